//! Two strategies on one scene, or a snapshot and the live picture, side by side: the second side, its
//! maps, the figures of both, the reference, and their panel.

pub mod figures;
pub mod maps;
pub mod measure;
pub mod noise_plot;
pub mod panel;
pub mod reference;
pub mod region_figures;
pub mod rows;
pub mod second_side;
