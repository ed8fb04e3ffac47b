//! The render thread of a session.

use std::sync::atomic::Ordering;
use std::sync::mpsc::Sender;
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use glam::UVec2;

use super::{Improvement, Mail, Request, Resume, Seat, Shared, lock};
use crate::error::Result;
use crate::render::area::Area;
use crate::render::film::Film;
use crate::render::headless::same_size;
use crate::render::pool::{Failure, Pool};
use crate::render::progressive::{ProgressiveRender, RenderStep};
use crate::render::publish::{Extras, Picture};
use crate::render::schedule::Limits;
use crate::render::turns::Usage;
use crate::transport::PixelSampler;

/// How long a request without a picture is left to get one when the next already waits. Otherwise
/// a drag whose edits come faster than coarse pictures would show nothing until it ends.
/// Long enough for a machine whose cores are busy drawing the window.
const PATIENCE: Duration = Duration::from_secs(1);
/// How long it waits before it asks for its turn again. Turns are twenty times as long.
const TURN: Duration = Duration::from_millis(1);

/// The render thread.
pub(super) struct Worker {
    shared: Arc<Shared>,
    pool: Pool,
    /// The epoch of the last letter read.
    epoch: u64,
    paused: bool,
    extras: Extras,
    /// Whether extras were asked for since the last picture.
    owes_extras: bool,
    /// Where it takes turns with another session.
    seat: Option<Seat>,
    /// The pixels that get all samples.
    area: Option<Area>,
    job: Option<Active>,
    seconds_per_path: Option<f64>,
    snapshots: Vec<Sender<Film>>,
    /// Pictures published before, to write the next one into once nobody looks at them.
    spare: Vec<Arc<Picture>>,
}

/// The request being rendered.
struct Active {
    engine: ProgressiveRender,
    generation: u64,
    begun: Instant,
    failed: bool,
    shown_final: bool,
    /// Whether a better sampler is in the making, and the sampler if it is there.
    awaits: Awaits,
    /// Paths of the picture shown when it started over, without which it shows none.
    held_below: u64,
    /// Seconds that the film took which it goes on from, if it does.
    resumed_at: Option<f64>,
}

/// What the render thread waits for.
#[derive(Clone, Copy, PartialEq)]
enum Wait {
    Nothing,
    /// The next letter.
    Letter,
    /// Its turn, or the next letter.
    Turn,
}

/// How a request stands that may be improved.
enum Awaits {
    Nothing,
    Sampler,
    /// For the pause to end.
    Resumption(Arc<dyn PixelSampler>),
}

impl Active {
    fn new(
        engine: ProgressiveRender,
        generation: u64,
        provisional: bool,
        resumed_at: Option<f64>,
    ) -> Self {
        Self {
            engine,
            generation,
            begun: Instant::now(),
            failed: false,
            shown_final: false,
            awaits: if provisional { Awaits::Sampler } else { Awaits::Nothing },
            held_below: 0,
            resumed_at,
        }
    }

    /// Whether what it samples will not change any more.
    fn is_settled(&self) -> bool {
        matches!(self.awaits, Awaits::Nothing)
    }

    /// Whether it goes on from a film and waits for the sampler to do so with.
    fn holds(&self) -> bool {
        self.resumed_at.is_some() && !self.is_settled()
    }

    /// Whether there is a picture that does not fall behind the one shown before it started over.
    fn may_show(&self) -> bool {
        let paths = self.engine.film().totals.paths;
        self.engine.has_picture() && (paths >= self.held_below || self.engine.is_finished())
    }

    /// Whether it should get its first picture before the next request has its turn.
    fn is_owed_a_picture(&self) -> bool {
        let may_get_one = !self.failed && !self.holds();
        may_get_one && !self.engine.has_picture() && self.begun.elapsed() < PATIENCE
    }
}

impl Worker {
    /// Samples with the threads of `pool`.
    pub(super) fn new(shared: Arc<Shared>, pool: Pool) -> Self {
        Self {
            shared,
            pool,
            epoch: 0,
            paused: false,
            extras: Extras::default(),
            owes_extras: false,
            seat: None,
            area: None,
            job: None,
            seconds_per_path: None,
            snapshots: Vec::new(),
            spare: Vec::new(),
        }
    }

    /// Until the session ends.
    pub(super) fn run(mut self) {
        let mut wait = Wait::Letter;
        while self.read_mail(wait) {
            self.serve_snapshots();
            self.serve_extras();
            wait = self.take_turn();
        }
        self.take_seat(None);
    }

    /// Works if it is this session's turn.
    fn take_turn(&mut self) -> Wait {
        let Some(seat) = self.seat.clone() else { return self.work() };
        if !seat.begin(self.account()) {
            return Wait::Turn;
        }
        let wait = self.work();
        match wait {
            Wait::Letter => seat.leave(),
            _ => seat.end(self.account()),
        }
        wait
    }

    /// What the present request has had of the machine.
    fn account(&self) -> Usage {
        let engine = self.job.as_ref().map(|job| &job.engine);
        Usage {
            cpu_seconds: engine.map_or(0.0, ProgressiveRender::cpu_seconds),
            samples: engine.map_or(0.0, ProgressiveRender::samples_per_pixel),
            closed: false,
        }
    }

    fn take_seat(&mut self, seat: Option<Seat>) {
        if let Some(old) = std::mem::replace(&mut self.seat, seat) {
            old.leave();
        }
    }

    /// Takes the mail, after some waiting. Returns false when the session ends.
    fn read_mail(&mut self, wait: Wait) -> bool {
        let shared = Arc::clone(&self.shared);
        let mut mail = lock(&shared.mail);
        let nothing_new = |_: &mut Mail| shared.epoch.load(Ordering::Relaxed) == self.epoch;
        mail = match wait {
            Wait::Nothing => mail,
            Wait::Letter => {
                let waited = shared.bell.wait_while(mail, nothing_new);
                waited.unwrap_or_else(PoisonError::into_inner)
            }
            Wait::Turn => {
                // Also when a letter waits that must wait longer, for the first picture.
                shared.bell.wait_timeout(mail, TURN).unwrap_or_else(PoisonError::into_inner).0
            }
        };
        if shared.quit.load(Ordering::Relaxed) {
            return false;
        }
        shared.improved.store(false, Ordering::Relaxed);
        self.snapshots.append(&mut mail.snapshots);
        self.paused = mail.paused;
        self.owes_extras |= mail.extras.adds_to(self.extras);
        self.extras = mail.extras;
        let (seat, area) = (mail.seat.clone(), mail.area);
        if self.job.as_ref().is_some_and(Active::is_owed_a_picture) && mail.request.is_some() {
            // The epoch stays the old one: the letter is still unread.
            return true;
        }
        let (request, improvement) = (mail.request.take(), mail.improvement.take());
        self.epoch = shared.epoch.load(Ordering::Relaxed);
        drop(mail);
        self.take_seat(seat);
        let is_moved = std::mem::replace(&mut self.area, area) != area;
        if let Some(request) = request {
            self.begin(request);
        } else if let Some(job) = self.job.as_mut().filter(|_| is_moved) {
            job.engine.focus(area);
            job.shown_final = false;
        }
        if let Some(improvement) = improvement {
            self.take_in(improvement);
        }
        self.start_over();
        true
    }

    /// Notes what becomes of a provisional request, if it is the one being rendered.
    fn take_in(&mut self, improvement: Improvement) {
        let Improvement { generation, sampler } = improvement;
        let Some(job) = self.job.as_mut().filter(|job| job.generation == generation) else {
            return;
        };
        match sampler {
            Some(sampler) => job.awaits = Awaits::Resumption(sampler),
            None => {
                job.awaits = Awaits::Nothing;
                // A last picture may have been shown that did not know it.
                job.shown_final = false;
            }
        }
    }

    /// Starts the render over with the better sampler that came for it, unless it is paused and has
    /// something to show.
    fn start_over(&mut self) {
        let Some(job) = &mut self.job else { return };
        if job.failed || self.paused && job.engine.has_picture() {
            return;
        }
        let Awaits::Resumption(sampler) = &job.awaits else { return };
        let sampler = sampler.clone();
        job.awaits = Awaits::Nothing;
        job.shown_final = false;
        if job.resumed_at.is_some() {
            job.engine.go_on_with(sampler);
            return;
        }
        job.engine.start_over(sampler);
        let shown = lock(&self.shared.latest);
        let shown = shown.as_ref().filter(|picture| picture.generation == job.generation);
        job.held_below = shown.map_or(0, |picture| picture.stats.paths);
    }

    fn begin(&mut self, request: Request) {
        *lock(&self.shared.failure) = None;
        let mut old_film = None;
        if let Some(job) = self.job.take() {
            let (film, cost) = job.engine.into_parts();
            self.seconds_per_path = cost.or(self.seconds_per_path);
            old_film = Some(film);
        }
        let resumed_at = request.resume.as_ref().map(|resume| resume.seconds);
        let cpu_seconds = request.resume.as_ref().map_or(0.0, |resume| resume.cpu_seconds);
        match film_for(request.resume, request.size, old_film) {
            Ok(film) => {
                let limits = Limits { spp: request.spp, seconds: None };
                let mut engine =
                    ProgressiveRender::new(request.sampler, film, limits, self.seconds_per_path);
                engine.focus(self.area);
                engine.count_in(cpu_seconds);
                let (generation, provisional) = (request.generation, request.provisional);
                self.job = Some(Active::new(engine, generation, provisional, resumed_at));
            }
            Err(error) => {
                let failure = Failure { at: None, message: error.to_string() };
                self.fail(request.generation, failure);
            }
        }
    }

    fn fail(&self, generation: u64, failure: Failure) {
        *lock(&self.shared.failure) = Some((generation, failure));
        (self.shared.on_publish)();
    }

    fn serve_snapshots(&mut self) {
        let Some(job) = &self.job else {
            self.snapshots.clear();
            return;
        };
        let stands = job.is_settled() || self.paused;
        if !(job.may_show() && stands || job.failed) {
            return;
        }
        for sender in self.snapshots.drain(..) {
            if let Ok(film) = job.engine.film().try_clone() {
                // Whoever asked may have gone.
                let _ = sender.send(film);
            }
        }
    }

    /// Publishes what there is once more when extras were asked for; a request without a picture
    /// brings them with its first.
    fn serve_extras(&mut self) {
        let owed = std::mem::take(&mut self.owes_extras);
        if owed && self.job.as_ref().is_some_and(Active::may_show) {
            self.publish();
        }
    }

    /// One step of the render; returns what there is to wait for after it.
    fn work(&mut self) -> Wait {
        let Some(job) = &mut self.job else { return Wait::Letter };
        if job.failed || job.holds() && !job.may_show() {
            return Wait::Letter;
        }
        let (shared, epoch, begun) = (&self.shared, self.epoch, job.begun);
        let has_picture = job.engine.has_picture();
        let stop = || {
            shared.epoch.load(Ordering::Relaxed) != epoch
                && (has_picture
                    || shared.quit.load(Ordering::Relaxed)
                    || shared.improved.load(Ordering::Relaxed)
                    || begun.elapsed() > PATIENCE)
        };
        let paused = (self.paused || job.holds()) && job.may_show();
        let step = job.engine.step(&self.pool, paused, &stop);
        let finished = job.engine.is_finished();
        let due = job.may_show() && job.engine.publish_due() || finished && !job.shown_final;
        if due && !matches!(step, RenderStep::Interrupted) {
            job.shown_final = finished;
            self.publish();
        }
        match step {
            RenderStep::Worked | RenderStep::Interrupted => Wait::Nothing,
            RenderStep::Paused | RenderStep::Done => Wait::Letter,
            RenderStep::Failed(failure) => {
                if let Some(job) = &mut self.job {
                    job.failed = true;
                    let generation = job.generation;
                    self.fail(generation, failure);
                }
                // Snapshots that waited for a picture get what there is.
                if self.snapshots.is_empty() { Wait::Letter } else { Wait::Nothing }
            }
        }
    }

    /// Makes a picture of the film and hands it over.
    fn publish(&mut self) {
        let mut picture = self.spare_memory();
        let Some(job) = &mut self.job else { return };
        job.engine.read(&self.pool, self.extras, &mut picture);
        picture.stats.finished &= job.is_settled();
        picture.stats.seconds += job.resumed_at.unwrap_or(0.0);
        picture.generation = job.generation;
        let picture = Arc::new(picture);
        self.spare.push(Arc::clone(&picture));
        *lock(&self.shared.latest) = Some(picture);
        (self.shared.on_publish)();
    }

    /// Memory for a picture: that of an old one if nobody holds it any more.
    fn spare_memory(&mut self) -> Picture {
        let free = self.spare.iter().position(|picture| Arc::strong_count(picture) == 1);
        let free = free.map(|index| self.spare.swap_remove(index));
        // Two are kept: the latest and the one the window may still be reading.
        let excess = self.spare.len().saturating_sub(2);
        self.spare.drain(..excess);
        free.and_then(|picture| Arc::try_unwrap(picture).ok()).unwrap_or_default()
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
