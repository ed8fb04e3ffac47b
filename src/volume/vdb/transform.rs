//! The maps from index space to the world, as files have them.

use glam::{DAffine3, DMat4, DVec3};

use super::stream::{Fault, Result, Stream};
use crate::volume::Taper;
use crate::volume::grid::Transform;

/// From this version on the box of a frustum is stored as floating-point numbers.
const FRUSTUM_OF_DOUBLES: u32 = 221;

/// Reads the type of the map and the map, of a file of that `version`. A map of another kind is
/// [`Fault::Unsupported`].
pub(super) fn read(stream: &mut Stream, version: u32) -> Result<Transform> {
    stream.enter("transform");
    let map = stream.text()?;
    match map.as_str() {
        "NonlinearFrustumMap" => frustum(stream, version),
        map => usable(affine(stream, map)?),
    }
}

/// The transform with this map.
fn usable(index_to_world: DAffine3) -> Result<Transform> {
    Transform::new(index_to_world).ok_or_else(|| Fault::Unsupported(Transform::UNUSABLE.into()))
}

/// Reads an affine map of that type.
fn affine(stream: &mut Stream, map: &str) -> Result<DAffine3> {
    Ok(match map {
        "UniformScaleMap" | "ScaleMap" => {
            let [scale, ..] = vectors::<5>(stream)?;
            DAffine3::from_scale(scale)
        }
        "UniformScaleTranslateMap" | "ScaleTranslateMap" => {
            let [translation, scale, ..] = vectors::<6>(stream)?;
            DAffine3 { matrix3: glam::DMat3::from_diagonal(scale), translation }
        }
        "TranslationMap" => DAffine3::from_translation(vectors::<1>(stream)?[0]),
        "AffineMap" | "UnitaryMap" => matrix(stream)?,
        other => {
            return Err(Fault::Unsupported(format!(
                "a transform of type '{other}'; export the grid with an affine transform"
            )));
        }
    })
}

/// Reads a frustum: the box of its index space, which becomes one unit wide at the near end,
/// widened to 1 / taper at the far one, and `depth` deep; then an affine map to the world.
fn frustum(stream: &mut Stream, version: u32) -> Result<Transform> {
    let [min, max] = match version < FRUSTUM_OF_DOUBLES {
        true => [integers(stream)?, integers(stream)?],
        false => vectors::<2>(stream)?,
    };
    let (taper, depth) = (stream.f64()?, stream.f64()?);
    let map = stream.text()?;
    let world_from_unit = affine(stream, &map)?;
    let size = max - min;
    if !(size.is_finite() && size.min_element() > 0.0 && taper.is_finite() && taper > 0.0) {
        return Err(Fault::Unsupported(
            "a frustum transform without extent or with a tip; give its ends a size above zero"
                .into(),
        ));
    }
    let spread = DVec3::new(1.0 / size.x, 1.0 / size.x, depth / size.z);
    let transform = usable(world_from_unit * DAffine3::from_scale(spread))?;
    let center = (0.5 * (min + max)).truncate();
    let taper = Taper { center, near: min.z, growth: (1.0 / taper - 1.0) / size.z };
    Ok(Transform { taper: Some(taper), ..transform })
}

fn integers(stream: &mut Stream) -> Result<DVec3> {
    Ok(DVec3::new(stream.i32()?.into(), stream.i32()?.into(), stream.i32()?.into()))
}

/// Reads adjacent vectors; scale maps keep values derived from the scale behind it.
fn vectors<const N: usize>(stream: &mut Stream) -> Result<[DVec3; N]> {
    let mut vectors = [DVec3::ZERO; N];
    for vector in &mut vectors {
        *vector = DVec3::new(stream.f64()?, stream.f64()?, stream.f64()?);
    }
    Ok(vectors)
}

/// Reads a matrix, stored row by row for row vectors, which is column by column for column vectors.
fn matrix(stream: &mut Stream) -> Result<DAffine3> {
    let mut columns = [0.0; 16];
    for value in &mut columns {
        *value = stream.f64()?;
    }
    let matrix = DMat4::from_cols_array(&columns);
    if matrix.row(3) != glam::DVec4::W {
        return Err(Fault::Unsupported(
            "a projective transform; export the grid with an affine transform".into(),
        ));
    }
    Ok(DAffine3::from_mat4(matrix))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(name: &str, values: &[f64]) -> Vec<u8> {
        let mut bytes = (name.len() as u32).to_le_bytes().to_vec();
        bytes.extend(name.bytes());
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    fn read_map(name: &str, values: &[f64]) -> Result<Transform> {
        read(&mut Stream::new(&map(name, values), 0, ""), 224)
    }

    /// A frustum over the box from (-8, -8, -8) to (9, 14, 8), 10 deep, that doubles its width.
    fn frustum_bytes(version: u32, taper: f64) -> Vec<u8> {
        let corners = [-8, -8, -8, 9, 14, 8];
        let mut bytes = map("NonlinearFrustumMap", &[]);
        match version < 221 {
            true => corners.iter().for_each(|c: &i32| bytes.extend(c.to_le_bytes())),
            false => corners.iter().for_each(|&c| bytes.extend(f64::from(c).to_le_bytes())),
        }
        [taper, 10.0].iter().for_each(|value| bytes.extend(value.to_le_bytes()));
        bytes.extend(map("ScaleMap", &[0.1; 15]));
        bytes
    }

    #[test]
    fn frustums_widen_with_depth() {
        for version in [220, 221, 225] {
            let bytes = frustum_bytes(version, 0.5);
            let transform = read(&mut Stream::new(&bytes, 0, ""), version).unwrap();
            let world = transform.point(DVec3::new(3.0, -2.0, 5.0));
            let expected = DVec3::new(0.026_654_411_764, -0.053_308_823_529, 0.8125);
            assert!((world - expected).length() < 1e-9, "{world}");
            assert_eq!(transform.voxel_size.z, 0.0625);
            for length in 0..bytes.len() {
                let cut = read(&mut Stream::new(&bytes[..length], 0, ""), version);
                assert!(matches!(cut, Err(Fault::Broken { .. })), "{length}");
            }
        }
        for taper in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let found = read(&mut Stream::new(&frustum_bytes(224, taper), 0, ""), 224);
            assert!(matches!(found, Err(Fault::Unsupported(_))), "{taper}");
        }
    }

    #[test]
    fn affine_maps_carry_their_translation_in_the_last_row() {
        #[rustfmt::skip]
        let rows = [0.0, 2.0, 0.0, 0.0,  -3.0, 0.0, 0.0, 0.0,  0.0, 0.0, 4.0, 0.0,  5.0, 6.0, 7.0, 1.0];
        let transform = read_map("AffineMap", &rows).unwrap();
        assert_eq!(transform.voxel_size, DVec3::new(2.0, 3.0, 4.0));
        let world = transform.index_to_world.transform_point3(DVec3::new(1.0, 10.0, 0.0));
        assert_eq!(world, DVec3::new(-25.0, 8.0, 7.0));
    }

    #[test]
    fn translations_come_before_scales() {
        let values: Vec<f64> = (1..=18).map(f64::from).collect();
        let transform = read_map("ScaleTranslateMap", &values).unwrap();
        let world = transform.index_to_world.transform_point3(DVec3::ONE);
        assert_eq!(world, DVec3::new(5.0, 7.0, 9.0));
        let moved = read_map("TranslationMap", &values).unwrap();
        assert_eq!(moved.index_to_world.translation, DVec3::new(1.0, 2.0, 3.0));
    }

    #[test]
    fn other_maps_and_flat_ones_are_refused() {
        for name in ["NonlinearFrustumMap", "SomethingElse"] {
            assert!(matches!(read_map(name, &[0.0; 40]), Err(Fault::Unsupported(_))));
        }
        for scale in [0.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(read_map("ScaleMap", &[scale; 15]), Err(Fault::Unsupported(_))));
        }
        assert!(matches!(read_map("AffineMap", &[1.0; 16]), Err(Fault::Unsupported(_))));
        assert!(matches!(read_map("AffineMap", &[1.0; 15]), Err(Fault::Broken { .. })));
    }
}
