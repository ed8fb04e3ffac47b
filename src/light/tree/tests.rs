use glam::UVec2;

use super::*;
use crate::math::{Aabb, PathRng};

fn random(rng: &mut PathRng, scale: f32) -> Vec3A {
    scale * (2.0 * Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform()) - Vec3A::ONE)
}

fn torch(at: Vec3A) -> Emitter {
    let bounds = Aabb::new(at - Vec3A::splat(0.1), at + Vec3A::splat(0.1));
    Emitter { bounds, intensity: 1.0, cone: None }
}

/// Boxes, points and spots of very unequal power, some on top of each other.
fn mixed(count: usize) -> Vec<Emitter> {
    let mut rng = PathRng::new(0, UVec2::ZERO, 0);
    (0..count)
        .map(|i| {
            let at = if i % 7 == 0 { Vec3A::ONE } else { random(&mut rng, 10.0) };
            let size = if i % 3 == 0 { Vec3A::ZERO } else { random(&mut rng, 2.0).abs() };
            let cone = (i % 5 == 0)
                .then(|| (random(&mut rng, 1.0).normalize(), (0.2 + 1.2 * rng.uniform()).cos()));
            let intensity = 10.0_f32.powf(4.0 * rng.uniform() - 2.0);
            Emitter { bounds: Aabb::new(at, at + size), intensity, cone }
        })
        .collect()
}

fn receivers(count: usize) -> Vec<Receiver> {
    let mut rng = PathRng::new(1, UVec2::ZERO, 0);
    (0..count)
        .map(|i| Receiver {
            position: random(&mut rng, if i % 4 == 0 { 100.0 } else { 12.0 }),
            normal: (i % 2 == 0).then(|| random(&mut rng, 1.0).normalize()),
        })
        .collect()
}

/// Whether an emitter really contributes, from a few points of its box.
fn contributes(emitter: &Emitter, to: &Receiver) -> bool {
    let corners = emitter.bounds.corners();
    corners.into_iter().chain([emitter.bounds.center()]).any(|from| {
        let towards = (to.position - from).normalize_or_zero();
        let above = to.normal.is_none_or(|normal| normal.dot(towards) < -1e-4);
        above && emitter.cone.is_none_or(|(axis, cos)| axis.dot(towards) > cos + 1e-4)
    })
}

#[test]
fn every_light_that_can_contribute_can_be_found() {
    for count in [1, 2, 3, 50, 400] {
        let emitters = mixed(count);
        let tree = LightTree::new(&emitters);
        let mut found = 0;
        for to in receivers(60) {
            for (index, emitter) in emitters.iter().enumerate() {
                if contributes(emitter, &to) {
                    found += 1;
                    assert!(tree.probability(index as u32, &to) > 0.0, "{emitter:?} {to:?}");
                    assert!(tree.importance(&to) > 0.0);
                }
            }
        }
        assert!(found >= 5 * count, "{found} contributions of {count} lights");
    }
}

#[test]
fn the_probability_of_a_sample_is_the_one_it_comes_with() {
    let emitters = mixed(300);
    let tree = LightTree::new(&emitters);
    let mut rng = PathRng::new(2, UVec2::ZERO, 0);
    for to in receivers(100) {
        for _ in 0..20 {
            if let Some((index, probability)) = tree.sample(&to, f64::from(rng.uniform())) {
                assert_eq!(probability, tree.probability(index, &to));
            }
        }
    }
}

/// Picks go through [0, 1) evenly, so that frequencies may differ from the probabilities by one
/// pick per border between neighbors in the tree, no more: no statistics are needed.
#[test]
fn frequencies_are_the_probabilities_and_they_sum_to_one() {
    let emitters = mixed(60);
    let tree = LightTree::new(&emitters);
    let picks = 1 << 18;
    for to in receivers(12) {
        let mut frequency = vec![0.0; emitters.len()];
        let mut nothing = 0.0;
        for pick in 0..picks {
            match tree.sample(&to, (f64::from(pick) + 0.5) / f64::from(picks)) {
                Some((index, _)) => frequency[index as usize] += 1.0 / f64::from(picks),
                None => nothing += 1.0 / f64::from(picks),
            }
        }
        let mut sum = nothing;
        for (index, frequency) in frequency.iter().enumerate() {
            let probability = f64::from(tree.probability(index as u32, &to));
            assert!((probability - frequency).abs() <= 2.0 / f64::from(picks), "{index} {to:?}");
            sum += probability;
        }
        let dead_ends = to.normal.is_some() || emitters.iter().any(|e| e.cone.is_some());
        assert!((sum - 1.0).abs() < 1e-3, "{sum} {to:?}");
        assert!(dead_ends || nothing == 0.0);
    }
    let round: Vec<Emitter> = emitters.iter().map(|e| Emitter { cone: None, ..*e }).collect();
    let tree = LightTree::new(&round);
    for to in receivers(40).into_iter().filter(|to| to.normal.is_none()) {
        let sum: f64 = (0..60).map(|i| f64::from(tree.probability(i, &to))).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");
    }
}

#[test]
fn nothing_comes_from_below_the_horizon_nor_out_of_the_cone() {
    let down = Emitter { cone: Some((-Vec3A::Z, 0.9)), ..torch(Vec3A::new(3.0, 0.0, 5.0)) };
    let tree = LightTree::new(&[torch(Vec3A::new(0.0, 0.0, 1.0)), down]);
    let at = |x: f32, z: f32, normal: Option<Vec3A>| {
        let to = Receiver { position: Vec3A::new(x, 0.0, z), normal };
        [0, 1].map(|index| tree.probability(index, &to) > 0.0)
    };
    assert_eq!(at(3.0, 0.0, None), [true, true]);
    assert_eq!(at(-3.0, 0.0, None), [true, false]);
    assert_eq!(at(3.0, 2.0, Some(Vec3A::Z)), [false, true]);
    assert_eq!(at(3.0, 2.0, Some(-Vec3A::Z)), [true, false]);
    // A box that reaches above the plane may contribute.
    assert_eq!(at(3.0, 1.05, Some(Vec3A::Z)), [true, true]);
    let below = Receiver { position: Vec3A::new(0.0, 0.0, 9.0), normal: Some(Vec3A::Z) };
    assert_eq!(tree.importance(&below), 0.0);
    assert!(tree.sample(&below, 0.5).is_none());
}

/// Second moment of 1/d² under the tree's probabilities, relative to that of choosing by 1/d²
/// itself; the least ratio of probability to the ideal one; and the importance of all relative to
/// the sum of 1/d².
fn quality(tree: &LightTree, emitters: &[Emitter], to: &Receiver) -> [f64; 3] {
    let ideal: Vec<f64> = emitters
        .iter()
        .map(|e| 1.0 / f64::from(e.bounds.center().distance_squared(to.position).max(0.01)))
        .collect();
    let total: f64 = ideal.iter().sum();
    let ratio = |i: usize| f64::from(tree.probability(i as u32, to)) / (ideal[i] / total);
    let moment = (0..ideal.len()).map(|i| ideal[i] / total / ratio(i)).sum();
    let least = (0..ideal.len()).map(ratio).fold(f64::INFINITY, f64::min);
    [moment, least, f64::from(tree.importance(to)) / total]
}

/// The street of torches: inside the rows, beside them and at their end the choice is nearly as
/// good as by the true 1/d². Choosing evenly has a mean moment of 18 there.
#[test]
fn in_a_street_of_torches_the_choice_follows_the_distance() {
    let street: Vec<Emitter> = (0..200)
        .map(|i| torch(Vec3A::new((i / 2) as f32, 4.0 * (i % 2) as f32 - 2.0, 2.0)))
        .collect();
    let mut rng = PathRng::new(3, UVec2::ZERO, 0);
    let tree = LightTree::new(&street);
    let (mut moments, mut sums, mut least) = (Vec::new(), Vec::new(), f64::INFINITY);
    for _ in 0..300 {
        let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
        let position = Vec3A::new(-10.0, -4.0, 0.0) + u * Vec3A::new(120.0, 8.0, 4.0);
        let to = Receiver { position, normal: None };
        let [moment, ratio, sum] = quality(&tree, &street, &to);
        moments.push(moment);
        sums.push(sum);
        least = least.min(ratio);
    }
    moments.sort_by(f64::total_cmp);
    let mean = moments.iter().sum::<f64>() / 300.0;
    println!("moments: mean {mean:.3}, median {:.3}, worst {:.3}", moments[150], moments[299]);
    println!("least probability against the ideal: {least:.3}");
    sums.sort_by(f64::total_cmp);
    println!("importance against the sum: {:.3} to {:.3}", sums[0], sums[299]);
    assert!(mean < 1.1 && moments[299] < 2.0 && least > 0.2);
    assert!(sums[0] > 0.3 && sums[299] < 3.0);
}

#[test]
fn boxes_that_overlap_and_extreme_numbers_are_survived() {
    let same = vec![torch(Vec3A::ONE); 1000];
    let tree = LightTree::new(&same);
    for to in receivers(10).iter().map(|to| Receiver { normal: None, ..*to }) {
        let sum: f64 = (0..1000).map(|i| f64::from(tree.probability(i, &to))).sum();
        assert!((sum - 1.0).abs() < 1e-4 && tree.sample(&to, 0.999).is_some());
    }
    let numbers = [0.0, 1e-38, 1e-20, 1.0, 1e20, 3e38, f32::INFINITY, f32::NAN, -1.0];
    let emitters: Vec<Emitter> = (0..81)
        .map(|i| {
            let place = Vec3A::splat(numbers[i / 9]);
            let bounds = Aabb::new(-place, place);
            Emitter { bounds, intensity: numbers[i % 9], cone: None }
        })
        .collect();
    let tree = LightTree::new(&emitters);
    for position in [0.0, 1e-30, 1.0, 1e15, 1e30, f32::INFINITY, f32::NAN].map(Vec3A::splat) {
        for normal in [None, Some(Vec3A::X)] {
            let to = Receiver { position, normal };
            assert!(tree.importance(&to).is_finite());
            for pick in [0.0, 0.3, 0.7, 1.0 - f64::EPSILON] {
                if let Some((index, probability)) = tree.sample(&to, pick) {
                    assert!(probability > 0.0 && probability <= 1.0);
                    assert_eq!(tree.probability(index, &to), probability);
                }
            }
        }
    }
    let one_point = Receiver { position: Vec3A::ZERO, normal: None };
    let lone = LightTree::new(&[Emitter { bounds: Aabb::centered(Vec3A::ZERO), ..same[0] }]);
    assert!(lone.importance(&one_point).is_finite());
    assert_eq!(lone.sample(&one_point, 0.5), Some((0, 1.0)));
    assert!(LightTree::default().sample(&one_point, 0.5).is_none());
    assert_eq!(LightTree::new(&[]).importance(&one_point), 0.0);
}

#[test]
fn a_hundred_thousand_lights_make_a_shallow_tree() {
    let mut rng = PathRng::new(4, UVec2::ZERO, 0);
    // Each nearer to the others than a bin of the last: by cost alone they would go off one by one.
    let mut emitters: Vec<Emitter> = (0..120)
        .map(|i| {
            let mut at = Vec3A::ZERO;
            at[i % 3] = 1e17 * 16.5_f32.powi(-(i as i32 / 3));
            Emitter { bounds: Aabb::new(at, at), intensity: 1.0, cone: None }
        })
        .collect();
    emitters.extend((0..100_000).map(|_| torch(random(&mut rng, 100.0))));
    let tree = LightTree::new(&emitters);
    assert_eq!(tree.nodes.len(), 2 * emitters.len() - 1);
    let to = Receiver { position: Vec3A::ZERO, normal: None };
    let sum: f64 = (0..emitters.len()).map(|i| f64::from(tree.probability(i as u32, &to))).sum();
    assert!((sum - 1.0).abs() < 1e-3, "{sum}");
}
