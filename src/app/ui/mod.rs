//! Parts that every panel is made of.
//!
//! - `theme`: colors, spacing, type; `widgets`: rows of settings; `sections`: parts of the column.
//! - `chooser`: one of many by its name; `notices`: messages below the picture.
//! - `words`: samples, times and shares in words.

pub mod chooser;
pub mod notices;
pub mod sections;
pub mod theme;
pub mod widgets;
pub mod words;
