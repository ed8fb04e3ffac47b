//! Surfaces and lights of the settings as the core knows them.

use glam::Vec3A;

use crate::{
    light::{Light, Point, Spot, Sun},
    math::Rgb,
    scene::settings::{
        LightKind, LightSettings, MaterialKind, MaterialSettings, SurfaceSettings, SurfaceShape,
    },
    surface::{Material, Quad, Shape, Sphere, Surface},
};

/// A surface of the scene file.
pub(super) fn surface(settings: &SurfaceSettings) -> Surface {
    let emission = settings.emission.rgb();
    let material = match settings.material {
        Some(material) => self::material(&material),
        None if !settings.emission.is_black() => Material::Black,
        None => self::material(&MaterialSettings::default()),
    };
    Surface { shape: shape(settings), material, emission }
}

fn shape(settings: &SurfaceSettings) -> Shape {
    let center = Vec3A::from_array(settings.center());
    match settings.shape {
        SurfaceShape::Plane => Shape::plane(
            Vec3A::from_array(settings.point()),
            Vec3A::from_array(settings.normal()).normalize(),
            settings.half_size.map(|half_size| half_size.axes()[0]),
        ),
        SurfaceShape::Quad => quad(center, settings.half_u(), settings.half_v()),
        SurfaceShape::Sphere => Shape::Sphere(Sphere { center, radius: settings.radius() }),
        SurfaceShape::Box => {
            let half_size = settings.half_size.unwrap_or_default();
            Shape::cuboid(center, Vec3A::from_array(half_size.axes()))
        }
    }
}

fn quad(center: Vec3A, half_u: [f32; 3], half_v: [f32; 3]) -> Shape {
    Shape::Quad(Quad::new(center, Vec3A::from_array(half_u), Vec3A::from_array(half_v)))
}

fn material(settings: &MaterialSettings) -> Material {
    let reflectance = settings.reflectance().rgb();
    match settings.kind {
        _ if reflectance == Rgb::ZERO => Material::Black,
        MaterialKind::Diffuse => Material::Diffuse { reflectance },
        MaterialKind::Conductor => Material::Conductor { alpha: settings.alpha(), reflectance },
        MaterialKind::Black => Material::Black,
    }
}

/// Light or surface that a light of the scene file becomes.
pub(super) enum LightOrSurface {
    /// A light that no ray meets.
    Light(Light),
    /// An emitting surface: it is seen and hides what is behind it.
    Surface(Surface),
}

/// A light of the scene file.
pub(super) fn light(settings: &LightSettings) -> LightOrSurface {
    let brightness = settings.intensity.rgb();
    let center = Vec3A::from_array(settings.center());
    let position = Vec3A::from_array(settings.position());
    match settings.kind {
        LightKind::Sun => LightOrSurface::Light(Light::Sun(Sun::new(
            Vec3A::from_array(settings.direction()),
            brightness,
            settings.angle(),
            settings.visible,
        ))),
        LightKind::Point => {
            LightOrSurface::Light(Light::Point(Point { position, intensity: brightness }))
        }
        LightKind::Spot => LightOrSurface::Light(Light::Spot(Spot::new(
            position,
            Vec3A::from_array(settings.target()),
            brightness,
            settings.cone(),
            settings.blend(),
        ))),
        LightKind::Sphere => {
            let sphere = Shape::Sphere(Sphere { center, radius: settings.radius() });
            emitter(sphere, brightness, settings.visible)
        }
        LightKind::Quad => emitter(
            quad(center, settings.half_u(), settings.half_v()),
            brightness,
            settings.visible,
        ),
    }
}

fn emitter(shape: Shape, radiance: Rgb, visible: bool) -> LightOrSurface {
    if visible {
        LightOrSurface::Surface(Surface { shape, material: Material::Black, emission: radiance })
    } else {
        LightOrSurface::Light(Light::Invisible { shape, radiance })
    }
}
