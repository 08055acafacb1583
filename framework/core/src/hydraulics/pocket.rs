//! Pockets at bearings and chambers: how high the oil stands that flows in and out.

use super::edge::segment;
use super::network::{Fluid, Hydraulics, Inputs};
use super::solve::Work;
use super::{Edge, GRAVITY, Orifice, Window};
use crate::real::{Mask as _, Points, Real};

/// Least rise of the upward direction over a floor: steeper floors hold no known volume.
const LEAST_RISE: f64 = 0.1;

/// Maximum number of steps to the height of the oil in a pocket.
const MOST_STEPS: usize = 200;

/// A space that oil leaves through holes at its bottom, into another chamber or the sump.
#[derive(Debug, Clone, PartialEq)]
pub struct Chamber {
    /// Name.
    pub name: String,
    /// Its holes.
    pub drain: Orifice,
    /// Area of its floor; its walls are perpendicular to it. \[m2\]
    pub floor: f64,
    /// Place of its holes from the middle of the floor, along x and y. \[m\]
    pub holes: [f64; 2],
    /// Height of its walls over the holes. \[m\]
    pub height: Option<f64>,
    /// Number of its oil.
    pub oil: u16,
    /// Chamber into which it drains, by number; the sump without.
    pub into: Option<usize>,
}

/// The pocket of a bearing, between it and its cover or seal.
#[derive(Debug, Clone, PartialEq)]
pub struct Pocket {
    /// Path of the bearing.
    pub path: String,
    /// Lowest edge over which oil escapes.
    pub edge: Edge,
    /// Height of the edge over the lowest point of the raceway. \[m\]
    pub edge_height: f64,
    /// Hole at the lowest point of the raceway.
    pub drain: Option<Orifice>,
    /// Elements that supply it, with the number of components that share each.
    pub feeds: Vec<(usize, f64)>,
    /// Flow from elsewhere, such as oil that a rib catches from the wall. \[m3/s\]
    pub inflow: f64,
    /// Rib that catches a part of what gears lift, as estimated.
    pub rib: Option<Rib>,
    /// Window through which a gear throws oil.
    pub window: Option<Window>,
    /// The space in which its oil stands; not known without.
    pub room: Option<Room>,
    /// Number of its oil.
    pub oil: u16,
    /// True if its oil is that of the sump, so that it is missing there.
    pub of_sump: bool,
}

/// The space of a pocket between a bearing and its cover or seal: a ring around the shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Room {
    /// Length along the shaft. \[m\]
    pub length: f64,
    /// Radii of the lowest point of the raceway and of the shaft. \[m\]
    pub radii: [f64; 2],
}

impl Room {
    /// Oil in it up to a height over the lowest point of the raceway. \[m and m3\]
    pub fn volume<R: Real>(&self, height: R) -> R {
        let [outer, inner] = self.radii;
        height.lift(|h| self.length * (segment(outer, h) - segment(inner, h - (outer - inner))))
    }
}

impl Chamber {
    /// Oil in it for a flow (m3/s) that stands at a height over its holes (m), with the upward direction of the housing. With vertical walls it
    /// is the depth over the middle of the floor times its area; exact while oil covers the whole floor. \[m3\]
    fn volume<R: Real>(&self, flow: R, head: R, [x, y, z]: [R; 3]) -> R {
        let depth = (head + x * self.holes[0] + y * self.holes[1]) / z.at_least(LEAST_RISE);
        R::select(flow.is_zero(), R::ZERO, depth.at_least(0.0) * self.floor)
    }
}

/// A rib on a wall down which oil runs that gears have thrown there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rib {
    /// Its length along the wall. \[m\]
    pub width: f64,
    /// Horizontal length of all wetted walls; that of the oil space without. \[m\]
    pub walls: Option<f64>,
    /// Height of wetted wall above the rib over that of all wetted wall.
    pub above: f64,
}

impl Rib {
    /// Its length over that of the walls (m), at most 1.
    fn part<R: Real>(&self, walls: R) -> R {
        (R::constant(self.width) / self.walls.map_or(walls, R::constant)).at_most(1.0)
    }

    /// Part of the oil on the walls, of this horizontal length (m), that it catches.
    pub fn share<R: Real>(&self, walls: R) -> R {
        self.part(walls) * self.above
    }

    /// Share of the film on the walls that is missing below it, where the film begins anew: films grow with the cube root of the distance.
    pub fn bare<R: Real>(&self, walls: R) -> R {
        let film = |part: f64| part * part.cbrt();
        self.part(walls) * (1.0 - film(self.above) - film(1.0 - self.above))
    }
}

impl Pocket {
    /// Oil that flows into it but for what gears lift. \[m3/s\]
    pub(crate) fn fed<R: Points>(&self, work: &Work<R>) -> R {
        let fed = self.feeds.iter();
        let fed = fed.map(|(element, shared)| work.supplies[*element].flow / *shared);
        fed.fold(R::constant(self.inflow), |sum, flow| sum + flow.max(R::ZERO))
    }

    /// Oil that flows into it, by its number. \[m3/s\]
    pub(crate) fn inflow<R: Points>(&self, number: usize, work: &Work<R>) -> R {
        let fed = self.fed(work);
        let fed = match self.rib {
            Some(rib) => fed + work.wetting * rib.share(work.walls),
            None => fed,
        };
        match self.window {
            Some(_) => fed + work.thrown[number],
            None => fed,
        }
    }

    /// Oil height over the lowest point of the raceway for a flow into the pocket. \[m3/s and m\]
    pub fn height<R: Real>(&self, inflow: R, fluid: &Fluid<R>) -> R {
        let weight = fluid.rho * GRAVITY;
        let (full, at_edge) = match &self.drain {
            // What the hole takes below the edge.
            Some(drain) => (
                drain.pressure(inflow, fluid.eta, fluid.rho) / weight,
                drain.flow(weight * self.edge_height, fluid.eta, fluid.rho).0,
            ),
            None => (R::constant(self.edge_height), R::ZERO),
        };
        let wet = inflow.is_above(R::ZERO);
        let over = wet & inflow.is_above(at_edge);
        let below = R::select(wet, full, R::ZERO);
        if !over.any() {
            return below;
        }
        R::select(over, self.over_edge(inflow, fluid), below)
    }

    /// The same while oil flows over the edge.
    fn over_edge<R: Real>(&self, inflow: R, fluid: &Fluid<R>) -> R {
        let weight = fluid.rho * GRAVITY;
        // Flow out and height at the unknown of the edge, with their slopes.
        let out = |root: R| {
            let over = self.edge.over(root, fluid.nu);
            let height = over.height + self.edge_height;
            let (hole, slope) = self.drain.map_or((R::ZERO, R::ZERO), |drain| {
                let (flow, slope) = drain.flow(weight * height, fluid.eta, fluid.rho);
                (flow, slope * weight)
            });
            (
                over.flow + hole,
                over.flow_slope + slope * over.height_slope,
                height,
                over.height_slope,
            )
        };
        let (mut low, mut high) = (R::ZERO, R::constant(self.edge.bound().unwrap_or(1.0)));
        let mut at = high * 0.25;
        let mut open = inflow.is_above(R::ZERO);
        for _ in 0..MOST_STEPS {
            let (flow, slope, ..) = out(at);
            let is_above = flow.is_above(inflow);
            high = R::select(is_above, at, high);
            low = R::select(is_above, low, at);
            let newton = at - (flow - inflow) / slope;
            let inside = newton.is_above(low) & newton.is_below(high);
            let next = R::select(inside, newton, (low + high) * 0.5);
            let close = !(next - at).abs().is_above(at * 1e-14);
            at = R::select(open, next, at);
            open = open & !close;
            if !open.any() {
                break;
            }
        }
        // One more step over numbers with derivatives.
        let (flow, slope, height, height_slope) = out(at);
        height - (flow - inflow) / slope * height_slope
    }
}

impl Hydraulics {
    /// True if a rib or a window catches what gears lift.
    pub(crate) fn catches(&self) -> bool {
        let mut pockets = self.pockets.iter();
        pockets.any(|pocket| pocket.rib.is_some() || pocket.window.is_some())
    }

    /// Fills the pockets with what gears throw on walls of a horizontal length, and with what each window takes. \[m3/s, m, m3/s\]
    pub(crate) fn catch<R: Points>(
        &self,
        (wetting, walls): (R, R),
        thrown: impl Fn(&Window) -> R,
        at: &Inputs<'_, R>,
        work: &mut Work<R>,
    ) {
        (work.wetting, work.walls) = (wetting, walls);
        for (own, pocket) in work.thrown.iter_mut().zip(&self.pockets) {
            *own = pocket.window.as_ref().map_or(R::ZERO, &thrown);
        }
        self.fill_pockets(at, work);
    }

    /// Oil of the sump that stands in chambers. \[m3\]
    pub(crate) fn held<R: Points>(&self, work: &Work<R>, at: &Inputs<'_, R>) -> R {
        let mut held = R::ZERO;
        for (number, chamber) in self.chambers.iter().enumerate() {
            let flow = self.through(number, work);
            let fluid = self.aerated(&at.oils[chamber.oil as usize]);
            let head = chamber.drain.pressure(flow, fluid.eta, fluid.rho) / (fluid.rho * GRAVITY);
            held += chamber.volume(flow, head, self.up(at));
        }
        held
    }

    /// The upward direction in the housing.
    fn up<R: Points>(&self, at: &Inputs<'_, R>) -> [R; 3] {
        R::each_of(|point| at.incline.and_then(|incline| incline.up(point)).unwrap_or(self.up))
    }

    /// Flow through a chamber: into it, and into those that drain into it. \[m3/s\]
    fn through<R: Points>(&self, chamber: usize, work: &Work<R>) -> R {
        let own = self.elements.iter().zip(&work.supplies);
        let own = own.filter(|(element, _)| element.chamber == Some(chamber));
        let own = own.fold(R::ZERO, |sum, (_, supply)| sum + supply.flow.max(R::ZERO));
        // Chambers precede those into which they drain.
        let from = (0..chamber).filter(|other| self.chambers[*other].into == Some(chamber));
        from.fold(own, |sum, other| sum + self.through(other, work))
    }

    /// The oil height in all pockets.
    pub(super) fn fill_pockets<R: Points>(&self, at: &Inputs<'_, R>, work: &mut Work<R>) {
        for (i, pocket) in self.pockets.iter().enumerate() {
            let fluid = self.aerated(&at.oils[pocket.oil as usize]);
            work.pockets[i] = pocket.height(pocket.inflow(i, work), &fluid);
        }
    }

    /// Oil height over the holes of each chamber, the flow through it, and the oil in it. \[m, m3/s and m3\]
    pub(crate) fn chambers(&self, work: &Work<f64>, at: &Inputs<'_, f64>) -> Vec<[f64; 3]> {
        let mut flows = vec![0.0; self.chambers.len()];
        for (element, supply) in self.elements.iter().zip(&work.supplies) {
            if let Some(chamber) = element.chamber {
                flows[chamber] += supply.flow.max(0.0);
            }
        }
        let mut levels = Vec::with_capacity(flows.len());
        for (i, chamber) in self.chambers.iter().enumerate() {
            let flow = flows[i];
            if let Some(into) = chamber.into {
                flows[into] += flow;
            }
            let fluid = self.aerated(&at.oils[chamber.oil as usize]);
            let head = chamber.drain.pressure(flow, fluid.eta, fluid.rho) / (fluid.rho * GRAVITY);
            levels.push([head, flow, chamber.volume(flow, head, self.up(at))]);
        }
        levels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydraulics::tests::{L_MIN, close};

    #[test]
    fn a_pocket_with_a_drain_and_a_circular_edge() {
        let pocket = Pocket {
            path: String::new(),
            edge: Edge::Circle { radius: 20e-3 },
            edge_height: 8e-3,
            drain: Some(Orifice {
                diameter: 3e-3,
                length: 8e-3,
                discharge: 0.8,
                count: 1.0,
            }),
            feeds: Vec::new(),
            inflow: 0.0,
            rib: None,
            window: None,
            room: None,
            oil: 0,
            of_sump: true,
        };
        for (nu, heights) in [
            (1e-5, [5.282_09, 10.2526, 12.2371, 17.2800]),
            (1e-4, [9.305_32, 10.8747, 12.6528, 17.5412]),
        ] {
            let fluid = Fluid {
                nu,
                eta: 830.0 * nu,
                rho: 830.0,
            };
            for (flow, height) in [0.05, 0.2, 0.5, 2.0].into_iter().zip(heights) {
                close(pocket.height(flow * L_MIN, &fluid) * 1e3, height, 6);
            }
            assert_eq!(pocket.height(0.0, &fluid), 0.0);
            let closed = Pocket {
                drain: None,
                ..pocket.clone()
            };
            assert!(closed.height(1e-12, &fluid) >= 8e-3 && closed.height(1e-12, &fluid) < 8.01e-3);
            // Monotone, through the edge.
            let mut last = 0.0;
            for i in 1..400 {
                let height = pocket.height(f64::from(i) * 0.01 * L_MIN, &fluid);
                assert!(height > last);
                last = height;
            }
        }
    }
}
