//! The rule by which renders that share one machine take turns: pure bookkeeping, no threads and no
//! clocks.
//!
//! The next piece of work goes to the side that has had least so far. A piece never lasts longer
//! than the schedule lets it, so sides are never further apart than one piece of one of them.

/// The use that one side has made of the machine so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Usage {
    /// CPU time of the sampling threads, in seconds.
    pub cpu_seconds: f64,
    /// Mean number of samples of a pixel.
    pub samples: f64,
    /// Whether the side takes no more slices: its limit is reached, or it has failed.
    pub closed: bool,
}

/// The quantity that the sides get equal shares of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Share {
    /// CPU time: which side makes more of it?
    #[default]
    CpuTime,
    /// Samples per pixel: which side makes more of them?
    Samples,
}

impl Usage {
    fn had(&self, share: Share) -> f64 {
        match share {
            Share::CpuTime => self.cpu_seconds,
            Share::Samples => self.samples,
        }
    }
}

/// The side that gets the next time slice: of those not closed the one that has had least, of
/// several the first. `None` when all are closed.
pub fn next(usages: &[Usage], share: Share) -> Option<usize> {
    let open = usages.iter().enumerate().filter(|(_, usage)| !usage.closed);
    open.min_by(|(_, a), (_, b)| a.had(share).total_cmp(&b.had(share))).map(|(side, _)| side)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives out time slices of `pieces` (seconds, samples) a side until `turns` are over.
    fn play(pieces: [(f64, f64); 2], share: Share, turns: usize) -> [Usage; 2] {
        let mut usages = [Usage::default(); 2];
        for _ in 0..turns {
            let side = next(&usages, share).unwrap();
            usages[side].cpu_seconds += pieces[side].0;
            usages[side].samples += pieces[side].1;
        }
        usages
    }

    #[test]
    fn sides_stay_within_one_piece_of_each_other() {
        let pieces = [(0.1, 8.0), (0.37, 1.0)];
        for turns in 1..200 {
            let [a, b] = play(pieces, Share::CpuTime, turns);
            assert!((a.cpu_seconds - b.cpu_seconds).abs() <= 0.37 + 1e-9, "{turns} turns");
            let [a, b] = play(pieces, Share::Samples, turns);
            assert!((a.samples - b.samples).abs() <= 8.0 + 1e-9, "{turns} turns");
        }
    }

    /// Many sides, some of which end early, stay as close.
    #[test]
    fn many_sides_stay_within_the_longest_piece_of_each_other() {
        let pieces = [0.02, 0.31, 0.07, 0.11, 0.05, 0.19, 0.03, 0.23, 0.13, 0.017, 0.29, 0.041];
        let mut usages = [Usage::default(); 12];
        for _ in 0..2000 {
            let side = next(&usages, Share::CpuTime).unwrap();
            usages[side].cpu_seconds += pieces[side];
            usages[side].closed = side % 4 == 1 && usages[side].cpu_seconds > 3.0;
            let open = || usages.iter().filter(|usage| !usage.closed);
            let had = || open().map(|usage| usage.cpu_seconds);
            let [least, most] = [had().fold(f64::MAX, f64::min), had().fold(0.0, f64::max)];
            assert!(most - least <= 0.31 + 1e-9, "{usages:?}");
        }
        assert!(usages.iter().filter(|usage| usage.closed).count() == 3);
    }

    #[test]
    fn the_first_begins_and_equal_sides_alternate() {
        let mut usages = [Usage::default(); 2];
        let mut order = Vec::new();
        for _ in 0..6 {
            let side = next(&usages, Share::Samples).unwrap();
            usages[side].samples += 1.0;
            order.push(side);
        }
        assert_eq!(order, [0, 1, 0, 1, 0, 1]);
    }

    #[test]
    fn closed_sides_get_no_turn() {
        let open = Usage { cpu_seconds: 9.0, samples: 9.0, closed: false };
        let closed = Usage { closed: true, ..Usage::default() };
        assert_eq!(next(&[closed, open], Share::CpuTime), Some(1));
        assert_eq!(next(&[closed, closed], Share::CpuTime), None);
        assert_eq!(next(&[], Share::Samples), None);
    }
}
