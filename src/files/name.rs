//! Names of files as text, for paths that are not Unicode too: on Unix a path is any bytes.
//!
//! Scenes, settings and messages hold names as text. A byte that is no part of UTF-8 is written as
//! a private-use character that stands for it, and opening the file turns it back.

use std::borrow::Cow;
use std::path::Path;

/// The character of byte 0; those of the bytes from 128 on are in use. They are at the end of the
/// last private-use plane, before its two noncharacters.
#[cfg(unix)]
const FIRST: u32 = 0x10_FE00;

/// The path as text, from which [`path_of`] makes the path again.
#[cfg(unix)]
pub fn name_of(path: &Path) -> String {
    use std::os::unix::ffi::OsStrExt;
    let mut name = String::new();
    let escaped = |byte: &u8| char::from_u32(FIRST + u32::from(*byte)).unwrap_or_default();
    for chunk in path.as_os_str().as_bytes().utf8_chunks() {
        for letter in chunk.valid().chars() {
            match byte_of(letter) {
                // A letter that would be taken for a byte is written as its own bytes.
                Some(_) => {
                    name.extend(letter.encode_utf8(&mut [0; 4]).as_bytes().iter().map(escaped))
                }
                None => name.push(letter),
            }
        }
        name.extend(chunk.invalid().iter().map(escaped));
    }
    name
}

/// The path that a name means.
#[cfg(unix)]
pub fn path_of(name: &str) -> Cow<'_, Path> {
    use std::os::unix::ffi::OsStringExt;
    if !name.contains(|letter| byte_of(letter).is_some()) {
        return Cow::Borrowed(Path::new(name));
    }
    let mut bytes = Vec::with_capacity(name.len());
    for letter in name.chars() {
        match byte_of(letter) {
            Some(byte) => bytes.push(byte),
            None => bytes.extend(letter.encode_utf8(&mut [0; 4]).bytes()),
        }
    }
    Cow::Owned(std::ffi::OsString::from_vec(bytes).into())
}

/// The byte that a character stands for.
#[cfg(unix)]
fn byte_of(letter: char) -> Option<u8> {
    let byte = u8::try_from(u32::from(letter).checked_sub(FIRST)?).ok()?;
    (byte >= 128).then_some(byte)
}

/// The path as text; what is not Unicode is replaced.
#[cfg(not(unix))]
pub fn name_of(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// The path that a name means.
#[cfg(not(unix))]
pub fn path_of(name: &str) -> Cow<'_, Path> {
    Cow::Borrowed(Path::new(name))
}

#[cfg(all(test, unix))]
mod tests {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    use super::*;

    #[test]
    fn any_bytes_come_back() {
        let paths: [&[u8]; 7] = [
            b"/fire/smoke.vdb",
            "/fumée/дым.vdb".as_bytes(),
            b"/fum\xe9e/\xff\xfe\x80.vdb",
            "\u{10FEE9}.vdb".as_bytes(),
            b"\xf4\x8f\xbb\xff\xc3",
            "\u{10FE41}\u{E000}".as_bytes(),
            b"",
        ];
        for bytes in paths {
            let path = Path::new(OsStr::from_bytes(bytes));
            let name = name_of(path);
            assert_eq!(path_of(&name), path, "{name:?}");
            if path.to_str().is_some_and(|text| !text.contains('\u{10FEE9}')) {
                assert_eq!(Some(name.as_str()), path.to_str());
            }
        }
    }
}
