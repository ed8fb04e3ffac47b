//! Radiance pictures (`.hdr`): three mantissas and a common exponent a pixel, run-length encoded
//! (Ward 1991, *Real Pixels*, in Graphics Gems II).
//!
//! `EXPOSURE` of the header is not heeded, as elsewhere: the values are taken as they are stored.

use glam::{DVec2, UVec2};

use super::primaries::Primaries;

/// Beginnings of the files.
const MAGICS: [&[u8]; 2] = [b"#?RADIANCE", b"#?RGBE"];
/// Longest line of a header.
const LONGEST_LINE: usize = 4096;
/// Widths whose lines are encoded component by component.
const WIDTHS: std::ops::Range<usize> = 8..0x8000;

/// Whether a file that starts so is a Radiance picture.
pub fn is_radiance(start: &[u8]) -> bool {
    MAGICS.iter().any(|magic| start.starts_with(magic))
}

/// Header of a picture, before its pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Width and height in pixels, at least 1.
    pub size: UVec2,
    /// Chromaticities, where the file gives them.
    pub primaries: Option<Primaries>,
    /// Offset of the pixels in bytes.
    offset: usize,
}

/// Reads the header.
///
/// # Errors
/// The reason why it is none.
pub fn header(bytes: &[u8]) -> Result<Header, String> {
    let (mut rest, mut primaries, mut is_first) = (bytes, None, true);
    loop {
        let line = next_line(&mut rest)?;
        if line.is_empty() {
            break;
        }
        let line = String::from_utf8_lossy(line);
        if let Some(format) = line.strip_prefix("FORMAT=")
            && format.trim() != "32-bit_rle_rgbe"
        {
            return Err(format!(
                "its pixels are \"{}\"; convert it to 32-bit_rle_rgbe",
                format.trim()
            ));
        }
        if let Some(numbers) = line.strip_prefix("PRIMARIES=") {
            primaries = Some(parse_primaries(numbers)?);
        }
        if is_first && !is_radiance(line.as_bytes()) {
            return Err("it is no Radiance picture".to_owned());
        }
        is_first = false;
    }
    let size = parse_size(&String::from_utf8_lossy(next_line(&mut rest)?))?;
    Ok(Header { size, primaries, offset: bytes.len() - rest.len() })
}

/// Reads the pixels of a picture with that header, row 0 on top.
///
/// # Errors
/// The file ends before its pixels do, or holds a run beyond the end of its line.
pub fn pixels(bytes: &[u8], header: &Header) -> Result<Vec<[f32; 3]>, String> {
    let [width, height] = [header.size.x as usize, header.size.y as usize];
    let mut rest = bytes.get(header.offset..).unwrap_or_default();
    let (mut pixels, mut line) = (Vec::new(), vec![[0; 4]; width]);
    let count = width.checked_mul(height).ok_or("it has too many pixels")?;
    pixels.try_reserve_exact(count).map_err(|_| "its pixels do not fit the memory")?;
    for row in 0..height {
        read_line(&mut rest, &mut line).map_err(|reason| format!("in line {row} {reason}"))?;
        pixels.extend(line.iter().map(color));
    }
    Ok(pixels)
}

/// The next line without its end.
fn next_line<'b>(rest: &mut &'b [u8]) -> Result<&'b [u8], String> {
    let end = rest.iter().take(LONGEST_LINE).position(|&byte| byte == b'\n');
    let Some((line, after)) = end.and_then(|end| rest.split_at_checked(end)) else {
        return Err("its header has no end".to_owned());
    };
    *rest = after.get(1..).unwrap_or_default();
    Ok(line.strip_suffix(b"\r").unwrap_or(line))
}

fn parse_size(line: &str) -> Result<UVec2, String> {
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    let ["-Y", height, "+X", width] = words.as_slice() else {
        let reason =
            format!("\"{line}\" is not \"-Y height +X width\"; write it from the top left");
        return Err(reason);
    };
    match (width.parse(), height.parse()) {
        (Ok(width), Ok(height)) if width > 0 && height > 0 => Ok(UVec2::new(width, height)),
        _ => Err(format!("{width} x {height} is no size of a picture")),
    }
}

fn parse_primaries(text: &str) -> Result<Primaries, String> {
    let numbers: Vec<f64> =
        text.split_ascii_whitespace().map_while(|number| number.parse().ok()).collect();
    let [rx, ry, gx, gy, bx, by, wx, wy] = numbers[..] else {
        return Err("PRIMARIES is not eight numbers".to_owned());
    };
    let rgb = [DVec2::new(rx, ry), DVec2::new(gx, gy), DVec2::new(bx, by)];
    Ok(Primaries { rgb, white: DVec2::new(wx, wy) })
}

/// Reads the pixels of a line in whichever way it is encoded.
fn read_line(rest: &mut &[u8], line: &mut [[u8; 4]]) -> Result<(), String> {
    let width = line.len();
    let by_component = match rest.first_chunk::<4>() {
        Some(&[2, 2, high, low]) if WIDTHS.contains(&width) => {
            usize::from(high) << 8 | usize::from(low) == width
        }
        _ => false,
    };
    if !by_component {
        return read_old_line(rest, line);
    }
    take(rest, 4)?;
    (0..4).try_for_each(|component| read_component(rest, line, component))
}

/// Reads one component of all pixels of a line: runs, and counted single values.
fn read_component(rest: &mut &[u8], line: &mut [[u8; 4]], component: usize) -> Result<(), String> {
    let mut left = line;
    while !left.is_empty() {
        let code = usize::from(take(rest, 1)?[0]);
        let (count, is_run) = if code > 128 { (code - 128, true) } else { (code, false) };
        if count == 0 || count > left.len() {
            return Err("a run goes beyond the end".to_owned());
        }
        let values = take(rest, if is_run { 1 } else { count })?;
        let (now, later) = left.split_at_mut(count);
        for (pixel, value) in now.iter_mut().zip(values.iter().cycle()) {
            pixel[component] = *value;
        }
        left = later;
    }
    Ok(())
}

/// Reads whole pixels, of which (1, 1, 1, n) repeats the one before; the counts of repeats that
/// follow each other are digits of a number to the base of 256, the lowest first.
fn read_old_line(rest: &mut &[u8], line: &mut [[u8; 4]]) -> Result<(), String> {
    let (mut at, mut shift) = (0_usize, 0_u32);
    while at < line.len() {
        let bytes = take(rest, 4)?;
        let pixel = [bytes[0], bytes[1], bytes[2], bytes[3]];
        if pixel[..3] != [1, 1, 1] {
            line[at] = pixel;
            (at, shift) = (at + 1, 0);
            continue;
        }
        let count = usize::from(pixel[3]).checked_shl(shift).filter(|_| shift < 24);
        let end = count.and_then(|count| at.checked_add(count)).filter(|end| *end <= line.len());
        let (Some(end), Some(before)) = (end, at.checked_sub(1)) else {
            return Err("a run goes beyond the end".to_owned());
        };
        let repeated = line[before];
        line[at..end].fill(repeated);
        (at, shift) = (end, shift + 8);
    }
    Ok(())
}

fn take<'b>(rest: &mut &'b [u8], count: usize) -> Result<&'b [u8], String> {
    let (taken, after) = rest.split_at_checked(count).ok_or("the file ends")?;
    *rest = after;
    Ok(taken)
}

fn color(&[r, g, b, exponent]: &[u8; 4]) -> [f32; 3] {
    // Of the exponent 0 whole pixels are black.
    let scale = if exponent == 0 { 0.0 } else { f64::from(i32::from(exponent) - 136).exp2() };
    [r, g, b].map(|mantissa| (f64::from(mantissa) * scale) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "#?RADIANCE\nSOFTWARE=x\nFORMAT=32-bit_rle_rgbe\n\n";

    fn read(head: &str, body: &[u8]) -> Result<Vec<[f32; 3]>, String> {
        let bytes = [head.as_bytes(), body].concat();
        let header = header(&bytes)?;
        pixels(&bytes, &header)
    }

    /// A line in the three ways to write it.
    #[test]
    fn all_encodings_are_read() {
        let one = [128, 64, 0, 129];
        let other = [1, 2, 3, 136];
        let expected: Vec<[f32; 3]> =
            [[[1.0, 0.5, 0.0]; 7].as_slice(), &[[1.0, 2.0, 3.0]]].concat();
        let flat = [one.repeat(7), other.to_vec()].concat();
        let old = [&one[..], &[1, 1, 1, 6], &other[..]].concat();
        let mut new = vec![2, 2, 0, 8];
        for component in 0..4 {
            // A run of six, then two single values.
            new.extend([128 + 6, one[component], 2, one[component], other[component]]);
        }
        for body in [flat, old, new] {
            let head = format!("{HEAD}-Y 1 +X 8\n");
            assert_eq!(read(&head, &body).unwrap(), expected);
            for cut in 0..body.len() {
                assert!(read(&head, &body[..cut]).unwrap_err().contains("in line 0"));
            }
        }
        let head = HEAD.replace("RADIANCE", "RGBE").replace('\n', "\r\n") + "-Y 2 +X 1\r\n";
        assert_eq!(read(&head, &[one, [9, 9, 9, 0]].concat()).unwrap()[1], [0.0; 3]);
    }

    /// A long run in the old encoding takes two repeats, lower digit first.
    #[test]
    fn long_runs_are_counted_in_digits() {
        let body = [&[128, 128, 128, 129][..], &[1, 1, 1, 2], &[1, 1, 1, 1]].concat();
        assert_eq!(read(&format!("{HEAD}-Y 1 +X 259\n"), &body).unwrap(), [[1.0; 3]; 259]);
    }

    #[test]
    fn faulty_files_are_refused_with_the_reason() {
        for (head, body, reason) in [
            ("#?RADIANCE\n", &[][..], "no end"),
            ("P6\n\n-Y 1 +X 1\n", &[], "no Radiance picture"),
            ("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", &[], "convert"),
            ("#?RADIANCE\nPRIMARIES=1 2 x\n\n-Y 1 +X 1\n", &[], "eight numbers"),
            ("#?RADIANCE\n\n+Y 1 +X 1\n", &[], "top left"),
            ("#?RADIANCE\n\n-Y 0 +X 1\n", &[], "no size"),
            ("#?RADIANCE\n\n-Y 1 +X 99999999999\n", &[], "no size"),
            ("#?RADIANCE\n\n-Y 1 +X 1\n", &[1, 1, 1, 1], "beyond the end"),
            ("#?RADIANCE\n\n-Y 1 +X 8\n", &[2, 2, 0, 8, 128 + 9, 1], "beyond the end"),
            ("#?RADIANCE\n\n-Y 1 +X 8\n", &[2, 2, 0, 8, 0, 1], "beyond the end"),
        ] {
            let found = read(head, body).unwrap_err();
            assert!(found.contains(reason), "{head:?}: {found}");
        }
        let zeros = [&[5, 5, 5, 128][..], &[1, 1, 1, 0].repeat(20)].concat();
        assert!(read("#?RADIANCE\n\n-Y 1 +X 2\n", &zeros).is_err());
    }
}
