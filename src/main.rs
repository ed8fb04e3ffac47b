//! The program: everything is in the library.

fn main() -> std::process::ExitCode {
    flambeau::cli::run()
}
