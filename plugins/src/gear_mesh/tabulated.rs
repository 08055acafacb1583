//! The loss of another model, computed beforehand and interpolated.
//!
//! Derived. Friction of films that warm themselves costs some thousand times what a closed formula does, and a drive cycle asks
//! for it thousands of times. This model asks the other one at some hundred nodes when it is first needed and interpolates from
//! then on. What is interpolated is the loss over the power, which is bounded and smooth, over the logarithms of speed, torque
//! and viscosity, by cubic splines (de Boor). Over the viscosity friction bends evenly, over the temperature it does not; and
//! splines keep a bend to where it is, which Chebyshev polynomials carry through the whole table.
//! With `ehl_mixed` on two stages of an electric axle and the usual nodes the error is 0.5 % rms and 4 % at most; over 20 to 12000
//! rpm, 1 to 300 Nm and 0 to 120 degC it is 0.15 and 1.2 %.
//! Where the temperatures of the gears' bodies are known and the other model looks at them, a second table runs over their mean,
//! with oil and both bodies equally warm; the heat that passes between bodies that differ is tabulated as a conduction, and
//! what goes into the first gear is bounded as `ehl_mixed` bounds it. Rolling friction in the other model follows the oil and not
//! the bodies: the stated error then says how far that is off.
//! The error is found, not assumed: the other model is asked again in the middles of cells spread over the table, and, where
//! bodies are known, with oil up to 30 K colder and bodies up to 20 K apart. Each point notes what was found, and whether the
//! other model leaves ranges that its sources state at the nearest node.
//! Beyond the ends of the table, and for a mesh without an oil of its own, the other model itself is asked. The terms of the other
//! model are one. The table holds for either sense of rotation and either driving gear, which the models that it may stand
//! for do not look at. A gearbox that is built anew, as in a study of its parameters, builds its tables anew, each in the time
//! of some 500 points, or 1000 where bodies are known; with fewer points than that the other model alone is quicker.

pub mod spline;
pub mod table;

#[cfg(test)]
mod tests;

use std::sync::OnceLock;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::PLACE;
use gearloss_framework::loss::{Limit, Loss, Observed, Term, Undefined};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshModel, MeshPart};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use table::{Asked, Extents, Table};

const TOTAL: Term = Term::load(0, "total");

const LEFT: Limit = Limit::new(
    1,
    "ranges left at the nearest node",
    "-",
    0.0,
    0.0,
    "what the sources of the tabulated model state; ask it alone to see which",
);

const GREATEST: Observed = Observed::new(0, "greatest error", "%", "Greatest error of the table at its checks.");
const RMS: Observed = Observed::new(
    1,
    "rms error",
    "%",
    "Root mean square of the error of the table at its checks.",
);
const SHARE: Observed = Observed::new(
    2,
    "error of the heat share",
    "-",
    "Greatest error at the checks of the share of the heat that goes into the first gear.",
);

/// Models that are as quick as a table.
const QUICK: [&str; 6] = ["none", "constant", "formula", "table", "efficiency", "tabulated"];

/// Tangential force over module and face width up to which a table reaches where nothing is stated: what teeth of hardened
/// steel bear at most, rounded. \[Pa\]
const BORNE: f64 = 200e6;

/// The loss of another model, computed beforehand and interpolated.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// The model whose loss is tabulated.
    pub of: ModelRef<GearMesh>,
    /// Least and greatest speed of the first gear, in either sense. [rpm]
    #[serde(default = "speeds")]
    #[schemars(inner(range(min = 1e-3, max = 1e6)))]
    pub speeds: [f64; 2],
    /// Least and greatest torque of the first gear; absent, up to a tangential force of 200 N/mm2 times module and face width, and
    /// down to a thousandth of it. [Nm]
    #[schemars(inner(range(min = 1e-6, max = 1e7)))]
    pub torques: Option<[f64; 2]>,
    /// Least and greatest temperature of the oil, or the mean of both bodies. [degC]
    #[serde(default = "temperatures")]
    #[schemars(inner(range(min = -60.0, max = 250.0)))]
    pub temperatures: [f64; 2],
    /// Number of nodes over speed, torque and temperature. [-]
    #[serde(default = "nodes")]
    #[schemars(inner(range(min = 4, max = 40)))]
    pub nodes: [u32; 3],
    /// Number of points between the nodes at which the error is found. [-]
    #[serde(default = "checks")]
    #[schemars(range(min = 1, max = 10000))]
    pub checks: u32,
}

fn speeds() -> [f64; 2] {
    [10.0, 20000.0].map(|rpm| rpm * (std::f64::consts::PI / 30.0))
}
fn temperatures() -> [f64; 2] {
    [-20.0, 140.0]
}
fn nodes() -> [u32; 3] {
    [8, 8, 6]
}
fn checks() -> u32 {
    100
}

struct Tabulated {
    of: Slot<GearMesh>,
    extents: Extents,
    nodes: [usize; 3],
    checks: u32,
    /// Once it was needed.
    over_oil: OnceLock<Result<Table, Undefined>>,
    /// Once it was needed; none where the model does not look at bodies.
    over_bodies: OnceLock<Option<Result<Table, Undefined>>>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Tabulated, Diagnostic> {
    let name = params.of.value.as_str().or_else(|| params.of.value["type"].as_str());
    if let Some(quick) = name.filter(|name| QUICK.contains(name)) {
        return Err(cx
            .error(format!("`{quick}` is as quick itself as a table of it"))
            .help(format!("write `type: {quick}` in place of `tabulated`")));
    }
    let of = cx.slot("of", &params.of)?;
    let part = cx.part::<GearMesh>().ok_or_else(|| cx.error("bug: no pair"))?;
    let extents = Extents {
        speeds: params.speeds,
        torques: params.torques.unwrap_or_else(|| torques(part)),
        temperatures: params.temperatures,
    };
    for (key, [least, greatest]) in [
        ("speeds", extents.speeds),
        ("torques", extents.torques),
        ("temperatures", extents.temperatures),
    ] {
        if least >= greatest {
            return Err(cx
                .error(format!("`{key}` does not rise from its first to its second value"))
                .help("write the least and then the greatest"));
        }
    }
    if let Some(oil) = &part.oil {
        let [cold, hot] = extents.temperatures.map(|t| oil.lubricant.eta(t));
        if !(cold.is_finite() && hot > 0.0 && cold > hot) {
            return Err(cx
                .error(format!(
                    "the viscosity of `{}` does not fall over `temperatures`",
                    oil.id
                ))
                .help("narrow `temperatures` to where the oil's law of viscosity holds"));
        }
    }
    Ok(Tabulated {
        of,
        extents,
        nodes: params.nodes.map(|n| n as usize),
        checks: params.checks,
        over_oil: OnceLock::new(),
        over_bodies: OnceLock::new(),
    })
}

/// Torques of the first gear for which a pair is made. \[Nm\]
fn torques(part: &MeshPart) -> [f64; 2] {
    let pair = &part.pair;
    let most = BORNE * pair.normal_module * pair.facewidth * pair.working_radius[0];
    [1e-3 * most, most]
}

impl Tabulated {
    /// The table for a point, built when it is first needed, and the temperatures over whose mean it runs.
    fn table(&self, at: &GearMeshAt<'_>, asked: &Asked<'_>) -> Result<(&Table, [f64; 2]), Undefined> {
        let build = |known| Table::new(asked, &self.extents, self.nodes, self.checks, known);
        if let Some([first, second]) = at.bodies() {
            let table = self
                .over_bodies
                .get_or_init(|| asked.follows_bodies(&self.extents).then(|| build(true)));
            if let Some(table) = table {
                return built(table).map(|table| (table, [first, second]));
            }
        }
        built(self.over_oil.get_or_init(|| build(false))).map(|table| (table, [at.temperature; 2]))
    }

    /// The loss of the tabulated model itself, as one term.
    fn itself(&self, at: &GearMeshAt<'_>) -> Result<Loss, Undefined> {
        let loss = self.of.loss(&at.nested(&self.of))?;
        Ok(Loss::POWERS
            .with(&TOTAL, loss.total_watts(at.speed))
            .heats_first(loss.first_heat()))
    }
}

/// The table, or why there is none.
fn built(table: &Result<Table, Undefined>) -> Result<&Table, Undefined> {
    table.as_ref().map_err(|inside| Undefined {
        what: "the tabulated model inside of its table (narrow `speeds`, `torques` or `temperatures`), which has no value at",
        value: inside.value,
    })
}

impl GearMeshModel for Tabulated {
    fn loss(&self, at: &GearMeshAt<'_>) -> Result<Loss, Undefined> {
        if at.speed == 0.0 || at.torque == 0.0 {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let Some(oil) = &at.part.oil else {
            at.branch("no oil of its own: the tabulated model itself");
            return self.itself(at);
        };
        let asked = Asked {
            model: &self.of,
            part: at.part,
            lubricant: &oil.lubricant,
        };
        let (table, [first, second]) = self.table(at, &asked)?;
        let speed = at.speed.abs();
        let place = table.place([speed, at.torque, 0.5 * (first + second)], &oil.lubricant);
        let farthest = place.iter().fold(
            0.5,
            |far: f64, x| if (x - 0.5).abs() > (far - 0.5).abs() { *x } else { far },
        );
        if !(0.0..=1.0).contains(&at.check(&PLACE, farthest)) {
            at.branch("beyond the ends of the table: the tabulated model itself");
            return self.itself(at);
        }
        let input = at.show("P_in", "W", at.torque * speed);
        let read = table.read(place, input, first - second);
        at.check(&LEFT, read.left);
        at.observe(&GREATEST, 100.0 * table.errors.greatest);
        at.observe(&RMS, 100.0 * table.errors.rms);
        at.observe(&SHARE, table.errors.share);
        Ok(Loss::POWERS
            .with(&TOTAL, at.show("P", "W", read.watts))
            .heats_first(read.first_heat))
    }
}

register!(GearMesh, "tabulated", Params,
    source: "derived; splines after de Boor, A Practical Guide to Splines",
    example: "{ type: tabulated, of: { type: path_integral, tooth_friction: { type: xu } } }",
    evidence: [
        formula(Evidence::Derived, "interpolates the other model, with the error found beside it"),
        default_of("speeds", Evidence::Assumed, "from creeping to the fastest electric motors"),
        default_of("torques", Evidence::Assumed, "beyond what hardened teeth bear"),
        default_of("temperatures", Evidence::Assumed, "of most gearboxes"),
        default_of("nodes", Evidence::Derived, "leave some 0.5 % rms with `ehl_mixed` on two stages of an electric axle"),
        default_of("checks", Evidence::Derived, "of other points some 1 % err more than the greatest of 100"),
    ],
    limits: [PLACE, LEFT], terms: [TOTAL], observed: [GREATEST, RMS, SHARE], prepare: prepare);
