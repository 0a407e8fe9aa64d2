//! A whole picture: all regions once, then the flagged pixels again.

use super::context::Context;
use super::edges::{EdgeRule, flagged};
use super::execution::{Execution, Method};
use super::first_pass::{FirstPass, FirstSample, Spare};
use super::image::Image;
use super::probe::{Phase, Probe, Unwatched, watched};
use super::progress::{Cancel, Cancelled, Progress};
use super::region::PixelRect;
use super::statistics::Statistics;
use super::workspace::{Refined, Workspaces};
use crate::classic::Caster;
use crate::scene::{Antialias, Prepared, Settings};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// A rendered picture, or a rectangle of one.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The part of the picture that this is.
    pub rect: PixelRect,
    /// Its pixels.
    pub image: Image,
    /// What the first sample of every pixel saw, row by row; empty if neither [`Execution::first_samples`] nor edges
    /// wanted to know.
    pub first: Vec<FirstSample>,
    /// Whether a pixel got more than one sample, row by row: the paper's figure 4.
    pub supersampled: Vec<bool>,
    /// What was done for these pixels.
    pub statistics: Statistics,
    /// What was done for pixels around `rect`, only to know whether there are edges between them and it.
    pub apron: Statistics,
}

/// Render the whole picture.
///
/// Runs in the current rayon pool: within `pool.install` with as many threads as `pool` has, elsewhere in rayon's
/// global pool. The settings should have passed [`Settings::check`].
///
/// # Errors
/// If `cancel` was set before the picture was finished.
pub fn render(
    prepared: &Prepared,
    settings: &Settings,
    execution: &Execution,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Frame, Cancelled> {
    let whole = PixelRect::whole(settings.size);
    render_rect(prepared, settings, execution, &whole, progress, cancel, &Unwatched)
}

/// Render the part of the picture that lies in `rect`, and tell `probe` what is being done.
///
/// The pixels are those of the whole picture. What of `rect` lies outside it is left out.
///
/// # Errors
/// If `cancel` was set before the picture was finished.
pub fn render_rect<P: Probe>(
    prepared: &Prepared,
    settings: &Settings,
    execution: &Execution,
    rect: &PixelRect,
    progress: &dyn Progress,
    cancel: &Cancel,
    probe: &P,
) -> Result<Frame, Cancelled> {
    Renderer::default().render(prepared, settings, execution, rect, progress, cancel, probe)
}

/// A scene with the paper's structures.
#[derive(Clone, Copy, Debug)]
pub struct Classic<'a> {
    /// The scene; its tree is not used.
    pub prepared: &'a Prepared,
    /// Finds what rays hit, among the primitives of `prepared`.
    pub caster: Caster<'a>,
}

/// As [`render_rect`], recursively and with the paper's structures, whatever method and walk `execution` says.
///
/// The pixels are the same, unless triangles are tested by projection.
///
/// # Errors
/// If `cancel` was set before the picture was finished.
pub fn render_classic<P: Probe>(
    classic: &Classic<'_>,
    settings: &Settings,
    execution: &Execution,
    rect: &PixelRect,
    progress: &dyn Progress,
    cancel: &Cancel,
    probe: &P,
) -> Result<Frame, Cancelled> {
    let execution = Execution { method: Method::Recursive, ..*execution };
    let context = Context::new(classic.prepared, settings, &execution, cancel);
    let context = Context { caster: Some(classic.caster), ..context };
    Renderer::default().render_in(context, rect, progress, probe)
}

/// Renders one picture after another in the same memory: for moving pictures, whose frames take about as long as getting
/// fresh memory for each.
#[derive(Debug, Default)]
pub struct Renderer {
    workspaces: Workspaces,
    spare: Mutex<Spare>,
}

impl Renderer {
    /// As [`render_rect`].
    ///
    /// # Errors
    /// If `cancel` was set before the picture was finished.
    pub fn render<P: Probe>(
        &self,
        prepared: &Prepared,
        settings: &Settings,
        execution: &Execution,
        rect: &PixelRect,
        progress: &dyn Progress,
        cancel: &Cancel,
        probe: &P,
    ) -> Result<Frame, Cancelled> {
        self.render_in(Context::new(prepared, settings, execution, cancel), rect, progress, probe)
    }

    /// Take back the memory of a picture that nobody needs any more, for the next one.
    pub fn recycle(&self, frame: Frame) {
        let spare = Spare { colors: frame.image.pixels, samples: frame.first };
        *self.spare.lock().unwrap_or_else(PoisonError::into_inner) = spare;
    }

    fn take_spare(&self) -> Spare {
        std::mem::take(&mut self.spare.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn render_in<P: Probe>(
        &self,
        context: Context<'_>,
        rect: &PixelRect,
        progress: &dyn Progress,
        probe: &P,
    ) -> Result<Frame, Cancelled> {
        let rect = rect.intersection(&PixelRect::whole(context.settings.size));
        if rect.is_empty() {
            let nothing = FirstPass::new(PixelRect::EMPTY, false, Spare::default());
            return Ok(Frame::of(nothing, rect, Statistics::default(), Statistics::default()));
        }
        let rule = EdgeRule::new(context.settings);
        let job = Job { context, rule, progress, probe, renderer: self };
        let (pass, statistics, apron) = job.first_pass(&rect)?;
        let refined = if job.rule.never() { Vec::new() } else { job.refine(&pass, &rect)? };
        let mut frame = Frame::of(pass, rect, statistics, apron);
        refined.iter().for_each(|(pixels, statistics)| frame.refine(pixels, statistics));
        Ok(frame)
    }
}

/// A render under way.
struct Job<'a, P> {
    context: Context<'a>,
    rule: EdgeRule,
    progress: &'a dyn Progress,
    probe: &'a P,
    renderer: &'a Renderer,
}

impl<P: Probe> Job<'_, P> {
    /// One sample of every pixel of `rect`, and of those around it if they matter. Returns counts for both.
    fn first_pass(&self, rect: &PixelRect) -> Result<(FirstPass, Statistics, Statistics), Cancelled> {
        let settings = self.context.settings;
        let covered = match settings.antialias {
            Antialias::Paper | Antialias::Edge => rect.with_apron(settings.size),
            Antialias::Off | Antialias::Uniform(_) => *rect,
        };
        let kind = self.context.execution.region;
        let around = rect.strips_to(&covered).into_iter().flat_map(|strip| strip.regions(kind));
        let regions: Vec<PixelRect> = rect.regions(kind).into_iter().chain(around).collect();
        let mut pass = FirstPass::new(covered, self.context.keeps_first_samples(), self.renderer.take_spare());
        let rows = pass.rows();
        let results = self.for_each(1, &regions, |workspace, region| {
            let is_inside = rect.contains([region.x, region.y]);
            workspace.first_samples(&self.context, region, self.probe, |part, samples| {
                rows.set(part, samples.colors(), samples.first());
                if is_inside {
                    self.progress.painted(part, &mut samples.colors().iter().copied());
                }
            })?;
            Ok(workspace.take_statistics())
        })?;
        drop(rows);
        let (mut inside, mut apron) = (Statistics::default(), Statistics::default());
        for (region, statistics) in regions.iter().zip(results) {
            let place = if rect.contains([region.x, region.y]) { &mut inside } else { &mut apron };
            *place += statistics;
        }
        Ok((pass, inside, apron))
    }

    /// More samples for the flagged pixels of `rect`: what they give, and what was done for them, region by region.
    fn refine(&self, pass: &FirstPass, rect: &PixelRect) -> Result<Vec<(Vec<Refined>, Statistics)>, Cancelled> {
        let regions = rect.regions(self.context.execution.region);
        self.for_each(2, &regions, |workspace, region| {
            let pixels = watched(self.probe, Phase::Refine, || flagged(&self.rule, pass, region));
            let refined = workspace.refine(&self.context, pass, &pixels, self.probe)?;
            self.progress.refined(&mut refined.iter().map(|&Refined { pixel, color }| (pixel, color)));
            Ok((refined, workspace.take_statistics()))
        })
    }

    /// Do `work` for every region in parallel; results in the order of the regions.
    fn for_each<R: Send>(
        &self,
        phase: u32,
        regions: &[PixelRect],
        work: impl Fn(&mut super::workspace::Workspace, &PixelRect) -> Result<R, Cancelled> + Sync,
    ) -> Result<Vec<R>, Cancelled> {
        let done = AtomicUsize::new(0);
        regions
            .par_iter()
            // Left to itself, rayon leaves runs of many regions to one thread, for which the others wait in the end.
            .with_max_len(1)
            .map(|region| {
                let result = self.renderer.workspaces.with(|workspace| {
                    // What was counted for a picture that is not finished must not appear in the next one.
                    work(workspace, region).inspect_err(|_| _ = workspace.take_statistics())
                })?;
                self.progress.regions_done(phase, done.fetch_add(1, Ordering::Relaxed) + 1, regions.len());
                Ok(result)
            })
            .collect()
    }
}

impl Frame {
    /// The frame after the first pass.
    fn of(pass: FirstPass, rect: PixelRect, statistics: Statistics, apron: Statistics) -> Self {
        let (pixels, first) = pass.into_part(&rect);
        let image = Image { width: rect.width, height: rect.height, pixels };
        Self { rect, image, supersampled: vec![false; rect.len()], first, statistics, apron }
    }

    /// Take over supersampled pixels.
    fn refine(&mut self, refined: &[Refined], statistics: &Statistics) {
        self.statistics += *statistics;
        self.statistics.supersampled_pixels += refined.len() as u64;
        for &Refined { pixel, color } in refined {
            let index = self.rect.index(pixel);
            self.image.pixels[index] = color;
            self.supersampled[index] = true;
        }
    }
}
