//! Memory of the walks, one for each thread, kept from call to call.

use crate::ray::HitLists;
use crate::tree::{Occlusion, Scratch};
use std::cell::Cell;

/// What a query needs beside its answer.
#[derive(Debug, Default)]
pub(super) struct Memory {
    pub scratch: Scratch,
    pub occlusion: Vec<Occlusion>,
    pub lists: HitLists,
}

thread_local! {
    static MEMORY: Cell<Option<Box<Memory>>> = const { Cell::new(None) };
}

/// Run `work` with this thread's memory; a query inside a query gets new memory.
#[inline]
pub(super) fn with<T>(work: impl FnOnce(&mut Memory) -> T) -> T {
    // A thread that is being torn down has none any more.
    let mut memory = MEMORY.try_with(Cell::take).ok().flatten().unwrap_or_default();
    let answer = work(&mut memory);
    // The value is dropped if the thread has no place for it any more.
    let _ = MEMORY.try_with(|place| place.set(Some(memory)));
    answer
}
