use std::f32::consts::PI;

use glam::UVec2;

use super::*;
use crate::math::{PathRng, luminance};
use crate::sampling::chi2::Sphere;

/// A size of maps whose texels have their edges on those of the bins of [`Sphere::even`].
const SIZE: UVec2 = UVec2::new(16, 8);

fn turned(radiance: Radiance) -> Environment {
    let scale = Rgb::new(0.5, 1.0, 2.0);
    Environment::new(radiance, scale, Orientation::new(Up::Z, 90.0), false)
}

fn gradient(colors: [f32; 3]) -> Environment {
    turned(Radiance::Gradient(Gradient::new(colors.map(Rgb::splat))))
}

/// A map of `size` with the gray values that `value` says for column and row.
fn gray(size: UVec2, value: impl Fn(u32, u32) -> f32) -> (RadianceMap, usize) {
    let places = (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y)));
    let texels = places.map(|(x, y)| [value(x, y); 3]).collect();
    RadianceMap::new(size, texels).unwrap()
}

fn map(value: impl Fn(u32, u32) -> f32) -> Environment {
    turned(Radiance::Map(Arc::new(gray(SIZE, value).0)))
}

/// Environments that vary in every way.
fn environments() -> Vec<(&'static str, Environment)> {
    vec![
        ("gradient", gradient([0.2, 1.0, 3.0])),
        ("gradient without a horizon", gradient([0.0, 0.0, 2.0])),
        ("gradient that falls to nothing", gradient([3.0, 1.0, 0.0])),
        ("bright horizon", gradient([0.0, 1.0, 0.0])),
        ("sun of one texel", map(|x, y| if (x, y) == (11, 2) { 1e5 } else { 0.1 })),
        ("black but for one texel", map(|x, y| if (x, y) == (0, 7) { 1.0 } else { 0.0 })),
        ("black half", map(|x, y| if y < 4 { (x + 1) as f32 } else { 0.0 })),
    ]
}

/// Directions are drawn with the density that is told, which integrates to one.
#[test]
fn directions_follow_the_density() {
    for (name, environment) in environments() {
        let sample = |rng: &mut PathRng| {
            let u = [0; 2].map(|_| f64::from(rng.uniform()));
            environment.sample(u).map(|drawn| drawn.direction)
        };
        let pdf = |direction| environment.pdf_solid_angle(direction);
        Sphere::even(Vec3A::Z).assert_follows(name, sample, pdf);
    }
}

/// A light sample has the radiance and the density of its direction, and the mean of the radiance
/// over the density is the light of all directions.
#[test]
fn samples_have_the_radiance_of_their_direction() {
    const DRAWS: u32 = 40_000;
    for (name, environment) in environments() {
        let (mut sum, mut differ) = (0.0, 0);
        let brightest = if name.starts_with("sun") { 2e5 } else { 32.0 };
        for index in 0..DRAWS {
            // An even lattice (Fibonacci).
            let u = [(f64::from(index) + 0.5) / f64::from(DRAWS), f64::from(index) * 0.618_034];
            let drawn = environment.sample(u.map(f64::fract)).unwrap();
            assert!(drawn.can_be_met && drawn.distance.is_infinite());
            assert!((drawn.direction.length() - 1.0).abs() < 1e-5, "{name}");
            sum += luminance(drawn.radiance) / drawn.pdf;
            // Between texels, single precision tells places apart to a hundred thousandth.
            let error = environment.radiance(drawn.direction) - drawn.radiance;
            assert!(error.abs().max_element() <= 2e-5 * brightest, "{name}: {error}");
            // On the edge of a texel rounding may decide.
            let pdf = environment.pdf_solid_angle(drawn.direction);
            differ += u32::from((pdf / drawn.pdf - 1.0).abs() > 1e-3);
        }
        assert!(differ < DRAWS / 1000, "{name}: {differ} densities differ");
        let ratio = sum / DRAWS as f32 / luminance(environment.fluence());
        // The light of maps is summed up by texels, and interpolated between them.
        let most = if name.contains("texel") { 0.1 } else { 0.02 };
        assert!((ratio - 1.0).abs() < most, "{name}: {ratio}");
    }
}

/// The light of a gradient, and the irradiance of a plane that faces up, in closed form.
#[test]
fn a_gradient_lights_a_plane_as_its_formula_says() {
    let (bottom, horizon, top) = (0.3, 1.0, 4.0);
    let sky = Gradient::new([bottom, horizon, top].map(Rgb::splat));
    let steps = 2000;
    let sines = (0..steps).map(|i| (i as f32 + 0.5) / steps as f32);
    let ring = 2.0 * PI / steps as f32;
    let irradiance: f32 = sines.clone().map(|s| ring * s * sky.radiance(s).x).sum();
    let expected = PI * (horizon + 2.0 / 3.0 * (top - horizon));
    assert!((irradiance / expected - 1.0).abs() < 1e-3, "{irradiance} for {expected}");
    let fluence: f32 = sines.map(|s| ring * (sky.radiance(s).x + sky.radiance(-s).x)).sum();
    assert!((fluence / sky.fluence().x - 1.0).abs() < 1e-3, "{fluence}");
    assert_eq!(sky.radiance(1.0).x, top);
    assert_eq!(sky.radiance(-1.0).x, bottom);
    assert_eq!(sky.radiance(0.0).x, horizon);
}

/// The middle column looks along −y where +z is up and along +z where +y is up; the left quarter
/// along +x; a rotation turns the environment counter-clockwise seen from above.
#[test]
fn images_are_oriented_as_the_conventions_say() {
    let size = UVec2::new(64, 32);
    // One bright texel, the first to the right of a column and just above the horizon.
    let at = |column: u32, up, degrees| {
        let marked = gray(size, |x, y| if (x, y) == (column, 15) { 1.0 } else { 0.0 }).0;
        let orientation = Orientation::new(up, degrees);
        Environment::new(Radiance::Map(Arc::new(marked)), Rgb::ONE, orientation, false)
    };
    let (middle, left, right) = (32, 16, 48);
    for (up, column, degrees, expected) in [
        (Up::Z, middle, 0.0, Vec3A::NEG_Y),
        (Up::Z, left, 0.0, Vec3A::X),
        (Up::Z, right, 0.0, Vec3A::NEG_X),
        (Up::Z, middle, 90.0, Vec3A::X),
        (Up::Z, left, 90.0, Vec3A::Y),
        (Up::Z, middle, -450.0, Vec3A::NEG_X),
        (Up::Y, middle, 0.0, Vec3A::Z),
        (Up::Y, left, 0.0, Vec3A::X),
        (Up::Y, right, 0.0, Vec3A::NEG_X),
        (Up::Y, middle, 90.0, Vec3A::X),
        (Up::Y, left, 90.0, Vec3A::NEG_Z),
        (Up::Y, middle, 180.0, Vec3A::NEG_Z),
    ] {
        let environment = at(column, up, degrees);
        let angle = environment.middle().angle_between(expected);
        assert!(angle < 0.11, "{up:?} {column} {degrees}: {}", environment.middle());
        assert!(environment.radiance(environment.middle()).x > 0.9);
        assert_eq!(environment.radiance(-expected), Rgb::ZERO);
    }
    // The top row is up.
    for (up, direction) in [(Up::Y, Vec3A::Y), (Up::Z, Vec3A::Z)] {
        let radiance = Radiance::Map(Arc::new(gray(size, |_, y| if y < 2 { 1.0 } else { 0.0 }).0));
        let environment = Environment::new(radiance, Rgb::ONE, Orientation::new(up, 30.0), false);
        assert_eq!(environment.radiance(direction).x, 1.0);
        assert_eq!(environment.radiance(-direction).x, 0.0);
    }
}

/// An environment that is the same everywhere is no light to sample, whatever it was written as.
#[test]
fn even_environments_are_recognized() {
    for (even, value) in [
        (Environment::even(Rgb::splat(2.0)), 2.0),
        (gradient([3.0; 3]), 3.0),
        (map(|_, _| 5.0), 5.0),
        (turned(Radiance::Map(Arc::new(gray(UVec2::ONE, |_, _| 7.0).0))), 7.0),
        (map(|_, _| 0.0), 0.0),
        (gradient([0.0; 3]), 0.0),
    ] {
        assert!(!even.varies());
        assert_eq!(even.radiance(Vec3A::X).y, value);
        assert_eq!(even.is_black(), value == 0.0);
        assert!(even.sample([0.5; 2]).is_none());
    }
    let tint = Environment::new(
        Radiance::Gradient(Gradient::new([Rgb::ZERO, Rgb::ONE, Rgb::ONE])),
        Rgb::ZERO,
        Orientation::default(),
        false,
    );
    assert!(tint.is_black() && !tint.varies());
}

/// Values that are no radiance are counted and become 0; huge ones stay finite in every sum.
#[test]
fn maps_of_odd_values_stay_finite() {
    let odd = [f32::NAN, f32::INFINITY, -1.0, f32::MAX, 1e-40, 1.0, -0.0, 1.0];
    let (map, mended) = gray(UVec2::new(4, 2), |x, y| odd[(4 * y + x) as usize]);
    assert_eq!(mended, 3);
    assert!(map.fluence().is_finite() && map.middle().is_finite());
    let environment = turned(Radiance::Map(Arc::new(map)));
    for index in 0..100 {
        let drawn = environment.sample([f64::from(index) / 100.0, 0.99]).unwrap();
        assert!(drawn.radiance.is_finite() && drawn.pdf.is_finite() && drawn.pdf >= 0.0);
        assert!(environment.radiance(drawn.direction).is_finite());
    }
    assert!(RadianceMap::new(UVec2::new(0, 3), Vec::new()).is_none());
    assert!(RadianceMap::new(UVec2::new(2, 3), vec![[0.0; 3]; 5]).is_none());
    assert!(RadianceMap::new(UVec2::splat(u32::MAX), vec![[0.0; 3]; 5]).is_none());
}
