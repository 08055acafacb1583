//! Every model that fits a part of the two-speed example explains its answer, and the explained numbers are those of the
//! solution, to the last bit.

use crate::common::{self, RPM};
use gearloss_framework::evaluate::Point;
use gearloss_framework::resolve::Choice;

/// Mechanism, part and slot, and another slot that would count a cause twice.
const PLACES: [(&str, &str, &str, Option<&str>); 6] = [
    ("bearing", "bearings.B5", "bearings.B5.model", None),
    ("gear_mesh", "meshes.M1", "meshes.M1.model", None),
    (
        "gear_drag",
        "gears.G4.drag.churning",
        "gears.G4.drag.churning",
        Some("meshes.M2.drag.churning"),
    ),
    (
        "gear_drag",
        "meshes.M2.drag.churning",
        "meshes.M2.drag.churning",
        Some("gears.G4.drag.churning"),
    ),
    ("seal", "seals.D1", "seals.D1.model", None),
    ("synchronizer", "couplings.S2", "couplings.S2.model", None),
];

#[test]
fn every_model_explains_the_number_of_the_solution() {
    let language = common::language();
    let gearbox = common::two_speed(&language);
    let mut explained = 0;
    for (mechanism, path, slot, other) in PLACES {
        for entry in language.registry().models(mechanism).filter(|m| m.name != "table") {
            // The walked example is SI, and an override without units counts in documented ones: other sizes, the same path.
            let (value, _) = language.example_of(entry).unwrap();
            let mut overrides = vec![(slot.to_owned(), value)];
            overrides.extend(other.map(|slot| (slot.to_owned(), "none".into())));
            let choice = Choice {
                overrides,
                ..Choice::default()
            };
            let t = match gearbox.transmission(&language, &choice) {
                Ok(t) => t,
                // A model may ask for what this gearbox has not; then it says what.
                Err(findings) => {
                    let text = format!("{:?}", findings.list);
                    assert!(
                        findings.list.iter().all(|d| d.help.is_some()),
                        "{mechanism}/{}: {text}",
                        entry.name
                    );
                    continue;
                }
            };
            let case = t.case("first", &[], &["input"]).unwrap();
            let mut scratch = t.scratch(&case);
            let point = Point {
                speeds: &[9000.0 * RPM],
                torques: &[12.0],
                ..Point::default()
            };
            let solution = t.evaluate(&case, &point, &[90.0], &mut scratch);
            let Some(part) = t.parts().iter().position(|p| p.path == path) else {
                continue;
            };
            let whole = solution.watts()[part];
            let (loss, trace) = solution.explain(part);
            let what = format!("{mechanism}/{} at {path}", entry.name);
            assert_eq!(loss.watts().to_bits(), whole.to_bits(), "{what}");
            let own_law = ["none", "constant", "formula", "constant_power"].contains(&entry.name);
            assert!(own_law || !trace.into_steps().is_empty(), "{what} shows no step");
            explained += 1;
        }
    }
    assert!(explained > 40, "{explained}");
}
