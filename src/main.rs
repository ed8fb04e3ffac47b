fn main() {
    if let Err(e) = flambeau::app::run(std::env::args().nth(1)) { eprintln!("{e}"); std::process::exit(1); }
}
