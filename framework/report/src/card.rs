//! Key data of a gearbox: its stages and teeth, its bearings and their pairs, the ratio of each gear, its oil.

use gearloss_framework::attach::Stiffness;
use gearloss_framework::geometry::Holding;
use gearloss_framework::mechanism::worm_mesh::{AtRest, WormPart};
use gearloss_framework::transmission::{ChainStage, CrossedStage, Stage, Transmission};
use gearloss_studies::bearings::{BearingCard, bearing_cards};
use gearloss_studies::checked::CheckedGearbox;
use gearloss_studies::pairs::pair_cards;
use serde::Serialize;
use serde_json::Value;

use crate::text::{TextTable, last_key, number, short, significant};

/// Indented tables and lines.
pub fn card(checked: &CheckedGearbox) -> String {
    let transmission = &checked.transmission;
    let mut text = String::new();
    let stages: Vec<Stage> = transmission.stages().collect();
    if !stages.is_empty() {
        text.push_str(&stage_table(&stages));
        text.push_str(&tooth_table(&stages));
    }
    let crossed: Vec<CrossedStage> = transmission.crossed_stages().collect();
    if !crossed.is_empty() {
        text.push_str(&crossed_table(&crossed));
    }
    for line in worm_lines(transmission) {
        text.push_str(&line);
        text.push('\n');
    }
    let chains: Vec<ChainStage> = transmission.chain_stages().collect();
    if !chains.is_empty() {
        text.push_str(&chain_table(&chains));
    }
    let bearings = bearing_cards(checked);
    if !bearings.is_empty() {
        text.push_str(&bearing_table(&bearings));
    }
    for pair in pair_cards(transmission, &checked.resolved) {
        text.push_str(&pair.sentence());
        text.push('\n');
    }
    for (bearing, known) in transmission.stiffnesses() {
        let (load, value) = (significant(known.load), known.value);
        let line = match known.stiffness {
            Stiffness::Radial => {
                let [stiffness, moved] = [1e-6 * value, 1e6 * known.load / value].map(short);
                format!("{bearing}: radial stiffness {stiffness} N/um at {load} N ({moved} um)\n")
            }
            Stiffness::Tilting => format!(
                "{bearing}: tilting stiffness {} Nm/mrad at {load} N\n",
                short(1e-3 * value)
            ),
        };
        text.push_str(&line);
    }
    text.push_str(&ratio_lines(transmission));
    if let Some((volume, mass)) = transmission.oil_fill() {
        let [litres, mass] = [1e3 * volume, mass].map(short);
        let temperature = significant(transmission.oil_temperature);
        text.push_str(&format!("oil: {litres} l, {mass} kg at {temperature} degC\n"));
    }
    let lines: Vec<&str> = text.lines().collect();
    format!("  {}\n", lines.join("\n  "))
}

/// What determines each worm drive, and whether it holds a load at rest.
fn worm_lines(transmission: &Transmission) -> Vec<String> {
    let percent = |efficiency: f64| format!("{:.1} %", 100.0 * efficiency);
    let line = |(path, part, rest): (&str, &WormPart, Option<AtRest>)| {
        let pair = &part.pair;
        let mut line = format!(
            "{path}: worm {}/{}, lead angle {:.3} deg, q {}, a {} mm",
            pair.spec.z[0],
            pair.spec.z[1],
            pair.lead_angle.to_degrees(),
            significant(pair.diameter_factor()),
            significant(1e3 * pair.centre_distance),
        );
        if let Some(rest) = rest {
            let holding = match rest.holding() {
                Holding::SelfLocking => "self-locking: the wheel cannot set the worm in motion",
                Holding::Doubtful => "self-locking is doubtful: vibration may release it",
                Holding::None => "not self-locking: the wheel can drive the worm",
            };
            line.push_str(&format!(
                "; at rest friction {}, efficiency {} (worm drives), {holding}",
                significant(rest.friction),
                percent(rest.efficiency[0]),
            ));
        }
        line
    };
    transmission.worms().map(line).collect()
}

/// One line for each gear: the ratio from the reference port to each other port.
fn ratio_lines(transmission: &Transmission) -> String {
    let mut text = String::new();
    let ports = transmission.ports();
    let reference = &ports[transmission.reference_port()].name;
    for (i, state) in transmission.states().iter().enumerate() {
        let ratios: Vec<String> = transmission
            .ratios(i)
            .into_iter()
            .map(|(port, ratio)| {
                let ratio = ratio.map_or_else(|| "stationary".to_owned(), significant);
                format!("{reference}/{} {ratio}", ports[port].name)
            })
            .collect();
        let ratios = if ratios.is_empty() {
            "no fixed ratio".to_owned()
        } else {
            ratios.join(", ")
        };
        text.push_str(&format!("gear {}: {ratios}\n", state.name));
    }
    text
}

/// Stages of gears on axes that cross; values of both gears with a slash.
fn crossed_table(stages: &[CrossedStage]) -> String {
    let both = |values: [f64; 2]| format!("{:.3}/{:.3}", values[0], values[1]);
    TextTable::of(stages)
        .column("stage", |stage| last_key(&stage.mesh))
        .column("z", |stage| format!("{}/{}", stage.z[0], stage.z[1]))
        .column("ratio", |stage| format!("{:.4}", stage.ratio))
        .column("shaft angle deg", |stage| format!("{:.3}", stage.shaft_angle_deg))
        .column("offset mm", |stage| format!("{:.3}", stage.offset_mm))
        .column("pitch angles deg", |stage| both(stage.pitch_angle_deg))
        .column("spiral angles deg", |stage| both(stage.spiral_angle_deg.map(f64::abs)))
        .column("m_mn mm", |stage| format!("{:.4}", stage.mean_normal_module_mm))
        .column("d_m mm", |stage| both(stage.mean_diameter_mm))
        .column("mean point at mm", |stage| both(stage.at_mm))
        .finish()
        .render()
}

/// What determines a stage.
fn stage_table(stages: &[Stage]) -> String {
    let shift = |x: f64| number(Some(if x.abs() < 5e-5 { 0.0 } else { x }), 4);
    TextTable::of(stages)
        .column("stage", |stage| mesh_name(stage))
        .column("z", |stage| format!("{}/{}", stage.z[0], stage.z[1]))
        .column("ratio", |stage| number(Some(stage.ratio), 4))
        .column("a mm", |stage| number(Some(stage.centre_distance_mm), 3))
        .column("x1", |stage| shift(stage.profile_shift[0]))
        .column("x2", |stage| shift(stage.profile_shift[1]))
        .column("x1+x2", |stage| {
            let [x1, x2] = stage.profile_shift;
            shift(if stage.internal { x2 - x1 } else { x1 + x2 })
        })
        .column("eps_alpha", |stage| number(stage.transverse_contact_ratio, 4))
        .column("eps_beta", |stage| number(Some(stage.overlap_contact_ratio), 4))
        .column("face overlap mm", |stage| {
            let narrow = stage.facewidth_mm[0].min(stage.facewidth_mm[1]);
            format!("{} of {}", significant(stage.face_overlap_mm), significant(narrow))
        })
        .finish()
        .render()
}

/// Chains and belts, with the links that their wheels need.
fn chain_table(chains: &[ChainStage]) -> String {
    TextTable::of(chains)
        .column("chain", |chain| last_key(&chain.chain))
        .column("z", |chain| format!("{}/{}", chain.z[0], chain.z[1]))
        .column("ratio", |chain| number(Some(chain.ratio), 4))
        .column("a mm", |chain| number(Some(chain.centre_distance_mm), 3))
        .column("wrap deg", |chain| {
            format!("{:.1} / {:.1}", chain.wrap_deg[0], chain.wrap_deg[1])
        })
        .column("links needed", |chain| number(Some(chain.links_needed), 3))
        .column("links", |chain| {
            chain.links.map_or_else(|| "-".to_owned(), |links| links.to_string())
        })
        .finish()
        .render()
}

/// Whether its teeth can exist and run: both gears of a stage in one cell.
fn tooth_table(stages: &[Stage]) -> String {
    let both = |values: [Option<f64>; 2], digits: usize| {
        let cells = values.map(|value| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}")));
        format!("{} / {}", cells[0], cells[1])
    };
    let of_both = |values: Option<[f64; 2]>| [0, 1].map(|gear| values.map(|values| values[gear]));
    TextTable::of(stages)
        .column("teeth", |stage| mesh_name(stage))
        .column("tip clearance mm", |stage| both(of_both(stage.tip_clearance_mm), 3))
        .column("tip width mm", |stage| both(stage.tip_width_mm, 3))
        .column("x over undercut", |stage| {
            let above = |gear: usize| stage.undercut_limit[gear].map(|limit| stage.profile_shift[gear] - limit);
            both([0, 1].map(above), 3)
        })
        .column("specific sliding", |stage| both(of_both(stage.specific_sliding), 2))
        .finish()
        .render()
}

/// Bearings with their arrangement, and their loads at the rated point if there is one.
fn bearing_table(bearings: &[BearingCard]) -> String {
    let rated = bearings.iter().any(|bearing| bearing.at_rating.is_some());
    let kilo = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |newton| short(newton / 1e3));
    let whole = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.0}"));
    let table = TextTable::of(bearings)
        .column("bearing", |bearing| last_key(&bearing.bearing))
        .column("shaft", |bearing| &bearing.shaft)
        .column("at mm", |bearing| significant(bearing.at_mm))
        .column("designation", |bearing| bearing.designation.as_deref().unwrap_or("-"))
        .column("takes thrust", |bearing| match bearing.axial.as_str() {
            "both" => "both ways",
            "left" => "to -x",
            "right" => "to +x",
            _ => "no",
        })
        .column("C kN", |bearing| kilo(bearing.c_n))
        .column("C0 kN", |bearing| kilo(bearing.c0_n))
        .each(rated.then_some(()), |table, ()| {
            table
                .column("P kN", |bearing| kilo(bearing.at_rating.as_ref().and_then(|at| at.p_n)))
                .column("P0 kN", |bearing| {
                    kilo(bearing.at_rating.as_ref().and_then(|at| at.p0_n))
                })
                .column("L10h h", |bearing| {
                    whole(bearing.at_rating.as_ref().and_then(|at| at.l10h_h))
                })
                .column("n d_m mm/min", |bearing| {
                    whole(bearing.at_rating.as_ref().and_then(|at| at.speed_factor))
                })
        })
        .finish();
    let note = if rated {
        "  (P, P0, L10h, n d_m: worst of the rated torque and speed in all gears, drive and coast)\n"
    } else {
        ""
    };
    format!("{}{note}", table.render())
}

fn mesh_name(stage: &Stage) -> &str {
    last_key(&stage.mesh)
}

/// All data of a stage at full precision, one line each: key and value as in JSON.
pub fn stage_lines(stage: &impl Serialize) -> Vec<String> {
    let value = serde_json::to_value(stage).unwrap_or_default();
    let fields = value.as_object().into_iter().flatten();
    fields
        .filter(|(key, _)| *key != "mesh")
        .map(|(key, value)| format!("{key}: {}", inline(value)))
        .collect()
}

fn inline(value: &Value) -> String {
    match value {
        Value::Array(items) => format!("[{}]", items.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
