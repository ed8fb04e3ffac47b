//! Guesses in words.

/// The subject of a guess.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum About {
    /// The axis of the file that points up.
    UpAxis,
    /// The grid that is the density, and how thick it is.
    Density,
    /// The grid that emits, and how.
    Emission,
    /// The grids that a volume moves by.
    Velocity,
    /// The light on a volume that emits none.
    Light,
    /// The frames of a sequence.
    Sequence,
    /// The part of the volume that the camera frames.
    Framing,
    /// The place that a volume far from the origin was moved to.
    Placement,
    /// A grid that could not be used.
    LeftOut,
}

/// A guess in words, or a fact about the file that decided one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Subject of the note.
    pub about: About,
    /// The guess itself.
    pub text: String,
}

impl Note {
    /// A guess about something.
    pub(in crate::scene) fn new(about: About, text: impl Into<String>) -> Self {
        Self { about, text: text.into() }
    }
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.about {
            About::Framing | About::LeftOut => f.write_str(&self.text),
            _ => write!(f, "guessed: {}", self.text),
        }
    }
}
