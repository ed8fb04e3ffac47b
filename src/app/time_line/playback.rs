//! Playback: which frame is shown at which time. Pure logic, without a clock of its own.

use std::time::{Duration, Instant};

/// Frames that are played one after the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Playback {
    frame: i32,
    /// When the frame was first shown; `None` before that.
    since: Option<Instant>,
}

/// The pace of a playback and its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// Frames per second.
    pub(super) fps: f64,
    /// First and last frame.
    pub(super) range: [i32; 2],
    /// Whether the first frame follows the last.
    pub(super) loops: bool,
}

/// The next thing to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tick {
    /// Show this frame, and look again after so much time.
    Show(i32, Duration),
    /// Render this frame, which has no picture yet.
    Render(i32),
    /// Stop at this frame, the last.
    End(i32),
}

impl Playback {
    /// Begins at `frame`.
    pub(super) fn new(frame: i32) -> Self {
        Self { frame, since: None }
    }

    /// The step due at `now`, where `is_there` says which frames have a picture. A frame is shown
    /// for its time, and those that came too late are passed over; none is passed over that has no
    /// picture.
    pub(super) fn tick(
        &mut self,
        now: Instant,
        pace: Pace,
        is_there: impl Fn(i32) -> bool,
    ) -> Tick {
        let time = Duration::from_secs_f64(1.0 / pace.fps.max(1e-3));
        let [first, last] = pace.range;
        if !(first..=last).contains(&self.frame) {
            *self = Self::new(first);
        }
        let frames = i64::from(last) - i64::from(first) + 1;
        // One round at most, after a long pause.
        for _ in 0..frames {
            if !is_there(self.frame) {
                self.since = None;
                return Tick::Render(self.frame);
            }
            let since = *self.since.get_or_insert(now);
            let shown = now.saturating_duration_since(since);
            if shown < time {
                return Tick::Show(self.frame, time - shown);
            }
            if self.frame >= last && !pace.loops {
                return Tick::End(last);
            }
            self.frame = if self.frame >= last { first } else { self.frame + 1 };
            self.since = Some(since + time);
        }
        self.since = Some(now);
        Tick::Show(self.frame, time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PACE: Pace = Pace { fps: 10.0, range: [1, 4], loops: true };

    fn ms(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    #[test]
    fn frames_keep_the_pace_of_the_scene() {
        let start = Instant::now();
        let mut playback = Playback::new(3);
        let mut at = |milliseconds| playback.tick(start + ms(milliseconds), PACE, |_| true);
        assert_eq!(at(0), Tick::Show(3, ms(100)));
        assert_eq!(at(60), Tick::Show(3, ms(40)));
        assert_eq!(at(130), Tick::Show(4, ms(70)), "late by 30 ms, which the next makes up for");
        assert_eq!(at(200), Tick::Show(1, ms(100)), "around");
        assert_eq!(at(450), Tick::Show(3, ms(50)), "one is passed over");
        assert!(matches!(at(60_000), Tick::Show(..)));
    }

    #[test]
    fn frames_without_a_picture_are_waited_for() {
        let start = Instant::now();
        let mut playback = Playback::new(1);
        assert_eq!(playback.tick(start, PACE, |_| false), Tick::Render(1));
        let now = start + ms(5000);
        assert_eq!(playback.tick(now, PACE, |frame| frame == 1), Tick::Show(1, ms(100)));
        let now = now + ms(100);
        assert_eq!(playback.tick(now, PACE, |frame| frame == 1), Tick::Render(2));
    }

    #[test]
    fn without_a_loop_it_ends_at_the_last_frame() {
        let start = Instant::now();
        let pace = Pace { loops: false, ..PACE };
        let mut playback = Playback::new(4);
        assert_eq!(playback.tick(start, pace, |_| true), Tick::Show(4, ms(100)));
        assert_eq!(playback.tick(start + ms(100), pace, |_| true), Tick::End(4));
        let mut astray = Playback::new(77);
        assert_eq!(astray.tick(start, pace, |_| true), Tick::Show(1, ms(100)));
    }
}
