//! The frames of the scene, and where the time line stands.

use std::time::{Duration, Instant};

use super::flipbook::{Flipbook, FramePictures, Take};
use super::playback::{Pace, Playback, Tick};
use crate::scene::Settings;
use crate::scene::sequence;
use crate::scene::settings::VolumeSettings;

/// Samples of a pixel from which on a frame belongs to the flipbook, at first.
const SAMPLES: u32 = 8;

/// The time line.
pub struct TimeLine {
    /// Pictures of frames that were rendered.
    pub flipbook: Flipbook,
    /// Samples of a pixel from which on a frame belongs to the flipbook.
    pub samples: u32,
    /// Whether the first frame follows the last.
    pub loops: bool,
    range: Option<[i32; 2]>,
    /// Settings of the present range, once it is known.
    ranged: Option<RangeSource>,
    playback: Option<Playback>,
    /// The frame of the flipbook that is shown while it plays.
    playhead: Option<i32>,
}

/// Settings that the range of frames was found for.
#[derive(Debug, PartialEq)]
struct RangeSource {
    volumes: Vec<VolumeSettings>,
    time_range: Option<[i32; 2]>,
    camera_keys: Option<[i32; 2]>,
}

/// A request of the playback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// Look again after so much time.
    Wait(Duration),
    /// The scene goes to this frame.
    GoTo(i32),
}

impl Default for TimeLine {
    fn default() -> Self {
        Self {
            flipbook: Flipbook::default(),
            samples: SAMPLES,
            loops: true,
            range: None,
            ranged: None,
            playback: None,
            playhead: None,
        }
    }
}

impl TimeLine {
    /// First and last frame; `None` for a scene of one frame.
    pub fn range(&self) -> Option<[i32; 2]> {
        self.range.filter(|[first, last]| first < last)
    }

    /// Looks for the frames on the disk again.
    pub fn look_again(&mut self) {
        self.ranged = None;
    }

    /// Brings the frames in line with the settings, and drops pictures of another take.
    pub fn update(&mut self, settings: &Settings, take: &Take) {
        let (time_range, camera_keys) = (settings.time.range, settings.camera.key_range());
        let is_known = self.ranged.as_ref().is_some_and(|known| {
            known.volumes == settings.volume
                && (known.time_range, known.camera_keys) == (time_range, camera_keys)
        });
        if !is_known {
            self.range = sequence::time_range(settings);
            let volumes = settings.volume.clone();
            self.ranged = Some(RangeSource { volumes, time_range, camera_keys });
        }
        self.flipbook.keep_only(take);
        if self.range().is_none() {
            self.stop();
        }
    }

    /// Keeps the pictures of a frame.
    pub fn keep(&mut self, frame: i32, pictures: FramePictures) {
        if self.range().is_some() {
            self.flipbook.keep(frame, pictures);
        }
    }

    /// Whether frames are played.
    pub fn is_playing(&self) -> bool {
        self.playback.is_some()
    }

    /// Plays from `frame`, from the beginning where that is the last one.
    pub fn play(&mut self, frame: i32) {
        if let Some([first, last]) = self.range() {
            let frame = if frame >= last { first } else { frame };
            self.playback = Some(Playback::new(frame));
        }
    }

    /// Ends the playback; the frame that was shown, if it was one of the flipbook.
    pub fn stop(&mut self) -> Option<i32> {
        self.playback = None;
        self.playhead.take()
    }

    /// The frame that is shown, where the scene stands at `frame`.
    pub fn shown(&self, frame: i32) -> i32 {
        self.playhead.unwrap_or(frame)
    }

    /// Whether a frame of the flipbook is shown in passing, and no other picture wanted.
    pub fn is_passing(&self) -> bool {
        self.playhead.is_some()
    }

    /// Goes on with the playback. `done` is the frame that the live picture shows with enough
    /// samples, also where the flipbook has no room for it.
    pub fn turn(&mut self, now: Instant, fps: f64, done: Option<i32>) -> Option<Turn> {
        let range = self.range()?;
        let playback = self.playback.as_mut()?;
        let pace = Pace { fps, range, loops: self.loops };
        let flipbook = &self.flipbook;
        let is_there = |frame| flipbook.get(frame).is_some() || done == Some(frame);
        Some(match playback.tick(now, pace, is_there) {
            Tick::Show(frame, wait) => {
                self.playhead = self.flipbook.get(frame).map(|_| frame);
                Turn::Wait(wait)
            }
            Tick::Render(frame) => {
                self.playhead = None;
                Turn::GoTo(frame)
            }
            Tick::End(frame) => {
                self.stop();
                Turn::GoTo(frame)
            }
        })
    }

    /// The frame so many `steps` from `frame`, around the ends.
    pub fn step(&self, frame: i32, steps: i32) -> Option<i32> {
        let [first, last] = self.range()?;
        let length = i64::from(last) - i64::from(first) + 1;
        let offset = i64::from(frame.clamp(first, last)) - i64::from(first) + i64::from(steps);
        Some((i64::from(first) + offset.rem_euclid(length)) as i32)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::UVec2;

    use super::*;
    use crate::app::document::Document;
    use crate::render::Picture;

    fn time_line() -> TimeLine {
        let mut document = Document::default();
        document.settings.time.range = Some([1, 3]);
        let mut time_line = TimeLine::default();
        time_line.update(&document.settings, &Take::new(&document, UVec2::ONE, None));
        time_line
    }

    #[test]
    fn a_scene_of_one_frame_has_no_time_line() {
        let document = Document::default();
        let mut time_line = TimeLine::default();
        time_line.update(&document.settings, &Take::new(&document, UVec2::ONE, None));
        assert_eq!((time_line.range(), time_line.step(1, 1)), (None, None));
        time_line.play(1);
        assert!(!time_line.is_playing());
    }

    #[test]
    fn steps_go_around_the_ends() {
        let time_line = time_line();
        for (frame, steps, next) in [(1, 1, 2), (3, 1, 1), (1, -1, 3), (9, 1, 1), (2, -7, 1)] {
            assert_eq!(time_line.step(frame, steps), Some(next), "{frame} {steps}");
        }
    }

    #[test]
    fn frames_are_rendered_once_and_then_shown() {
        let mut time_line = time_line();
        let now = Instant::now();
        time_line.play(3);
        assert_eq!(time_line.turn(now, 10.0, None), Some(Turn::GoTo(1)), "from the beginning");
        assert_eq!(time_line.shown(1), 1);
        let picture = || vec![Arc::new(Picture::default())];
        time_line.keep(1, picture());
        let wait = Turn::Wait(Duration::from_millis(100));
        assert_eq!(time_line.turn(now, 10.0, Some(1)), Some(wait));
        let now = now + Duration::from_millis(100);
        assert_eq!(time_line.turn(now, 10.0, Some(1)), Some(Turn::GoTo(2)));
        (2..=3).for_each(|frame| time_line.keep(frame, picture()));
        assert!(matches!(time_line.turn(now, 10.0, None), Some(Turn::Wait(_))));
        assert_eq!(time_line.shown(1), 2, "of the flipbook, wherever the scene stands");
        assert_eq!(time_line.stop(), Some(2));
        assert_eq!(time_line.turn(now, 10.0, None), None);
    }
}
