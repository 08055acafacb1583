//! Thermal properties of the flanks of two gears: those that a model states, else those of the gears' materials, else of steel.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::material::{Conductor, Material, MaterialKind};
use gearloss_framework::registry::Build;

/// What is known of a material: its kind, and its thermal properties.
pub fn known(material: Material) -> (MaterialKind, Option<Conductor>) {
    (material.kind, material.thermal)
}

/// Thermal properties of both flanks, from what the model states for both, else from the materials, else those of a steel.
///
/// # Errors
/// If a gear is of plastic and its thermal properties are not known: those of steel would be wrong by orders of magnitude.
pub fn flanks(
    stated: [Option<f64>; 3],
    steel: Conductor,
    materials: [(MaterialKind, Option<Conductor>); 2],
    cx: &Build<'_>,
) -> Result<[Conductor; 2], Diagnostic> {
    let unknown = |(kind, thermal): &(MaterialKind, Option<Conductor>)| kind.is_plastic() && thermal.is_none();
    if stated.contains(&None) && materials.iter().any(unknown) {
        return Err(cx
            .error("the thermal properties of a plastic gear are not known")
            .help("state `conductivity`, `density` and `heat_capacity` of its material"));
    }
    let [conductivity, density, heat_capacity] = stated;
    Ok(materials.map(|(_, thermal)| {
        let own = thermal.unwrap_or(steel);
        Conductor {
            conductivity: conductivity.unwrap_or(own.conductivity),
            density: density.unwrap_or(own.density),
            heat_capacity: heat_capacity.unwrap_or(own.heat_capacity),
        }
    }))
}
