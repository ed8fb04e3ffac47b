//! The values of `--a` and `--b`: strategies in words.

use std::str::FromStr;

use crate::cli::values::quoted;
use crate::error::{Error, Result};
use crate::scene::{self, Overrides, Settings};
use crate::transport::strategy::Preset;

/// A preset, keys of the strategy, or several of them in their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StrategyChoice {
    text: String,
    /// Overrides of the strategy, as `--set` takes them.
    set: Vec<String>,
}

impl FromStr for StrategyChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let items: Vec<&str> = split(text).into_iter().map(str::trim).collect();
        let set = items.into_iter().map(assignment).collect::<Result<_, _>>()?;
        Ok(Self { text: text.trim().to_owned(), set })
    }
}

impl StrategyChoice {
    /// Text of the side as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// `settings` with this strategy; `option` is the option that the user wrote it after.
    ///
    /// # Errors
    /// Names the option, the key and the fix. Keys that are not the strategy's are refused: with
    /// them the two sides would be two pictures.
    pub fn over(&self, settings: &Settings, option: &str) -> Result<Settings> {
        let overrides = Overrides { preset: None, set: self.set.clone() };
        scene::apply(settings, &overrides).map_err(|error| match error {
            Error::Invalid { field, reason, .. } => Error::invalid(option, field, reason),
            Error::Unsupported { field, reason, .. } => Error::unsupported(option, field, reason),
            other => other,
        })
    }

    /// Options that lead another command to this strategy, each with a space before.
    pub fn in_words(&self) -> String {
        self.set.iter().map(|assignment| format!(" --set {}", quoted(assignment))).collect()
    }
}

/// An item as `--set` takes it: `strategy.key=value`.
fn assignment(item: &str) -> Result<String, String> {
    let Some((key, value)) = item.split_once('=') else {
        let preset: Preset = item
            .parse()
            .map_err(|reason| format!("{reason}, or a key of the strategy such as nee=false"))?;
        return Ok(format!("strategy.preset={}", preset.name()));
    };
    let key = key.trim();
    let inner = key.strip_prefix("strategy.").unwrap_or(key);
    let (first, _) = key.split_once('.').unwrap_or((key, ""));
    let is_of_the_scene = SECTIONS.contains(&first);
    if is_of_the_scene {
        return Err(format!(
            "{key} is no key of the strategy, and A and B are two strategies for one picture; \
             --set {key}={value} changes it for both"
        ));
    }
    Ok(format!("strategy.{inner}={value}"))
}

/// Sections of a scene other than the strategy.
const SECTIONS: [&str; 9] =
    ["scene", "camera", "film", "time", "path", "environment", "volume", "light", "surface"];

/// Splits at the commas that are in no brackets and no quotes.
fn split(text: &str) -> Vec<&str> {
    let (mut items, mut start, mut depth, mut quote) = (Vec::new(), 0, 0_i32, None);
    for (at, letter) in text.char_indices() {
        match (letter, quote) {
            (_, Some(open)) if letter == open => quote = None,
            ('"' | '\'', None) => quote = Some(letter),
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth -= 1,
            (',', None) if depth <= 0 => {
                items.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    items.push(&text[start..]);
    items
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::strategy::{BoostMode, Integrator, Strategy};

    fn strategy(text: &str) -> Strategy {
        let choice: StrategyChoice = text.parse().unwrap();
        choice.over(&Settings::default(), "--a").unwrap().strategy
    }

    #[test]
    fn presets_and_keys_come_in_their_order() {
        assert_eq!(strategy("emission").preset(), Some(Preset::Emission));
        let mixed = strategy("baseline, nee=true ,strategy.advanced.boost_mode=optimal");
        assert!(mixed.nee && !mixed.majorant_boost);
        assert_eq!(mixed.advanced.boost_mode, BoostMode::Optimal);
        assert!(strategy("nee=false,full").nee);
        assert_eq!(strategy("integrator=\"march\"").integrator, Integrator::March);
        assert!(!strategy("preset=baseline").nee, "a preset may be named by its key");
    }

    #[test]
    fn mistakes_name_the_key_and_the_mend() {
        let unread = |text: &str| text.parse::<StrategyChoice>().unwrap_err();
        assert!(unread("ful").contains("\"full\"") && unread("").contains("nee=false"));
        let camera = unread("camera.fov_x=30");
        assert!(camera.contains("--set camera.fov_x=30"), "{camera}");
        let refused = |text: &str| {
            let choice: StrategyChoice = text.parse().unwrap();
            choice.over(&Settings::default(), "--b").unwrap_err().to_string()
        };
        let unknown = refused("nea=false");
        assert!(unknown.starts_with("--b: strategy.nea") && unknown.contains("nee"), "{unknown}");
        let wrong = refused("baseline,nee=maybe");
        assert!(wrong.starts_with("--b: strategy.nee"), "{wrong}");
    }

    #[test]
    fn commas_in_brackets_and_quotes_separate_nothing() {
        assert_eq!(split("a,b=[1, 2],c=\"x,y\""), ["a", "b=[1, 2]", "c=\"x,y\""]);
        assert_eq!(split("a]],b"), ["a]]", "b"]);
    }

    #[test]
    fn in_words_it_can_be_set() {
        let choice: StrategyChoice = "baseline,nee=true".parse().unwrap();
        assert_eq!(choice.in_words(), " --set strategy.preset=baseline --set strategy.nee=true");
    }
}
