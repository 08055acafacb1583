//! Tables for `LossyGear` of the Modelica Standard Library.
//!
//! Source: documentation of `Modelica.Mechanics.Rotational.Components.LossyGear`.

use gearloss_studies::analyses::map::{Axes, ExportFile, ExportFormat, ExportMap, LossGrid, MapOf, Refusal};
use gearloss_studies::numbers::{RPM, tidy};
use gearloss_studies::points::Given;
use gearloss_studies::register_export;

register_export!(LossyGear);

struct LossyGear;

impl ExportFormat for LossyGear {
    fn name(&self) -> &'static str {
        "lossy_gear"
    }

    fn meaning(&self) -> &'static str {
        "Efficiency and bearing friction over speed for `LossyGear` of the Modelica Standard Library: straight lines from the no-load \
         loss, a fit by relative deviation."
    }

    fn takes(&self, of: MapOf) -> Result<(), Refusal> {
        if of.is_gearbox() {
            return Ok(());
        }
        Err(Refusal::new(
            format!(
                "`LossyGear` connects two shafts by a ratio, and its losses vanish without speed; the losses{} are between the DC link and a \
                 shaft, and machines lose at standstill too",
                of.words()
            ),
            "export `lossy_gear` of a map without `of`, and `modelica` or `fmu3` of the machines (`of: machine`)",
        ))
    }

    fn fits(&self, axes: &Axes) -> Result<(), Refusal> {
        let above = |list: &[f64]| list.iter().any(|x| *x > 0.0);
        if above(&axes.torques) && above(&axes.speeds) {
            Ok(())
        } else {
            Err(Refusal::new(
                "`LossyGear` needs torques and speeds above zero",
                "give the grid speeds and torques above zero",
            ))
        }
    }

    /// The ends of the straight lines for each speed: at zero torque, and at the maximum torque in drive and in coast.
    fn further_points(&self, grid: &LossGrid, rated: Option<f64>) -> Vec<Given> {
        let torque = rated.unwrap_or(largest(grid));
        let at = |torque: f64| {
            let given = move |speed: &f64| Given {
                torque,
                speed: *speed,
                oil: None,
            };
            grid.axes.speeds.iter().map(given)
        };
        at(0.0).chain(at(torque)).chain(at(-torque)).collect()
    }

    fn file(&self, map: &ExportMap<'_>) -> Result<Option<ExportFile>, Refusal> {
        // Modelica requires that the file has the name of the record.
        let name = map.own_name();
        let letters = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
        let name: String = "losses_".chars().chain(letters).collect();
        let (text, about) = table(map, &name)?;
        Ok(Some(ExportFile {
            name: format!("{name}.mo"),
            bytes: text.into_bytes(),
            about,
        }))
    }
}

/// The largest torque of a grid. [Nm]
fn largest(grid: &LossGrid) -> f64 {
    grid.axes
        .torques
        .iter()
        .fold(0.0, |largest: f64, t| largest.max(t.abs()))
}

/// Loss torques at the ends of the straight lines for each speed of the grid; the grid need not contain these torques.
struct Ends<'a> {
    /// The rated torque; without a rating the largest torque of the grid. [Nm]
    torque: f64,
    /// Whether `torque` is the rated torque.
    is_rating: bool,
    /// At zero torque. [Nm]
    no_load: &'a [Option<f64>],
    /// At the torque above, drive and coast. [Nm]
    rated: [&'a [Option<f64>]; 2],
}

impl<'a> Ends<'a> {
    fn new(map: &ExportMap<'a>) -> Self {
        let count = map.grid.axes.speeds.len();
        let rated = map.map.export.rated;
        Self {
            torque: rated.unwrap_or(largest(map.grid)),
            is_rating: rated.is_some(),
            no_load: &map.further[..count],
            rated: [&map.further[count..2 * count], &map.further[2 * count..]],
        }
    }
}

/// Magnitude of torque and loss torque of the points of one side at speed `i`, zeros excluded. [Nm]
fn side(grid: &LossGrid, speed: usize, sign: f64) -> Vec<(f64, f64)> {
    let torques = grid.axes.torques.iter().enumerate();
    torques
        .filter(|(_, torque)| sign * **torque > 0.0)
        .filter_map(|(t, torque)| Some((torque.abs(), grid.loss_torque(t, speed)?)))
        .filter(|(_, loss)| *loss > 0.0)
        .collect()
}

/// A row of the table: speed, mesh efficiency in drive and coast, friction in drive and coast.
type Row = [f64; 5];

/// The text of the table and its description. Drive and coast have separate straight lines of loss torque over torque, which start at the
/// no-load loss.
fn table(map: &ExportMap<'_>, name: &str) -> Result<(String, String), Refusal> {
    let ends = Ends::new(map);
    let (mut rows, mut missed): (Vec<Row>, _) = (Vec::new(), Missed::default());
    let (mut coasts, mut skipped) = (false, 0);
    for (w, speed) in map.grid.axes.speeds.iter().copied().enumerate() {
        let [drive, coast] = [1.0, -1.0].map(|sign| side(map.grid, w, sign));
        if speed <= 0.0 || drive.is_empty() {
            continue;
        }
        let Some(no_load) = ends.no_load[w] else {
            skipped += 1;
            continue;
        };
        coasts |= !coast.is_empty();
        let slopes = slopes(no_load, &drive, &coast);
        missed.add(&ends, (w, speed), no_load, [(&drive, slopes[0]), (&coast, slopes[1])]);
        rows.push(row(speed, no_load, slopes)?);
    }
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let Some(first) = rows.first().copied() else {
        return Err(Refusal::new(
            "no speed above zero has a torque above zero with a loss",
            "give the grid speeds and torques above zero",
        ));
    };
    missed.stays_below(map.outcome.lossy_gear_limit)?;
    // The table must begin at speed zero.
    rows.insert(0, [0.0, first[1], first[2], first[3], first[4]]);
    let mut about = format!("{} speeds; {}", rows.len() - 1, missed.words(&ends));
    if !coasts {
        about.push_str("; the grid has no coast side, so the drive side is used for both");
    }
    if skipped > 0 {
        about.push_str(&format!("; {skipped} speeds without a no-load loss are omitted"));
    }
    let body: Vec<String> = rows
        .iter()
        .map(|r| format!("    {:.6}, {:.8}, {:.8}, {:.8}, {:.8}", r[0], r[1], r[2], r[3], r[4]))
        .collect();
    let text = format!(
        "record {name} \"Losses of gear {} by gearloss {}\"\n  // |w_a| rad/s, mesh efficiency drive and coast, bearing friction drive and coast Nm.\n  \
         // {about}\n  constant Real lossTable[{}, 5] = [\n{}];\nend {name};\n",
        map.map.gear,
        env!("CARGO_PKG_VERSION"),
        rows.len(),
        body.join(";\n")
    );
    Ok((text, about))
}

/// Slopes of the straight lines in drive and coast. Without a coast side in the grid the losses of the drive side apply to both.
fn slopes(no_load: f64, drive: &[(f64, f64)], coast: &[(f64, f64)]) -> [f64; 2] {
    let slope = slope_from(no_load, drive);
    let coast = if coast.is_empty() {
        slope
    } else {
        slope_from(no_load, coast)
    };
    [slope, coast]
}

/// The row of a speed by the library's equations: loss = (1 - eta1) T + f1 if flange a drives, loss = (1 - 1 / eta2) T + f2 if flange b
/// drives.
fn row(speed: f64, no_load: f64, [drive, coast]: [f64; 2]) -> Result<Row, Refusal> {
    if drive >= 1.0 {
        return Err(Refusal::new(
            format!(
                "at {:.0} rpm the loss grows as fast as the torque, which `LossyGear` cannot represent",
                speed * RPM
            ),
            "omit torques without output power",
        ));
    }
    Ok([speed, 1.0 - drive, 1.0 / (1.0 + coast), no_load, no_load])
}

/// Deviation of the straight lines from the loss torques.
#[derive(Default)]
struct Missed {
    /// The largest relative deviation among the grid points, with its torque in Nm and speed in rad/s.
    share: (f64, f64, f64),
    squares: f64,
    points: f64,
    /// The largest deviation at the rated torque in Nm, as a fraction of the loss torque, and its speed in rad/s.
    rated: Option<(f64, f64, f64)>,
}

impl Missed {
    /// Adds the points of speed `i` and the ends of its lines.
    fn add(
        &mut self,
        ends: &Ends<'_>,
        (place, speed): (usize, f64),
        no_load: f64,
        [drive, coast]: [(&[(f64, f64)], f64); 2],
    ) {
        for (sign, (points, slope)) in [(1.0, drive), (-1.0, coast)] {
            let line = |torque: f64| slope * torque + no_load;
            for (torque, loss) in points {
                self.add_point(sign * torque, speed, line(*torque), *loss);
            }
            let rated = ends.rated[usize::from(sign < 0.0)][place];
            if let Some(loss) = rated.filter(|loss| *loss > 0.0 && !points.is_empty()) {
                self.add_rated(speed, line(ends.torque), loss);
            }
        }
    }

    /// Rejects a table whose lines deviate from a point by more than the limit.
    fn stays_below(&self, limit: f64) -> Result<(), Refusal> {
        let (share, torque, speed) = self.share;
        if share <= limit {
            return Ok(());
        }
        Err(Refusal::new(
            format!(
                "the straight lines of `LossyGear` deviate from the loss torque by {:.1} % at {} Nm, {:.0} rpm; the limit is {} %",
                100.0 * share,
                tidy(torque),
                speed * RPM,
                tidy(100.0 * limit)
            ),
            format!(
                "narrow the torques and speeds of the grid, export `matlab` or `vecto`, or accept it by \
                 `lossy_gear_limit: {}`",
                (100.0 * share).ceil() / 100.0
            ),
        ))
    }

    fn add_point(&mut self, torque: f64, speed: f64, line: f64, loss: f64) {
        let share = line / loss - 1.0;
        self.squares += share * share;
        self.points += 1.0;
        if share.abs() > self.share.0 {
            self.share = (share.abs(), torque, speed);
        }
    }

    fn add_rated(&mut self, speed: f64, line: f64, loss: f64) {
        let share = line / loss - 1.0;
        if self.rated.is_none_or(|(_, worst, _)| share.abs() > worst.abs()) {
            self.rated = Some((line - loss, share, speed));
        }
    }

    fn words(&self, ends: &Ends<'_>) -> String {
        let mut words =
            "straight lines from the no-load loss deviate from the loss torque by 0 Nm at zero torque".to_owned();
        if let Some((gap, share, speed)) = self.rated {
            let which = if ends.is_rating { "rated" } else { "the largest" };
            words.push_str(&format!(
                ", by {gap:.4} Nm ({:.1} %, {:.0} rpm) at {which} torque {} Nm",
                100.0 * share,
                speed * RPM,
                tidy(ends.torque)
            ));
        }
        let (share, torque, speed) = self.share;
        words.push_str(&format!(
            ", by at most {:.1} % ({} Nm, {:.0} rpm), {:.1} % rms over the grid",
            100.0 * share,
            tidy(torque),
            speed * RPM,
            100.0 * f64::sqrt(self.squares / self.points.max(1.0))
        ));
        words
    }
}

/// Non-negative slope of the straight line from the no-load loss with the least squares of relative deviations, so that part load has the
/// same weight as full load.
fn slope_from(no_load: f64, points: &[(f64, f64)]) -> f64 {
    let (mut above, mut below) = (0.0, 0.0);
    for (torque, loss) in points {
        let weighted = torque / loss;
        above += weighted * (loss - no_load) / loss;
        below += weighted * weighted;
    }
    (above / below).max(0.0)
}
