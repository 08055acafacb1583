//! Overall heat transfer coefficients according to ISO/TR 14179-1.
//!
//! Source: ISO/TR 14179-1:2001, quoted from memory: Q = k A (T_oil - T_ambient); k in W/(m2 K): small confined space, air of about 0.6 m/s, 10 to
//! 14; large indoor hall, 1.4 m/s, 16 to 20; outdoors, 3.7 m/s, 18 to 21; with a fan on the shaft 15, 24, 42, 58 at 2.5, 5, 10, 15 m/s, linear
//! in between. A is the free outer surface that oil touches inside and air outside, without fins, bolts and foundation.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_dissipation::{
    HeatDissipation, HeatDissipationAt, HeatDissipationModel, WarmSide,
};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{limits, register};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{needed, part};

limits! { AIR = ("v_air", "air velocity", "m/s", 2.5, 15.0, "table of the report, quoted from memory"); }
const FAN: [(f64, f64); 4] = [(2.5, 15.0), (5.0, 24.0), (10.0, 42.0), (15.0, 58.0)];

/// Location of the gearbox.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// A small confined space.
    Confined,
    /// A large hall.
    #[default]
    Indoor,
    /// Outdoors.
    Outdoor,
    /// A fan on the shaft; the air speed is that of `housing.outside`.
    ShaftFan,
}

/// Overall heat transfer coefficients by the location of the gearbox.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Location of the gearbox.
    #[serde(default)]
    pub place: Place,
    /// Position within the range of the coefficient: 0 minimum, 1 maximum. [-]
    #[serde(default = "half")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub within: f64,
}

fn half() -> f64 {
    0.5
}

struct Ready {
    k: f64,
    /// Air speed of a fan.
    air: Option<f64>,
    area: f64,
}

/// Coefficient with a fan.
fn fan(v: f64) -> f64 {
    let v = v.clamp(FAN[0].0, FAN[3].0);
    let pair = FAN.windows(2).find(|w| v <= w[1].0).unwrap_or(&FAN[2..]);
    let [(v0, k0), (v1, k1)] = [pair[0], pair[1]];
    k0 + (v - v0) / (v1 - v0) * (k1 - k0)
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Ready, Diagnostic> {
    let part = part(cx);
    let area = needed(part.area, "iso14179_1", "the area of the housing", "area: 500 cm2", cx)?;
    let range = |least: f64, greatest: f64| least + params.within * (greatest - least);
    let (k, air) = match params.place {
        Place::Confined => (range(10.0, 14.0), None),
        Place::Indoor => (range(16.0, 20.0), None),
        Place::Outdoor => (range(18.0, 21.0), None),
        Place::ShaftFan if part.air_speed > 0.0 => (fan(part.air_speed), Some(part.air_speed)),
        Place::ShaftFan => {
            return Err(cx
                .error("iso14179_1 requires the air speed of the fan")
                .help("add `housing: { outside: { air_speed: 5 m/s } }` with your value"));
        }
    };
    Ok(Ready { k, air, area })
}

impl HeatDissipationModel for Ready {
    fn warm_side(&self) -> WarmSide {
        WarmSide::Oil
    }
    fn conductance(&self, at: &HeatDissipationAt<'_>) -> Result<f64, Undefined> {
        if let Some(v) = self.air {
            at.check(&AIR, v);
        }
        let k = at.show("k", "W/(m2 K)", self.k);
        Ok(at.show("k A", "W/K", k * self.area))
    }
}

register!(HeatDissipation, "iso14179_1", Params,
    source: "ISO/TR 14179-1:2001",
    example: "{ type: iso14179_1 }",
    evidence: [
        formula(Evidence::Recalled, "table quoted from memory, not checked"),
        default_of("within", Evidence::Assumed, "the middle of the range"),
    ],
    limits: [AIR], prepare: prepare);

#[cfg(test)]
mod tests {
    use gearloss_framework::testing::eval;

    use super::*;
    use crate::heat_dissipation::cases::assert_conductance;

    #[test]
    fn the_conductance_is_put_together_in_si() {
        let way = Ready {
            k: 18.0,
            air: None,
            area: 0.4,
        };
        assert_conductance(&way, 7.2);
    }

    #[test]
    fn e2_the_fan_table_is_linear_and_ends() {
        for (v, k) in [
            (1.0, 15.0),
            (2.5, 15.0),
            (5.0, 24.0),
            (7.5, 33.0),
            (12.5, 50.0),
            (15.0, 58.0),
            (30.0, 58.0),
        ] {
            assert!((fan(v) - k).abs() < 1e-12, "{v}");
        }
    }

    #[test]
    fn every_coefficient_is_that_of_the_report() {
        let table = crate::printed::Printed::read(include_str!("../../tests/tables/heat_iso14179_1.csv"));
        for line in table.rows() {
            let place = match line.text("place") {
                "small confined space" => "confined",
                "large indoor hall" => "indoor",
                "outdoors" => "outdoor",
                _ => {
                    line.is("least", fan(line.number("air")));
                    continue;
                }
            };
            for (column, within) in [("least", 0.0), ("greatest", 1.0)] {
                let input = format!(
                    "model: {{ type: iso14179_1, place: {place}, within: {within} }}\npart: {{ area: 10000 cm2, wall_thickness: 8 mm, wall_conductivity: 150 W/(m K), emissivity: 0.9, air_speed: 0 m/s }}"
                );
                line.is(column, eval("heat_dissipation/iso14179_1", &input).total);
            }
        }
        assert_eq!(
            FAN.len(),
            table.rows().filter(|line| line.text("place") == "fan").count()
        );
    }
}
