//! Small packages with a planted arrow or circle, each found, and innocent ones, which pass.

use crate::arrows::{self, Arrows};
use crate::circles;
use crate::modules::Package;
use crate::order::Order;
use crate::source::Sources;

/// A tower of stones that stands on `low`; `door` hands names on.
const FILES: [(&str, &str); 6] = [
    ("src/lib.rs", "pub mod door; pub mod high; pub mod low;"),
    ("src/door.rs", "pub use crate::high::{Tower, tower}; pub use crate::high;"),
    (
        "src/high.rs",
        "use crate::low::{Stone, sand::Grain};
         pub struct Tower(Stone, Grain);
         pub trait Tall {}
         pub fn tower() -> bool { true }",
    ),
    ("src/low/mod.rs", "pub mod sand; mod stone; pub use stone::Stone;"),
    ("src/low/stone.rs", "pub struct Stone;"),
    ("src/low/sand.rs", ""),
];

const ORDER: Order = Order { folder: "src", layers: &[&["low"], &["high"], &["door"], &["lib"]] };

/// Ways in which `low/sand.rs` can take a name from `high.rs`.
const ARROWS: [(&str, &str); 34] = [
    ("use", "use crate::high::Tower;"),
    ("use of a group", "use crate::{high::{self, Tower}};"),
    ("use with another name", "use crate::high::Tower as House;"),
    ("use by a visible name", "pub use crate::high::Tower;"),
    ("use in a block", "fn f() { use crate::high::Tower; }"),
    ("use in a macro", "macro_rules! m { () => { use crate::high::{Tall, Tower}; }; }"),
    ("type", "fn f(_: crate::high::Tower) {}"),
    ("argument of a type", "fn f(_: Vec<Option<crate::high::Tower>>) {}"),
    ("expression", "fn f() { crate::high::tower(); }"),
    ("associated function", "fn f() { crate::high::Tower::new(); }"),
    ("pattern", "fn f(t: T) { if let crate::high::Tower(..) = t {} }"),
    ("bound", "fn f<T: crate::high::Tall>() {}"),
    ("implemented trait", "impl crate::high::Tall for Grain {}"),
    ("qualified path", "fn f() { <u8 as crate::high::Tall>::up(); }"),
    ("super", "fn f(_: super::super::high::Tower) {}"),
    ("super of an inline module", "mod m { fn f(_: super::super::super::high::Tower) {} }"),
    ("self", "use crate::high; fn f(_: self::high::Tower) {}"),
    ("super with an imported name", "use crate::high; mod m { fn f(_: super::high::Tower) {} }"),
    ("imported module", "use crate::high; fn f(_: high::Tower) {}"),
    ("module imported by self", "use crate::high::{self}; fn f(_: high::Tower) {}"),
    ("imported module with another name", "use crate::high as h; fn f(_: h::Tower) {}"),
    ("imported parent", "use super::super::high::{self as h}; fn f(_: h::Tower) {}"),
    ("re-export", "fn f(_: crate::door::Tower) {}"),
    ("re-export of a function", "use crate::door; fn f() { door::tower(); }"),
    ("re-export of a module", "fn f(_: crate::door::high::Tower) {}"),
    ("glob", "use crate::high::*;"),
    ("glob of a re-export", "use crate::door::*; fn f(_: Tower) {}"),
    ("macro's argument", "fn f() { assert!(crate::high::tower()); }"),
    ("macro's argument, super", "fn f() { vec![super::super::high::Tower::new()]; }"),
    ("macro's argument, module", "use crate::high; fn f() { assert!(!high::tower()); }"),
    ("macro's body", "macro_rules! m { ($x:ident) => { $x($crate::high::tower()) }; }"),
    ("attribute", "#[derive(crate::high::Tall)] struct S;"),
    ("text of an attribute", "struct S { #[serde(default = \"crate::high::tower\")] x: u8 }"),
    ("code of a feature", "#[cfg(feature = \"gui\")] fn f(_: crate::high::Tower) {}"),
];

/// Code in `low/sand.rs` that takes nothing from `high.rs`.
const INNOCENT: [(&str, &str); 13] = [
    ("nothing", ""),
    ("a stone", "use super::Stone; fn f(_: Stone) {}"),
    ("a module without its items", "use crate::high;"),
    ("a module of tests", "#[cfg(test)] mod tests { use crate::high::Tower; }"),
    ("tests of a system", "#[cfg(all(test, unix))] mod tests { use crate::high::Tower; }"),
    ("a function of tests", "#[cfg(test)] fn f(_: crate::high::Tower) {}"),
    ("a method of tests", "impl G { #[cfg(test)] fn f(_: crate::high::Tower) {} }"),
    ("an import of tests", "#[cfg(test)] use crate::high::Tower;"),
    ("documentation", "/// See [`crate::high::Tower`].\nfn f() {}"),
    ("text", "const S: &str = \"crate::high::Tower\";"),
    ("another package", "use high::Tower; fn f(_: ::high::Tower) {}"),
    ("a field in a macro", "use crate::door::*; fn f(x: X) { vec![x.tower, x.tower()]; }"),
    ("a name of its own", "fn tower() {} fn f() { tower(); self::tower(); }"),
];

fn package(files: &[(&str, &str)]) -> Package {
    let owned = |(file, text): &(&str, &str)| ((*file).to_owned(), (*text).to_owned());
    Package::read(&files.iter().map(owned).collect::<Sources>())
}

/// The package of the tower with `planted` in `low/sand.rs`.
fn with(planted: &str) -> Package {
    let mut files = FILES;
    let sand = format!("pub struct Grain; {planted}");
    files[5].1 = &sand;
    package(&files)
}

fn ends(arrows: &Arrows) -> Vec<(&str, &str)> {
    arrows.keys().map(|(from, to)| (from.as_str(), to.as_str())).collect()
}

#[test]
fn a_planted_arrow_is_found_in_whatever_form() {
    for (form, planted) in ARROWS {
        let package = with(planted);
        assert!(package.faults.is_empty(), "{form}: {:?}", package.faults);
        let arrows = arrows::of(&package);
        let circles = circles::of(&arrows);
        assert_eq!(circles.len(), 1, "{form}: {arrows:?}");
        assert!(circles[0].iter().eq(&["src/high.rs", "src/low/sand.rs"]), "{form}: {circles:?}");
        let faults = ORDER.faults(package.files(), &arrows);
        let names_both = |fault: &String| fault.contains("src/low/sand.rs → src/high.rs");
        assert!(faults.len() == 1 && faults.iter().all(names_both), "{form}: {faults:?}");
    }
}

#[test]
fn innocent_code_passes() {
    for (form, planted) in INNOCENT {
        let package = with(planted);
        assert!(package.faults.is_empty(), "{form}: {:?}", package.faults);
        let arrows = arrows::of(&package);
        assert!(circles::of(&arrows).is_empty(), "{form}: {arrows:?}");
        assert_eq!(ORDER.faults(package.files(), &arrows), [""; 0], "{form}");
    }
}

#[test]
fn arrows_go_to_the_file_that_defines_the_name() {
    let arrows = arrows::of(&with(""));
    let expected = [
        ("src/door.rs", "src/high.rs"),
        ("src/high.rs", "src/low/sand.rs"),
        ("src/high.rs", "src/low/stone.rs"),
        ("src/low/mod.rs", "src/low/stone.rs"),
    ];
    assert_eq!(ends(&arrows), expected);
}

#[test]
fn a_child_and_its_parent_can_make_a_circle() {
    let lib = ("src/lib.rs", "mod parent;");
    let child = ("src/parent/child.rs", "use super::Size; pub fn grow(_: Size) {}");
    let asks = ("src/parent.rs", "mod child; pub struct Size; fn f() { child::grow(Size); }");
    let hands_on = ("src/parent.rs", "mod child; pub use child::grow; pub struct Size;");
    let declares = ("src/parent.rs", "pub mod child; pub struct Size;");
    for (parent, expected) in [(asks, 1), (hands_on, 1), (declares, 0)] {
        let arrows = arrows::of(&package(&[lib, parent, child]));
        assert_eq!(circles::of(&arrows).len(), expected, "{parent:?}: {arrows:?}");
    }
}

#[test]
fn a_macro_of_the_parent_is_taken_by_its_bare_name() {
    let files = [
        ("src/lib.rs", "mod parent;"),
        ("src/parent.rs", "macro_rules! make { () => {}; } mod child; fn f() { child::g(); }"),
        ("src/parent/child.rs", "make! {} pub fn g() {}"),
    ];
    assert_eq!(circles::of(&arrows::of(&package(&files))).len(), 1);
}

#[test]
fn a_long_circle_is_one_circle() {
    let files = [
        ("src/lib.rs", "mod a; mod b; mod c; mod d;"),
        ("src/a.rs", "pub fn f() { crate::b::f() }"),
        ("src/b.rs", "pub fn f() { crate::c::f() }"),
        ("src/c.rs", "pub fn f() { crate::a::f() }"),
        ("src/d.rs", "pub fn f() { crate::a::f() }"),
    ];
    let arrows = arrows::of(&package(&files));
    let circles = circles::of(&arrows);
    assert_eq!(circles.len(), 1);
    assert!(circles[0].iter().eq(&["src/a.rs", "src/b.rs", "src/c.rs"]), "{circles:?}");
    let words = circles::describe(&circles[0], &arrows);
    assert!(words.contains("src/c.rs → src/a.rs: f (line 1)"), "{words}");
}

#[test]
fn modules_are_followed_to_their_files() {
    let files = [
        ("src/lib.rs", "mod a; mod inline { mod b; } #[path = \"odd/c.rs\"] mod c;"),
        ("src/a/mod.rs", "mod deep; #[cfg(unix)] mod gated; #[cfg(test)] mod tests;"),
        ("src/a/deep.rs", "#[path = \"aside.rs\"] mod beside;"),
        ("src/a/aside.rs", ""),
        ("src/a/gated.rs", ""),
        ("src/a/tests.rs", ""),
        ("src/inline/b.rs", ""),
        ("src/odd/c.rs", "mod d;"),
        ("src/odd/d.rs", ""),
    ];
    let package = package(&files);
    assert_eq!(package.faults, [""; 0]);
    assert_eq!(package.files().len(), files.len() - 1);
    assert!(package.test_files().iter().eq(&["src/a/tests.rs"]));
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let files = [
        ("src/lib.rs", "mod missing; mod broken;"),
        ("src/broken.rs", "fn fn fn"),
        ("src/stray.rs", ""),
    ];
    let faults = package(&files).faults.join("\n");
    assert!(faults.contains("src/lib.rs: the module missing has no file"), "{faults}");
    assert!(faults.contains("src/broken.rs:1: "), "{faults}");
    assert!(faults.contains("src/stray.rs: no module declares this file"), "{faults}");
}

#[test]
fn benches_stand_on_the_library() {
    let files = [
        ("src/lib.rs", "pub mod low;"),
        ("src/low.rs", "pub struct Stone;"),
        ("benches/noise/main.rs", "mod rows; mod scenes; use flambeau::low::Stone;"),
        ("benches/noise/rows.rs", "use crate::scenes::Scene; pub struct Row;"),
        ("benches/noise/scenes.rs", "pub struct Scene(super::rows::Row);"),
        ("benches/single.rs", "fn main() { ::flambeau::low::Stone; }"),
    ];
    let arrows = arrows::of(&package(&files));
    let circles = circles::of(&arrows);
    assert_eq!(circles.len(), 1);
    assert!(circles[0].iter().eq(&["benches/noise/rows.rs", "benches/noise/scenes.rs"]));
    assert!(ends(&arrows).contains(&("benches/noise/main.rs", "src/low.rs")));
    assert!(ends(&arrows).contains(&("benches/single.rs", "src/low.rs")));
}

#[test]
fn an_order_names_every_file_once() {
    let package = with("");
    let arrows = arrows::of(&package);
    let faults = |layers: &[&[&str]]| {
        Order { folder: "src", layers }.faults(package.files(), &arrows).join("\n")
    };
    let missing = faults(&[&["low"], &["high"], &["lib"]]);
    assert_eq!(missing, "src/door.rs is in no layer of src");
    let gone = faults(&[&["low"], &["gone", "high"], &["door"], &["lib"]]);
    assert_eq!(gone, "src/gone is no file and no folder");
    let twice = faults(&[&["low"], &["high"], &["door"], &["lib", "low"]]);
    assert!(twice.contains("low stands twice in the order of src"), "{twice}");
}

#[test]
fn rooms_of_one_layer_take_nothing_from_each_other() {
    let package = with("");
    let order = Order { folder: "src", layers: &[&["high", "low"], &["door"], &["lib"]] };
    let faults = order.faults(package.files(), &arrows::of(&package));
    assert_eq!(faults.len(), 2, "{faults:?}");
    assert!(faults.iter().all(|fault| fault.starts_with("an arrow runs sideways: src/high.rs")));
}

#[test]
fn a_file_belongs_to_the_longest_name() {
    let layers: &[&[&str]] = &[&["low/sand"], &["low"]];
    let order = Order { folder: "src", layers };
    let rooms = ["src/low/sand.rs", "src/low/sand/dune.rs", "src/low/mod.rs", "src/lower.rs"];
    let found = rooms.map(|file| order.room(file));
    assert_eq!(found, [Some("low/sand"), Some("low/sand"), Some("low"), None]);
}
