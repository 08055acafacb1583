//! Points of a field, solved singly or, if several have the same speed and temperature, batched.

use super::{Given, OilTemperature, PointResult, Points, sums};
use gearloss_framework::evaluate::{BatchScratch, Block, Point, PowerFlow, Scratch, Solution};
use gearloss_framework::loss::Extent;
use gearloss_framework::real::{LANES, Lane, Real as _};
use gearloss_framework::transmission::{Case, Transmission};

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
        for run in numbers.chunk_by(together) {
            let first = given(&run[0]);
            let oil = first.oil.map_or(self.points.oil, OilTemperature::Fixed);
            match oil {
                OilTemperature::Fixed(oil)
                    if run.len() >= FEW && self.points.flow == PowerFlow::Real && self.at_torque.is_some() =>
                {
                    self.row(run, first.speed, oil, space, &mut results);
                }
                _ => results.extend(run.iter().map(|number| self.single(given(number), space))),
            }
        }
        space.results = results;
        &mut space.results
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
        let wanted = given.oil.map_or(self.points.oil, OilTemperature::Fixed);
        let warm = wanted.find(self.transmission, self.case, &point, single);
        let solution = self
            .transmission
            .evaluate(self.case, &point, warm.temperatures(), single);
        let result = PointResult {
            surface: warm.balance.as_ref().and_then(|b| b.surface),
            balance: warm.outcome(),
            evaluations: warm.evaluations(),
            nodes: warm
                .network
                .as_ref()
                .map(|n| n.temperatures.clone())
                .unwrap_or_default(),
            ..self.of_solution(given, warm.oil, &solution)
        };
        if warm.is_sound() {
            result
        } else {
            result.without_temperature()
        }
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
            let given = &given[..some.len()];
            let start = results.len();
            let block = row.solve(given);
            self.of_block(given, speed, oil, &block, spare, results);
            let alone: [bool; LANES] = std::array::from_fn(|lane| block.is_alone(lane));
            for (lane, torque) in given.iter().enumerate().filter(|(lane, _)| alone[*lane]) {
                let given = Given {
                    torque: *torque,
                    speed,
                    oil: None,
                };
                results[start + lane] = self.of_solution(given, oil, &row.alone(*torque));
            }
        }
    }

    /// The points of a block; points that must be evaluated singly are placeholders.
    fn of_block(
        &self,
        torques: &[f64],
        speed: f64,
        oil: f64,
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
        for (lane, torque) in torques.iter().enumerate() {
            let loss = block.losses()[lane];
            let reference_speed = block.speed(self.reference);
            let balance = block.balance(lane);
            let mut parts = spare.pop().unwrap_or_default();
            parts.clear();
            parts.extend(block.watts().iter().map(|watts| watts[lane]));
            results.push(PointResult {
                torque: *torque,
                speed,
                torque_speed: self.at_torque.map_or(0.0, |member| block.speed(member)),
                reference_speed,
                output_speed: self.other.map(|member| block.speed(member)),
                at_reference: self.at_reference,
                oil: Some(oil),
                surface: None,
                balance: None,
                nodes: Vec::new(),
                status: block.status(lane),
                efficiency: balance.efficiency_as_is(),
                loss: Some(loss),
                loss_torque: (reference_speed != 0.0).then(|| loss / reference_speed.abs()),
                input: Some(balance.input),
                output: Some(balance.output),
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
