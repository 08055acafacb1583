#![allow(clippy::unwrap_used)]

use super::*;

fn read(text: &str, options: &Options) -> Result<Catalogue, Vec<Diagnostic>> {
    let shipped = CatalogueTable::from_file("designation,bore,outside\n6208,40 mm,80 mm\n").unwrap();
    import(text.as_bytes(), "maker.csv", options, Some(&shipped))
}

fn lines(text: &str) -> Vec<&str> {
    text.lines().filter(|line| !line.starts_with('#')).collect()
}

fn refused(text: &str, options: &Options) -> String {
    let found = read(text, options).unwrap_err();
    let lines: Vec<String> = found
        .iter()
        .map(|fault| format!("{} | {:?}", fault.message, fault.help))
        .collect();
    lines.join("\n")
}

fn warned(catalogue: &Catalogue) -> String {
    let lines: Vec<&str> = catalogue
        .warnings
        .iter()
        .map(|warning| warning.message.as_str())
        .collect();
    lines.join("\n")
}

/// Headings in English with symbols, units in a row, thousands with commas, and a row that begins a section.
const ENGLISH: &str = "\
Designation,Bore diameter d,Outside diameter D,Width B,Basic dynamic load rating C,Basic static load rating C0,Fatigue load limit Pu,Reference speed,Limiting speed,Mass,f0,kr
,mm,mm,mm,kN,kN,kN,r/min,r/min,kg,-,-
Single row,,,,,,,,,,,
6208,40,80,18,32.5,19,0.8,\"18,000\",\"11,000\",0.34,14,0.025
NU 208 ECP,40,80,18,62,53,6.7,9500,12000,0.39,,0.15
30208,40,80,19.75,74.9,68,7.65,7500,9000,0.43,,
";

#[test]
fn an_english_table_becomes_a_catalogue() {
    let found = read(ENGLISH, &Options::default()).unwrap();
    let lines = lines(&found.text);
    assert_eq!(
        lines[0],
        "designation,kind,series,bore [mm],outside [mm],width [mm],c [N],c0 [N],pu [N],calculation_factor [-],minimum_load_factor [-],reference_speed [rpm],limiting_speed [rpm],confidence,basis"
    );
    assert_eq!(
        lines[1],
        "6208,deep_groove_ball,62,40,80,18,32500,19000,800,14,0.025,18000,11000,medium,\"maker.csv, line 4\""
    );
    assert_eq!(
        lines[2],
        "NU 208 ECP,cylindrical_roller,2,40,80,18,62000,53000,6700,,0.15,9500,12000,medium,\"maker.csv, line 5\""
    );
    assert!(lines[3].starts_with("30208,tapered_roller,302,40,80,19.75,74900,"));
    let report = found.report.join("\n");
    assert!(
        report.contains("- c [N] from `Basic dynamic load rating C`: 3 of 3 bearings"),
        "{report}"
    );
    assert!(
        report.contains("Not used: Mass") && report.contains("kind from the series in the designation: 3 of 3"),
        "{report}"
    );
    assert!(report.contains("decimal point, thousands with commas"), "{report}");
    assert!(
        warned(&found).contains("bore or outside diameter is blank; this row is omitted"),
        "{}",
        warned(&found)
    );
    assert_eq!(found.rows, 3);
}

#[test]
fn a_german_table_with_decimal_commas_gives_the_same_numbers() {
    let german = "\
Kurzzeichen;Bohrung d [mm];Außendurchmesser D [mm];Breite B [mm];Dynamische Tragzahl C [kN];Statische Tragzahl C0 [kN];\
Ermüdungsgrenzbelastung Pu [kN];Referenzdrehzahl [min-1];Grenzdrehzahl [1/min];Gewicht [kg];Berechnungsfaktor f0;Minimallastfaktor kr
6208;40;80;18;32,5;19;0,8;18.000;11.000;0,34;14;0,025
NU 208 ECP;40;80;18;62;53;6,7;9.500;12.000;0,39;;0,15
30208;40;80;19,75;74,9;68;7,65;7.500;9.000;0,43;–;-
";
    let (english, german) = (
        read(ENGLISH, &Options::default()).unwrap(),
        read(german, &Options::default()).unwrap(),
    );
    let rows = |text: &str| -> Vec<String> {
        lines(text)
            .iter()
            .map(|line| line.split(",medium").next().unwrap().to_owned())
            .collect()
    };
    assert_eq!(rows(&english.text), rows(&german.text));
    assert!(german.warnings.is_empty());
}

#[test]
fn symbols_keep_their_case_and_total_widths_have_precedence() {
    let text = "Lager;d;D;B;T;Cr;C0r;Cur;nG;nB\n;mm;mm;mm;mm;N;N;N;min-1;min-1\n32208;40;80;23;24,75;93500;104000;11400;9700;6800\n6208;40;80;18;;32500;19000;800;11000;18000\n";
    let found = read(text, &Options::default()).unwrap();
    let lines = lines(&found.text);
    assert!(
        lines[1].starts_with("32208,tapered_roller,322,40,80,24.75,93500,104000,11400,6800,9700,"),
        "{}",
        lines[1]
    );
    assert!(
        lines[2].starts_with("6208,deep_groove_ball,62,40,80,18,32500,"),
        "{}",
        lines[2]
    );
}

#[test]
fn other_headings_are_assigned() {
    let text = "Art.,inner,outer,load (dyn)\nX1,40,80,32.5\n";
    let options = |columns: &[&str]| Options {
        columns: columns.iter().map(|text| (*text).to_owned()).collect(),
        kind: Some("deep_groove_ball".to_owned()),
        ..Options::default()
    };
    let told = refused(text, &options(&[]));
    for key in ["designation", "bore", "outside"] {
        assert!(told.contains(&format!("no heading is known as `{key}`")), "{told}");
    }
    let all = ["designation=Art.", "d=inner [mm]", "outside=outer [mm]", "C=load [kN]"];
    let found = read(text, &options(&all)).unwrap();
    assert!(
        lines(&found.text)[1].starts_with("X1,deep_groove_ball,40,80,32500,"),
        "{}",
        found.text
    );
    assert!(refused(text, &options(&["d=inner"])).contains("column `inner` (bore) has no unit"));
    assert!(refused(text, &options(&["d=inner [kg]"])).contains("(bore): `kg` is a mass, not a length"));
    let twice = "Art.;inner [mm];outer [mm]\nX1;40;80\n";
    let both = ["designation=Art.", "d=inner [in]", "outside=outer"];
    assert!(refused(twice, &options(&both)).contains("in `mm` according to the file, in `in` according to --columns"));
    assert!(refused(text, &options(&["dia=inner [mm]"])).contains("`dia` is no key of a catalogue"));
    assert!(refused(text, &options(&["d=iner [mm]"])).contains("there is no column `iner`"));
    let kind = Options {
        kind: Some("deep_groove".to_owned()),
        ..options(&all)
    };
    assert!(refused(text, &kind).contains("--kind `deep_groove` is no kind of bearing"));
}

#[test]
fn unclear_numbers_are_refused() {
    let head = "designation;d [mm];D [mm];C [N]\n";
    let told = refused(&format!("{head}6208;40;80;32.500\n"), &Options::default());
    assert!(
        told.contains("`32.500` in line 2 may have decimals or thousands") && told.contains("--decimal comma"),
        "{told}"
    );
    let stated = Options {
        form: TableForm {
            decimal: Some(Decimal::Comma),
            ..TableForm::default()
        },
        ..Options::default()
    };
    assert!(lines(&read(&format!("{head}6208;40;80;32.500\n"), &stated).unwrap().text)[1].contains(",32500,"));
    let told = refused(&format!("{head}6208;40,5;80.5;32500\n"), &Options::default());
    assert!(told.contains("different decimal signs"), "{told}");
    let told = refused(
        &format!("{head}6208;40;80;about 32\n6209;45;85;x\n"),
        &Options::default(),
    );
    assert!(
        told.contains("line 2, column 4 `C`: `about 32` is not a number") && told.contains("line 3"),
        "{told}"
    );
    let spaces = read(&format!("{head}6208;40;80;32\u{a0}500\n"), &Options::default()).unwrap();
    assert!(spaces.text.contains(",32500,"));
}

#[test]
fn implausible_rows_are_told() {
    let text = "designation,kind,d [mm],D [mm],B [mm],C [N],C0 [N],Pu [N],limiting speed [rpm]\n\
                a,Rillenkugellager,40,80,18,32.5,19,0.8,11000\nb,,80,40,18,32500,19000,800,11000\n\
                c,,40,80,18,32500,1900,800,11\n6208,,41,80,18,32500,19000,800,11000\na,,40,80,18,1,1,1,1\n";
    let found = read(text, &Options::default()).unwrap();
    let told = warned(&found);
    assert!(
        told.contains("line 2: `a`: C is 32.5 N")
            && told.contains("line 3: `b`: the outside diameter 40 mm is not larger"),
        "{told}"
    );
    assert!(
        told.contains("line 4: `c`: C0/C is 0.058")
            && told.contains("Pu/C0 is 0.42")
            && told.contains("limiting_speed is 11 rpm"),
        "{told}"
    );
    assert!(
        told.contains("line 5: `6208`: d 41 mm, D 80 mm; the shipped catalogue has 40 and 80 mm"),
        "{told}"
    );
    assert!(told.contains("line 6: `a` is already in line 2"), "{told}");
    assert_eq!(found.rows, 3);
    assert!(
        refused("designation,kind,d [mm],D [mm]\na,ball,1,2\n", &Options::default())
            .contains("`ball` is no known kind of bearing")
    );
}

/// What is usual for one kind is wrong for another.
#[test]
fn limits_of_ratings_are_those_of_the_kind() {
    let all: Vec<&str> = kind::all().collect();
    for (designation, ratio, told) in [
        ("1208", 0.22, false),
        ("6208", 0.22, true),
        ("6208", 0.6, false),
        ("51208", 5.0, false),
        ("51208", 0.8, true),
        ("30208", 5.0, true),
        ("29412 E", 2.7, false),
        ("22208 E", 0.5, true),
        ("unknown", 5.0, false),
    ] {
        let text = format!(
            "designation,d [mm],D [mm],C [N],C0 [N]\n{designation},40,80,30000,{}\n",
            3e4 * ratio
        );
        let found = read(&text, &Options::default()).unwrap();
        assert_eq!(warned(&found).contains("C0/C"), told, "{designation} {ratio}");
    }
    assert!(
        all.iter()
            .all(|kind| plausible::STATIC_TO_DYNAMIC.iter().any(|row| row.0 == *kind))
    );
}

#[test]
fn the_own_format_is_written_unchanged() {
    let text = "designation,kind,series,bore [mm],outside [mm],width [mm],c [N],c0 [N],e [-],y [-],y0 [-],estimated,confidence,basis\n\
                30208,tapered_roller,302,40,80,19.75,61800,68100,0.37,1.62,0.89,y0,high,two makers\n\
                51208,thrust_ball,512,40,68,19,44400,98000,,,,,medium,one maker\n";
    let found = read(text, &Options::default()).unwrap();
    assert_eq!(lines(&found.text), text.lines().collect::<Vec<_>>());
    assert!(found.warnings.is_empty() && !found.report.iter().any(|line| line.starts_with("Not used")));
}

/// Every key is found by its own name, and no heading belongs to two keys.
#[test]
fn headings_are_unambiguous() {
    for key in KEYS.iter().filter(|key| !key.total && key.name.len() > 1) {
        assert_eq!(headings::key(key.name).unwrap().name, key.name);
    }
    for (heading, name) in [
        ("C₀", "c0"),
        ("Basic static load rating", "c0"),
        ("Bore diameter, d", "bore"),
        ("n_G", "limiting_speed"),
        ("Thermische Bezugsdrehzahl", "reference_speed"),
        ("Dynamische Tragzahl, radial", "c"),
        ("P_u", "pu"),
        ("C_0r", "c0"),
        ("α", "contact_angle"),
        ("Druckwinkel", "contact_angle"),
    ] {
        assert_eq!(headings::key(heading).map(|key| key.name), Some(name), "{heading}");
    }
    assert_eq!(headings::key("Mass"), None);
    assert_eq!(headings::key("x"), None);
    headings::assert_distinct();
}

#[test]
fn changed_tables_never_panic() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as usize
    };
    let letters: Vec<char> = "0.,;-–'\"[]mmkNµ₀ \n#Ü".chars().collect();
    for _ in 0..5000 {
        let mut text: Vec<char> = ENGLISH.chars().collect();
        for _ in 0..=next() % 8 {
            let at = next() % text.len();
            text[at] = letters[next() % letters.len()];
        }
        let text: String = text.into_iter().collect();
        if let Ok(found) = read(&text, &Options::default()) {
            assert!(
                !found.text.contains("NaN") && !found.text.contains("inf"),
                "{}",
                found.text
            );
        }
    }
}
