//! The table of one mesh: built from the model, evaluated at a point, with the error measured at check points.

use std::thread;

use gearloss_framework::attach::Oil;
use gearloss_framework::loss::{Notes, Seen, Undefined};
use gearloss_framework::lubricant::Lubricant;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, MeshPart};
use gearloss_framework::registry::Slot;
use gearloss_numerics::sampling::Sobol;
use std::cell::Cell;

use super::spline::Spline;
use crate::tooth_friction::ehl_mixed::LEAST_SHARE;

/// Maximum by which check points place the oil below known body temperatures. \[K\]
const OIL_BELOW: f64 = 30.0;

/// Maximum difference of known body temperatures at check points. \[K\]
const APART: f64 = 20.0;

/// Axes of a table: minimum and maximum.
#[derive(Debug, Clone, Copy)]
pub struct Extents {
    /// Magnitude of the speed of the first gear. \[rad/s\]
    pub speeds: [f64; 2],
    /// Torque of the first gear. \[Nm\]
    pub torques: [f64; 2],
    /// Temperature. \[degC\]
    pub temperatures: [f64; 2],
}

/// An operating point of the model.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// Speed of the first gear. \[rad/s\]
    pub speed: f64,
    /// Torque of the first gear. \[Nm\]
    pub torque: f64,
    /// Temperature of the oil. \[degC\]
    pub oil: f64,
    /// Body temperatures, if they are known. \[degC\]
    pub bodies: Option<[f64; 2]>,
}

impl Point {
    /// The context of a mesh model at the point.
    pub fn context<'a>(&self, part: &'a MeshPart, lubricant: &Lubricant, notes: Notes<'a>) -> GearMeshAt<'a> {
        let Oil {
            temperature,
            nu,
            rho,
            eta,
            alpha,
            beta,
            conductivity,
            x_l,
            ..
        } = lubricant.oil_at(self.oil);
        let [temperature_1, temperature_2] = self.bodies.unwrap_or([temperature; 2]);
        GearMeshAt::usual(part, notes).with(|to| {
            to.torque = self.torque;
            to.speed = self.speed;
            to.first_drives = 1.0;
            to.temperature = temperature;
            to.nu = nu;
            to.eta = eta;
            to.rho = rho;
            to.alpha = alpha;
            to.beta = beta;
            to.conductivity = conductivity;
            to.x_l = x_l;
            to.bodies_known = f64::from(u8::from(self.bodies.is_some()));
            to.temperature_1 = temperature_1;
            to.temperature_2 = temperature_2;
        })
    }
}

/// Result of the model at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// Loss. \[W\]
    watts: f64,
    /// Share of the heat that enters the first gear.
    share: f64,
    /// Number of stated ranges exceeded, of the model and its nested models.
    left: usize,
}

/// A model with its pair and its oil.
#[derive(Clone, Copy)]
pub struct DirectModel<'a> {
    /// The model.
    pub model: &'a Slot<GearMesh>,
    /// The pair.
    pub part: &'a MeshPart,
    /// Its oil.
    pub lubricant: &'a Lubricant,
}

impl DirectModel<'_> {
    /// Evaluates the model.
    ///
    /// # Errors
    /// If it is undefined.
    pub fn answer(&self, point: &Point) -> Result<Answer, Undefined> {
        let cells = vec![Cell::new(Seen::NOTHING); self.model.notes.end()];
        let notes = Notes::new(&cells, self.model.notes);
        let loss = self.model.loss(&point.context(self.part, self.lubricant, notes))?;
        Ok(Answer {
            watts: loss.total_watts(point.speed),
            share: loss.first_heat(),
            left: cells.iter().filter(|cell| cell.get().extent().outside > 0).count(),
        })
    }

    /// Conductance from the first body to the second, from a result for equal bodies. \[W/K\]
    ///
    /// # Errors
    /// If the model is undefined.
    fn conduction(&self, point: &Point, temperature: f64, even: &Answer) -> Result<f64, Undefined> {
        const TRIED: [f64; 4] = [1.0, 0.03, 1e-3, 3e-5];
        let mut conduction = 0.0;
        for apart in TRIED {
            let answer = self.answer(&Point {
                bodies: Some([temperature + 0.5 * apart, temperature - 0.5 * apart]),
                ..*point
            })?;
            conduction = (even.share * even.watts - answer.share * answer.watts) / apart;
            // Models bound the share; if the share changes much, a smaller temperature difference is more accurate.
            if (answer.share - even.share).abs() < 0.3 {
                break;
            }
        }
        Ok(conduction)
    }

    /// True if the model uses body temperatures when they are known.
    pub fn follows_bodies(&self, extents: &Extents) -> bool {
        let middle = |ends: [f64; 2]| (ends[0] * ends[1]).sqrt();
        let oil = 0.5 * (extents.temperatures[0] + extents.temperatures[1]);
        let with = |bodies: f64| {
            self.answer(&Point {
                speed: middle(extents.speeds),
                torque: middle(extents.torques),
                oil,
                bodies: Some([bodies; 2]),
            })
        };
        with(oil) != with(oil + APART)
    }
}

/// Runs a function for many points in parallel and returns the results in order. It uses its own threads: a pool thread that waited
/// here could take up other points, and these may wait for this very table.
fn for_all<T: Copy + Send>(points: &[Point], run: impl Fn(&Point) -> T + Copy + Send) -> Vec<T> {
    let threads = thread::available_parallelism().map_or(1, usize::from).min(points.len());
    let parts: Vec<Vec<T>> = thread::scope(|scope| {
        let start = |k: usize| scope.spawn(move || points.iter().skip(k).step_by(threads).map(run).collect());
        let started: Vec<_> = (0..threads).map(start).collect();
        let joined = started.into_iter().map(thread::ScopedJoinHandle::join);
        joined
            .map(|part| part.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    (0..points.len()).map(|i| parts[i % threads][i / threads]).collect()
}

/// Axes of a table: logarithms of speed, torque and fluidity (the inverse of viscosity), which increases with temperature.
#[derive(Debug, Clone, Copy)]
struct Axes {
    first: [f64; 3],
    last: [f64; 3],
}

fn fluidity(lubricant: &Lubricant, temperature: f64) -> f64 {
    -lubricant.eta(temperature).ln()
}

impl Axes {
    fn new(extents: &Extents, lubricant: &Lubricant) -> Self {
        let end = |i: usize| {
            [
                extents.speeds[i].ln(),
                extents.torques[i].ln(),
                fluidity(lubricant, extents.temperatures[i]),
            ]
        };
        Self {
            first: end(0),
            last: end(1),
        }
    }

    /// Position of a point along the axes, from zero to one.
    fn place(&self, point: [f64; 3], lubricant: &Lubricant) -> [f64; 3] {
        let [speed, torque, temperature] = point;
        let x = [speed.ln(), torque.ln(), fluidity(lubricant, temperature)];
        std::array::from_fn(|i| (x[i] - self.first[i]) / (self.last[i] - self.first[i]))
    }

    /// The inverse of [`Axes::place`]; searches between the ends of the temperature axis.
    fn point(&self, place: [f64; 3], ends: [f64; 2], lubricant: &Lubricant) -> [f64; 3] {
        let x: [f64; 3] = std::array::from_fn(|i| self.first[i] + place[i] * (self.last[i] - self.first[i]));
        let [mut cold, mut hot] = ends;
        // Bisection narrows hundreds of kelvin to the last digit.
        for _ in 0..60 {
            let middle = 0.5 * (cold + hot);
            if fluidity(lubricant, middle) < x[2] {
                cold = middle;
            } else {
                hot = middle;
            }
        }
        [x[0].exp(), x[1].exp(), 0.5 * (cold + hot)]
    }
}

/// Maximum and rms error at the check points. \[-\]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// Maximum relative error of the loss.
    pub greatest: f64,
    /// Root mean square of the relative error of the loss.
    pub rms: f64,
    /// Maximum error of the heat share of the first gear.
    pub share: f64,
}

/// Interpolated result at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Read {
    /// Loss. \[W\]
    pub watts: f64,
    /// Share of the heat that enters the first gear. \[-\]
    pub first_heat: f64,
    /// Number of stated ranges exceeded at the nearest node.
    pub left: f64,
}

/// The loss over power, the heat share of the first gear and the conductance between the bodies over speed, torque and temperature.
#[derive(Debug)]
pub struct Table {
    axes: Axes,
    nodes: [usize; 3],
    spline: Spline,
    /// Number of stated ranges exceeded at each node.
    left: Vec<u8>,
    /// Errors at the check points.
    pub errors: Errors,
}

impl Table {
    /// Evaluates the model at all nodes and at a number of check points.
    ///
    /// # Errors
    /// If it is undefined at any of them.
    pub fn new(
        direct: &DirectModel<'_>,
        extents: &Extents,
        nodes: [usize; 3],
        checks: u32,
        known: bool,
    ) -> Result<Self, Undefined> {
        let axes = Axes::new(extents, direct.lubricant);
        let ends = extents.temperatures;
        let point = |place: [f64; 3]| axes.point(place, ends, direct.lubricant);
        let mut points = Vec::new();
        for k in 0..nodes.iter().product() {
            let at = [k / (nodes[1] * nodes[2]), k / nodes[2] % nodes[1], k % nodes[2]];
            let [speed, torque, t] = point(std::array::from_fn(|i| at[i] as f64 / (nodes[i] - 1) as f64));
            points.push(Point {
                speed,
                torque,
                oil: t,
                bodies: known.then_some([t; 2]),
            });
        }
        let node = |point: &Point| {
            let answer = direct.answer(point)?;
            let conduction = match point.bodies {
                Some([temperature, _]) => direct.conduction(point, temperature, &answer)?,
                None => 0.0,
            };
            Ok((answer, conduction))
        };
        let answers: Vec<(Answer, f64)> = for_all(&points, node).into_iter().collect::<Result<_, _>>()?;
        let numbers = |(point, (answer, conduction)): (&Point, &(Answer, f64))| {
            [answer.watts / (point.torque * point.speed), answer.share, *conduction]
        };
        let mut table = Self {
            spline: Spline::through(nodes, points.iter().zip(&answers).map(numbers).collect()),
            left: answers.iter().map(|(answer, _)| answer.left.min(255) as u8).collect(),
            axes,
            nodes,
            errors: Errors::default(),
        };
        let checks = table.checks(checks, ends, direct.lubricant, known);
        table.errors = table.compare(&checks, direct)?;
        Ok(table)
    }

    /// Points at cell centres, where the spline error is largest; with known body temperatures, these differ and the oil is colder.
    fn checks(&self, count: u32, ends: [f64; 2], lubricant: &Lubricant, known: bool) -> Vec<Point> {
        let Ok(sobol) = Sobol::new(5) else { return Vec::new() };
        (1..=count)
            .map(|index| {
                let random = sobol.point(index);
                let place = std::array::from_fn(|i| {
                    let cells = (self.nodes[i] - 1) as f64;
                    ((random[i] * cells).floor() + 0.5) / cells
                });
                let [speed, torque, t] = self.axes.point(place, ends, lubricant);
                let half = APART * (random[3] - 0.5);
                Point {
                    speed,
                    torque,
                    oil: if known {
                        (t - OIL_BELOW * random[4]).max(ends[0])
                    } else {
                        t
                    },
                    bodies: known.then_some([t + half, t - half]),
                }
            })
            .collect()
    }

    fn compare(&self, checks: &[Point], direct: &DirectModel<'_>) -> Result<Errors, Undefined> {
        let mut errors = Errors::default();
        let mut squares = 0.0;
        for (point, answer) in checks.iter().zip(for_all(checks, |point| direct.answer(point))) {
            let Answer { watts, share, .. } = answer?;
            let [first, second] = point.bodies.unwrap_or([point.oil; 2]);
            let place = self.place([point.speed, point.torque, 0.5 * (first + second)], direct.lubricant);
            let read = self.read(place, point.torque * point.speed, first - second);
            let error = if read.watts == watts {
                0.0
            } else if watts == 0.0 {
                1.0
            } else {
                (read.watts / watts - 1.0).abs()
            };
            squares += error * error;
            errors.greatest = errors.greatest.max(error);
            errors.share = errors.share.max((read.first_heat - share).abs());
        }
        errors.rms = (squares / checks.len().max(1) as f64).sqrt();
        Ok(errors)
    }

    /// Position of a speed in rad/s, a torque in Nm and a temperature in degC along the axes; zero and one are the ends.
    pub fn place(&self, point: [f64; 3], lubricant: &Lubricant) -> [f64; 3] {
        self.axes.place(point, lubricant)
    }

    /// The table at a position within its ends, for a power in W and a temperature difference of the first to the second body in K.
    pub fn read(&self, place: [f64; 3], input: f64, warmer: f64) -> Read {
        let [fraction, share, conduction] = self.spline.value(place);
        // A spline may undershoot zero where the loss is small.
        let watts = fraction.max(0.0) * input;
        let first_heat = if warmer != 0.0 && watts > 0.0 {
            (share - conduction * warmer / watts).clamp(LEAST_SHARE, 1.0 - LEAST_SHARE)
        } else {
            share
        };
        let nearest = (0..3).fold(0, |k, i| {
            let last = self.nodes[i] - 1;
            k * self.nodes[i] + ((place[i] * last as f64).round() as usize).min(last)
        });
        Read {
            watts,
            first_heat,
            left: f64::from(self.left[nearest]),
        }
    }
}
