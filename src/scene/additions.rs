//! The things that artists add to a shot most: lights and a floor, placed and measured so that they
//! show.

use glam::Vec3A;

use super::settings::{
    CameraSettings, Color, Extent, LightKind, LightSettings, MaterialSettings, SurfaceSettings,
    SurfaceShape,
};
use crate::format::two_digits;
use crate::math::Aabb;

/// The irradiance that a new light brings to the middle of the picture.
const IRRADIANCE: f32 = 3.0;
/// Position of a new lamp from the camera's target: to the right, up and towards the camera, in
/// half widths of the picture there. It lies within the picture, so that its handles can be
/// dragged.
const LAMP: Vec3A = Vec3A::new(-0.45, 0.3, 0.8);
/// Radius of a new ball and half the edge of a new quad, in the same measure.
const BALL: f32 = 0.12;
const QUAD: f32 = 0.3;
/// Half the edge of a floor, in sizes of what stands on it.
const FLOOR: f32 = 20.0;
/// Gap between a floor and the volume above it, in heights of the volume, so that nothing flickers
/// where both would meet.
const GAP: f32 = 1e-3;
/// The color of a new floor.
const FLOOR_REFLECTANCE: f32 = 0.4;

/// A new light of that kind, placed for what `camera` sees.
pub fn new_light(kind: LightKind, camera: &CameraSettings) -> LightSettings {
    let (center, eye) = (Vec3A::from(camera.target), Vec3A::from(camera.position));
    let away = eye - center;
    let size = away.length().max(1e-3) * (0.5 * camera.fov_x.to_radians()).tan();
    let back = away.normalize_or(Vec3A::NEG_Y);
    let right = Vec3A::from(camera.up).cross(back).try_normalize();
    let right = right.unwrap_or_else(|| back.any_orthonormal_vector());
    let lamp = LAMP.x * right + LAMP.y * back.cross(right) + LAMP.z * back;
    let position = rounded(center + size * lamp, size);
    let towards = center - position;
    let distance = towards.length();
    let facing = towards.normalize_or(Vec3A::NEG_Z);
    let intensity = IRRADIANCE * distance * distance;
    let light = LightSettings { kind, ..LightSettings::default() };
    let gray = |value: f32| Color::Gray(two_digits(value));
    match kind {
        LightKind::Sun => LightSettings {
            intensity: gray(IRRADIANCE),
            direction: Some(rounded(facing, 1.0).to_array()),
            ..light
        },
        LightKind::Point => LightSettings {
            intensity: gray(intensity),
            position: Some(position.to_array()),
            ..light
        },
        LightKind::Spot => LightSettings {
            intensity: gray(intensity),
            position: Some(position.to_array()),
            target: Some(rounded(center, size).to_array()),
            ..light
        },
        LightKind::Sphere => {
            let radius = two_digits(BALL * size);
            let area = std::f32::consts::PI * radius * radius;
            LightSettings {
                intensity: gray(intensity / area),
                center: Some(position.to_array()),
                radius: Some(radius),
                ..light
            }
        }
        LightKind::Quad => {
            let half = two_digits(QUAD * size);
            let across = facing.cross(Vec3A::Z).normalize_or(Vec3A::X);
            let edges = [across, across.cross(facing)].map(|edge| rounded(half * edge, half));
            LightSettings {
                intensity: gray(intensity / (4.0 * half * half)),
                center: Some(position.to_array()),
                half_u: Some(edges[0].to_array()),
                half_v: Some(edges[1].to_array()),
                ..light
            }
        }
    }
}

/// A gray floor under `bounds` in a world where `up` is up.
pub fn floor_under(bounds: &Aabb, up: Vec3A) -> SurfaceSettings {
    let axis = up.abs().max_position();
    let sign = if up[axis] < 0.0 { -1.0 } else { 1.0 };
    let mut normal = Vec3A::ZERO;
    normal[axis] = sign;
    let lowest = if sign > 0.0 { bounds.min[axis] } else { bounds.max[axis] };
    let mut point = rounded(bounds.center(), bounds.size().max_element());
    point[axis] = lowest - sign * GAP * bounds.size()[axis];
    SurfaceSettings {
        shape: SurfaceShape::Plane,
        point: Some(point.to_array()),
        normal: Some(normal.to_array()),
        half_size: Some(Extent::Uniform(two_digits(FLOOR * bounds.size().max_element()))),
        material: Some(MaterialSettings {
            reflectance: Some(Color::Gray(FLOOR_REFLECTANCE)),
            ..MaterialSettings::default()
        }),
        ..SurfaceSettings::default()
    }
}

/// `vector` in steps of a hundredth of `size`, or of the next power of ten below, as one types it.
fn rounded(vector: Vec3A, size: f32) -> Vec3A {
    let step = 10.0_f32.powf((size.max(f32::MIN_POSITIVE) * 0.01).log10().floor());
    // Dividing by a whole number keeps the digits that multiplying by a fraction would spoil.
    let steps = (1.0 / step).round();
    let rounded = if steps >= 1.0 {
        (vector * steps).round() / steps
    } else {
        (vector / step).round() * step
    };
    // Adding zero takes the sign off it.
    rounded + Vec3A::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::NO_PROGRESS;
    use crate::scene::{Settings, VolumeCache, assemble, validate};
    use glam::Vec3;

    const KINDS: [LightKind; 5] =
        [LightKind::Sun, LightKind::Point, LightKind::Spot, LightKind::Sphere, LightKind::Quad];

    #[test]
    fn every_new_light_is_valid_and_lights_the_middle_as_brightly() {
        let camera = CameraSettings {
            position: [4.0, -9.0, 3.0],
            target: [1.0, 0.5, 2.0],
            ..CameraSettings::default()
        };
        for kind in KINDS {
            let light = new_light(kind, &camera);
            let mut scene = Settings { light: vec![light.clone()], ..Settings::default() };
            scene.camera = camera.clone();
            validate(&scene, "").unwrap();
            let built = assemble(&scene, &VolumeCache::default(), NO_PROGRESS).unwrap();
            let from = match kind {
                LightKind::Sun => continue,
                LightKind::Point | LightKind::Spot => light.position(),
                LightKind::Sphere | LightKind::Quad => light.center(),
            };
            let area = match kind {
                LightKind::Sphere => std::f32::consts::PI * light.radius().powi(2),
                LightKind::Quad => {
                    4.0 * Vec3::from(light.half_u()).cross(light.half_v().into()).length()
                }
                _ => 1.0,
            };
            let size = glam::UVec2::new(160, 90);
            let seen = built.camera.film_from_view(size, built.camera.view_from_world(from.into()));
            let inside = seen.cmpgt(glam::Vec2::ZERO).all() && seen.cmplt(size.as_vec2()).all();
            assert!(inside, "{kind:?} is out of the picture, at {seen}");
            let distance = Vec3A::from(from).distance(camera.target.into());
            let irradiance = light.intensity.rgb().x * area / (distance * distance);
            assert!((irradiance / IRRADIANCE - 1.0).abs() < 0.1, "{kind:?}: {irradiance}");
        }
    }

    #[test]
    fn a_floor_lies_just_below() {
        let bounds = Aabb::new(Vec3A::new(-1.0, -1.0, 0.5), Vec3A::new(1.0, 1.0, 4.5));
        let floor = floor_under(&bounds, Vec3A::Z);
        assert_eq!(floor.normal(), [0.0, 0.0, 1.0]);
        let height = floor.point()[2];
        assert!(height < 0.5 && height > 0.49, "{height}");
        assert!(floor.half_size.unwrap().axes()[0] > 10.0 * bounds.size().z);
        let y_down = floor_under(&bounds, Vec3A::new(0.1, -1.0, 0.0));
        assert!(y_down.normal() == [0.0, -1.0, 0.0] && y_down.point()[1] > 1.0);
        let scene = Settings { surface: vec![floor, y_down], ..Settings::default() };
        validate(&scene, "").unwrap();
    }
}
