//! The phases of a request: when it samples, rests, starts over or waits. Pure logic, no threads
//! and no clocks.

/// The phase that the request being rendered is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// The render samples while a better sampler is in the making, with which it will start over.
    Provisional,
    /// The render continues a film, but takes no samples before the better sampler has come.
    Holding,
    /// The render samples, and its sampler does not change any more.
    Settled,
    /// A sample could not be taken. Only another request ends this.
    Failed,
}

/// The state of a render and its session that the next step depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Progress {
    /// Whether the session is paused.
    pub paused: bool,
    /// Whether the better sampler has come.
    pub improved: bool,
    /// Whether the film has something to show in every place.
    pub has_picture: bool,
    /// Whether the film has as many paths as the picture that was shown before it started over.
    pub caught_up: bool,
    /// Whether the limit is reached.
    pub finished: bool,
    /// Whether the picture at the limit has been shown.
    pub final_shown: bool,
}

/// The next step of the render thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// Take the better sampler: start over with it, or go on with it from a film.
    StartOver,
    /// Take samples, and show the picture when it is due.
    Sample,
    /// Take no samples, but show the picture when it is due.
    Rest,
    /// Do nothing before the next message.
    Wait,
}

impl Phase {
    /// The first phase of a request, which may be provisional and may go on from a film.
    pub fn first(provisional: bool, resumed: bool) -> Self {
        match (provisional, resumed) {
            (false, _) => Self::Settled,
            (true, false) => Self::Provisional,
            (true, true) => Self::Holding,
        }
    }

    /// The phase after an improvement came: with a sampler, which is taken in the step
    /// [`Next::StartOver`], or with the word that none will come.
    pub fn after_improvement(self, with_sampler: bool, resumed: bool) -> Self {
        match self {
            Self::Failed => Self::Failed,
            _ => Self::first(with_sampler, resumed),
        }
    }

    /// The next step. While paused a render goes on until it has something to show, and starts over
    /// only if it shows nothing.
    pub fn next(self, now: &Progress) -> Next {
        let keeps_its_picture = now.paused && now.has_picture;
        match self {
            Self::Failed => Next::Wait,
            Self::Provisional | Self::Holding if now.improved && !keeps_its_picture => {
                Next::StartOver
            }
            Self::Holding if now.may_show() => Next::Rest,
            Self::Holding => Next::Wait,
            Self::Provisional | Self::Settled if now.paused && now.may_show() => Next::Rest,
            Self::Provisional | Self::Settled => Next::Sample,
        }
    }

    /// Whether the sampler may still change, so that the render is not finished at its limit.
    pub fn awaits_sampler(self) -> bool {
        matches!(self, Self::Provisional | Self::Holding)
    }

    /// Whether a copy of the film may be given away: of samples that stay, or of what there is when
    /// nothing more will come.
    pub fn gives_snapshots(self, now: &Progress) -> bool {
        match self {
            Self::Failed => true,
            Self::Settled => now.may_show(),
            Self::Provisional | Self::Holding => now.may_show() && now.paused,
        }
    }

    /// Whether the request should get its first picture before the next one begins.
    pub fn is_owed_a_picture(self, now: &Progress) -> bool {
        matches!(self, Self::Provisional | Self::Settled) && !now.has_picture
    }
}

impl Progress {
    /// Whether there is a picture that does not fall behind the one shown before the render started
    /// over.
    pub fn may_show(&self) -> bool {
        self.has_picture && (self.caught_up || self.finished)
    }

    /// Whether a picture is to be shown after a step, where the schedule says that one is `due`.
    /// The one at the limit does not wait for the schedule.
    pub fn shows(&self, due: bool) -> bool {
        self.may_show() && due || self.finished && !self.final_shown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A render under way that shows pictures.
    const SHOWING: Progress = Progress {
        paused: false,
        improved: false,
        has_picture: true,
        caught_up: true,
        finished: false,
        final_shown: false,
    };
    const PAUSED: Progress = Progress { paused: true, ..SHOWING };
    /// A render that has nothing to show yet.
    const BLANK: Progress = Progress { has_picture: false, ..SHOWING };

    #[test]
    fn a_render_samples_until_it_is_paused_and_has_something_to_show() {
        for phase in [Phase::Provisional, Phase::Settled] {
            assert_eq!(phase.next(&SHOWING), Next::Sample);
            assert_eq!(phase.next(&PAUSED), Next::Rest);
            let blank = Progress { paused: true, ..BLANK };
            assert_eq!(phase.next(&blank), Next::Sample, "its first picture comes all the same");
            let behind = Progress { caught_up: false, ..PAUSED };
            assert_eq!(phase.next(&behind), Next::Sample, "what is shown must not get worse");
        }
    }

    #[test]
    fn a_film_is_shown_but_not_continued_before_the_better_sampler_has_come() {
        let phase = Phase::first(true, true);
        assert_eq!(phase, Phase::Holding);
        assert_eq!([SHOWING, PAUSED].map(|now| phase.next(&now)), [Next::Rest; 2]);
        assert_eq!(phase.next(&BLANK), Next::Wait);
        let settled = phase.after_improvement(false, true);
        assert_eq!(settled.next(&SHOWING), Next::Sample, "none will come");
    }

    #[test]
    fn a_better_sampler_is_taken_at_once_unless_a_pause_keeps_the_picture() {
        for (resumed, expected) in [(false, Phase::Provisional), (true, Phase::Holding)] {
            for before in [Phase::first(true, resumed), Phase::Settled] {
                let phase = before.after_improvement(true, resumed);
                assert_eq!(phase, expected, "{before:?}");
                let improved = |now| Progress { improved: true, ..now };
                assert_eq!(phase.next(&improved(SHOWING)), Next::StartOver);
                assert_eq!(phase.next(&improved(BLANK)), Next::StartOver);
                let blank = Progress { paused: true, ..BLANK };
                assert_eq!(phase.next(&improved(blank)), Next::StartOver);
                assert_eq!(phase.next(&improved(PAUSED)), Next::Rest);
            }
        }
    }

    #[test]
    fn after_a_failure_nothing_happens_but_snapshots() {
        let improved = Progress { improved: true, ..SHOWING };
        for now in [SHOWING, PAUSED, BLANK, improved] {
            assert_eq!(Phase::Failed.next(&now), Next::Wait);
            assert!(Phase::Failed.gives_snapshots(&now));
            assert!(!Phase::Failed.is_owed_a_picture(&now));
        }
        for with_sampler in [false, true] {
            assert_eq!(Phase::Failed.after_improvement(with_sampler, false), Phase::Failed);
        }
    }

    #[test]
    fn snapshots_never_mix_two_samplers() {
        assert!(Phase::Settled.gives_snapshots(&SHOWING));
        assert!(!Phase::Settled.gives_snapshots(&BLANK));
        for phase in [Phase::Provisional, Phase::Holding] {
            assert!(phase.awaits_sampler() && !phase.gives_snapshots(&SHOWING));
            assert!(phase.gives_snapshots(&PAUSED), "it may stay paused for good");
        }
    }

    #[test]
    fn the_next_request_waits_for_the_first_picture_of_one_that_samples() {
        for phase in [Phase::Provisional, Phase::Settled] {
            assert!(phase.is_owed_a_picture(&BLANK) && !phase.is_owed_a_picture(&SHOWING));
        }
        assert!(!Phase::Holding.is_owed_a_picture(&BLANK), "it might wait forever");
    }

    #[test]
    fn pictures_come_when_due_and_once_at_the_limit() {
        assert!(SHOWING.shows(true) && !SHOWING.shows(false));
        assert!(!BLANK.shows(true) && !Progress { caught_up: false, ..SHOWING }.shows(true));
        let finished = Progress { finished: true, caught_up: false, ..SHOWING };
        assert!(finished.may_show(), "more paths than this it will not get");
        assert!(finished.shows(false) && !Progress { final_shown: true, ..finished }.shows(false));
    }
}
