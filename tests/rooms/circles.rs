//! Circles: files that take names from each other, straight or by way of others.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use crate::arrows::{Arrows, Names, Use};

/// The circles among arrows, each with its files, in the order of their names.
pub fn of(arrows: &Arrows) -> Vec<BTreeSet<&str>> {
    let mut targets: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (from, to) in arrows.keys() {
        targets.entry(from).or_default().insert(to);
    }
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        targets.keys().map(|file| (*file, reachable(&targets, file))).collect();
    let mut circles: BTreeSet<BTreeSet<&str>> = BTreeSet::new();
    for (file, below) in reached.iter().filter(|(file, below)| below.contains(*file)) {
        let back = |other: &&&str| reached.get(*other).is_some_and(|below| below.contains(file));
        circles.insert(below.iter().filter(back).copied().collect());
    }
    circles.into_iter().collect()
}

fn reachable<'a>(targets: &BTreeMap<&'a str, BTreeSet<&'a str>>, from: &str) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut waiting: Vec<&str> = targets.get(from).into_iter().flatten().copied().collect();
    while let Some(file) = waiting.pop() {
        if reached.insert(file) {
            waiting.extend(targets.get(file).into_iter().flatten());
        }
    }
    reached
}

/// A circle in words: its arrows, each with the names that it takes and their lines.
pub fn describe(circle: &BTreeSet<&str>, arrows: &Arrows) -> String {
    let mut text = format!("circle of {} files:\n", circle.len());
    let within = |(from, to): &(String, String)| {
        circle.contains(from.as_str()) && circle.contains(to.as_str())
    };
    for ((from, to), names) in arrows.iter().filter(|(ends, _)| within(ends)) {
        let _ = writeln!(text, "  {}", arrow(from, to, names));
    }
    text
}

/// An arrow in words.
pub fn arrow(from: &str, to: &str, names: &Names) -> String {
    let word = |(name, taken): (&String, &Use)| {
        let way = if taken.reexport { ", handed on" } else { "" };
        format!("{name} (line {}{way})", taken.line)
    };
    let names: Vec<_> = names.iter().map(word).collect();
    format!("{from} → {to}: {}", names.join(", "))
}
