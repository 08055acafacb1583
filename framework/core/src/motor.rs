//! Losses of an electric motor from a map over speed and torque.

use std::collections::BTreeMap;

use gearloss_document::data::missing::CELL_HELP;
use gearloss_document::data::sheet::{Sheet, Wanted, limited_faults};
use gearloss_document::data::{MeasuredFault, TableFile, fault};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::table::{Axis, Interpolation, Outside, Reading, Table, clamped};

/// An electric motor that heats its rotor and its stator.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct MotorEntry {
    /// CSV file, workbook or MDF file, relative to this one, or an entry with `file`, `columns` and `units`: `speed [rpm]`, `torque [Nm]`, and `efficiency [-]` or `loss [W]`; with `temperature [degC]`, one
    /// map for each temperature. Rows with negative torque are for generating, those of 0 Nm for both.
    #[schemars(extend("x-refers-to" = "file"))]
    pub map: TableFile,
    /// Share of the losses that occurs in the rotor.
    #[serde(default)]
    pub rotor_share: RotorShare,
    /// Port that the motor drives.
    #[serde(default = "input")]
    #[schemars(extend("x-refers-to" = "ports"))]
    pub port: String,
    /// Node of the thermal network that is the rotor.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub rotor: String,
    /// Node of the thermal network that is the stator.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub stator: String,
}

/// Share of the losses of a motor that occurs in its rotor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum RotorShare {
    /// The same at all speeds. [-]
    One(#[schemars(range(min = 0.0, max = 1.0))] f64),
    /// Over speed: linear between the values, constant beyond.
    Over(#[schemars(length(min = 1))] Vec<RotorShareAt>),
}

/// Share at a speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RotorShareAt {
    /// Speed of the motor; increases along the list. [rpm]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub speed: f64,
    /// Share. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub share: f64,
}

fn input() -> String {
    "input".to_owned()
}

impl Default for RotorShare {
    // Assumed: motors with interior magnets have 0.1 to 0.3, increasing with speed.
    fn default() -> Self {
        Self::One(0.2)
    }
}

impl RotorShare {
    /// The share at a speed \[rad/s\] of either sign. \[-\]
    ///
    /// # Errors
    /// If the speeds of the list do not increase.
    pub fn share_at(&self, speed: f64) -> Result<f64, MeasuredFault> {
        match self {
            Self::One(share) => Ok(*share),
            Self::Over(list) => {
                if list.windows(2).any(|pair| pair[1].speed <= pair[0].speed) {
                    return Err(fault("the speeds of `rotor_share` do not increase", "sort them"));
                }
                let speeds: Vec<f64> = list.iter().map(|s| s.speed).collect();
                let shares: Vec<f64> = list.iter().map(|s| s.share).collect();
                Ok(clamped(&speeds, &shares, speed.abs()))
            }
        }
    }
}

/// A loss read from a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorLoss {
    /// \[W\]
    pub loss: f64,
    /// True if speed, torque, temperature or voltage is outside the map, whose end value is then used.
    pub outside: bool,
}

/// A state of a motor: where a map is read.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotorAt {
    /// \[rad/s\]
    pub speed: f64,
    /// \[Nm\]
    pub torque: f64,
    /// Of the windings. \[degC\]
    pub temperature: f64,
    /// Of the DC link. \[V\]
    pub voltage: f64,
}

/// What the inverter carries, read from a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseCurrent {
    /// Root mean square of a phase. \[A\]
    pub current: f64,
    /// Cosine of the phase angle: negative while the motor generates. \[-\]
    pub power_factor: f64,
    /// Twice the amplitude of the phase voltage over the DC voltage. \[-\]
    pub modulation: f64,
}

/// Losses over speed, torque and, if the file has them, temperature and DC voltage.
///
/// The loss is interpolated, not the efficiency, which is undefined without power. Motoring and generating share the nodes at zero
/// torque, so that the loss is continuous there. Where no row has zero torque, as in a map of efficiencies, it is linear between the
/// smallest torques of both signs; without negative torques, the loss of the smallest torque is used below it. Below the lowest speed
/// the loss of the nearest node is used. The same applies in corners that the motor does not reach, where it is that of the largest
/// torque at that speed. At standstill without torque the motor is off: the loss is zero.
#[derive(Debug, Clone)]
pub struct MotorMap {
    motoring: Quadrant,
    /// `None`: generating has the losses of motoring at the same torque.
    generating: Option<Quadrant>,
    /// Current, power factor and modulation, if the file has them, motoring and generating.
    phase: Option<[[Quadrant; 3]; 2]>,
    /// How the file was interpreted, in sentences.
    pub notes: Vec<String>,
}

/// Nodes with torque of one sign.
#[derive(Debug, Clone)]
struct Quadrant {
    table: Table,
    /// Speeds and the largest torque at each that the file holds.
    reach: (Vec<f64>, Vec<f64>),
    /// First and last temperature, if the file has several.
    temperatures: Option<(f64, f64)>,
    /// First and last voltage, if the file has several.
    voltages: Option<(f64, f64)>,
}

/// One row; magnitude of the torque.
#[derive(Clone, Copy)]
struct Node {
    line: u64,
    speed: f64,
    torque: f64,
    temperature: f64,
    voltage: f64,
    loss: f64,
    /// Current, power factor and modulation; zero if the file has none.
    phase: [f64; 3],
}

const SPEED: usize = 0;
const TORQUE: usize = 1;
const EFFICIENCY: usize = 2;
const LOSS: usize = 3;
const TEMPERATURE: usize = 4;
const VOLTAGE: usize = 5;
const PHASE: [usize; 3] = [6, 7, 8];

const QUANTITIES: [Wanted; 9] = [
    ("speed", "rpm"),
    ("torque", "Nm"),
    ("efficiency", "-"),
    ("loss", "W"),
    ("temperature", "degC"),
    ("voltage", "V"),
    ("current", "A"),
    ("power_factor", "-"),
    ("modulation", "-"),
];

/// Fix for a wrong header.
const COLUMNS: &str = "a map has columns `speed [rpm],torque [Nm],loss [W]`, or `efficiency [-]`; others are stated by `{ file: ..., columns: ..., units: ... }`";

/// Minimum share of stated nodes of a grid; below it, speeds or torques of the rows differ that should be equal.
const LEAST_FILLED: f64 = 0.3;

impl MotorMap {
    /// Reads the bytes of a CSV file, a workbook or an MDF file: `speed [rpm]`, `torque [Nm]`, `efficiency [-]` or `loss [W]`, and optionally `temperature
    /// [degC]`, `voltage [V]` of the DC link, and `current [A]` (root mean square), `power_factor [-]` and `modulation [-]` of the inverter. If both are given, the loss is used. Rows with an efficiency and without speed or torque carry no information and
    /// are skipped.
    ///
    /// # Errors
    /// The problem, with line and column.
    pub fn read(bytes: &[u8]) -> Result<Self, Vec<MeasuredFault>> {
        Self::read_stated(&TableFile::Name(String::new()), bytes)
    }

    /// As [`MotorMap::read`], of a file whose columns, units and form may be stated.
    ///
    /// # Errors
    /// As [`MotorMap::read`].
    pub fn read_stated(file: &TableFile, bytes: &[u8]) -> Result<Self, Vec<MeasuredFault>> {
        let stated = file.stated();
        let sheet = Sheet::open(bytes, &stated.form, &QUANTITIES, stated.assigned());
        let sheet = sheet.map_err(|faults| match file {
            TableFile::Name(_) => in_header(faults),
            TableFile::Stated(_) => faults,
        })?;
        Self::from_sheet(&sheet).map_err(|faults| sheet.table.placed(faults))
    }

    fn from_sheet(sheet: &Sheet) -> Result<Self, Vec<MeasuredFault>> {
        let mut lacks = Vec::new();
        for (place, what) in [(SPEED, "speed"), (TORQUE, "torque")] {
            if !sheet.holds(place) {
                lacks.push(lacking(sheet, &format!("the {what}")));
            }
        }
        if !sheet.holds(EFFICIENCY) && !sheet.holds(LOSS) {
            lacks.push(lacking(sheet, "the efficiency or the loss"));
        }
        let of_phase = PHASE.iter().filter(|place| sheet.holds(**place)).count();
        if of_phase > 0 && of_phase < PHASE.len() {
            let what = ["the current", "the power factor", "the modulation"];
            let missing = PHASE.iter().zip(what).filter(|(place, _)| !sheet.holds(**place));
            lacks.extend(missing.map(|(_, what)| {
                let help = "state `current [A]`, `power_factor [-]` and `modulation [-]`, or none of them";
                fault(sheet.lacks(what, "").message, help)
            }));
        }
        if !lacks.is_empty() {
            return Err(lacks);
        }
        let mut quadrants = [Vec::new(), Vec::new()];
        let mut faulty = Vec::new();
        let mut silent = 0;
        for row in 0..sheet.table.rows.len() {
            match node(sheet, row) {
                Ok(Some((node, generating))) => quadrants[usize::from(generating)].push(node),
                Ok(None) => silent += 1,
                Err(reason) => faulty.push(reason),
            }
        }
        if !faulty.is_empty() {
            return Err(limited_faults(faulty, CELL_HELP));
        }
        let mut notes = sheet.notes.clone();
        if silent > 0 {
            notes.push(format!(
                "{silent} rows without speed or torque skipped: an efficiency defines no loss there"
            ));
        }
        let [mut motoring, mut generating] = quadrants;
        if generating.is_empty() {
            notes.push("no negative torques: generating has the losses of motoring at the same torque".to_owned());
        } else {
            // Zero torque is the border of both parts.
            generating.extend(motoring.iter().filter(|node| node.torque == 0.0).copied());
        }
        two_of_each(&motoring, "motoring").map_err(|f| vec![f])?;
        if !generating.is_empty() {
            two_of_each(&generating, "generating").map_err(|f| vec![f])?;
            let between = between_signs(&motoring, &generating);
            if !between.is_empty() {
                notes.push(format!(
                    "no loss at 0 Nm at {} speeds: linear between the smallest torques of both signs",
                    rising(between.iter().map(|node| node.speed)).len()
                ));
            }
            motoring.extend(&between);
            generating.extend(&between);
        }
        let of = |nodes: &[Node], what: &str, value: fn(&Node) -> f64| {
            Quadrant::from_nodes(nodes, what, value).map_err(|f| vec![f])
        };
        let quadrant = |nodes: &[Node], what: &str| of(nodes, what, |node| node.loss);
        let phase = if of_phase == 0 {
            None
        } else {
            let both = |nodes: &[Node], what: &str| -> Result<[Quadrant; 3], Vec<MeasuredFault>> {
                Ok([
                    of(nodes, what, |node| node.phase[0])?,
                    of(nodes, what, |node| node.phase[1])?,
                    of(nodes, what, |node| node.phase[2])?,
                ])
            };
            let own = if generating.is_empty() { &motoring } else { &generating };
            Some([both(&motoring, "motoring")?, both(own, "generating")?])
        };
        Ok(Self {
            phase,
            motoring: quadrant(&motoring, "motoring")?,
            generating: if generating.is_empty() {
                None
            } else {
                Some(quadrant(&generating, "generating")?)
            },
            notes,
        })
    }

    /// The loss at a speed \[rad/s\], a torque \[Nm\] and a temperature \[degC\], which a map without temperatures ignores. Torque
    /// against the speed is generating. In a map with temperatures each quadrant uses those of its own rows.
    pub fn loss(&self, speed: f64, torque: f64, temperature: f64) -> MotorLoss {
        self.loss_at(&MotorAt {
            speed,
            torque,
            temperature,
            voltage: self.any_voltage(),
        })
    }

    /// As [`MotorMap::loss`], also at a DC voltage, which a map without voltages ignores.
    pub fn loss_at(&self, at: &MotorAt) -> MotorLoss {
        if at.speed == 0.0 && at.torque == 0.0 {
            return MotorLoss {
                loss: 0.0,
                outside: false,
            };
        }
        let generating = at.speed * at.torque < 0.0;
        let quadrant = self
            .generating
            .as_ref()
            .filter(|_| generating)
            .unwrap_or(&self.motoring);
        quadrant.loss(at)
    }

    /// Current, power factor and modulation; `None` if the file has none. The power factor has the sign of the power.
    pub fn phase(&self, at: &MotorAt) -> Option<PhaseCurrent> {
        let [motoring, generating] = self.phase.as_ref()?;
        let generates = at.speed * at.torque < 0.0;
        let [current, power_factor, modulation] = if generates { generating } else { motoring };
        let power_factor = power_factor.loss(at).loss.abs();
        Some(PhaseCurrent {
            current: current.loss(at).loss,
            power_factor: if generates { -power_factor } else { power_factor },
            modulation: modulation.loss(at).loss,
        })
    }

    /// True if the file states current, power factor and modulation.
    pub fn has_phase(&self) -> bool {
        self.phase.is_some()
    }

    /// True if the file has several temperatures.
    pub fn has_temperatures(&self) -> bool {
        self.motoring.temperatures.is_some()
    }

    /// First and last DC voltage, if the file has several. \[V\]
    pub fn voltages(&self) -> Option<(f64, f64)> {
        self.motoring.voltages
    }

    /// Voltage of a map that ignores it, or the first.
    fn any_voltage(&self) -> f64 {
        self.motoring.voltages.map_or(0.0, |(first, _)| first)
    }

    /// Largest speed of the map \[rad/s\], and its largest torque at a speed in the direction of a torque \[Nm\].
    pub fn reach(&self, speed: f64, torque: f64) -> [f64; 2] {
        let generating = self.generating.as_ref().filter(|_| speed * torque < 0.0);
        let (speeds, torques) = &generating.unwrap_or(&self.motoring).reach;
        [speeds[speeds.len() - 1], clamped(speeds, torques, speed.abs())]
    }

    /// How far a speed \[rad/s\] and a torque \[Nm\] are outside the map, relative to its border; zero inside. \[-\]
    pub fn excess(&self, speed: f64, torque: f64) -> f64 {
        let generating = speed * torque < 0.0;
        let quadrant = self
            .generating
            .as_ref()
            .filter(|_| generating)
            .unwrap_or(&self.motoring);
        let (speeds, torques) = &quadrant.reach;
        let excess = |x: f64, most: f64| if x > most * (1.0 + 1e-9) { x / most - 1.0 } else { 0.0 };
        let of_speed = excess(speed.abs(), speeds[speeds.len() - 1]);
        of_speed.max(excess(torque.abs(), clamped(speeds, torques, speed.abs())))
    }

    /// The nodes of the motoring map, including filled corners: speed \[rad/s\], torque \[Nm\], temperature \[degC\] if the map has
    /// it, and loss \[W\].
    pub fn nodes(&self) -> Vec<(Vec<f64>, f64)> {
        self.motoring.table.points()
    }
}

/// A map that is named only must have its units in the header.
fn in_header(faults: Vec<MeasuredFault>) -> Vec<MeasuredFault> {
    let unit = |f: MeasuredFault| {
        // A map has no `units` of its own.
        if f.help.contains("`units") {
            fault(f.message, COLUMNS)
        } else {
            f
        }
    };
    faults.into_iter().map(unit).collect()
}

fn lacking(sheet: &Sheet, what: &str) -> MeasuredFault {
    let missing = sheet.lacks(what, "");
    fault(missing.message, COLUMNS)
}

/// A node and whether it is generating; `None` if an efficiency defines no loss.
fn node(sheet: &Sheet, row: usize) -> Result<Option<(Node, bool)>, String> {
    let speed = sheet.not_negative(row, SPEED)?.unwrap_or(0.0);
    let torque = sheet.number(row, TORQUE)?.unwrap_or(0.0);
    let power = (speed * torque).abs();
    let loss = if sheet.holds(LOSS) {
        sheet.not_negative(row, LOSS)?.unwrap_or(0.0)
    } else {
        let efficiency = sheet.number(row, EFFICIENCY)?.unwrap_or(1.0);
        if power == 0.0 {
            return Ok(None);
        }
        let least = if torque < 0.0 { 0.0 } else { 1e-3 };
        if !(least..=1.0).contains(&efficiency) {
            return Err(format!(
                "{}: an efficiency of {efficiency}; it must be between 0 and 1, or 0 and 100 %",
                sheet.describe_cell(row, EFFICIENCY)
            ));
        }
        if torque < 0.0 {
            power * (1.0 - efficiency)
        } else {
            power * (1.0 / efficiency - 1.0)
        }
    };
    let node = Node {
        line: sheet.line(row),
        speed,
        torque: torque.abs(),
        temperature: sheet.number(row, TEMPERATURE)?.unwrap_or(0.0),
        voltage: sheet.not_negative(row, VOLTAGE)?.unwrap_or(0.0),
        loss,
        phase: [
            sheet.not_negative(row, PHASE[0])?.unwrap_or(0.0),
            sheet.number(row, PHASE[1])?.unwrap_or(0.0),
            sheet.not_negative(row, PHASE[2])?.unwrap_or(0.0),
        ],
    };
    Ok(Some((node, torque < 0.0)))
}

/// Refuses a part that has one speed or one torque.
fn two_of_each(nodes: &[Node], what: &str) -> Result<(), MeasuredFault> {
    let count = |value: fn(&Node) -> f64| rising(nodes.iter().map(value)).len();
    let (speeds, torques) = (count(|n| n.speed), count(|n| n.torque));
    if speeds < 2 || torques < 2 {
        return Err(fault(
            format!("the {what} part has {speeds} speeds and {torques} torques; a map requires two of each"),
            "add rows",
        ));
    }
    Ok(())
}

/// Nodes at zero torque where the rows have none but reach both signs, linear between the smallest torques of each sign.
fn between_signs(motoring: &[Node], generating: &[Node]) -> Vec<Node> {
    let [positive, negative] = [motoring, generating].map(smallest_torques);
    let both = positive.iter().filter_map(|(key, a)| Some((a, negative.get(key)?)));
    both.filter(|(a, _)| a.torque > 0.0)
        .map(|(a, b)| {
            let between =
                |a_value: f64, b_value: f64| (a_value * b.torque + b_value * a.torque) / (a.torque + b.torque);
            Node {
                torque: 0.0,
                loss: between(a.loss, b.loss),
                phase: std::array::from_fn(|i| between(a.phase[i].abs(), b.phase[i].abs())),
                ..**a
            }
        })
        .collect()
}

/// The node of the smallest torque at each speed, temperature and voltage.
fn smallest_torques(nodes: &[Node]) -> BTreeMap<[u64; 3], &Node> {
    let mut smallest = BTreeMap::new();
    for node in nodes {
        let least = smallest
            .entry([node.speed, node.temperature, node.voltage].map(f64::to_bits))
            .or_insert(node);
        if node.torque < least.torque {
            *least = node;
        }
    }
    smallest
}

/// The distinct values, increasing.
fn rising(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    // Products with the factor of a unit may differ in their last digit.
    values.dedup_by(|b, a| (*b - *a).abs() <= 1e-9 * a.abs());
    values
}

/// Index of a value among the distinct ones.
fn place(values: &[f64], x: f64) -> usize {
    let after = values.partition_point(|v| *v < x - 1e-9 * x.abs());
    after.min(values.len() - 1)
}

impl Quadrant {
    fn from_nodes(nodes: &[Node], what: &str, value: fn(&Node) -> f64) -> Result<Self, MeasuredFault> {
        let speeds = rising(nodes.iter().map(|n| n.speed));
        let torques = rising(nodes.iter().map(|n| n.torque));
        let temperatures = rising(nodes.iter().map(|n| n.temperature));
        let voltages = rising(nodes.iter().map(|n| n.voltage));
        // Each temperature at each voltage is a layer; voltages vary fastest.
        let (m, k) = (torques.len(), temperatures.len() * voltages.len());
        let count = speeds.len().saturating_mul(m).saturating_mul(k);
        if (nodes.len() as f64) < LEAST_FILLED * count as f64 {
            let of_voltages = if voltages.len() > 1 {
                format!(" and {} voltages", voltages.len())
            } else {
                String::new()
            };
            return Err(fault(
                format!(
                    "the {what} part has {} rows for {} speeds, {m} torques and {} temperatures{of_voltages}, which is not a grid",
                    nodes.len(),
                    speeds.len(),
                    temperatures.len()
                ),
                "write the same torques at each speed; omit those that the motor does not reach",
            ));
        }
        let mut cells: Vec<Option<Node>> = vec![None; count];
        for node in nodes {
            let (i, j) = (place(&speeds, node.speed), place(&torques, node.torque));
            let layer = place(&temperatures, node.temperature) * voltages.len() + place(&voltages, node.voltage);
            let cell = &mut cells[(i * m + j) * k + layer];
            if let Some(first) = cell {
                return Err(fault(
                    format!(
                        "line {}: this speed and torque are already in line {}",
                        node.line, first.line
                    ),
                    "remove one of them",
                ));
            }
            *cell = Some(*node);
        }
        let reach: Vec<f64> = (0..speeds.len())
            .map(|i| {
                let held = (0..m)
                    .rev()
                    .find(|j| (0..k).any(|t| cells[(i * m + j) * k + t].is_some()));
                held.map_or(0.0, |j| torques[j])
            })
            .collect();
        let values = filled(&cells, [speeds.len(), m, k], value).map_err(|layer| {
            let temperature = temperatures[layer / voltages.len()];
            let at_voltage = if voltages.len() > 1 {
                format!(" and {} V", voltages[layer % voltages.len()])
            } else {
                String::new()
            };
            fault(
                format!("the {what} part has a speed without any row at {temperature} degC{at_voltage}"),
                "write the same speeds at each temperature and voltage",
            )
        })?;
        let axis = |name: &str, unit: &str, values: &[f64]| Axis {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: values.to_vec(),
        };
        let mut axes = vec![axis("speed", "rad/s", &speeds), axis("torque", "Nm", &torques)];
        if temperatures.len() > 1 {
            axes.push(axis("temperature", "degC", &temperatures));
        }
        if voltages.len() > 1 {
            axes.push(axis("voltage", "V", &voltages));
        }
        let reading = Reading {
            outside: Outside::Clamp,
            interpolation: Interpolation::Linear,
            ..Reading::default()
        };
        let table = Table::from_grid(axes, values, &reading).map_err(|reason| fault(reason, "correct the map"))?;
        let ends = |values: &[f64]| (values.len() > 1).then(|| (values[0], values[values.len() - 1]));
        Ok(Self {
            table,
            reach: (speeds, reach),
            temperatures: ends(&temperatures),
            voltages: ends(&voltages),
        })
    }

    fn loss(&self, at: &MotorAt) -> MotorLoss {
        let (speed, torque) = (at.speed.abs(), at.torque.abs());
        let mut point = [speed, torque, at.temperature, at.voltage];
        if self.temperatures.is_none() {
            point[2] = at.voltage;
        }
        // A clamped table is defined at every number; NaN is treated as the start of the map.
        let loss = self.table.value(&point[..self.table.axes().len()]).unwrap_or(0.0);
        let (speeds, torques) = &self.reach;
        let beyond = |x: f64, most: f64| x > most * (1.0 + 1e-9);
        let leaves = |ends: Option<(f64, f64)>, x: f64| ends.is_some_and(|(first, last)| x < first || x > last);
        let outside = beyond(speed, speeds[speeds.len() - 1])
            || beyond(torque, clamped(speeds, torques, speed))
            || leaves(self.temperatures, at.temperature)
            || leaves(self.voltages, at.voltage);
        MotorLoss { loss, outside }
    }
}

/// Losses of all cells. An empty cell takes the value of the nearest smaller torque at its speed and temperature, or, below all, of
/// the nearest larger one. The fault is the index of a layer, a temperature at a voltage, at which a speed has no row.
fn filled(
    cells: &[Option<Node>],
    [speeds, torques, layers]: [usize; 3],
    value: fn(&Node) -> f64,
) -> Result<Vec<f64>, usize> {
    let mut values = Vec::with_capacity(cells.len());
    for i in 0..speeds {
        for j in 0..torques {
            for t in 0..layers {
                let at = |j: usize| cells[(i * torques + j) * layers + t];
                let node = (0..=j).rev().find_map(at).or_else(|| (j..torques).find_map(at));
                values.push(value(&node.ok_or(t)?));
            }
        }
    }
    Ok(values)
}

#[cfg(test)]
mod tests;
