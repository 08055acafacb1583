//! A schematic of the gearbox as SVG: the unfolded axial view with gears to scale and the usual symbols.

mod along;
mod axes;
mod canvas;
mod draw;
mod oil;
mod projection;
mod things;

use serde_json::Value;

use along::{Along, along};
use axes::{Axes, axes};
use canvas::Canvas;
use gearloss_framework::transmission::Transmission;
pub use oil::oil_section;
use things::Things;

/// Maximum width of gears and bearings. \[px\]
const WIDTH: f64 = 520.0;
/// Maximum height of the drawing if the symbols allow it. \[px\]
const HEIGHT: f64 = 420.0;

/// Draws a gearbox as a self-contained `<svg>` element.
///
/// The x axis is the position along the shafts. Gears have their true face width and tip diameter, all to one scale, which a bar shows in
/// mm; bearings have their true width. The axes are unfolded into one plane: first the axis of the reference port, then each further axis
/// at the sum of the tip radii from the axis that it meshes with; coaxial shafts are on one line. A planetary set shows one planet, between
/// its sun and the upper half of its ring. A chain is drawn with its two wheels; its strands connect the lines of their axes, which are not at
/// the centre distance. A dotted line connects meshing gears that cannot touch in one plane. Seals, couplings and
/// auxiliaries without `at` have the position zero in the resolved document; they are drawn at a free position with a dashed outline. Every
/// component is a group with its path in `data-part`.
///
/// If axes are not parallel, the drawing has two views instead, from above and from the side, with the outlines of all bodies to one scale;
/// components without a stated position are not in it.
///
/// `resolved` is the resolved document that the transmission was built from (`Resolved::value`).
pub fn schematic(transmission: &Transmission, resolved: &Value) -> String {
    let things = Things::new(transmission, resolved);
    if projection::is_needed(transmission) {
        return projection::projected(transmission, &things);
    }
    let (scale, along, axes) = laid_out(&things);
    let mut canvas = Canvas::default();
    draw::draw_all(&mut canvas, &things, &along, &axes, scale);
    canvas.finish(&format!("Schematic of {}", transmission.title()))
}

/// The largest scale in px/m at which the drawing has the allowed size, with the layout.
fn laid_out(things: &Things) -> (f64, Along, Axes) {
    let mut scale = WIDTH / length(things);
    let lay = |scale: f64| {
        let along = along(things, scale);
        let axes = axes(things, &along, scale);
        (along, axes)
    };
    let (mut places, mut heights) = lay(scale);
    // Symbols have a constant size, so the height is not proportional to the scale.
    for _ in 0..3 {
        let rects = (0..things.wheels.len()).map(|g| heights.rectangle(things, &places, g).y);
        let [top, bottom] = rects.fold([0.0_f64, 0.0_f64], |a, y| [a[0].min(y[0]), a[1].max(y[1])]);
        if bottom - top <= 1.02 * HEIGHT {
            break;
        }
        scale *= HEIGHT / (bottom - top);
        (places, heights) = lay(scale);
    }
    (scale, places, heights)
}

/// Distance from the first to the last face of all things with a position. \[m\]
fn length(things: &Things) -> f64 {
    let gears = things.wheels.iter().map(|w| (w.at, 0.5 * w.width));
    let parts = things
        .parts
        .iter()
        .filter_map(|p| p.at.map(|at| (at, 0.5 * p.size[0].unwrap_or(0.0))));
    let chains = things.chains.iter().map(|chain| (chain.at, 0.0));
    let all = gears.chain(parts).chain(chains);
    let [first, last] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |span, (at, half)| {
        [span[0].min(at - half), span[1].max(at + half)]
    });
    if last > first { (last - first).max(1e-3) } else { 0.1 }
}
