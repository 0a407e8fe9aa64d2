//! Measures Whitted beside its peers: ray queries and builds beside Embree, pictures beside POV-Ray and Tachyon.
//!
//! Not shipped. Without a peer our own figures are printed alone.
//!
//! # Invariants
//! * Figures of two sides are comparable only if they come from the same run: peers are interleaved with us.
//! * Answers are compared in the same run: a fast wrong answer is no figure.

mod builds;
mod contest;
mod curve;
mod embree;
mod field;
mod machine;
mod one_by_one;
mod options;
mod ours;
mod packets;
mod peer;
mod pictures;
mod ray_sets;
mod rays;
mod record;
mod row;
mod scenes;

use clap::Parser;
use std::error::Error;
use std::process::ExitCode;

/// Measures Whitted beside Embree, POV-Ray and Tachyon
#[derive(Parser)]
#[command(version)]
enum Command {
    /// Ray queries beside Embree
    Rays(rays::Options),
    /// How the time for a ray grows with the number of primitives
    Curve(curve::Options),
    /// Tree builds beside Embree
    Build(builds::Options),
    /// Whole renders beside POV-Ray and Tachyon
    Pictures(pictures::Options),
    /// All of it, kept in bench/record
    Record(record::Options),
}

fn main() -> ExitCode {
    match run(Command::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: Command) -> Result<(), Box<dyn Error>> {
    match command {
        Command::Rays(options) => rays::run(&options).map(drop),
        Command::Curve(options) => curve::run(&options).map(drop),
        Command::Build(options) => builds::run(&options).map(drop),
        Command::Pictures(options) => pictures::run(&options).map(drop),
        Command::Record(options) => record::run(&options),
    }
}
