//! What several tests share.

use std::path::Path;
use std::sync::OnceLock;

use gearloss_exchange::rexs::{Imported, import};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use gearloss_plugins as _;

pub const TWO_STAGE: &str = "FVA-Industriegetriebe_2stufig_1-4.rexs";
pub const PLANETARY: &str = "FVA_Planetary_stage_-_Minus_gearing_1.1.rexs";
pub const THREE_STAGE: &str = "SEW_3-stage_cylindrical_gearbox_1.0.rexs";
pub const WORM: &str = "FVA_worm_stage_1-4.rexs";

pub fn language() -> &'static Language {
    static LANGUAGE: OnceLock<Language> = OnceLock::new();
    LANGUAGE.get_or_init(|| Language::linked().unwrap_or_else(|found| panic!("{}", found.render())))
}

pub fn data(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)).unwrap()
}

pub fn text(name: &str) -> String {
    String::from_utf8(data(name)).unwrap()
}

pub fn imported(name: &str) -> Imported {
    import(&data(name), name, language()).unwrap_or_else(|found| panic!("{}", found.render()))
}

/// The findings of a file that is refused.
pub fn refused(bytes: &[u8], name: &str) -> String {
    match import(bytes, name, language()) {
        Ok(imported) => panic!("it was accepted:\n{}", imported.gearbox),
        Err(found) => {
            for finding in &found.list {
                assert!(finding.help.is_some(), "{finding:?}");
                assert!(finding.code.is_some(), "{finding:?}");
            }
            found.render()
        }
    }
}

pub fn gearbox(text: &str) -> (Gearbox, Transmission) {
    let gearbox =
        Gearbox::of_text(language(), text, "gearbox.yaml", "").unwrap_or_else(|found| panic!("{}", found.render()));
    let transmission = gearbox
        .transmission(language(), &Choice::default())
        .unwrap_or_else(|found| panic!("{}", found.render()));
    (gearbox, transmission)
}
