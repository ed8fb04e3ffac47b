//! Frames on the command line: `--frames A-BxN`, and a file for each by the place for its number in
//! an output's name.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::exit::Refusal;
use crate::error::Error;
use crate::scene::sequence::Pattern;
use crate::scene::settings::MAX_FRAME;

/// Frames from a first to a last one in equal steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameList {
    first: i32,
    last: i32,
    step: u32,
}

impl FrameList {
    /// The frames in their order.
    pub fn iter(self) -> impl Iterator<Item = i32> {
        (self.first..=self.last).step_by(self.step as usize)
    }

    /// Whether there is more than one frame.
    pub fn has_several(self) -> bool {
        self.iter().nth(1).is_some()
    }
}

impl FromStr for FrameList {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let usage = || format!("\"{text}\" is no list of frames; write A-B, A-BxN or one number");
        let (range, step) = text.split_once('x').unwrap_or((text, "1"));
        // A minus in front belongs to the number.
        let dash = range.char_indices().skip(1).find(|(_, letter)| *letter == '-');
        let (first, last) = match dash {
            Some((at, _)) => (&range[..at], &range[at + 1..]),
            None => (range, range),
        };
        let number = |text: &str| text.parse::<i32>().map_err(|_| usage());
        let (first, last) = (number(first)?, number(last)?);
        let step = step.parse::<u32>().map_err(|_| usage())?;
        if step == 0 {
            return Err("the step between frames is 1 or more".to_owned());
        }
        if first > last {
            return Err(format!("the first frame, {first}, comes after the last, {last}"));
        }
        if first < -MAX_FRAME || last > MAX_FRAME {
            return Err(format!("frames lie between -{MAX_FRAME} and {MAX_FRAME}"));
        }
        Ok(Self { first, last, step })
    }
}

/// The path with the number of a frame in its place, `####` or `%04d`, if it has one.
pub fn path_of_frame(path: &Path, frame: i32) -> PathBuf {
    let pattern = path.to_str().and_then(Pattern::spelled);
    pattern.map_or_else(|| path.to_owned(), |pattern| pattern.file(frame))
}

/// Refuses a file that each frame would replace.
pub fn refuse_one_file_for_all(option: &str, path: &Path) -> Result<(), Refusal> {
    if path.to_str().and_then(Pattern::spelled).is_some() {
        return Ok(());
    }
    let reason = format!(
        "{option} needs a place for the number of the frame, such as out.####.exr: each frame \
         would replace the one before"
    );
    Err(Refusal::usage(Error::invalid(path.display().to_string(), "", reason)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_ranges_with_steps() {
        let frames = |text: &str| text.parse::<FrameList>().map(|list| list.iter().collect());
        let some = |numbers: &[i32]| Ok::<Vec<i32>, String>(numbers.to_vec());
        assert_eq!(frames("7"), some(&[7]));
        assert_eq!(frames("1-3"), some(&[1, 2, 3]));
        assert_eq!(frames("1-8x3"), some(&[1, 4, 7]));
        assert_eq!(frames("-2-1"), some(&[-2, -1, 0, 1]));
        assert_eq!(frames("-2--1"), some(&[-2, -1]));
        for wrong in ["", "a", "1-", "3-1", "1-3x0", "1-3x", "1-99999999", "-"] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
        assert!(!"1-3x3".parse::<FrameList>().unwrap().has_several());
    }

    #[test]
    fn the_number_takes_its_place_in_the_name() {
        let path = |name: &str| path_of_frame(Path::new(name), 12);
        assert_eq!(path("a/out.####.exr"), Path::new("a/out.0012.exr"));
        assert_eq!(path("out.%03d.png"), Path::new("out.012.png"));
        assert_eq!(path("out.exr"), Path::new("out.exr"));
    }
}
