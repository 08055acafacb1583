//! The sump of a transmission: its space, walls, and the gears whose churning lifts oil out of it.

use std::sync::Arc;

use super::inside::Inside;
use super::seats::GearSeat;
use super::{DragModel, Oils};
use crate::attach::{Level, Oil, State};
use crate::hydraulics::{Taken, Window};
use crate::immersion::Height;
use crate::loss::{Loss, Undefined};
use crate::real::{Mask as _, Points};
use crate::sump::{
    AnySpace, CAPTURE, Catchers, Inclinations, InclinedWalls, Lift, Lifted, Outline, Running, Space, Travel, Walls,
};
use crate::transmission::Surface;

/// The sump with the gears that lift oil.
#[derive(Debug, Clone)]
pub struct Sump {
    space: Arc<Space>,
    /// The spaces of a housing that cycles incline.
    inclinations: Option<Arc<Inclinations>>,
    walls: Walls,
    /// The walls at the inclinations of a housing that travels.
    inclined_walls: Option<InclinedWalls>,
    /// True if the inside is drawn; otherwise it is the hull of the gears.
    drawn: bool,
    sections: Vec<Outline>,
    /// The upward direction, and the height of the datum along it. \[m\]
    up: ([f64; 3], f64),
    lifts: Vec<Lift>,
    /// The axis and the number of the gear of each.
    levels: Vec<Level>,
    gears: Vec<usize>,
    lifters: Vec<Lifter>,
    /// Number of its oil.
    pub(crate) oil: usize,
    /// True if a component reads the level while rotating.
    pub(crate) read: bool,
}

/// A churning model whose power lifts oil.
#[derive(Debug, Clone)]
struct Lifter {
    drag: usize,
    /// Number of its first lift; a pair has two in a row.
    first: usize,
    members: [usize; 2],
    pair: bool,
}

impl Sump {
    /// The sump of an inside with a level at rest, and the churning models of stationary or orbiting gears in it.
    pub(crate) fn new(
        inside: &Inside,
        rest: f64,
        oil: usize,
        read: bool,
        (gears, levels): (&[GearSeat], &[Level]),
        drags: &[DragModel],
    ) -> Self {
        let mut lifts = Vec::new();
        let (mut of_lifts, mut numbers) = (Vec::new(), Vec::new());
        let mut lifters = Vec::new();
        for (drag, model) in drags
            .iter()
            .enumerate()
            .filter(|(_, model)| model.churning && !model.model.off)
        {
            let seat = &model.seat;
            let own = if seat.pair { &seat.gears[..] } else { &seat.gears[..1] };
            let found: Option<Vec<Lift>> = own
                .iter()
                .map(|gear| lift(&gears[*gear], levels[*gear], seat.count))
                .collect();
            if let Some(found) = found {
                lifters.push(Lifter {
                    drag,
                    first: lifts.len(),
                    members: seat.members,
                    pair: seat.pair,
                });
                lifts.extend(found);
                of_lifts.extend(own.iter().map(|gear| levels[*gear]));
                numbers.extend_from_slice(own);
            }
        }
        Self {
            space: Arc::clone(&inside.space),
            inclinations: inside.inclinations.clone(),
            walls: inside.walls(rest),
            inclined_walls: inside.inclined_walls(rest),
            drawn: inside.drawn,
            sections: inside.sections.clone(),
            up: inside.up,
            lifts,
            levels: of_lifts,
            gears: numbers,
            lifters,
            oil,
            read,
        }
    }

    /// The oil space.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// Where lifted oil runs down, as built.
    pub fn walls(&self) -> &Walls {
        &self.walls
    }

    /// Where lifted oil runs down at an inclination. \[rad\]
    pub(crate) fn walls_at<R: Points>(&self, inclination: R) -> Walls<R> {
        let Some(inclined) = self.inclined_walls.as_ref().filter(|_| !inclination.is_zero().all()) else {
            return self.walls.map(R::constant);
        };
        let [area, length, flight] = R::each_of(|point| {
            let walls = match inclination.at_point(point) {
                0.0 => self.walls,
                inclination => inclined.at(inclination),
            };
            [walls.area, walls.length, walls.flight]
        });
        Walls { area, length, flight }
    }

    /// True if the inside is drawn; otherwise it is the hull of the gears.
    pub fn is_drawn(&self) -> bool {
        self.drawn
    }

    /// Sections of the oil space.
    pub fn sections(&self) -> &[Outline] {
        &self.sections
    }

    /// The part of a section below a level, at its middle along the shafts: corners as y and z. \[m\]
    pub fn below(&self, section: &Outline, level: f64) -> Vec<[f64; 2]> {
        let (up, datum) = self.up;
        let middle = 0.5 * (section.range[0] + section.range[1]);
        section.below(|[y, z]| up[0] * middle + up[1] * y + up[2] * z - datum, level)
    }

    /// The surface of a level between two values of y, at the middle of the sections along the shafts: points as y and z. \[m\]
    pub fn surface(&self, level: f64, ends: [f64; 2]) -> [[f64; 2]; 2] {
        let (up, datum) = self.up;
        let ranges = self.sections.iter().flat_map(|section| section.range);
        let (from, to) = (
            ranges.clone().fold(f64::INFINITY, f64::min),
            ranges.fold(f64::NEG_INFINITY, f64::max),
        );
        ends.map(|y| [y, (level + datum - up[0] * 0.5 * (from + to) - up[1] * y) / up[2]])
    }

    /// Number of the lift of a gear, if it may lift oil.
    pub(crate) fn lift_of(&self, gear: usize) -> Option<usize> {
        self.gears.iter().position(|own| *own == gear)
    }

    /// What a window takes of the oil that its gear throws at a level (m) with a share of the band's factor, and that flow (m3/s).
    pub(crate) fn through<R: Points>(&self, window: &Window, state: (&[R], R), lifted: &[Lifted<R>]) -> (Taken<R>, R) {
        let (speeds, level) = state;
        let (lift, gear) = (&self.lifts[window.lift], &lifted[window.lift]);
        let dip = lift.tip_dip_at(level, gear.axis);
        let taken = window.taken(speeds[window.member], dip);
        (taken, taken.share * lift.thrown(gear, level, CAPTURE[1]))
    }

    /// True if a gear may lift oil.
    pub(crate) fn has_lifts(&self) -> bool {
        !self.lifts.is_empty()
    }

    /// Number of gears that may lift oil.
    pub(crate) fn lifts(&self) -> usize {
        self.lifts.len()
    }

    /// How the housing travels, if cycles incline it.
    pub fn travel(&self) -> Option<&Travel> {
        self.inclinations.as_deref().map(Inclinations::travel)
    }

    /// The space at an inclination; as built without one. \[rad\]
    pub fn at(&self, inclination: f64) -> AnySpace<'_> {
        match &self.inclinations {
            Some(inclinations) if inclination != 0.0 => inclinations.space(inclination),
            _ => (&*self.space).into(),
        }
    }

    /// The level at an inclination of the oil below a level as built. \[rad, m\]
    pub(crate) fn inclined<R: Points>(&self, level: R, inclination: R) -> R {
        let each = |point: usize| {
            let (level, inclination) = (level.at_point(point), inclination.at_point(point));
            if inclination == 0.0 || !level.is_finite() {
                return [level, level, 1.0];
            }
            let [volume, area] = self.space.volume(level);
            let space = self.at(inclination);
            let found = space.level(volume);
            let of_found = space.volume(found)[1];
            let slope = if of_found > 0.0 { area / of_found } else { 0.0 };
            [found, level, slope]
        };
        let [found, known, slope] = R::each_of(each);
        let change = R::select(level.is_equal(known), R::ZERO, level - known);
        found + change * slope
    }

    /// The level of a volume. \[m3, m\]
    pub(crate) fn level<R: Points>(&self, volume: R) -> R {
        level_in(|_| (&*self.space).into(), volume)
    }

    /// What each gear lifts by its churning loss.
    pub(crate) fn lift<R: Points>(
        &self,
        drags: &[DragModel],
        losses: &[Result<Loss<R>, Undefined>],
        state: &State<'_, R>,
        lifted: &mut [Lifted<R>],
    ) {
        for lifter in &self.lifters {
            let model = &drags[lifter.drag];
            let power = match &losses[lifter.drag] {
                Ok(loss) => loss.total_watts(state.speeds[lifter.members[0]]) * (model.seat.count * model.loss_factor),
                Err(_) => R::ZERO,
            };
            let rho = state.oils[model.oil as usize].rho;
            let gears = lifter.first..lifter.first + if lifter.pair { 2 } else { 1 };
            let axis = |i: usize| match state.incline {
                Some(incline) => self.levels[i].axis(incline),
                None => [self.lifts[i].height, self.lifts[i].slope].map(R::constant),
            };
            let depths = gears
                .clone()
                .map(|i| self.lifts[i].tip_dip_at(state.rest, axis(i)))
                .fold(R::ZERO, |sum, depth| sum + depth);
            let dry = depths.is_zero();
            for (i, member) in gears.zip(lifter.members) {
                // A pair shares its loss by immersion.
                let share = self.lifts[i].tip_dip_at(state.rest, axis(i)) / R::select(dry, R::constant(1.0), depths);
                let own = self.lifts[i].lifted(power * share, state.speeds[member], rho);
                lifted[i] = Lifted { axis: axis(i), ..own };
            }
        }
    }

    /// The balance of the sump at a point with an inclination (rad); the level at rest determines how much oil there is, of which chambers
    /// hold a part (m3).
    pub(crate) fn running<'a, R: Points, C: Catchers<R>>(
        &'a self,
        (rest, inclination): (R, R),
        held: R,
        oils: &[Oil<R>],
        lifted: &'a [Lifted<R>],
        (catchers, starts): (C, u32),
    ) -> Running<'a, R, impl Fn(usize) -> AnySpace<'a>, C> {
        let space = move |point: usize| self.at(inclination.at_point(point));
        let known = R::each(|point| rest.at_point(point));
        let [filled, area] = R::each_of(|point| space(point).volume(rest.at_point(point)));
        // The volume over the level at rest, with derivatives.
        let stock = filled + (rest - known) * area;
        let none = held.is_zero();
        let left = (stock - held).at_least(0.0);
        let lowered = if none.all() {
            rest
        } else {
            R::select(none, rest, level_in(space, left))
        };
        Running {
            space,
            inside: self.space.inside(),
            walls: self.walls_at(inclination),
            lifts: &self.lifts,
            lifted,
            rest: lowered,
            stock: R::select(none, stock, left),
            nu: oils[self.oil].nu,
            catchers,
            starts,
        }
    }
}

impl Oils {
    /// The sump and the place in the band, if the level while rotating is estimated.
    #[inline]
    pub(crate) fn estimated(&self) -> Option<(&Sump, f64)> {
        match (&self.sump, &self.surface()) {
            (Some(sump), Surface::Estimated(place)) => Some((sump, *place)),
            _ => None,
        }
    }
}

/// The lift of a gear in the sump; `None` for ring gears and gears in oil of their own.
fn lift(gear: &GearSeat, level: Level, count: f64) -> Option<Lift> {
    let Level::Sump {
        height, slope, orbit, ..
    } = level
    else {
        return None;
    };
    let [reference, tip, root] = gear.diameters.map(|diameter| 0.5 * diameter);
    (!gear.ring && tip > root && root > 0.0).then_some(Lift {
        height,
        slope,
        orbit,
        radii: [tip, reference, root],
        width: gear.facewidth * count,
        teeth: f64::from(gear.z),
    })
}

impl<R: Points> State<'_, R> {
    /// Oil height at rest above an axis, which churning laws use.
    #[inline(always)]
    pub(crate) fn level_at_rest(&self, level: Level) -> Height<R> {
        level.under(self.rest, self.incline)
    }
}

/// The level of a volume in a space of each point. \[m3, m\]
fn level_in<'a, R: Points>(space: impl Fn(usize) -> AnySpace<'a>, volume: R) -> R {
    // Points of one temperature have one level.
    let mut last: Option<(AnySpace<'a>, f64, [f64; 3])> = None;
    let [level, below, area] = R::each_of(|point| {
        let (space, volume) = (space(point), volume.at_point(point));
        if let Some((of, same, found)) = &last
            && *same == volume
            && of.is(&space)
        {
            return *found;
        }
        let level = space.level(volume);
        let [below, area] = space.volume(level);
        let found = [level, below, area.max(0.0)];
        last = Some((space, volume, found));
        found
    });
    // One step of Newton's gives derivatives, where numbers have them.
    let full = area.is_zero();
    R::select(
        full,
        level,
        level - (below - volume) / R::select(full, R::constant(1.0), area),
    )
}
