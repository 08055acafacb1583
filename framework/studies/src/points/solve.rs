//! Points of a field, solved one by one, in batches of one speed and temperature, or in groups of any speeds and temperatures.

use std::sync::Arc;

use super::temperature::find_all;
use super::{Given, OilTemperature, PointResult, Points, sums};
use gearloss_framework::evaluate::{BatchScratch, Block, Noting, Point, PowerFlow, Solution};
use gearloss_framework::loss::Extent;
use gearloss_framework::machine::{Machine, MachineState, Reached};
use gearloss_framework::real::{LANES, Lane, Real as _};
use gearloss_framework::transmission::{Case, Transmission};

/// Points that are balanced and solved side by side.
const GROUP: usize = 4 * LANES;

/// Minimum number of points that are solved together; fewer are faster one by one.
const FEW: usize = 6;

/// Minimum number of points of one speed and temperature in a batch of their own; fewer are solved together with points of other speeds,
/// because what they have in common costs less than lanes without a point.
const MANY: usize = 12;

/// Common data of all points of a field.
pub(super) struct Solver<'a> {
    transmission: &'a Transmission,
    case: &'a Case,
    points: &'a Points,
    /// Member of the port of the torque.
    at_torque: Option<usize>,
    reference: usize,
    other: Option<usize>,
    at_reference: bool,
    /// Machines that heat nothing where temperatures are given, and all of them where a network is solved.
    has_machines: bool,
    /// Component and term with its sum, in the order of addition.
    terms: Vec<(usize, usize, usize)>,
}

/// Working memory for one concurrent task.
pub(super) struct Space {
    scratch: BatchScratch,
    results: Vec<PointResult>,
    /// Buffers for the components of points.
    spare: Vec<Vec<f64>>,
    torques: Vec<f64>,
    speeds: Vec<f64>,
}

impl Space {
    /// Observations since the last call.
    pub fn take_seen(&mut self) -> Vec<Extent> {
        self.scratch.take_totals()
    }
}

impl<'a> Solver<'a> {
    pub fn new(transmission: &'a Transmission, case: &'a Case, points: &'a Points) -> Self {
        let member = |port: usize| transmission.ports()[port].member;
        let reference = transmission.reference_port();
        let terms = transmission.parts().iter().enumerate().flat_map(|(number, part)| {
            let terms = transmission.instances()[part.notes.instance()].entry.terms;
            terms
                .iter()
                .map(move |term| (number, term.index, sums::sum_of(part.mechanism, term.load_dependent)))
        });
        Self {
            transmission,
            case,
            points,
            at_torque: case.torque_ports.first().map(|port| member(*port)),
            reference: member(reference),
            other: match transmission.ports() {
                [_, _] => Some(member(1 - reference)),
                _ => None,
            },
            at_reference: case.torque_ports.first() == Some(&reference),
            has_machines: !transmission.machines().is_empty(),
            terms: terms.collect(),
        }
    }

    pub fn space(&self) -> Space {
        Space {
            scratch: self.transmission.batch_scratch(self.case),
            results: Vec::new(),
            spare: Vec::new(),
            torques: vec![0.0; self.case.torque_ports.len()],
            speeds: vec![0.0; self.case.speed_ports.len()],
        }
    }

    /// Solves the points with the given indices, and returns them with their indices in ascending order. Neighbours with equal speed and
    /// temperature are a batch if they are many.
    pub fn solve<'s>(&self, numbers: &[usize], space: &'s mut Space) -> Vec<(usize, &'s mut PointResult)> {
        let mut results = std::mem::take(&mut space.results);
        space.spare.clear();
        space.spare.extend(results.drain(..).map(|point| point.parts));
        results.reserve(numbers.len());
        let given = |number: &usize| self.points.field.given_point(*number);
        let together = |a: &usize, b: &usize| {
            let (a, b) = (given(a), given(b));
            a.speed.to_bits() == b.speed.to_bits() && a.oil == b.oil
        };
        // Where torque or speed turn so do the drivers, which the points of a block have in common.
        let sense = |number: &usize| [given(number).torque, given(number).speed].map(|x| x.partial_cmp(&0.0));
        let like = |a: &usize, b: &usize| sense(a) == sense(b);
        let (mut solved, mut rest): (Vec<usize>, Vec<usize>) = Default::default();
        for run in numbers.chunk_by(together) {
            let first = given(&run[0]);
            match self.oil_of(first) {
                OilTemperature::Fixed(oil) if self.points.flow == PowerFlow::Real && self.at_torque.is_some() => {
                    let blocks = run.chunk_by(like).flat_map(|alike| alike.chunks(LANES));
                    let (many, few): (Vec<&[usize]>, Vec<&[usize]>) = blocks.partition(|block| block.len() >= MANY);
                    rest.extend(few.into_iter().flatten());
                    if !many.is_empty() {
                        self.row(&many, first.speed, oil, space, &mut results);
                        solved.extend(many.into_iter().flatten());
                    }
                }
                _ => rest.extend(run),
            }
        }
        rest.sort_by_key(sense);
        for alike in rest.chunk_by(like).flat_map(|group| group.chunks(GROUP)) {
            self.several(alike, space, &mut results);
        }
        solved.extend(rest);
        if self.has_machines {
            for point in &mut results {
                self.lose_in_machines(point);
            }
        }
        space.results = results;
        let mut points: Vec<(usize, &mut PointResult)> = solved.into_iter().zip(&mut space.results).collect();
        // Stable sort: the runs are already sorted.
        points.sort_by_key(|(number, _)| *number);
        points
    }

    /// Origin of the oil temperature of a point.
    fn oil_of(&self, given: Given) -> OilTemperature {
        given.oil.map_or(self.points.oil, OilTemperature::Fixed)
    }

    /// Points with speeds and temperatures of their own.
    fn several(&self, numbers: &[usize], space: &mut Space, results: &mut Vec<PointResult>) {
        let given: Vec<Given> = numbers
            .iter()
            .map(|number| self.points.field.given_point(*number))
            .collect();
        if given.len() < FEW {
            results.extend(given.iter().map(|given| self.single(*given, space)));
        } else {
            self.group(&given, space, results);
        }
    }

    /// The same, solved together.
    fn group(&self, given: &[Given], space: &mut Space, results: &mut Vec<PointResult>) {
        let Space { scratch, spare, .. } = space;
        // Speeds or torques of all points in one buffer; all but the first of each point are zero.
        let spread = |each: usize, first: fn(&Given) -> f64| {
            let mut all = vec![0.0; each * given.len()];
            for (first_guess, given) in all.iter_mut().step_by(each.max(1)).zip(given) {
                *first_guess = first(given);
            }
            all
        };
        let (speeds_each, torques_each) = (self.case.speed_ports.len(), self.case.torque_ports.len());
        let speeds = spread(speeds_each, |given| given.speed);
        let torques = spread(torques_each, |given| given.torque);
        let points: Vec<Point<'_>> = (0..given.len())
            .map(|i| Point {
                speeds: &speeds[i * speeds_each..][..speeds_each],
                torques: &torques[i * torques_each..][..torques_each],
                flow: self.points.flow,
                ..Point::default()
            })
            .collect();
        let oil = |point: usize| self.oil_of(given[point]);
        let found = find_all(self.transmission, self.case, &points, oil, scratch);
        let start = results.len();
        for first in (0..points.len()).step_by(LANES) {
            let places = first..points.len().min(first + LANES);
            let alone: Vec<usize> = if places.len() < FEW {
                places.collect()
            } else {
                let temperatures = |lane: usize| found[first + lane].temperatures();
                let some = &points[places.clone()];
                let block =
                    self.transmission
                        .evaluate_together(self.case, some, &temperatures, Noting::Counted, scratch);
                self.of_block(
                    &given[places.clone()],
                    |lane| found[first + lane].oil,
                    &block,
                    spare,
                    results,
                );
                places.filter(|point| block.is_alone(point - first)).collect()
            };
            for point in alone {
                let temperatures = found[point].temperatures();
                let solution = self
                    .transmission
                    .evaluate(self.case, &points[point], temperatures, scratch.alone());
                let result = self.of_solution(given[point], found[point].oil, &solution);
                match results.get_mut(start + point) {
                    Some(placeholder) => *placeholder = result,
                    None => results.push(result),
                }
            }
        }
        for (result, found) in results[start..].iter_mut().zip(&found) {
            result.set_temperature(found);
        }
    }

    fn single(&self, given: Given, space: &mut Space) -> PointResult {
        let Space {
            scratch,
            torques,
            speeds,
            ..
        } = space;
        if let Some(first) = torques.first_mut() {
            *first = given.torque;
        }
        if let Some(first) = speeds.first_mut() {
            *first = given.speed;
        }
        let point = Point {
            speeds,
            torques,
            flow: self.points.flow,
            ..Point::default()
        };
        let oil = self.oil_of(given);
        let mut found = find_all(self.transmission, self.case, &[point], |_| oil, scratch);
        let warm = found.remove(0);
        let single = scratch.alone();
        let solution = self
            .transmission
            .evaluate(self.case, &point, warm.temperatures(), single);
        let mut result = self.of_solution(given, warm.oil, &solution);
        result.set_temperature(&warm);
        result
    }

    /// Blocks of points of one speed.
    fn row(&self, blocks: &[&[usize]], speed: f64, oil: f64, space: &mut Space, results: &mut Vec<PointResult>) {
        let Space {
            scratch,
            torques,
            speeds,
            spare,
            ..
        } = space;
        if let Some(first) = speeds.first_mut() {
            *first = speed;
        }
        let point = Point {
            speeds,
            torques,
            flow: self.points.flow,
            ..Point::default()
        };
        let temperature = [oil];
        let mut row = self.transmission.batch(self.case, &point, &temperature, scratch);
        for some in blocks {
            let torque = |number: &usize| self.points.field.given_point(*number).torque;
            let mut given = [0.0; LANES];
            for (given, number) in given.iter_mut().zip(*some) {
                *given = torque(number);
            }
            let start = results.len();
            let block = row.solve(&given[..some.len()]);
            let points = given.map(|torque| Given {
                torque,
                speed,
                oil: None,
            });
            self.of_block(&points[..some.len()], |_| oil, &block, spare, results);
            let alone: [bool; LANES] = std::array::from_fn(|lane| block.is_alone(lane));
            for lane in (0..some.len()).filter(|lane| alone[*lane]) {
                results[start + lane] = self.of_solution(points[lane], oil, &row.alone(given[lane]));
            }
        }
    }

    /// The points of a block; points that must be evaluated singly are placeholders.
    fn of_block(
        &self,
        given: &[Given],
        oil: impl Fn(usize) -> f64,
        block: &Block<'_>,
        spare: &mut Vec<Vec<f64>>,
        results: &mut Vec<PointResult>,
    ) {
        let mut sums = [Lane::ZERO; 6];
        let mut terms = Vec::new();
        if self.points.terms {
            terms.resize(
                self.transmission.parts().len(),
                [Lane::ZERO; gearloss_framework::loss::MOST_TERMS],
            );
        }
        for (part, term, sum) in &self.terms {
            let watts = block.term_watts(*part, *term);
            sums[*sum] += watts;
            if let Some(terms) = terms.get_mut(*part) {
                terms[*term] = watts;
            }
        }
        for (lane, given) in given.iter().enumerate() {
            let loss = block.losses()[lane];
            let reference_speed = block.speeds(self.reference)[lane];
            let (input, output) = (block.balance(lane).input, block.output_power(lane));
            let mut parts = spare.pop().unwrap_or_default();
            parts.clear();
            parts.extend(block.watts().iter().map(|watts| watts[lane]));
            results.push(PointResult {
                torque: given.torque,
                speed: given.speed,
                torque_speed: self.at_torque.map_or(0.0, |member| block.speeds(member)[lane]),
                reference_speed,
                output_speed: self.other.map(|member| block.speeds(member)[lane]),
                at_reference: self.at_reference,
                oil: Some(oil(lane)),
                surface: None,
                balance: None,
                nodes: Vec::new(),
                status: block.status(lane),
                efficiency: output
                    .filter(|output| *output > 0.0 && input > 0.0)
                    .map(|output| output / input),
                loss: Some(loss),
                loss_torque: (reference_speed != 0.0).then(|| loss / reference_speed.abs()),
                input: Some(input),
                output,
                sums: std::array::from_fn(|k| sums[k][lane]),
                parts,
                terms: terms
                    .iter()
                    .map(|terms| std::array::from_fn(|k| terms[k][lane]))
                    .collect(),
                machines: self.machines(
                    block.status(lane).has_flow(),
                    |member| block.speeds(member)[lane],
                    |member| block.port_torques(member)[lane],
                ),
                outside: block.leaves_a_range(lane),
                limits: Vec::new(),
                beyond: false,
                undefined: None,
                passes: block.passes(lane),
            });
        }
    }

    /// Speeds and torques of all machines; their losses follow from the temperatures.
    fn machines(
        &self,
        has_flow: bool,
        speed: impl Fn(usize) -> f64,
        torque: impl Fn(usize) -> f64,
    ) -> Vec<MachineState> {
        if !self.has_machines || !has_flow {
            return Vec::new();
        }
        let machines = self.transmission.machines().iter();
        let at = |machine: &Arc<Machine>| MachineState {
            speed: speed(machine.member),
            torque: torque(machine.member),
            machine: 0.0,
            inverter: 0.0,
            outside: false,
            reached: Reached::Continuous,
        };
        machines.map(at).collect()
    }

    /// Adds the losses of the machines at the temperatures of a point.
    fn lose_in_machines(&self, point: &mut PointResult) {
        let Some(oil) = point.oil.filter(|_| !point.machines.is_empty()) else {
            point.machines.clear();
            return;
        };
        let alone = [oil];
        let temperatures = if point.nodes.is_empty() {
            &alone[..]
        } else {
            &point.nodes
        };
        let all = self.transmission.machines().iter().zip(&point.machines);
        let active = all.filter(|(machine, _)| !machine.only_in_network || temperatures.len() > 1);
        let lose = |(machine, state): (&Arc<Machine>, &MachineState)| {
            self.transmission
                .machine_at(machine, state.speed, state.torque, temperatures)
        };
        point.machines = active.map(lose).collect();
    }

    /// Results of a solution at a point, at a given oil temperature.
    fn of_solution(&self, given: Given, oil: f64, solution: &Solution<'_>) -> PointResult {
        let mut totals = [0.0; 6];
        let mut terms = Vec::new();
        for (part, loss) in solution.parts() {
            sums::add(&mut totals, self.transmission, part, &loss);
            if self.points.terms {
                terms.push(std::array::from_fn(|k| loss.term_watts(k)));
            }
        }
        PointResult {
            torque: given.torque,
            speed: given.speed,
            torque_speed: self.at_torque.map_or(0.0, |member| solution.speed(member)),
            reference_speed: solution.speed(self.reference),
            output_speed: self.other.map(|member| solution.speed(member)),
            at_reference: self.at_reference,
            oil: Some(oil),
            surface: None,
            balance: None,
            nodes: Vec::new(),
            status: solution.status(),
            efficiency: solution.efficiency(),
            loss: solution.loss(),
            loss_torque: solution.loss_torque(),
            input: solution.input_power(),
            output: solution.output_power(),
            sums: totals,
            parts: solution.watts().to_vec(),
            terms,
            machines: self.machines(
                solution.has_flow(),
                |member| solution.speed(member),
                |member| solution.port_torque(member),
            ),
            outside: solution.leaves_a_range(),
            limits: Vec::new(),
            beyond: false,
            undefined: solution.undefined_part(),
            passes: solution.passes(),
        }
    }
}
