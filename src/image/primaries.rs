//! Colors of other primaries in linear Rec.709.

use glam::{DMat3, DVec2, DVec3, Mat3A};

/// CIE xy chromaticities of a color space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primaries {
    /// Red, green and blue.
    pub rgb: [DVec2; 3],
    /// White: equal values of all channels.
    pub white: DVec2,
}

/// Primaries of Rec.709 with its white, D65.
pub const REC_709: Primaries = Primaries {
    rgb: [DVec2::new(0.64, 0.33), DVec2::new(0.30, 0.60), DVec2::new(0.15, 0.06)],
    white: DVec2::new(0.3127, 0.3290),
};

/// The largest difference of chromaticities that are taken to be the same.
const SAME: f64 = 2e-4;

impl Primaries {
    /// Transform of linear values to Rec.709, in which white stays white (after Bradford); `None`
    /// where the primaries span no color space. It is the identity where they are Rec.709's.
    pub fn rec_709_from_rgb(&self) -> Option<Mat3A> {
        if self.is_same(&REC_709) {
            return Some(Mat3A::IDENTITY);
        }
        let (from, to) = (self.xyz_from_rgb()?, REC_709.xyz_from_rgb()?);
        let cones = [self.white, REC_709.white].map(|white| BRADFORD * xyz(white));
        let adapt = BRADFORD.inverse() * DMat3::from_diagonal(cones[1] / cones[0]) * BRADFORD;
        let matrix = (to.inverse() * adapt * from).as_mat3();
        matrix.is_finite().then(|| matrix.into())
    }

    fn is_same(&self, other: &Self) -> bool {
        let near = |a: DVec2, b: DVec2| (a - b).abs().max_element() <= SAME;
        near(self.white, other.white)
            && std::iter::zip(self.rgb, other.rgb).all(|(a, b)| near(a, b))
    }

    fn xyz_from_rgb(&self) -> Option<DMat3> {
        let [r, g, b] = self.rgb.map(xyz);
        let primaries = DMat3::from_cols(r, g, b);
        let spans = primaries.is_finite() && primaries.determinant().abs() > 1e-9;
        let scales = spans.then(|| primaries.inverse() * xyz(self.white))?;
        scales.is_finite().then(|| primaries * DMat3::from_diagonal(scales))
    }
}

/// Cone responses of XYZ (Lam 1985, known as Bradford), column by column.
const BRADFORD: DMat3 = DMat3::from_cols(
    DVec3::new(0.8951, -0.7502, 0.0389),
    DVec3::new(0.2664, 1.7135, -0.0685),
    DVec3::new(-0.1614, 0.0367, 1.0296),
);

/// XYZ of a chromaticity at Y = 1.
fn xyz(xy: DVec2) -> DVec3 {
    DVec3::new(xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y)
}

#[cfg(test)]
mod tests {
    use glam::Vec3A;

    use super::*;

    /// White stays white, and colors come out as published: Rec.2020's green (ITU-R BT.2087) and
    /// the white of ACES, D60.
    #[test]
    fn known_spaces_become_rec_709() {
        let same = REC_709.rec_709_from_rgb().unwrap();
        assert_eq!(same, Mat3A::IDENTITY);
        let rec_2020 = Primaries {
            rgb: [DVec2::new(0.708, 0.292), DVec2::new(0.170, 0.797), DVec2::new(0.131, 0.046)],
            ..REC_709
        };
        let matrix = rec_2020.rec_709_from_rgb().unwrap();
        let near = |a: Vec3A, b: Vec3A| assert!((a - b).abs().max_element() < 2e-3, "{a} {b}");
        near(matrix * Vec3A::ONE, Vec3A::ONE);
        near(matrix * Vec3A::X, Vec3A::new(1.6605, -0.1246, -0.0182));
        near(matrix * Vec3A::Y, Vec3A::new(-0.5876, 1.1329, -0.1006));
        let acescg = Primaries {
            rgb: [DVec2::new(0.713, 0.293), DVec2::new(0.165, 0.830), DVec2::new(0.128, 0.044)],
            white: DVec2::new(0.32168, 0.33767),
        };
        let matrix = acescg.rec_709_from_rgb().unwrap();
        near(matrix * Vec3A::ONE, Vec3A::ONE);
        // As published for Bradford: 1.70505 -0.62179 -0.08326.
        near(matrix * Vec3A::X, Vec3A::new(1.7051, -0.1302, -0.0240));
    }

    #[test]
    fn primaries_on_a_line_are_no_space() {
        let line = Primaries {
            rgb: [DVec2::new(0.1, 0.1), DVec2::new(0.2, 0.2), DVec2::new(0.3, 0.3)],
            ..REC_709
        };
        assert!(line.rec_709_from_rgb().is_none());
        for bad in [0.0, f64::NAN, f64::INFINITY] {
            let white = DVec2::new(0.3, bad);
            assert!(Primaries { white, ..line }.rec_709_from_rgb().is_none());
            assert!(Primaries { white, ..REC_709 }.rec_709_from_rgb().is_none());
        }
    }
}
