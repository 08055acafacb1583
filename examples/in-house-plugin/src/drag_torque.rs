//! An analysis of our own crate: the torque that turns the unloaded gearbox over the temperature of its oil, and the ratio of the torques
//! with cold and with warm oil.

use gearloss::report::page::Page;
use gearloss::report::register_view;
use gearloss::studies::prelude::*;

/// Torque that turns the unloaded gearbox, over the temperature of the oil.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct DragTorqueEntry {
    /// Gearbox, gear and model sets.
    #[serde(flatten)]
    pub chosen: Chosen,
    /// Speed at the port that the conditions name. [rpm]
    #[schemars(range(min = 1.0, max = 1e6))]
    pub speed: f64,
    /// Temperatures of the oil.
    pub oil_temperature: TemperatureAxis,
}

register_analysis!(DragTorqueEntry);

/// Drag torques of each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DragTorqueOutcome {
    /// Analysis, gearboxes and files of the result.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub sets: Vec<DragTorqueOfSet>,
}

/// Drag torques of one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DragTorqueOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Torque at the first temperature over that at the last. [-]
    pub cold_over_warm: Option<f64>,
    /// One for each temperature.
    pub torques: Vec<DragTorque>,
    /// Notes of the models.
    pub notes: Vec<Note>,
}

/// The drag torque at one temperature.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct DragTorque {
    /// Temperature of the oil. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Torque that turns the unloaded gearbox; absent if a loss has no value. [Nm]
    pub torque_nm: Option<f64>,
}

impl Analysis for DragTorqueEntry {
    const TYPE: &'static str = "drag_torque";
    type Plan<'a> = Runs<'a>;
    type Outcome = DragTorqueOutcome;

    fn uses(&self) -> Uses<'_> {
        self.chosen.uses()
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<Runs<'a>, Stopped> {
        let built = self.chosen.built(cx)?;
        let path = format!("{}.oil_temperature", cx.path());
        let temperatures = axis(cx, &path, self.oil_temperature.values())?;
        Runs::of_sets(&built, |b| {
            Run::new(cx, b, self.points(cx, &b.transmission, &temperatures))
        })
    }

    fn reduce<'a>(&'a self, plan: Runs<'a>, engine: &Engine<'a>) -> Result<DragTorqueOutcome, Stopped> {
        let solved = engine.solve_all(&plan)?;
        Ok(DragTorqueOutcome {
            head: engine.head(&plan.built()),
            sets: plan
                .0
                .iter()
                .zip(&solved)
                .map(|(run, solved)| of_set(run, solved))
                .collect(),
        })
    }
}

impl DragTorqueEntry {
    /// The turned port has the speed; no torque acts on the others.
    fn points(&self, cx: &Planner<'_>, t: &Transmission, temperatures: &[f64]) -> Points {
        let given = |oil: &f64| Given {
            oil: Some(*oil),
            ..Given::new(0.0, self.speed)
        };
        let list = temperatures.iter().map(given).collect();
        let mut points = cx.listed(t, self.chosen.gear(t), list);
        let names = t.ports().iter().map(|port| port.name.clone());
        points.torque_at = names.filter(|port| !points.speed_at.contains(port)).collect();
        points
    }
}

fn of_set(run: &Run<'_>, solved: &GridResult) -> DragTorqueOfSet {
    let torque = |point: &PointResult| DragTorque {
        oil_temperature_degc: point.oil,
        torque_nm: point.loss.map(|loss| loss / point.speed),
    };
    let torques: Vec<DragTorque> = solved.points.iter().map(torque).collect();
    let ends = torques.first().zip(torques.last());
    DragTorqueOfSet {
        model_set: run.built.name.clone(),
        cold_over_warm: ends.and_then(|(first, last)| Some(first.torque_nm? / last.torque_nm?)),
        torques,
        notes: notes(&run.built.transmission, &solved.seen),
    }
}

impl Outcome for DragTorqueOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let table = Table::of_each(&self.head.analysis, &self.sets, |set| &set.torques)
            .text("model_set", "Model set", |(set, _)| &set.model_set)
            .fields("oil_temperature_degc torque_nm", |(_, at)| at);
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        self.sets.iter().flat_map(|set| &set.notes).collect()
    }
}

// Without a view, the terminal and the report show the tables.
register_view!(DragTorqueOutcome, show);

fn show(outcome: &DragTorqueOutcome, page: &mut Page) {
    page.tables(&outcome.tables());
    // The result in one sentence, for the terminal and the first screen of the report, and the number to remember.
    for set in &outcome.sets {
        if let Some(ratio) = set.cold_over_warm {
            let models = &set.model_set;
            page.headline = Some(format!("cold oil takes {ratio:.2} times the torque, models {models}"));
            page.key_figure(
                "torque of cold over warm oil",
                format!("{ratio:.2}"),
                "",
                models.as_str(),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use gearloss::api::{Disk, Language, StudyRun, read_study};

    use super::*;

    /// Cold oil causes a higher drag torque, and the ratio is that of the first and the last torque.
    #[test]
    fn the_torque_is_the_loss_over_the_speed() {
        let language = Language::linked().expect("all that is linked fits");
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/study.yaml");
        let study = read_study(&language, &Disk::shared(), file).expect("the study is right");
        let outcome = StudyRun::new(&language, &study).analysis("drag").expect("it runs");
        let typed: &DragTorqueOutcome = outcome.get().expect("it is an outcome of this analysis");
        let [set] = &typed.sets[..] else {
            panic!("one model set: {typed:?}");
        };
        let torques: Vec<f64> = set.torques.iter().filter_map(|at| at.torque_nm).collect();
        assert_eq!(torques.len(), 4, "{set:?}");
        assert!(
            torques.windows(2).all(|pair| pair[0] > pair[1]),
            "cold oil drags more: {torques:?}"
        );
        let ratio = torques[0] / torques[3];
        assert!(
            set.cold_over_warm
                .is_some_and(|measured| (measured - ratio).abs() < 1e-12)
        );
    }
}
