//! The schematic of a gearbox: everything is drawn once, inside the picture, and gears in mesh touch.
//!
//! The pictures are left in the temporary folder of the target, to be looked at.

use std::path::Path;

use crate::common::{self, language};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use gearloss_report::schematic;

const OIL: &str = "lubricants: { oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } } }\n";

const DIFFERENTIAL: &str = "
ports: { input: drive, left: left_half, right: right_half }
shafts:
  drive: { axis: [0 mm, 0 mm], bearings: none }
  cage: { axis: [100 mm, 0 mm], bearings: none }
  left_half: { axis: [100 mm, 0 mm] }
  right_half: { axis: [100 mm, 0 mm] }
gears:
  pinion: { shaft: drive, at: 30 mm, z: 20, facewidth: 20 mm }
  crown: { shaft: cage, at: 30 mm, z: 80, facewidth: 20 mm }
meshes: { final_drive: { gears: [pinion, crown], normal_module: 2 mm } }
differentials: { axle: { case: cage, left: left_half, right: right_half } }
";

/// A simple set without any place, with brake and lock.
const SIMPLE: &str = "
ports: { input: sun_shaft, output: carrier }
shafts:
  sun_shaft: { axis: [0 mm, 0 mm] }
  carrier: { axis: [0 mm, 0 mm] }
  ring_shaft: { axis: [0 mm, 0 mm] }
  planet: { mass: 0.2 kg }
gears:
  sun: { shaft: sun_shaft, z: 24, facewidth: 20 mm }
  planet_gear: { shaft: planet, z: 24, facewidth: 20 mm }
  ring: { shaft: ring_shaft, z: 72, facewidth: 20 mm, kind: ring, tip_diameter: 140.8 mm }
meshes:
  sun_planet: { gears: [sun, planet_gear], normal_module: 2 mm, centre_distance: 48 mm }
  planet_ring: { gears: [planet_gear, ring], normal_module: 2 mm, centre_distance: 48 mm }
planetary_sets: { set: { carrier: carrier, count: 3, planets: [planet] } }
bearings:
  pin: { shaft: planet, outer: carrier, at: 0 mm, kind: needle_cage, bore: 20 mm, outside: 25 mm, width: 18 mm }
couplings:
  brake: { kind: dog, between: [ring_shaft, housing] }
  lock: { kind: dog, between: [sun_shaft, carrier] }
gear_states: { low: [brake], direct: { engaged: [lock] } }
";

/// A stepped planet between a held ring and a ring that drives.
const WOLFROM: &str = "
ports: { input: sun_shaft, output: output }
shafts:
  sun_shaft: { axis: [0 mm, 0 mm] }
  carrier: { axis: [0 mm, 0 mm] }
  held: { axis: [0 mm, 0 mm] }
  output: { axis: [0 mm, 0 mm] }
  planet: {}
gears:
  sun: { shaft: sun_shaft, z: 21, facewidth: 10 mm }
  planet_1: { shaft: planet, z: 30, facewidth: 10 mm }
  planet_2: { shaft: planet, at: 12 mm, z: 29, facewidth: 10 mm }
  ring_1: { shaft: held, z: 81, facewidth: 10 mm, kind: ring, tip_diameter: 79.2 mm }
  ring_2: { shaft: output, at: 12 mm, z: 80, facewidth: 10 mm, kind: ring, tip_diameter: 78.2 mm }
meshes:
  sp: { gears: [sun, planet_1], normal_module: 1 mm, centre_distance: 25.5 mm }
  p_r1: { gears: [planet_1, ring_1], normal_module: 1 mm, centre_distance: 25.5 mm }
  p_out: { gears: [planet_2, ring_2], normal_module: 1 mm, centre_distance: 25.5 mm }
planetary_sets: { set: { carrier: carrier, planets: [planet], count: 3 } }
couplings: { brake: { kind: dog, between: [held, housing] } }
gear_states: { only: [brake] }
";

/// Two sets in a row of which nothing tells where they lie; the carrier of the first drives the sun of the second.
const TWO_SETS: &str = "
ports: { input: sun_shaft, output: out }
shafts:
  sun_shaft: { axis: [0 mm, 0 mm] }
  middle: { axis: [0 mm, 0 mm] }
  out: { axis: [0 mm, 0 mm] }
  rings: { axis: [0 mm, 0 mm] }
  p1: {}
  p2: {}
gears:
  s1: { shaft: sun_shaft, z: 24, facewidth: 20 mm }
  g1: { shaft: p1, z: 24, facewidth: 20 mm }
  r1: { shaft: rings, z: 72, facewidth: 20 mm, kind: ring, tip_diameter: 140.8 mm }
  s2: { shaft: middle, z: 24, facewidth: 20 mm }
  g2: { shaft: p2, z: 24, facewidth: 20 mm }
  r2: { shaft: rings, z: 72, facewidth: 20 mm, kind: ring, tip_diameter: 140.8 mm }
meshes:
  m1: { gears: [s1, g1], normal_module: 2 mm, centre_distance: 48 mm }
  m2: { gears: [g1, r1], normal_module: 2 mm, centre_distance: 48 mm }
  m3: { gears: [s2, g2], normal_module: 2 mm, centre_distance: 48 mm }
  m4: { gears: [g2, r2], normal_module: 2 mm, centre_distance: 48 mm }
planetary_sets:
  set_1: { carrier: middle, count: 3, planets: [p1] }
  set_2: { carrier: out, count: 4, planets: [p2] }
clutches: { C1: { between: [rings, housing] } }
gear_states: { only: [C1] }
";

/// Two suns, short and long planets on one carrier, one ring.
const RAVIGNEAUX: &str = "
ports: { input: small, output: ring_shaft }
shafts:
  small: { axis: [0 mm, 0 mm] }
  large: { axis: [0 mm, 0 mm] }
  carrier: { axis: [0 mm, 0 mm] }
  ring_shaft: { axis: [0 mm, 0 mm] }
  short: {}
  long: {}
gears:
  S1: { shaft: small, at: 0 mm, z: 24, facewidth: 20 mm }
  S2: { shaft: large, at: 40 mm, z: 36, facewidth: 20 mm }
  K: { shaft: short, at: 5 mm, z: 20, facewidth: 28 mm }
  L: { shaft: long, at: 25 mm, z: 24, facewidth: 55 mm }
  R: { shaft: ring_shaft, at: 20 mm, z: 84, facewidth: 20 mm, kind: ring, tip_diameter: 164.8 mm }
meshes:
  a: { gears: [S1, K], normal_module: 2 mm }
  b: { gears: [K, L], normal_module: 2 mm }
  c: { gears: [S2, L], normal_module: 2 mm }
  d: { gears: [L, R], normal_module: 2 mm }
planetary_sets: { set: { carrier: carrier, count: 3, planets: [short, long] } }
clutches:
  B1: { between: [large, housing] }
  B2: { between: [carrier, housing] }
gear_states: { first: [B2], second: [B1] }
";

/// Coaxial input and output with a countershaft, a direct gear and a reverse idler.
const COUNTERSHAFT: &str = "
ports: { input: drive, output: main }
shafts:
  drive: { axis: [0 mm, 0 mm] }
  main: { axis: [0 mm, 0 mm] }
  counter: { axis: [0 mm, -80 mm] }
  reverse: { axis: [60 mm, -60 mm] }
gears:
  A1: { shaft: drive, at: 20 mm, z: 30, facewidth: 16 mm }
  A2: { shaft: counter, at: 20 mm, z: 50, facewidth: 16 mm }
  B1: { shaft: main, at: 90 mm, z: 45, facewidth: 16 mm, mounted: loose }
  B2: { shaft: counter, at: 90 mm, z: 35, facewidth: 16 mm }
  C1: { shaft: main, at: 130 mm, z: 45, facewidth: 16 mm, mounted: loose }
  C2: { shaft: counter, at: 130 mm, z: 20, facewidth: 16 mm }
  C3: { shaft: reverse, at: 130 mm, z: 40, facewidth: 14 mm }
meshes:
  a: { gears: [A1, A2], normal_module: 2 mm }
  b: { gears: [B1, B2], normal_module: 2 mm }
  c: { gears: [C2, C3], normal_module: 2 mm, centre_distance: 63.2456 mm }
  d: { gears: [C3, C1], normal_module: 2 mm, centre_distance: 84.8528 mm }
bearings:
  L1: { shaft: drive, at: 0 mm, designation: \"6207\", axial: both }
  L0: { shaft: drive, at: 40 mm, designation: \"6207\" }
  pilot: { shaft: main, outer: drive, at: 20 mm, kind: needle_cage, bore: 16 mm, outside: 20 mm, width: 12 mm }
  L2: { shaft: main, at: 160 mm, designation: \"6207\", axial: both }
  L3: { shaft: counter, at: 0 mm, designation: \"6206\", axial: both }
  L4: { shaft: counter, at: 160 mm, designation: \"6206\" }
  L5: { shaft: reverse, at: 115 mm, designation: \"6204\", axial: both }
  L6: { shaft: reverse, at: 145 mm, designation: \"6204\" }
  NB: { shaft: main, outer: B1, at: 90 mm, kind: needle_cage, bore: 32 mm, outside: 37 mm, width: 14 mm }
  NC: { shaft: main, outer: C1, at: 130 mm, kind: needle_cage, bore: 32 mm, outside: 37 mm, width: 14 mm }
couplings:
  direct: { kind: synchronizer, between: [main, drive], at: 62 mm }
  SB: { kind: synchronizer, between: [main, B1] }
  SC: { kind: synchronizer, between: [main, C1] }
gear_states: { direct: [direct], first: [SB], back: [SC], neutral: [] }
seals:
  front: { shaft: drive, diameter: 30 mm }
  rear: { shaft: main, diameter: 30 mm }
auxiliaries: { pump: { shaft: counter } }
";

/// A clutch for each of two coaxial inputs, two layshafts, one final drive.
const TWIN_CLUTCH: &str = "
ports: { input: engine, output: wheels }
shafts:
  engine: { axis: [0 mm, 0 mm] }
  solid: { axis: [0 mm, 0 mm], bearings: none }
  hollow: { axis: [0 mm, 0 mm], bearings: none }
  upper: { axis: [0 mm, 84 mm], bearings: none }
  lower: { axis: [60 mm, -60 mm], bearings: none }
  wheels: { axis: [121.777914 mm, 55.801778 mm], bearings: none }
gears:
  i1: { shaft: solid, at: 150 mm, z: 20, facewidth: 15 mm }
  i2: { shaft: hollow, at: 60 mm, z: 30, facewidth: 15 mm }
  u1: { shaft: upper, at: 150 mm, z: 64, facewidth: 15 mm, mounted: loose, bearings: none }
  l2: { shaft: lower, at: 60 mm, z: 55, facewidth: 15 mm, mounted: loose, bearings: none }
  u_out: { shaft: upper, at: 20 mm, z: 20, facewidth: 20 mm }
  l_out: { shaft: lower, at: 20 mm, z: 25, facewidth: 20 mm }
  final: { shaft: wheels, at: 20 mm, z: 80, facewidth: 20 mm }
meshes:
  a: { gears: [i1, u1], normal_module: 2 mm }
  b: { gears: [i2, l2], normal_module: 2 mm }
  c: { gears: [u_out, final], normal_module: 2.5 mm }
  d: { gears: [l_out, final], normal_module: 2.5 mm }
clutches:
  K1: { between: [engine, solid], at: -30 mm }
  K2: { between: [engine, hollow], at: -60 mm }
couplings:
  S1: { between: [upper, u1] }
  S2: { between: [lower, l2] }
gear_states:
  first: { engaged: [K1, S1], standstill: [hollow] }
  second: { engaged: [K2, S2], standstill: [solid] }
";

/// Nothing but a shaft in two bearings.
const BARE: &str = "
ports: { input: axle }
shafts: { axle: { axis: [0 mm, 0 mm] } }
bearings:
  L: { shaft: axle, at: 0 mm, designation: \"6207\", axial: both }
  R: { shaft: axle, at: 60 mm, designation: \"6207\" }
seals: { s: { shaft: axle, diameter: 30 mm } }
";

/// Thin gears at the far ends of long shafts, one without a mate, a ring about a pinion, a shaft that nothing holds.
const FAR: &str = "
ports: { input: a, output: c }
shafts:
  a: { axis: [0 mm, 0 mm], bearings: none }
  b: { axis: [60 mm, 0 mm], bearings: none }
  c: { axis: [100 mm, 0 mm], bearings: none }
  idle: { axis: [0 mm, 900 mm] }
gears:
  p: { shaft: a, at: -90000 mm, z: 20, facewidth: 0.2 mm }
  w: { shaft: b, at: -90000 mm, z: 40, facewidth: 0.2 mm }
  v: { shaft: b, at: 90000 mm, z: 20, facewidth: 0.2 mm }
  r: { shaft: c, at: 90000 mm, z: 60, facewidth: 0.2 mm, kind: ring, tip_diameter: 116.5 mm }
  alone: { shaft: b, z: 20, facewidth: 2 mm, mounted: loose }
meshes:
  m: { gears: [p, w], normal_module: 2 mm }
  k2: { gears: [v, r], normal_module: 2 mm }
couplings: { k: { between: [alone, b] } }
gear_states: { only: { engaged: [k], standstill: [idle] } }
";

struct Picture {
    name: String,
    svg: String,
    resolved: serde_json::Value,
    transmission: Transmission,
}

fn picture(language: &Language, name: &str, gearbox: &Gearbox) -> Picture {
    let resolved = gearbox.resolve(language, &Choice::default()).unwrap();
    let transmission = gearbox.build(language, &resolved).unwrap();
    let svg = schematic(&transmission, &resolved.value);
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("schematic-{name}.svg"));
    std::fs::write(file, &svg).unwrap();
    Picture {
        name: name.to_owned(),
        svg,
        resolved: resolved.value,
        transmission,
    }
}

fn pictures() -> Vec<Picture> {
    let language = language();
    let mut all = Vec::new();
    for file in [
        "examples/two-speed-ev/gearbox.yaml",
        "examples/planetary-reducer/gearbox.yaml",
        "examples/two-products/theirs.yaml",
        "examples/transfer-case/gearbox.yaml",
        "tests/cases/fine/input.yaml",
    ] {
        let gearbox = Gearbox::read(&language, &common::file(file)).unwrap();
        all.push(picture(&language, &file.replace(['/', '.'], "-"), &gearbox));
    }
    for (name, text) in [
        ("differential", DIFFERENTIAL),
        ("simple-set", SIMPLE),
        ("wolfrom", WOLFROM),
        ("two-sets", TWO_SETS),
        ("ravigneaux", RAVIGNEAUX),
        ("countershaft", COUNTERSHAFT),
        ("twin-clutch", TWIN_CLUTCH),
    ] {
        let text = format!("gearloss: gearbox/1\n{text}{OIL}");
        let gearbox = Gearbox::of_text(&language, &text, "input.yaml", ".").unwrap();
        all.push(picture(&language, name, &gearbox));
    }
    all
}

/// The text between two others, again and again.
fn between<'a>(text: &'a str, from: &str, to: &str) -> Vec<&'a str> {
    let pieces = text.split(from).skip(1);
    pieces.map(|piece| piece.split(to).next().unwrap()).collect()
}

/// A number of an attribute of the first tag.
fn attribute(tag: &str, name: &str) -> f64 {
    between(tag, &format!(" {name}=\""), "\"")[0].parse().unwrap()
}

/// The first rectangle of a component: left, top, right, bottom.
fn rectangle(svg: &str, path: &str) -> [f64; 4] {
    let group = between(svg, &format!("<g data-part=\"{path}\">"), "</g>")[0];
    let rect = group.split("<rect").nth(1).unwrap();
    let [x, y, w, h] = ["x", "y", "width", "height"].map(|name| attribute(rect, name));
    [x, y, x + w, y + h]
}

/// Paths of all that must be drawn once.
fn parts(picture: &Picture) -> Vec<String> {
    let sections = [
        "gears",
        "bearings",
        "seals",
        "couplings",
        "clutches",
        "auxiliaries",
        "differentials",
        "chains",
        "joints",
        "ports",
    ];
    let ids = |section: &str| {
        let entries = picture.resolved.get(section).and_then(|s| s.as_object());
        let ids: Vec<String> = entries
            .into_iter()
            .flatten()
            .map(|(id, _)| format!("{section}.{id}"))
            .collect();
        ids
    };
    sections.into_iter().flat_map(ids).collect()
}

#[test]
fn every_component_is_drawn_once_with_its_id() {
    for picture in pictures() {
        let svg = &picture.svg;
        assert!(svg.starts_with("<svg ") && svg.contains("role=\"img\"") && svg.contains("<title>Schematic of "));
        let texts: Vec<&str> = between(svg, "<text", "</text>")
            .into_iter()
            .map(|t| t.split('>').nth(1).unwrap())
            .collect();
        let all = parts(&picture);
        assert!(all.len() > 3, "{}", picture.name);
        for path in all {
            let (section, id) = path.split_once('.').unwrap();
            let drawn = svg.matches(&format!("data-part=\"{path}\"")).count();
            assert_eq!(drawn, 1, "{} draws {path} {drawn} times", picture.name);
            // Ids of one spelling in two sections have a text each.
            let named = texts.iter().filter(|t| t.split(' ').next() == Some(id)).count();
            assert!(named >= 1, "{} does not name {section} {id}", picture.name);
        }
    }
}

#[test]
fn everything_lies_inside_the_picture() {
    let language = language();
    let odd = [("bare", BARE), ("far", FAR)].map(|(name, text)| {
        let text = format!("gearloss: gearbox/1\n{text}{OIL}");
        let gearbox = Gearbox::of_text(&language, &text, "input.yaml", ".").unwrap();
        picture(&language, name, &gearbox)
    });
    for Picture { name, svg, .. } in pictures().into_iter().chain(odd) {
        assert!(!svg.contains("NaN") && !svg.contains("\"inf"), "{name}");
        let frame: Vec<f64> = between(&svg, "viewBox=\"", "\"")[0]
            .split(' ')
            .map(|x| x.parse().unwrap())
            .collect();
        let inside = |x: f64, y: f64| {
            assert!(x.is_finite() && y.is_finite(), "{name}");
            let reach = |v: f64, side: usize| v >= frame[side] - 0.011 && v <= frame[side] + frame[side + 2] + 0.011;
            assert!(reach(x, 0) && reach(y, 1), "{name}: {x} {y} lies outside {frame:?}");
        };
        for tag in between(&svg, "<rect", "/>") {
            let [x, y, w, h] = ["x", "y", "width", "height"].map(|a| attribute(tag, a));
            assert!(w >= 0.0 && h >= 0.0, "{name}");
            inside(x, y);
            inside(x + w, y + h);
        }
        for tag in between(&svg, "<text", ">") {
            inside(attribute(tag, "x"), attribute(tag, "y"));
        }
        for tag in between(&svg, "<circle", "/>") {
            inside(attribute(tag, "cx"), attribute(tag, "cy"));
        }
        for point in between(&svg, "points=\"", "\"")
            .into_iter()
            .flat_map(|list| list.split(' '))
        {
            let (x, y) = point.split_once(',').unwrap();
            inside(x.parse().unwrap(), y.parse().unwrap());
        }
    }
}

/// Distance in px between the edges of a mesh that face each other; negative where the gears cover each other.
fn gap(picture: &Picture, gears: &serde_json::Value) -> f64 {
    let [a, b] = [0, 1].map(|i| rectangle(&picture.svg, &format!("gears.{}", gears[i].as_str().unwrap())));
    assert!(a[0] < b[2] && b[0] < a[2], "gears in mesh overlap along the shafts");
    (a[1] - b[3]).max(b[1] - a[3])
}

#[test]
fn gears_in_mesh_touch() {
    for picture in pictures() {
        let (mut closed, mut dotted) = (0, 0);
        for (id, mesh) in picture.resolved["meshes"].as_object().into_iter().flatten() {
            let gap = gap(&picture, &mesh["gears"]);
            let scale = scale(&picture);
            // A second pair on the same axes may differ by the height of a tooth.
            let tooth = scale * mesh["normal_module"].as_f64().unwrap();
            if gap.abs() <= 0.05_f64.max(0.3 * tooth) {
                closed += 1;
            } else {
                dotted += 1;
                assert!(
                    gap > 0.0,
                    "{}: the gears of {id} cover each other by {gap}",
                    picture.name
                );
            }
        }
        // Only where axes close a circle can they not all touch in one plane.
        let open = match picture.name.as_str() {
            "ravigneaux" | "countershaft" | "twin-clutch" => 1,
            _ => 0,
        };
        assert_eq!(dotted, open, "{} with {closed} that touch", picture.name);
        let shown = picture.svg.contains("Dotted: gears in mesh");
        assert_eq!(shown, open > 0, "{}", picture.name);
    }
}

/// Scale of a picture from the face of its first gear. \[px/m\]
fn scale(picture: &Picture) -> f64 {
    let gear = &picture.transmission.gears()[0];
    let [left, _, right, _] = rectangle(&picture.svg, &format!("gears.{}", gear.id));
    (right - left) / gear.facewidth
}

#[test]
fn gears_have_one_scale() {
    for picture in pictures()
        .into_iter()
        .filter(|picture| picture.svg.contains("data-part=\"gears."))
    {
        let scale = scale(&picture);
        for gear in picture.transmission.gears() {
            let [left, top, right, bottom] = rectangle(&picture.svg, &format!("gears.{}", gear.id));
            let wide = (right - left) / (scale * gear.facewidth) - 1.0;
            assert!(wide.abs() < 2e-3, "{} {}: {wide}", picture.name, gear.id);
            if !gear.ring {
                let high = (bottom - top) / (scale * gear.diameters[1]) - 1.0;
                assert!(high.abs() < 2e-3, "{} {}: {high}", picture.name, gear.id);
            }
        }
    }
}

#[test]
fn what_has_no_place_is_dashed_and_stands_free() {
    let all = pictures();
    let two_speed = &all[0].svg;
    let group = |path: &str| between(two_speed, &format!("data-part=\"{path}\">"), "</g>")[0];
    for path in ["couplings.S1", "couplings.S2", "seals.D1", "seals.D2"] {
        assert!(group(path).contains("stroke-dasharray"), "{path}");
    }
    for path in ["gears.G1", "bearings.B1"] {
        assert!(!group(path).contains("stroke-dasharray"), "{path}");
    }
    // Of two sets whose gears all have the place zero the second stands beside the first.
    let sets = &all.iter().find(|p| p.name == "two-sets").unwrap().svg;
    assert!(rectangle(sets, "gears.s2")[0] > rectangle(sets, "gears.s1")[2]);
}

#[test]
fn titles_are_escaped_and_a_document_of_another_gearbox_does_no_harm() {
    let language = language();
    let text = format!("gearloss: gearbox/1\ntitle: \"<a> & 'b'\"\n{SIMPLE}{OIL}");
    let gearbox = Gearbox::of_text(&language, &text, "input.yaml", ".").unwrap();
    let picture = picture(&language, "escaped", &gearbox);
    assert!(
        picture
            .svg
            .contains("<title>Schematic of &lt;a&gt; &amp; &#39;b&#39;</title>")
    );
    for other in [
        serde_json::Value::Null,
        serde_json::json!({ "gears": 3, "bearings": { "B": { "shaft": 1 } } }),
    ] {
        let svg = schematic(&picture.transmission, &other);
        assert!(svg.ends_with("</svg>\n") && !svg.contains("NaN"));
    }
}
