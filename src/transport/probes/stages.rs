//! The numbers that all stages of placing probes share.

/// The seed of all random numbers of placing and learning: fixed, and one that no picture is likely
/// to use.
pub(in crate::transport) const SEED: u64 = 0x7072_6f62_6573_2e2e;
/// Part of the work that is done, about, once probes are placed.
pub(in crate::transport) const PLACED: f32 = 0.3;
/// Part of the work that is done, about, once caustics are found.
pub(in crate::transport) const CAUSTICS_FOUND: f32 = 0.4;
