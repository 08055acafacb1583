//! Files that are broken or made to do harm: findings, and bounded memory.

use allocation_counter::measure;

use crate::common::{PLANETARY, TWO_STAGE, data, refused, text};
use crate::formats::{archive, json_of};

/// The findings of a file, which use at most so many MB.
fn within(bytes: &[u8], most_mb: u64) -> String {
    let mut found = String::new();
    let used = measure(|| found = refused(bytes, "bad.rexs"));
    let peak = used.bytes_max >> 20;
    assert!(peak <= most_mb, "{peak} MB for:\n{}", &found[..found.len().min(300)]);
    found
}

/// The model of two stages with a text replaced.
fn changed(old: &str, new: &str) -> Vec<u8> {
    let text = text(TWO_STAGE);
    let changed = text.replacen(old, new, 1);
    assert_ne!(changed, text, "{old}");
    changed.into_bytes()
}

fn says(bytes: &[u8], expected: &[&str]) {
    let found = within(bytes, 100);
    for text in expected {
        assert!(found.contains(text), "`{text}` is not in:\n{found}");
    }
}

#[test]
fn what_is_no_model_is_refused() {
    says(b"", &["E0801", "begins neither as XML nor as JSON"]);
    says(b"\xef\xbb\xbf   ", &["E0801"]);
    says(b"\xff\xfe<\0m\0", &["byte 1 is not UTF-8 text"]);
    says(b"gearloss: gearbox/1", &["E0801"]);
    says(b"<html/>", &["the first element is `html`, not `model`"]);
    says(b"{}", &["missing field `model`"]);
    says(b"{\"model\": 3}", &["E0801"]);
    says(b"<model version=\"1.4\"/>", &["E0805", "the model has no gears"]);
    says(
        b"<!DOCTYPE a [<!ENTITY b \"c\">]><model/>",
        &["document type declaration"],
    );
    let text = text(TWO_STAGE);
    says(&text.as_bytes()[..text.len() / 2], &["E0801", "the XML is wrong"]);
    let json = json_of(&text);
    says(&json.as_bytes()[..json.len() / 2], &["E0801", "cannot be read"]);
}

#[test]
fn broken_archives_are_refused() {
    let bytes = data(TWO_STAGE);
    let whole = archive(&[("a.rexs", &bytes)], true);
    says(&whole[..whole.len() / 2], &["E0801", "the archive cannot be read"]);
    says(
        &archive(&[("a.txt", b"nothing")], true),
        &["the archive contains no model"],
    );
    says(
        &archive(&[("a.rexs", &bytes), ("b.rexs", &bytes)], true),
        &["the archive contains 2 models"],
    );
    let mut damaged = whole.clone();
    damaged[200] ^= 0x55;
    says(&damaged, &["E0801"]);
    let many: Vec<String> = (0..1002).map(|i| format!("{i}.txt")).collect();
    let files: Vec<(&str, &[u8])> = many.iter().map(|name| (name.as_str(), b"".as_slice())).collect();
    says(&archive(&files, false), &["E0802", "more than 1000 entries"]);
    // A bomb: zeros pack to a thousandth.
    let bomb = archive(&[("a.rexs", &vec![b' '; 20 << 20])], true);
    assert!(bomb.len() < 100_000);
    says(&bomb, &["E0802", "200 times its size"]);
    // One that lies about its length.
    let mut liar = archive(&[("a.rexs", &bytes)], true);
    let length = (bytes.len() as u32).to_le_bytes();
    let short = 1000_u32.to_le_bytes();
    for at in 0..liar.len() - 4 {
        if liar[at..at + 4] == length {
            liar[at..at + 4].copy_from_slice(&short);
        }
    }
    says(&liar, &["E0801", "cannot be unpacked"]);
}

fn numbered(count: usize, one: impl Fn(usize) -> String) -> String {
    let mut all = String::new();
    for i in 0..count {
        all.push_str(&one(i));
    }
    all
}

#[test]
fn files_that_use_much_memory_are_refused() {
    let nested = format!("<model>{}", "<array>".repeat(1_000_000));
    let found = within(nested.as_bytes(), 400);
    assert!(found.contains("E0801"), "{found}");
    let nested = format!(
        "{{\"model\":{{\"version\":\"1.4\",\"components\":{}",
        "[".repeat(1_000_000)
    );
    assert!(within(nested.as_bytes(), 100).contains("E0801"));
    let nested = format!(
        "{{\"model\":{{\"components\":[{{\"id\":1,\"type\":\"shaft\",\"attributes\":[{{\"id\":\"a\",\"x\":{}{}}}]}}]}}}}",
        "[".repeat(1_000_000),
        "]".repeat(1_000_000)
    );
    within(nested.as_bytes(), 100);
    let attributes = numbered(1_000_000, |i| format!(" a{i}=\"\""));
    assert!(within(format!("<model{attributes}/>").as_bytes(), 100).contains("E0802"));
    let spaces = numbered(100_000, |i| format!("<a xmlns:n{i}=\"u\">"));
    assert!(within(format!("<model>{spaces}").as_bytes(), 100).contains("E0802"));
    let elements = format!("<model>{}</model>", "<a/>".repeat(5_000_000));
    assert!(within(elements.as_bytes(), 1000).contains("E0802"));
    let long = vec![b' '; 65 << 20];
    assert!(within(&long, 10).contains("E0802"));
    let shafts = numbered(3000, |i| format!("<component id=\"{i}\" type=\"shaft\"/>"));
    let found = within(
        format!("<model version=\"1.4\"><components>{shafts}</components></model>").as_bytes(),
        100,
    );
    assert!(
        found.contains("the model has 3000 shafts, gears, bearings and couplings"),
        "{found}"
    );
}

/// Findings name the component and its line.
#[test]
fn contradictions_are_findings_with_their_places() {
    let line = |text: &str, of: &str| text[..text.find(of).unwrap()].matches('\n').count() + 1;
    let original = text(TWO_STAGE);
    // Positions that refer to each other.
    let gear = "<component id=\"15\" name=\"Cylindrical gear [27]\" type=\"cylindrical_gear\">";
    let at = original.find(gear).unwrap();
    let mut circle = original.clone();
    let reference = "reference_component_for_position\" unit=\"\">1<";
    let place = at + original[at..].find(reference).unwrap();
    circle.replace_range(
        place..place + reference.len(),
        "reference_component_for_position\" unit=\"\">16<",
    );
    let second = circle.find("<component id=\"16\"").unwrap();
    let place = second + circle[second..].find(reference).unwrap();
    circle.replace_range(
        place..place + reference.len(),
        "reference_component_for_position\" unit=\"\">15<",
    );
    says(
        circle.as_bytes(),
        &[
            "E0803",
            "cylindrical_gear 15: its position refers to itself",
            &format!("bad.rexs:{}:5", line(&circle, gear)),
        ],
    );
    let away = changed(gear, &gear.replace("15", "17"));
    says(
        &away,
        &[
            "E0803",
            "cylindrical_gear 17: the id 17 occurs twice",
            "there is no component 15",
        ],
    );
    says(
        &changed(
            "<relation id=\"5\" type=\"assembly\">",
            "<relation id=\"5\" type=\"nothing\">",
        ),
        &["cylindrical_gear 15: it is on no shaft"],
    );
    says(
        &changed(
            "<relation id=\"127\" type=\"stage\">",
            "<relation id=\"127\" type=\"nothing\">",
        ),
        &["cylindrical_stage 19: it names no gears"],
    );
    says(
        &changed("face_width\" unit=\"mm\">50<", "face_width\" unit=\"mm\">NaN<"),
        &[
            "E0804",
            "cylindrical_gear 15: face_width is `NaN`, not a number",
            "bad.rexs:317:7",
        ],
    );
    says(
        &changed("face_width\" unit=\"mm\">50<", "face_width\" unit=\"mm\">1e999<"),
        &["is `1e999`, not a number"],
    );
    says(
        &changed("face_width\" unit=\"mm\">50<", "face_width\" unit=\"kg\">50<"),
        &["has the unit `kg`, which is not one of mm"],
    );
    says(
        &changed("number_of_teeth\" unit=\"\">27<", "number_of_teeth\" unit=\"\">27.5<"),
        &["is 27.5, not an integer"],
    );
    says(
        &changed("id=\"number_of_teeth\"", "id=\"other\""),
        &["number_of_teeth is missing"],
    );
    says(
        &changed("normal_module\" unit=\"mm\">4.5<", "normal_module\" unit=\"mm\">4<"),
        &["normal modules 4 and 4.5 mm"],
    );
    says(
        &changed(
            "addendum_modification_coefficient\" unit=\"\">0.231415<",
            "addendum_modification_coefficient\" unit=\"\">0.3<",
        ),
        &["its flanks have different profile shift coefficients: 0.3 and 0.231415"],
    );
    says(
        &changed("<component id=\"12\"", "<component id=\"12x\""),
        &["the id `12x` is not an integer"],
    );
    let planets = text(PLANETARY).replacen(
        "number_of_teeth\" unit=\"none\">22<",
        "number_of_teeth\" unit=\"none\">23<",
        1,
    );
    says(planets.as_bytes(), &["E0805", "planetary_stage 9: its planets differ"]);
}

/// In JSON, too.
#[test]
fn findings_in_json_have_lines() {
    let json = json_of(&text(TWO_STAGE)).replacen("\"floating_point\": 4.5", "\"string\": \"NaN\"", 1);
    let line = json[..json.find("NaN").unwrap()].matches('\n').count();
    let found = within(json.as_bytes(), 100);
    assert!(
        found.contains("cylindrical_gear 15: normal_module is `NaN`, not a number"),
        "{found}"
    );
    let near: Vec<String> = (line - 3..=line + 1).map(|line| format!("bad.rexs:{line}:")).collect();
    assert!(near.iter().any(|place| found.contains(place)), "{near:?}\n{found}");
}
