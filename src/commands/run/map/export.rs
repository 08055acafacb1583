//! Tables of losses for other programs, one file for each gear state.
//!
//! Sources of the formats: VECTO's user manual (Transmission Loss Map), the Powertrain Blockset's block Gearbox, and the
//! documentation of `Modelica.Mechanics.Rotational.Components.LossyGear`.

use gearloss_framework::analysis::{Given, Statistics, held};
use gearloss_framework::study::Export;

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::write::keep;
use super::kept::Whole;
use super::{Map, tidy};
use crate::output::Failure;

/// Writes the tables, and says in lines what a reader has to know.
pub fn write(runner: &Runner<'_>, name: &str, export: Export, maps: &[Map<'_>]) -> Result<Vec<String>, Failure> {
    let path = format!("analyses.{name}.export");
    let conditions = &runner.study.entry.conditions;
    let mut lines = Vec::new();
    for (i, map) in maps.iter().enumerate() {
        let t = &map.built.transmission;
        let reference = &t.ports()[t.reference_port()].name;
        if [&conditions.torque_at, &conditions.speed_at] != [reference, reference] {
            let message = format!("a table for another program gives torque and speed at `{reference}`");
            let mend = format!("write `torque_at: {reference}` and `speed_at: {reference}` under `conditions`");
            return Err(runner.wrong(&path, message, &mend));
        }
        let Some(whole) = &map.kept.whole else { continue };
        let axes = &whole.axes;
        let rising = |list: &[f64]| list.windows(2).all(|w| w[0] < w[1]);
        if !rising(&axes.torques) || !rising(&axes.speeds) {
            let message = "a table for another program needs torques and speeds that rise";
            return Err(runner.wrong(&path, message, "sort the axes of the grid"));
        }
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
                (format!("{name}.mo"), table.lossy_gear(&name))
            }
        };
        let (text, said) = text.map_err(|(message, mend)| runner.wrong(&path, message, mend))?;
        keep(runner, &file, Ok(text.into_bytes()))?;
        lines.push(format!("{file}: {said}{missed}"));
    }
    Ok(lines)
}

/// How far straight lines between the points of a table are from the loss torque half way between them.
fn between(runner: &Runner<'_>, table: &Table<'_>) -> Result<String, Failure> {
    let (axes, t) = (&table.whole.axes, &table.map.built.transmission);
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
    let points = runner.listed(t, &table.map.gear, list);
    let (mut gaps, mut means) = (Vec::new(), means.into_iter());
    runner.solve_pieces(&table.map.built, &points, None, &held, &mut |piece| {
        let pairs = piece.points().zip(means.by_ref());
        gaps.extend(pairs.filter_map(|(p, mean)| Some(mean - p.loss_torque?)));
        Ok(())
    })?;
    let gaps = Statistics::of(gaps);
    Ok(gaps.map_or_else(String::new, |g| {
        let worst = g.greatest.abs().max(g.least.abs());
        format!(
            "; between its points the table of the map misses the loss torque by {worst:.4} Nm at most, {:.4} Nm rms",
            g.rms
        )
    }))
}

/// Text of a file and what to say of it, or what is wrong and how to mend it.
type Written = Result<(String, String), (String, &'static str)>;

/// A map with its axes.
struct Table<'a> {
    map: &'a Map<'a>,
    whole: &'a Whole,
}

impl Table<'_> {
    /// Loss torque over speed and torque, both at the side of the engine.
    fn vecto(&self) -> Written {
        let torques = &self.whole.axes.torques;
        if !(torques.iter().any(|t| *t < 0.0) && torques.contains(&0.0) && torques.iter().any(|t| *t > 0.0)) {
            return Err((
                "VECTO needs rows below, at and above zero torque".to_owned(),
                "let the torques of the grid run from below zero, through zero, to above",
            ));
        }
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
                "give the grid more points",
            ));
        }
        let mut said = format!("{rows} rows, for VECTO's engineering mode");
        if left > 0 {
            said.push_str(&format!("; {left} points without a loss torque are left out"));
        }
        Ok((text, said))
    }

    /// Efficiency and friction over speed: straight lines of the loss torque over torque, drive and coast apart.
    fn lossy_gear(&self, name: &str) -> Written {
        let (mut rows, mut worst, mut square, mut count): (Vec<[f64; 5]>, _, _, _) = (Vec::new(), 0.0_f64, 0.0, 0.0);
        let mut coasts = false;
        for w in 0..self.whole.axes.speeds.len() {
            let speed = self.whole.axes.speeds[w];
            let side = |sign: f64| -> Vec<(f64, f64)> {
                (0..self.whole.axes.torques.len())
                    .filter(|t| sign * self.whole.axes.torques[*t] >= 0.0)
                    .filter_map(|t| Some((self.whole.axes.torques[t].abs(), self.whole.loss_torque(t, w)?)))
                    .collect()
            };
            let drive = side(1.0);
            if speed <= 0.0 || drive.len() < 2 {
                continue;
            }
            let coast = side(-1.0);
            let (slope, base) = line(&drive);
            // Without a coast side its losses are taken as those of the drive side.
            let (slope_2, base_2) = if coast.len() < 2 { (slope, base) } else { line(&coast) };
            coasts |= coast.len() >= 2;
            for (points, slope, base) in [(&drive, slope, base), (&coast, slope_2, base_2)] {
                for (torque, loss) in points {
                    let gap = slope * torque + base - loss;
                    worst = worst.max(gap.abs());
                    square += gap * gap;
                    count += 1.0;
                }
            }
            if slope >= 1.0 {
                return Err((
                    format!(
                        "at {:.0} rpm losses grow as fast as the torque, which `LossyGear` cannot take",
                        speed * RPM
                    ),
                    "leave torques out at which nothing comes out",
                ));
            }
            // The library's equations: loss = (1 - eta1) T + f1 where a drives, loss = (1 - 1 / eta2) T + f2 where b does.
            rows.push([speed, 1.0 - slope, 1.0 / (1.0 + slope_2), base, base_2]);
        }
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let Some(first) = rows.first().copied() else {
            return Err((
                "no speed above zero has two torques with a loss".to_owned(),
                "give the grid speeds above zero and several torques from zero on",
            ));
        };
        // The table has to begin at rest.
        rows.insert(0, [0.0, first[1], first[2], first[3], first[4]]);
        let rms = if count > 0.0 { f64::sqrt(square / count) } else { 0.0 };
        let said = format!(
            "{} speeds; the straight lines miss the loss torque by {worst:.4} Nm at most, {rms:.4} Nm rms{}",
            rows.len() - 1,
            if coasts {
                ""
            } else {
                "; no coast side in the grid, the drive side stands for it"
            }
        );
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

/// Slope and value at zero of the straight line through points, neither below zero; least squares.
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let sxx: f64 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    let sxy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let slope = if sxx > 0.0 { (sxy / sxx).max(0.0) } else { 0.0 };
    let base = y - slope * x;
    if base >= 0.0 {
        return (slope, base);
    }
    let through_zero = points.iter().map(|p| p.0 * p.1).sum::<f64>() / points.iter().map(|p| p.0 * p.0).sum::<f64>();
    (through_zero, 0.0)
}

/// Efficiency over torque, speed and oil temperature, as vectors of a script.
fn matlab(maps: &[&Map<'_>]) -> Written {
    let mut slabs: Vec<(f64, &Map<'_>)> = Vec::new();
    for map in maps {
        match map.oil.given() {
            Some(oil) => slabs.push((oil, map)),
            None => {
                return Err((
                    "a table over oil temperature needs given temperatures, not a balance".to_owned(),
                    "fix the temperature, or bind `thermal.mode: [fixed]` and `thermal.oil: [40 degC, 80 degC]` in the grid",
                ));
            }
        }
    }
    slabs.sort_by(|a, b| a.0.total_cmp(&b.0));
    if slabs.windows(2).any(|w| w[0].0 == w[1].0) {
        return Err((
            "two maps of one table have the same oil temperature".to_owned(),
            "bind nothing but `thermal.oil` in its grid",
        ));
    }
    let one = slabs.len() == 1;
    if one {
        // Interpolating blocks want two break points.
        let (oil, map) = slabs[0];
        slabs = vec![(oil - 50.0, map), (oil + 50.0, map)];
    }
    let Some(Whole { axes, .. }) = &slabs[0].1.kept.whole else {
        return Err(("the map has no grid".to_owned(), "give `grid`"));
    };
    if axes.speeds.len() < 2 || axes.torques.len() < 2 {
        return Err((
            "a table needs two torques and two speeds at least".to_owned(),
            "give the grid more points",
        ));
    }
    let list = |values: &mut dyn Iterator<Item = f64>| values.map(|x| format!("{x}")).collect::<Vec<_>>().join(" ");
    let mut empty = 0;
    let mut eta = String::new();
    for (k, (_, map)) in slabs.iter().enumerate() {
        let Some(whole) = &map.kept.whole else { continue };
        let axes = &whole.axes;
        eta.push_str(&format!("eta_tbl(:,:,{}) = [\n", k + 1));
        for t in 0..axes.torques.len() {
            let row = (0..axes.speeds.len()).map(|w| {
                let eta = whole.efficiency(t, w);
                empty += usize::from(eta.is_none());
                eta.unwrap_or(0.0)
            });
            eta.push_str(&format!("  {};\n", list(&mut row.collect::<Vec<_>>().into_iter())));
        }
        eta.push_str("];\n");
    }
    let mut said = format!(
        "{} torques, {} speeds, {} oil temperatures",
        axes.torques.len(),
        axes.speeds.len(),
        slabs.len()
    );
    if one {
        said.push_str("; one temperature, written twice because blocks want two");
    }
    if empty > 0 {
        said.push_str(&format!("; zero at {empty} points at which no power comes out"));
    }
    let text = format!(
        "% Efficiency of gear {}, by gearloss {}. {said}.\n% Power out over power in, drive and coast; rows are torques, columns are speeds.\n\
         Trq_bpts = [{}]; % Nm\nomega_bpts = [{}]; % rad/s\nTemp_bpts = [{}]; % K\neta_tbl = zeros({}, {}, {});\n{eta}",
        maps[0].gear,
        env!("CARGO_PKG_VERSION"),
        list(&mut axes.torques.iter().copied()),
        list(&mut axes.speeds.iter().copied()),
        list(&mut slabs.iter().map(|(oil, _)| oil + 273.15)),
        axes.torques.len(),
        axes.speeds.len(),
        slabs.len(),
    );
    Ok((text, said))
}
