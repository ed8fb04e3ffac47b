//! Motion of a camera while the shutter is open.

use super::view::{Frame, View};

/// Views of a moving camera over the time that the shutter is open, piecewise linear between
/// moments and held beyond them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Times in seconds after that of the frame, ascending, and the views then.
    moments: Vec<(f32, View)>,
    open: f32,
}

impl Track {
    /// A track of `moments`: seconds after the time of the frame, ascending, with the views then.
    /// The shutter is `open` for so many seconds, half of them before the frame. A camera with the
    /// same view at all moments stands still.
    pub fn new(moments: Vec<(f32, View)>, open: f32) -> Self {
        let moves = moments.windows(2).any(|pair| pair[0].1 != pair[1].1);
        if moves { Self { moments, open } } else { Self::default() }
    }

    /// Seconds in which the camera moves; 0 for one that stands still.
    pub(super) fn open_seconds(&self) -> f32 {
        self.open
    }

    /// Position and axes at `time`, in seconds after that of the frame; `None` for a camera that
    /// stands still, and at a moment at which it has no direction.
    pub(super) fn frame(&self, time: f32) -> Option<Frame> {
        let after = self.moments.partition_point(|(moment, _)| *moment <= time);
        let (first, last) = (self.moments.first()?, self.moments.last()?);
        let view = match (after.checked_sub(1).map(|n| &self.moments[n]), self.moments.get(after)) {
            (Some((start, before)), Some((end, then))) => {
                before.lerp(then, (time - start) / (end - start))
            }
            (None, _) => first.1,
            (_, None) => last.1,
        };
        view.frame()
    }
}
