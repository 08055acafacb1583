//! Checks for likely mistakes in valid descriptions: little face overlap, profile shifts that only match a centre distance, oil
//! that reaches no gear.

use super::oils::OilNumbers;
use super::seats::GearSeat;
use crate::attach::Level;
use crate::description::GearboxEntry;
use crate::document::Diagnostic;
use crate::geometry::{Pair, PairFault, PairSpec};

/// Share of the narrower face width below which the overlap is reported. Faces are often offset or differ by a few percent on
/// purpose.
const LEAST_OVERLAP: f64 = 0.9;

/// Profile shift coefficient above which an unstated one is reported, and limit of the sum if neither is stated: designs according
/// to DIN 3992 are within it except for pinions with few teeth, whose shift is stated. One tooth too many changes the sum by about
/// 0.5.
const LARGEST_SHIFT: f64 = 0.5;

/// Reports faces with little overlap. \[m\]
pub fn face_overlap(path: &str, [a, b]: [&GearSeat; 2], overlap: f64) -> Option<Diagnostic> {
    let narrow = a.facewidth.min(b.facewidth);
    (overlap < LEAST_OVERLAP * narrow).then(|| {
        Diagnostic::warning(
            format!("{path}.gears"),
            format!(
                "`{}` and `{}` share only {:.3} mm of a face of {:.3} mm ({:.0} %)",
                a.id,
                b.id,
                overlap * 1e3,
                narrow * 1e3,
                100.0 * overlap / narrow
            ),
        )
        .note("forces and losses are computed for the shared width")
        .help("check `at` and `facewidth` of both gears")
    })
}

/// Reports teeth that form no involute pair, if no model uses them. An unstated tip diameter of a ring gear is then no fault.
pub fn no_involute(path: &str, faults: &[PairFault]) -> Option<Diagnostic> {
    let fault = faults.iter().find(|fault| **fault != PairFault::RingTip)?;
    Some(
        Diagnostic::warning(path, fault.to_string())
            .note("no model uses the tooth geometry, so the pair is treated as pitch circles that roll on each other")
            .help("check the numbers of teeth and the centre distance; a loss model of the mesh requires a valid geometry"),
    )
}

/// Reports large profile shifts that follow from the centre distance only; `follows` marks these.
pub fn shifts(path: &str, spec: &PairSpec, pair: &Pair, follows: [bool; 2]) -> Option<Diagnostic> {
    let [x1, x2] = pair.profile_shift;
    let largest = match follows {
        [true, true] => (x1 + x2).abs(),
        [true, false] => x1.abs(),
        [false, true] => x2.abs(),
        [false, false] => 0.0,
    };
    if largest <= LARGEST_SHIFT {
        return None;
    }
    let own: Vec<String> = (0..2)
        .filter(|i| follows[*i])
        .map(|i| format!("x{} = {:.3}", i + 1, pair.profile_shift[i]))
        .collect();
    let warning = Diagnostic::warning(
        path,
        format!(
            "profile shift {} follows from the centre distance of {:.4} mm only",
            own.join(", "),
            pair.centre_distance * 1e3
        ),
    )
    .help("check the numbers of teeth, the module and the centre distance, or state `profile_shift` of both gears");
    Some(match fitting_teeth(spec, pair) {
        Some((teeth, shift)) => warning.note(format!(
            "with {teeth} teeth instead of {} the second gear would have x2 = {shift:.3}",
            pair.z[1]
        )),
        None => warning,
    })
}

/// The number of teeth of the second gear that best matches the centre distance, with its remaining profile shift.
fn fitting_teeth(spec: &PairSpec, pair: &Pair) -> Option<(u32, f64)> {
    let module_t = pair.normal_module / pair.helix_angle.cos();
    let teeth = (2.0 * pair.centre_distance / module_t - pair.sign() * f64::from(pair.z[0])).round();
    if teeth < 5.0 || teeth == f64::from(pair.z[1]) {
        return None;
    }
    let other = Pair::new(&PairSpec {
        z: [pair.z[0], teeth as u32],
        centre_distance: Some(pair.centre_distance),
        profile_shift: [Some(spec.profile_shift[0].unwrap_or(0.0)), None],
        tip_diameter: [None, pair.internal.then_some(module_t * (teeth - 2.0))],
        root_diameter: [None, None],
        ..*spec
    })
    .ok()?;
    Some((other.z[1], other.profile_shift[1]))
}

/// Reports an oil level below the lowest tip circle.
pub fn oil_level(
    entry: &GearboxEntry,
    gears: &[GearSeat],
    levels: &[Level],
    oils: &OilNumbers<'_>,
) -> Option<Diagnostic> {
    let surface = oils.highest()?;
    let lowest = gears
        .iter()
        .zip(levels)
        .filter(|(gear, _)| gear.diameters[1] > 0.0)
        .map(|(gear, level)| {
            let height = match *level {
                Level::Dry => f64::NEG_INFINITY,
                Level::Own(level) => level,
                // At the lowest point of an orbit.
                Level::Sump { height, slope, orbit } => (surface - height) * slope + orbit,
            };
            // Outer radius: the root radius of a ring gear is close to its tip radius, and its lowest teeth are immersed first.
            let radius = 0.5 * gear.diameters[1].max(gear.diameters[2]);
            (gear, height + radius)
        })
        .max_by(|(_, a), (_, b)| a.total_cmp(b));
    let (gear, depth) = lowest.filter(|(_, depth)| *depth <= 0.0)?;
    let key = match entry.housing.oil.as_ref() {
        Some(oil) if oil.level.is_none() => "running_level",
        _ => "level",
    };
    Some(
        Diagnostic::warning(
            format!("housing.oil.{key}"),
            format!(
                "the oil reaches no gear: the lowest tip circle, of `{}`, is {:.3} mm above it",
                gear.id,
                -depth * 1e3
            ),
        )
        .help("check the level and `measured_from`; omit the level if oil is only sprayed"),
    )
}
