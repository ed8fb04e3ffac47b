//! Two sessions that share the machine: one works at a time, the one that has had least.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::render::turns::{self, Share, Usage};

/// What two sessions have had of the machine.
#[derive(Debug, Default)]
pub struct Sharing {
    desk: Mutex<Desk>,
}

#[derive(Debug, Default)]
struct Desk {
    accounts: [Usage; 2],
    /// The side at work.
    working: Option<usize>,
    share: Share,
}

/// One side's place.
#[derive(Clone, Debug)]
pub struct Seat {
    sharing: Arc<Sharing>,
    side: usize,
}

impl Sharing {
    /// Two seats. Neither side counts until it asks for a turn.
    pub fn seats() -> [Seat; 2] {
        let sharing = Arc::new(Self::default());
        sharing.desk().accounts.iter_mut().for_each(|account| account.closed = true);
        [0, 1].map(|side| Seat { sharing: sharing.clone(), side })
    }

    /// The desk, also after a panic of the other side: it is sound after every statement.
    fn desk(&self) -> MutexGuard<'_, Desk> {
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Seat {
    /// What both sides get equal shares of from now on.
    pub fn set_share(&self, share: Share) {
        self.sharing.desk().share = share;
    }

    /// Asks for a turn with what the side has had so far, after which [`Seat::end`] must follow;
    /// false while it is the other's, or the other is still at its own.
    pub(super) fn begin(&self, account: Usage) -> bool {
        let mut desk = self.sharing.desk();
        desk.accounts[self.side] = Usage { closed: false, ..account };
        let free = desk.working.is_none_or(|side| side == self.side);
        let mine = free && turns::next(&desk.accounts, desk.share) == Some(self.side);
        if mine {
            desk.working = Some(self.side);
        }
        mine
    }

    /// Ends a turn with what the side has had so far.
    pub(super) fn end(&self, account: Usage) {
        let mut desk = self.sharing.desk();
        desk.accounts[self.side] = account;
        if desk.working == Some(self.side) {
            desk.working = None;
        }
    }

    /// Wants no turn until it asks again.
    pub(super) fn leave(&self) {
        let mut desk = self.sharing.desk();
        desk.accounts[self.side].closed = true;
        if desk.working == Some(self.side) {
            desk.working = None;
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
        let [a, b] = Sharing::seats();
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
        let [a, b] = Sharing::seats();
        a.set_share(Share::Samples);
        let account = |cpu_seconds, samples| Usage { cpu_seconds, samples, closed: false };
        assert!(b.begin(account(1.0, 8.0)));
        b.end(account(2.0, 8.0));
        assert!(a.begin(account(9.0, 4.0)), "fewer samples, more time");
    }
}
