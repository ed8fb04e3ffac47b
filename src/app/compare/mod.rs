//! Two strategies on one scene, or a snapshot and the live picture, side by side, and errors
//! against a reference.
//!
//! - `state`: all of it; `second_side`: the render of the second strategy and what is shown of
//!   both.
//! - `reference`: the reference and the errors against it; `measure`: the kinds of errors.
//! - `maps`: differences, noise and errors as pictures; `region_figures`: figures of a region.
//! - `panel`, `figures`, `noise_plot`: the panel of a comparison with its tables and its plot.
//! - `rows`, `marks`: rows below the picture, and what is drawn over it.
//! - `report`: sentences and tables for a file.

pub mod figures;
pub mod maps;
pub mod marks;
pub mod measure;
pub mod noise_plot;
pub mod panel;
pub mod reference;
pub mod region_figures;
pub mod report;
pub mod rows;
pub mod second_side;
pub mod state;
