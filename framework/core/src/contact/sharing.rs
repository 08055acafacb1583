//! Load sharing among pairs of teeth that depends on the load: stated by a relief, read from a file, or calculated in thin slices.
//!
//! A sharing is prepared for some loads of a mesh, its knots; between them its results are interpolated linearly, over a coordinate in which
//! the shares of teeth with a constant stiffness are straight lines as long as all of them touch: F_0/F above the load F_0 that closes the
//! largest gap, and 2 - F/F_0 below it, where F is the tangential force at the base circle over the face width.

mod entry;
mod file;
pub mod modification;
pub mod slices;
pub mod stiffness;

#[cfg(test)]
mod tests;

use std::sync::Arc;

pub use entry::{CalculatedSharing, SharingEntry, SlicesSharing};

use crate::codes;
use crate::document::Diagnostic;
use crate::geometry::{LoadSharing, Pair, ShareRow, ShareTable};
use crate::mechanism::gear_mesh::MeshPart;
use crate::real::Real;
use modification::Gap;
use slices::{MeshLoad, Slices};
use stiffness::{Stiffness, StiffnessLaw};

/// A flank of the first gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flank {
    /// That in contact if the first gear drives forwards.
    Drive,
    /// The other one.
    Coast,
}

impl Flank {
    /// The flank in contact.
    pub fn of(first_drives: bool, speed: f64) -> Self {
        if first_drives == (speed >= 0.0) {
            Self::Drive
        } else {
            Self::Coast
        }
    }
}

/// A load sharing, prepared for one pair.
#[derive(Debug, Clone, PartialEq)]
pub enum Sharing {
    /// The same under every load.
    Fixed(LoadSharing),
    /// One that depends on the load.
    Loaded(Arc<LoadedShares>),
}

impl From<LoadSharing> for Sharing {
    fn from(sharing: LoadSharing) -> Self {
        Self::Fixed(sharing)
    }
}

impl From<&Sharing> for Sharing {
    fn from(sharing: &Sharing) -> Self {
        sharing.clone()
    }
}

/// Coordinate over which results are interpolated between knots.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Coordinate {
    /// The line load itself. \[N/m\]
    Load,
    /// That of the head of this file, with its load F_0. \[N/m\]
    Closing(f64),
}

impl Coordinate {
    /// The line load at a place. \[N/m\]
    fn load(self, place: f64) -> f64 {
        match self {
            Self::Load => place,
            Self::Closing(unit) if place <= 1.0 => unit / place,
            Self::Closing(unit) => unit * (2.0 - place),
        }
    }
}

/// The knots of a sharing.
#[derive(Debug, Clone, PartialEq)]
pub struct Knots {
    coordinate: Coordinate,
    /// Increasing places.
    places: Vec<f64>,
}

impl Knots {
    /// One knot: nothing depends on the load.
    pub const ONE: Self = Self {
        coordinate: Coordinate::Load,
        places: Vec::new(),
    };

    /// Number of knots.
    pub fn len(&self) -> usize {
        self.places.len().max(1)
    }

    /// False: there is always one.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// The coordinate of a line load F_bt/b. \[N/m\]
    #[inline(always)]
    pub fn place<R: Real>(&self, line_load: R) -> R {
        match self.coordinate {
            Coordinate::Load => line_load,
            Coordinate::Closing(unit) => {
                let over = line_load / unit;
                let closes = over.is_above(R::constant(1.0));
                let some = R::select(closes, over, R::constant(1.0));
                R::select(closes, R::constant(1.0) / some, R::constant(2.0) - over)
            }
        }
    }

    /// Part of the result of a knot in that at a place, from zero to one; all parts add up to one.
    #[inline(always)]
    pub fn part<R: Real>(&self, knot: usize, place: R) -> R {
        let here = self.places[knot];
        let mut part = R::constant(1.0);
        if let Some(before) = knot.checked_sub(1).map(|i| self.places[i]) {
            part = part.min((place - before) / (here - before));
        }
        if let Some(behind) = self.places.get(knot + 1) {
            part = part.min((R::constant(*behind) - place) / (behind - here));
        }
        part.at_least(0.0)
    }

    /// A number of each knot, between them.
    #[inline(always)]
    pub fn between<R: Real>(&self, line_load: R, values: &[f64]) -> R {
        if let [only] = values {
            return R::constant(*only);
        }
        let place = self.place(line_load);
        let mut sum = R::ZERO;
        for (knot, value) in values.iter().enumerate() {
            sum += self.part(knot, place) * *value;
        }
        sum
    }

    /// Line loads halfway between the knots, for checks. \[N/m\]
    fn loads_between(&self) -> impl Iterator<Item = f64> {
        let places = self.places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        places.map(|place| self.coordinate.load(place))
    }
}

/// Places of the first knots. More are added where the interpolation needs them: teeth of constant stiffness that all touch need none between
/// zero and one; the stiffness of a contact of Hertz and slices that open need some.
const PLACES: [f64; 3] = [0.02, 1.0, 1.93];

/// Places of the first knots of flanks without modification, whose stiffness depends on the load.
const PLACES_UNMODIFIED: [f64; 3] = [0.1, 1.0, 1.9];

/// Greatest number of knots: a point has at most the friction of two, a batch of points with different loads that of all.
const MOST_KNOTS: usize = 12;

/// Relative error of the loss factor halfway between two knots below which no knot is added between them.
pub const ACCURATE: f64 = 0.005;

/// One load with the results of the slices under it.
struct Knot {
    place: f64,
    mesh: MeshLoad,
    table: ShareTable,
}

impl Knot {
    fn new(slices: &Slices, coordinate: Coordinate, place: f64) -> Self {
        let (mesh, table) = slices.mesh(coordinate.load(place));
        Self { place, mesh, table }
    }

    fn between(slices: &Slices, coordinate: Coordinate, [low, high]: [&Self; 2]) -> Self {
        Self::new(slices, coordinate, 0.5 * (low.place + high.place))
    }

    /// Knots from the first places on, with more of them where the loss factor between two is not accurate; and the greatest error that is
    /// left.
    fn enough(slices: &Slices, coordinate: Coordinate, places: &[f64]) -> (Vec<Self>, f64) {
        let mut knots: Vec<Self> = places
            .iter()
            .map(|place| Self::new(slices, coordinate, *place))
            .collect();
        let between = |knots: &[Self], i: usize| Self::between(slices, coordinate, [&knots[i], &knots[i + 1]]);
        let mut middles: Vec<Self> = (1..knots.len()).map(|i| between(&knots, i - 1)).collect();
        loop {
            let error = |(i, middle): (usize, &Self)| {
                let linear = 0.5 * (knots[i].mesh.loss_factor + knots[i + 1].mesh.loss_factor);
                (i, (linear / middle.mesh.loss_factor - 1.0).abs())
            };
            let worst = middles.iter().enumerate().map(error);
            let Some((i, error)) = worst.max_by(|a, b| a.1.total_cmp(&b.1)) else {
                return (knots, 0.0);
            };
            if error <= ACCURATE || knots.len() == MOST_KNOTS {
                return (knots, error);
            }
            knots.insert(i + 1, middles.remove(i));
            middles.insert(i, between(&knots, i + 1));
            middles.insert(i, between(&knots, i));
        }
    }
}

/// Line load at which a stiffness that depends on the load has its middle knot. \[N/m\]
const USUAL: f64 = 100e3;

/// Gap below which flanks are not modified. \[m\]
const NO_GAP: f64 = 1e-12;

/// Shares at the knots.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedShares {
    knots: Knots,
    tables: Vec<ShareTable>,
    factors: Vec<f64>,
    /// Results of the slices at each knot.
    meshes: Vec<MeshLoad>,
    /// Greatest relative error of the loss factor between knots; zero if it is not measured.
    error: f64,
    /// How far a file was from carrying the whole force.
    deviation: f64,
}

impl LoadedShares {
    /// The knots.
    pub fn knots(&self) -> &Knots {
        &self.knots
    }

    /// The shares at each knot.
    pub fn tables(&self) -> &[ShareTable] {
        &self.tables
    }

    /// Local tooth loss factor at each knot.
    pub fn factors(&self) -> &[f64] {
        &self.factors
    }

    /// The shares at a place of the path under a line load, between the knots. \[N/m\]
    pub fn row(&self, x: f64, line_load: f64) -> ShareRow {
        let mut sum = ShareRow {
            x,
            ..ShareRow::default()
        };
        let place = self.knots.place(line_load);
        for (knot, table) in self.tables.iter().enumerate() {
            let row = table.at(x);
            let part = if self.tables.len() == 1 {
                1.0
            } else {
                self.knots.part(knot, place)
            };
            sum.share += part * row.share;
            sum.line += part * row.line;
            sum.peak += part * row.peak;
        }
        sum
    }

    /// Greatest relative error of the loss factor halfway between knots.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Greatest relative difference of the sum of the shares of a file from one, before they were corrected.
    pub fn deviation(&self) -> f64 {
        self.deviation
    }

    /// Shares of a pair in thin slices.
    pub fn from_slices(pair: &Pair, stiffness: &Stiffness, slices: &Slices) -> Self {
        let [.., end] = pair.points;
        let opening = slices.gap().under(USUAL).range() * stiffness.at(0.5 * (pair.points[0] + end), USUAL);
        let is_closed = slices.gap().is_none() || opening <= NO_GAP * 1e9;
        let (coordinate, places) = if is_closed {
            (Coordinate::Closing(USUAL), &PLACES_UNMODIFIED)
        } else {
            (Coordinate::Closing(opening), &PLACES)
        };
        let (found, mut error) = if is_closed && !stiffness.depends_on_load() {
            (vec![Knot::new(slices, coordinate, 1.0)], 0.0)
        } else {
            Knot::enough(slices, coordinate, places)
        };
        let knots = match &found[..] {
            [_] => Knots::ONE,
            several => Knots {
                coordinate,
                places: several.iter().map(|knot| knot.place).collect(),
            },
        };
        let factors: Vec<f64> = found.iter().map(|knot| knot.table.loss_factor(pair)).collect();
        for (knot, factor) in found.iter().zip(&factors) {
            error = error.max((factor / knot.mesh.loss_factor - 1.0).abs());
        }
        let (meshes, tables) = found.into_iter().map(|knot| (knot.mesh, knot.table)).unzip();
        Self {
            factors,
            knots,
            tables,
            meshes,
            error,
            deviation: 0.0,
        }
    }

    /// The closed family of linear reliefs of both tips over the whole double contact of a spur pair, with a constant stiffness: the share
    /// rises from 1/2 - kappa/2 to 1/2 + kappa/2, cut off at 0 and 1. With `amount` in m and the stiffness in Pa, kappa falls with the load.
    ///
    /// # Errors
    /// A pair that the family does not describe, as a sentence.
    fn from_relief(pair: &Pair, kappa: Kappa) -> Result<Self, String> {
        if pair.helix_angle != 0.0 || pair.contact_ratio >= 2.0 {
            return Err(format!(
                "the closed shares are those of spur gears with one or two pairs in contact; this pair has a helix angle of {:.2} deg and a \
                 contact ratio of {:.3}",
                pair.helix_angle.to_degrees(),
                pair.contact_ratio
            ));
        }
        let (knots, kappas) = match kappa {
            Kappa::Stated(kappa) => (Knots::ONE, vec![kappa]),
            Kappa::OfAmount(unit) if unit <= 0.0 => (Knots::ONE, vec![0.0]),
            Kappa::OfAmount(unit) => {
                // Up to one the shares are straight lines over the coordinate.
                let places = vec![0.0, 1.0, 1.2, 1.4, 1.6, 1.8, 1.95];
                let of = |place: &f64| if *place <= 1.0 { *place } else { 1.0 / (2.0 - place) };
                let kappas = places.iter().map(of).collect();
                let coordinate = Coordinate::Closing(unit);
                (Knots { coordinate, places }, kappas)
            }
        };
        let tables: Vec<ShareTable> = kappas.iter().map(|kappa| relieved(pair, *kappa)).collect();
        let factors: Vec<f64> = tables.iter().map(|table| table.loss_factor(pair)).collect();
        let mut error = 0.0_f64;
        if let Kappa::OfAmount(unit) = kappa {
            for load in knots.loads_between() {
                let exact = relieved(pair, unit / load).loss_factor(pair);
                error = error.max((knots.between(load, &factors) / exact - 1.0).abs());
            }
        }
        Ok(Self {
            knots,
            tables,
            factors,
            meshes: Vec::new(),
            error,
            deviation: 0.0,
        })
    }
}

/// Relief over the deflection of one pair under the full load.
#[derive(Debug, Clone, Copy)]
enum Kappa {
    /// The same under every load.
    Stated(f64),
    /// The line load at which it is one. \[N/m\]
    OfAmount(f64),
}

/// The shares of the closed family.
fn relieved(pair: &Pair, kappa: f64) -> ShareTable {
    let [start, inner, _, outer, end] = pair.points;
    let share = |s: f64| (0.5 + kappa * (s - 0.5)).clamp(0.0, 1.0);
    let mut places = vec![0.0, 1.0];
    if kappa > 1.0 {
        places = vec![0.0, 0.5 - 0.5 / kappa, 0.5 + 0.5 / kappa, 1.0];
    }
    let row = |x: f64, share: f64| ShareRow {
        x,
        share,
        line: share,
        peak: share,
    };
    // In the double contact the pair that leaves carries what the one that enters leaves.
    let mut rows: Vec<ShareRow> = places
        .iter()
        .map(|s| row(start + s * (inner - start), share(*s)))
        .collect();
    rows.extend([row(inner, 1.0), row(outer, 1.0)]);
    rows.extend(places.iter().map(|s| row(outer + s * (end - outer), share(1.0 - s))));
    ShareTable::new(rows)
}

/// What is wrong with a load sharing.
#[derive(Debug, Clone)]
pub struct SharingFault {
    message: String,
    help: &'static str,
    code: &'static str,
}

impl SharingFault {
    fn new(message: impl Into<String>, help: &'static str) -> Self {
        Self {
            message: message.into(),
            help,
            code: "sharing",
        }
    }

    fn of_file(message: impl Into<String>, help: &'static str) -> Self {
        Self {
            code: "file",
            ..Self::new(message, help)
        }
    }

    /// The finding at a path.
    pub fn at(self, path: &str) -> Diagnostic {
        let code = if self.code == "file" {
            codes::SHARE_FILE
        } else {
            codes::LOAD_SHARING
        };
        Diagnostic::error(path, self.message).code(code).help(self.help)
    }
}

/// The slices of a mesh with their stiffness.
///
/// # Errors
/// Modifications or a stiffness that the pair cannot have.
pub fn slices_of(part: &MeshPart, entry: &SlicesSharing) -> Result<(Stiffness, Slices), SharingFault> {
    let pair = &part.pair;
    if !pair.involute || pair.crossed.is_some() {
        return Err(SharingFault::new(
            "thin slices describe involute teeth on parallel axes, and this mesh has none",
            "state the tip diameter of the ring, or choose a load sharing that is one word",
        ));
    }
    let bodies = (part.elastic(), part.bores);
    let stiffness = Stiffness::new(pair, bodies, entry.stiffness, entry.single_stiffness);
    let help = match entry.stiffness {
        StiffnessLaw::Sainsot if !pair.internal => {
            "state `bore` of both gears below their root, or write `stiffness: weber`"
        }
        _ => "write `stiffness: iso6336`, which has one stiffness",
    };
    let stiffness = stiffness.map_err(|fault| SharingFault::new(fault, help))?;
    let gap = Gap::new(pair, &part.flanks, (part.misalignment, part.yielding)).map_err(|(gear, key, fault)| {
        let which = if gear == 0 { "first" } else { "second" };
        SharingFault::new(
            format!("`{key}` of the {which} gear: {fault}"),
            "state one of `length`, at most that of the path, and `from_diameter`, within the path",
        )
    })?;
    let (count, phases) = (entry.slices as usize, entry.phases as usize);
    let slices = Slices::new(
        pair,
        (stiffness.clone(), entry.single_stiffness.is_some()),
        gap,
        count,
        phases,
    );
    Ok((stiffness, slices))
}

impl Sharing {
    /// Prepares the sharing of a flank of a mesh; `bytes` reads a file that it names. `None` for a coast flank that has none of its own.
    ///
    /// # Errors
    /// A sharing that the mesh cannot have, or a faulty file.
    pub fn new(
        part: &MeshPart,
        entry: &SharingEntry,
        flank: Flank,
        bytes: impl FnOnce(&str) -> Result<Arc<[u8]>, String>,
    ) -> Result<Option<Self>, SharingFault> {
        let pair = &part.pair;
        let calculated = match entry {
            SharingEntry::Calculated(calculated @ CalculatedSharing::File { .. }) => calculated,
            _ if flank == Flank::Coast => return Ok(None),
            SharingEntry::Fixed(sharing) => return Ok(Some(Self::Fixed(*sharing))),
            SharingEntry::Calculated(calculated) => calculated,
        };
        let shares = match calculated {
            CalculatedSharing::Relief {
                amount,
                kappa,
                stiffness,
            } => {
                let kappa = match (amount, kappa) {
                    (None, Some(kappa)) => Kappa::Stated(*kappa),
                    (Some(amount), None) => {
                        let single = || stiffness::single_stiffness(pair, part.elastic());
                        Kappa::OfAmount(amount * stiffness.unwrap_or_else(single))
                    }
                    _ => {
                        return Err(SharingFault::new(
                            "a relief has either an `amount`, which makes the shares depend on the load, or its ratio `kappa` to the \
                             deflection",
                            "state one of both",
                        ));
                    }
                };
                LoadedShares::from_relief(pair, kappa).map_err(|fault| {
                    SharingFault::new(fault, "write `type: slices`, which describes any cylindrical pair")
                })?
            }
            CalculatedSharing::File { path } => {
                let bytes = bytes(path).map_err(|reason| {
                    SharingFault::of_file(reason, "names of files are relative to the document that names them")
                })?;
                match file::shares(pair, path, &bytes, flank)? {
                    Some(shares) => shares,
                    None => return Ok(None),
                }
            }
            CalculatedSharing::Slices(entry) => {
                let (stiffness, slices) = slices_of(part, entry)?;
                LoadedShares::from_slices(pair, &stiffness, &slices)
            }
        };
        Ok(Some(Self::Loaded(Arc::new(shares))))
    }

    /// The knots: one for a sharing that does not depend on the load.
    pub fn knots(&self) -> Knots {
        match self {
            Self::Fixed(_) => Knots::ONE,
            Self::Loaded(shares) => shares.knots.clone(),
        }
    }

    /// Local tooth loss factor at each knot.
    pub fn loss_factors(&self, pair: &Pair) -> Vec<f64> {
        match self {
            Self::Fixed(sharing) => vec![pair.loss_factor_local(*sharing)],
            Self::Loaded(shares) => shares.factors.clone(),
        }
    }
}
