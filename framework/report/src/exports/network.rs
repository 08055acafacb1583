//! Functional Mock-up Units of the thermal networks of cycles.

use gearloss_fmu::{Fmu, Version};
use gearloss_framework::document::Diagnostic;
use gearloss_studies::analyses::cycle::{CycleExport, CycleOutcome, NetworkTables};

use crate::codes;
use crate::page::Page;
use crate::text::significant;

/// Adds the requested files, with a line for each; stops at the first error.
pub fn add(outcome: &CycleOutcome, page: &mut Page) {
    for format in &outcome.exports {
        for network in &outcome.networks {
            let (version, suffix) = match format {
                CycleExport::Fmu2 => (Version::Two, "fmi2"),
                CycleExport::Fmu3 => (Version::Three, "fmi3"),
                CycleExport::BearingLoads | CycleExport::RexsLoads => continue,
            };
            let analysis = &outcome.head.analysis;
            let name = format!("{analysis}-{}", network.model_set).replace('/', "-");
            let about = about(network);
            let fmu = Fmu {
                name: name.clone(),
                description: format!("Thermal network by gearloss: {about}"),
                tool: format!("gearloss {}", env!("CARGO_PKG_VERSION")),
                content: &network.content,
                shares: &[],
                experiment: network.experiment.clone(),
                libraries: &outcome.libraries,
            };
            let file = format!("{name}-{suffix}.fmu");
            match fmu.bytes(version) {
                Ok(bytes) => {
                    let platforms: Vec<&str> = outcome
                        .libraries
                        .iter()
                        .map(|library| library.platform.names()[2])
                        .collect();
                    page.line(format!("{analysis}: {file}: {about}; for {}", platforms.join(", ")));
                    page.file(file, bytes);
                }
                Err(reason) => {
                    let path = format!("analyses.{analysis}.export");
                    return page.fault(
                        Diagnostic::error(path, format!("the FMU cannot be written: {reason}"))
                            .help("export fewer gears or cycles in one analysis")
                            .code(codes::EXPORT),
                    );
                }
            }
        }
    }
}

/// Ranges and accuracy as one line.
fn about(network: &NetworkTables) -> String {
    let [oil, nodes] = network.deviation.map(significant);
    let mut about = format!(
        "{}; {} values in tables; over the simulated cycles the oil deviates by at most {oil} K, any node by {nodes} K",
        network.about, network.values
    );
    if network.filled > 0 {
        about.push_str(&format!(
            "; {} loads without a value have the losses of the next smaller torque",
            network.filled
        ));
    }
    about
}
