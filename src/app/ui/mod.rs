//! What every panel is made of: theme, widgets, sections, notices, words.

pub mod chooser;
pub mod notices;
pub mod sections;
pub mod theme;
pub mod widgets;
pub mod words;
