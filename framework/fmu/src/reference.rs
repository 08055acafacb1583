//! Reference inputs and outputs, by which a receiver can check the FMU in its own program.
//!
//! Source: FMI Layered Standard References (FMI-LS-REF), 1.0.0-alpha.1. It is a draft; programs that do not know it ignore the folder.

use std::fmt::Write;

use crate::archive::Fmu;
use crate::description::info;
use crate::model::Model;
use crate::variables::{Causality, Slot};

const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";
const MANIFEST: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiReferences
    xmlns:fmi-ls="http://fmi-standard.org/fmi-ls-manifest"
    fmi-ls:fmi-ls-name="org.fmi-standard.fmi-ls-ref"
    fmi-ls:fmi-ls-version="1.0.0-alpha.1"
    fmi-ls:fmi-ls-description="Layered Standard providing information on related files included in an FMU.">
    <Related type="text/csv" source="inputs.csv" role="experiment/smoke-test" description="Inputs of the default experiment, constant over each step"/>
    <Related type="text/csv" source="outputs.csv" role="result" description="Outputs of the default experiment at the end of each step, with the inputs of that step"/>
</fmiReferences>
"#;

/// The files with their names.
pub fn files(fmu: &Fmu<'_>) -> Vec<(String, Vec<u8>)> {
    if fmu.experiment.inputs.is_empty() {
        return Vec::new();
    }
    let (inputs, outputs) = simulated(fmu);
    let named = |name: &str, text: String| (format!("{FOLDER}/{name}"), text.into_bytes());
    vec![
        named("fmi-ls-manifest.xml", MANIFEST.to_owned()),
        named("inputs.csv", inputs),
        named("outputs.csv", outputs),
    ]
}

/// Inputs and outputs of the default experiment as tables.
fn simulated(fmu: &Fmu<'_>) -> (String, String) {
    let mut model = Model::new(fmu.content.clone());
    let slots = model.slots().to_vec();
    let those = |wanted: fn(Causality) -> bool| -> Vec<(u32, Slot)> {
        let numbered = (0..).zip(slots.iter().copied());
        numbered.filter(|(_, slot)| wanted(slot.causality)).collect()
    };
    let ins = those(|c| c == Causality::Input);
    let outs = those(|c| matches!(c, Causality::Output | Causality::State));
    let head = |list: &[(u32, Slot)]| {
        let names = list.iter().map(|(_, slot)| format!(",\"{}\"", info(fmu, slot).name));
        format!("\"time\"{}\n", names.collect::<String>())
    };
    let (mut inputs, mut outputs) = (head(&ins), head(&outs));
    let record = |model: &mut Model, time: f64, to: &mut String, list: &[(u32, Slot)]| {
        let _ = write!(to, "{time}");
        for (reference, slot) in list {
            let _ = write!(to, ",{}", model.get(*reference, slot.kind).unwrap_or(0.0));
        }
        to.push('\n');
    };
    let step = fmu.experiment.step;
    for (i, row) in fmu.experiment.inputs.iter().enumerate() {
        let time = step * i as f64;
        if i == 1 {
            model.start();
        }
        // The outputs at the end of a step still have the inputs at its start.
        if i > 0 {
            let _ = model.advance(step);
            record(&mut model, time, &mut outputs, &outs);
        }
        for ((reference, slot), value) in ins.iter().zip(row) {
            let _ = model.set(*reference, slot.kind, *value);
        }
        record(&mut model, time, &mut inputs, &ins);
        if i == 0 {
            record(&mut model, time, &mut outputs, &outs);
        }
    }
    (inputs, outputs)
}
