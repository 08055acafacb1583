//! Loads and speeds of the bearings over cycles as load cases of a REXS model.
//!
//! Source: `rexs_schema_1.7.xml` and `rexs-file.xsd` of the FVA, github.com/fva-net/rexs-api-java. The model has a gear unit and the
//! bearings only; each cycle is a load spectrum whose load cases have result attributes of the bearings. u is x of the gearbox, v is y and w
//! is z.

use std::fmt::Write as _;

use gearloss_studies::analyses::cycle::{BearingLoad, BearingLoads, LoadCase};

/// Number of the gear unit; the bearings follow it.
const UNIT: usize = 1;

/// The model of one model set.
pub fn rexs(all: &[BearingLoads]) -> String {
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model version=\"1.7\" applicationId=\"gearloss\" applicationVersion=\"{}\" date=\"1980-01-01T00:00:00+00:00\">\n  <relations/>\n  <components>\n    <component id=\"{UNIT}\" type=\"gear_unit\" name=\"{}\"/>\n",
        env!("CARGO_PKG_VERSION"),
        escaped(all.first().map_or("", |loads| &loads.model_set)),
    );
    let first = all.iter().find_map(|loads| loads.cases.first());
    let bearings = first.map_or(&[][..], |case| &case.bearings);
    for (bearing, id) in bearings.iter().zip(UNIT + 1..) {
        line(
            &mut text,
            2,
            &format!(
                "<component id=\"{id}\" type=\"rolling_bearing_with_catalog_geometry\" name=\"{}\"/>",
                escaped(&bearing.bearing)
            ),
        );
    }
    line(&mut text, 1, "</components>");
    for (loads, spectrum) in all.iter().zip(1..) {
        if loads.cases.is_empty() {
            continue;
        }
        line(&mut text, 1, &format!("<!-- {} -->", commented(&loads.cycle)));
        line(&mut text, 1, &format!("<load_spectrum id=\"{spectrum}\">"));
        for (case, id) in loads.cases.iter().zip(1..) {
            load_case(&mut text, id, case);
        }
        line(&mut text, 1, "</load_spectrum>");
    }
    text.push_str("</model>\n");
    text
}

fn load_case(text: &mut String, id: usize, case: &LoadCase) {
    line(text, 2, &format!("<load_case id=\"{id}\">"));
    line(text, 3, &format!("<component id=\"{UNIT}\" type=\"gear_unit\">"));
    attribute(text, "operating_time_fraction", "%", 100.0 * case.share);
    attribute(text, "operating_time", "h", case.duration_s / 3600.0);
    line(
        text,
        4,
        &format!("<attribute id=\"gear_shift_index\">{}</attribute>", case.gear_number),
    );
    line(text, 3, "</component>");
    for (load, id) in case.bearings.iter().zip(UNIT + 1..) {
        line(
            text,
            3,
            &format!("<component id=\"{id}\" type=\"rolling_bearing_with_catalog_geometry\">"),
        );
        bearing(text, load);
        line(text, 3, "</component>");
    }
    line(text, 2, "</load_case>");
}

fn bearing(text: &mut String, bearing: &BearingLoad) {
    for (name, speed) in [
        ("speed_inner_ring", bearing.inner_rpm),
        ("speed_outer_ring", bearing.outer_rpm),
    ] {
        if let Some(speed) = speed {
            attribute(text, name, "1 / min", speed);
        }
    }
    if let Some(oil) = bearing.oil_degc {
        attribute(text, "temperature_lubricant", "C", oil);
    }
    let Some(load) = bearing.load else { return };
    // Without a direction the whole load is along v.
    let [v, w] = load.radial_yz_n.unwrap_or([load.radial_n, 0.0]);
    attribute(text, "force_acting_on_inner_component_v", "N", v);
    attribute(text, "force_acting_on_inner_component_w", "N", w);
    attribute(text, "axial_force", "kN", load.axial_n / 1000.0);
}

fn attribute(text: &mut String, id: &str, unit: &str, value: f64) {
    // Minus zero is zero.
    let value = value + 0.0;
    line(
        text,
        4,
        &format!("<attribute id=\"{id}\" unit=\"{unit}\">{value}</attribute>"),
    );
}

fn line(text: &mut String, depth: usize, content: &str) {
    let _ = writeln!(text, "{:1$}{content}", "", 2 * depth);
}

fn escaped(name: &str) -> String {
    let name = name.replace('&', "&amp;").replace('<', "&lt;");
    name.replace('>', "&gt;").replace('"', "&quot;")
}

/// A comment must not contain two hyphens.
fn commented(name: &str) -> String {
    name.replace("--", "- -")
}
