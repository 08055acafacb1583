//! Units of REXS, converted to those of gearbox files.

use gearloss_document::Unit;

/// A quantity of gearbox files and its unit there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// \[mm\]
    Length,
    /// \[um\]
    Roughness,
    /// \[deg\]
    Angle,
    /// In rad unless stated. \[rad\]
    RollAngle,
    /// \[N\]
    Force,
    /// Of a bearing; in kN unless stated. \[N\]
    LoadRating,
    /// \[Nm\]
    Moment,
    /// \[W\]
    Power,
    /// \[rpm\]
    Speed,
    /// \[degC\]
    Temperature,
    /// \[mm2/s\]
    Viscosity,
    /// \[kg/m3\]
    Density,
    /// \[N/mm\]
    Stiffness,
    /// \[N/mm\]
    LineLoad,
    /// \[Nm/rad\]
    TiltingStiffness,
    /// \[GPa\]
    Modulus,
    /// \[%\]
    Percent,
    /// \[h\]
    Time,
    /// \[J/(kg K)\]
    HeatCapacity,
    /// \[W/(m K)\]
    Conductivity,
    /// \[cm2\]
    Area,
    /// \[K m2/W\]
    Resistance,
    /// \[kg\]
    Mass,
    /// \[-\]
    Number,
}

use Quantity::{
    Angle, Area, Conductivity, Density, Force, HeatCapacity, Length, LineLoad, LoadRating, Mass, Modulus, Moment,
    Number, Percent, Power, Resistance, RollAngle, Roughness, Speed, Stiffness, Temperature, TiltingStiffness, Time,
    Viscosity,
};

/// Unit as written in REXS, without spaces; quantity; factor to the unit of gearbox files. The first unit of a quantity is that of the
/// specification, which applies where a file states none.
const UNITS: &[(&str, Quantity, f64)] = &[
    ("mm", Length, 1.0),
    ("mum", Length, 1e-3),
    ("m", Length, 1e3),
    ("mum", Roughness, 1.0),
    ("mm", Roughness, 1e3),
    ("deg", Angle, 1.0),
    ("°", Angle, 1.0),
    ("rad", Angle, 180.0 / std::f64::consts::PI),
    ("rad", RollAngle, 1.0),
    ("deg", RollAngle, std::f64::consts::PI / 180.0),
    ("°", RollAngle, std::f64::consts::PI / 180.0),
    ("N", Force, 1.0),
    ("kN", Force, 1e3),
    ("kN", LoadRating, 1e3),
    ("N", LoadRating, 1.0),
    ("Nm", Moment, 1.0),
    ("Nmm", Moment, 1e-3),
    ("kNm", Moment, 1e3),
    ("kW", Power, 1e3),
    ("W", Power, 1.0),
    ("1/min", Speed, 1.0),
    ("1/s", Speed, 60.0),
    ("rad/s", Speed, 30.0 / std::f64::consts::PI),
    ("C", Temperature, 1.0),
    ("°C", Temperature, 1.0),
    ("K", Temperature, 1.0),
    ("mm^2/s", Viscosity, 1.0),
    ("kg/dm^3", Density, 1e3),
    ("g/cm^3", Density, 1e3),
    ("kg/m^3", Density, 1.0),
    ("N/m", Stiffness, 1e-3),
    ("N/mm", Stiffness, 1.0),
    ("N/mm", LineLoad, 1.0),
    ("N/m", LineLoad, 1e-3),
    ("Nmm/rad", TiltingStiffness, 1e-3),
    ("Nm/rad", TiltingStiffness, 1.0),
    ("MPa", Modulus, 1e-3),
    ("N/mm^2", Modulus, 1e-3),
    ("GPa", Modulus, 1.0),
    ("%", Percent, 1.0),
    ("h", Time, 1.0),
    ("min", Time, 1.0 / 60.0),
    ("s", Time, 1.0 / 3600.0),
    ("J/(kgK)", HeatCapacity, 1.0),
    ("W/(mK)", Conductivity, 1.0),
    ("m^2", Area, 1e4),
    ("mm^2", Area, 1e-2),
    ("Km^2/W", Resistance, 1.0),
    ("kg", Mass, 1.0),
    ("none", Number, 1.0),
];

/// A value in the unit of gearbox files; `None` for a unit of another quantity.
pub fn converted(value: f64, unit: &str, quantity: Quantity) -> Option<f64> {
    let unit: String = unit.chars().filter(|c| !c.is_whitespace()).collect();
    let mut known = UNITS
        .iter()
        .filter(|(_, known_quantity, _)| *known_quantity == quantity);
    let listed = if unit.is_empty() || unit == "none" {
        Some(known.next()?)
    } else {
        known.find(|(name, _, _)| *name == unit)
    };
    let Some((name, _, factor)) = listed else {
        return written_otherwise(value, &unit, quantity);
    };
    let offset = if *name == "K" && quantity == Temperature {
        -273.15
    } else {
        0.0
    };
    Some(value * factor + offset)
}

/// A value in a unit that the specification does not list.
fn written_otherwise(value: f64, unit: &str, quantity: Quantity) -> Option<f64> {
    let target = Unit::of_symbol(match quantity {
        Length => "mm",
        Roughness => "um",
        Angle => "deg",
        RollAngle => "rad",
        Force | LoadRating => "N",
        Moment => "Nm",
        Power => "W",
        Speed => "rpm",
        Temperature => "degC",
        Viscosity => "mm2/s",
        Density => "kg/m3",
        Stiffness | LineLoad => "N/mm",
        TiltingStiffness => "Nm/rad",
        Modulus => "GPa",
        Time => "h",
        HeatCapacity => "J/(kg K)",
        Conductivity => "W/(m K)",
        Area => "cm2",
        Mass => "kg",
        Percent | Resistance | Number => return None,
    })?;
    let unit = Unit::read_as(unit, target.dimension).ok()?;
    Some(target.from_si(unit.to_si(value)))
}

/// The units in which a quantity can be written.
pub fn known(quantity: Quantity) -> String {
    let names = UNITS
        .iter()
        .filter(|(_, known_quantity, _)| *known_quantity == quantity);
    names.map(|(name, _, _)| *name).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn units_are_converted_and_spelled_in_any_version() {
        for (unit, value, quantity, expected) in [
            ("N / mm^2", 210000.0, Modulus, 210.0),
            ("MPa", 210000.0, Modulus, 210.0),
            ("°", 30.0, Angle, 30.0),
            ("deg", 30.0, Angle, 30.0),
            ("kN", 22.4, Force, 22400.0),
            ("", 12.0, Length, 12.0),
            ("none", 22.4, LoadRating, 22400.0),
            ("N", 22400.0, LoadRating, 22400.0),
            ("none", 1500.0, Speed, 1500.0),
            ("K", 343.15, Temperature, 70.0),
            ("C", 70.0, Temperature, 70.0),
            ("rad / s", 100.0, Speed, 954.929658551372),
        ] {
            let found = converted(value, unit, quantity).unwrap();
            assert!((found - expected).abs() < 1e-9, "{unit}: {found}");
        }
        assert_eq!(converted(1.0, "kg", Length), None);
        assert_eq!(known(Force), "N, kN");
    }
}
