//! Thin slices: the load over the plane of action of a cylindrical pair, from stiffness, modification and misalignment.
//!
//! Derived. At a phase of the mesh, slice j of the pair of teeth k is in contact at x = A + phi + k p - y tan(beta_b) on the line of
//! action. Its line load is c(x) max(delta - e(x, y), 0), with one transmission error delta for all slices, and the loads add up to the
//! tangential force at the base circle. The sum is piecewise linear in delta: with the gaps sorted, delta is that of the first i slices for the
//! i at which it lies between their gaps and the next one; no iteration. Where the stiffness depends on the load (contact of Hertz), it is
//! repeated with the stiffness at the loads found. With a pitch error every second pair of teeth lags: the mesh repeats after two base pitches,
//! and the shares are means over both pairs. Slices are not coupled with each other; contact outside the path (teeth that meet early
//! because others are deflected) and the effect of the deflection on sliding are neglected.

use std::borrow::Cow;

use crate::contact::sharing::modification::Gap;
use crate::contact::sharing::stiffness::Stiffness;
use crate::geometry::{Pair, ShareRow, ShareTable};

/// Places of a table on each section of the path.
const ROWS: usize = 32;

/// Greatest number of repetitions where the stiffness depends on the load; each leaves about a tenth of the error.
const REPEATS: usize = 16;

/// One slice of one pair of teeth.
#[derive(Debug, Clone, Copy)]
struct Cell {
    x: f64,
    gap: f64,
    pair: u32,
    slice: u32,
}

/// The slices that may touch at one phase, by increasing gap.
#[derive(Debug, Clone)]
struct Phase {
    cells: Vec<Cell>,
}

/// A phase under a force.
struct Settled {
    /// Transmission error. \[m\]
    delta: f64,
    /// Stiffness of each slice. \[Pa\]
    stiffness: Vec<f64>,
    /// How many were evaluated.
    evaluations: usize,
}

impl Settled {
    /// The slices of the phase that carry load, with their line loads. \[N/m\]
    fn loads<'a>(&'a self, phase: &'a Phase) -> impl Iterator<Item = (Cell, f64)> + 'a {
        let cells = phase.cells.iter().zip(&self.stiffness);
        cells
            .map(|(cell, c)| (*cell, c * (self.delta - cell.gap)))
            .filter(|(_, load)| *load > 0.0)
    }
}

/// A pair in slices.
#[derive(Debug, Clone)]
pub struct Slices {
    pair: Pair,
    stiffness: Stiffness,
    /// True if the single stiffness is the user's own.
    stated: bool,
    gap: Gap,
    count: usize,
    /// Number of phases in one base pitch.
    base_phases: usize,
    inclination: f64,
    phases: Vec<Phase>,
    /// Places of the tables, and for spur gears their phases.
    places: Vec<Place>,
}

/// A place along the path, with the phases in which a pair of teeth is there; empty for helical gears, of which only a slice is.
type Place = (f64, Vec<Phase>);

/// Load of one slice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliceLoad {
    /// Number of the pair of teeth.
    pub pair: usize,
    /// Number of the slice.
    pub slice: usize,
    /// Distance from T1 along the line of action. \[m\]
    pub x: f64,
    /// Line load. \[N/m\]
    pub line_load: f64,
}

/// One phase under a force.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// Transmission error along the line of action. \[m\]
    pub delta: f64,
    /// The slices that touch.
    pub slices: Vec<SliceLoad>,
    /// Stiffness of the mesh per face width, dF_bt/(b d delta). \[Pa\]
    pub stiffness: f64,
}

/// A pair under one force over a base pitch, over two with a pitch error.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshLoad {
    /// Tangential force at the base circle over the face width. \[N/m\]
    pub line_load: f64,
    /// Transmission error at each phase. \[m\]
    pub delta: Vec<f64>,
    /// Mean stiffness of the mesh per face width. \[Pa\]
    pub stiffness: f64,
    /// Greatest line load. \[N/m\]
    pub greatest: f64,
    /// Mean over time of the line load along the face: the greatest over the mean.
    pub face_factor: f64,
    /// Distance of the resultant force from the middle of the face, over half of the face width, towards its end.
    pub shift: f64,
    /// Least share of the face that carries load, over time, of all that is on the path.
    pub least_touching: f64,
    /// Local tooth loss factor.
    pub loss_factor: f64,
    /// Evaluations of the stiffness of one slice at the phases.
    pub evaluations: usize,
}

impl MeshLoad {
    /// Greatest less least transmission error. \[m\]
    pub fn peak_to_peak(&self) -> f64 {
        let least = self.delta.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = self.delta.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        greatest - least
    }

    /// Mean transmission error. \[m\]
    pub fn mean(&self) -> f64 {
        self.delta.iter().sum::<f64>() / self.delta.len() as f64
    }
}

/// Inclination of the lines of contact in the plane of action; zero for spur gears.
fn inclination(pair: &Pair) -> f64 {
    let inclination = pair.base_helix.tan();
    let is_spur = inclination * pair.facewidth <= 1e-9 * pair.base_pitch;
    if is_spur { 0.0 } else { inclination }
}

impl Slices {
    /// A pair with numbers of slices and phases. A spur pair without modification along the face has one slice.
    pub fn new(pair: &Pair, (stiffness, stated): (Stiffness, bool), gap: Gap, count: usize, phases: usize) -> Self {
        let count = if inclination(pair) == 0.0 && gap.is_even_along_the_face() {
            1
        } else {
            count
        };
        Self::with_exactly(pair, (stiffness, stated), gap, [count, phases])
    }

    /// A pair with exactly these numbers of slices and of phases in a base pitch. Where the gap changes with the load, phases and places are
    /// prepared under each.
    fn with_exactly(
        pair: &Pair,
        (stiffness, stated): (Stiffness, bool),
        gap: Gap,
        [count, phases]: [usize; 2],
    ) -> Self {
        let mut slices = Self {
            pair: *pair,
            stiffness,
            stated,
            gap,
            base_phases: phases,
            count,
            inclination: inclination(pair),
            phases: Vec::new(),
            places: Vec::new(),
        };
        if slices.gap.yields() {
            return slices;
        }
        let step = pair.base_pitch / phases as f64;
        slices.phases = (0..phases * slices.period())
            .map(|i| slices.phase((i as f64 + 0.5) * step))
            .collect();
        slices.places = slices.rows();
        slices
    }

    /// The slices with the gap under a line load of the mesh. \[N/m\]
    fn under(&self, line_load: f64) -> Cow<'_, Self> {
        if !self.gap.yields() {
            return Cow::Borrowed(self);
        }
        let law = (self.stiffness.clone(), self.stated);
        let counts = [self.count, self.base_phases];
        Cow::Owned(Self::with_exactly(&self.pair, law, self.gap.under(line_load), counts))
    }

    /// Number of slices.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The gap between the unloaded flanks.
    pub fn gap(&self) -> &Gap {
        &self.gap
    }

    /// Base pitches after which the mesh repeats: two with a pitch error.
    pub fn period(&self) -> usize {
        if self.gap.lag() == 0.0 { 1 } else { 2 }
    }

    /// Place of a slice on the face. \[m\]
    fn face(&self, slice: usize) -> f64 {
        (slice as f64 + 0.5) * self.pair.facewidth / self.count as f64
    }

    /// The phase after a travel since a pair of teeth that does not lag began its contact, less than the period. \[m\]
    fn phase(&self, phi: f64) -> Phase {
        let [start, .., end] = self.pair.points;
        let (phi, turn) = if self.period() > 1 && phi >= self.pair.base_pitch {
            (phi - self.pair.base_pitch, 1)
        } else {
            (phi, 0)
        };
        let lean = self.pair.facewidth * self.inclination;
        let most = ((end - start + lean) / self.pair.base_pitch).ceil() as usize + 1;
        let mut cells = Vec::new();
        for slice in 0..self.count {
            let y = self.face(slice);
            for pair in 0..=most {
                let x = start + phi + pair as f64 * self.pair.base_pitch - y * self.inclination;
                if (start..=end).contains(&x) {
                    let lag = if (pair + turn) % 2 == 1 { self.gap.lag() } else { 0.0 };
                    cells.push(Cell {
                        x,
                        gap: self.gap.at(x, y) + lag,
                        pair: pair as u32,
                        slice: slice as u32,
                    });
                }
            }
        }
        cells.sort_by(|a, b| a.gap.total_cmp(&b.gap));
        Phase { cells }
    }

    /// The places of a table: a grid on each section, and a little inside of its ends.
    fn rows(&self) -> Vec<Place> {
        let breaks = self.pair.breaks();
        let mut places = Vec::new();
        for piece in breaks.windows(2) {
            let length = piece[1] - piece[0];
            for i in 0..=ROWS {
                let x = piece[0] + length * (i as f64 / ROWS as f64).clamp(1e-7, 1.0 - 1e-7);
                places.push((x, self.phases_at(x)));
            }
        }
        places
    }

    /// The phases in which a pair of spur teeth is at a place, one for each pair that differs.
    fn phases_at(&self, x: f64) -> Vec<Phase> {
        if self.inclination > 0.0 {
            return Vec::new();
        }
        let pitch = self.pair.base_pitch;
        let phi = (x - self.pair.points[0]).rem_euclid(pitch);
        (0..self.period())
            .map(|turn| self.phase(phi + turn as f64 * pitch))
            .collect()
    }

    /// A phase under a force over the face width. \[N/m\]
    fn settle(&self, phase: &Phase, line_load: f64, factor: f64) -> Settled {
        let cells = &phase.cells;
        let width = self.pair.facewidth / self.count as f64;
        let force = line_load * self.pair.facewidth;
        let mut stiffness: Vec<f64> = cells
            .iter()
            .map(|cell| factor * self.stiffness.at(cell.x, line_load))
            .collect();
        let (mut delta, mut evaluations) = (0.0, cells.len());
        let repeats = if self.stiffness.depends_on_load() { REPEATS } else { 1 };
        for repeat in 0..repeats {
            let before = delta;
            let (mut sum, mut closing) = (0.0, force);
            for (i, (cell, c)) in cells.iter().zip(&stiffness).enumerate() {
                sum += c * width;
                closing += c * width * cell.gap;
                delta = closing / sum;
                if cells.get(i + 1).is_none_or(|next| delta <= next.gap) {
                    break;
                }
            }
            if repeat + 1 == repeats || (delta - before).abs() <= 1e-14 * delta.abs() {
                break;
            }
            for (cell, c) in cells.iter().zip(&mut stiffness) {
                *c = factor * self.stiffness.at(cell.x, *c * (delta - cell.gap).max(0.0));
            }
            evaluations += cells.len();
        }
        Settled {
            delta,
            stiffness,
            evaluations,
        }
    }

    /// One phase, from zero to the end of the period, under a force over the face width. \[N/m\]
    pub fn loaded(&self, phi: f64, line_load: f64) -> Loaded {
        let here = self.under(line_load);
        let phase = here.phase(phi);
        let factor = self.stiffness.factor(&self.pair, line_load, self.stated);
        let found = self.settle(&phase, line_load, factor);
        let delta = found.delta;
        let touching = phase.cells.iter().zip(&found.stiffness);
        let touching = touching.filter(|(cell, _)| cell.gap < delta);
        Loaded {
            delta,
            stiffness: touching.map(|(_, c)| c).sum::<f64>() / self.count as f64,
            slices: found
                .loads(&phase)
                .map(|(cell, line_load)| SliceLoad {
                    pair: cell.pair as usize,
                    slice: cell.slice as usize,
                    x: cell.x,
                    line_load,
                })
                .collect(),
        }
    }

    /// The mesh under a force over the face width: its results and shares. \[N/m\]
    pub fn mesh(&self, line_load: f64) -> (MeshLoad, ShareTable) {
        self.under(line_load).mesh_with_its_gap(line_load)
    }

    fn mesh_with_its_gap(&self, line_load: f64) -> (MeshLoad, ShareTable) {
        let factor = self.stiffness.factor(&self.pair, line_load, self.stated);
        let (pair, count) = (&self.pair, self.count as f64);
        let mut delta = Vec::with_capacity(self.phases.len());
        let mut along = vec![0.0; self.count];
        let (mut stiff, mut greatest, mut sliding, mut least) = (0.0, 0.0_f64, 0.0, 1.0_f64);
        let mut evaluations = 0;
        for phase in &self.phases {
            let found = self.settle(phase, line_load, factor);
            delta.push(found.delta);
            evaluations += found.evaluations;
            let mut touching = 0;
            for (cell, load) in found.loads(phase) {
                along[cell.slice as usize] += load;
                greatest = greatest.max(load);
                sliding += load * pair.sliding(cell.x);
                touching += 1;
            }
            stiff += found.stiffness[..touching].iter().sum::<f64>() / count;
            least = least.min(touching as f64 / phase.cells.len().max(1) as f64);
        }
        let number = self.phases.len() as f64;
        let total: f64 = along.iter().sum();
        let most = along.iter().copied().fold(0.0, f64::max);
        let arm = |(slice, load): (usize, &f64)| load * (2.0 * (slice as f64 + 0.5) / count - 1.0);
        let load = MeshLoad {
            line_load,
            stiffness: stiff / number,
            greatest,
            face_factor: most * count / total,
            shift: along.iter().enumerate().map(arm).sum::<f64>() / total,
            least_touching: least,
            loss_factor: sliding / (line_load * count * number) / (pair.cos_base_helix * pair.base_radius[0]),
            delta,
            evaluations,
        };
        let table = self.table(&load, factor);
        (load, table)
    }

    /// Transmission error at a phase in base pitches, between those that were solved. \[m\]
    fn delta_at(&self, delta: &[f64], phase: f64) -> f64 {
        let period = self.period() as f64;
        let place = phase.rem_euclid(period) * (delta.len() as f64 / period) - 0.5;
        let low = place.floor();
        let t = place - low;
        let at = |i: f64| delta[i.rem_euclid(delta.len() as f64) as usize % delta.len()];
        at(low) + t * (at(low + 1.0) - at(low))
    }

    /// Line load of all slices at a place of the path, each when it is there, of one pair of teeth after the other that differ. \[N/m\]
    fn lines(&self, (x, phases): &Place, load: &MeshLoad, factor: f64) -> Vec<f64> {
        let x = *x;
        let [start, ..] = self.pair.points;
        let mut lines = vec![0.0; self.period() * self.count];
        if self.inclination == 0.0 {
            let near = 1e-6 * self.pair.base_pitch;
            for (phase, lines) in phases.iter().zip(lines.chunks_mut(self.count)) {
                for (cell, load) in self.settle(phase, load.line_load, factor).loads(phase) {
                    if (cell.x - x).abs() < near {
                        lines[cell.slice as usize] = load;
                    }
                }
            }
            return lines;
        }
        for (place, line) in lines.iter_mut().enumerate() {
            let (teeth, y) = (place / self.count, self.face(place % self.count));
            let phase = (x - start + y * self.inclination) / self.pair.base_pitch - teeth as f64;
            let gap = self.gap.at(x, y) + teeth as f64 * self.gap.lag();
            let closed = self.delta_at(&load.delta, phase) - gap;
            if closed <= 0.0 {
                continue;
            }
            *line = load.line_load;
            let repeats = if self.stiffness.depends_on_load() { 6 } else { 1 };
            for _ in 0..repeats {
                *line = factor * self.stiffness.at(x, *line) * closed;
            }
        }
        lines
    }

    fn table(&self, load: &MeshLoad, factor: f64) -> ShareTable {
        let row = |place: &Place| {
            let lines = self.lines(place, load, factor);
            let sum: f64 = lines.iter().sum();
            // The load with the friction of the whole face, for friction that grows with its fifth root.
            let fifth = lines.iter().map(|w| w.powf(1.2)).sum::<f64>() / sum;
            ShareRow {
                x: place.0,
                share: sum / (lines.len() as f64 * load.line_load),
                line: if sum > 0.0 { fifth.powi(5) / load.line_load } else { 0.0 },
                peak: lines.iter().copied().fold(0.0, f64::max) / load.line_load,
            }
        };
        let [start, .., end] = self.pair.points;
        let mut rows: Vec<ShareRow> = self.places.iter().map(row).collect();
        // The places at the ends of a section stand for the ends.
        let breaks = self.pair.breaks();
        for (piece, rows) in breaks.windows(2).zip(rows.chunks_mut(ROWS + 1)) {
            rows[0].x = piece[0];
            rows[ROWS].x = piece[1];
        }
        let whole: f64 = rows
            .windows(2)
            .map(|pair| 0.5 * (pair[0].share + pair[1].share) * (pair[1].x - pair[0].x))
            .sum();
        // All pairs together carry the force.
        if whole > 0.0 && end > start {
            let scale = self.pair.base_pitch / whole;
            for row in &mut rows {
                row.share *= scale;
            }
        }
        ShareTable::new(rows)
    }

    /// Even places along the path from its start to its end, for [`Self::plane`]. \[m\]
    pub fn even_places(&self, count: usize) -> Vec<f64> {
        let [start, .., end] = self.pair.points;
        let last = (count.max(2) - 1) as f64;
        (0..count.max(2))
            .map(|i| start + (end - start) * (i as f64 / last).clamp(1e-7, 1.0 - 1e-7))
            .collect()
    }

    /// The same with two places beside each end of single contact, where the load of a spur pair jumps. \[m\]
    pub fn places_with_jumps(&self, count: usize) -> Vec<f64> {
        let [start, .., end] = self.pair.points;
        let mut places = self.even_places(count);
        let jumps = self.pair.breaks().into_iter().filter(|x| *x > start && *x < end);
        places.extend(jumps.flat_map(|x| [-1.0, 1.0].map(|side| x + side * 1e-6 * (end - start))));
        places.sort_by(f64::total_cmp);
        places
    }

    /// Line load over the plane of action under a force over the face width: that of all slices at each place along the path, with a pitch
    /// error the mean of both pairs. \[N/m\]
    pub fn plane(&self, line_load: f64, places: &[f64]) -> Vec<(f64, Vec<f64>)> {
        let here = self.under(line_load);
        let (load, _) = here.mesh(line_load);
        let factor = self.stiffness.factor(&self.pair, line_load, self.stated);
        let period = self.period();
        let at = |x: f64| {
            let lines = here.lines(&(x, here.phases_at(x)), &load, factor);
            let mean = |j: usize| lines[j..].iter().step_by(self.count).sum::<f64>() / period as f64;
            (x, (0..self.count).map(mean).collect())
        };
        places.iter().map(|x| at(*x)).collect()
    }
}
