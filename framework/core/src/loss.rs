//! Results of a model: terms, limits, observed quantities, steps.
//!
//! Terms, limits and observed quantities are constants with an index. Names are neither compared nor stored per point.

mod notebook;

pub use notebook::{Kept, Notebook};

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Deserializer, Serialize};

use crate::real::{Mask as _, Points, Real};

/// Maximum number of terms of one model.
pub const MOST_TERMS: usize = 5;

/// Maximum number of values that a model may keep over the iterations of one point, and over all points that differ in torque only.
pub const MOST_KEPT: usize = 6;

/// One named part of a loss, such as rolling, sliding or drag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, schemars::JsonSchema)]
pub struct Term {
    /// Index of the term among the terms of its model.
    #[serde(skip)]
    pub index: usize,
    /// Name as in the source.
    pub name: &'static str,
    /// True if the term vanishes with the load.
    pub load_dependent: bool,
}

impl Term {
    /// The only term of a model, which depends on the load; [`terms!`](crate::terms) declares several.
    pub const fn load(name: &'static str) -> Self {
        Self {
            index: 0,
            name,
            load_dependent: true,
        }
    }

    /// The only term of a model, which does not depend on the load; [`terms!`](crate::terms) declares several.
    pub const fn no_load(name: &'static str) -> Self {
        Self {
            load_dependent: false,
            ..Self::load(name)
        }
    }

    /// The same at a position among the terms of its model.
    #[doc(hidden)]
    pub const fn at(self, index: usize) -> Self {
        assert!(index < MOST_TERMS);
        Self { index, ..self }
    }
}

/// Declares the terms of a model as constants, numbered in the order of writing, which is that of `terms` in
/// [`register!`](crate::register).
///
/// ```
/// gearloss_framework::terms! {
///     ROLLING = load("rolling");
///     DRAG = no_load("drag");
/// }
/// assert_eq!((ROLLING.index, DRAG.index), (0, 1));
/// ```
#[macro_export]
macro_rules! terms {
    ($($all:tt)+) => { $crate::numbered! { Term, 0; $($all)+ } };
}

/// Declares the limits of a model as constants: symbol, meaning, unit, least, greatest, origin of the range. They are numbered in the order of
/// writing, which is that of `limits` in [`register!`](crate::register). Limits of another module that the model lists first are named
/// in front: `after PLACE;`.
///
/// ```
/// use gearloss_framework::generic::PLACE;
///
/// gearloss_framework::limits! {
///     after PLACE;
///     SPEED = ("v", "pitch line velocity", "m/s", 0.0, 60.0, "speeds on the rig");
/// }
/// assert_eq!((SPEED.index, SPEED.greatest), (1, 60.0));
/// ```
#[macro_export]
macro_rules! limits {
    (after $($before:ident),+; $($(#[$attribute:meta])* $vis:vis $NAME:ident = $limit:tt;)+) => {
        $crate::numbered! { Limit, [$(&$before),+].len(); $($(#[$attribute])* $vis $NAME = new $limit;)+ }
    };
    ($($(#[$attribute:meta])* $vis:vis $NAME:ident = $limit:tt;)+) => {
        $crate::numbered! { Limit, 0; $($(#[$attribute])* $vis $NAME = new $limit;)+ }
    };
}

/// Declares the observed quantities of a model as constants: symbol, unit, meaning; otherwise as [`limits!`](crate::limits).
///
/// ```
/// gearloss_framework::observed! { MU = ("mu", "-", "coefficient of friction"); }
/// assert_eq!(MU.name, "mu");
/// ```
#[macro_export]
macro_rules! observed {
    (after $($before:ident),+; $($(#[$attribute:meta])* $vis:vis $NAME:ident = $observed:tt;)+) => {
        $crate::numbered! { Observed, [$(&$before),+].len(); $($(#[$attribute])* $vis $NAME = new $observed;)+ }
    };
    ($($(#[$attribute:meta])* $vis:vis $NAME:ident = $observed:tt;)+) => {
        $crate::numbered! { Observed, 0; $($(#[$attribute])* $vis $NAME = new $observed;)+ }
    };
}

/// One constant after the other, each with the next index.
#[doc(hidden)]
#[macro_export]
macro_rules! numbered {
    ($Kind:ident, $index:expr;) => {};
    ($Kind:ident, $index:expr; $(#[$attribute:meta])* $vis:vis $NAME:ident = $new:ident $arguments:tt; $($rest:tt)*) => {
        $(#[$attribute])*
        $vis const $NAME: $crate::loss::$Kind = $crate::loss::$Kind::$new $arguments.at($index);
        $crate::numbered! { $Kind, $index + 1; $($rest)* }
    };
}

/// Whether the values of a loss are moments about the attachment's relative speed or powers.
// As wide as the adjacent values, so that a loss is copied in whole words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub enum Measure {
    /// Moments, N m. The power follows from the relative speed.
    Moment,
    /// Powers, W. The moment follows from the relative speed.
    Power,
}

/// The loss of one part: a value for each term, at one point or at each of several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loss<R = f64> {
    measure: Measure,
    values: [R; MOST_TERMS],
    first_share: R,
    first_heat: R,
}

impl<R: Real> Loss<R> {
    /// A result in moments, N m, about the relative speed of the attachment; every term is zero.
    pub const MOMENTS: Self = Self {
        measure: Measure::Moment,
        values: [R::ZERO; MOST_TERMS],
        first_share: R::HALF,
        first_heat: R::HALF,
    };
    /// A result in powers, W; every term is zero.
    pub const POWERS: Self = Self {
        measure: Measure::Power,
        ..Self::MOMENTS
    };

    /// Adds to a term: N m for moments, W for powers.
    #[inline(always)]
    pub fn with(mut self, term: &Term, value: R) -> Self {
        self.values[term.index] += value;
        self
    }

    /// The result times a factor.
    #[inline(always)]
    #[must_use]
    pub fn times(mut self, factor: R) -> Self {
        for value in &mut self.values {
            *value = *value * factor;
        }
        self
    }

    /// Sets the share of a loss between two gears that reduces the torque of the first gear; default: half. From 0 to 1.
    #[inline]
    pub fn felt_by_first(mut self, share: R) -> Self {
        self.first_share = share;
        self
    }

    /// The share of the power that reduces the torque of the first gear of a pair. \[-\]
    #[inline]
    pub fn first_share(&self) -> R {
        self.first_share
    }

    /// Sets the share of the heat of a loss between two gears that enters the body of the first; default: half. If the body
    /// temperatures differ, heat also flows from one to the other, so that the share may be outside zero to one.
    #[inline(always)]
    pub fn heats_first(mut self, share: R) -> Self {
        self.first_heat = share;
        self
    }

    /// The share of the heat that enters the body of the first gear of a pair. \[-\]
    #[inline]
    pub fn first_heat(&self) -> R {
        self.first_heat
    }

    /// The mean of two results of one model, with the weight of this one; the other has the remaining weight.
    #[inline(always)]
    pub fn mean(self, weight: f64, other: Self) -> Self {
        let mut mean = self;
        mean.first_heat = self.first_heat * weight + other.first_heat * (1.0 - weight);
        for (value, other) in mean.values.iter_mut().zip(other.values) {
            *value = *value * weight + other * (1.0 - weight);
        }
        mean
    }

    /// Whether the result is in moments or powers.
    pub fn measure(&self) -> Measure {
        self.measure
    }

    /// Value of one term as returned: N m or W.
    #[inline(always)]
    pub fn value(&self, index: usize) -> R {
        self.values[index]
    }

    /// Power of one term at a relative speed in rad/s. \[W\]
    #[inline(always)]
    pub fn watts(&self, index: usize, speed: R) -> R {
        match self.measure {
            Measure::Moment => self.values[index] * speed.abs(),
            Measure::Power => self.values[index],
        }
    }

    /// Sum of all terms as returned: N m or W. Terms are added in their order.
    #[inline(always)]
    pub fn sum(&self) -> R {
        let mut sum = R::ZERO;
        for value in &self.values {
            sum += *value;
        }
        sum
    }

    /// Power of all terms at a relative speed in rad/s: the sum of [`Loss::watts`], to the last bit. \[W\]
    #[inline(always)]
    pub fn total_watts(&self, speed: R) -> R {
        match self.measure {
            Measure::Moment => {
                let speed = speed.abs();
                let mut sum = R::ZERO;
                for value in &self.values {
                    sum += *value * speed;
                }
                sum
            }
            Measure::Power => self.sum(),
        }
    }

    /// Moment of all terms about the relative speed in rad/s; zero where a power acts at standstill. \[Nm\]
    #[inline(always)]
    pub fn total_moment(&self, speed: R) -> R {
        match self.measure {
            Measure::Moment => self.sum(),
            Measure::Power => R::select(speed.is_zero(), R::ZERO, self.sum() / speed.abs()),
        }
    }

    /// Where every term is finite and not negative.
    #[inline(always)]
    pub fn is_sound(&self) -> R::Mask {
        // Negative values and NaN fail the first comparison, infinity the second.
        let mut sound = self.sum().is_below(R::constant(f64::INFINITY));
        for value in &self.values {
            sound = sound & !value.is_below(R::ZERO);
        }
        sound
    }

    /// The result without loss where a condition does not hold.
    #[inline(always)]
    pub(crate) fn only_where(mut self, mask: R::Mask) -> Self {
        for value in &mut self.values {
            *value = R::select(mask, *value, R::ZERO);
        }
        self
    }
}

impl<R: Real> Loss<R> {
    /// The result whose numbers follow from those of other results: `number` is given the access to one of them.
    pub(crate) fn gather(measure: Measure, number: impl Fn(&dyn Fn(&Loss) -> f64) -> R) -> Self {
        Self {
            measure,
            values: std::array::from_fn(|term| number(&|loss| loss.values[term])),
            first_share: number(&|loss| loss.first_share),
            first_heat: number(&|loss| loss.first_heat),
        }
    }

    /// The result of one point whose numbers follow from these.
    #[inline]
    pub(crate) fn map(&self, number: impl Fn(R) -> f64) -> Loss {
        Loss {
            measure: self.measure,
            values: self.values.map(&number),
            first_share: number(self.first_share),
            first_heat: number(self.first_heat),
        }
    }
}

impl<R: Points> Loss<R> {
    /// The same result at each point.
    #[inline(always)]
    pub(crate) fn everywhere(loss: &Loss) -> Self {
        Self {
            measure: loss.measure,
            values: loss.values.map(R::constant),
            first_share: R::constant(loss.first_share),
            first_heat: R::constant(loss.first_heat),
        }
    }

    /// The result of one point.
    #[inline]
    pub fn at_point(&self, point: usize) -> Loss {
        self.map(|value| value.at_point(point))
    }

    /// The results of the points of some bits, without derivatives, evaluated one by one; NaN where there is none, or none in the same measure as that of
    /// the first point.
    pub fn one_by_one(points: u32, mut evaluate: impl FnMut(usize) -> Result<Loss, Undefined>) -> Self {
        let mut all: Option<Self> = None;
        for point in (0..R::COUNT).filter(|point| points >> point & 1 == 1) {
            let result = evaluate(point);
            let all = all.get_or_insert(Self {
                measure: result.map_or(Measure::Power, |loss| loss.measure),
                ..Self::POWERS
            });
            match result {
                Ok(loss) if loss.measure == all.measure => {
                    for (value, number) in all.values.iter_mut().zip(loss.values) {
                        value.set(point, number);
                    }
                    all.first_share.set(point, loss.first_share);
                    all.first_heat.set(point, loss.first_heat);
                }
                _ => all.values[0].set(point, f64::NAN),
            }
        }
        all.unwrap_or(Self::POWERS)
    }
}

/// A formula is undefined. Small and without an owned text, so that it is free in a map.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error, Serialize)]
#[error("undefined: {what} = {value:.6}")]
pub struct Undefined {
    /// The quantity or condition that is outside the formula's domain.
    pub what: &'static str,
    /// Its value, in the unit stated by `what`.
    pub value: f64,
}

impl Undefined {
    /// A reason with its own text, which is kept for good: for few texts.
    pub fn new(what: String, value: f64) -> Self {
        let what = lasting(what);
        Self { what, value }
    }

    /// Points that are evaluated together take different branches of a law, so that each must be evaluated on its own. It never leaves
    /// the framework.
    pub const DISAGREED: Self = Self {
        what: "branch that all points take",
        value: f64::NAN,
    };
}

/// Reads what another process wrote.
impl<'de> Deserialize<'de> for Undefined {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        /// The reason with its own text.
        #[derive(Deserialize)]
        struct Reason {
            what: String,
            value: f64,
        }
        let Reason { what, value } = Reason::deserialize(from)?;
        Ok(Self::new(what, value))
    }
}

/// A text that is never freed, because [`Undefined`] is copied for millions of points and therefore owns none. Reasons are texts of
/// models, so that there are few; each is allocated once.
fn lasting(text: String) -> &'static str {
    static KNOWN: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(same) = known.get(text.as_str()) {
        return same;
    }
    let text: &'static str = text.leak();
    known.insert(text);
    text
}

/// The range in which a source states its formula to be valid. Outside it the model still returns a result, and this is noted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, schemars::JsonSchema)]
pub struct Limit {
    /// Index among the limits of its model.
    #[serde(skip)]
    pub index: usize,
    /// Symbol of the quantity.
    pub name: &'static str,
    /// Name of the quantity, as it stands in a sentence.
    pub meaning: &'static str,
    /// Unit of the range.
    pub unit: &'static str,
    /// Minimum of the stated range; null if there is none.
    #[schemars(with = "Option<f64>")]
    pub least: f64,
    /// Maximum of the stated range; null if there is none.
    #[schemars(with = "Option<f64>")]
    pub greatest: f64,
    /// Source of the range.
    pub origin: &'static str,
}

impl Limit {
    /// A stated range with its origin, the only one of its model; [`limits!`](crate::limits) declares several.
    pub const fn new(
        name: &'static str,
        meaning: &'static str,
        unit: &'static str,
        least: f64,
        greatest: f64,
        origin: &'static str,
    ) -> Self {
        Self {
            index: 0,
            name,
            meaning,
            unit,
            least,
            greatest,
            origin,
        }
    }

    /// The same at a position among the limits of its model.
    #[doc(hidden)]
    pub const fn at(self, index: usize) -> Self {
        Self { index, ..self }
    }
}

/// A quantity that a model reports, such as a coefficient of friction or a film ratio.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, schemars::JsonSchema)]
pub struct Observed {
    /// Index among the observed quantities of its model.
    #[serde(skip)]
    pub index: usize,
    /// Symbol.
    pub name: &'static str,
    /// Name of the quantity, as it stands in a sentence.
    pub meaning: &'static str,
    /// Unit.
    pub unit: &'static str,
}

impl Observed {
    /// The only observed quantity of a model; [`observed!`](crate::observed) declares several.
    pub const fn new(name: &'static str, unit: &'static str, meaning: &'static str) -> Self {
        Self {
            index: 0,
            name,
            unit,
            meaning,
        }
    }

    /// The same at a position among the observed quantities of its model.
    #[doc(hidden)]
    pub const fn at(self, index: usize) -> Self {
        Self { index, ..self }
    }
}

/// Observed extent of one limit or observed quantity. Extents merge in any order to the same bits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Extent {
    /// Minimum observed value.
    pub least: f64,
    /// Maximum observed value.
    pub greatest: f64,
    /// Number of points with an observation.
    pub seen: u32,
    /// Number of points outside the limit; NaN counts as outside.
    pub outside: u32,
    /// Loss of the components that use the model, summed over the points outside the limit, in whole nanowatts ([`nanowatts`]).
    pub lost_outside: i128,
}

/// A loss in whole nanowatts, whose sums do not depend on the order of the summands. \[nW\]
pub fn nanowatts(watts: f64) -> i128 {
    let scaled = watts * 1e9;
    // A conversion to 64 bits is one instruction, one to 128 bits a call.
    if scaled.abs() < 9e18 {
        i128::from(scaled as i64)
    } else {
        scaled as i128
    }
}

impl Extent {
    /// No observation.
    pub const EMPTY: Self = Self {
        least: f64::INFINITY,
        greatest: f64::NEG_INFINITY,
        seen: 0,
        outside: 0,
        lost_outside: 0,
    };

    /// Both together.
    #[inline]
    pub fn merge(self, other: Self) -> Self {
        Self {
            seen: self.seen.saturating_add(other.seen),
            outside: self.outside.saturating_add(other.outside),
            lost_outside: self.lost_outside.saturating_add(other.lost_outside),
            ..self.spanning(other.least, other.greatest)
        }
    }

    /// Counts the points of an observation.
    #[inline]
    pub(crate) fn count(&mut self, seen: Seen) {
        if seen.points == 0 {
            return;
        }
        *self = Self {
            seen: self.seen.saturating_add(seen.points.count_ones()),
            outside: self.outside.saturating_add(seen.outside.count_ones()),
            ..self.spanning(seen.least, seen.greatest)
        };
    }

    /// The same with further values; NaN is ignored, as in `min` and `max`, which promise more and cost more.
    #[inline]
    fn spanning(self, least: f64, greatest: f64) -> Self {
        Self {
            least: if least < self.least { least } else { self.least },
            greatest: if greatest > self.greatest {
                greatest
            } else {
                self.greatest
            },
            ..self
        }
    }
}

/// What the points that are evaluated together observe of one limit or quantity, with one bit for each of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    least: f64,
    greatest: f64,
    points: u32,
    outside: u32,
}

impl Seen {
    /// No observation.
    pub const NOTHING: Self = Self {
        least: f64::INFINITY,
        greatest: f64::NEG_INFINITY,
        points: 0,
        outside: 0,
    };

    #[inline]
    fn add(self, (least, greatest): (f64, f64), seen: u32, outside: u32) -> Self {
        Self {
            least: if least < self.least { least } else { self.least },
            greatest: if greatest > self.greatest {
                greatest
            } else {
                self.greatest
            },
            points: self.points | seen,
            outside: self.outside | outside,
        }
    }

    /// The values of some points, of which some are outside a limit.
    #[inline]
    pub(crate) fn new(range: (f64, f64), seen: u32, outside: u32) -> Self {
        Self::NOTHING.add(range, seen, outside)
    }

    /// What one point observes, as observed by each of several.
    pub(crate) fn for_points(self, points: u32) -> Self {
        let spread = |bits: u32| if bits == 0 { 0 } else { points };
        Self {
            points: spread(self.points),
            outside: spread(self.outside),
            ..self
        }
    }

    /// The observations without those of other points; the values are those of all.
    pub(crate) fn among(self, points: u32) -> Self {
        Self {
            points: self.points & points,
            outside: self.outside & points,
            ..self
        }
    }

    /// The observations of one of the points, as those of a single one; the values are those of all.
    pub(crate) fn at_point(self, point: usize) -> Self {
        Self {
            points: self.points >> point & 1,
            outside: self.outside >> point & 1,
            ..self
        }
    }

    /// The points outside the limit, as bits.
    pub(crate) fn outside(self) -> u32 {
        self.outside
    }

    /// The observations with each point counted once, without losses.
    #[inline]
    pub fn extent(self) -> Extent {
        Extent {
            least: self.least,
            greatest: self.greatest,
            seen: self.points.count_ones(),
            outside: self.outside.count_ones(),
            lost_outside: 0,
        }
    }
}

/// One line of an explanation.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// An intermediate of the formula.
    Value {
        /// Number of the model instance that computed it.
        instance: usize,
        /// Symbol as in the source.
        symbol: &'static str,
        /// Unit as in the source.
        unit: &'static str,
        /// Value in that unit.
        value: f64,
    },
    /// A branch that the formula took.
    Branch {
        /// Number of the model instance that took it.
        instance: usize,
        /// Description of the branch.
        taken: &'static str,
    },
}

impl Step {
    /// Number of the model instance that took the step.
    pub fn instance(&self) -> usize {
        match self {
            Self::Value { instance, .. } | Self::Branch { instance, .. } => *instance,
        }
    }
}

/// Collects the steps of one explained evaluation.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    steps: RefCell<Vec<Step>>,
}

impl Trace {
    // Cold: models are explained once and evaluated very often.
    #[cold]
    #[inline(never)]
    fn write(&self, step: Step) {
        self.steps.borrow_mut().push(step);
    }

    /// The steps in the order in which the model took them.
    pub fn into_steps(self) -> Vec<Step> {
        self.steps.into_inner()
    }
}

/// Position of the notes of one model instance among all cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NoteBase {
    // As small as possible, because every call of a model copies it.
    instance: u32,
    limits: u32,
    observed: u32,
    end: u32,
}

impl NoteBase {
    /// The position of an instance by number, with its numbers of limits and observed quantities, from a first cell.
    pub(crate) fn new(instance: usize, first: usize, limits: usize, observed: usize) -> Self {
        Self {
            instance: instance as u32,
            limits: first as u32,
            observed: (first + limits) as u32,
            end: (first + limits + observed) as u32,
        }
    }

    /// The same including the cells of its nested models, up to an end cell.
    pub(crate) fn until(self, end: usize) -> Self {
        Self {
            end: end as u32,
            ..self
        }
    }

    /// Number of the instance in the transmission.
    #[inline]
    pub fn instance(self) -> usize {
        self.instance as usize
    }

    /// First cell of its limits.
    #[inline]
    pub fn limits(self) -> usize {
        self.limits as usize
    }

    /// First cell of its observed quantities.
    #[inline]
    pub fn observed(self) -> usize {
        self.observed as usize
    }

    /// The end of its own cells and those of its nested models.
    #[inline]
    pub fn end(self) -> usize {
        self.end as usize
    }
}

/// Where one model instance writes its notes. Muted if it has no cells.
// The field order makes both parts copy in the same pieces alone and together; a copy in other pieces than those just written
// stalls, in every call of a model.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Notes<'a, R: Real = f64> {
    base: NoteBase,
    pub(crate) book: Notebook<'a, R>,
}

impl Notes<'_> {
    /// Muted notes.
    pub const MUTED: Notes<'static> = Notes {
        base: NoteBase {
            instance: 0,
            limits: 0,
            observed: 0,
            end: 0,
        },
        book: Notebook::CLOSED,
    };
}

impl<'a> Notes<'a> {
    /// Notes of one instance at one point into the cells of a scratch.
    #[inline]
    pub fn new(cells: &'a [Cell<Seen>], base: NoteBase) -> Self {
        let book = Notebook {
            cells,
            ..Notebook::CLOSED
        };
        Self { base, book }
    }

    /// The same notes, recording every step.
    pub fn traced(self, trace: &'a Trace) -> Self {
        let book = Notebook {
            trace: Some(trace),
            ..self.book
        };
        Self { book, ..self }
    }
}

impl<'a, R: Points> Notes<'a, R> {
    /// The notes of one of the points.
    #[inline]
    pub fn at_point(self, point: usize) -> Notes<'a> {
        Notes {
            base: self.base,
            book: self.book.at_point(point),
        }
    }
}

impl<R: Real> Notes<'_, R> {
    /// The same target for a nested instance. It keeps nothing, because it may be evaluated at several speeds or with several oils.
    #[inline]
    pub fn nested(self, base: NoteBase) -> Self {
        self.nested_at_same_state(base).forgetting()
    }

    /// The same for a nested instance that is only evaluated at the speed, oil and level of this one, so that it may keep values,
    /// too.
    #[inline]
    pub fn nested_at_same_state(self, base: NoteBase) -> Self {
        Self { base, ..self }
    }

    /// The same notes for an instance that is evaluated several times at a point, at other speeds or with other oils: nothing is
    /// kept.
    #[inline]
    pub(crate) fn forgetting(self) -> Self {
        let book = Notebook {
            kept: &[],
            kept_alone: &[],
            ..self.book
        };
        Self { book, ..self }
    }

    /// Values that depend only on speed, oil and its level. The iterations of one point and all points that differ in torque only
    /// share them; without space to keep them they are computed again. Each instance has one slot, so it must always compute the
    /// same values. Limits and observed quantities are noted elsewhere.
    #[inline(always)]
    pub fn once<const N: usize>(&self, numbers: impl FnOnce() -> [R; N]) -> [R; N] {
        const { assert!(0 < N && N <= MOST_KEPT) };
        let Some(kept) = self.book.kept.get(self.base.instance()) else {
            return numbers();
        };
        let known = kept.take();
        let known = known.unwrap_or_else(|| {
            let numbers = numbers();
            std::array::from_fn(|i| if i < N { numbers[i] } else { R::ZERO })
        });
        kept.set(Some(known));
        std::array::from_fn(|i| known[i])
    }

    /// The same points without notes, for an evaluation whose result is not the final one.
    #[inline(always)]
    #[must_use]
    pub fn muted(self) -> Self {
        let book = Notebook {
            cells: &[],
            trace: None,
            ..self.book
        };
        Self { book, ..self }
    }

    /// The same notes of those points only at which a condition holds.
    #[inline(always)]
    #[must_use]
    pub fn among(self, mask: R::Mask) -> Self {
        let points = self.book.points & mask.bits();
        let book = Notebook { points, ..self.book };
        Self { book, ..self }
    }

    /// The points that note, as bits.
    #[inline]
    pub fn points(&self) -> u32 {
        self.book.points
    }

    /// True if the notes are not used.
    #[inline]
    pub fn is_muted(&self) -> bool {
        self.book.cells.is_empty() && self.book.trace.is_none()
    }

    /// True if the steps of the formula are shown.
    #[inline]
    pub fn is_traced(&self) -> bool {
        self.book.trace.is_some()
    }

    /// Notes whether a value, in the limit's unit, is in its stated range. Returns the value.
    #[inline(always)]
    pub fn check(&self, limit: &Limit, x: R) -> R {
        if let Some(cell) = self.book.cells.get(self.base.limits() + limit.index) {
            let points = self.book.points;
            let outside = points & !x.is_within(limit.least, limit.greatest).bits();
            cell.set(cell.get().add(x.extremes(points), points, outside));
        }
        self.show(limit.name, limit.unit, x)
    }

    /// Notes an observed quantity in its unit. Returns the value.
    #[inline(always)]
    pub fn observe(&self, observed: &Observed, x: R) -> R {
        if let Some(cell) = self.book.cells.get(self.base.observed() + observed.index) {
            let points = self.book.points;
            cell.set(cell.get().add(x.extremes(points), points, 0));
        }
        self.show(observed.name, observed.unit, x)
    }

    /// Shows an intermediate of the formula in an explanation, in the source's symbol and unit. Returns the value.
    #[inline(always)]
    pub fn show(&self, symbol: &'static str, unit: &'static str, x: R) -> R {
        if let Some(trace) = self.book.trace {
            trace.write(Step::Value {
                instance: self.base.instance(),
                symbol,
                unit,
                // A single point is explained.
                value: x.extremes(1).0,
            });
        }
        x
    }

    /// Names the branch of the formula in an explanation.
    #[inline(always)]
    pub fn branch(&self, taken: &'static str) {
        if let Some(trace) = self.book.trace {
            trace.write(Step::Branch {
                instance: self.base.instance(),
                taken,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    terms! {
        ROLLING = load("rolling");
        DRAG = no_load("drag");
    }
    limits! { RANGE = ("x", "position", "-", 0.0, 1.0, "test"); }

    #[test]
    fn a_reason_is_read_back_with_a_text_that_lasts() {
        let what = String::from("speed [rpm]").leak();
        let reason = Undefined { what, value: -3.5 };
        let text = serde_json::to_string(&reason).unwrap_or_default();
        let [one, other] = [(); 2].map(|()| serde_json::from_str::<Undefined>(&text).ok());
        assert_eq!((one, other), (Some(reason), Some(reason)));
        let [one, other] = [one, other].map(|reason| reason.map(|reason| reason.what.as_ptr()));
        assert_eq!(one, other, "it is allocated once");
    }

    #[test]
    fn total_derives_from_terms_to_the_last_bit() {
        let loss = Loss::MOMENTS.with(&ROLLING, 0.1).with(&DRAG, 0.2);
        assert_eq!(loss.total_watts(-3.0), loss.watts(0, 3.0) + loss.watts(1, 3.0));
        assert_eq!(loss.total_watts(0.0), 0.0);
        assert_eq!(Loss::POWERS.with(&DRAG, 6.0).total_moment(-3.0), 2.0);
    }

    #[test]
    fn a_limit_counts_what_is_outside_and_nan_too() {
        let mut extents = [Seen::NOTHING];
        {
            let cells = Cell::from_mut(&mut extents[..]).as_slice_of_cells();
            let notes = Notes::new(cells, NoteBase::default());
            for x in [0.5, 1.5, f64::NAN] {
                notes.check(&RANGE, x);
            }
        }
        // Three observations of one point.
        let extent = extents[0].extent();
        assert_eq!((extent.seen, extent.outside, extent.greatest), (1, 1, 1.5));
    }

    #[test]
    fn muted_notes_write_nowhere() {
        assert_eq!(Notes::MUTED.check(&RANGE, 7.0), 7.0);
    }
}
