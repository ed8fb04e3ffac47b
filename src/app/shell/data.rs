//! The folder of what outlasts a run.

use std::path::PathBuf;

/// The variable of the environment that names it.
const DATA: &str = "FLAMBEAU_DATA";

/// `chosen`, or what `FLAMBEAU_DATA` says, or where the system keeps the data of the user's
/// programs; `None` where there is no such place.
pub fn folder(chosen: Option<PathBuf>) -> Option<PathBuf> {
    let named = || std::env::var_os(DATA).filter(|name| !name.is_empty()).map(PathBuf::from);
    chosen.or_else(named).or_else(|| eframe::storage_dir("flambeau"))
}
