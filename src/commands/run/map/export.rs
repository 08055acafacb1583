//! Tables of losses for other programs, one file for each gear state.
//!
//! Sources of the formats: VECTO's user manual (Transmission Loss Map), the Powertrain Blockset's block Gearbox, and the
//! documentation of `Modelica.Mechanics.Rotational.Components.LossyGear`.

use gearloss_studies::analysis::{Given, Statistics, held};
use gearloss_studies::study::{Export, MapEntry};

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::write::keep;
use super::kept::Whole;
use super::plan::Planned;
use super::{Axes, Map, tidy};
use crate::output::Failure;

/// Writes the tables, and says in lines what a reader has to know.
pub fn write(runner: &Runner<'_>, name: &str, entry: &MapEntry, maps: &[Map<'_>]) -> Result<Vec<String>, Failure> {
    let mut lines = Vec::new();
    for export in &entry.export {
        lines.extend(write_one(runner, name, *export, entry.lossy_gear_limit, maps)?);
    }
    Ok(lines)
}

/// Refuses, before anything is computed, grids that a table cannot hold.
pub fn check(runner: &Runner<'_>, name: &str, entry: &MapEntry, planned: &[Planned<'_>]) -> Result<(), Failure> {
    let path = format!("analyses.{name}.export");
    let conditions = &runner.study.entry.conditions;
    for export in &entry.export {
        for plan in planned {
            let t = &plan.built.transmission;
            let reference = &t.ports()[t.reference_port()].name;
            if [&conditions.torque_at, &conditions.speed_at] != [reference, reference] {
                let message = format!("a table for another program gives torque and speed at `{reference}`");
                let mend = format!("write `torque_at: {reference}` and `speed_at: {reference}` under `conditions`");
                return Err(runner.wrong(&path, message, &mend));
            }
            fits(*export, &plan.axes).map_err(|(message, mend)| runner.wrong(&path, message, mend))?;
        }
    }
    Ok(())
}

/// Whether a table can have these axes; else what is wrong and what helps.
fn fits(export: Export, axes: &Axes) -> Result<(), (&'static str, &'static str)> {
    let Axes { torques, speeds, .. } = axes;
    let rising = |list: &[f64]| list.windows(2).all(|w| w[0] < w[1]);
    if !rising(torques) || !rising(speeds) {
        return Err((
            "a table for another program needs torques and speeds that rise",
            "sort the axes of the grid",
        ));
    }
    let drives = torques.iter().any(|torque| *torque > 0.0);
    match export {
        Export::Vecto if !(drives && torques.contains(&0.0) && torques.iter().any(|t| *t < 0.0)) => Err((
            "VECTO needs rows below, at and above zero torque",
            "let the torques of the grid run from below zero, through zero, to above",
        )),
        Export::Matlab if torques.len() < 2 || speeds.len() < 2 => Err((
            "a table needs two torques and two speeds at least",
            "give the grid more points",
        )),
        Export::LossyGear if !drives || speeds.iter().all(|speed| *speed <= 0.0) => Err((
            "`LossyGear` needs torques and speeds above zero",
            "give the grid speeds and torques above zero",
        )),
        Export::Vecto | Export::Matlab | Export::LossyGear => Ok(()),
    }
}

fn write_one(
    runner: &Runner<'_>,
    name: &str,
    export: Export,
    limit: f64,
    maps: &[Map<'_>],
) -> Result<Vec<String>, Failure> {
    let path = format!("analyses.{name}.export");
    let mut lines = Vec::new();
    for (i, map) in maps.iter().enumerate() {
        let Some(whole) = &map.kept.whole else { continue };
        if export == Export::Matlab && whole.has_gaps() {
            let message = "an efficiency over a grid with an envelope would be zero beyond it";
            return Err(runner.wrong(&path, message, "give a grid without envelope"));
        }
        let table = Table { map, whole };
        // Maps that differ in bound values have a number each; the temperatures of one table stand in one file.
        let same = |m: &&Map<'_>| m.built.name == map.built.name && m.gear == map.gear;
        let siblings: Vec<&Map<'_>> = maps.iter().filter(same).collect();
        let number = maps[..i].iter().filter(same).count() + 1;
        let mut file = format!("{name}-{}-{}", map.built.name, map.gear).replace('/', "-");
        if siblings.len() > 1 && export != Export::Matlab {
            file.push_str(&format!("-{number}"));
        }
        let missed = between(runner, &table)?;
        let (file, text) = match export {
            Export::Vecto => (format!("{file}.vtlm"), table.vecto()),
            Export::Matlab if number > 1 => continue,
            Export::Matlab => (format!("{file}.m"), matlab(&siblings)),
            Export::LossyGear => {
                // Modelica wants the file to be called as what it holds.
                let letters = file.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
                let name: String = "losses_".chars().chain(letters).collect();
                let ends = Ends::solve(runner, &table)?;
                (format!("{name}.mo"), table.lossy_gear(&name, &ends, limit))
            }
        };
        let (text, said) = text.map_err(|(message, help)| runner.wrong(&path, message, &help))?;
        keep(runner.run, &file, Ok(text.into_bytes()))?;
        lines.push(format!("{file}: {said}{missed}"));
    }
    Ok(lines)
}

/// Loss torques at points of a map's gear state, in their order; absent where there is none. \[Nm\]
fn loss_torques(runner: &Runner<'_>, table: &Table<'_>, list: Vec<Given>) -> Result<Vec<Option<f64>>, Failure> {
    let points = runner.listed(&table.map.built.transmission, &table.map.gear, list);
    let mut losses = Vec::new();
    runner.solve_pieces(&table.map.built, &points, None, &held, &mut |piece| {
        losses.extend(piece.points().map(|p| p.loss_torque));
        Ok(())
    })?;
    Ok(losses)
}

/// How far straight lines between the points of a table are from the loss torque half way between them.
fn between(runner: &Runner<'_>, table: &Table<'_>) -> Result<String, Failure> {
    let axes = &table.whole.axes;
    let (mut list, mut means) = (Vec::new(), Vec::new());
    for i in 0..axes.torques.len().saturating_sub(1) {
        for k in 0..axes.speeds.len().saturating_sub(1) {
            let corners = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(a, b)| table.whole.loss_torque(i + a, k + b));
            let sum: Option<f64> = corners.into_iter().sum();
            let Some(sum) = sum else { continue };
            list.push(Given {
                torque: 0.5 * (axes.torques[i] + axes.torques[i + 1]),
                speed: 0.5 * (axes.speeds[k] + axes.speeds[k + 1]),
                oil: None,
            });
            means.push(0.25 * sum);
        }
    }
    if list.is_empty() {
        return Ok(String::new());
    }
    let losses = loss_torques(runner, table, list)?;
    let gaps = means
        .into_iter()
        .zip(losses)
        .filter_map(|(mean, loss)| Some(mean - loss?));
    let gaps = Statistics::of(gaps);
    Ok(gaps.map_or_else(String::new, |g| {
        let worst = g.greatest.abs().max(g.least.abs());
        format!(
            "; between its points the table of the map misses the loss torque by {worst:.4} Nm at most, {:.4} Nm rms",
            g.rms
        )
    }))
}

/// Text of a file and what to print about it, or what is wrong and what helps.
type Written = Result<(String, String), (String, String)>;

/// A map with its axes.
struct Table<'a> {
    map: &'a Map<'a>,
    whole: &'a Whole,
}

impl Table<'_> {
    /// Loss torque over speed and torque, both at the side of the engine.
    fn vecto(&self) -> Written {
        let torques = &self.whole.axes.torques;
        let mut text = "Input Speed [rpm],Input Torque [Nm],Torque Loss [Nm]\n".to_owned();
        let (mut rows, mut left) = (0, 0);
        for w in 0..self.whole.axes.speeds.len() {
            for t in 0..torques.len() {
                // Where nothing turns or a loss has no value there is no loss torque.
                match self.whole.loss_torque(t, w) {
                    Some(loss) => {
                        let speed = tidy(self.whole.axes.speeds[w] * RPM);
                        text.push_str(&format!("{speed:.2},{:.4},{loss:.6}\n", torques[t]));
                        rows += 1;
                    }
                    None => left += 1,
                }
            }
        }
        if rows < 4 {
            return Err((
                format!("VECTO needs four rows at least, and {rows} have a loss"),
                "give the grid more points".to_owned(),
            ));
        }
        let mut said = format!("{rows} rows, for VECTO's engineering mode");
        if left > 0 {
            said.push_str(&format!("; {left} points without a loss torque are left out"));
        }
        Ok((text, said))
    }

    /// Points of one side at a speed by its number: the magnitude of the torque and the loss torque, neither of them zero. \[Nm\]
    fn side(&self, speed: usize, sign: f64) -> Vec<(f64, f64)> {
        let torques = self.whole.axes.torques.iter().enumerate();
        torques
            .filter(|(_, torque)| sign * **torque > 0.0)
            .filter_map(|(t, torque)| Some((torque.abs(), self.whole.loss_torque(t, speed)?)))
            .filter(|(_, loss)| *loss > 0.0)
            .collect()
    }

    /// Efficiency and friction over speed: straight lines of the loss torque over torque from the no-load loss, drive and coast
    /// apart.
    fn lossy_gear(&self, name: &str, ends: &Ends, limit: f64) -> Written {
        let (mut rows, mut missed): (Vec<[f64; 5]>, _) = (Vec::new(), Missed::default());
        let (mut coasts, mut skipped) = (false, 0);
        for (w, speed) in self.whole.axes.speeds.iter().copied().enumerate() {
            let [drive, coast] = [1.0, -1.0].map(|sign| self.side(w, sign));
            if speed <= 0.0 || drive.is_empty() {
                continue;
            }
            let Some(no_load) = ends.no_load[w] else {
                skipped += 1;
                continue;
            };
            let slope = slope_from(no_load, &drive);
            // Without a coast side its losses are taken as those of the drive side.
            let slope_2 = if coast.is_empty() {
                slope
            } else {
                slope_from(no_load, &coast)
            };
            coasts |= !coast.is_empty();
            for (sign, points, slope) in [(1.0, &drive, slope), (-1.0, &coast, slope_2)] {
                let line = |torque: f64| slope * torque + no_load;
                for (torque, loss) in points {
                    missed.add_point(sign * torque, speed, line(*torque), *loss);
                }
                let rated = ends.rated[usize::from(sign < 0.0)][w];
                if let Some(loss) = rated.filter(|loss| *loss > 0.0 && !points.is_empty()) {
                    missed.add_rated(speed, line(ends.torque), loss);
                }
            }
            if slope >= 1.0 {
                return Err((
                    format!(
                        "at {:.0} rpm losses grow as fast as the torque, which `LossyGear` cannot represent",
                        speed * RPM
                    ),
                    "omit torques at which no power comes out".to_owned(),
                ));
            }
            // The library's equations: loss = (1 - eta1) T + f1 where a drives, loss = (1 - 1 / eta2) T + f2 where b does.
            rows.push([speed, 1.0 - slope, 1.0 / (1.0 + slope_2), no_load, no_load]);
        }
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let Some(first) = rows.first().copied() else {
            return Err((
                "no speed above zero has a torque above zero with a loss".to_owned(),
                "give the grid speeds and torques above zero".to_owned(),
            ));
        };
        if missed.share.0 > limit {
            return Err((
                format!(
                    "the straight lines of `LossyGear` miss the loss torque by {:.1} % at {} Nm, {:.0} rpm, above the limit of {} %",
                    100.0 * missed.share.0,
                    tidy(missed.share.1),
                    missed.share.2 * RPM,
                    tidy(100.0 * limit)
                ),
                format!(
                    "narrow the torques and speeds of the grid, export `matlab` or `vecto`, or accept it by \
                     `lossy_gear_limit: {}`",
                    (100.0 * missed.share.0).ceil() / 100.0
                ),
            ));
        }
        // The table has to begin at rest.
        rows.insert(0, [0.0, first[1], first[2], first[3], first[4]]);
        let mut said = format!("{} speeds; {}", rows.len() - 1, missed.words(ends));
        if !coasts {
            said.push_str("; no coast side in the grid, the drive side is used for it");
        }
        if skipped > 0 {
            said.push_str(&format!("; {skipped} speeds without a no-load loss are omitted"));
        }
        let body: Vec<String> = rows
            .iter()
            .map(|r| format!("    {:.6}, {:.8}, {:.8}, {:.8}, {:.8}", r[0], r[1], r[2], r[3], r[4]))
            .collect();
        Ok((
            format!(
                "record {name} \"Losses of gear {} by gearloss {}\"\n  // |w_a| rad/s, mesh efficiency drive and coast, bearing friction drive and coast Nm.\n  \
                 // {said}\n  constant Real lossTable[{}, 5] = [\n{}];\nend {name};\n",
                self.map.gear,
                env!("CARGO_PKG_VERSION"),
                rows.len(),
                body.join(";\n")
            ),
            said,
        ))
    }
}

/// Loss torques at the ends of the straight lines, which the grid need not have, for each of its speeds.
struct Ends {
    /// The rated torque; without a rating the largest of the grid. \[Nm\]
    torque: f64,
    /// Whether it is that of the rating.
    is_rating: bool,
    /// At zero torque. \[Nm\]
    no_load: Vec<Option<f64>>,
    /// At the torque above, drive and coast. \[Nm\]
    rated: [Vec<Option<f64>>; 2],
}

impl Ends {
    fn solve(runner: &Runner<'_>, table: &Table<'_>) -> Result<Self, Failure> {
        let axes = &table.whole.axes;
        let rating = table.map.built.transmission.rating.map(|rating| rating.torque);
        let largest = axes.torques.iter().fold(0.0, |largest: f64, t| largest.max(t.abs()));
        let torque = rating.unwrap_or(largest);
        let at = |torque: f64| {
            let given = |speed: &f64| Given {
                torque,
                speed: *speed,
                oil: None,
            };
            loss_torques(runner, table, axes.speeds.iter().map(given).collect())
        };
        Ok(Self {
            torque,
            is_rating: rating.is_some(),
            no_load: at(0.0)?,
            rated: [at(torque)?, at(-torque)?],
        })
    }
}

/// How far straight lines are from loss torques.
#[derive(Default)]
struct Missed {
    /// The largest share of the loss torque among the points of the grid, with its torque in Nm and speed in rad/s.
    share: (f64, f64, f64),
    squares: f64,
    points: f64,
    /// At the rated torque the largest gap in Nm, as a share of the loss torque, and its speed in rad/s.
    rated: Option<(f64, f64, f64)>,
}

impl Missed {
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

    fn words(&self, ends: &Ends) -> String {
        let mut words = "straight lines from the no-load loss miss the loss torque by 0 Nm at zero torque".to_owned();
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

/// Slope, not below zero, of the straight line from the no-load loss that has the smallest squares of relative deviations from
/// points of torque and loss torque, so that part load counts as much as full load.
fn slope_from(no_load: f64, points: &[(f64, f64)]) -> f64 {
    let (mut above, mut below) = (0.0, 0.0);
    for (torque, loss) in points {
        let weighted = torque / loss;
        above += weighted * (loss - no_load) / loss;
        below += weighted * weighted;
    }
    (above / below).max(0.0)
}

/// Efficiency and loss torque over torque, speed and, where several were computed, oil temperature, as vectors of a script.
fn matlab(maps: &[&Map<'_>]) -> Written {
    let mut slabs: Vec<(Option<f64>, &Map<'_>)> = maps.iter().map(|map| (map.oil.given(), *map)).collect();
    let several = slabs.len() > 1;
    if several && slabs.iter().any(|(oil, _)| oil.is_none()) {
        return Err((
            "a table over oil temperature needs given temperatures, not a balance".to_owned(),
            "fix the temperature, or bind `thermal.mode: [fixed]` and `thermal.oil: [40 degC, 80 degC]` in the grid"
                .to_owned(),
        ));
    }
    slabs.sort_by(|a, b| a.0.unwrap_or(0.0).total_cmp(&b.0.unwrap_or(0.0)));
    if slabs.windows(2).any(|w| w[0].0 == w[1].0) {
        return Err((
            "two maps of one table have the same oil temperature".to_owned(),
            "bind nothing but `thermal.oil` in its grid".to_owned(),
        ));
    }
    let Some(Whole { axes, .. }) = &slabs[0].1.kept.whole else {
        return Err(("the map has no grid".to_owned(), "give `grid`".to_owned()));
    };
    // Where nothing turns there is no loss torque: a table cannot have that speed.
    let turns = |w: &usize| {
        let mut wholes = slabs.iter().filter_map(|(_, map)| map.kept.whole.as_ref());
        wholes.any(|whole| (0..axes.torques.len()).any(|t| whole.loss_torque(t, *w).is_some()))
    };
    let columns: Vec<usize> = (0..axes.speeds.len()).filter(turns).collect();
    if columns.len() < 2 {
        return Err((
            "a table needs two speeds with a loss torque at least".to_owned(),
            "give the grid more speeds above zero".to_owned(),
        ));
    }
    let list = |values: &mut dyn Iterator<Item = f64>| values.map(|x| format!("{x}")).collect::<Vec<_>>().join(" ");
    // A table of one value for each place, with a third index where there are several temperatures.
    let table = |name: &str, empty: &str, value: fn(&Whole, usize, usize) -> Option<f64>| {
        let (mut text, mut missing) = (String::new(), 0);
        for (k, (_, map)) in slabs.iter().enumerate() {
            let Some(whole) = &map.kept.whole else { continue };
            let slab = if several {
                format!("(:,:,{})", k + 1)
            } else {
                String::new()
            };
            text.push_str(&format!("{name}{slab} = [\n"));
            for t in 0..whole.axes.torques.len() {
                let row = columns.iter().map(|w| {
                    let value = value(whole, t, *w);
                    missing += usize::from(value.is_none());
                    value.map_or_else(|| empty.to_owned(), |x| format!("{x}"))
                });
                text.push_str(&format!("  {};\n", row.collect::<Vec<_>>().join(" ")));
            }
            text.push_str("];\n");
        }
        (text, missing)
    };
    let (eta, without_output) = table("eta_tbl", "0", Whole::efficiency);
    let (loss, without_loss) = table("loss_tbl", "", Whole::loss_torque);
    if without_loss > 0 {
        return Err((
            format!("{without_loss} points of the grid have no loss torque, and a table has no holes"),
            "omit torques and speeds at which the transmission locks itself or a loss is undefined".to_owned(),
        ));
    }
    let mut said = format!("{} torques, {} speeds, ", axes.torques.len(), columns.len());
    let omitted = axes.speeds.len() - columns.len();
    if omitted > 0 {
        said.push_str(&format!("{omitted} speed without a loss torque omitted, "));
    }
    said.push_str(&match slabs[0].0 {
        _ if several => format!("{} oil temperatures", slabs.len()),
        Some(oil) => format!("no axis of temperature: all at {} degC", tidy(oil)),
        None => "no axis of temperature: each point at its own, found by balance".to_owned(),
    });
    if without_output > 0 {
        said.push_str(&format!(
            "; efficiency zero at {without_output} points at which no power comes out"
        ));
    }
    let temperatures = if several {
        let kelvin = &mut slabs.iter().filter_map(|(oil, _)| Some((*oil)? + 273.15));
        format!("Temp_bpts = [{}]; % K\n", list(kelvin))
    } else {
        String::new()
    };
    let text = format!(
        "% Losses of gear {}, by gearloss {}. {said}.\n% eta_tbl: power out over power in, drive and coast; loss_tbl: loss over the speed of the reference port, Nm; \
         rows are torques, columns are speeds.\nTrq_bpts = [{}]; % Nm\nomega_bpts = [{}]; % rad/s\n{temperatures}{eta}{loss}",
        maps[0].gear,
        env!("CARGO_PKG_VERSION"),
        list(&mut axes.torques.iter().copied()),
        list(&mut columns.iter().map(|w| axes.speeds[*w])),
    );
    Ok((text, said))
}
