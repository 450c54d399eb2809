//! The polygon of the mounts seen along gravity, and how far inside the CG is.

use nalgebra::{Vector2, Vector3};

/// Indices of the mounts at the corners of the polygon that they span, seen along gravity, in order, and the
/// distance of the CG from its edge, m: above zero inside, below outside; of mounts in a line never above zero.
/// Without gravity it is seen along y.
#[must_use]
pub fn support_polygon(
    mounts: &[Vector3<f64>],
    cg: Vector3<f64>,
    gravity: Vector3<f64>,
) -> (Vec<usize>, f64) {
    let down = gravity.try_normalize(0.0).unwrap_or_else(|| -Vector3::y());
    // Any two directions at right angles to it.
    let least = down.iamin();
    let across =
        down.cross(&Vector3::from_fn(|k, _| if k == least { 1.0 } else { 0.0 })).normalize();
    let ahead = down.cross(&across);
    let seen = |(k, mount): (usize, &Vector3<f64>)| {
        let from_cg = mount - cg;
        (k, Vector2::new(from_cg.dot(&across), from_cg.dot(&ahead)))
    };
    let (corners, hull): (Vec<usize>, Vec<Vector2<f64>>) =
        convex_hull(mounts.iter().enumerate().map(seen).collect()).into_iter().unzip();
    let edges = hull.iter().zip(hull.iter().cycle().skip(1));
    let distance = |(from, to): (&Vector2<f64>, &Vector2<f64>)| {
        let edge = to - from;
        let length = edge.norm_squared();
        let along = if length > 0.0 { (-from.dot(&edge) / length).clamp(0.0, 1.0) } else { 0.0 };
        (from + edge * along).norm()
    };
    let nearest = edges.clone().map(distance).fold(f64::INFINITY, f64::min);
    let is_inside =
        hull.len() > 2 && edges.clone().all(|(from, to)| (to - from).perp(&-from) > 0.0);
    (corners, if is_inside { nearest } else { -nearest + 0.0 })
}

/// Corners of the convex hull, counter-clockwise (Andrew's monotone chain), with their indices.
fn convex_hull(mut points: Vec<(usize, Vector2<f64>)>) -> Vec<(usize, Vector2<f64>)> {
    points.sort_by(|(_, a), (_, b)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup_by_key(|(_, point)| *point);
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = (usize, Vector2<f64>)>| {
        let mut chain: Vec<(usize, Vector2<f64>)> = Vec::new();
        for point in points {
            while let [.., (_, before), (_, last)] = chain[..]
                && (last - before).perp(&(point.1 - last)) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOWN: Vector3<f64> = Vector3::new(0.0, -9.8, 0.0);

    fn margin(places: &[[f64; 2]], cg: [f64; 2]) -> f64 {
        let place = |[x, z]: [f64; 2]| Vector3::new(x, 0.7, z);
        let places: Vec<_> = places.iter().copied().map(place).collect();
        support_polygon(&places, place(cg), DOWN).1
    }

    #[test]
    fn the_cg_is_inside_by_its_distance_to_the_nearest_edge() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 0.1], [1.0, 0.0]];
        assert!((margin(&square, [1.0, 0.25]) - 0.25).abs() < 1e-15);
        assert!((margin(&square, [1.0, -0.5]) + 0.5).abs() < 1e-15);
        assert!((margin(&square, [-3.0, -4.0]) + 5.0).abs() < 1e-14);
        assert!((margin(&square[..3], [1.5, 0.5]) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn its_corners_are_mounts_in_order() {
        let places = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0], [1.0, 0.0]];
        let places: Vec<_> = places.map(|[x, z]| Vector3::new(x, 0.7, z)).into();
        let (mut corners, _) = support_polygon(&places, Vector3::zeros(), DOWN);
        let first = corners.iter().position(|&k| k == 0).unwrap();
        corners.rotate_left(first);
        assert!(corners == [0, 3, 2, 4] || corners == [0, 4, 2, 3], "{corners:?}");
    }

    #[test]
    fn mounts_in_a_line_carry_nothing_beside_it() {
        let line = [[0.0, 0.0], [1.0, 0.0], [3.0, 0.0]];
        assert_eq!(margin(&line, [2.0, 0.0]), 0.0);
        assert!((margin(&line, [2.0, 0.5]) + 0.5).abs() < 1e-15);
        assert!((margin(&line[..1], [3.0, 4.0]) + 5.0).abs() < 1e-14);
        let same = [[1.0, 1.0]; 3];
        assert!((margin(&same, [1.0, 2.0]) + 1.0).abs() < 1e-15);
    }

    #[test]
    fn gravity_says_from_where_it_is_seen() {
        let places = [[0.2, 0.0, 0.2], [-0.2, 0.0, 0.2], [0.0, 0.0, -0.3]].map(Vector3::from);
        let upright = support_polygon(&places, Vector3::new(0.0, 0.5, 0.0), DOWN).1;
        let gravity = Vector3::new(5.0, -5.0, 0.0);
        let inclined = support_polygon(&places, Vector3::new(0.0, 0.5, 0.0), gravity).1;
        assert!(upright > 0.1 && inclined < 0.0);
    }
}
