//! The message about a path that failed.

use crate::render::Failure;

/// A failure, and the command that follows the same path in the scene of these arguments.
pub fn in_words(failure: &Failure, scene: &str) -> String {
    match failure.replay_options() {
        Some(path) => format!("{failure} (`flambeau replay {scene} {path}` follows that path)"),
        None => failure.to_string(),
    }
}
