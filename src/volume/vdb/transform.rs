//! The maps from index space to the world, as files have them.

use glam::{DAffine3, DMat4, DVec3};

use super::stream::{Fault, Result, Stream};
use crate::volume::grid::Transform;

/// Reads the type of the map and the map. A map of another kind is [`Fault::Unsupported`].
pub(super) fn read(stream: &mut Stream) -> Result<Transform> {
    stream.enter("transform");
    let map = stream.text()?;
    let affine = match map.as_str() {
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
        "NonlinearFrustumMap" => {
            return Err(Fault::Unsupported(
                "a frustum transform (voxels that widen away from a camera); resample the grid \
                 into a box before exporting it"
                    .into(),
            ));
        }
        other => {
            return Err(Fault::Unsupported(format!(
                "a transform of type '{other}'; export the grid with an affine transform"
            )));
        }
    };
    Transform::new(affine).ok_or_else(|| Fault::Unsupported(Transform::UNUSABLE.into()))
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
        read(&mut Stream::new(&map(name, values), 0, ""))
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
