//! All keys of the scene file, read from the schema of the one settings struct.

use std::sync::LazyLock;

use serde::Serialize;
use serde_json::Value;

use super::schema::{self, NumberBounds};

/// A key of the scene file, as `flambeau keys` prints it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Key {
    /// The dotted path; `N` stands for the index of a list item, counted from 0.
    pub path: String,
    /// Type of the value: `number`, `[number, number, number]`, `"a" | "b"`, ...
    #[serde(rename = "type")]
    pub kind: String,
    /// Unit of the value, if it has one.
    pub unit: Option<String>,
    /// Default value as TOML; `None` where absence is a meaning of its own.
    pub default: Option<String>,
    /// Bounds of each number in the value, if there are any.
    pub range: Option<String>,
    /// The same as the smallest and the largest number; infinite where there is no bound.
    #[serde(skip)]
    pub limits: [f64; 2],
    /// Help text of the key.
    pub help: String,
    /// Choices that the key belongs to (`shape = "sphere"`), if it does not always apply.
    pub only: Option<String>,
}

/// All keys, table by table.
pub fn all() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| {
        let mut keys = Vec::new();
        collect(schema::root(), "", &mut keys);
        keys
    });
    &KEYS
}

/// The key at `path`, where list items may be `N` or numbers (`volume.0.density.scale`).
pub fn find(path: &str) -> Option<Key> {
    let path = general(path);
    all().iter().find(|key| key.path == path).cloned()
}

/// The names that the key at `path` chooses among; empty if it is no such choice.
pub fn choices(path: &str) -> Vec<&'static str> {
    at(path).map(schema::choices).unwrap_or_default()
}

/// Names of the choices of a key, each with its meaning.
pub fn explained_choices(path: &str) -> Vec<(&'static str, &'static str)> {
    at(path).map(schema::explained_choices).unwrap_or_default()
}

/// The schema of the key at `path`.
fn at(path: &str) -> Option<&'static Value> {
    let mut schema = schema::root();
    for part in general(path).split('.') {
        let next = match part {
            "N" => schema::list_item(schema),
            key => schema::table(schema).and_then(schema::properties).and_then(|p| p.get(key)),
        };
        schema = next?;
    }
    Some(schema)
}

/// The path with `N` for every index.
pub(super) fn general(path: &str) -> String {
    let index = |part: &&str| part.parse::<usize>().is_ok();
    let parts: Vec<&str> =
        path.split('.').map(|part| if index(&part) { "N" } else { part }).collect();
    parts.join(".")
}

/// The path of `key` in the table at `path`.
pub(super) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

fn collect(table: &Value, path: &str, keys: &mut Vec<Key>) {
    for (name, schema) in schema::properties(table).into_iter().flatten() {
        let path = join(path, name);
        if let Some(item) = schema::list_item(schema) {
            collect(item, &join(&path, "N"), keys);
            continue;
        }
        let inner = schema::table(schema);
        if inner.is_none() || schema::alternatives(schema).len() > 1 {
            keys.push(describe(path.clone(), schema));
        }
        if let Some(inner) = inner {
            collect(inner, &path, keys);
        }
    }
}

fn describe(path: String, schema: &Value) -> Key {
    let text = |key: &str| schema.get(key).and_then(Value::as_str).map(str::to_owned);
    let conditions: Vec<String> = schema::only(schema).iter().map(ToString::to_string).collect();
    let items = schema.get("items").map(NumberBounds::of).unwrap_or_default();
    let bounds = NumberBounds::of(schema).or(items);
    Key {
        path,
        kind: schema::label(schema),
        unit: text("unit"),
        default: schema.get("default").and_then(toml_text),
        range: bounds.words(),
        limits: bounds.limits(),
        help: text("description").unwrap_or_default().replace('\n', " "),
        only: (!conditions.is_empty()).then(|| conditions.join(" and ")),
    }
}

/// A default as TOML. JSON holds every number in 64 bits, the settings in 32: the shortest form of
/// the latter is what one would write.
fn toml_text(value: &Value) -> Option<String> {
    match value {
        Value::Null => None,
        Value::Number(number) if number.is_f64() => {
            number.as_f64().map(|value| format!("{:?}", value as f32))
        }
        Value::Array(items) => {
            let items: Vec<String> = items.iter().filter_map(toml_text).collect();
            Some(format!("[{}]", items.join(", ")))
        }
        other => Some(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_help_and_a_meaning_when_absent() {
        assert!(all().len() > 70, "{}", all().len());
        for key in all() {
            assert!(key.help.len() > 8, "{} has no help", key.path);
            assert!(!key.kind.is_empty(), "{} has no type", key.path);
            let absent_means_something = [
                "camera.focus_distance",
                "camera.key.N.position",
                "camera.key.N.target",
                "camera.key.N.fov_x",
                "volume.N.file",
                "volume.N.shape",
                "volume.N.matrix",
                "volume.N.frame_range",
                "time.range",
                "environment.file",
                "environment.gradient",
                "volume.N.emission.grid",
                "volume.N.emission.intensity_grid",
                "volume.N.albedo.grid",
                "volume.N.velocity.grid",
                "volume.N.velocity.grids",
                "surface.N.half_size",
            ];
            assert_eq!(
                key.default.is_none(),
                absent_means_something.contains(&key.path.as_str()),
                "{}: {:?}",
                key.path,
                key.default
            );
        }
    }

    #[test]
    fn types_units_ranges_and_conditions_come_from_the_struct() {
        let fov = find("camera.fov_x").unwrap();
        assert_eq!((fov.kind.as_str(), fov.unit.as_deref()), ("number", Some("degrees")));
        assert_eq!(fov.range.as_deref(), Some("> 0, <= 179.9"));
        assert_eq!(fov.limits[1], 179.9);
        assert_eq!(fov.default.as_deref(), Some("36.0"));
        let radius = find("volume.3.radius").unwrap();
        assert_eq!(radius.only.as_deref(), Some("shape = \"sphere\""));
        assert_eq!(radius.range.as_deref(), Some("> 0"));
        assert_eq!(find("light.0.radius").unwrap().default.as_deref(), Some("0.1"));
        assert_eq!(find("film.size").unwrap().kind, "[integer, integer]");
        assert_eq!(find("film.size").unwrap().range.as_deref(), Some("1..16384"));
        assert_eq!(find("environment.radiance").unwrap().kind, "number or [r, g, b]");
        assert_eq!(
            find("surface.0.material.type").unwrap().default.as_deref(),
            Some("\"diffuse\"")
        );
        assert_eq!(choices("strategy.preset"), ["baseline", "emission", "full"]);
        assert_eq!(choices("volume.0.shape"), ["box", "sphere", "everywhere", "ramp", "noise"]);
        let explained = explained_choices("strategy.advanced.boost_mode");
        let names: Vec<&str> = explained.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["stratified", "optimal", "clamped", "literal"]);
        assert!(explained.iter().all(|(_, help)| help.len() > 20), "{explained:?}");
        assert!(find("strategy.preset").is_some());
        assert!(find("strategy.nee").is_some());
        assert!(find("strategy.neee").is_none());
    }
}
