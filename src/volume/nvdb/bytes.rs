//! Checked look-ups in the bytes of a file.

use glam::{DVec3, IVec3};

use crate::error::{Error, Result};

/// Bytes of which every look-up is checked. Errors name the offset, neither file nor grid.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    /// Number of bytes.
    pub fn len(self) -> usize {
        self.0.len()
    }

    /// The `count` bytes from `at` on.
    pub fn slice(self, at: usize, count: usize) -> Result<&'a [u8]> {
        let end = at.checked_add(count);
        end.and_then(|end| self.0.get(at..end)).ok_or_else(|| {
            let reason = format!(
                "{count} bytes expected where {} are left; the file is cut short or damaged, \
                 export or copy it again",
                self.len().saturating_sub(at)
            );
            broken(at, reason)
        })
    }

    fn array<const N: usize>(self, at: usize) -> Result<[u8; N]> {
        let mut array = [0; N];
        array.copy_from_slice(self.slice(at, N)?);
        Ok(array)
    }

    pub fn u16(self, at: usize) -> Result<u16> {
        self.array(at).map(u16::from_le_bytes)
    }

    pub fn u32(self, at: usize) -> Result<u32> {
        self.array(at).map(u32::from_le_bytes)
    }

    pub fn u64(self, at: usize) -> Result<u64> {
        self.array(at).map(u64::from_le_bytes)
    }

    pub fn i64(self, at: usize) -> Result<i64> {
        self.array(at).map(i64::from_le_bytes)
    }

    pub fn dvec3(self, at: usize) -> Result<DVec3> {
        let number = |axis: usize| self.array(at + 8 * axis).map(f64::from_le_bytes);
        Ok(DVec3::new(number(0)?, number(1)?, number(2)?))
    }

    /// A size or an offset of 64 bits.
    pub fn size(self, at: usize) -> Result<usize> {
        let size = self.u64(at)?;
        usize::try_from(size).map_err(|_| broken(at, "a size beyond what this machine addresses"))
    }

    /// The place that an offset of 64 bits at `at` leads to, counted from `origin`.
    pub fn target(self, at: usize, origin: usize) -> Result<usize> {
        let offset = self.i64(at)?;
        let target = isize::try_from(offset).ok().and_then(|o| origin.checked_add_signed(o));
        target.filter(|&target| target < self.len()).ok_or_else(|| {
            broken(at, "an offset out of the grid; the file is damaged, export or copy it again")
        })
    }

    /// A text of at most `length` bytes, which a zero may end; what is not UTF-8 is replaced.
    pub fn text(self, at: usize, length: usize) -> Result<String> {
        let bytes = self.slice(at, length)?;
        let text = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
        Ok(String::from_utf8_lossy(text).into_owned())
    }
}

/// The error of bytes at `at` that break the format.
pub(super) fn broken(at: usize, reason: impl AsRef<str>) -> Error {
    Error::invalid("", "", format!("at byte {at}: {}", reason.as_ref()))
}

/// The first voxel of a root's entry: 21 bits an axis, z lowest, in units of 4096 voxels.
pub(super) fn origin_of_key(key: u64) -> IVec3 {
    let axis = |shift: u32| ((key >> shift) as u32 & 0x1f_ffff).wrapping_shl(12) as i32;
    IVec3::new(axis(42), axis(21), axis(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn look_ups_past_the_end_are_refused() {
        let bytes = Bytes(&[1, 2, 3, 4, 5, 6, 7, 0x80]);
        assert_eq!((bytes.u16(6).unwrap(), bytes.u32(0).unwrap()), (0x8007, 0x0403_0201));
        assert!(bytes.u32(5).is_err() && bytes.u64(1).is_err() && bytes.u16(usize::MAX).is_err());
        assert!(bytes.slice(8, 0).is_ok() && bytes.slice(1, usize::MAX).is_err());
        assert!(bytes.target(0, 0).is_err(), "an offset far below zero");
        assert_eq!(Bytes(&[0xff; 8]).target(0, 3).unwrap(), 2);
        assert_eq!(Bytes(b"name\0left").text(0, 9).unwrap(), "name");
    }

    #[test]
    fn keys_hold_negative_places_too() {
        let key = |at: IVec3| {
            let [x, y, z] = at.to_array().map(|c| u64::from(c as u32 >> 12));
            z | y << 21 | x << 42
        };
        for at in [[0, 0, 0], [4096, -4096, 8192], [i32::MIN, 0x7fff_f000, -8192]] {
            assert_eq!(origin_of_key(key(at.into())), IVec3::from_array(at));
        }
    }
}
