//! The header of a numpy file: a Python dictionary of three entries ("NPY format", numpy's
//! documentation, versions 1.0 to 3.0).
//!
//! Read without a package: those there are take any Python literal and go as deep into brackets as
//! a broken file asks for. Here nothing nests, and nothing is allocated by what a header claims.

/// Header of a numpy array: its element type, order and shape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NpyHeader {
    /// The type of a number, such as `<f4`.
    pub descr: String,
    /// Whether the first index runs fastest.
    pub fortran_order: bool,
    /// Lengths of the axes.
    pub shape: Vec<usize>,
}

/// Fault of a header: the entry, which may be empty, and the reason.
pub type Flaw = (&'static str, &'static str);

/// The first bytes of every numpy file.
pub const MAGIC: &[u8] = b"\x93NUMPY";

const DESCR: &str = "descr";
const FORTRAN_ORDER: &str = "fortran_order";
const SHAPE: &str = "shape";

/// Bytes of a header that is written, magic and length included: room for any lengths of 32 bits,
/// and a multiple of 64, so that the values after it are aligned.
const WRITTEN_BYTES: usize = 128;

/// The header, of version 1.0, of an array of little-endian float32 whose last index runs fastest.
pub fn float_header(shape: [u32; 3]) -> Vec<u8> {
    let [height, width, channels] = shape;
    let entries = format!(
        "{{'{DESCR}': '<f4', '{FORTRAN_ORDER}': False, '{SHAPE}': ({height}, {width}, {channels}, ), }}"
    );
    let mut header = [MAGIC, &[1, 0, WRITTEN_BYTES as u8 - 10, 0], entries.as_bytes()].concat();
    header.resize(WRITTEN_BYTES - 1, b' ');
    header.push(b'\n');
    header
}

/// Splits a file into its header and its data.
///
/// # Errors
/// A fault of the header, in words.
pub fn split(bytes: &[u8]) -> Result<(NpyHeader, &[u8]), Flaw> {
    let flaw = ("", "it ends inside of its header; save it again");
    let rest = bytes.strip_prefix(MAGIC).ok_or(("", "it does not begin as a numpy file"))?;
    let (version, rest) = rest.split_at_checked(2).ok_or(flaw)?;
    let length_bytes = match version[0] {
        1 => 2,
        2 | 3 => 4,
        _ => return Err(("version", "only versions 1 to 3 are known; save it with numpy.save")),
    };
    let (length, rest) = rest.split_at_checked(length_bytes).ok_or(flaw)?;
    let length = length.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte));
    let (text, data) = rest.split_at_checked(length).ok_or(flaw)?;
    let text = str::from_utf8(text).map_err(|_| ("", "its header is not text; save it again"))?;
    Ok((parse(text)?, data))
}

fn parse(text: &str) -> Result<NpyHeader, Flaw> {
    let unreadable = ("", "its header is not a dictionary; save it with numpy.save");
    let (mut descr, mut fortran_order, mut shape) = (None, None, None);
    let mut scanner = Scanner { rest: text };
    scanner.symbol('{').ok_or(unreadable)?;
    while scanner.symbol('}').is_none() {
        let key = scanner.quoted().ok_or(unreadable)?;
        scanner.symbol(':').ok_or(unreadable)?;
        match key {
            DESCR => {
                let reason = "it has to hold plain numbers, and no structures or objects";
                descr = Some(scanner.quoted().ok_or((DESCR, reason))?.to_owned());
            }
            FORTRAN_ORDER => {
                let value = scanner.boolean().ok_or((FORTRAN_ORDER, "it is not True or False"))?;
                fortran_order = Some(value);
            }
            SHAPE => shape = Some(scanner.lengths().ok_or((SHAPE, "it is not a list of lengths"))?),
            _ => return Err(("", "its header has an unknown entry; save it with numpy.save")),
        }
        if scanner.symbol(',').is_none() && !scanner.rest.trim_start().starts_with('}') {
            return Err(unreadable);
        }
    }
    Ok(NpyHeader {
        descr: descr.ok_or((DESCR, "it is missing"))?,
        fortran_order: fortran_order.ok_or((FORTRAN_ORDER, "it is missing"))?,
        shape: shape.ok_or((SHAPE, "it is missing"))?,
    })
}

/// Takes tokens from the front of a text; blanks before them are skipped.
struct Scanner<'a> {
    rest: &'a str,
}

impl<'a> Scanner<'a> {
    fn symbol(&mut self, symbol: char) -> Option<()> {
        self.rest = self.rest.trim_start().strip_prefix(symbol)?;
        Some(())
    }

    fn quoted(&mut self) -> Option<&'a str> {
        let text = self.rest.trim_start();
        let quote = text.chars().next().filter(|first| matches!(first, '\'' | '"'))?;
        let (inside, rest) = text[1..].split_once(quote)?;
        self.rest = rest;
        Some(inside)
    }

    fn boolean(&mut self) -> Option<bool> {
        let text = self.rest.trim_start();
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = text.strip_prefix(word) {
                self.rest = rest;
                return Some(value);
            }
        }
        None
    }

    /// A tuple of whole numbers.
    fn lengths(&mut self) -> Option<Vec<usize>> {
        self.symbol('(')?;
        let (inside, rest) = self.rest.split_once(')')?;
        self.rest = rest;
        let inside = inside.trim();
        let inside = inside.strip_suffix(',').unwrap_or(inside);
        if inside.is_empty() {
            return Some(Vec::new());
        }
        inside.split(',').map(|length| length.trim().parse().ok()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_of_all_kinds_are_read() {
        let header = |shape: &[usize]| NpyHeader {
            descr: "<f4".to_owned(),
            fortran_order: false,
            shape: shape.to_vec(),
        };
        let text = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), }   \n";
        assert_eq!(parse(text), Ok(header(&[2, 3, 4])));
        assert_eq!(
            parse("{\"shape\":(7,),\"descr\":\"<f4\",\"fortran_order\":False}"),
            Ok(header(&[7]))
        );
        let text = "{'descr': '<f4', 'fortran_order': False, 'shape': ()}";
        assert_eq!(parse(text), Ok(header(&[])));
    }

    /// The bytes that `numpy.load` has read from the first version on.
    #[test]
    fn written_headers_have_their_length_whatever_the_shape() {
        let header = float_header([540, 960, 3]);
        let entries = b"{'descr': '<f4', 'fortran_order': False, 'shape': (540, 960, 3, ), }";
        assert_eq!(&header[..10], b"\x93NUMPY\x01\x00\x76\x00");
        assert_eq!(&header[10..10 + entries.len()], entries);
        assert!(header[10 + entries.len()..127].iter().all(|&byte| byte == b' '));
        for shape in [[540, 960, 3], [1, 1, 1], [u32::MAX; 3]] {
            let file = [&float_header(shape)[..], &[7]].concat();
            assert_eq!((file.len(), file[127]), (129, b'\n'));
            let (header, data) = split(&file).unwrap();
            assert_eq!((header.descr.as_str(), header.fortran_order), ("<f4", false));
            assert_eq!((header.shape, data), (shape.map(|n| n as usize).to_vec(), &[7][..]));
        }
    }

    #[test]
    fn flaws_are_named() {
        let field = |text: &str| parse(text).unwrap_err().0;
        assert_eq!(field("{'descr': [('r', '<f4')], 'fortran_order': False, 'shape': ()}"), DESCR);
        assert_eq!(field("{'descr': '<f4', 'fortran_order': 0, 'shape': ()}"), FORTRAN_ORDER);
        assert_eq!(field("{'descr': '<f4', 'fortran_order': True, 'shape': (-1, 2)}"), SHAPE);
        assert_eq!(field("{'descr': '<f4', 'fortran_order': True}"), SHAPE);
        assert_eq!(field("{'descr': '<f4' 'fortran_order': True}"), "");
        assert_eq!(field(&"{(".repeat(100_000)), "");
    }
}
