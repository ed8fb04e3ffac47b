//! Values of the command line: how they are read, and how a shell takes them.

use clap::builder::{OsStringValueParser, TypedValueParser};
use glam::UVec2;

use crate::files::{name_of, path_of};
use crate::scene::settings::MAX_FRAME;

/// A frame of a sequence, which may lie between two.
pub fn parse_frame(text: &str) -> Result<f64, String> {
    let most = f64::from(MAX_FRAME);
    match text.parse::<f64>() {
        Ok(frame) if frame.abs() <= most => Ok(frame),
        Ok(_) => Err(format!("frames lie between -{most} and {most}")),
        Err(_) => Err("expected the number of a frame".to_owned()),
    }
}

/// The name of a file, or another text that may hold one; it need not be Unicode.
pub fn file_name() -> impl TypedValueParser<Value = String> {
    OsStringValueParser::new().map(|name| name_of(name.as_ref()))
}

/// A number of seconds above 0.
pub fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("expected a number of seconds above 0".to_owned()),
    }
}

/// A width and a height in pixels, such as 960x540.
pub fn parse_size(text: &str) -> Result<UVec2, String> {
    let sides =
        text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match sides {
        Some((width, height)) if (1..=16384).contains(&width) && (1..=16384).contains(&height) => {
            Ok(UVec2::new(width, height))
        }
        _ => Err("expected WIDTHxHEIGHT with sides of 1 to 16384, such as 960x540".to_owned()),
    }
}

/// A word as a shell takes it literally.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,=+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    if path_of(word).to_str() != Some(word) {
        return quoted_bytes(path_of(word).as_os_str().as_encoded_bytes());
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

/// Bytes that are no text, as Bash and other shells take them.
fn quoted_bytes(bytes: &[u8]) -> String {
    let byte = |byte: &u8| match byte {
        b'\'' | b'\\' => format!("\\{}", char::from(*byte)),
        b' '..=b'~' => char::from(*byte).to_string(),
        _ => format!("\\x{byte:02x}"),
    };
    format!("$'{}'", bytes.iter().map(byte).collect::<String>())
}

/// A pixel, column and row from 0, such as 480,270.
pub fn parse_pixel(text: &str) -> Result<UVec2, String> {
    let sides = text.split_once(',').and_then(|(x, y)| Some((x.parse().ok()?, y.parse().ok()?)));
    sides.map(|(x, y)| UVec2::new(x, y)).ok_or_else(|| "expected X,Y such as 480,270".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn words_that_are_no_text_are_quoted_byte_by_byte() {
        use std::os::unix::ffi::OsStrExt;
        let word = |bytes| quoted(&name_of(std::ffi::OsStr::from_bytes(bytes).as_ref()));
        assert_eq!(word(b"it's \xe9.vdb"), r"$'it\'s \xe9.vdb'");
        assert_eq!([word(b"it's"), word(b"a-b.vdb")], [r"'it'\''s'", "a-b.vdb"]);
    }

    #[test]
    fn sizes_are_two_numbers() {
        assert_eq!(parse_size("960x540"), Ok(UVec2::new(960, 540)));
        for wrong in ["960", "0x5", "5x0", "ax5", "5x5x5", "-5x5", "99999x5", ""] {
            assert!(parse_size(wrong).is_err(), "{wrong}");
        }
    }
}
