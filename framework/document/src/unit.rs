//! Units of quantities. Internally all values are SI; temperatures are degC.

mod grammar;

/// Dimension of a unit. Quantities of different dimensions never convert.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// A plain number.
    None,
    /// A number in percent, where the key says so.
    Percent,
    /// Length, m.
    Length,
    /// Area, m2.
    Area,
    /// Volume, m3.
    Volume,
    /// Angle, rad.
    Angle,
    /// Angular speed, rad/s.
    AngularSpeed,
    /// Speed, m/s.
    Speed,
    /// Torque, N m.
    Torque,
    /// Force, N.
    Force,
    /// Force per length, N/m; also a stiffness.
    LineLoad,
    /// Angular stiffness, N m/rad.
    AngularStiffness,
    /// Power, W.
    Power,
    /// Energy, J.
    Energy,
    /// Mass, kg.
    Mass,
    /// Moment of inertia, kg m2.
    Inertia,
    /// Density, kg/m3.
    Density,
    /// Kinematic viscosity, m2/s.
    KinematicViscosity,
    /// Dynamic viscosity, Pa s.
    DynamicViscosity,
    /// Temperature, degC.
    Temperature,
    /// Temperature difference, K.
    TemperatureDifference,
    /// Thermal expansion, 1/K.
    Expansion,
    /// Pressure or modulus, Pa.
    Pressure,
    /// One over a pressure, 1/Pa.
    PressureCoefficient,
    /// Time, s.
    Time,
    /// Acceleration, m/s2.
    Acceleration,
    /// Angular acceleration, rad/s2.
    AngularAcceleration,
    /// Force per speed, N s/m.
    SpeedResistance,
    /// Force per square of speed, N s2/m2.
    SquareResistance,
    /// Volume flow, m3/s.
    Flow,
    /// Mass flow, kg/s.
    MassFlow,
    /// Heat transfer coefficient, W/(m2 K).
    HeatTransfer,
    /// Heat per temperature difference, J/K.
    HeatCapacity,
    /// Heat flow per temperature difference, W/K.
    Conductance,
    /// Temperature difference per heat flow, K/W.
    Resistance,
    /// Thermal conductivity, W/(m K).
    Conductivity,
    /// Specific heat, J/(kg K).
    SpecificHeat,
    /// Electric voltage, V.
    Voltage,
    /// Electric current, A.
    Current,
    /// Electric resistance, ohm.
    ElectricResistance,
    /// Electric charge, A s.
    Charge,
}

impl Dimension {
    /// Name with article, for messages.
    pub fn with_article(self) -> String {
        let name = self.name();
        let article = if name.starts_with(['a', 'e', 'i', 'o', 'u']) {
            "an"
        } else {
            "a"
        };
        format!("{article} {name}")
    }

    /// Name in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "plain number",
            Self::Percent => "percentage",
            Self::Length => "length",
            Self::Area => "area",
            Self::Volume => "volume",
            Self::Angle => "angle",
            Self::AngularSpeed => "angular speed",
            Self::Speed => "speed",
            Self::Torque => "torque",
            Self::Force => "force",
            Self::LineLoad => "force per length",
            Self::AngularStiffness => "angular stiffness",
            Self::Power => "power",
            Self::Energy => "energy",
            Self::Mass => "mass",
            Self::Inertia => "moment of inertia",
            Self::Density => "density",
            Self::KinematicViscosity => "kinematic viscosity",
            Self::DynamicViscosity => "dynamic viscosity",
            Self::Temperature => "temperature",
            Self::TemperatureDifference => "temperature difference",
            Self::Expansion => "thermal expansion",
            Self::Pressure => "pressure",
            Self::PressureCoefficient => "pressure coefficient",
            Self::Time => "time",
            Self::Acceleration => "acceleration",
            Self::AngularAcceleration => "angular acceleration",
            Self::SpeedResistance => "force per speed",
            Self::SquareResistance => "force per square of speed",
            Self::Flow => "volume flow",
            Self::MassFlow => "mass flow",
            Self::HeatTransfer => "heat transfer coefficient",
            Self::HeatCapacity => "heat capacity",
            Self::Conductance => "thermal conductance",
            Self::Resistance => "thermal resistance",
            Self::Conductivity => "thermal conductivity",
            Self::SpecificHeat => "specific heat",
            Self::Voltage => "voltage",
            Self::Current => "current",
            Self::ElectricResistance => "electric resistance",
            Self::Charge => "electric charge",
        }
    }
}

/// One spelling of a unit.
#[derive(Debug, PartialEq)]
pub struct Unit {
    /// Symbol.
    pub symbol: &'static str,
    /// Dimension.
    pub dimension: Dimension,
    /// SI value of one.
    pub factor: f64,
    /// SI value of zero.
    pub offset: f64,
}

const PI: f64 = std::f64::consts::PI;

const fn unit(symbol: &'static str, dimension: Dimension, factor: f64) -> Unit {
    Unit {
        symbol,
        dimension,
        factor,
        offset: 0.0,
    }
}

/// Whether texts are equal; `==` does not work in constants.
const fn is_same(mut a: &[u8], mut b: &[u8]) -> bool {
    while let (Some((first, rest)), Some((other, others))) = (a.split_first(), b.split_first()) {
        if *first != *other {
            return false;
        }
        (a, b) = (rest, others);
    }
    a.is_empty() && b.is_empty()
}

/// The usual units, the most usual one of each dimension first; `grammar` reads all others and other spellings. The factors are those of
/// the first version to the bit.
const UNITS: &[Unit] = &[
    unit("-", Dimension::None, 1.0),
    unit("%", Dimension::Percent, 1.0),
    unit("mm", Dimension::Length, 1e-3),
    unit("um", Dimension::Length, 1e-6),
    unit("cm", Dimension::Length, 1e-2),
    unit("m", Dimension::Length, 1.0),
    unit("in", Dimension::Length, 25.4e-3),
    unit("ft", Dimension::Length, 0.3048),
    unit("mm2", Dimension::Area, 1e-6),
    unit("cm2", Dimension::Area, 1e-4),
    unit("m2", Dimension::Area, 1.0),
    unit("in2", Dimension::Area, 6.4516e-4),
    unit("ft2", Dimension::Area, 0.09290304),
    unit("l", Dimension::Volume, 1e-3),
    unit("ml", Dimension::Volume, 1e-6),
    unit("cm3", Dimension::Volume, 1e-6),
    unit("mm3", Dimension::Volume, 1e-9),
    unit("m3", Dimension::Volume, 1.0),
    unit("gal", Dimension::Volume, 3.785411784e-3),
    unit("deg", Dimension::Angle, PI / 180.0),
    unit("rad", Dimension::Angle, 1.0),
    unit("rpm", Dimension::AngularSpeed, PI / 30.0),
    unit("rad/s", Dimension::AngularSpeed, 1.0),
    unit("Hz", Dimension::AngularSpeed, 2.0 * PI),
    unit("m/s", Dimension::Speed, 1.0),
    unit("mm/min", Dimension::Speed, 1e-3 / 60.0),
    unit("km/h", Dimension::Speed, 1.0 / 3.6),
    unit("mph", Dimension::Speed, 0.44704),
    unit("Nm", Dimension::Torque, 1.0),
    unit("mNm", Dimension::Torque, 1e-3),
    unit("N mm", Dimension::Torque, 1e-3),
    unit("kNm", Dimension::Torque, 1e3),
    unit("lbf ft", Dimension::Torque, 1.3558179483314004),
    unit("lbf in", Dimension::Torque, 0.1129848290276167),
    unit("N", Dimension::Force, 1.0),
    unit("kN", Dimension::Force, 1e3),
    unit("lbf", Dimension::Force, 4.4482216152605),
    unit("N/mm", Dimension::LineLoad, 1e3),
    unit("N/um", Dimension::LineLoad, 1e6),
    unit("kN/mm", Dimension::LineLoad, 1e6),
    unit("N/m", Dimension::LineLoad, 1.0),
    unit("Nm/rad", Dimension::AngularStiffness, 1.0),
    unit("W", Dimension::Power, 1.0),
    unit("kW", Dimension::Power, 1e3),
    unit("hp", Dimension::Power, 745.6998715822702),
    unit("PS", Dimension::Power, 735.49875),
    unit("J", Dimension::Energy, 1.0),
    unit("kJ", Dimension::Energy, 1e3),
    unit("MJ", Dimension::Energy, 1e6),
    unit("Wh", Dimension::Energy, 3.6e3),
    unit("kWh", Dimension::Energy, 3.6e6),
    unit("kg", Dimension::Mass, 1.0),
    unit("g", Dimension::Mass, 1e-3),
    unit("t", Dimension::Mass, 1e3),
    unit("lb", Dimension::Mass, 0.45359237),
    unit("kg m2", Dimension::Inertia, 1.0),
    unit("kg cm2", Dimension::Inertia, 1e-4),
    unit("kg/m3", Dimension::Density, 1.0),
    unit("kg/l", Dimension::Density, 1e3),
    unit("g/cm3", Dimension::Density, 1e3),
    unit("mm2/s", Dimension::KinematicViscosity, 1e-6),
    unit("cSt", Dimension::KinematicViscosity, 1e-6),
    unit("m2/s", Dimension::KinematicViscosity, 1.0),
    unit("mPa s", Dimension::DynamicViscosity, 1e-3),
    unit("cP", Dimension::DynamicViscosity, 1e-3),
    unit("Pa s", Dimension::DynamicViscosity, 1.0),
    unit("K", Dimension::TemperatureDifference, 1.0),
    unit("degC", Dimension::Temperature, 1.0),
    Unit {
        symbol: "degF",
        dimension: Dimension::Temperature,
        factor: 5.0 / 9.0,
        offset: -160.0 / 9.0,
    },
    // An absolute temperature where one is due; elsewhere K is a difference.
    Unit {
        symbol: "K",
        dimension: Dimension::Temperature,
        factor: 1.0,
        offset: -273.15,
    },
    unit("1/K", Dimension::Expansion, 1.0),
    unit("Pa", Dimension::Pressure, 1.0),
    unit("kPa", Dimension::Pressure, 1e3),
    unit("bar", Dimension::Pressure, 1e5),
    unit("MPa", Dimension::Pressure, 1e6),
    unit("N/mm2", Dimension::Pressure, 1e6),
    unit("GPa", Dimension::Pressure, 1e9),
    unit("psi", Dimension::Pressure, 6894.757293168361),
    unit("1/GPa", Dimension::PressureCoefficient, 1e-9),
    unit("1/Pa", Dimension::PressureCoefficient, 1.0),
    unit("s", Dimension::Time, 1.0),
    unit("ms", Dimension::Time, 1e-3),
    unit("min", Dimension::Time, 60.0),
    unit("h", Dimension::Time, 3600.0),
    unit("m/s2", Dimension::Acceleration, 1.0),
    unit("rpm/s", Dimension::AngularAcceleration, PI / 30.0),
    unit("rad/s2", Dimension::AngularAcceleration, 1.0),
    unit("N s/m", Dimension::SpeedResistance, 1.0),
    unit("N/(km/h)", Dimension::SpeedResistance, 3.6),
    unit("N s2/m2", Dimension::SquareResistance, 1.0),
    unit("N/(km/h)2", Dimension::SquareResistance, 12.96),
    unit("l/min", Dimension::Flow, 1e-3 / 60.0),
    unit("m3/s", Dimension::Flow, 1.0),
    unit("gal/min", Dimension::Flow, 3.785411784e-3 / 60.0),
    unit("kg/s", Dimension::MassFlow, 1.0),
    unit("kg/min", Dimension::MassFlow, 1.0 / 60.0),
    unit("g/s", Dimension::MassFlow, 1e-3),
    unit("W/(m2 K)", Dimension::HeatTransfer, 1.0),
    unit("W/K", Dimension::Conductance, 1.0),
    unit("K/W", Dimension::Resistance, 1.0),
    unit("W/(m K)", Dimension::Conductivity, 1.0),
    unit("J/K", Dimension::HeatCapacity, 1.0),
    unit("kJ/K", Dimension::HeatCapacity, 1e3),
    unit("J/(kg K)", Dimension::SpecificHeat, 1.0),
    unit("kJ/(kg K)", Dimension::SpecificHeat, 1e3),
    unit("V", Dimension::Voltage, 1.0),
    unit("A", Dimension::Current, 1.0),
    unit("mohm", Dimension::ElectricResistance, 1e-3),
    unit("ohm", Dimension::ElectricResistance, 1.0),
    unit("Ah", Dimension::Charge, 3600.0),
    unit("A s", Dimension::Charge, 1.0),
];

impl Unit {
    /// The plain number.
    pub const ONE: &'static Unit = &unit("-", Dimension::None, 1.0);

    /// The unit of one of the program's own symbols; [`Unit::read`] reads what users write.
    pub const fn of_symbol(symbol: &str) -> Option<&'static Unit> {
        Self::of_bytes(symbol.as_bytes())
    }

    const fn of_bytes(symbol: &[u8]) -> Option<&'static Unit> {
        let mut units = UNITS;
        while let Some((unit, others)) = units.split_first() {
            if is_same(unit.symbol.as_bytes(), symbol) {
                return Some(unit);
            }
            units = others;
        }
        None
    }

    /// The SI unit of a dimension.
    pub fn si(dimension: Dimension) -> Option<&'static Unit> {
        let is_si = |u: &&Unit| u.dimension == dimension && u.factor.to_bits() == 1.0_f64.to_bits() && u.offset == 0.0;
        UNITS.iter().find(is_si)
    }

    /// The unit in brackets at the end of a doc comment.
    pub const fn of_doc(doc: &str) -> Option<&'static Unit> {
        let doc = doc.trim_ascii_end().as_bytes();
        let Some((b']', inner)) = doc.split_last() else {
            return None;
        };
        let mut rest = inner;
        while let Some((last, before)) = rest.split_last() {
            if *last == b'[' {
                let (_, symbol) = inner.split_at(rest.len());
                return Self::of_bytes(symbol);
            }
            rest = before;
        }
        None
    }

    /// The usual symbols of a dimension.
    pub fn symbols(dimension: Dimension) -> impl Iterator<Item = &'static str> {
        UNITS.iter().filter(move |u| u.dimension == dimension).map(|u| u.symbol)
    }

    /// All usual symbols.
    pub fn all_symbols() -> impl Iterator<Item = &'static str> {
        UNITS.iter().map(|u| u.symbol)
    }

    /// A number in this unit, in SI.
    #[inline]
    pub const fn to_si(&self, x: f64) -> f64 {
        x * self.factor + self.offset
    }

    /// True if a number in this unit is the SI value.
    #[inline]
    pub fn is_si(&self) -> bool {
        self.factor == 1.0 && self.offset == 0.0
    }

    /// An SI value in this unit.
    #[inline]
    pub fn from_si(&self, si: f64) -> f64 {
        (si - self.offset) / self.factor
    }

    /// Regular expression of a quantity of this unit's dimension written as text.
    pub fn pattern(&self) -> String {
        format!(
            "^[+-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)? ?({})$",
            grammar::pattern(self.dimension)
        )
    }

    /// How numbers in this unit become SI.
    pub const fn conversion(&self) -> Conversion {
        Conversion {
            dimension: self.dimension,
            factor: self.factor,
            offset: self.offset,
        }
    }

    /// A unit in any known spelling, of whatever dimension; `K` is a difference of temperatures, `%` a hundredth.
    pub fn read(text: &str) -> Option<Conversion> {
        match Self::of_symbol(text) {
            Some(unit) if unit.dimension != Dimension::Percent => Some(unit.conversion()),
            _ => grammar::read(text, None),
        }
    }

    /// Whether two texts are the same unit in perhaps different spellings.
    pub fn is_same(a: &str, b: &str) -> bool {
        a == b || Self::read(a).is_some_and(|unit| Self::read(b) == Some(unit))
    }

    /// A unit of a dimension in any known spelling. This is the only reader of the units that users write.
    ///
    /// # Errors
    /// If it is unknown or of another dimension, with a help that does not repeat the number with another unit.
    pub fn read_as(text: &str, dimension: Dimension) -> Result<Conversion, UnitFault> {
        let listed = UNITS
            .iter()
            .find(|unit| unit.dimension == dimension && unit.symbol == text);
        match listed {
            Some(unit) => Ok(unit.conversion()),
            None => grammar::read(text, Some(dimension)).ok_or_else(|| UnitFault::new(text, dimension)),
        }
    }
}

/// How numbers in a unit become SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conversion {
    /// Dimension of the unit.
    pub dimension: Dimension,
    /// SI value of one, less that of zero.
    pub factor: f64,
    /// SI value of zero.
    pub offset: f64,
}

impl Conversion {
    /// A number in this unit, in SI.
    #[inline]
    pub fn to_si(&self, x: f64) -> f64 {
        x * self.factor + self.offset
    }

    /// The number in this unit from which the same bits in SI are read; `None` if it has more than 13 digits.
    pub fn written(&self, si: f64) -> Option<f64> {
        let converted = (si - self.offset) / self.factor;
        let tidy: f64 = format!("{converted:.12e}").parse().unwrap_or(converted);
        (self.to_si(tidy).to_bits() == si.to_bits()).then_some(tidy)
    }
}

/// A unit that is not read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnitFault {
    /// What is wrong.
    pub message: String,
    /// How to fix it.
    pub help: String,
}

impl UnitFault {
    /// The fault of a text that is no unit of a dimension.
    pub fn new(text: &str, dimension: Dimension) -> Self {
        let message = match Unit::read(text) {
            Some(found) => format!(
                "`{text}` is {}, not {}",
                found.dimension.with_article(),
                dimension.with_article()
            ),
            None => format!("unknown unit `{text}`"),
        };
        let known = if dimension == Dimension::None {
            "this is a plain number: only `%` may follow it".to_owned()
        } else {
            let symbols: Vec<&str> = Unit::symbols(dimension).collect();
            format!("{} is written in {}", dimension.with_article(), symbols.join(", "))
        };
        let is_dynamic = Unit::read(text).is_some_and(|found| found.dimension == Dimension::DynamicViscosity);
        let why = match dimension {
            // Oils have keys for both.
            Dimension::KinematicViscosity if is_dynamic => Some(
                "divide a dynamic viscosity by the density, or state it in an oil as `eta40`, `eta100` or `dynamic`",
            ),
            _ => grammar::why_refused(text, dimension),
        };
        let help = match why {
            Some(why) => format!("{why}; {known}"),
            None => known,
        };
        Self { message, help }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_symbol_is_written_once_and_converts_there_and_back() {
        for (i, u) in UNITS.iter().enumerate() {
            let is_other = |v: &Unit| (v.symbol, v.dimension) != (u.symbol, u.dimension);
            assert!(UNITS[..i].iter().all(is_other), "{}", u.symbol);
            for x in [-40.0, 0.0, 1.0, 123.456] {
                let back = u.from_si(u.to_si(x));
                assert!((back - x).abs() <= 1e-12 * (1.0 + x.abs()), "{} {x} {back}", u.symbol);
            }
        }
        assert!((Unit::of_symbol("degF").unwrap().to_si(212.0) - 100.0).abs() < 1e-12);
    }

    #[test]
    fn every_dimension_has_a_unit_of_one_in_si() {
        for u in UNITS {
            assert_eq!(
                Unit::si(u.dimension).map(|si| si.dimension),
                Some(u.dimension),
                "{}",
                u.symbol
            );
        }
    }

    #[test]
    fn mass_flows_are_read_in_three_units() {
        let flow = Unit::of_doc("Mass flow of the oil. [kg/s]").unwrap();
        assert_eq!(flow.dimension, Dimension::MassFlow);
        let symbols: Vec<&str> = Unit::symbols(Dimension::MassFlow).collect();
        assert_eq!(symbols, ["kg/s", "kg/min", "g/s"]);
        for (symbol, si) in [("kg/s", 6.0), ("kg/min", 0.1), ("g/s", 0.006)] {
            assert!(
                (Unit::of_symbol(symbol).unwrap().to_si(6.0) - si).abs() < 1e-15,
                "{symbol}"
            );
        }
    }

    #[test]
    fn the_unit_of_a_doc_comment_stands_in_brackets_at_its_end() {
        assert_eq!(Unit::of_doc(" Bore diameter. [mm]").unwrap().symbol, "mm");
        assert!(Unit::of_doc("No unit.").is_none());
        assert!(Unit::of_doc("Strange. [furlong]").is_none());
    }
    #[test]
    fn road_loads_and_accelerations_convert() {
        for (symbol, dimension, si) in [
            ("N s/m", Dimension::SpeedResistance, 1.0),
            ("N/(km/h)", Dimension::SpeedResistance, 3.6),
            ("N s2/m2", Dimension::SquareResistance, 1.0),
            ("N/(km/h)2", Dimension::SquareResistance, 3.6 * 3.6),
            ("m/s2", Dimension::Acceleration, 1.0),
            ("rpm/s", Dimension::AngularAcceleration, PI / 30.0),
        ] {
            let unit = Unit::of_symbol(symbol).unwrap();
            assert_eq!(unit.dimension, dimension, "{symbol}");
            assert!((unit.to_si(1.0) - si).abs() < 1e-12, "{symbol}");
        }
    }
}
