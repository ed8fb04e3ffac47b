//! Two sessions that share the machine in time slices: the one that has had least is next.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::render::turns::{self, Share, Usage};

/// Time slices of two sessions.
#[derive(Debug, Default)]
pub struct Sharing {
    state: Mutex<State>,
}

/// The shared state of both sides.
#[derive(Debug, Default)]
struct State {
    usages: [Usage; 2],
    /// The side at work.
    working: Option<usize>,
    share: Share,
}

/// The token by which one of two sessions asks for a time slice.
#[derive(Clone, Debug)]
pub struct TurnToken {
    sharing: Arc<Sharing>,
    side: usize,
}

impl Sharing {
    /// A token for each side. A side does not count until it asks for a time slice.
    pub fn tokens() -> [TurnToken; 2] {
        let sharing = Arc::new(Self::default());
        sharing.state().usages.iter_mut().for_each(|usage| usage.closed = true);
        [0, 1].map(|side| TurnToken { sharing: sharing.clone(), side })
    }

    /// The state, also after a panic of the other side: it is sound after every statement.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl TurnToken {
    /// Sets what both sides get equal shares of from now on.
    pub fn set_share(&self, share: Share) {
        self.sharing.state().share = share;
    }

    /// Asks for a time slice with the usage of the side so far, after which [`TurnToken::end`] must
    /// follow; false while the other side is next or still at work.
    pub(super) fn begin(&self, usage: Usage) -> bool {
        let mut state = self.sharing.state();
        state.usages[self.side] = Usage { closed: false, ..usage };
        let free = state.working.is_none_or(|side| side == self.side);
        let mine = free && turns::next(&state.usages, state.share) == Some(self.side);
        if mine {
            state.working = Some(self.side);
        }
        mine
    }

    /// Ends a time slice with the usage of the side so far.
    pub(super) fn end(&self, usage: Usage) {
        let mut state = self.sharing.state();
        state.usages[self.side] = usage;
        if state.working == Some(self.side) {
            state.working = None;
        }
    }

    /// Leaves: the side gets no time slice until it asks again.
    pub(super) fn leave(&self) {
        let mut state = self.sharing.state();
        state.usages[self.side].closed = true;
        if state.working == Some(self.side) {
            state.working = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn had(cpu_seconds: f64) -> Usage {
        Usage { cpu_seconds, ..Usage::default() }
    }

    #[test]
    fn the_side_behind_has_its_turn_and_the_other_waits() {
        let [a, b] = Sharing::tokens();
        assert!(b.begin(had(3.0)), "alone, whatever it has had");
        assert!(!a.begin(had(0.0)), "the other is at work");
        b.end(had(3.5));
        assert!(!b.begin(had(3.5)), "the other is behind");
        assert!(a.begin(had(0.0)));
        a.end(had(4.0));
        assert!(!a.begin(had(4.0)) && b.begin(had(3.5)));
        b.leave();
        assert!(a.begin(had(4.0)), "nobody else wants it");
    }

    #[test]
    fn equal_samples_are_another_share() {
        let [a, b] = Sharing::tokens();
        a.set_share(Share::Samples);
        let usage = |cpu_seconds, samples| Usage { cpu_seconds, samples, closed: false };
        assert!(b.begin(usage(1.0, 8.0)));
        b.end(usage(2.0, 8.0));
        assert!(a.begin(usage(9.0, 4.0)), "fewer samples, more time");
    }
}
