//! A cross-section of the housing with its oil: outline, gears, level at rest, level while rotating with the band of its estimates, and pockets
//! of bearings.

use serde_json::Value;

use super::canvas::{Canvas, Rect, width_of};
use gearloss_framework::evaluate::{LevelFrom, OilLevels, PocketLevel};
use gearloss_framework::transmission::Transmission;

/// Width and greatest height of the outline. \[px\]
const WIDTH: f64 = 420.0;
const HEIGHT: f64 = 320.0;

const WALL: &str = "fill=\"none\" stroke=\"#333\" stroke-width=\"1.6\"";
const GUESSED: &str = "fill=\"none\" stroke=\"#333\" stroke-width=\"1.2\" stroke-dasharray=\"6 4\"";
const GEAR: &str = "fill=\"none\" stroke=\"#667\" stroke-width=\"1\"";
const OIL: &str = "fill=\"#e8c36a\" fill-opacity=\"0.35\" stroke=\"none\"";
const BAND: &str = "fill=\"#b5541c\" fill-opacity=\"0.22\" stroke=\"none\"";
const REST: &str = "fill=\"none\" stroke=\"#9a6b00\" stroke-width=\"1.6\"";
const RUNNING: &str = "fill=\"none\" stroke=\"#b5541c\" stroke-width=\"1.6\" stroke-dasharray=\"8 3\"";

/// Draws the oil of a housing at a point as a self-contained `<svg>` element, seen along the shafts; `None` if the oil space is not known.
///
/// The outline is drawn dashed if it is the hull of the gears. Circles are the tip circles of gears with fixed axes along x. An inclined
/// surface is drawn where it meets the middle of the section. Oil in the pocket of a bearing is a part of the circle of its raceway. `resolved`
/// is the document that the transmission was built from.
pub fn oil_section<'a>(
    transmission: &Transmission,
    resolved: &Value,
    levels: &OilLevels,
    pockets: impl Iterator<Item = PocketLevel<'a>>,
) -> Option<String> {
    let sump = transmission.oil_space()?;
    let estimate = levels.estimate?;
    let corners = || {
        sump.sections()
            .iter()
            .flat_map(|section| section.corners.iter().copied())
    };
    let range = |axis: usize| {
        let values = corners().map(|corner| corner[axis]);
        [
            values.clone().fold(f64::INFINITY, f64::min),
            values.fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    let ([left, right], [bottom, top]) = (range(0), range(1));
    let scale = (WIDTH / (right - left)).min(HEIGHT / (top - bottom));
    let place = |[y, z]: [f64; 2]| [scale * (y - left), scale * (top - z)];
    let mut canvas = Canvas::default();
    for section in sump.sections() {
        let below = sump.below(section, levels.at_rest);
        if below.len() > 2 {
            canvas.shape(&below.into_iter().map(place).collect::<Vec<_>>(), OIL);
        }
    }
    for section in sump.sections() {
        let points: Vec<[f64; 2]> = section.corners.iter().copied().map(place).collect();
        canvas.shape(&points, if estimate.drawn { WALL } else { GUESSED });
    }
    let axis = |name: &str| -> Option<[f64; 2]> {
        let axis = resolved["shafts"][name]["axis"].as_array()?;
        let [y, z] = &axis[..] else { return None };
        Some([y.as_f64()?, z.as_f64()?])
    };
    for gear in transmission.gears().iter().filter(|gear| !gear.ring) {
        let shaft = &transmission.members()[gear.member];
        let of_gear = || axis(resolved["gears"][&gear.id]["shaft"].as_str().unwrap_or_default());
        if let Some(axis) = axis(shaft).or_else(of_gear) {
            canvas.circle(place(axis), scale * 0.5 * gear.diameters[1], GEAR);
        }
    }
    let mut heights = Vec::new();
    for pocket in pockets {
        let id = pocket.bearing.rsplit('.').next().unwrap_or_default();
        let shaft = resolved["bearings"][id]["shaft"].as_str().unwrap_or_default();
        let (Some(axis), Some(raceway)) = (axis(shaft), pocket.raceway) else {
            continue;
        };
        canvas.circle(place(axis), scale * raceway, GEAR);
        if pocket.height > 0.0 {
            canvas.shape(&segment(axis, raceway, pocket.height).map(place), OIL);
        }
        heights.push(format!("{id} {:.1} mm", pocket.height * 1e3));
    }
    let surface = |level: f64| sump.surface(level, [left, right]).map(place);
    let [from, to] = [estimate.band.high(), estimate.band.low()].map(surface);
    if levels.from == LevelFrom::Estimated {
        canvas.shape(&[from[0], from[1], to[1], to[0]], BAND);
    }
    canvas.line(&surface(levels.at_rest), REST);
    canvas.line(&surface(levels.running), RUNNING);
    let mm = |x: f64| format!("{:.1} mm", x * 1e3);
    let running = match levels.from {
        LevelFrom::Estimated => format!(
            "rotating {} by estimate, {} to {} (band)",
            mm(levels.running),
            mm(estimate.band.low()),
            mm(estimate.band.high())
        ),
        LevelFrom::Stated => format!("rotating {} as stated", mm(levels.running)),
        LevelFrom::AtRest => "rotating as at rest".to_owned(),
    };
    let outline = if estimate.drawn {
        "inside of the housing"
    } else {
        "inside of the housing, assumed: hull of the gears"
    };
    let volume = format!("oil at rest {}, {:.2} l", mm(levels.at_rest), estimate.volume * 1e3);
    let mut rows = vec![
        (REST, volume),
        (RUNNING, running),
        (if estimate.drawn { WALL } else { GUESSED }, outline.to_owned()),
    ];
    if !heights.is_empty() {
        rows.push((GEAR, format!("pockets of bearings: {}", heights.join(", "))));
    }
    let foot = canvas.extent().y[1] + 26.0;
    for (i, (style, text)) in rows.iter().enumerate() {
        let y = foot + 20.0 * i as f64;
        canvas.line(&[[0.0, y - 5.0], [26.0, y - 5.0]], style);
        canvas.foot(34.0, y, text);
        canvas.avoid(Rect::new([34.0, 34.0 + width_of(text)], [y - 14.0, y]));
    }
    Some(canvas.finish(&format!("Oil of {}", transmission.title())))
}

/// The part of a circle about an axis (m) that a height of oil above its lowest point fills: corners as y and z.
fn segment([y, z]: [f64; 2], radius: f64, height: f64) -> [[f64; 2]; 33] {
    let half = (1.0 - height / radius).clamp(-1.0, 1.0).acos();
    std::array::from_fn(|i| {
        let angle = half * (i as f64 / 16.0 - 1.0);
        [y + radius * angle.sin(), z - radius * angle.cos()]
    })
}
