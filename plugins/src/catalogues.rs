//! Catalogues as registered data.

use gearloss_framework::origin;
use gearloss_framework::registry::{Catalogue, inventory};

inventory::submit! {
    Catalogue {
        section: "bearings",
        csv: include_str!("../catalogues/bearings.csv"),
        source: "Public catalogue data of rolling bearings; boundary dimensions according to ISO 15. Each row states its confidence.",
        origin: origin!(),
    }
}

inventory::submit! {
    Catalogue {
        section: "bearings",
        csv: include_str!("../catalogues/bearings-typical.csv"),
        source: "Typical ratings: means over the catalogues of two to five makers, a statistic of this project and no maker's figures; boundary dimensions according to ISO 15, ISO 355 and ISO 104. Each row states how many makers and how far apart they are.",
        origin: origin!(),
    }
}

inventory::submit! {
    Catalogue {
        section: "lubricants",
        csv: include_str!("../catalogues/lubricants.csv"),
        source: "Typical gear oils: constants of a public gear oil library and published data sheets. Each row states its basis.",
        origin: origin!(),
    }
}

inventory::submit! {
    Catalogue {
        section: "materials",
        csv: include_str!("../catalogues/materials.csv"),
        source: "Materials of gears: libraries of public gear programs and data sheets. Each row states its basis.",
        origin: origin!(),
    }
}

#[cfg(test)]
mod bearings;

#[cfg(test)]
mod tests {
    use crate::printed::Printed;

    /// Outside diameters of a series grow with the bore (ISO 15), and C0/C, f0 and C0/Pu of deep groove ball bearings stay near those of their
    /// neighbours: a row that mixes two bearings breaks these rules.
    #[test]
    fn rows_of_a_series_of_bearings_belong_together() {
        let catalogue = Printed::read(include_str!("../catalogues/bearings.csv"));
        let mut series: std::collections::BTreeMap<String, Vec<[f64; 6]>> = std::collections::BTreeMap::new();
        for row in catalogue.rows().filter(|row| row.text("kind") == "deep_groove_ball") {
            let columns = [
                "bore [mm]",
                "outside [mm]",
                "c [N]",
                "c0 [N]",
                "calculation_factor [-]",
                "pu [N]",
            ];
            let values = columns.map(|column| row.number(column));
            series.entry(row.text("series").to_owned()).or_default().push(values);
        }
        assert_eq!(series.len(), 7);
        for (name, rows) in &mut series {
            rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
            for pair in rows.array_windows::<2>() {
                let [a, b] = pair;
                assert!(b[1] > a[1], "{name}: {a:?} {b:?}");
                let ratio = (b[3] / b[2]) / (a[3] / a[2]);
                assert!((0.82..1.2).contains(&ratio), "{name}: C0/C of {a:?} and {b:?}");
            }
            for row in rows {
                assert!((19.0..30.0).contains(&(row[3] / row[5])), "{name}: C0/Pu of {row:?}");
                assert!((11.0..=17.0).contains(&row[4]), "{name}: f0 of {row:?}");
            }
        }
    }

    #[test]
    fn every_oil_follows_from_the_constants_of_its_source() {
        let source = Printed::read(include_str!("../tests/tables/oils.csv"));
        let catalogue = Printed::read(include_str!("../catalogues/lubricants.csv"));
        for line in source.rows() {
            let name = line.text("oil");
            let (base, grade) = name.split_once(' ').unwrap_or((name, ""));
            let designation = match base {
                "fva" => format!("FVA {grade}"),
                "pao" | "pag" => format!("ISO VG {grade} {}", base.to_uppercase()),
                _ => format!("ISO VG {grade} {base}"),
            };
            let oil = catalogue
                .rows()
                .find(|row| row.text("designation") == designation)
                .unwrap_or_else(|| panic!("{designation}"));
            for (column, printed, celsius) in [
                ("viscosity.kv40 [mm2/s]", "nu40", 40.0_f64),
                ("viscosity.kv100 [mm2/s]", "nu100", 100.0),
            ] {
                let lg = line.number("A") - line.number("B") * (celsius + 273.15).log10();
                let nu = 10.0_f64.powf(10.0_f64.powf(lg)) - 0.7;
                // The catalogue gives five digits, the source three or four.
                let cell = oil.number(column);
                assert!(
                    (cell / nu - 1.0).abs() < 5e-5,
                    "{designation}: {column} {cell}, not {nu}"
                );
                assert!(
                    (cell / line.number(printed) - 1.0).abs() < 2e-3,
                    "{designation}: {column} {cell}"
                );
            }
        }
        assert_eq!(source.rows().count(), 19);
    }
}
