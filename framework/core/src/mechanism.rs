//! Mechanisms: physical causes of loss, each with its own trait, context and result.
//!
//! A mechanism consists of an empty marker type, a plain trait that models implement, a context that lists each quantity once
//! ([`context!`](crate::context)), and, if its parts have a section in the document, an attachment ([`crate::attach`]).

mod answers;
pub mod auxiliary;
pub mod bearing;
pub mod bevel_mesh;
pub mod chain;
pub mod clutch;
pub mod crossed_helical_mesh;
pub(crate) mod differences;
pub mod differential;
pub mod gear_drag;
pub mod gear_mesh;
pub mod heat_dissipation;
pub mod heat_link;
pub mod joint;
mod law;
pub mod mean_friction;
mod mesh_law;
pub mod planetary_drag;
pub mod scalar;
pub mod seal;
mod slot;
pub mod synchronizer;
pub mod tooth_friction;
pub mod worm_mesh;

pub use answers::Answers;
pub use law::{Follows, Law, ROUNDED, settle};
pub use scalar::{Lookup, Scalar};
pub use slot::{ModelRef, NamedSlots, Slot};

use std::borrow::Cow;
use std::sync::Arc;

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use crate::attach::{Attach, Stiffness};
use crate::document::Unit;
use crate::loads::{AngularRow, Carries, Induced, StaticRating};
use crate::loss::{Loss, Notes, Term, Undefined};
use crate::real::{Dual, Lane, Points, Real};

/// A physical cause of loss. Implemented by an empty marker type, once per mechanism.
pub trait Mechanism: Sized + 'static {
    /// Name in documents: snake_case, a noun.
    const KEY: &'static str;
    /// Description, as a sentence.
    const MEANING: &'static str;
    /// Result of a model, for `constant`, `formula` and `table`. Ends with its \[unit\].
    const ANSWER: &'static str;
    /// An example part for the conformance suite and `eval`, in YAML.
    const EXAMPLE: &'static str;
    /// The quantities of the context.
    const QUANTITIES: &'static [Quantity<Self>] = <Self::At<'static, f64> as Inputs<'static, Self, f64>>::QUANTITIES;
    /// The laws between them.
    const LAWS: &'static [Law<Self>] = <Self::At<'static, f64> as Inputs<'static, Self, f64>>::LAWS;
    /// The term set by `constant`, `formula` and `table`.
    const TOTAL: Term = Term::no_load("total");
    /// The component: the typed fields of its entry. [`NoPart`] if there is none. Derived values are computed during
    /// deserialisation (`serde(try_from)`), so that an existing part is complete. One that is read again and is equal keeps its model.
    type Part: DeserializeOwned + JsonSchema + PartialEq + Send + Sync;
    /// All inputs of a model, at one point or at several; defined by [`context!`](crate::context).
    type At<'a, R: Real>: Inputs<'a, Self, R>;
    /// A [`Loss`], or an `f64` for a coefficient.
    type Answer: Answer;
    /// The plain trait that a model implements, as `dyn`.
    type Model: ?Sized + Send + Sync;

    /// Table axes, and `answer`, that are logarithmic if all values are positive.
    const LOGARITHMIC: &'static [&'static str] = &[];
    /// Names among `none`, `constant`, `formula` and `table` that the mechanism's own models use.
    const OWN: &'static [&'static str] = &[];

    /// What to state so that a quantity is known for a part; `None` if it is known. Used by tables and formulas.
    fn needs(_part: &Self::Part, _quantity: &str) -> Option<&'static str> {
        None
    }
    /// A context at its usual point, the base point of `eval` and the conformance grid.
    fn usual<'a>(part: &'a Self::Part, notes: Notes<'a>) -> Self::At<'a, f64> {
        Self::At::usual(part, notes)
    }
    /// Calls the model; written by [`answered_by!`](crate::answered_by).
    fn answer(model: &Self::Model, at: &Self::At<'_, f64>) -> Result<Self::Answer, Undefined>;
    /// The relative speed opposed by the moments of the result: the quantity `speed`; one if there is none. \[rad/s\]
    fn speed(at: &Self::At<'_, f64>) -> f64 {
        let speed = Self::QUANTITIES.iter().find(|q| q.name == "speed");
        speed.map_or(1.0, |q| (q.get)(at))
    }
    /// The result of a model at several points together. An error, whichever, has the points evaluated one by one; that is what most
    /// models do, whose law is written for one point.
    ///
    /// # Errors
    /// If the points take different branches, one of them is undefined, or the law is not written for several points.
    fn answer_together(
        _model: &Self::Model,
        _at: &Self::At<'_, Lane>,
    ) -> Result<<Self::Answer as Answer>::Of<Lane>, Undefined> {
        Err(Undefined::DISAGREED)
    }
    /// The result of a model with its derivatives; `None` if its law is not written over [`Real`] and must be differentiated by
    /// differences.
    fn answer_with_derivatives(
        _model: &Self::Model,
        _at: &Self::At<'_, Dual>,
    ) -> Option<Result<<Self::Answer as Answer>::Of<Dual>, Undefined>> {
        None
    }
    /// The adapter through which `none`, `constant`, `formula` and `table` serve this mechanism; written by
    /// [`answered_by!`](crate::answered_by).
    fn scalar(law: Scalar<Self>) -> Arc<Self::Model>;
}

/// Writes how a [`Mechanism`] calls its models, by the method of their trait: `answered_by!(loss);` in its `impl`. A trait for laws that
/// are written over [`Real`] names the methods for several points and for derivatives, too.
#[macro_export]
macro_rules! answered_by {
    ($method:ident, $together:ident, $with_derivatives:ident) => {
        $crate::answered_by!($method);
        fn answer_together(
            model: &Self::Model,
            at: &Self::At<'_, $crate::real::Lane>,
        ) -> Result<<Self::Answer as $crate::mechanism::Answer>::Of<$crate::real::Lane>, $crate::loss::Undefined> {
            model.$together(at)
        }
        fn answer_with_derivatives(
            model: &Self::Model,
            at: &Self::At<'_, $crate::real::Dual>,
        ) -> Option<Result<<Self::Answer as $crate::mechanism::Answer>::Of<$crate::real::Dual>, $crate::loss::Undefined>>
        {
            model.$with_derivatives(at)
        }
    };
    ($method:ident) => {
        fn answer(model: &Self::Model, at: &Self::At<'_, f64>) -> Result<Self::Answer, $crate::loss::Undefined> {
            model.$method(at)
        }
        fn scalar(law: $crate::mechanism::Scalar<Self>) -> ::std::sync::Arc<Self::Model> {
            ::std::sync::Arc::new(law)
        }
    };
}

/// All inputs of the models of a mechanism; [`context!`](crate::context) implements it.
pub trait Inputs<'a, M: Mechanism, R: Real>: Copy {
    /// The list of the quantities.
    const QUANTITIES: &'static [Quantity<M>];
    /// The laws between them.
    const LAWS: &'static [Law<M>];
    /// The context at its usual point.
    fn usual(part: &'a M::Part, notes: Notes<'a, R>) -> Self;
    /// The component.
    fn part(&self) -> &'a M::Part;
    /// Target of limits, observed quantities and steps.
    fn notes(&self) -> Notes<'a, R>;
    /// The same with another target.
    fn with_notes(&self, notes: Notes<'a, R>) -> Self;
    /// A context of one point, whose quantities follow from these.
    fn map(&self, notes: Notes<'a>, number: impl Fn(R) -> f64) -> M::At<'a, f64>;
    /// The context of one of the points.
    #[inline(always)]
    fn at_point(&self, point: usize) -> M::At<'a, f64>
    where
        R: Points,
    {
        self.map(self.notes().at_point(point), |x| x.at_point(point))
    }
    /// The context whose quantities follow from those of others: `number` is given the access to one quantity.
    fn gather(part: &'a M::Part, notes: Notes<'a, R>, number: impl Fn(&dyn Fn(&M::At<'a, f64>) -> f64) -> R) -> Self;
    /// The context of several points, from that of each.
    fn together(part: &'a M::Part, notes: Notes<'a, R>, each: impl Fn(usize) -> M::At<'a, f64>) -> Self
    where
        R: Points,
    {
        Self::gather(part, notes, |quantity| R::each(|point| quantity(&each(point))))
    }
}

/// A mechanism whose parts have their own section in the document.
pub trait Component: Mechanism<Answer = Loss> {
    /// Name of the section: the plural of the part.
    const SECTION: &'static str;
    /// Attachment of its parts; determines relative speed, loads, oil and which members take the reaction.
    type Attachment: Attach;
    /// The context of a part at its site.
    fn context<'a, R: Points>(
        part: &'a Self::Part,
        site: <Self::Attachment as Attach>::Site<'a, R>,
        notes: Notes<'a, R>,
    ) -> Self::At<'a, R>;
    /// Static load rating of a part that carries load, if known.
    fn static_rating(_part: &Self::Part) -> Option<StaticRating> {
        None
    }
    /// The loads that a part can carry by its design.
    fn carries(_part: &Self::Part) -> Carries {
        Carries::ANY
    }
    /// The thrust that a radial load induces by the design of a part.
    fn induced(_part: &Self::Part) -> Induced {
        Induced::None
    }
    /// How a part with a contact angle is displaced by an axial load; an error says why this is not known.
    ///
    /// # Errors
    /// If the part has no contact angle, or its geometry is not known.
    fn angular_row(_part: &Self::Part) -> Result<AngularRow, Cow<'static, str>> {
        Err("it is no rolling bearing".into())
    }
    /// A stiffness of a part under a radial load (N); an error says why this is not known.
    ///
    /// # Errors
    /// If the part has no load distribution.
    fn stiffness(_part: &Self::Part, _stiffness: Stiffness, _load: f64) -> Result<f64, Cow<'static, str>> {
        Err("it is no rolling bearing".into())
    }
    /// Radius of the lowest point over which the oil height at the place of a part matters to its context; `None` if it does not. \[m\]
    fn lowest(_part: &Self::Part) -> Option<f64> {
        Some(f64::INFINITY)
    }
    /// Name of a part in messages about it, such as its designation.
    fn name(_part: &Self::Part) -> String {
        Self::KEY.to_owned()
    }
}

/// The part of a mechanism that has none.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Deserialize, serde::Serialize, JsonSchema)]
pub struct NoPart {}

mod sealed {
    /// Sealed: only the framework implements the traits bounded by it.
    pub trait Sealed {}
    impl Sealed for crate::loss::Loss {}
    impl Sealed for f64 {}
}

/// The result of a mechanism's models: a [`Loss`] or a coefficient. Sealed.
pub trait Answer: sealed::Sealed + Copy + Send + Sync {
    /// The result at several points.
    type Of<R: Real>;
    /// The result of the only point.
    fn alone(self) -> Self::Of<f64>;
    /// The results of the points of some bits, evaluated one by one; NaN where one is undefined.
    fn one_by_one<R: Points>(points: u32, evaluate: impl FnMut(usize) -> Result<Self, Undefined>) -> Self::Of<R>;
    /// The result of one point whose numbers follow from these.
    fn map<R: Real>(all: &Self::Of<R>, number: impl Fn(R) -> f64) -> Self;
    /// The result of one of the points.
    fn at_point<R: Points>(all: &Self::Of<R>, point: usize) -> Self {
        Self::map(all, |x: R| x.at_point(point))
    }
    /// The result whose numbers follow from those of others of the same model: `number` is given the access to one of them.
    fn gather<R: Real>(&self, number: impl Fn(&dyn Fn(&Self) -> f64) -> R) -> Self::Of<R>;
    /// The named values of the result at a relative speed: for a loss, the power of each term. \[W or the unit of the result\]
    fn values(&self, terms: &'static [Term], speed: f64) -> Vec<(&'static str, f64)>;
    /// True if the result is finite and not negative.
    fn is_sound(&self) -> bool;
    /// One number for the whole result: the power, or the coefficient.
    fn total(&self, speed: f64) -> f64;
    /// The moment about a relative speed; `None` for a coefficient. \[Nm\]
    fn moment(&self, speed: f64) -> Option<f64>;
    /// Index of a term that is set but not listed.
    fn stray(&self, terms: &[Term]) -> Option<usize>;
}

impl Answer for Loss {
    type Of<R: Real> = Loss<R>;
    fn alone(self) -> Self {
        self
    }
    fn one_by_one<R: Points>(points: u32, evaluate: impl FnMut(usize) -> Result<Self, Undefined>) -> Loss<R> {
        Loss::one_by_one(points, evaluate)
    }
    fn map<R: Real>(all: &Loss<R>, number: impl Fn(R) -> f64) -> Self {
        all.map(number)
    }
    fn gather<R: Real>(&self, number: impl Fn(&dyn Fn(&Self) -> f64) -> R) -> Loss<R> {
        Loss::gather(self.measure(), number)
    }
    fn values(&self, terms: &'static [Term], speed: f64) -> Vec<(&'static str, f64)> {
        terms.iter().map(|t| (t.name, self.watts(t.index, speed))).collect()
    }
    fn is_sound(&self) -> bool {
        Loss::is_sound(self)
    }
    fn total(&self, speed: f64) -> f64 {
        self.total_watts(speed)
    }
    fn moment(&self, speed: f64) -> Option<f64> {
        Some(self.total_moment(speed))
    }
    fn stray(&self, terms: &[Term]) -> Option<usize> {
        (terms.len()..crate::loss::MOST_TERMS).find(|i| self.value(*i) != 0.0)
    }
}

impl Answer for f64 {
    type Of<R: Real> = R;
    fn alone(self) -> Self {
        self
    }
    fn one_by_one<R: Points>(points: u32, mut evaluate: impl FnMut(usize) -> Result<Self, Undefined>) -> R {
        R::each(|point| match points >> point & 1 {
            1 => evaluate(point).unwrap_or(f64::NAN),
            _ => 0.0,
        })
    }
    fn map<R: Real>(all: &R, number: impl Fn(R) -> f64) -> Self {
        number(*all)
    }
    fn gather<R: Real>(&self, number: impl Fn(&dyn Fn(&Self) -> f64) -> R) -> R {
        number(&|result| *result)
    }
    fn values(&self, _terms: &'static [Term], _speed: f64) -> Vec<(&'static str, f64)> {
        vec![("value", *self)]
    }
    fn is_sound(&self) -> bool {
        self.is_finite() && *self >= 0.0
    }
    fn total(&self, _speed: f64) -> f64 {
        *self
    }
    fn moment(&self, _speed: f64) -> Option<f64> {
        None
    }
    fn stray(&self, _terms: &[Term]) -> Option<usize> {
        None
    }
}

/// One entry of a mechanism's context. It can be read and set, because `eval` and the conformance grid build contexts.
pub struct Quantity<M: Mechanism> {
    /// Name in formulas, tables and `eval`.
    pub name: &'static str,
    /// Description, with its \[unit\] at the end.
    pub doc: &'static str,
    /// The unit.
    pub unit: &'static Unit,
    /// Usual value in that unit.
    pub usual: f64,
    /// Minimum value at which models are tested, in the documented unit. The framework does not clip.
    pub least: f64,
    /// Maximum value at which models are tested, in the documented unit. The framework does not clip.
    pub greatest: f64,
    /// Source of the value in the framework.
    pub from: &'static str,
    /// Reads the value, SI.
    pub get: for<'a, 'b> fn(&'b M::At<'a, f64>) -> f64,
    /// Reads the values of several points, SI.
    pub get_together: for<'a, 'b> fn(&'b M::At<'a, Lane>) -> Lane,
    /// Sets the value, SI.
    pub set: for<'a, 'b> fn(&'b mut M::At<'a, f64>, f64),
}

impl<M: Mechanism> Quantity<M> {
    /// The unit at the end of a doc comment. In a constant, a missing unit is a compile error with the message.
    #[doc(hidden)]
    pub const fn unit_of(doc: &str, missing: &str) -> &'static Unit {
        match Unit::of_doc(doc) {
            Some(unit) => unit,
            None => panic!("{}", missing),
        }
    }

    /// Its value at a context, in its unit.
    pub(crate) fn value(&self, at: &M::At<'_, f64>) -> f64 {
        self.unit.from_si((self.get)(at))
    }

    /// The same at several points.
    #[inline(always)]
    pub(crate) fn values(&self, at: &M::At<'_, Lane>) -> Lane {
        let si = (self.get_together)(at);
        if self.unit.is_si() {
            return si;
        }
        si.map(|si| self.unit.from_si(si))
    }
}

/// A [`Quantity`] without its types, for listings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuantityDoc {
    /// Name.
    pub name: &'static str,
    /// Description and unit.
    pub doc: &'static str,
    /// The unit.
    pub unit: &'static Unit,
    /// Usual value in the documented unit.
    pub usual: f64,
    /// Minimum value in the documented unit.
    pub least: f64,
    /// Maximum value in the documented unit.
    pub greatest: f64,
    /// Source of the value in the framework.
    pub from: &'static str,
}

/// Declares the context of a mechanism: each quantity once, with its description and unit in the doc comment, its usual value, the
/// range in which models are tested, and the source of the value. The fields are SI; the three numbers are in the documented unit.
/// A description may exceed the range, and the framework does not clip: a model returns a result there too, or reports that it is
/// undefined.
///
/// The same list feeds rustdoc, `models`, the schema and input of `eval`, the variables of `formula`, the axes of `table`
/// and the grid of the conformance suite.
///
/// Quantities that depend on each other are listed below in `laws`: a [`Law`] in its written form, and for each of its quantities
/// the value from the others; `usually` before the brace if the law need not hold.
///
/// `..oil from "the oil of the component",` stands for the temperature, the viscosities and the density of an oil, with their law;
/// `..oil of contacts from` adds what friction between teeth depends on.
///
/// A context may gain quantities, so other crates do not construct it (`#[non_exhaustive]`): they start from the usual context or
/// an existing one, and change the known quantities (`with`, `nested`).
#[macro_export]
macro_rules! context {
    (@unit $M:ty, $name:ident, $($doc:literal)+) => {
        $crate::mechanism::Quantity::<$M>::unit_of(
            concat!($($doc),+),
            concat!("the doc comment of `", stringify!($name), "` does not end in a known [unit]"),
        )
    };
    ($(#[doc = $head:literal])+ pub struct $At:ident of $M:ty {
        $($(#[doc = $doc:literal])+ $name:ident: $usual:literal in $least:literal ..= $greatest:literal from $from:literal,)+
        ..oil of contacts from $oil:literal,
        $($more:tt)*
    } $($laws:tt)*) => {
        $crate::context! { $(#[doc = $head])+ pub struct $At of $M {
            $($(#[doc = $doc])+ $name: $usual in $least ..= $greatest from $from,)+
            ..oil from $oil,
            /// Pressure-viscosity coefficient of the oil. [1/GPa]
            alpha: 15.0 in 1.0..=60.0 from "`pressure_viscosity` of the oil, or its kind",
            /// Relative decrease of the oil's viscosity with temperature. [1/K]
            beta: 0.03 in 0.001..=0.3 from "the slope of its viscosity at this temperature",
            /// Thermal conductivity of the oil. [W/(m K)]
            conductivity: 0.135 in 0.05..=0.5 from "`conductivity` of the oil, else its density according to Cragoe",
            /// Lubricant factor of mean mesh friction stated for the oil. [-]
            x_l: 1.0 in 0.1..=2.0 from "`x_l` of the oil, or its kind",
            $($more)*
        } $($laws)* }
    };
    ($(#[doc = $head:literal])+ pub struct $At:ident of $M:ty {
        $($(#[doc = $doc:literal])+ $name:ident: $usual:literal in $least:literal ..= $greatest:literal from $from:literal,)+
        ..oil from $oil:literal,
        $($more:tt)*
    } $(laws { $($laws:tt)+ })?) => {
        $crate::context! { $(#[doc = $head])+ pub struct $At of $M {
            $($(#[doc = $doc])+ $name: $usual in $least ..= $greatest from $from,)+
            /// Temperature of the oil. [degC]
            temperature: 80.0 in -40.0..=200.0 from
                concat!($oil, ": given, balanced or a node of the network, and `temperature_offset`"),
            /// Kinematic viscosity of the oil. [mm2/s]
            nu: 10.0 in 1.0..=10000.0 from "the viscosity of that oil at this temperature",
            /// Dynamic viscosity of the oil. [mPa s]
            eta: 8.2 in 0.5..=10000.0 from "`nu` times `rho`",
            /// Density of the oil. [kg/m3]
            rho: 820.0 in 500.0..=1300.0 from "the density of that oil at this temperature",
            $($more)*
        } laws {
            "eta = nu rho" { eta: |at| at.nu * at.rho, nu: |at| at.eta / at.rho, rho: |at| at.eta / at.nu }
            $($($laws)+)?
        } }
    };
    ($(#[doc = $head:literal])+ pub struct $At:ident of $M:ty {
        $($(#[doc = $doc:literal])+ $name:ident: $usual:literal in $least:literal ..= $greatest:literal from $from:expr,)+
    } $(laws {
        $($law:literal $($usually:ident)? { $($of:ident: $follows:expr),+ $(,)? })+
    })?) => {
        $(#[doc = $head])+
        #[derive(Clone, Copy)]
        #[non_exhaustive]
        pub struct $At<'a, R: $crate::real::Real = f64> {
            /// The component.
            pub part: &'a <$M as $crate::mechanism::Mechanism>::Part,
            $(
                $(#[doc = $doc])+
                #[doc = ""]
                #[doc = concat!("SI here; in that unit usually ", stringify!($usual), ", tested from ", stringify!($least), " to ",
                    stringify!($greatest), ". From ", $from, ".")]
                pub $name: R,
            )+
            /// Target of limits, observed quantities and steps.
            pub notes: $crate::loss::Notes<'a, R>,
        }

        impl<'a, R: $crate::real::Real> $crate::mechanism::Inputs<'a, $M, R> for $At<'a, R> {
            const QUANTITIES: &'static [$crate::mechanism::Quantity<$M>] = &[$($crate::mechanism::Quantity {
                name: stringify!($name), doc: concat!($($doc),+), usual: $usual, least: $least, greatest: $greatest, from: $from,
                unit: $crate::context!(@unit $M, $name, $($doc)+),
                get: |at| at.$name, get_together: |at| at.$name, set: |at, si| at.$name = si,
            }),+];

            const LAWS: &'static [$crate::mechanism::Law<$M>] = &[$($($crate::mechanism::Law {
                text: $law, quantities: &[$((stringify!($of), $follows)),+], always: <[&str]>::is_empty(&[$(stringify!($usually))?]),
            }),+)?];

            fn usual(part: &'a <$M as $crate::mechanism::Mechanism>::Part, notes: $crate::loss::Notes<'a, R>) -> Self {
                $(#[allow(non_upper_case_globals)]
                const $name: f64 = $crate::context!(@unit $M, $name, $($doc)+).to_si($usual);)+
                Self { part, $($name: R::constant($name),)+ notes }
            }

            fn part(&self) -> &'a <$M as $crate::mechanism::Mechanism>::Part {
                self.part
            }

            fn notes(&self) -> $crate::loss::Notes<'a, R> {
                self.notes
            }

            fn with_notes(&self, notes: $crate::loss::Notes<'a, R>) -> Self {
                Self { notes, ..*self }
            }

            #[inline(always)]
            fn map(&self, notes: $crate::loss::Notes<'a>, number: impl Fn(R) -> f64) -> $At<'a> {
                $At { part: self.part, $($name: number(self.$name),)+ notes }
            }

            fn gather(
                part: &'a <$M as $crate::mechanism::Mechanism>::Part,
                notes: $crate::loss::Notes<'a, R>,
                number: impl Fn(&dyn Fn(&$At<'a>) -> f64) -> R,
            ) -> Self {
                Self { part, $($name: number(&|at| at.$name),)+ notes }
            }
        }

        impl<'a, R: $crate::real::Real> $At<'a, R> {
            /// The context at its usual point.
            pub fn usual(part: &'a <$M as $crate::mechanism::Mechanism>::Part, notes: $crate::loss::Notes<'a, R>) -> Self {
                <Self as $crate::mechanism::Inputs<'a, $M, R>>::usual(part, notes)
            }

            /// The same with some quantities changed.
            #[inline(always)]
            pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
                change(&mut self);
                self
            }

            /// The same for the model of a nested slot, which has its own notes.
            #[inline]
            pub fn nested(&self, slot: &$crate::mechanism::Slot<$M>) -> Self {
                self.with(|to| to.notes = self.notes.nested(slot.notes))
            }

            /// Notes whether a value is in the range of a limit; returns the value.
            #[inline(always)]
            pub fn check(&self, limit: &$crate::loss::Limit, x: R) -> R {
                self.notes.check(limit, x)
            }

            /// Notes an observed quantity; returns the value.
            #[inline(always)]
            pub fn observe(&self, observed: &$crate::loss::Observed, x: R) -> R {
                self.notes.observe(observed, x)
            }

            /// Shows an intermediate in an explanation; returns the value.
            #[inline(always)]
            pub fn show(&self, symbol: &'static str, unit: &'static str, x: R) -> R {
                self.notes.show(symbol, unit, x)
            }

            /// Values that depend only on speed, oil and its level, computed once for all iterations of a point and all points that
            /// differ in torque only.
            #[inline(always)]
            pub fn once<const N: usize>(&self, numbers: impl FnOnce() -> [R; N]) -> [R; N] {
                self.notes.once(numbers)
            }

            /// Names the branch in an explanation.
            #[inline(always)]
            pub fn branch(&self, taken: &'static str) {
                self.notes.branch(taken);
            }
        }
    };
}

/// A context with these values and those of `..oil`, or of `..oil of contacts`, from an oil or another context.
macro_rules! with_oil {
    (of contacts from $oil:expr, $At:ident { $($name:ident $(: $value:expr)?),+ $(,)? }) => {
        $crate::mechanism::with_oil!(from $oil, $At {
            alpha: $oil.alpha,
            beta: $oil.beta,
            conductivity: $oil.conductivity,
            x_l: $oil.x_l,
            $($name $(: $value)?,)+
        })
    };
    (from $oil:expr, $At:ident { $($name:ident $(: $value:expr)?),+ $(,)? }) => {
        $At {
            temperature: $oil.temperature,
            nu: $oil.nu,
            eta: $oil.eta,
            rho: $oil.rho,
            $($name $(: $value)?,)+
        }
    };
}
pub(crate) use with_oil;

/// A part is described by the schema of the entry from which it is made.
macro_rules! described_as {
    ($Part:ty, $Entry:ty) => {
        impl schemars::JsonSchema for $Part {
            fn inline_schema() -> bool {
                true
            }
            fn schema_name() -> std::borrow::Cow<'static, str> {
                <$Entry>::schema_name()
            }
            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                <$Entry>::json_schema(generator)
            }
        }
    };
}
pub(crate) use described_as;

/// Unit conversions for empirical formulas, which then show their units at the point of use.
pub trait ShopUnits: Real {
    /// rad/s to revolutions per minute.
    #[inline(always)]
    #[must_use]
    fn rpm(self) -> Self {
        self * (30.0 / std::f64::consts::PI)
    }
    /// m to mm.
    #[inline(always)]
    #[must_use]
    fn mm(self) -> Self {
        self * 1e3
    }
    /// m to um.
    #[inline(always)]
    #[must_use]
    fn um(self) -> Self {
        self * 1e6
    }
    /// m2/s to mm2/s.
    #[inline(always)]
    #[must_use]
    fn mm2_s(self) -> Self {
        self * 1e6
    }
    /// Pa s to mPa s.
    #[inline(always)]
    #[must_use]
    fn mpa_s(self) -> Self {
        self * 1e3
    }
    /// Pa to GPa.
    #[inline(always)]
    #[must_use]
    fn gpa(self) -> Self {
        self * 1e-9
    }
    /// N/m to N/mm.
    #[inline(always)]
    #[must_use]
    fn n_mm(self) -> Self {
        self * 1e-3
    }
    /// N mm to N m.
    #[inline(always)]
    #[must_use]
    fn nmm_in_nm(self) -> Self {
        self * 1e-3
    }
}

impl<R: Real> ShopUnits for R {}
