//! Placement of a volume: the transform from its own space to the world.

use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};

use crate::scene::settings::VolumeSettings;

/// The placement of a volume: scale, then rotation about x, y and z in turn, then translation; or
/// its matrix. In double precision, since a file may lie far from the origin and be moved back.
pub(crate) fn world_from_file(volume: &VolumeSettings) -> DAffine3 {
    let double = |vector: [f32; 3]| DVec3::from_array(vector.map(f64::from));
    if let Some(rows) = volume.matrix {
        let column = |i: usize| double(rows.map(|row| row[i]));
        return DAffine3 {
            matrix3: DMat3::from_cols(column(0), column(1), column(2)),
            translation: column(3),
        };
    }
    let [x, y, z] = double(volume.rotate).to_array().map(f64::to_radians);
    // The last of the three factors acts first.
    let rotation = DQuat::from_euler(EulerRot::ZYX, z, y, x);
    DAffine3::from_scale_rotation_translation(
        double(volume.scale.axes()),
        rotation,
        double(volume.translate),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::settings::Extent;

    fn moved(volume: &VolumeSettings, point: [f64; 3]) -> DVec3 {
        world_from_file(volume).transform_point3(DVec3::from_array(point))
    }

    #[test]
    fn scale_comes_first_then_x_y_z_then_translation() {
        let volume = VolumeSettings {
            scale: Extent::Axes([1.0, 2.0, 3.0]),
            rotate: [90.0, 0.0, 90.0],
            translate: [10.0, 0.0, 0.0],
            ..VolumeSettings::default()
        };
        // (0, 1, 0) is scaled to (0, 2, 0), turned about x to (0, 0, 2) and stays so about z.
        assert!(moved(&volume, [0.0, 1.0, 0.0]).abs_diff_eq(DVec3::new(10.0, 0.0, 2.0), 1e-5));
        // (0, 0, 1): (0, 0, 3), about x to (0, -3, 0), about z to (3, 0, 0).
        assert!(moved(&volume, [0.0, 0.0, 1.0]).abs_diff_eq(DVec3::new(13.0, 0.0, 0.0), 1e-5));
    }

    #[test]
    fn a_matrix_is_rows_for_column_vectors() {
        let matrix = [[0.0, -1.0, 0.0, 5.0], [1.0, 0.0, 0.0, 6.0], [0.0, 0.0, 2.0, 7.0]];
        let volume = VolumeSettings { matrix: Some(matrix), ..VolumeSettings::default() };
        assert_eq!(moved(&volume, [1.0, 2.0, 3.0]), DVec3::new(3.0, 7.0, 13.0));
    }
}
