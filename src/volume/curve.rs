//! Piecewise linear functions of a field's value.

/// A piecewise linear function, constant beyond its ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Points (x, y) in ascending order of x; at least one.
    points: Vec<(f32, f32)>,
}

impl Curve {
    /// The curve through `points` [x, y], which ascend in x; `None` where there is none.
    pub fn new(points: &[[f32; 2]]) -> Option<Self> {
        let points: Vec<_> = points.iter().map(|&[x, y]| (x, y)).collect();
        (!points.is_empty()).then_some(Self { points })
    }

    /// The value at `x`.
    #[inline]
    pub fn at(&self, x: f32) -> f32 {
        let above = self.points.partition_point(|point| point.0 <= x);
        match (above.checked_sub(1).map(|i| self.points[i]), self.points.get(above)) {
            (Some((x0, y0)), Some(&(x1, y1))) => {
                // Rounding must not leave the interval, which bounds rely on.
                (y0 + (y1 - y0) * ((x - x0) / (x1 - x0))).clamp(y0.min(y1), y0.max(y1))
            }
            (Some((_, y)), None) | (None, Some(&(_, y))) => y,
            (None, None) => 0.0,
        }
    }

    /// The least and the largest value over an interval.
    pub fn range(&self, low: f32, high: f32) -> (f32, f32) {
        let ends = [self.at(low), self.at(high)];
        let inside = self.points.iter().filter(|point| low < point.0 && point.0 < high);
        let all = inside.map(|point| point.1).chain(ends);
        all.fold((f32::INFINITY, f32::NEG_INFINITY), |(least, most), y| (least.min(y), most.max(y)))
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::math::PathRng;

    #[test]
    fn a_curve_is_linear_between_its_points_and_held_beyond() {
        let curve = Curve::new(&[[1.0, 4.0], [2.0, 0.0], [4.0, 3.0]]).unwrap();
        for (x, y) in [(-9.0, 4.0), (1.0, 4.0), (1.5, 2.0), (2.0, 0.0), (3.0, 1.5), (9.0, 3.0)] {
            assert_eq!(curve.at(x), y, "at {x}");
        }
        assert_eq!(curve.range(1.5, 3.0), (0.0, 2.0));
        assert_eq!(curve.range(-1.0, 9.0), (0.0, 4.0));
        assert_eq!(Curve::new(&[[3.0, 0.5]]).unwrap().range(-1.0, 9.0), (0.5, 0.5));
        assert_eq!(Curve::new(&[]), None);
    }

    /// No value of an interval leaves the range over it, to the last bit.
    #[test]
    fn ranges_hold_every_value() {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        for _ in 0..2000 {
            let mut x = -1.0;
            let points: Vec<[f32; 2]> = (0..5)
                .map(|_| {
                    x += 1e-3 + rng.uniform();
                    [x, rng.uniform() * 10.0]
                })
                .collect();
            let curve = Curve::new(&points).unwrap();
            let [a, b] = [rng.uniform(), rng.uniform()].map(|u| u * 8.0 - 2.0);
            let (low, high) = (a.min(b), a.max(b));
            let (least, most) = curve.range(low, high);
            for _ in 0..20 {
                let y = curve.at((low + (high - low) * rng.uniform()).clamp(low, high));
                assert!(least <= y && y <= most, "{curve:?} over {low} to {high}: {y}");
            }
        }
    }
}
