//! `[camera]`.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::or_default::is_default;
use super::time::MAX_FRAME;

/// Default width of the sensor in millimeters: full frame.
const SENSOR_WIDTH: f32 = 36.0;
/// Default of `units_per_mm`: a scene in meters.
const UNITS_PER_MM: f32 = 0.001;

/// A camera that looks at a target, through a pinhole or a thin lens.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct CameraSettings {
    /// The position of the camera, in world space.
    #[schemars(extend("unit" = "length"))]
    pub position: [f32; 3],
    /// The point that the camera looks at, in world space.
    #[schemars(extend("unit" = "length"))]
    pub target: [f32; 3],
    /// The direction that points up in the picture.
    pub up: [f32; 3],
    /// The horizontal field of view. A scene file may have `focal_length` (mm) in its place, which
    /// means 2 atan(sensor_width / (2 focal_length)).
    #[schemars(extend("unit" = "degrees", "exclusiveMinimum" = 0.0, "maximum" = 179.9))]
    pub fov_x: f32,
    /// The width of the sensor that focal lengths are given for.
    #[serde(skip_serializing_if = "is_full_frame")]
    #[schemars(extend("unit" = "mm", "default" = SENSOR_WIDTH))]
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub sensor_width: f32,
    /// The f-stop: focal length over the diameter of the aperture. The smaller, the less depth is
    /// in focus; 0 is a pinhole, which has everything in focus.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("default" = 0.0), range(min = 0.0, max = 1000.0))]
    pub f_stop: f32,
    /// World units of a millimeter, which give the aperture its size in the scene: 0.001 for a
    /// scene in meters.
    #[serde(skip_serializing_if = "is_in_meters")]
    #[schemars(extend("unit" = "length/mm", "default" = 0.001))]
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1e6))]
    pub units_per_mm: f32,
    /// The distance of the plane of focus along the view axis; absent, that of the target.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("unit" = "length", "default" = null))]
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1e9))]
    pub focus_distance: Option<f32>,
    /// Lens shift: moves the picture's frame to the right and up, as a fraction of its width, and
    /// keeps upright lines upright.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("unit" = "widths", "default" = [0.0, 0.0]))]
    #[schemars(extend("minimum" = -10.0, "maximum" = 10.0))]
    pub shift: [f32; 2],
    /// The camera at some frames: linear between them, held beyond the first and the last.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub key: Vec<CameraKey>,
}

/// Position, target and field of view of the camera in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct CameraKey {
    /// The frame, which may be fractional.
    #[schemars(extend("unit" = "frames"), range(min = -MAX_FRAME, max = MAX_FRAME))]
    pub frame: f64,
    /// The position in this frame; absent, that of the camera.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("unit" = "length", "default" = null))]
    pub position: Option<[f32; 3]>,
    /// The target in this frame; absent, that of the camera.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("unit" = "length", "default" = null))]
    pub target: Option<[f32; 3]>,
    /// The horizontal field of view in this frame; absent, that of the camera. `focal_length` may
    /// stand in its place.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("unit" = "degrees", "default" = null))]
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 179.9))]
    pub fov_x: Option<f32>,
}

fn is_full_frame(width: &f32) -> bool {
    *width == SENSOR_WIDTH
}

fn is_in_meters(units: &f32) -> bool {
    *units == UNITS_PER_MM
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self {
            position: [0.0, -6.0, 0.0],
            target: [0.0; 3],
            up: [0.0, 0.0, 1.0],
            fov_x: 36.0,
            sensor_width: SENSOR_WIDTH,
            f_stop: 0.0,
            units_per_mm: UNITS_PER_MM,
            focus_distance: None,
            shift: [0.0; 2],
            key: Vec::new(),
        }
    }
}

impl CameraSettings {
    /// The camera as it stands in a frame, without keys.
    #[must_use]
    pub fn at(&self, frame: f64) -> Self {
        let mut still = Self { key: Vec::new(), ..self.clone() };
        let after = self.key.partition_point(|key| key.frame <= frame);
        let before = after.checked_sub(1).and_then(|index| self.key.get(index));
        let (start, end) = match (before, self.key.get(after)) {
            (Some(start), Some(end)) => (start, end),
            (Some(held), None) | (None, Some(held)) => (held, held),
            (None, None) => return still,
        };
        let between = match end.frame - start.frame {
            0.0 => 0.0,
            frames => ((frame - start.frame) / frames) as f32,
        };
        let lerp = |a: Option<[f32; 3]>, b: Option<[f32; 3]>, own: [f32; 3]| {
            let [a, b] = [a, b].map(|place| Vec3::from_array(place.unwrap_or(own)));
            if a == b { a.to_array() } else { a.lerp(b, between).to_array() }
        };
        still.position = lerp(start.position, end.position, self.position);
        still.target = lerp(start.target, end.target, self.target);
        let [a, b] = [start.fov_x, end.fov_x].map(|fov_x| fov_x.unwrap_or(self.fov_x));
        still.fov_x = a + between * (b - a);
        still
    }

    /// Makes the camera stand in a frame as `still` does, with its lens. A camera with keys gets
    /// one of that frame, if it moves.
    pub fn set_at(&mut self, frame: f64, still: Self) {
        let present = self.at(frame);
        if self.key.is_empty() {
            *self = still;
            return;
        }
        let pose = |camera: &Self| (camera.position, camera.target, camera.fov_x);
        if pose(&still) != pose(&present) {
            self.put_key(CameraKey::of(&still, frame));
        }
        let Self { position, target, fov_x, .. } = *self;
        *self = Self { position, target, fov_x, key: std::mem::take(&mut self.key), ..still };
    }

    /// The key of a frame, by its index.
    pub fn key_of(&self, frame: f64) -> Option<usize> {
        self.key.iter().position(|key| key.frame == frame)
    }

    /// Adds a key, in place of the one of its frame.
    pub fn put_key(&mut self, key: CameraKey) {
        let at = self.key.partition_point(|other| other.frame < key.frame);
        match self.key.get_mut(at) {
            Some(same) if same.frame == key.frame => *same = key,
            _ => self.key.insert(at, key),
        }
    }

    /// Takes the key of a frame away. The camera stands where the last one was.
    pub fn remove_key(&mut self, frame: f64) {
        if let Some(index) = self.key_of(frame) {
            let still = self.at(frame);
            self.key.remove(index);
            if self.key.is_empty() {
                *self = still;
            }
        }
    }

    /// The whole frames from the first key to the last; `None` without keys.
    pub fn key_range(&self) -> Option<[i32; 2]> {
        let (first, last) = (self.key.first()?, self.key.last()?);
        Some([first.frame.floor() as i32, last.frame.ceil() as i32])
    }

    /// Focal length in millimeters.
    pub fn focal_length(&self) -> f32 {
        focal_length(self.fov_x, self.sensor_width)
    }

    /// Radius of the aperture in world units; 0 for a pinhole.
    pub fn lens_radius(&self) -> f32 {
        match self.f_stop {
            0.0 => 0.0,
            f_stop => self.focal_length() / (2.0 * f_stop) * self.units_per_mm,
        }
    }

    /// `focus_distance`, or its default, the distance of the target.
    pub fn focus_distance(&self) -> f32 {
        let to_target = Vec3::from(self.position).distance(self.target.into());
        self.focus_distance.unwrap_or(to_target)
    }
}

impl CameraKey {
    /// A key of a frame in which the camera stands as `camera` does without keys.
    pub fn of(camera: &CameraSettings, frame: f64) -> Self {
        Self {
            frame,
            position: Some(camera.position),
            target: Some(camera.target),
            fov_x: Some(camera.fov_x),
        }
    }
}

/// The focal length in millimeters of a horizontal field of view in degrees on a sensor of a width
/// in millimeters.
pub fn focal_length(fov_x: f32, sensor_width: f32) -> f32 {
    (0.5 * f64::from(sensor_width) / (0.5 * f64::from(fov_x).to_radians()).tan()) as f32
}

/// The horizontal field of view in degrees of a focal length on a sensor of a width, both in
/// millimeters.
pub fn field_of_view(focal_length: f64, sensor_width: f64) -> f64 {
    2.0 * (0.5 * sensor_width / focal_length).atan().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keyed() -> CameraSettings {
        let key = |frame, x, fov_x| CameraKey {
            frame,
            position: Some([x, -5.0, 0.0]),
            fov_x,
            target: None,
        };
        CameraSettings {
            target: [0.5; 3],
            key: vec![key(1.0, 0.0, None), key(5.0, 2.0, Some(50.0)), key(7.0, 3.0, Some(40.0))],
            ..CameraSettings::default()
        }
    }

    #[test]
    fn keys_are_joined_by_lines_and_held_beyond_the_ends() {
        let camera = keyed();
        let rows = [(-9.0, 0.0, 36.0), (1.0, 0.0, 36.0), (3.0, 1.0, 43.0), (5.0, 2.0, 50.0)];
        for (frame, x, fov_x) in rows.into_iter().chain([(6.5, 2.75, 42.5), (99.0, 3.0, 40.0)]) {
            let still = camera.at(frame);
            assert_eq!((still.position, still.fov_x), ([x, -5.0, 0.0], fov_x), "frame {frame}");
            assert_eq!((still.target, still.key.len()), ([0.5; 3], 0));
        }
    }

    /// Only what moves the camera makes a key, of the frame that it was moved in.
    #[test]
    fn a_camera_that_is_moved_gets_a_key_of_the_frame() {
        let mut camera = keyed();
        let mut still = camera.at(3.0);
        camera.set_at(3.0, still.clone());
        assert_eq!(camera, keyed());
        still.f_stop = 2.0;
        camera.set_at(3.0, still.clone());
        assert_eq!((camera.f_stop, camera.key.len()), (2.0, 3));
        still.position = [9.0; 3];
        camera.set_at(3.0, still.clone());
        assert_eq!(camera.key.len(), 4);
        assert_eq!(camera.at(3.0), still);
        assert_eq!(camera.at(5.0).position, keyed().at(5.0).position);
        still.fov_x = 20.0;
        camera.set_at(3.0, still.clone());
        assert_eq!((camera.key.len(), camera.at(3.0)), (4, still));
    }

    #[test]
    fn without_its_last_key_a_camera_stands_where_that_was() {
        let mut camera = keyed();
        for frame in [1.0, 5.0, 6.0] {
            camera.remove_key(frame);
        }
        let last = camera.at(1.0);
        camera.remove_key(7.0);
        assert_eq!((camera.key.len(), camera.position, camera.fov_x), (0, [3.0, -5.0, 0.0], 40.0));
        assert_eq!(camera, last);
    }

    #[test]
    fn the_aperture_is_the_focal_length_over_the_f_stop() {
        let fov_x = field_of_view(50.0, 36.0) as f32;
        assert!((fov_x - 39.6).abs() < 0.01, "a normal lens");
        let camera = CameraSettings { fov_x, f_stop: 2.0, ..CameraSettings::default() };
        assert!((camera.focal_length() - 50.0).abs() < 1e-4);
        assert!((camera.lens_radius() - 0.0125).abs() < 1e-6, "25 mm wide in meters");
        assert_eq!((camera.focus_distance(), CameraSettings::default().lens_radius()), (6.0, 0.0));
    }
}
