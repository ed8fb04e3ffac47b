//! The request being rendered.

use std::sync::Arc;
use std::time::Instant;

use glam::UVec2;

use super::phase::{Phase, Progress};
use super::request::{Request, Resume};
use crate::error::Result;
use crate::render::area::Area;
use crate::render::film::Film;
use crate::render::headless::same_size;
use crate::render::picture::{Extras, Picture};
use crate::render::pool::Pool;
use crate::render::progressive::ProgressiveRender;
use crate::render::schedule::Limits;
use crate::transport::PixelSampler;

/// A request under way.
pub(super) struct Active {
    pub render: ProgressiveRender,
    pub generation: u64,
    pub begun: Instant,
    pub phase: Phase,
    /// Whether the picture at the limit has been shown.
    pub final_shown: bool,
    /// The better sampler, from its arrival until it is taken.
    better: Option<Arc<dyn PixelSampler>>,
    /// Paths of the picture that was shown when the render started over. No picture with fewer
    /// paths is shown.
    held_below: u64,
    /// Seconds that the samples of a resumed film took, if there is one.
    resumed_seconds: Option<f64>,
}

impl Active {
    /// Begins a request, in the memory of an `old` film where that fits. Its first picture is as
    /// coarse as `seconds_per_path` says.
    ///
    /// # Errors
    /// When the film does not fit the memory, or the one to go on from is of another size.
    pub fn begin(
        request: Request,
        old: Option<Film>,
        seconds_per_path: Option<f64>,
        area: Option<Area>,
    ) -> Result<Self> {
        let Request { sampler, size, spp, generation, resume, provisional } = request;
        let resumed_seconds = resume.as_ref().map(|resume| resume.seconds);
        let cpu_seconds = resume.as_ref().map_or(0.0, |resume| resume.cpu_seconds);
        let film = film_for(resume, size, old)?;
        let limits = Limits { spp, seconds: None };
        let mut render = ProgressiveRender::new(sampler, film, limits, seconds_per_path);
        render.render_region_only(area);
        render.count_in(cpu_seconds);
        Ok(Self {
            render,
            generation,
            begun: Instant::now(),
            phase: Phase::first(provisional, resumed_seconds.is_some()),
            final_shown: false,
            better: None,
            held_below: 0,
            resumed_seconds,
        })
    }

    /// The state that the next step depends on.
    pub fn progress(&self, paused: bool) -> Progress {
        let finished = self.render.is_finished();
        Progress {
            paused,
            improved: self.better.is_some(),
            has_picture: self.render.has_picture(),
            caught_up: self.render.film().totals.paths >= self.held_below,
            finished,
            final_shown: self.final_shown,
        }
    }

    /// Notes the better sampler, or that none will come.
    pub fn improve(&mut self, sampler: Option<Arc<dyn PixelSampler>>) {
        let resumed = self.resumed_seconds.is_some();
        self.phase = self.phase.after_improvement(sampler.is_some(), resumed);
        if sampler.is_none() {
            // A last picture may have been shown that did not know that it was.
            self.final_shown = false;
        }
        self.better = sampler;
    }

    /// Starts over with the better sampler while `shown` is on the screen, or goes on with it from
    /// a film.
    pub fn start_over(&mut self, shown: Option<&Picture>) {
        let Some(sampler) = self.better.take() else { return };
        self.phase = Phase::Settled;
        self.final_shown = false;
        if self.resumed_seconds.is_some() {
            self.render.go_on_with(sampler);
            return;
        }
        self.render.start_over(sampler);
        let shown = shown.filter(|picture| picture.generation == self.generation);
        self.held_below = shown.map_or(0, |picture| picture.stats.paths);
    }

    /// Gives all samples to the pixels of `area`, or to all pixels.
    pub fn render_region_only(&mut self, area: Option<Area>) {
        self.render.render_region_only(area);
        self.final_shown = false;
    }

    /// Reads the picture that the film shows now.
    pub fn read(&mut self, pool: &Pool, extras: Extras, picture: &mut Picture) {
        self.render.read(pool, extras, picture);
        picture.stats.finished &= !self.phase.awaits_sampler();
        picture.stats.seconds += self.resumed_seconds.unwrap_or(0.0);
        picture.generation = self.generation;
    }
}

/// The film to render on: the one to resume, the old one cleared, or a new one.
fn film_for(resume: Option<Resume>, size: UVec2, old: Option<Film>) -> Result<Film> {
    match (resume, old) {
        (Some(resume), _) => same_size(resume.film, size),
        (None, Some(mut film)) if film.size() == size => {
            film.clear();
            Ok(film)
        }
        (None, old) => {
            drop(old);
            Film::new(size)
        }
    }
}
