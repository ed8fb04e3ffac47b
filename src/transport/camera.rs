//! The camera: rays from its film through a thin lens, at the time of each path.

mod track;
mod view;

use glam::{UVec2, Vec2, Vec3A};

use crate::math::Ray;
use crate::sampling::warp::uniform_disk;
pub use track::Track;
use view::Frame;
pub use view::View;

/// A camera with a thin lens, which may move while the shutter is open; the film conventions are
/// those of the scene format.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The camera at the time of the frame.
    still: Frame,
    lens: Lens,
    track: Track,
}

/// The lens of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Radius of the aperture in world units; 0 for a pinhole, which has everything in focus.
    pub radius: f32,
    /// Distance along the view axis of the plane that is in focus, in world units.
    pub focus_distance: f32,
    /// Shift of the picture to the right and up, in widths of the film.
    pub shift: Vec2,
}

impl Lens {
    /// A pinhole in front of the middle of the film.
    pub const PINHOLE: Self = Self { radius: 0.0, focus_distance: 1.0, shift: Vec2::ZERO };
}

impl Camera {
    /// A pinhole camera at `position` looking at `target`. `fov_x` is the full horizontal angle in
    /// degrees. `None` where position and target coincide or `up` is along the view.
    pub fn look_at(position: Vec3A, target: Vec3A, up: Vec3A, fov_x: f32) -> Option<Self> {
        let view = View { position, target, up, fov_x };
        Some(Self { still: view.frame()?, lens: Lens::PINHOLE, track: Track::default() })
    }

    /// This camera with another lens.
    #[must_use]
    pub fn with_lens(self, lens: Lens) -> Self {
        Self { lens, ..self }
    }

    /// This camera on a track that it follows while the shutter is open.
    #[must_use]
    pub fn on_track(self, track: Track) -> Self {
        Self { track, ..self }
    }

    /// The ray through the point `offset` in [0, 1)² of a pixel and the middle of the lens, at the
    /// time of the frame; row 0 is on top.
    pub fn ray(&self, size: UVec2, pixel: UVec2, offset: Vec2) -> Ray {
        let across = self.still.across(self.film_plane(size, pixel, offset));
        Ray::new(self.still.position, (self.still.forward + across).normalize())
    }

    /// The ray through the point `offset` of a pixel and the point of the lens that `u`, in
    /// [0, 1)², chooses, at `time` in seconds after that of the frame. All rays of a film point
    /// meet in the plane of focus.
    pub(super) fn lens_ray(&self, film: (UVec2, UVec2, Vec2), u: Option<Vec2>, time: f32) -> Ray {
        let frame = self.track.frame(time).unwrap_or(self.still);
        let (size, pixel, offset) = film;
        let through_middle = frame.forward + frame.across(self.film_plane(size, pixel, offset));
        let Some(u) = u else {
            return Ray::new(frame.position, through_middle.normalize()).at_time(time);
        };
        let on_lens = self.lens.radius * uniform_disk(u);
        let aside = on_lens.x * frame.right + on_lens.y * frame.up;
        let to_focus = self.lens.focus_distance * through_middle - aside;
        Ray::new(frame.position + aside, to_focus.normalize()).at_time(time)
    }

    /// Whether the lens has a size, so that rays have to choose a point of it.
    pub(super) fn has_aperture(&self) -> bool {
        self.lens.radius > 0.0
    }

    /// Seconds in which the camera moves, half of them before the time of the frame; 0 for one that
    /// stands still.
    pub(super) fn open_seconds(&self) -> f32 {
        self.track.open_seconds()
    }

    /// A point of the film in half widths of it from the middle of the view, to the right and up.
    fn film_plane(&self, size: UVec2, pixel: UVec2, offset: Vec2) -> Vec2 {
        let [width, height] = size.as_vec2().to_array();
        let place = pixel.as_vec2() + offset;
        let ndc_x = 2.0 * place.x / width - 1.0;
        let ndc_y = (1.0 - 2.0 * place.y / height) * height / width;
        Vec2::new(ndc_x, ndc_y) + 2.0 * self.lens.shift
    }

    /// Position of the middle of the lens in the world, at the time of the frame.
    pub fn position(&self) -> Vec3A {
        self.still.position
    }

    /// Distance of the plane of focus along the view axis, where the lens has a size.
    pub fn focus_distance(&self) -> Option<f32> {
        self.has_aperture().then_some(self.lens.focus_distance)
    }

    /// A point of the world as the camera sees it at the time of the frame: to the right, up and
    /// forward of it.
    pub fn view_from_world(&self, point: Vec3A) -> Vec3A {
        let offset = point - self.still.position;
        let Frame { right, up, forward, .. } = self.still;
        Vec3A::new(offset.dot(right), offset.dot(up), offset.dot(forward))
    }

    /// The place on a film of `size` pixels, row 0 on top, of a point in front of the camera given
    /// in its view; the inverse of [`Camera::ray`].
    pub fn film_from_view(&self, size: UVec2, view: Vec3A) -> Vec2 {
        let size = size.as_vec2();
        let scale = self.pixels_per_length(size.x, view.z);
        let shift = size.x * self.lens.shift * Vec2::new(1.0, -1.0);
        0.5 * size + scale * Vec2::new(view.x, -view.y) - shift
    }

    /// Pixels that a unit of length spans across the view, `depth` in front of the camera on a film
    /// of `width` pixels.
    pub fn pixels_per_length(&self, width: f32, depth: f32) -> f32 {
        0.5 * width / (self.still.tan_half_fov_x * depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_left_edge_is_half_the_field_of_view_away_and_row_zero_is_on_top() {
        let camera = Camera::look_at(Vec3A::ZERO, Vec3A::Y, Vec3A::Z, 90.0).unwrap();
        let size = UVec2::new(200, 100);
        let left = camera.ray(size, UVec2::new(0, 50), Vec2::ZERO).direction;
        assert!((left - Vec3A::new(-1.0, 1.0, 0.0).normalize()).length() < 1e-6, "{left}");
        let top = camera.ray(size, UVec2::new(100, 0), Vec2::ZERO).direction;
        assert!((top - Vec3A::new(0.0, 1.0, 0.5).normalize()).length() < 1e-6, "{top}");
    }

    /// A shift of half a width brings the view axis to the edge of the film, where the frame has
    /// moved away from it.
    #[test]
    fn a_positive_shift_moves_the_frame_right_and_up() {
        let lens = Lens { shift: Vec2::new(0.5, 0.25), ..Lens::PINHOLE };
        let camera = Camera::look_at(Vec3A::ZERO, Vec3A::Y, Vec3A::Z, 90.0).unwrap();
        let camera = camera.with_lens(lens);
        let size = UVec2::new(200, 100);
        let corner = camera.ray(size, UVec2::new(0, 100), Vec2::ZERO).direction;
        assert!((corner - Vec3A::Y).length() < 1e-6, "{corner}");
    }

    #[test]
    fn a_point_on_a_ray_is_seen_where_the_ray_left_the_film() {
        let (position, target) = (Vec3A::new(1.0, -5.0, 2.0), Vec3A::new(0.0, 0.5, 0.3));
        let camera = Camera::look_at(position, target, Vec3A::Z, 50.0).unwrap();
        let shift = Vec2::new(0.3, -0.2);
        let camera = camera.with_lens(Lens { shift, ..Lens::PINHOLE });
        let size = UVec2::new(160, 90);
        for pixel in [UVec2::ZERO, UVec2::new(80, 45), UVec2::new(159, 3)] {
            let ray = camera.ray(size, pixel, Vec2::new(0.25, 0.5));
            let view = camera.view_from_world(ray.at(3.0));
            let seen = camera.film_from_view(size, view);
            let left = pixel.as_vec2() + Vec2::new(0.25, 0.5);
            assert!((seen - left).length() < 1e-3, "{seen} for {left}");
        }
        let depth = camera.view_from_world(target).z;
        assert!(
            (camera.pixels_per_length(2.0, depth) * depth - 1.0 / 25_f32.to_radians().tan()).abs()
                < 1e-4
        );
    }

    /// The lens is as wide as it says, and all rays of a film point meet in the plane of focus.
    #[test]
    fn rays_of_a_film_point_meet_in_the_plane_of_focus() {
        let lens = Lens { radius: 0.25, focus_distance: 4.0, shift: Vec2::new(0.1, 0.0) };
        let camera = Camera::look_at(Vec3A::X, Vec3A::new(1.0, 7.0, 1.0), Vec3A::Z, 60.0).unwrap();
        let camera = camera.with_lens(lens);
        let film = (UVec2::new(80, 60), UVec2::new(61, 7), Vec2::new(0.3, 0.9));
        let meets = |ray: Ray| {
            let speed = camera.view_from_world(ray.origin + ray.direction).z
                - camera.view_from_world(ray.origin).z;
            ray.at(4.0 / speed)
        };
        let middle = meets(camera.lens_ray(film, None, 0.0));
        assert!((camera.view_from_world(middle).z - 4.0).abs() < 1e-5);
        for (u, away) in [(Vec2::ZERO, 0.0), (Vec2::new(1.0, 0.7), 0.25), (Vec2::splat(0.5), 0.177)]
        {
            let ray = camera.lens_ray(film, Some(u), 0.0);
            assert!((meets(ray) - middle).length() < 1e-5, "{ray:?}");
            assert!((ray.origin.distance(camera.position()) - away).abs() < 1e-3, "{ray:?}");
        }
    }

    /// A camera on a track is at the place of each moment, turned as it is there.
    #[test]
    fn a_moving_camera_looks_from_the_place_of_the_moment() {
        let view = |x: f32, fov_x| View {
            position: Vec3A::new(x, -5.0, 0.0),
            target: Vec3A::new(x * x, 0.0, 0.0),
            up: Vec3A::Z,
            fov_x,
        };
        let camera = Camera::look_at(Vec3A::NEG_Y, Vec3A::ZERO, Vec3A::Z, 40.0).unwrap();
        let track = Track::new(vec![(-0.5, view(0.0, 40.0)), (0.25, view(1.5, 70.0))], 1.0);
        let camera = camera.on_track(track);
        let film = (UVec2::new(80, 60), UVec2::new(61, 7), Vec2::new(0.3, 0.9));
        for (time, there) in [(-0.5, 0.0), (0.0, 2.0 / 3.0), (0.25, 1.0), (0.4, 1.0)] {
            let View { position, target, up, fov_x } =
                view(0.0, 40.0).lerp(&view(1.5, 70.0), there);
            let still = Camera::look_at(position, target, up, fov_x).unwrap();
            let (seen, expected) =
                (camera.lens_ray(film, None, time), still.ray(film.0, film.1, film.2));
            assert!(seen.origin.distance(expected.origin) < 1e-5, "at {time}");
            assert!(seen.direction.distance(expected.direction) < 1e-5, "at {time}");
            assert_eq!(seen.time, time);
        }
    }
}
