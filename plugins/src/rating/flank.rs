//! The path of contact of a mesh at one point, for ratings of flanks.

use gearloss_framework::contact::path::Path;
use gearloss_framework::contact::sharing::{Flank, Knots, Sharing};
use gearloss_framework::geometry::{Line, Pair, PathPoint};
use gearloss_framework::mechanism::gear_mesh::GearMeshAt;
use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
use gearloss_framework::mechanism::tooth_friction::{ContactAt, PathNode};

/// Points on each section of the path besides its ends, where pressure and flash temperature jump and mostly have their maxima.
const ORDER: usize = 14;

/// The path of the drive flank of a pair, and of its coast flank if that has its own load sharing.
pub struct RatedFlanks {
    drive: RatedPath,
    coast: Option<RatedPath>,
}

impl RatedFlanks {
    /// The paths of a pair; `None` if it has no involute flanks, or too many pairs in contact.
    pub fn new(pair: &Pair, drive: &Sharing, coast: Option<&Sharing>) -> Option<Self> {
        Some(Self {
            drive: RatedPath::new(pair, drive)?,
            coast: match coast {
                Some(coast) => Some(RatedPath::new(pair, coast)?),
                None => None,
            },
        })
    }

    /// The path of the flank in contact.
    pub fn at(&self, at: &GearMeshAt<'_>) -> &RatedPath {
        match (Flank::of(at.first_drives > 0.5, at.speed), &self.coast) {
            (Flank::Coast, Some(coast)) => coast,
            _ => &self.drive,
        }
    }
}

/// The path of a pair at the knots of its load sharing, with the greatest line load along the face; all have the same points.
pub struct RatedPath {
    knots: Knots,
    paths: Vec<Path>,
    /// Number of the point next to the pitch point.
    pitch: usize,
}

impl RatedPath {
    /// The path of a pair; `None` if it has no involute flanks, or too many pairs in contact.
    pub fn new(pair: &Pair, sharing: &Sharing) -> Option<Self> {
        let [start, .., end] = pair.points;
        if end <= start || !pair.contact_ratio.is_finite() {
            return None;
        }
        let paths: Result<Vec<Path>, String> = match sharing {
            Sharing::Fixed(sharing) => Path::with_ends(pair, *sharing, ORDER).map(|path| vec![path]),
            Sharing::Loaded(shares) => {
                let of = |table| Path::of_table(pair, table, Line::Peak, ORDER);
                shares.tables().iter().map(of).collect()
            }
        };
        let paths = paths.ok()?;
        let points = paths[0].points();
        let distance = |i: usize| (points[i].x - pair.points[2]).abs();
        let nearest = (0..points.len()).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        Some(Self {
            knots: sharing.knots(),
            pitch: nearest.unwrap_or(0),
            paths,
        })
    }

    /// The points of the path.
    pub fn points(&self) -> &[PathPoint] {
        self.paths[0].points()
    }

    /// Whether the flank of the first gear is the faster one at a point.
    pub fn first_faster(&self, point: usize) -> bool {
        self.paths[0].nodes()[point].first_faster
    }

    /// Line load at a point over that of one pair alone, under a line load of the mesh in N/m.
    pub fn line(&self, point: usize, line_load: f64) -> f64 {
        match &self.paths[..] {
            [only] => only.nodes()[point].share,
            paths => {
                let place = self.knots.place(line_load);
                let part = |(knot, path): (usize, &Path)| self.knots.part(knot, place) * path.nodes()[point].share;
                paths.iter().enumerate().map(part).sum()
            }
        }
    }

    /// Number of the point next to the pitch point.
    pub fn at_pitch_point(&self) -> usize {
        self.pitch
    }
}

/// Calls a function with the number of each loaded point of the path and its contact; not without speed or torque.
pub fn contacts(
    path: &RatedPath,
    at: &GearMeshAt<'_>,
    mean: &MeanFrictionAt<'_>,
    mut each: impl FnMut(usize, &ContactAt<'_>),
) {
    let first = &path.paths[0];
    let along = first.at_operating_point(mean, at.notes);
    for (i, node) in first.nodes().iter().enumerate() {
        if path.paths.len() == 1 {
            if node.share > 0.0 {
                each(i, &along.contact(node));
            }
            continue;
        }
        let line = path.line(i, along.line_load);
        if line > 0.0 {
            let node = PathNode {
                weight: node.weight,
                first_faster: node.first_faster,
                ..PathNode::new(node.sliding, node.sum_speed, node.radius, line)
            };
            each(i, &along.contact(&node));
        }
    }
}
