//! Catalogues as registered data.

use gearloss_framework::origin;
use gearloss_framework::registry::{Catalogue, inventory};

inventory::submit! {
    Catalogue {
        section: "bearings",
        csv: include_str!("../catalogues/bearings.csv"),
        source: "Public catalogue data of rolling bearings; boundary dimensions after ISO 15. Confidence stands in each row.",
        origin: origin!(),
    }
}

inventory::submit! {
    Catalogue {
        section: "lubricants",
        csv: include_str!("../catalogues/lubricants.csv"),
        source: "Typical gear oils: constants of a public gear oil library and published data sheets. Basis stands in each row.",
        origin: origin!(),
    }
}
