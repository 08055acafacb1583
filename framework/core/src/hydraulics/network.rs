//! The elements of an oil network and how they are joined.

use super::pocket::Chamber;
use super::{Channel, GRAVITY, Orifice, Pocket};
use crate::attach::{Incline, Oil};
use crate::real::{Mask as _, Points, Real};

/// Where an element begins or ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// A junction, by number.
    Node(usize),
    /// The oil of the sump, below its surface, at the pressure of the air.
    Sump,
    /// The air of the housing: a free jet or a chamber.
    Open,
}

/// How high a part of the network is in the housing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Height above the datum of the oil level, as built. \[m\]
    pub height: f64,
    /// The place from the datum, if it is known; otherwise the height is that at any inclination. \[m\]
    pub at: Option<[f64; 3]>,
}

impl Place {
    /// Its height above the datum at an inclination. \[m\]
    pub(crate) fn height<R: Points>(&self, incline: Option<Incline<'_, R>>) -> R {
        match (self.at, incline) {
            (Some(at), Some(incline)) => R::each(|point| match incline.up(point) {
                Some(up) => up[0] * at[0] + up[1] * at[1] + up[2] * at[2],
                None => self.height,
            }),
            _ => R::constant(self.height),
        }
    }
}

/// A relief valve at the delivery of a pump, which returns oil to the sump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relief {
    /// Pressure at which it opens. \[Pa\]
    pub opens: f64,
    /// Flow per pressure above that. \[m3/(s Pa)\]
    pub conductance: f64,
}

/// What drives a pump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Driver {
    /// A member of the transmission, by number.
    Member(usize),
    /// A separate motor with this speed. \[rad/s\]
    Motor(f64),
}

/// The law of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// A displacement pump.
    Pump {
        /// What drives it.
        driver: Driver,
        /// Displacement per radian. \[m3\]
        displacement: f64,
        /// Coefficient of leakage (Wilson). \[-\]
        leakage: f64,
        /// Flow above which a regulator leads the surplus back to the inlet. \[m3/s\]
        regulated: Option<f64>,
        /// Relief valve.
        relief: Option<Relief>,
    },
    /// A pipe, bore or duct.
    Pipe(Channel),
    /// An orifice or nozzle.
    Orifice(Orifice),
    /// A channel in a rotating part.
    Rotating {
        /// Each of the channels.
        channel: Channel,
        /// Their number.
        count: f64,
        /// Rotating member.
        member: usize,
        /// Radii of inlet and outlet. \[m\]
        radii: [f64; 2],
        /// Share of the swirl of the shaft that the oil has at the inlet. \[-\]
        swirl: f64,
    },
}

/// One element of a network.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    /// Path in the description.
    pub path: String,
    /// Where it begins and ends.
    pub ends: [End; 2],
    /// Its law.
    pub law: Law,
    /// Number of its oil.
    pub oil: u16,
    /// Paths of the components that it supplies with equal shares.
    pub feeds: Vec<String>,
    /// Chamber into which it ends, by number.
    pub chamber: Option<usize>,
    /// Its mouth in the sump.
    pub inlet: Option<Place>,
}

/// Oil with its share of free air.
#[derive(Debug, Clone, Copy)]
pub struct Fluid<R = f64> {
    /// Kinematic viscosity. \[m2/s\]
    pub nu: R,
    /// Dynamic viscosity. \[Pa s\]
    pub eta: R,
    /// Density. \[kg/m3\]
    pub rho: R,
}

/// What flows through an element.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Supply<R = f64> {
    /// Flow of oil, without its free air, from begin to end. \[m3/s\]
    pub flow: R,
    /// Pressure at the end minus pressure at the beginning. \[Pa\]
    pub rise: R,
    /// Flow of oil through the relief valve of a pump. \[m3/s\]
    pub relieved: R,
    /// Torque that the oil takes from the shaft, or motor, without friction. \[Nm\]
    pub torque: R,
    /// Displacement of a pump per turn. \[m3\]
    pub displacement: R,
}

/// What the network supplies at a point, as models see it.
#[derive(Debug, Clone, Copy)]
pub struct Supplies<'a, R = f64> {
    /// Of each element.
    pub elements: &'a [Supply<R>],
    /// Oil height above the lowest point of the raceway in each pocket. \[m\]
    pub pockets: &'a [R],
}

/// The network of oil flows, with the chambers and pockets that it fills.
#[derive(Debug, Clone, Default)]
pub struct Hydraulics {
    /// Names of the junctions.
    pub junctions: Vec<String>,
    /// Place of each junction; at the surface of the sump without.
    pub heights: Vec<Option<Place>>,
    /// Elements.
    pub elements: Vec<Element>,
    /// Volume share of free air.
    pub air: f64,
    /// The upward direction of the housing as built; zeros if there are no chambers.
    pub up: [f64; 3],
    /// Chambers, each before those into which it drains.
    pub chambers: Vec<Chamber>,
    /// Pockets of bearings.
    pub pockets: Vec<Pocket>,
}

/// Flow of an element and its slope over the pressure difference that drives it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flow<R> {
    pub flow: R,
    pub slope: R,
}

/// What elements read at a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inputs<'a, R> {
    pub speeds: &'a [R],
    pub oils: &'a [Oil<R>],
    /// Surface of the sump above the datum. \[m\]
    pub surface: R,
    /// Inclination of the housing, if a point has any.
    pub incline: Option<Incline<'a, R>>,
}

impl<R> Fluid<R> {
    /// The same in other numbers.
    pub fn map<T>(self, of: impl Fn(R) -> T) -> Fluid<T> {
        Fluid {
            nu: of(self.nu),
            eta: of(self.eta),
            rho: of(self.rho),
        }
    }
}

impl Hydraulics {
    /// The fluid in an element.
    pub(super) fn fluid<R: Real>(&self, element: &Element, at: &Inputs<'_, R>) -> Fluid<R> {
        self.aerated(&at.oils[element.oil as usize])
    }

    /// An oil with the free air of the network: lower density, and the viscosity of a suspension of bubbles.
    pub fn aerated<R: Real>(&self, oil: &Oil<R>) -> Fluid<R> {
        let rho = oil.rho * (1.0 - self.air);
        let eta = oil.eta * (1.0 + 1.5 * self.air);
        Fluid {
            nu: eta / rho,
            eta,
            rho,
        }
    }

    /// Pressure that heights and rotation add from the beginning to the end of an element. \[Pa\]
    pub(super) fn gain<R: Points>(&self, element: &Element, fluid: &Fluid<R>, at: &Inputs<'_, R>) -> R {
        let mut gain = R::ZERO;
        if self.heights.iter().any(Option::is_some) {
            let height = |end: End| match end {
                End::Node(node) => Some(self.heights[node].map_or(at.surface, |place| place.height(at.incline))),
                End::Sump => Some(at.surface),
                End::Open => None,
            };
            if let [Some(from), Some(to)] = element.ends.map(height) {
                gain = fluid.rho * (from - to) * GRAVITY;
            }
        }
        if let Law::Rotating {
            member,
            radii: [inner, outer],
            ..
        } = element.law
        {
            let speed = at.speeds[member];
            gain += fluid.rho * speed * speed * (0.5 * (outer * outer - inner * inner));
        }
        gain
    }

    /// Flow of an element, with air, for the pressure at its beginning minus that at its end and its gain. \[Pa and m3/s\]
    pub(super) fn flow<R: Real>(element: &Element, driving: R, fluid: &Fluid<R>, at: &Inputs<'_, R>) -> Flow<R> {
        let (flow, slope) = match &element.law {
            Law::Pipe(channel) => channel.flow(driving, fluid.nu, fluid.rho),
            Law::Orifice(orifice) => orifice.flow(driving, fluid.eta, fluid.rho),
            Law::Rotating { channel, count, .. } => {
                let (flow, slope) = channel.flow(driving, fluid.nu, fluid.rho);
                (flow * *count, slope * *count)
            }
            Law::Pump {
                driver,
                displacement,
                leakage,
                regulated,
                ..
            } => {
                let speed = match driver {
                    Driver::Member(member) => at.speeds[*member].abs(),
                    Driver::Motor(speed) => R::constant(*speed),
                };
                let slip = R::constant(leakage * displacement) / fluid.eta;
                let delivered = speed * *displacement + slip * driving;
                match regulated {
                    Some(set) => {
                        let set = R::constant(*set);
                        let is_free = delivered.is_below(set);
                        (R::select(is_free, delivered, set), R::select(is_free, slip, R::ZERO))
                    }
                    None => (delivered, slip),
                }
            }
        };
        Flow { flow, slope }
    }

    /// Flow through the relief valve of an element at the pressure of its end. \[Pa and m3/s\]
    pub(super) fn relieved<R: Real>(element: &Element, pressure: R) -> Option<Flow<R>> {
        let Law::Pump {
            relief: Some(relief), ..
        } = &element.law
        else {
            return None;
        };
        let over = pressure - relief.opens;
        let open = over.is_above(R::ZERO);
        Some(Flow {
            flow: R::select(open, over * relief.conductance, R::ZERO),
            slope: R::select(open, R::constant(relief.conductance), R::ZERO),
        })
    }

    /// Torque that the oil takes from the shaft, and displacement per turn: that of a pump is displacement times pressure rise, whatever
    /// leaks or returns; that of rotating channels the change of the angular momentum of the oil. \[m3/s, Pa, Nm and m3\]
    pub(super) fn torque<R: Real>(element: &Element, flow: R, rise: R, at: &Inputs<'_, R>) -> [R; 2] {
        match &element.law {
            Law::Pump { displacement, .. } => {
                let turn = 2.0 * std::f64::consts::PI;
                [rise * *displacement, R::constant(displacement * turn)]
            }
            Law::Rotating {
                member,
                radii: [inner, outer],
                swirl,
                ..
            } => {
                let rho = at.oils[element.oil as usize].rho;
                let arm = outer * outer - swirl * inner * inner;
                [rho * flow * at.speeds[*member].abs() * arm, R::ZERO]
            }
            Law::Pipe(_) | Law::Orifice(_) => [R::ZERO; 2],
        }
    }

    /// True if elements or pockets are described.
    pub fn is_described(&self) -> bool {
        !self.elements.is_empty() || !self.pockets.is_empty()
    }

    /// Number of an element by its path.
    pub fn element(&self, path: &str) -> Option<usize> {
        self.elements.iter().position(|element| element.path == path)
    }

    /// Numbers of the elements that supply a component, with the number of components that share each.
    pub fn feeding<'s>(&'s self, component: &'s str) -> impl Iterator<Item = (usize, f64)> + 's {
        let elements = self.elements.iter().enumerate();
        elements
            .filter(move |(_, element)| element.feeds.iter().any(|fed| fed == component))
            .map(|(i, element)| (i, element.feeds.len() as f64))
    }
}

impl Element {
    /// Speed of the shaft or motor that drives it; `None` for elements that do not rotate. \[rad/s\]
    pub(crate) fn driver_speed(&self, speeds: &[f64]) -> Option<f64> {
        match self.law {
            Law::Pump {
                driver: Driver::Member(member),
                ..
            }
            | Law::Rotating { member, .. } => Some(speeds[member]),
            Law::Pump {
                driver: Driver::Motor(speed),
                ..
            } => Some(speed),
            Law::Pipe(_) | Law::Orifice(_) => None,
        }
    }
}

impl<R: Real> Supply<R> {
    /// Where a condition does not hold, a supply without a value.
    pub(super) fn valid(self, holds: R::Mask) -> Self {
        let valid = |x: R| R::select(holds, x, R::constant(f64::NAN));
        if holds.all() {
            return self;
        }
        Self {
            flow: valid(self.flow),
            rise: valid(self.rise),
            relieved: valid(self.relieved),
            torque: valid(self.torque),
            displacement: self.displacement,
        }
    }
}
