//! The render thread of a session.

use std::sync::atomic::Ordering;
use std::sync::mpsc::Sender;
use std::sync::{Arc, MutexGuard, PoisonError};
use std::time::Duration;

use super::active::Active;
use super::phase::{Next, Phase};
use super::request::Request;
use super::shared::{Improvement, Mailbox, Shared, lock};
use super::sharing::TurnToken;
use crate::render::area::Area;
use crate::render::film::Film;
use crate::render::picture::{Extras, Picture};
use crate::render::pool::{Failure, Pool};
use crate::render::progressive::{ProgressiveRender, RenderStep};
use crate::render::turns::Usage;

/// Time that a request without a picture is left to get one when the next already waits. Otherwise
/// a drag whose edits come faster than coarse pictures would show nothing until it ends. Long
/// enough for a machine whose cores are busy drawing the window.
const FIRST_PICTURE_PATIENCE: Duration = Duration::from_secs(1);
/// Wait of the thread before it asks for a time slice again. Slices are twenty times as long.
const TURN: Duration = Duration::from_millis(1);

/// The render thread.
pub(super) struct Worker {
    shared: Arc<Shared>,
    pool: Pool,
    /// The epoch of the last message read.
    epoch: u64,
    paused: bool,
    extras: Extras,
    /// Whether extras were asked for since the last picture.
    owes_extras: bool,
    /// The token by which the session asks for time slices, if it shares the machine.
    turn_token: Option<TurnToken>,
    /// The pixels that get all samples.
    area: Option<Area>,
    job: Option<Active>,
    seconds_per_path: Option<f64>,
    snapshots: Vec<Sender<Film>>,
    /// Pictures published before, reused for the next one once nobody reads them.
    spare: Vec<Arc<Picture>>,
}

/// The event that the render thread waits for.
#[derive(Clone, Copy, PartialEq)]
enum Wait {
    Nothing,
    /// The next message.
    Message,
    /// The thread waits for its time slice, or the next message.
    Turn,
}

impl Worker {
    /// A thread that samples with the threads of `pool`.
    pub(super) fn new(shared: Arc<Shared>, pool: Pool) -> Self {
        Self {
            shared,
            pool,
            epoch: 0,
            paused: false,
            extras: Extras::default(),
            owes_extras: false,
            turn_token: None,
            area: None,
            job: None,
            seconds_per_path: None,
            snapshots: Vec::new(),
            spare: Vec::new(),
        }
    }

    /// Renders until the session ends.
    pub(super) fn run(mut self) {
        let mut wait = Wait::Message;
        while self.read_mailbox(wait) {
            self.start_over();
            self.serve_snapshots();
            self.serve_extras();
            wait = self.take_turn();
        }
        self.take_turns_by(None);
    }

    /// Works if the session has the time slice.
    fn take_turn(&mut self) -> Wait {
        let Some(token) = self.turn_token.clone() else { return self.work() };
        if !token.begin(self.usage()) {
            return Wait::Turn;
        }
        let wait = self.work();
        match wait {
            Wait::Message => token.leave(),
            _ => token.end(self.usage()),
        }
        wait
    }

    /// The share of the machine that the present request has had.
    fn usage(&self) -> Usage {
        let render = self.job.as_ref().map(|job| &job.render);
        Usage {
            cpu_seconds: render.map_or(0.0, ProgressiveRender::cpu_seconds),
            samples: render.map_or(0.0, ProgressiveRender::samples_per_pixel),
            closed: false,
        }
    }

    fn take_turns_by(&mut self, token: Option<TurnToken>) {
        if let Some(old) = std::mem::replace(&mut self.turn_token, token) {
            old.leave();
        }
    }

    /// Reads the messages, after some waiting. Returns false when the session ends.
    fn read_mailbox(&mut self, wait: Wait) -> bool {
        let shared = Arc::clone(&self.shared);
        let mut mailbox = self.wait_for(wait, &shared);
        if shared.quit.load(Ordering::Relaxed) {
            return false;
        }
        shared.improved.store(false, Ordering::Relaxed);
        shared.requested.store(false, Ordering::Relaxed);
        self.snapshots.append(&mut mailbox.snapshots);
        self.paused = mailbox.paused;
        self.owes_extras |= mailbox.extras.adds_to(self.extras);
        self.extras = mailbox.extras;
        let (token, area) = (mailbox.turn_token.clone(), mailbox.area);
        if mailbox.request.is_some() && self.is_owed_a_picture() {
            // The epoch stays the old one: the message is still unread.
            return true;
        }
        let (request, improvement) = (mailbox.request.take(), mailbox.improvement.take());
        self.epoch = shared.epoch.load(Ordering::Relaxed);
        drop(mailbox);
        self.take_turns_by(token);
        let is_moved = std::mem::replace(&mut self.area, area) != area;
        if let Some(request) = request {
            self.begin(request);
        } else if let Some(job) = self.job.as_mut().filter(|_| is_moved) {
            job.render_region_only(area);
        }
        if let Some(Improvement { generation, sampler }) = improvement
            && let Some(job) = self.job.as_mut().filter(|job| job.generation == generation)
        {
            job.improve(sampler);
        }
        true
    }

    /// Locks the mailbox once there is nothing to wait for any more.
    fn wait_for<'s>(&self, wait: Wait, shared: &'s Shared) -> MutexGuard<'s, Mailbox> {
        let mailbox = lock(&shared.mailbox);
        let nothing_new = |_: &mut Mailbox| shared.epoch.load(Ordering::Relaxed) == self.epoch;
        match wait {
            Wait::Nothing => mailbox,
            Wait::Message => {
                let waited = shared.changed.wait_while(mailbox, nothing_new);
                waited.unwrap_or_else(PoisonError::into_inner)
            }
            Wait::Turn => {
                // Also when a message waits that must wait longer, for the first picture.
                let waited = shared.changed.wait_timeout(mailbox, TURN);
                waited.unwrap_or_else(PoisonError::into_inner).0
            }
        }
    }

    /// Whether the present request should get its first picture before the next one begins.
    fn is_owed_a_picture(&self) -> bool {
        self.job.as_ref().is_some_and(|job| {
            let progress = job.progress(self.paused);
            job.phase.is_owed_a_picture(&progress) && job.begun.elapsed() < FIRST_PICTURE_PATIENCE
        })
    }

    /// Starts the render over with the better sampler that came for it, if it is time to.
    fn start_over(&mut self) {
        let Some(job) = &mut self.job else { return };
        if job.phase.next(&job.progress(self.paused)) == Next::StartOver {
            job.start_over(lock(&self.shared.latest).as_deref());
        }
    }

    fn begin(&mut self, request: Request) {
        *lock(&self.shared.failure) = None;
        let mut old_film = None;
        if let Some(job) = self.job.take() {
            let (film, cost) = job.render.into_parts();
            self.seconds_per_path = cost.or(self.seconds_per_path);
            old_film = Some(film);
        }
        let generation = request.generation;
        match Active::begin(request, old_film, self.seconds_per_path, self.area) {
            Ok(job) => self.job = Some(job),
            Err(error) => {
                self.shared.fail(generation, Failure { at: None, message: error.to_string() });
            }
        }
    }

    fn serve_snapshots(&mut self) {
        let Some(job) = &self.job else {
            self.snapshots.clear();
            return;
        };
        if !job.phase.gives_snapshots(&job.progress(self.paused)) {
            return;
        }
        for sender in self.snapshots.drain(..) {
            if let Ok(film) = job.render.film().try_clone() {
                // Whoever asked may have gone.
                let _ = sender.send(film);
            }
        }
    }

    /// Publishes what there is once more when extras were asked for; a request without a picture
    /// brings them with its first.
    fn serve_extras(&mut self) {
        let owed = std::mem::take(&mut self.owes_extras);
        if owed && self.job.as_ref().is_some_and(|job| job.progress(self.paused).may_show()) {
            self.publish();
        }
    }

    /// Does one step of the render; returns what to wait for after it.
    fn work(&mut self) -> Wait {
        let Some(job) = &mut self.job else { return Wait::Message };
        let before = job.progress(self.paused);
        let next = job.phase.next(&before);
        match next {
            Next::Sample | Next::Rest => {}
            Next::Wait => return Wait::Message,
            // It is done before the next work.
            Next::StartOver => return Wait::Nothing,
        }
        let (shared, epoch, begun) = (&self.shared, self.epoch, job.begun);
        let ends =
            || shared.quit.load(Ordering::Relaxed) || shared.improved.load(Ordering::Relaxed);
        let stop = || {
            shared.epoch.load(Ordering::Relaxed) != epoch
                && (before.has_picture || ends() || begun.elapsed() > FIRST_PICTURE_PATIENCE)
        };
        // Messages about the same render would have a pilot pass begin anew, again and again.
        let give_up = || ends() || shared.requested.load(Ordering::Relaxed);
        let step = job.render.step(&self.pool, next == Next::Rest, &stop, &give_up);
        let after = job.progress(self.paused);
        let shows = after.shows(job.render.publish_due());
        if shows && !matches!(step, RenderStep::Interrupted) {
            job.final_shown = after.finished;
            self.publish();
        }
        match step {
            RenderStep::Worked | RenderStep::Interrupted => Wait::Nothing,
            RenderStep::Paused | RenderStep::Done => Wait::Message,
            RenderStep::Failed(failure) => self.fail(failure),
        }
    }

    /// Ends the render for good.
    fn fail(&mut self, failure: Failure) -> Wait {
        if let Some(job) = &mut self.job {
            job.phase = Phase::Failed;
            self.shared.fail(job.generation, failure);
        }
        // Snapshots that waited for a picture get what there is.
        if self.snapshots.is_empty() { Wait::Message } else { Wait::Nothing }
    }

    /// Makes a picture of the film and hands it over.
    fn publish(&mut self) {
        let mut picture = self.spare_memory();
        let Some(job) = &mut self.job else { return };
        job.read(&self.pool, self.extras, &mut picture);
        let picture = Arc::new(picture);
        self.spare.push(Arc::clone(&picture));
        self.shared.publish(picture);
    }

    /// Memory for a picture: that of an old one if nobody holds it any more.
    fn spare_memory(&mut self) -> Picture {
        let free = self.spare.iter().position(|picture| Arc::strong_count(picture) == 1);
        let free = free.map(|index| self.spare.swap_remove(index));
        // Two stay: the latest and the one the window may still be reading.
        let excess = self.spare.len().saturating_sub(2);
        self.spare.drain(..excess);
        free.and_then(|picture| Arc::try_unwrap(picture).ok()).unwrap_or_default()
    }
}
