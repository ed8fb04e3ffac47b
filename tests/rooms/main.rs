//! The order of the rooms: which file may take names from which other, read from every path in
//! the code.
//!
//! The files are parsed as the compiler would find them, through `mod` and whatever `#[cfg]`
//! stands there; code of tests is left out. A path makes an arrow from the file that holds it to
//! the file that defines what it names, whatever imports, re-exports and globs lie between. Paths
//! in macros are found among the tokens. Methods called with a dot name no module and make no
//! arrow.
//!
//! `FLAMBEAU_ROOMS_REPORT=1 cargo test --test rooms -- --nocapture` prints every arrow.

mod arrows;
mod circles;
mod imports;
mod modules;
mod order;
mod planted;
mod resolve;
mod source;
mod tables;
mod tokens;
mod window;

use std::path::Path;
use std::sync::LazyLock;

use arrows::Arrows;
use modules::Package;

/// The package under test, read once.
static PLAN: LazyLock<Plan> = LazyLock::new(Plan::read);

/// Files and arrows of a package.
struct Plan {
    files: Vec<String>,
    faults: Vec<String>,
    arrows: Arrows,
}

impl Plan {
    fn read() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let package = Package::read(&source::read(root, &source::FOLDERS).unwrap());
        let files = package.files().into_iter().map(str::to_owned).collect();
        let plan = Self { files, arrows: arrows::of(&package), faults: package.faults.clone() };
        if std::env::var_os("FLAMBEAU_ROOMS_REPORT").is_some() {
            println!("files of tests alone, left out: {:#?}", package.test_files());
            for ((from, to), names) in &plan.arrows {
                println!("{}", circles::arrow(from, to, names));
            }
        }
        plan
    }
}

#[test]
fn every_file_is_read() {
    assert!(
        PLAN.files.iter().any(|file| file == "src/lib.rs"),
        "the test looks in the wrong place"
    );
    assert!(PLAN.faults.is_empty(), "\n{}", PLAN.faults.join("\n"));
}

#[test]
fn no_file_stands_in_a_circle() {
    let circles = circles::of(&PLAN.arrows);
    let words: Vec<_> =
        circles.iter().map(|circle| circles::describe(circle, &PLAN.arrows)).collect();
    assert!(circles.is_empty(), "{} circles\n{}", circles.len(), words.join("\n"));
}

#[test]
fn arrows_run_down_the_order_of_the_rooms() {
    let files = || PLAN.files.iter().map(String::as_str);
    let orders = tables::ORDERS.iter();
    let faults: Vec<_> = orders.flat_map(|order| order.faults(files(), &PLAN.arrows)).collect();
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
