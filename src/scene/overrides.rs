//! Changes that are laid over a scene: `--preset NAME`, then each `--set key.path=value`.

use serde_json::Value as Schema;
use toml::{Table, Value};

use super::check::broken_condition;
use super::files;
use super::keys::join;
use super::schema;
use crate::error::{Error, Result};
use crate::transport::strategy::{Preset, Strategy};

/// The name of overrides in errors.
pub(super) const OVERRIDES: &str = "--set";

/// Changes that are laid over a scene, in the order of its fields.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Replaces the scene's toggles; its advanced choices stay.
    pub preset: Option<Preset>,
    /// `key.path=value`, the value as TOML or a bare string.
    pub set: Vec<String>,
}

impl Overrides {
    /// Whether nothing is laid over.
    pub fn is_empty(&self) -> bool {
        self.preset.is_none() && self.set.is_empty()
    }

    /// Lays everything over `scene`.
    pub(super) fn apply(&self, scene: &mut Table) -> Result<()> {
        if let Some(preset) = self.preset {
            set_toggles(scene, preset)?;
        }
        self.set.iter().try_for_each(|assignment| set(scene, assignment))
    }
}

/// Expands `strategy.preset` of a file: it fills in the toggles that the file leaves out.
pub(super) fn expand_preset(scene: &mut Table, source: &str) -> Result<()> {
    let Some(Value::Table(strategy)) = scene.get_mut("strategy") else { return Ok(()) };
    let Some(preset) = strategy.remove("preset") else { return Ok(()) };
    let preset = preset_named(&preset, source)?;
    for (key, value) in toggles(preset)? {
        strategy.entry(key).or_insert(value);
    }
    Ok(())
}

fn preset_named(value: &Value, source: &str) -> Result<Preset> {
    let name = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    name.parse().map_err(|reason: String| Error::invalid(source, "strategy.preset", reason))
}

/// The toggles of a preset alone.
fn toggles(preset: Preset) -> Result<Table> {
    let mut table = to_table(&preset.strategy())?;
    table.remove("integrator");
    table.remove("advanced");
    Ok(table)
}

fn to_table(strategy: &Strategy) -> Result<Table> {
    Table::try_from(strategy).map_err(|e| Error::invalid("", "strategy", e.to_string()))
}

fn set_toggles(scene: &mut Table, preset: Preset) -> Result<()> {
    let strategy = scene.entry("strategy").or_insert_with(|| Value::Table(Table::new()));
    if let Value::Table(strategy) = strategy {
        strategy.extend(toggles(preset)?);
    }
    Ok(())
}

/// Carries out one `key.path=value`.
fn set(scene: &mut Table, assignment: &str) -> Result<()> {
    let Some((path, text)) = assignment.split_once('=') else {
        let reason = "expected key.path=value, such as volume.0.density.scale=0.35";
        return Err(Error::invalid(OVERRIDES, assignment, reason));
    };
    let (path, text) = (path.trim(), text.trim());
    if path == "strategy.preset" {
        return set_toggles(scene, preset_named(&value_of(text, false), OVERRIDES)?);
    }
    let parts: Vec<&str> = path.split('.').collect();
    insert(scene, &parts, schema::root(), "", text)
}

/// The value that `text` stands for: TOML, or else the text itself.
fn value_of(text: &str, is_name: bool) -> Value {
    let parsed = toml::from_str::<Table>(&format!("value = {text}"));
    let parsed = parsed.ok().filter(|table| table.len() == 1).and_then(|mut t| t.remove("value"));
    match parsed {
        Some(value) if value.is_str() || !is_name => value,
        _ => Value::String(text.to_owned()),
    }
}

fn insert(
    table: &mut Table,
    parts: &[&str],
    schema: &Schema,
    path: &str,
    text: &str,
) -> Result<()> {
    let [key, rest @ ..] = parts else { return Ok(()) };
    let at = join(path, key);
    let key_schema = schema::properties(schema).and_then(|p| p.get(*key));
    if rest.is_empty() {
        table.insert((*key).to_owned(), leaf(text, key_schema, &at)?);
        drop_replaced(table, key, schema);
        return Ok(());
    }
    // A number gives way to a table where the key may be either (`albedo.grid`); an unknown key
    // becomes a table that the check refuses by name.
    let item_schema = key_schema.and_then(schema::list_item);
    let entry = table.entry(*key).or_insert(match item_schema {
        Some(_) => Value::Array(Vec::new()),
        None => Value::Table(Table::new()),
    });
    match (entry, item_schema) {
        (Value::Array(items), Some(item)) => insert_item(items, rest, item, &at, text),
        (Value::Array(items), None) => insert_number(items, rest, &at, text),
        (entry, _) => {
            if !entry.is_table() {
                *entry = Value::Table(Table::new());
            }
            let inner = key_schema.and_then(schema::table).unwrap_or(&Schema::Null);
            match entry {
                Value::Table(inner_table) => insert(inner_table, rest, inner, &at, text),
                _ => Ok(()),
            }
        }
    }
}

/// The value of a last key; a file named on the command line is relative to the current folder.
fn leaf(text: &str, schema: Option<&Schema>, path: &str) -> Result<Value> {
    let is_name = schema.is_some_and(|schema| {
        let alternatives = schema::alternatives(schema);
        !alternatives.is_empty()
            && alternatives.iter().all(|one| schema::type_name(one) == "string")
    });
    match value_of(text, is_name) {
        Value::String(file) if files::is_file_key(path) => {
            Ok(Value::String(files::resolve(&file, std::path::Path::new(""))?))
        }
        value => Ok(value),
    }
}

fn insert_item(
    items: &mut Vec<Value>,
    parts: &[&str],
    schema: &Schema,
    path: &str,
    text: &str,
) -> Result<()> {
    let [index, rest @ ..] = parts else { return Ok(()) };
    let index = index_in(items.len(), index, path, true)?;
    if index == items.len() {
        items.push(Value::Table(Table::new()));
    }
    let at = join(path, &index.to_string());
    match items.get_mut(index) {
        Some(Value::Table(item)) if !rest.is_empty() => insert(item, rest, schema, &at, text),
        Some(item) if rest.is_empty() => {
            *item = value_of(text, false);
            Ok(())
        }
        _ => Ok(()),
    }
}

fn insert_number(items: &mut [Value], parts: &[&str], path: &str, text: &str) -> Result<()> {
    let [index, rest @ ..] = parts else { return Ok(()) };
    let index = index_in(items.len(), index, path, false)?;
    match items.get_mut(index) {
        Some(Value::Array(inner)) if !rest.is_empty() => {
            insert_number(inner, rest, &join(path, &index.to_string()), text)
        }
        Some(item) if rest.is_empty() => {
            *item = value_of(text, false);
            Ok(())
        }
        _ => {
            let reason = format!("{} has no keys of its own", join(path, &index.to_string()));
            Err(Error::invalid(OVERRIDES, path, reason))
        }
    }
}

fn index_in(count: usize, text: &str, path: &str, may_append: bool) -> Result<usize> {
    let last = count + usize::from(may_append);
    match text.parse::<usize>() {
        Ok(index) if index < last => Ok(index),
        Ok(index) => {
            let fix = match may_append {
                true => format!("there are {count}; {path}.{count} adds one"),
                false => format!("there are {count}, counted from 0"),
            };
            Err(Error::invalid(OVERRIDES, path, format!("there is no item {index}: {fix}")))
        }
        Err(_) => {
            let reason = format!("expected an index after {path}, such as {path}.0, found {text}");
            Err(Error::invalid(OVERRIDES, path, reason))
        }
    }
}

/// A new choice (`shape`, `type`, `mode`) takes with it the keys that belonged to the old one; a
/// file replaces a shape, a matrix the other placement keys, and the other way round. The sources
/// of the sky replace each other.
fn drop_replaced(table: &mut Table, key: &str, schema: &Schema) {
    let replaced: &[&str] = match key {
        "file" => &["shape", "radiance", "gradient", "sky"],
        "shape" => &["file"],
        "matrix" => &["translate", "rotate", "scale"],
        "translate" | "rotate" | "scale" => &["matrix"],
        "radiance" => &["file", "gradient", "sky"],
        "gradient" => &["radiance", "file", "sky"],
        "sky" => &["radiance", "file", "gradient"],
        _ => &[],
    };
    for other in replaced {
        table.remove(*other);
    }
    drop_stray(table, key, schema);
    if replaced.contains(&"shape") {
        drop_stray(table, "shape", schema);
    }
}

/// Takes out every key that does not belong to its neighbors' choices.
pub(super) fn drop_all_stray(table: &mut Table, schema: &Schema) {
    let Some(properties) = schema::properties(schema) else { return };
    for (key, key_schema) in properties {
        for only in schema::only(key_schema) {
            drop_stray(table, only.key, schema);
        }
        match (table.get_mut(key), schema::list_item(key_schema), schema::table(key_schema)) {
            (Some(Value::Array(items)), Some(item_schema), _) => {
                let items = items.iter_mut().filter_map(Value::as_table_mut);
                items.for_each(|item| drop_all_stray(item, item_schema));
            }
            (Some(Value::Table(inner)), _, Some(inner_schema)) => {
                drop_all_stray(inner, inner_schema);
            }
            _ => {}
        }
    }
}

fn drop_stray(table: &mut Table, choice: &str, schema: &Schema) {
    let Some(properties) = schema::properties(schema) else { return };
    let stray: Vec<&String> = properties
        .iter()
        .filter(|(key, key_schema)| {
            table.contains_key(*key)
                && schema::only(key_schema).iter().any(|only| only.key == choice)
                && broken_condition(key_schema, table, schema).is_some()
        })
        .map(|(key, _)| key)
        .collect();
    for key in stray {
        table.remove(key);
    }
}
