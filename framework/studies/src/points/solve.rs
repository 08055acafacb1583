//! Points of a field, solved singly or, if several have the same speed and temperature, batched.

use super::temperature::find_all;
use super::{Given, OilTemperature, PointResult, Points, sums};
use gearloss_framework::evaluate::{BatchScratch, Block, Noting, Point, PowerFlow, Scratch, Solution};
use gearloss_framework::loss::Extent;
use gearloss_framework::real::{LANES, Lane, Real as _};
use gearloss_framework::transmission::{Case, Transmission};

/// Points that are balanced and solved side by side.
const GROUP: usize = 4 * LANES;

/// Minimum size of a block; smaller blocks are slower than single points.
const FEW: usize = 6;

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
    /// Component and term with its sum, in the order of addition.
    terms: Vec<(usize, usize, usize)>,
}

/// Working memory for one concurrent task.
pub(super) struct Space {
    single: Scratch,
    rows: Option<BatchScratch>,
    results: Vec<PointResult>,
    /// Buffers for the components of points.
    spare: Vec<Vec<f64>>,
    torques: Vec<f64>,
    speeds: Vec<f64>,
}

impl Space {
    /// Observations since the last call.
    pub fn take_seen(&mut self) -> Vec<Extent> {
        let single = self.single.take_totals();
        match &mut self.rows {
            None => single,
            Some(rows) => {
                let pairs = rows.take_totals().into_iter().zip(single);
                pairs.map(|(row, single)| row.merge(single)).collect()
            }
        }
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
            terms: terms.collect(),
        }
    }

    pub fn space(&self) -> Space {
        Space {
            single: self.transmission.scratch(self.case),
            rows: None,
            results: Vec::new(),
            spare: Vec::new(),
            torques: vec![0.0; self.case.torque_ports.len()],
            speeds: vec![0.0; self.case.speed_ports.len()],
        }
    }

    /// Solves the points with the given indices, in order; neighbours with equal speed and temperature are solved together.
    pub fn solve<'s>(&self, numbers: &[usize], space: &'s mut Space) -> &'s mut [PointResult] {
        let mut results = std::mem::take(&mut space.results);
        space.spare.clear();
        space.spare.extend(results.drain(..).map(|point| point.parts));
        let given = |number: &usize| self.points.field.given_point(*number);
        let together = |a: &usize, b: &usize| {
            let (a, b) = (given(a), given(b));
            a.speed.to_bits() == b.speed.to_bits() && a.oil == b.oil
        };
        let mut rest: Vec<usize> = Vec::new();
        for run in numbers.chunk_by(together) {
            let first = given(&run[0]);
            let oil = self.oil_of(first);
            match oil {
                OilTemperature::Fixed(oil)
                    if run.len() >= FEW && self.points.flow == PowerFlow::Real && self.at_torque.is_some() =>
                {
                    self.several(&rest, space, &mut results);
                    rest.clear();
                    self.row(run, first.speed, oil, space, &mut results);
                }
                _ => rest.extend(run),
            }
        }
        self.several(&rest, space, &mut results);
        space.results = results;
        &mut space.results
    }

    /// Origin of the oil temperature of a point.
    fn oil_of(&self, given: Given) -> OilTemperature {
        given.oil.map_or(self.points.oil, OilTemperature::Fixed)
    }

    /// Points with speeds and temperatures of their own.
    fn several(&self, numbers: &[usize], space: &mut Space, results: &mut Vec<PointResult>) {
        for group in numbers.chunks(GROUP) {
            let given: Vec<Given> = group
                .iter()
                .map(|number| self.points.field.given_point(*number))
                .collect();
            let network = given.iter().any(|given| self.oil_of(*given) == OilTemperature::Network);
            if given.len() < FEW || network {
                results.extend(given.iter().map(|given| self.single(*given, space)));
            } else {
                self.group(&given, space, results);
            }
        }
    }

    /// The same, solved together.
    fn group(&self, given: &[Given], space: &mut Space, results: &mut Vec<PointResult>) {
        let Space {
            rows,
            torques,
            speeds,
            spare,
            ..
        } = space;
        let batch = rows.get_or_insert_with(|| self.transmission.batch_scratch(self.case));
        let with_first = |template: &[f64], first: f64| {
            let mut own = template.to_vec();
            own.iter_mut().take(1).for_each(|own| *own = first);
            own
        };
        let own: Vec<[Vec<f64>; 2]> = given
            .iter()
            .map(|given| [with_first(speeds, given.speed), with_first(torques, given.torque)])
            .collect();
        let points: Vec<Point<'_>> = own
            .iter()
            .map(|[speeds, torques]| Point {
                speeds,
                torques,
                flow: self.points.flow,
                ..Point::default()
            })
            .collect();
        let found = find_all(
            self.transmission,
            self.case,
            &points,
            |point| self.oil_of(given[point]),
            batch,
        );
        let start = results.len();
        for first in (0..points.len()).step_by(LANES) {
            let last = points.len().min(first + LANES);
            let temperatures = |lane: usize| found[first + lane].temperatures();
            let some = &points[first..last];
            let block = self
                .transmission
                .evaluate_together(self.case, some, temperatures, Noting::Counted, batch);
            let oil = |lane: usize| found[first + lane].oil;
            self.of_block(&given[first..last], oil, &block, spare, results);
            let alone: Vec<usize> = (0..some.len()).filter(|lane| block.is_alone(*lane)).collect();
            for lane in alone {
                let solution = self
                    .transmission
                    .evaluate(self.case, &some[lane], temperatures(lane), batch.alone());
                results[start + first + lane] = self.of_solution(given[first + lane], oil(lane), &solution);
            }
        }
        for (result, found) in results[start..].iter_mut().zip(&found) {
            result.set_temperature(found);
        }
    }

    fn single(&self, given: Given, space: &mut Space) -> PointResult {
        let Space {
            single,
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
        let warm = self.oil_of(given).find(self.transmission, self.case, &point, single);
        let solution = self
            .transmission
            .evaluate(self.case, &point, warm.temperatures(), single);
        let mut result = self.of_solution(given, warm.oil, &solution);
        result.set_temperature(&warm);
        result
    }

    fn row(&self, run: &[usize], speed: f64, oil: f64, space: &mut Space, results: &mut Vec<PointResult>) {
        let Space {
            rows,
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
        let rows = rows.get_or_insert_with(|| self.transmission.batch_scratch(self.case));
        let temperature = [oil];
        let mut row = self.transmission.batch(self.case, &point, &temperature, rows);
        // Where the torque turns so do the drivers, which the points of a block have in common.
        let torque = |number: &usize| self.points.field.given_point(*number).torque;
        let blocks = run
            .chunk_by(|a, b| torque(a) * torque(b) > 0.0)
            .flat_map(|own| own.chunks(LANES));
        for some in blocks {
            if some.len() < FEW {
                for torque in some.iter().map(torque) {
                    let given = Given {
                        torque,
                        speed,
                        oil: None,
                    };
                    results.push(self.of_solution(given, oil, &row.alone(torque)));
                }
                continue;
            }
            let mut given = [0.0; LANES];
            for (given, number) in given.iter_mut().zip(some) {
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
                outside: block.leaves_a_range(lane),
                undefined: None,
                passes: block.passes(lane),
                evaluations: 0,
            });
        }
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
            outside: solution.leaves_a_range(),
            undefined: solution.undefined_part(),
            passes: solution.passes(),
            evaluations: 0,
        }
    }
}
