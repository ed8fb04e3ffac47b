//! Scene text to settings.

use std::path::Path;

use serde::Deserialize;
use toml::{Table, Value};

use super::overrides::{OVERRIDES, Overrides, drop_all_stray, expand_preset};
use super::settings::{CameraSettings, Settings, field_of_view};
use super::{check, files, rules, schema};
use crate::error::{Error, Result};

/// Reads a scene's TOML with `overrides` laid over it. `source` names the text in errors; relative
/// file names start from `folder`.
///
/// # Errors
/// Names the source, the key and the fix: syntax, unknown keys, wrong types, values out of range.
pub fn parse(text: &str, source: &str, folder: &Path, overrides: &Overrides) -> Result<Settings> {
    let mut scene: Table = toml::from_str(text).map_err(|e| syntax(text, source, &e))?;
    expand_preset(&mut scene, source)?;
    spell_one_way(&mut scene, source)?;
    check::check_keys(&scene, source)?;
    resolve_files(&mut scene, folder)?;
    let settings = from_table(scene, source)?;
    rules::check_rules(&settings, source)?;
    apply(&settings, overrides)
}

/// Settings with overrides laid over them.
///
/// # Errors
/// Names `--set`, the key and the fix.
pub fn apply(settings: &Settings, overrides: &Overrides) -> Result<Settings> {
    if overrides.is_empty() {
        return Ok(settings.clone());
    }
    let source = OVERRIDES;
    let mut scene = to_table(settings)?;
    overrides.apply(&mut scene)?;
    spell_one_way(&mut scene, source)?;
    check::check_keys(&scene, source)?;
    let settings = from_table(scene, source)?;
    rules::check_rules(&settings, source)?;
    Ok(settings)
}

/// Checks settings that did not come from a file; `source` names them in errors.
///
/// # Errors
/// As [`parse`].
pub fn validate(settings: &Settings, source: &str) -> Result<()> {
    check::check_keys(&to_table(settings)?, source)?;
    rules::check_rules(settings, source)
}

/// The settings without the keys that do not belong to the chosen shapes, types and modes: what is
/// left over when a choice has changed.
pub fn tidy(settings: &Settings) -> Result<Settings> {
    let mut scene = to_table(settings)?;
    drop_all_stray(&mut scene, schema::root());
    from_table(scene, "")
}

fn to_table(settings: &Settings) -> Result<Table> {
    Table::try_from(settings).map_err(|e| Error::invalid("", "", e.to_string()))
}

fn from_table(scene: Table, source: &str) -> Result<Settings> {
    Settings::deserialize(Value::Table(scene))
        .map_err(|e| Error::invalid(source, "", e.message().to_owned()))
}

fn syntax(text: &str, source: &str, error: &toml::de::Error) -> Error {
    let line = error.span().and_then(|span| text.get(..span.start)).map(|before| {
        let line = before.matches('\n').count() + 1;
        format!("line {line}")
    });
    Error::invalid(source, line.unwrap_or_default(), error.message().to_owned())
}

fn resolve_files(scene: &mut Table, folder: &Path) -> Result<()> {
    let resolve = |table: &mut Value| {
        if let Some(Value::String(file)) = table.get_mut("file") {
            *file = files::resolve(file, folder)?;
        }
        Ok(())
    };
    if let Some(environment) = scene.get_mut("environment") {
        resolve(environment)?;
    }
    let Some(Value::Array(volumes)) = scene.get_mut("volume") else { return Ok(()) };
    volumes.iter_mut().try_for_each(resolve)
}

/// Brings keys that may be spelled in two ways to one.
fn spell_one_way(scene: &mut Table, source: &str) -> Result<()> {
    spell_brightness_one_way(scene, source)?;
    spell_lenses_one_way(scene, source)
}

/// A camera's focal length is its field of view.
fn spell_lenses_one_way(scene: &mut Table, source: &str) -> Result<()> {
    let Some(Value::Table(camera)) = scene.get_mut("camera") else { return Ok(()) };
    let sensor = camera.get("sensor_width").and_then(number);
    let sensor = sensor.unwrap_or_else(|| CameraSettings::default().sensor_width.into());
    spell_lens_one_way(camera, sensor, (source, "camera"))?;
    let Some(Value::Array(keys)) = camera.get_mut("key") else { return Ok(()) };
    for (index, key) in keys.iter_mut().enumerate() {
        if let Value::Table(key) = key {
            spell_lens_one_way(key, sensor, (source, &format!("camera.key.{index}")))?;
        }
    }
    Ok(())
}

fn spell_lens_one_way(lens: &mut Table, sensor: f64, (source, path): (&str, &str)) -> Result<()> {
    const MM: &str = "a focal length is a number above 0, in millimeters";
    let Some(length) = lens.remove("focal_length") else { return Ok(()) };
    let invalid = |reason: &str| Error::invalid(source, format!("{path}.focal_length"), reason);
    if source != OVERRIDES && lens.contains_key("fov_x") {
        return Err(invalid("it and fov_x mean the same; leave one out"));
    }
    let length = number(&length).filter(|length| *length > 0.0).ok_or_else(|| invalid(MM))?;
    lens.insert("fov_x".to_owned(), Value::Float(field_of_view(length, sensor)));
    Ok(())
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|number| number as f64))
}

/// A sun's `irradiance` and a sphere's or quad's `radiance` are their `intensity`.
fn spell_brightness_one_way(scene: &mut Table, source: &str) -> Result<()> {
    let Some(Value::Array(lights)) = scene.get_mut("light") else { return Ok(()) };
    for (index, light) in lights.iter_mut().enumerate() {
        let Value::Table(light) = light else { continue };
        let other = match light.get("type").and_then(Value::as_str) {
            Some("sun") => "irradiance",
            Some("sphere" | "quad") => "radiance",
            _ => continue,
        };
        let Some(value) = light.remove(other) else { continue };
        if source != OVERRIDES && light.contains_key("intensity") {
            let reason = format!("{other} and intensity mean the same here; leave one out");
            return Err(Error::invalid(source, format!("light.{index}.{other}"), reason));
        }
        light.insert("intensity".to_owned(), value);
    }
    Ok(())
}
