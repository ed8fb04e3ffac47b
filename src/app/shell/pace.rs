//! The time from frame to frame.

use std::time::{Duration, Instant};

/// Limits the frame rate where drawing frames takes the cores from the render.
#[derive(Debug)]
pub struct FramePace {
    /// Shortest time from frame to frame; `None`: no limit.
    shortest: Option<Duration>,
    /// Time at which the last frame began.
    last: Option<Instant>,
}

impl FramePace {
    /// A pace with at least `shortest` from frame to frame.
    pub fn new(shortest: Option<Duration>) -> Self {
        Self { shortest, last: None }
    }

    /// Waits until the next frame may begin.
    pub fn keep(&mut self) {
        if let (Some(shortest), Some(last)) = (self.shortest, self.last) {
            std::thread::sleep(shortest.saturating_sub(last.elapsed()));
        }
        self.last = Some(Instant::now());
    }
}
