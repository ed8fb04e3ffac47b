//! `flambeau keys`: every key of the scene file.

use super::console::print;
use super::exit::{Exit, Refusal};
use crate::error::Error;
use crate::scene::keys::{Key, all};

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Print them as JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<Exit, Refusal> {
    let text = if arguments.json {
        let json = serde_json::to_string_pretty(all());
        json.map_err(|e| Error::invalid("keys", "", e.to_string()))? + "\n"
    } else {
        all().iter().map(describe).collect()
    };
    print(&text)?;
    Ok(Exit::Done)
}

/// A key in two or three lines: what may be written, what it is for, and when it applies.
fn describe(key: &Key) -> String {
    let mut facts = vec![key.kind.clone()];
    facts.extend(key.unit.clone());
    facts.extend(key.range.clone());
    facts.extend(key.default.as_ref().map(|default| format!("default {default}")));
    facts.extend(key.only.as_ref().map(|only| format!("with {only}")));
    format!("{}\n    {}\n    {}\n", key.path, facts.join(" · "), key.help)
}
