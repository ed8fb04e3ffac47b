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

use arrows::Arrows;
use modules::Package;

/// The package under test.
fn package() -> Package {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    Package::read(&source::read(root, &source::FOLDERS).unwrap())
}

fn report(package: &Package, arrows: &Arrows) {
    if std::env::var_os("FLAMBEAU_ROOMS_REPORT").is_some() {
        println!("files of tests alone, left out: {:#?}", package.test_files());
        for ((from, to), names) in arrows {
            println!("{}", circles::arrow(from, to, names));
        }
    }
}

#[test]
fn every_file_is_read() {
    let package = package();
    assert!(package.files().contains("src/transport/path.rs"), "the test looks in the wrong place");
    assert!(package.faults.is_empty(), "{}", package.faults.join("\n"));
}

#[test]
fn no_file_stands_in_a_circle() {
    let package = package();
    let arrows = arrows::of(&package);
    report(&package, &arrows);
    let circles = circles::of(&arrows);
    let words: Vec<_> = circles.iter().map(|circle| circles::describe(circle, &arrows)).collect();
    assert!(circles.is_empty(), "{} circles\n{}", circles.len(), words.join("\n"));
}

#[test]
fn arrows_run_down_the_order_of_the_rooms() {
    let package = package();
    let arrows = arrows::of(&package);
    let orders = tables::ORDERS.iter();
    let faults: Vec<_> = orders.flat_map(|order| order.faults(package.files(), &arrows)).collect();
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
