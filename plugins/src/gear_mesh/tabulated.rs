//! Precomputed, interpolated loss of another mesh model.
//!
//! Derived. A thermal film friction model costs about a thousand times as much as a closed formula, and a drive cycle evaluates it
//! thousands of times. This model evaluates the other one at some hundred nodes when it is first needed and interpolates
//! afterwards. It interpolates the loss over the power, which is bounded and smooth, over the logarithms of speed, torque and
//! viscosity, by cubic splines (de Boor). Friction is a smoother function of viscosity than of temperature. Splines keep a kink
//! local; Chebyshev polynomials spread it over the whole table. With `ehl_mixed` on two stages of an electric axle and the default
//! nodes the error is 0.5 % rms and 4 % at most; over 20 to 12000 rpm, 1 to 300 Nm and 0 to 120 degC it is 0.15 and 1.2 %. If the
//! body temperatures of the gears are known and the other model uses them, a second table uses their mean, with oil and both bodies
//! at equal temperature. The heat between bodies at different temperatures is tabulated as a conductance, and the heat into the
//! first gear is bounded as in `ehl_mixed`. Rolling friction in the other model depends on the oil and not on the bodies; the
//! stated error includes this. The error is measured, not assumed: the other model is evaluated again at cell centres across the
//! table and, if the body temperatures are known, with oil up to 30 K colder and bodies up to 20 K apart. Each operating point
//! notes the measured error, and whether the nearest node is outside the ranges stated for the other model. Outside the table, and
//! for a mesh without its own oil, the other model is evaluated directly. Its terms are combined into one. The table holds for both
//! directions of rotation and for either driving gear; the tabulated models do not depend on them. A rebuilt gearbox, as in a
//! parameter study, rebuilds its tables. Each takes the time of about 500 points, or 1000 with known body temperatures; for fewer
//! points direct evaluation is faster.

pub mod spline;
pub mod table;

#[cfg(test)]
mod tests;

use std::sync::OnceLock;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::PLACE;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshModel, MeshPart};
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, default_of, formula};
use gearloss_framework::{limits, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use table::{DirectModel, Extents, Table};

terms! { TOTAL = load("total"); }

limits! {
    after PLACE;
    LEFT = ("N", "number of ranges that the tabulated model leaves", "-", 0.0, 0.0,
        "ranges of the tabulated model; evaluate it directly to see which");
}

observed! {
    GREATEST = ("greatest error", "%", "maximum error of the table at its check points");
    RMS = ("rms error", "%", "root mean square error of the table at its check points");
    SHARE = ("error of the heat share", "-",
        "maximum error of the heat share of the first gear at the check points");
}

/// Models that are as fast as a table.
const QUICK: [&str; 6] = ["none", "constant", "formula", "table", "efficiency", "tabulated"];

/// Tangential force over module and face width up to which a table extends by default: the approximate maximum for hardened teeth.
/// \[Pa\]
const BORNE: f64 = 200e6;

/// Precomputed, interpolated loss of another mesh model.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Model to tabulate.
    pub of: ModelRef<GearMesh>,
    /// Minimum and maximum speed of the first gear, in either direction. [rpm]
    #[serde(default = "speeds")]
    #[schemars(inner(range(min = 1e-3, max = 1e6)))]
    pub speeds: [f64; 2],
    /// Minimum and maximum torque of the first gear; default: a tangential force of 200 N/mm2 times module and face width, and a
    /// thousandth of it. [Nm]
    #[schemars(inner(range(min = 1e-6, max = 1e7)))]
    pub torques: Option<[f64; 2]>,
    /// Minimum and maximum temperature of the oil, or mean temperature of both bodies. [degC]
    #[serde(default = "temperatures")]
    #[schemars(inner(range(min = -60.0, max = 250.0)))]
    pub temperatures: [f64; 2],
    /// Number of nodes over speed, torque and temperature. [-]
    #[serde(default = "nodes")]
    #[schemars(inner(range(min = 4, max = 40)))]
    pub nodes: [u32; 3],
    /// Number of check points between the nodes that measure the error. [-]
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
    /// Built on first use.
    over_oil: OnceLock<Result<Table, Undefined>>,
    /// Built on first use; `None` if the model does not depend on body temperatures.
    over_bodies: OnceLock<Option<Result<Table, Undefined>>>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Tabulated, Diagnostic> {
    let name = params.of.value.as_str().or_else(|| params.of.value["type"].as_str());
    if let Some(quick) = name.filter(|name| QUICK.contains(name)) {
        return Err(cx
            .error(format!("`{quick}` is as fast as a table of it"))
            .help(format!("write `type: {quick}` instead of `tabulated`")));
    }
    let of = cx.slot("of", &params.of)?;
    let part = cx.own_part::<GearMesh>()?;
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
                .error(format!("`{key}` does not increase from its first to its second value"))
                .help("write the minimum, then the maximum"));
        }
    }
    if let Some(oil) = &part.oil {
        let [cold, hot] = extents.temperatures.map(|t| oil.lubricant.eta(t));
        if !(cold.is_finite() && hot > 0.0 && cold > hot) {
            return Err(cx
                .error(format!(
                    "the viscosity of `{}` does not decrease over `temperatures`",
                    oil.id
                ))
                .help("narrow `temperatures` to the range of the oil's viscosity law"));
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

/// Minimum and maximum torque of the first gear of a pair. \[Nm\]
fn torques(part: &MeshPart) -> [f64; 2] {
    let pair = &part.pair;
    let most = BORNE * pair.normal_module * pair.facewidth * pair.working_radius[0];
    [1e-3 * most, most]
}

impl Tabulated {
    /// The table for a point, built on first use, and the temperatures whose mean is its axis.
    fn table(&self, at: &GearMeshAt<'_>, direct: &DirectModel<'_>) -> Result<(&Table, [f64; 2]), Undefined> {
        let build = |known| Table::new(direct, &self.extents, self.nodes, self.checks, known);
        if let Some([first, second]) = at.bodies()? {
            let table = self
                .over_bodies
                .get_or_init(|| direct.follows_bodies(&self.extents).then(|| build(true)));
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

/// The table, or the reason why there is none.
fn built(table: &Result<Table, Undefined>) -> Result<&Table, Undefined> {
    table.as_ref().map_err(|inside| Undefined {
        what: "a value inside the table (narrow `speeds`, `torques` or `temperatures`), which the tabulated model does not have at",
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
            at.branch("no own oil: the tabulated model itself");
            return self.itself(at);
        };
        let direct = DirectModel {
            model: &self.of,
            part: at.part,
            lubricant: &oil.lubricant,
        };
        let (table, [first, second]) = self.table(at, &direct)?;
        let speed = at.speed.abs();
        let place = table.place([speed, at.torque, 0.5 * (first + second)], &oil.lubricant);
        let farthest = place.iter().fold(
            0.5,
            |far: f64, x| if (x - 0.5).abs() > (far - 0.5).abs() { *x } else { far },
        );
        if !(0.0..=1.0).contains(&at.check(&PLACE, farthest)) {
            at.branch("outside the table: the tabulated model itself");
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
        formula(Evidence::Derived, "interpolates the other model; the measured error is reported"),
        default_of("speeds", Evidence::Assumed, "from creeping speed to the fastest electric motors"),
        default_of("torques", Evidence::Assumed, "beyond the capacity of hardened teeth"),
        default_of("temperatures", Evidence::Assumed, "the range of most gearboxes"),
        default_of("nodes", Evidence::Derived, "about 0.5 % rms error with `ehl_mixed` on two stages of an electric axle"),
        default_of("checks", Evidence::Derived, "at about 1 % of other points the error exceeds the maximum of 100 check points"),
    ],
    limits: [PLACE, LEFT], terms: [TOTAL], observed: [GREATEST, RMS, SHARE], prepare: prepare);
