//! Ends of commands: the exit code, and the error that prevented the work.

use crate::error::Error;

/// The exit code of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    Done = 0,
    Failed = 1,
    WrongUsage = 2,
    Interrupted = 130,
}

/// An error that prevented a command's work, with its exit code.
pub struct Refusal {
    /// The reason.
    pub error: Error,
    /// Exit code of the error.
    pub exit: Exit,
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        let exit = match error {
            Error::Cancelled => Exit::Interrupted,
            _ => Exit::Failed,
        };
        Self { error, exit }
    }
}

impl Refusal {
    /// A request that makes no sense, whatever the files hold.
    pub fn usage(error: Error) -> Self {
        Self { error, exit: Exit::WrongUsage }
    }
}
