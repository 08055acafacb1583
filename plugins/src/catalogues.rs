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
