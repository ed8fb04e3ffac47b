//! Orientation of an environment in the world.

use glam::Vec3A;

/// The world's up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// +y is up.
    Y,
    /// +z is up.
    #[default]
    Z,
}

/// Orientation of an environment. In its own space +z is up, and +x the direction that the middle
/// column of an image of it looks along.
#[derive(Clone, Copy, Debug)]
pub struct Orientation {
    /// The own axes in the world.
    axes: [Vec3A; 3],
}

impl Default for Orientation {
    fn default() -> Self {
        Self::new(Up::default(), 0.0)
    }
}

impl Orientation {
    /// An environment that is turned counter-clockwise about the world's `up`, seen from above, by
    /// an angle in degrees. Without that the middle column of its image looks along +z where +y is
    /// up, and along −y where +z is up; the column a quarter of the image further left looks along
    /// +x in both.
    pub fn new(up: Up, degrees: f32) -> Self {
        let (middle, left, up) = match up {
            Up::Y => (Vec3A::Z, Vec3A::X, Vec3A::Y),
            Up::Z => (Vec3A::NEG_Y, Vec3A::X, Vec3A::Z),
        };
        let (sin, cos) = sin_cos(degrees);
        Self { axes: [cos * middle + sin * left, cos * left - sin * middle, up] }
    }

    /// A direction of the environment's own space in the world.
    #[inline]
    pub fn world_from_local(&self, local: Vec3A) -> Vec3A {
        local.x * self.axes[0] + local.y * self.axes[1] + local.z * self.axes[2]
    }

    /// A direction of the world in the environment's own space.
    #[inline]
    pub fn local_from_world(&self, world: Vec3A) -> Vec3A {
        Vec3A::from_array(self.axes.map(|axis| world.dot(axis)))
    }
}

/// Sine and cosine of an angle in degrees; exact at quarters of a turn.
fn sin_cos(degrees: f32) -> (f32, f32) {
    let quarters = (f64::from(degrees) / 90.0).round();
    let (sin, cos) = (f64::from(degrees) - 90.0 * quarters).to_radians().sin_cos();
    let (sin, cos) = (sin as f32, cos as f32);
    match quarters.rem_euclid(4.0) as u32 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}
