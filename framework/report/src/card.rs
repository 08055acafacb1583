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
    let mut table = TextTable::new(&[
        "stage",
        "z",
        "ratio",
        "shaft angle deg",
        "offset mm",
        "pitch angles deg",
        "spiral angles deg",
        "m_mn mm",
        "d_m mm",
        "mean point at mm",
    ]);
    let both = |values: [f64; 2], digits: usize| format!("{:.digits$}/{:.digits$}", values[0], values[1]);
    for stage in stages {
        table.row(vec![
            last_key(&stage.mesh).to_owned(),
            format!("{}/{}", stage.z[0], stage.z[1]),
            format!("{:.4}", stage.ratio),
            format!("{:.3}", stage.shaft_angle_deg),
            format!("{:.3}", stage.offset_mm),
            both(stage.pitch_angle_deg, 3),
            both(stage.spiral_angle_deg.map(f64::abs), 3),
            format!("{:.4}", stage.mean_normal_module_mm),
            both(stage.mean_diameter_mm, 3),
            both(stage.at_mm, 3),
        ]);
    }
    table.render()
}

/// What determines a stage.
fn stage_table(stages: &[Stage]) -> String {
    let mut table = TextTable::new(&[
        "stage",
        "z",
        "ratio",
        "a mm",
        "x1",
        "x2",
        "x1+x2",
        "eps_alpha",
        "eps_beta",
        "face overlap mm",
    ]);
    for stage in stages {
        let narrow = stage.facewidth_mm[0].min(stage.facewidth_mm[1]);
        let [x1, x2] = stage.profile_shift;
        let sum = if stage.internal { x2 - x1 } else { x1 + x2 };
        let [x1, x2, sum] = [x1, x2, sum].map(|x| number(Some(if x.abs() < 5e-5 { 0.0 } else { x }), 4));
        table.row(vec![
            mesh_name(stage),
            format!("{}/{}", stage.z[0], stage.z[1]),
            number(Some(stage.ratio), 4),
            number(Some(stage.centre_distance_mm), 3),
            x1,
            x2,
            sum,
            number(stage.transverse_contact_ratio, 4),
            number(Some(stage.overlap_contact_ratio), 4),
            format!("{} of {}", significant(stage.face_overlap_mm), significant(narrow)),
        ]);
    }
    table.render()
}

/// Chains and belts, with the links that their wheels need.
fn chain_table(chains: &[ChainStage]) -> String {
    let mut table = TextTable::new(&["chain", "z", "ratio", "a mm", "wrap deg", "links needed", "links"]);
    for chain in chains {
        table.row(vec![
            last_key(&chain.chain).to_owned(),
            format!("{}/{}", chain.z[0], chain.z[1]),
            number(Some(chain.ratio), 4),
            number(Some(chain.centre_distance_mm), 3),
            format!("{:.1} / {:.1}", chain.wrap_deg[0], chain.wrap_deg[1]),
            number(Some(chain.links_needed), 3),
            chain.links.map_or_else(|| "-".to_owned(), |links| links.to_string()),
        ]);
    }
    table.render()
}

/// Whether its teeth can exist and run: both gears of a stage in one cell.
fn tooth_table(stages: &[Stage]) -> String {
    let mut table = TextTable::new(&[
        "teeth",
        "tip clearance mm",
        "tip width mm",
        "x over undercut",
        "specific sliding",
    ]);
    let both = |values: [Option<f64>; 2], digits: usize| {
        let cells = values.map(|value| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}")));
        format!("{} / {}", cells[0], cells[1])
    };
    for stage in stages {
        let above = |gear: usize| stage.undercut_limit[gear].map(|limit| stage.profile_shift[gear] - limit);
        table.row(vec![
            mesh_name(stage),
            both(
                [0, 1].map(|gear| stage.tip_clearance_mm.map(|clearances| clearances[gear])),
                3,
            ),
            both(stage.tip_width_mm, 3),
            both([0, 1].map(above), 3),
            both(
                [0, 1].map(|gear| stage.specific_sliding.map(|slidings| slidings[gear])),
                2,
            ),
        ]);
    }
    table.render()
}

/// Bearings with their arrangement, and their loads at the rated point if there is one.
fn bearing_table(bearings: &[BearingCard]) -> String {
    let rated = bearings.iter().any(|bearing| bearing.at_rating.is_some());
    let mut head = vec![
        "bearing",
        "shaft",
        "at mm",
        "designation",
        "takes thrust",
        "C kN",
        "C0 kN",
    ];
    if rated {
        head.extend(["P kN", "P0 kN", "L10h h", "n d_m mm/min"]);
    }
    let mut table = TextTable::new(&head);
    let cell = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), short);
    let kilo = |value: Option<f64>| cell(value.map(|newton| newton / 1e3));
    for bearing in bearings {
        let thrust = match bearing.axial.as_str() {
            "both" => "both ways",
            "left" => "to -x",
            "right" => "to +x",
            _ => "no",
        };
        let mut row = vec![
            last_key(&bearing.bearing).to_owned(),
            bearing.shaft.clone(),
            significant(bearing.at_mm),
            bearing.designation.clone().unwrap_or_else(|| "-".to_owned()),
            thrust.to_owned(),
            kilo(bearing.c_n),
            kilo(bearing.c0_n),
        ];
        if rated {
            let at_rating = bearing.at_rating.clone().unwrap_or_default();
            let life = at_rating
                .l10h_h
                .map_or_else(|| "-".to_owned(), |hours| format!("{hours:.0}"));
            let speed = at_rating
                .speed_factor
                .map_or_else(|| "-".to_owned(), |factor| format!("{factor:.0}"));
            row.extend([kilo(at_rating.p_n), kilo(at_rating.p0_n), life, speed]);
        }
        table.row(row);
    }
    let note = if rated {
        "  (P, P0, L10h, n d_m: worst of the rated torque and speed in all gears, drive and coast)\n"
    } else {
        ""
    };
    format!("{}{note}", table.render())
}

fn mesh_name(stage: &Stage) -> String {
    last_key(&stage.mesh).to_owned()
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
