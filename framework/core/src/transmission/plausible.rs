//! Checks for likely mistakes in valid descriptions: little face overlap, profile shifts that only match a centre distance, pointed or
//! undercut teeth, oil that reaches no gear, viscosities that no oil has.

use super::oils::OilNumbers;
use super::seats::GearSeat;
use crate::attach::Level;
use crate::description::{GearboxEntry, PlausibilityEntry};
use crate::document::Diagnostic;
use crate::geometry::{Pair, PairFault, PairSpec};
use crate::lubricant::{Lubricant, index::index};

/// Reports faces with less than a share of overlap. \[m\]
pub fn face_overlap(path: &str, [a, b]: [&GearSeat; 2], overlap: f64, least: f64) -> Option<Diagnostic> {
    let narrow = a.facewidth.min(b.facewidth);
    (overlap < least * narrow).then(|| {
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

/// A centre distance that is the cause of faults of the teeth, because it requires implausible profile shifts: the problem, what follows, and the
/// teeth that would fit.
pub fn misfit(spec: &PairSpec, faults: &[PairFault], most: f64) -> Option<(String, Vec<String>)> {
    let required = spec.required_shifts()?;
    let stated: f64 = match spec.profile_shift {
        [Some(_), Some(_)] => return None,
        shifts => shifts.into_iter().flatten().sum(),
    };
    let is_of_distance = |fault: &&PairFault| fault.is_of_teeth() && **fault != PairFault::RingTip;
    let fault = faults.iter().find(is_of_distance)?;
    if required.fit.is_some_and(|(_, sum)| (sum - stated).abs() <= most) {
        return None;
    }
    let [distance, reference, least] =
        [required.centre_distance, required.reference_distance, required.least].map(|x| 1e3 * x);
    let message = format!(
        "the centre distance {distance:.4} mm does not fit the teeth: without profile shift they need {reference:.4} mm"
    );
    let mut notes = vec![match required.fit {
        Some((working, sum)) => format!(
            "{distance:.4} mm needs a sum x1 + x2 of {sum:.2}, with a working pressure angle of {:.1} deg; then {fault}",
            working.to_degrees()
        ),
        None => format!("up to {least:.4} mm the base circles have no line of action"),
    }];
    if let Some((teeth, shift)) = fitting_teeth(spec, required.centre_distance) {
        notes.push(other_teeth(teeth, spec.z[1], shift));
    }
    Some((message, notes))
}

/// Reports teeth that form no involute pair, if no model uses them. An unstated tip diameter of a ring gear is then no fault.
pub(crate) fn no_involute(path: &str, spec: &PairSpec, faults: &[PairFault], most: f64) -> Option<Diagnostic> {
    let fault = faults.iter().find(|fault| **fault != PairFault::RingTip)?;
    let (message, notes) = misfit(spec, faults, most).unwrap_or_else(|| (fault.to_string(), Vec::new()));
    let warning = notes
        .into_iter()
        .fold(Diagnostic::warning(path, message), Diagnostic::note);
    Some(
        warning
            .note("no model uses the tooth geometry, so the pair is treated as pitch circles that roll on each other")
            .help("check the numbers of teeth and the centre distance; a loss model of the mesh requires a valid geometry"),
    )
}

/// Reports large profile shifts that follow from the centre distance only; `follows` marks these.
pub fn shifts(path: &str, spec: &PairSpec, pair: &Pair, follows: [bool; 2], most: f64) -> Option<Diagnostic> {
    let [x1, x2] = pair.profile_shift;
    let largest = match follows {
        [true, true] => (x1 + x2).abs(),
        [true, false] => x1.abs(),
        [false, true] => x2.abs(),
        [false, false] => 0.0,
    };
    if largest <= most {
        return None;
    }
    let modules: Vec<String> = (0..2)
        .filter(|i| follows[*i])
        .map(|i| format!("x{} = {:.3}", i + 1, pair.profile_shift[i]))
        .collect();
    let warning = Diagnostic::warning(
        path,
        format!(
            "profile shift {} follows from the centre distance of {:.4} mm only",
            modules.join(", "),
            pair.centre_distance * 1e3
        ),
    )
    .help("check the numbers of teeth, the module and the centre distance, or state `profile_shift` of both gears");
    Some(match fitting_teeth(spec, pair.centre_distance) {
        Some((teeth, shift)) => warning.note(other_teeth(teeth, pair.z[1], shift)),
        None => warning,
    })
}

fn other_teeth(teeth: u32, instead_of: u32, shift: f64) -> String {
    // Never a negative zero.
    let shift = (1e3 * shift).round() / 1e3 + 0.0;
    format!("with {teeth} teeth instead of {instead_of} the second gear would have x2 = {shift:.3}")
}

/// Reports teeth that are pointed, undercut, touch the root of their mate or slide much.
pub fn teeth(path: &str, pair: &Pair, gears: [&str; 2], ranges: &PlausibilityEntry) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut report = |message: String, help: &str| found.push(Diagnostic::warning(path, message).help(help));
    let module = pair.normal_module;
    let sliding = pair.specific_sliding();
    for (gear, id) in gears.into_iter().enumerate() {
        let mate = gears[1 - gear];
        let clearance = pair.tip_clearance(gear);
        if clearance < ranges.tip_clearance * module {
            report(
                format!(
                    "the tip of `{id}` has {:.3} mm clearance to the root of `{mate}` ({:.2} of the module)",
                    1e3 * clearance,
                    clearance / module
                ),
                "check `tip_diameter` and `root_diameter`, or write `tip_shortening: true`",
            );
        }
        if sliding[gear] < -ranges.specific_sliding {
            report(
                format!(
                    "`{id}` has a specific sliding of {:.2} at the lowest point of its contacting flank",
                    sliding[gear]
                ),
                "check the profile shifts and the tip diameter of the mate",
            );
        }
        if pair.internal && gear == 1 {
            continue;
        }
        let width = pair.tip_width(gear);
        if width < ranges.tip_width * module {
            report(
                format!(
                    "the teeth of `{id}` are {:.3} mm wide at the tip ({:.2} of the module)",
                    1e3 * width,
                    width / module
                ),
                "check `profile_shift` and `tip_diameter`",
            );
        }
        let (shift, limit) = (pair.profile_shift[gear], pair.undercut_limit(gear));
        if limit - shift > ranges.undercut {
            report(
                format!("the teeth of `{id}` are undercut: x = {shift:.3}, and undercut begins below {limit:.3}"),
                "check `z` and `profile_shift`",
            );
        }
    }
    found
}

/// The number of teeth of the second gear that best matches the centre distance in m, with its remaining profile shift.
fn fitting_teeth(spec: &PairSpec, centre_distance: f64) -> Option<(u32, f64)> {
    let module_t = spec.normal_module / spec.helix_angle.cos();
    let teeth = (2.0 * centre_distance / module_t - spec.sign() * f64::from(spec.z[0])).round();
    if teeth < 5.0 || teeth == f64::from(spec.z[1]) {
        return None;
    }
    let other = Pair::new(&PairSpec {
        z: [spec.z[0], teeth as u32],
        centre_distance: Some(centre_distance),
        profile_shift: [Some(spec.profile_shift[0].unwrap_or(0.0)), None],
        tip_diameter: [None, spec.internal.then_some(module_t * (teeth - 2.0))],
        root_diameter: [None, None],
        ..*spec
    })
    .ok()?;
    Some((other.z[1], other.profile_shift[1]))
}

/// Reports viscosities that no oil has, such as those with a slip of three digits.
pub fn viscosities(id: &str, oil: &Lubricant, ranges: &PlausibilityEntry) -> Vec<Diagnostic> {
    let [cold, hot] = [40.0, 100.0].map(|at| 1e6 * oil.oil_at(at).nu);
    let warning = |message: String, keys: &str| {
        Diagnostic::warning(format!("lubricants.{id}.viscosity"), message).help(format!(
            "check the numbers and their units; if the oil is so, set {keys} under `plausibility`"
        ))
    };
    let mut found = Vec::new();
    if !(1e6 * ranges.least_kv40..=1e6 * ranges.greatest_kv40).contains(&cold) {
        let message = format!("an oil of {cold:.4} mm2/s at 40 degC");
        found.push(warning(message, "`least_kv40` or `greatest_kv40`"));
    }
    if let Some(index) = index(cold, hot)
        && !(ranges.least_viscosity_index..=ranges.greatest_viscosity_index).contains(&index)
    {
        let message =
            format!("{cold:.4} mm2/s at 40 degC and {hot:.4} mm2/s at 100 degC are a viscosity index of {index:.0}");
        found.push(warning(
            message,
            "`least_viscosity_index` or `greatest_viscosity_index`",
        ));
    }
    found
}

/// Reports an oil level below the lowest tip circle.
pub(crate) fn oil_level(
    entry: &GearboxEntry,
    gears: &[GearSeat],
    levels: &[Level],
    oils: &OilNumbers<'_>,
) -> Option<Diagnostic> {
    let surface = oils.highest()?;
    let lowest = gears
        .iter()
        .zip(levels)
        .filter(|(gear, level)| gear.diameters[1] > 0.0 && **level != Level::Dry)
        .map(|(gear, level)| {
            let height = match *level {
                Level::Dry => f64::NEG_INFINITY,
                Level::Own(level) => level,
                // At the lowest point of an orbit.
                Level::Sump {
                    height, slope, orbit, ..
                } => (surface - height) * slope + orbit,
            };
            // Outer radius: the root radius of a ring gear is close to its tip radius, and its lowest teeth are immersed first.
            let radius = 0.5 * gear.diameters[1].max(gear.diameters[2]);
            (gear, height + radius)
        })
        .max_by(|(_, a), (_, b)| a.total_cmp(b));
    let (gear, depth) = lowest.filter(|(_, depth)| *depth <= 0.0)?;
    let key = match entry.housing.oil.as_ref() {
        Some(oil) if oil.level.is_some() => "level",
        Some(oil) if oil.running_level.is_some() => "running_level",
        _ => "volume",
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
