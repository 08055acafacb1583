//! The outline of a housing that is not drawn: the convex hull of circles around the gears.

/// Chords of one turn of a circle: the area of the polygon is too small by a share of 4e-4.
pub const CHORDS: usize = 128;

/// The convex hull of circles by centre (y, z) and radius, with a number of chords per turn, as corners in order; empty without
/// circles. \[m\]
pub fn hull(circles: &[([f64; 2], f64)], chords: usize) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = circles
        .iter()
        .flat_map(|(centre, radius)| {
            (0..chords).map(move |i| {
                let (sine, cosine) = (std::f64::consts::TAU * i as f64 / chords as f64).sin_cos();
                [centre[0] + radius * cosine, centre[1] + radius * sine]
            })
        })
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let mut corners = half(points.iter().copied());
    corners.extend(half(points.iter().rev().copied()));
    corners
}

/// One side of the hull of sorted points, without its last point.
fn half(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut side: Vec<[f64; 2]> = Vec::new();
    for point in points {
        while let [.., a, b] = side[..] {
            let turn = (b[0] - a[0]) * (point[1] - b[1]) - (b[1] - a[1]) * (point[0] - b[0]);
            if turn > 0.0 {
                break;
            }
            side.pop();
        }
        side.push(point);
    }
    side.pop();
    side
}
