//! The path of contact of a mesh at one point, for ratings of flanks.

use gearloss_framework::contact::path::Path;
use gearloss_framework::geometry::{LoadSharing, Pair};
use gearloss_framework::mechanism::gear_mesh::GearMeshAt;
use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
use gearloss_framework::mechanism::tooth_friction::{ContactAt, PathNode};

/// Points on each section of the path besides its ends, where pressure and flash temperature jump and mostly have their maxima.
const ORDER: usize = 14;

/// The path of a pair; `None` if it has no involute flanks, or too many pairs in contact.
pub fn path(pair: &Pair, sharing: LoadSharing) -> Option<Path> {
    let [start, .., end] = pair.points;
    let is_involute = end > start && pair.contact_ratio.is_finite();
    is_involute
        .then(|| Path::with_ends(pair, sharing, ORDER).ok())
        .flatten()
}

/// Calls a function with each loaded contact of the path, its node and its number; not without speed or torque.
pub fn contacts(
    path: &Path,
    at: &GearMeshAt<'_>,
    mean: &MeanFrictionAt<'_>,
    mut each: impl FnMut(usize, &PathNode, &ContactAt<'_>),
) {
    let along = path.at_operating_point(mean, at.notes);
    for (i, node) in path.nodes().iter().enumerate().filter(|(_, node)| node.share > 0.0) {
        each(i, node, &along.contact(node));
    }
}

/// Number of the node next to the pitch point.
pub fn at_pitch_point(path: &Path, pair: &Pair) -> usize {
    let distance = |i: usize| (path.points()[i].x - pair.points[2]).abs();
    (0..path.len())
        .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
        .unwrap_or(0)
}
