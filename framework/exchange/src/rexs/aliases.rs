//! Renamed ids: one table for all versions, from the change logs of REXS 1.0 to 2.0. Only ids that the import reads are listed.

/// Component types that another type replaced: old, new.
const COMPONENTS: &[(&str, &str)] = &[
    ("flank_geometry", "cylindrical_gear_flank"),
    ("stage_gear_data", "cylindrical_stage_gear_data"),
    ("fixed_coupling", "coupling"),
];

/// Attributes: old id, id in 2.0, component types with that meaning of the old id; none for all.
const ATTRIBUTES: &[(&str, &str, &[&str])] = &[
    (
        "name",
        "catalogue_designation",
        &[
            "rolling_bearing_with_catalog_geometry",
            "rolling_bearing_with_detailed_geometry",
        ],
    ),
    ("dynamic_capacity", "radial_dynamic_load_rating", &[]),
    ("static_capacity", "radial_static_load_rating", &[]),
    ("load_duration", "operating_time", &[]),
    ("load_duration_fraction", "operating_time_fraction", &[]),
    (
        "arithmetic_average_roughness_flank",
        "arithmetic_mean_roughness_flank_iso_4287_1997",
        &[],
    ),
    ("reference_diameter_din_3975_2017", "reference_diameter_worm_gear", &[]),
    ("pressure_angle_din_3975_2017", "pressure_angle_worm_gear", &[]),
    ("axial_module_din_3975_2017", "axial_module", &[]),
    ("reference_lead_angle_din_3975_2017", "lead_angle_worm_gear", &[]),
    ("tip_diameter_din_3975_2017", "tip_diameter_worm_gear", &[]),
    ("root_diameter_din_3975_2017", "root_diameter_worm_gear", &[]),
    ("flank_form_din_3975_2017", "flank_form", &[]),
    ("face_width_din_3975_2017", "face_width_worm_wheel", &[]),
    (
        "generated_pressure_angle_drive",
        "generated_pressure_angle_on_drive_side",
        &[],
    ),
    (
        "generated_pressure_angle_coast",
        "generated_pressure_angle_on_coast_side",
        &[],
    ),
    (
        "nominal_design_pressure_angle_drive",
        "nominal_design_pressure_angle_on_drive_side",
        &[],
    ),
    (
        "nominal_design_pressure_angle_coast",
        "nominal_design_pressure_angle_on_coast_side",
        &[],
    ),
    (
        "load_sharing_factor_of_calculation_points_agma_925_a03",
        "load_sharing_factor_of_calculation_points_agma_925_2003",
        &[],
    ),
    (
        "roll_angles_of_calculation_points_agma_925_a03",
        "roll_angles_of_calculation_points_agma_925_2003",
        &[],
    ),
    ("basic_addendum_coefficient", "basic_crown_gear_addendum_factor", &[]),
    ("basic_dedendum_coefficient", "basic_crown_gear_dedendum_factor", &[]),
];

/// Values of enumerations that were spelled otherwise: old, new. Hyphens were replaced by underscores.
pub fn newest_value(value: &str) -> String {
    value.trim().replace('-', "_").to_ascii_lowercase()
}

/// The newest name of a component type.
pub fn newest_component(kind: &str) -> &str {
    let renamed = COMPONENTS.iter().find(|(old, _)| *old == kind);
    renamed.map_or(kind, |(_, new)| new)
}

/// The newest id of an attribute of a component type.
pub fn newest_attribute<'a>(component: &str, id: &'a str) -> &'a str {
    let renamed = ATTRIBUTES
        .iter()
        .find(|(old, _, of)| *old == id && (of.is_empty() || of.contains(&component)));
    renamed.map_or(id, |(_, new, _)| new)
}
