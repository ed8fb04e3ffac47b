//! The tables of the benchmark.

/// A table of the benchmark: a kind of comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// Toggle upon toggle.
    Toggles,
    /// Modes of the majorant boost by their amounts.
    Modes,
    /// Strategies of distance sampling: null-collision sampling, probes, both.
    Distances,
    /// Estimators of transmittance, and trackers.
    Walks,
    /// The full preset against every combination of the toggles.
    NeverWorse,
}

impl Table {
    /// The table that a word of the command line asks for.
    pub fn named(word: &str) -> Option<Self> {
        match word {
            "modes" => Some(Self::Modes),
            "distances" => Some(Self::Distances),
            "walks" => Some(Self::Walks),
            "never-worse" => Some(Self::NeverWorse),
            _ => None,
        }
    }
}
