//! Reading the schema of the settings: what a key may hold, within which bounds, for which choices.

use std::sync::LazyLock;

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

use super::Settings;

/// The JSON schema of [`Settings`] with every type written out in place.
pub(super) fn root() -> &'static Value {
    static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
        SchemaSettings::draft2020_12()
            .with(|settings| settings.inline_subschemas = true)
            .into_generator()
            .into_root_schema_for::<Settings>()
            .to_value()
    });
    &SCHEMA
}

/// The keys of a table, if the schema is one.
pub(super) fn properties(schema: &Value) -> Option<&Map<String, Value>> {
    schema.get("properties")?.as_object()
}

/// The schema of the items, if the schema is a list of tables such as `[[volume]]`.
pub(super) fn list_item(schema: &Value) -> Option<&Value> {
    let items = schema.get("items")?;
    properties(items).map(|_| items)
}

/// The ways a value may be written; absence is none of them.
pub(super) fn alternatives(schema: &Value) -> Vec<&Value> {
    match ["anyOf", "oneOf"].iter().find_map(|key| schema.get(*key)?.as_array()) {
        Some(list) => list.iter().flat_map(alternatives).collect(),
        None if schema.get("type").and_then(Value::as_str) == Some("null") => Vec::new(),
        None => vec![schema],
    }
}

/// The table among the ways a value may be written.
pub(super) fn table(schema: &Value) -> Option<&Value> {
    alternatives(schema).into_iter().find(|one| properties(one).is_some())
}

/// The schema of what an optional key holds when it is there.
fn present(schema: &Value) -> Option<&Value> {
    let list = schema.get("anyOf")?.as_array()?;
    match list.as_slice() {
        [inner, null] if type_name(null) == "null" => Some(inner),
        _ => None,
    }
}

/// The type of one alternative: `number`, `integer`, `string`, `boolean`, `array` or `object`.
pub(super) fn type_name(schema: &Value) -> &str {
    let kind = schema.get("type");
    kind.and_then(Value::as_str)
        .or_else(|| kind?.as_array()?.iter().find_map(|k| k.as_str().filter(|k| *k != "null")))
        .unwrap_or("object")
}

/// The names a value may take, if it is a choice among names.
pub(super) fn choices(schema: &Value) -> Vec<&str> {
    alternatives(schema)
        .into_iter()
        .flat_map(|one| {
            let listed = one.get("enum").and_then(Value::as_array).into_iter().flatten();
            listed.chain(one.get("const")).filter_map(Value::as_str)
        })
        .collect()
}

/// The names a value may take, each with what it means, if the names are described one by one.
pub(super) fn explained_choices(schema: &Value) -> Vec<(&str, &str)> {
    alternatives(schema)
        .into_iter()
        .filter_map(|one| Some((one.get("const")?.as_str()?, one.get("description")?.as_str()?)))
        .collect()
}

/// Type of a key's value in words.
pub(super) fn label(schema: &Value) -> String {
    if let Some(label) = schema.get("label").and_then(Value::as_str) {
        return label.to_owned();
    }
    if let Some(inner) = present(schema) {
        return label(inner);
    }
    let names = choices(schema);
    if !names.is_empty() {
        return names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(" | ");
    }
    let words: Vec<String> = alternatives(schema).into_iter().map(plain_label).collect();
    words.join(" or ")
}

fn plain_label(schema: &Value) -> String {
    match type_name(schema) {
        "array" => {
            let item = schema.get("items").map(label).unwrap_or_default();
            match schema.get("minItems").and_then(Value::as_u64) {
                Some(count) => format!("[{}]", vec![item; count as usize].join(", ")),
                None => format!("[{item}, ...]"),
            }
        }
        "object" => "table".to_owned(),
        name => name.to_owned(),
    }
}

/// The bounds of every number in a value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct NumberBounds {
    min: Option<f64>,
    above: Option<f64>,
    max: Option<f64>,
    nonzero: bool,
}

impl NumberBounds {
    /// The bounds that the schema states for itself and for what it holds when it is there.
    pub(super) fn of(schema: &Value) -> Self {
        let number = |key: &str| schema.get(key).and_then(Value::as_f64);
        let own = Self {
            min: number("minimum"),
            above: number("exclusiveMinimum"),
            max: number("maximum"),
            nonzero: schema.get("nonzero").is_some(),
        };
        present(schema).map_or(own, |inner| own.or(Self::of(inner)))
    }

    /// These bounds, completed by those of the `inner` schema.
    pub(super) fn or(self, inner: Self) -> Self {
        Self {
            min: self.min.or(inner.min),
            above: self.above.or(inner.above),
            max: self.max.or(inner.max),
            nonzero: self.nonzero || inner.nonzero,
        }
    }

    /// Whether a whole number lies within.
    pub(super) fn contain_integer(&self, value: i64) -> bool {
        self.contain_by(value as f64, |bound| bound)
    }

    /// Whether a number lies within, as precisely as the settings hold it: 0.999 in 32 bits is not
    /// above a bound of 0.999.
    pub(super) fn contain(&self, value: f32) -> bool {
        self.contain_by(value.into(), |bound| f64::from(bound as f32))
    }

    fn contain_by(&self, value: f64, held: impl Fn(f64) -> f64) -> bool {
        self.min.is_none_or(|min| value >= held(min))
            && self.above.is_none_or(|above| value > held(above))
            && self.max.is_none_or(|max| value <= held(max))
            && !(self.nonzero && value == 0.0)
    }

    /// The smallest and the largest number within; infinite where there is no bound.
    pub(super) fn limits(&self) -> [f64; 2] {
        let low = self.min.or(self.above).unwrap_or(f64::NEG_INFINITY);
        [low, self.max.unwrap_or(f64::INFINITY)]
    }

    /// The bounds in words: `0..1`, `> 0`, `not 0`; `None` if there are none.
    pub(super) fn words(&self) -> Option<String> {
        let mut words = match (self.min, self.above, self.max) {
            (Some(min), _, Some(max)) => vec![format!("{min}..{max}")],
            (Some(min), _, None) => vec![format!(">= {min}")],
            (None, above, max) => [above.map(|a| format!("> {a}")), max.map(|m| format!("<= {m}"))]
                .into_iter()
                .flatten()
                .collect(),
        };
        words.extend(self.nonzero.then(|| "not 0".to_owned()));
        (!words.is_empty()).then(|| words.join(", "))
    }
}

/// A condition of a key: it belongs to these values of a neighboring key.
pub(super) struct Only<'a> {
    /// The neighboring key, such as `shape`.
    pub(super) key: &'a str,
    /// The values that the key belongs to.
    pub(super) values: Vec<&'a str>,
}

impl std::fmt::Display for Only<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let values: Vec<String> = self.values.iter().map(|value| format!("\"{value}\"")).collect();
        write!(f, "{} = {}", self.key, values.join(" or "))
    }
}

/// The choices that a key belongs to; empty if it always applies.
pub(super) fn only(schema: &Value) -> Vec<Only<'_>> {
    let Some(conditions) = schema.get("only").and_then(Value::as_object) else { return Vec::new() };
    conditions
        .iter()
        .map(|(key, values)| Only {
            key,
            values: values.as_array().into_iter().flatten().filter_map(Value::as_str).collect(),
        })
        .collect()
}
