//! Friction between flanks along the path of contact.

use crate::contact::{Film, thermal_terms};
use crate::loss::{Notes, Undefined};
use crate::mechanism::mean_friction::{MeanFrictionAt, hertz, load_at, modulus_at, radius_at};
use crate::mechanism::{Answers, Inputs as _, Mechanism, NoPart, Scalar, Slot, with_oil};
use crate::real::{Dual, Lane, Mask as _, Points, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum ToothFriction {}

/// Coefficient of friction between flanks. A model returns it for one contact; a model that iterates along the path, or shares work
/// between its nodes, returns it for the whole path.
///
/// The inputs are [`ContactAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait ToothFrictionModel: Send + Sync {
    /// Coefficient of friction at one contact. \[-\] Pure; must not allocate.
    fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined>;

    /// Number of nodes on each smooth section of a path for an error of the loss below 1e-4, or of the mean friction below 1e-6,
    /// unless the law has a [kink](Along::kink). [`SMOOTH`] is enough for a law that is smooth inside the sections, for any power
    /// of sliding and load at their ends; [`KINKED`] for one with unknown kinks. For a law with [limits](Self::friction_limits), its
    /// coefficients times load are also interpolated between these nodes.
    fn order(&self) -> usize {
        SMOOTH
    }

    /// The same where the law has a kink; none if it never has one, other than at its [limits](Self::friction_limits).
    fn kinked_order(&self) -> Option<usize> {
        None
    }

    /// The same for coefficients that are cut off at the limits.
    fn cut_off_order(&self) -> Option<usize> {
        let cut_off = self.friction_limits().map(|_| KINKED);
        cut_off.max(self.kinked_order())
    }

    /// Limits at which the framework cuts off the coefficients of [`uncut_along`](Self::uncut_along). A model that states them writes
    /// that method too, because `mu` is already cut off.
    fn friction_limits(&self) -> Option<FrictionLimits> {
        None
    }

    /// Coefficients of friction at all nodes of a path, before they are cut off at the [limits](Self::friction_limits), into a slice of the
    /// length of the path. Pure; must not allocate. Ask [`Answers::along`] for those that are cut off.
    fn uncut_along(&self, path: &PathAt<'_>, mu: &mut [f64]) -> Result<Along, Undefined> {
        for (node, mu) in path.nodes.iter().zip(mu) {
            *mu = self.mu(&path.contact(node))?;
        }
        Ok(Along::default())
    }

    /// The coefficient at several points together; written by a [law](ToothFrictionLaw). An error has them evaluated one by one.
    ///
    /// # Errors
    /// As [`Mechanism::answer_together`].
    fn mu_together(&self, _at: &ContactAt<'_, Lane>) -> Result<Lane, Undefined> {
        Err(Undefined::DISAGREED)
    }

    /// The coefficient with its derivatives; written by a [law](ToothFrictionLaw). `None` has them found by differences.
    fn mu_with_derivatives(&self, _at: &ContactAt<'_, Dual>) -> Option<Result<Dual, Undefined>> {
        None
    }

    /// The same at all nodes of a path.
    ///
    /// # Errors
    /// As [`Mechanism::answer_together`].
    fn uncut_along_together(&self, _path: &PathAt<'_, Lane>, _mu: &mut [Lane]) -> Result<Along<Lane>, Undefined> {
        Err(Undefined::DISAGREED)
    }

    /// The same at all nodes of a path with derivatives.
    fn uncut_along_with_derivatives(
        &self,
        _path: &PathAt<'_, Dual>,
        _mu: &mut [Dual],
    ) -> Option<Result<Along<Dual>, Undefined>> {
        None
    }
}

/// A law of friction that is written once for one point and for several; mark its methods as `#[inline(always)]`, so that they use
/// wide instructions.
pub trait ToothFrictionLaw: Send + Sync {
    /// Coefficient of friction at one contact, before it is cut off at the [limits](Self::friction_limits). \[-\] Pure; must not allocate.
    ///
    /// A law that states limits returns the formula without them; cut off, it would have a kink that the framework does not expect.
    fn mu<R: Answers>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined>;

    /// As [`ToothFrictionModel::order`].
    fn order(&self) -> usize {
        SMOOTH
    }

    /// Limits at which the framework cuts off the law. A law that is cut off otherwise states its [kinks](Along::kink).
    fn friction_limits(&self) -> Option<FrictionLimits> {
        None
    }

    /// The coefficient cut off at the [limits](Self::friction_limits).
    #[inline(always)]
    fn cut_off<R: Real>(&self, mu: R) -> R {
        self.friction_limits().map_or(mu, |limits| limits.cut_off(mu))
    }

    /// As [`ToothFrictionModel::kinked_order`].
    fn kinked_order(&self) -> Option<usize> {
        None
    }

    /// As [`ToothFrictionModel::uncut_along`].
    #[inline(always)]
    fn along<R: Answers>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        for (node, mu) in path.nodes.iter().zip(mu) {
            *mu = self.mu(&path.contact(node))?;
            R::end_pass();
        }
        Ok(Along::default())
    }
}

/// Limits at which a law of friction is cut off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionLimits {
    /// Minimum coefficient.
    pub least: f64,
    /// Maximum coefficient.
    pub greatest: f64,
    /// True if the formula grows without bound where sliding vanishes, as a negative power or a logarithm of the sliding velocity.
    pub diverges: bool,
}

impl FrictionLimits {
    /// From zero to a maximum coefficient.
    pub fn up_to(greatest: f64) -> Self {
        Self {
            least: 0.0,
            greatest,
            diverges: false,
        }
    }

    /// The same for a formula that grows without bound where sliding vanishes.
    pub fn diverging(self) -> Self {
        Self { diverges: true, ..self }
    }

    /// A coefficient cut off at the limits.
    #[inline(always)]
    pub fn cut_off<R: Real>(&self, mu: R) -> R {
        mu.at_least(self.least).at_most(self.greatest)
    }
}

/// The range of a quantity over the nodes that carry load.
#[derive(Debug, Clone, Copy)]
pub struct Range<R> {
    least: R,
    greatest: R,
}

impl<R: Real> Default for Range<R> {
    /// No node.
    fn default() -> Self {
        Self {
            least: R::constant(f64::INFINITY),
            greatest: R::constant(f64::NEG_INFINITY),
        }
    }
}

impl<R: Real> Range<R> {
    /// Extends the range to the value at a node.
    #[inline(always)]
    pub fn extend(&mut self, node: &PathNode, value: R) {
        if node.share > 0.0 {
            self.least = self.least.min(value);
            self.greatest = self.greatest.max(value);
        }
    }

    /// The minimum and maximum.
    #[inline(always)]
    pub fn ends(&self) -> [R; 2] {
        [self.least, self.greatest]
    }

    /// Where the quantity reaches or passes one of its limits at some nodes, but not at all of them: it is cut off between nodes.
    #[inline(always)]
    pub fn is_cut_off(&self, [least, greatest]: [f64; 2]) -> R::Mask {
        let (least, greatest) = (R::constant(least), R::constant(greatest));
        let below = !self.least.is_above(least) & self.greatest.is_above(least);
        let above = !self.greatest.is_below(greatest) & self.least.is_below(greatest);
        below | above
    }
}

impl<L: ToothFrictionLaw> ToothFrictionModel for L {
    fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined> {
        ToothFrictionLaw::mu(self, at).map(|mu| self.cut_off(mu))
    }

    fn order(&self) -> usize {
        ToothFrictionLaw::order(self)
    }

    fn kinked_order(&self) -> Option<usize> {
        ToothFrictionLaw::kinked_order(self)
    }

    fn friction_limits(&self) -> Option<FrictionLimits> {
        ToothFrictionLaw::friction_limits(self)
    }

    fn uncut_along(&self, path: &PathAt<'_>, mu: &mut [f64]) -> Result<Along, Undefined> {
        Lane::wide(
            #[inline(always)]
            || ToothFrictionLaw::along(self, path, mu),
        )
    }

    fn mu_together(&self, at: &ContactAt<'_, Lane>) -> Result<Lane, Undefined> {
        Lane::wide(
            #[inline(always)]
            || ToothFrictionLaw::mu(self, at).map(|mu| self.cut_off(mu)),
        )
    }

    fn mu_with_derivatives(&self, at: &ContactAt<'_, Dual>) -> Option<Result<Dual, Undefined>> {
        Some(ToothFrictionLaw::mu(self, at).map(|mu| self.cut_off(mu)))
    }

    fn uncut_along_together(&self, path: &PathAt<'_, Lane>, mu: &mut [Lane]) -> Result<Along<Lane>, Undefined> {
        Lane::wide(
            #[inline(always)]
            || ToothFrictionLaw::along(self, path, mu),
        )
    }

    fn uncut_along_with_derivatives(
        &self,
        path: &PathAt<'_, Dual>,
        mu: &mut [Dual],
    ) -> Option<Result<Along<Dual>, Undefined>> {
        Some(ToothFrictionLaw::along(self, path, mu))
    }
}

/// Nodes on each section of a path for a smooth law.
pub const SMOOTH: usize = 7;

/// Nodes on each section of a path for a law with a kink at a point that depends on load, speed and oil.
pub const KINKED: usize = 64;

/// Results of a law for a whole path in addition to its coefficients.
#[derive(Debug, Clone, Copy)]
pub struct Along<R: Real = f64> {
    /// Share of the friction heat that enters the body of the first gear. \[-\]
    pub first_heat: R,
    /// Where the law has a kink within the path, so that it needs [more nodes](ToothFrictionModel::kinked_order).
    pub kink: R::Mask,
}

impl<R: Real> Default for Along<R> {
    /// Half of the heat for each body, and no kink.
    fn default() -> Self {
        Self {
            first_heat: R::HALF,
            kink: R::Mask::NEVER,
        }
    }
}

context! {
    /// All inputs of a friction law in one contact.
    pub struct ContactAt of ToothFriction {
        /// Magnitude of the sliding velocity. [m/s]
        sliding: 1.0 in 0.0..=30.0 from "speed of the mesh and the position on the path",
        /// Sum of the surface speeds. [m/s]
        sum_speed: 10.0 in 0.0..=200.0 from "speed of the mesh and the position on the path",
        /// Radius of relative curvature. [mm]
        radius: 8.0 in 0.1..=500.0 from "the position on the path",
        /// Line load. [N/mm]
        line_load: 200.0 in 0.0..=3000.0 from "torque of the mesh and the load share at this point",
        /// Hertz pressure. [GPa]
        pressure: 0.948 in 0.0..=4.0 from "`line_load`, `radius` and `modulus`",
        /// Reduced modulus E/(1 - nu^2) of equal materials. [GPa]
        modulus: 226.0 in 1.0..=500.0 from "the material of the gears",
        /// Length of the line of contact. [mm]
        length: 20.0 in 0.1..=2000.0 from "face width and base helix",
        /// Arithmetic mean roughness, mean of both flanks. [um]
        ra: 0.4 in 0.01..=5.0 from "`surface.ra` of both gears",
        /// Root mean square roughness of both flanks together. [um]
        rq: 0.5 in 0.01..=5.0 from "`surface.rq` of both gears",
        ..oil of contacts from "the oil that enters the contact",
    } laws {
        "pressure = sqrt(line_load modulus/(2 pi radius))" {
            pressure: |at| hertz(at.line_load, at.modulus, at.radius),
            line_load: |at| load_at(at.pressure, at.modulus, at.radius),
            radius: |at| radius_at(at.pressure, at.modulus, at.line_load),
            modulus: |at| modulus_at(at.pressure, at.line_load, at.radius),
        }
        "sliding is at most sum_speed" {
            sliding: |at| at.sliding.min(at.sum_speed),
            sum_speed: |at| at.sum_speed.max(at.sliding),
        }
    }
}

impl<R: Real> ContactAt<'_, R> {
    /// Slide-to-roll ratio: sliding velocity over mean rolling velocity; zero at standstill. \[-\]
    #[inline(always)]
    pub fn slide_roll(&self) -> R {
        let moves = self.sum_speed.is_above(R::ZERO);
        R::select(moves, self.sliding * 2.0 / self.sum_speed, R::ZERO)
    }
}

/// One point on the path of contact, for a speed of one radian per second of the first gear. Prepared once per mesh. Logarithms are
/// stored because laws that are products of powers need them at every point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathNode {
    /// Sliding velocity per speed of the first gear. \[m\]
    pub sliding: f64,
    /// Sum of the surface speeds per speed of the first gear. \[m\]
    pub sum_speed: f64,
    /// Radius of relative curvature in the normal plane. \[m\]
    pub radius: f64,
    /// Share of the mesh's normal force that the pair of teeth carries, and of the line load under the full force.
    pub share: f64,
    /// Length of path that the node represents, over the base pitch; the weights of a path sum to its contact ratio.
    pub weight: f64,
    /// True if the flank of the first gear is the faster one.
    pub first_faster: bool,
    /// Slide-to-roll ratio.
    pub slide_roll: f64,
    /// Natural logarithm of `slide_roll`; minus infinity at the pitch point.
    pub ln_slide_roll: f64,
    /// Natural logarithm of half of `sum_speed`.
    pub ln_rolling: f64,
    /// Natural logarithm of `radius`.
    pub ln_radius: f64,
    /// Root of `share` over `radius`: Hertz pressure per root of reference line load and reduced modulus over 2 pi.
    pub root_load: f64,
    /// Natural logarithm of `root_load`.
    pub ln_root_load: f64,
    /// Film thickness by each formula, with one for every quantity that does not belong to the node. \[m\]
    pub films: [f64; 2],
    /// Terms of pressure and of sliding in the heating at the inlet, with one for every quantity that does not belong to the node.
    pub heating: [f64; 2],
}

impl PathNode {
    /// A node from sliding and sum velocity per speed of the first gear, radius and share; SI. Its weight is one base pitch, and its
    /// first flank is the faster one.
    pub fn new(sliding: f64, sum_speed: f64, radius: f64, share: f64) -> Self {
        let slide_roll = 2.0 * sliding / sum_speed;
        let root_load = (share / radius).sqrt();
        let rolling = 0.5 * sum_speed;
        Self {
            sliding,
            sum_speed,
            radius,
            share,
            weight: 1.0,
            first_faster: true,
            slide_roll,
            ln_slide_roll: slide_roll.ln(),
            ln_rolling: rolling.ln(),
            ln_radius: radius.ln(),
            root_load,
            ln_root_load: root_load.ln(),
            films: Film::at_node(rolling, radius, share),
            heating: thermal_terms(root_load, slide_roll, rolling * rolling),
        }
    }
}

/// Minimum and maximum values along a path, for notes that need no evaluation of its nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathExtent {
    /// Sliding velocity per speed of the first gear. \[m\]
    pub sliding: [f64; 2],
    /// Slide-to-roll ratio.
    pub slide_roll: [f64; 2],
    /// Sum of the surface speeds per speed of the first gear. \[m\]
    pub sum_speed: [f64; 2],
    /// Radius of relative curvature. \[m\]
    pub radius: [f64; 2],
    /// Root of share over radius.
    pub root_load: [f64; 2],
}

impl PathExtent {
    /// The extent of a path.
    pub fn from_nodes(nodes: &[PathNode]) -> Self {
        let range = |value: fn(&PathNode) -> f64| {
            let values = nodes.iter().map(value);
            [
                values.clone().fold(f64::INFINITY, f64::min),
                values.fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        Self {
            sliding: range(|n| n.sliding),
            slide_roll: range(|n| n.slide_roll),
            sum_speed: range(|n| n.sum_speed),
            radius: range(|n| n.radius),
            root_load: range(|n| n.root_load),
        }
    }
}

/// The whole path of contact at one operating point. SI.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct PathAt<'a, R: Real = f64> {
    /// The points on the path.
    pub nodes: &'a [PathNode],
    /// Their extent.
    pub extent: &'a PathExtent,
    /// Magnitude of the speed of the first gear in the carrier's frame, positive. \[rad/s\]
    pub speed: R,
    /// Line load of one pair of teeth under the full force, F_bt/b, positive. \[N/m\]
    pub line_load: R,
    /// Reduced modulus E/(1 - nu^2) of equal materials. \[Pa\]
    pub modulus: f64,
    /// Length of the line of contact of one pair. \[m\]
    pub length: f64,
    /// Arithmetic mean roughness, mean of both flanks. \[m\]
    pub ra: R,
    /// Root mean square roughness of both flanks together. \[m\]
    pub rq: R,
    /// Temperature of the oil. \[degC\]
    pub temperature: R,
    /// Kinematic viscosity. \[m2/s\]
    pub nu: R,
    /// Dynamic viscosity. \[Pa s\]
    pub eta: R,
    /// Density. \[kg/m3\]
    pub rho: R,
    /// Pressure-viscosity coefficient. \[1/Pa\]
    pub alpha: R,
    /// Relative decrease of the viscosity with temperature. \[1/K\]
    pub beta: R,
    /// Thermal conductivity. \[W/(m K)\]
    pub conductivity: R,
    /// Lubricant factor of mean mesh friction.
    pub x_l: R,
    /// Body temperatures of both gears, if a thermal network provides them. \[degC\]
    pub bodies: Option<[R; 2]>,
    /// The inputs of a mean friction law for this mesh.
    pub mean: &'a MeanFrictionAt<'a, R>,
    /// Target of limits, observed quantities and steps.
    pub notes: Notes<'a, R>,
}

impl<'a, R: Real> PathAt<'a, R> {
    /// The path of a mesh: its points and their extent.
    #[inline(always)]
    pub fn new(
        nodes: &'a [PathNode],
        extent: &'a PathExtent,
        mean: &'a MeanFrictionAt<'a, R>,
        notes: Notes<'a, R>,
    ) -> Self {
        with_oil!(of contacts from mean, PathAt {
            nodes,
            extent,
            speed: mean.speed,
            line_load: mean.part.pair.line_load(mean.normal_force),
            modulus: mean.part.modulus,
            length: mean.part.pair.line_length(),
            ra: mean.ra,
            rq: mean.rq,
            bodies: None,
            mean,
            notes,
        })
    }

    /// The same with some quantities changed.
    #[inline(always)]
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    /// The same for the law of a nested slot, which has its own notes.
    #[inline]
    pub fn nested(&self, slot: &Slot<ToothFriction>) -> Self {
        self.with(|to| to.notes = self.notes.nested(slot.notes))
    }

    /// Hertz pressure of a node with `root_load` one. \[Pa m^0.5\]
    #[inline(always)]
    pub fn unit_pressure(&self) -> R {
        (self.line_load * self.modulus / (2.0 * std::f64::consts::PI)).sqrt()
    }

    /// Moves a contact of the path to another point, where the unit pressure is known.
    #[inline(always)]
    fn move_to(&self, at: &mut ContactAt<'_, R>, node: &PathNode, unit_pressure: R) {
        at.sliding = self.speed * node.sliding;
        at.sum_speed = self.speed * node.sum_speed;
        at.radius = R::constant(node.radius);
        at.line_load = self.line_load * node.share;
        at.pressure = unit_pressure * node.root_load;
    }

    /// One point of the path as a contact.
    #[inline(always)]
    pub fn contact(&self, node: &PathNode) -> ContactAt<'a, R> {
        let mut at = with_oil!(of contacts from self, ContactAt {
            part: &NoPart {},
            sliding: R::ZERO,
            sum_speed: R::ZERO,
            radius: R::ZERO,
            line_load: R::ZERO,
            pressure: R::ZERO,
            modulus: R::constant(self.modulus),
            length: R::constant(self.length),
            ra: self.ra,
            rq: self.rq,
            // Each point has its own velocities.
            notes: self.notes.forgetting(),
        });
        self.move_to(&mut at, node, self.unit_pressure());
        at
    }
}

impl<R: Real> PathAt<'_, R> {
    /// Runs a function with a path at one point, whose quantities follow from these.
    pub(crate) fn map<T>(
        &self,
        [mean, notes]: [Notes<'_>; 2],
        number: impl Fn(R) -> f64,
        run: impl FnOnce(&PathAt<'_>) -> T,
    ) -> T {
        let mean = self.mean.map(mean, &number);
        run(&PathAt {
            nodes: self.nodes,
            extent: self.extent,
            speed: number(self.speed),
            line_load: number(self.line_load),
            modulus: self.modulus,
            length: self.length,
            ra: number(self.ra),
            rq: number(self.rq),
            temperature: number(self.temperature),
            nu: number(self.nu),
            eta: number(self.eta),
            rho: number(self.rho),
            alpha: number(self.alpha),
            beta: number(self.beta),
            conductivity: number(self.conductivity),
            x_l: number(self.x_l),
            bodies: self.bodies.map(|bodies| bodies.map(&number)),
            mean: &mean,
            notes,
        })
    }
}

impl<R: Points> PathAt<'_, R> {
    /// Runs a function with the path at one of the points.
    pub fn at_point<T>(&self, point: usize, run: impl FnOnce(&PathAt<'_>) -> T) -> T {
        let notes = [self.mean.notes, self.notes].map(|notes| notes.at_point(point));
        self.map(notes, |x| x.at_point(point), run)
    }
}

impl Mechanism for ToothFriction {
    const KEY: &'static str = "tooth_friction";
    const MEANING: &'static str = "Coefficient of friction between flanks along the path of contact.";
    const ANSWER: &'static str = "Coefficient of friction. [-]";
    const EXAMPLE: &'static str = "{}";
    type Part = NoPart;
    type At<'a, R: Real> = ContactAt<'a, R>;
    type Answer = f64;
    type Model = dyn ToothFrictionModel;

    answered_by!(mu, mu_together, mu_with_derivatives);
}

impl ToothFrictionModel for Scalar<ToothFriction> {
    fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined> {
        self.value(at)
    }

    /// A formula may be steep, if it has no kinks.
    fn order(&self) -> usize {
        match (self.is_constant(), self.is_smooth()) {
            (true, _) => SMOOTH,
            (false, true) => 2 * SMOOTH,
            (false, false) => KINKED,
        }
    }

    fn mu_together(&self, at: &ContactAt<'_, Lane>) -> Result<Lane, Undefined> {
        self.values(at)
    }

    fn mu_with_derivatives(&self, _at: &ContactAt<'_, Dual>) -> Option<Result<Dual, Undefined>> {
        self.constant().map(|value| Ok(Dual::constant(value)))
    }

    fn uncut_along_with_derivatives(
        &self,
        _path: &PathAt<'_, Dual>,
        mu: &mut [Dual],
    ) -> Option<Result<Along<Dual>, Undefined>> {
        mu.fill(Dual::constant(self.constant()?));
        Some(Ok(Along::default()))
    }

    fn uncut_along_together(&self, path: &PathAt<'_, Lane>, mu: &mut [Lane]) -> Result<Along<Lane>, Undefined> {
        if let Some(value) = self.constant() {
            mu.fill(Lane::constant(value));
            return Ok(Along::default());
        }
        Lane::wide(
            #[inline(always)]
            || {
                let Some(first) = path.nodes.first() else {
                    return Ok(Along::default());
                };
                let mut at = path.contact(first);
                let unit_pressure = path.unit_pressure();
                for (node, mu) in path.nodes.iter().zip(mu) {
                    path.move_to(&mut at, node, unit_pressure);
                    *mu = self.inlined_values(&at)?;
                    Lane::end_pass();
                }
                Ok(Along::default())
            },
        )
    }
}

crate::register_mechanism!(ToothFriction);
