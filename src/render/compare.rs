//! Two films of one scene held against each other: which setting needs less time for the same
//! noise, by how much, how well that is known, and whether both show the same picture.
//!
//! All figures are read from the accumulators of the films and the CPU time spent on them, in one
//! pass over the pixels that costs about as much as reading both pictures. A stands for the first
//! film and B for the second.

mod agreement;
mod comparison;
mod history;
pub mod maps;
mod side_figures;
mod speed;
mod tally;

pub use agreement::{ALARM, Agreement, Difference, FEWEST_SAMPLES, Verdict};
pub use comparison::Comparison;
pub use history::NoiseHistory;
pub use side_figures::SideFigures;
pub use speed::SpeedUp;

#[cfg(test)]
mod tests;
