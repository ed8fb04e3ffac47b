//! The command line: one file a command. `main` parses, runs and reports.
//!
//! - `render`, `compare`, `sweep`, `info`, `keys`, `replay`: the commands.
//! - `scene_source`: the scene that a command works on; `frames`: its frames; `values`: values of
//!   options.
//! - `outputs`, `clashes`, `rescue`: the files written, which replace no input and are never lost.
//! - `snapshot_header`, `stats`, `speed_up_row`: contents of these files.
//! - `console`, `interrupt`, `exit`, `failed_path`: messages, Ctrl-C, exit codes.
//! - [`cpu_time`]: CPU time of this process.

mod clashes;
mod compare;
mod console;
pub mod cpu_time;
mod exit;
mod failed_path;
mod frames;
mod info;
mod interrupt;
mod keys;
mod outputs;
mod render;
mod replay;
mod rescue;
mod scene_source;
mod snapshot_header;
mod speed_up_row;
mod stats;
mod sweep;
mod values;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use console::warn;
use exit::{Exit, Refusal};

use crate::error::Error;

/// Interactive, progressive preview of fire, smoke, fog and cloud.
#[derive(Debug, Parser)]
#[command(name = "flambeau", version, args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    /// A scene file (.toml), a volume (.vdb, .nvdb), a folder or pattern (fire_####.vdb) of
    /// numbered ones, a snapshot (.exr) to go on from, or `builtin:NAME` to open in the window;
    /// without one the default scene.
    #[arg(value_name = "SCENE|VOLUME", value_parser = values::file_name())]
    scene: Option<String>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render without a window.
    Render(Box<render::Arguments>),
    /// Hold two sampling strategies against each other: noise, cost and the ratio between them.
    Compare(Box<compare::Arguments>),
    /// Try every strategy on a scene for a few seconds each, and rank them.
    ///
    /// Says which to leave on, what each toggle brings alone and what is lost without it. The finer
    /// choices of --set hold for all. Unless --size is given, the film is small enough to be
    /// measured in seconds.
    Sweep(Box<sweep::Arguments>),
    /// Print every key of the scene file: type, unit, default, range, help.
    Keys(keys::Arguments),
    /// Say what is in a volume, a snapshot or a scene.
    Info(info::Arguments),
    /// Follow one path and print it vertex by vertex.
    Replay(replay::Arguments),
}

/// Runs the program on the arguments of the process.
pub fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version come this way too, and are no errors. Where the terminal is gone
            // there is nobody to tell.
            let _ = error.print();
            let exit = if error.use_stderr() { Exit::WrongUsage } else { Exit::Done };
            return ExitCode::from(exit as u8);
        }
    };
    let result = match arguments.command {
        Some(Command::Render(arguments)) => render::run(&arguments),
        Some(Command::Compare(arguments)) => compare::run(&arguments),
        Some(Command::Sweep(arguments)) => sweep::run(&arguments),
        Some(Command::Keys(arguments)) => keys::run(&arguments),
        Some(Command::Info(arguments)) => info::run(&arguments),
        Some(Command::Replay(arguments)) => replay::run(&arguments),
        None => open_window(arguments.scene),
    };
    let exit = result.unwrap_or_else(|refusal| {
        match refusal.error {
            Error::Cancelled => warn("interrupted before the first sample; nothing was written"),
            error => warn(&error.to_string()),
        }
        refusal.exit
    });
    ExitCode::from(exit as u8)
}

#[cfg(feature = "gui")]
fn open_window(scene: Option<String>) -> Result<Exit, Refusal> {
    crate::app::run(scene)?;
    Ok(Exit::Done)
}

#[cfg(not(feature = "gui"))]
fn open_window(_: Option<String>) -> Result<Exit, Refusal> {
    warn(
        "this build has no window; use `flambeau render SCENE -o OUT.exr`, or build with the \
         feature `gui`",
    );
    Ok(Exit::WrongUsage)
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        super::Arguments::command().debug_assert();
    }
}
