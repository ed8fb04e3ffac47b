//! Holds a TOML value against the schema: unknown keys, types, ranges, and keys that do not belong
//! to the chosen shape, type or mode. The one place where single values are judged.

use serde_json::Value as Schema;
use toml::{Table, Value};

use super::keys::{self, join};
use super::schema::{self, NumberBounds, Only};
use crate::error::{Error, Result};

/// Checks the keys of a whole scene and their values; `source` names it in errors.
pub(super) fn check_keys(scene: &Table, source: &str) -> Result<()> {
    Checker { source }.table(scene, schema::root(), "")
}

/// Whether the neighbors of a key make it apply: the first condition that they break, if any, and
/// the neighbor's value.
pub(super) fn broken_condition<'a>(
    key_schema: &'a Schema,
    table: &'a Table,
    table_schema: &'a Schema,
) -> Option<(Only<'a>, Option<&'a str>)> {
    schema::only(key_schema).into_iter().find_map(|only| {
        let default = || schema::properties(table_schema)?.get(only.key)?.get("default")?.as_str();
        let actual = match table.get(only.key) {
            Some(value) => value.as_str(),
            None => default(),
        };
        let holds = actual.is_some_and(|actual| only.values.contains(&actual));
        (!holds).then_some((only, actual))
    })
}

struct Checker<'a> {
    source: &'a str,
}

impl Checker<'_> {
    fn invalid(&self, path: &str, reason: String) -> Error {
        Error::invalid(self.source, path, reason)
    }

    fn table(&self, table: &Table, schema: &Schema, path: &str) -> Result<()> {
        let Some(properties) = schema::properties(schema) else { return Ok(()) };
        for (key, value) in table {
            let path = join(path, key);
            let Some(key_schema) = properties.get(key) else {
                return Err(self.unknown_key(&path, key, properties.keys()));
            };
            self.value(value, key_schema, &path, NumberBounds::default())?;
            if let Some((only, actual)) = broken_condition(key_schema, table, schema) {
                let has = match actual {
                    Some(actual) => format!("here {} = \"{actual}\"", only.key),
                    None => format!("here there is no {}", only.key),
                };
                return Err(self.invalid(
                    &path,
                    format!(
                        "{key} belongs to {only}, and {has}; leave it out or change {}",
                        only.key
                    ),
                ));
            }
        }
        Ok(())
    }

    fn unknown_key<'k>(
        &self,
        path: &str,
        key: &str,
        siblings: impl Iterator<Item = &'k String>,
    ) -> Error {
        let general = keys::general(path);
        if is_planned(&general) {
            let reason = "this feature is not there yet; leave the key out".to_owned();
            return Error::unsupported(self.source, path, reason);
        }
        let parent = path.strip_suffix(key).unwrap_or_default();
        let near = siblings
            .map(|name| {
                (strsim::normalized_damerau_levenshtein(key, name), format!("{parent}{name}"))
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let far = keys::all()
            .iter()
            .map(|known| {
                let name = known.path.rsplit('.').next().unwrap_or_default();
                (strsim::normalized_damerau_levenshtein(key, name) - 0.3, known.path.clone())
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let nearest = near.into_iter().chain(far).max_by(|a, b| a.0.total_cmp(&b.0));
        let nearest = nearest.map(|(_, path)| path).unwrap_or_default();
        self.invalid(path, format!("unknown key; the nearest known key is {nearest}"))
    }

    fn value(&self, value: &Value, schema: &Schema, path: &str, outer: NumberBounds) -> Result<()> {
        let bounds = outer.or(NumberBounds::of(schema));
        if schema::list_item(schema).is_some() && !value.is_array() {
            let reason = format!("expected a list of tables; write [[{path}]]");
            return Err(self.invalid(path, reason));
        }
        let alternatives = schema::alternatives(schema);
        let Some(&chosen) = alternatives.iter().find(|one| fits(value, one)) else {
            return Err(self.wrong_type(value, schema, path));
        };
        let bounds = bounds.or(NumberBounds::of(chosen));
        match value {
            Value::Integer(number) => self.integer(*number, path, bounds),
            Value::Float(number) => self.float(*number, path, bounds),
            Value::String(name) => self.name(name, schema, path),
            Value::Array(items) => self.array(items, chosen, schema, path, bounds),
            Value::Table(table) => self.table(table, chosen, path),
            Value::Boolean(_) | Value::Datetime(_) => Ok(()),
        }
    }

    fn wrong_type(&self, value: &Value, schema: &Schema, path: &str) -> Error {
        let found = match value {
            Value::Table(_) => "a table".to_owned(),
            Value::Array(_) => format!("the list {value}"),
            Value::String(_) => format!("the string {value}"),
            other => format!("the {} {other}", other.type_str()),
        };
        self.invalid(path, format!("expected {}, found {found}", schema::label(schema)))
    }

    fn integer(&self, number: i64, path: &str, bounds: NumberBounds) -> Result<()> {
        self.within(bounds.contain_integer(number), number, path, bounds)
    }

    fn float(&self, number: f64, path: &str, bounds: NumberBounds) -> Result<()> {
        let held = number as f32;
        if !held.is_finite() {
            return Err(self.invalid(path, format!("{number} is not a finite number")));
        }
        self.within(bounds.contain(held), held, path, bounds)
    }

    fn within(
        &self,
        is_within: bool,
        number: impl std::fmt::Display,
        path: &str,
        bounds: NumberBounds,
    ) -> Result<()> {
        match bounds.words() {
            Some(words) if !is_within => {
                Err(self.invalid(path, format!("{number} is out of range; the range is {words}")))
            }
            _ => Ok(()),
        }
    }

    fn name(&self, name: &str, schema: &Schema, path: &str) -> Result<()> {
        let choices = schema::choices(schema);
        if choices.is_empty() || choices.contains(&name) {
            return Ok(());
        }
        let label = schema::label(schema);
        if is_planned_value(&keys::general(path), name) {
            let reason = format!("\"{name}\" is not there yet; use {label}");
            return Err(Error::unsupported(self.source, path, reason));
        }
        Err(self.invalid(path, format!("\"{name}\" is none of its values; use {label}")))
    }

    fn array(
        &self,
        items: &[Value],
        chosen: &Schema,
        whole: &Schema,
        path: &str,
        bounds: NumberBounds,
    ) -> Result<()> {
        let count = chosen.get("minItems").and_then(Schema::as_u64);
        if count.is_some_and(|count| count != items.len() as u64) {
            let expected = schema::label(whole);
            let reason = format!("expected {expected}, found a list of {}", items.len());
            return Err(self.invalid(path, reason));
        }
        let Some(item_schema) = chosen.get("items") else { return Ok(()) };
        for (index, item) in items.iter().enumerate() {
            self.value(item, item_schema, &join(path, &index.to_string()), bounds)?;
        }
        Ok(())
    }
}

/// Whether a value is of the alternative's type, whatever its size and bounds.
fn fits(value: &Value, schema: &Schema) -> bool {
    match schema::type_name(schema) {
        "number" => value.is_float() || value.is_integer(),
        "integer" => value.is_integer(),
        "boolean" => value.is_bool(),
        "string" => value.is_str(),
        "array" => value.is_array(),
        _ => value.is_table(),
    }
}

/// Keys that the scene format knows but that are not there yet. They are refused with a message
/// that says so, which is another message than for a misspelled key.
const PLANNED_KEYS: &[&str] = &["environment.group"];

fn is_planned(general_path: &str) -> bool {
    PLANNED_KEYS.contains(&general_path)
}

fn is_planned_value(general_path: &str, name: &str) -> bool {
    match general_path {
        "surface.N.shape" => name == "mesh",
        _ => false,
    }
}
