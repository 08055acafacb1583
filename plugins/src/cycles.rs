//! Driving cycles as registered data.

use gearloss_framework::origin;
use gearloss_framework::registry::{ShippedCycle, inventory};

/// Phases of the WLTC for vehicles of class 3: 589, 433, 455 and 323 s (UN GTR No. 15, annex 1).
const WLTC_CLASS_3: &[(&str, f64)] = &[
    ("low", 589.0),
    ("medium", 1022.0),
    ("high", 1477.0),
    ("extra_high", 1800.0),
];

inventory::submit! {
    ShippedCycle {
        name: "wltc_class3a",
        csv: include_str!("../catalogues/cycles/wltc_class3a.csv"),
        phases: WLTC_CLASS_3,
        source: "UN GTR No. 15 and UN Regulation No. 154: WLTC class 3a.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "wltc_class3b",
        csv: include_str!("../catalogues/cycles/wltc_class3b.csv"),
        phases: WLTC_CLASS_3,
        source: "UN GTR No. 15 and UN Regulation No. 154: WLTC class 3b.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "nycc",
        csv: include_str!("../catalogues/cycles/nycc.csv"),
        phases: &[],
        source: "US EPA: New York City Cycle.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "udds",
        csv: include_str!("../catalogues/cycles/udds.csv"),
        phases: &[],
        source: "40 CFR 86 appendix I: Urban Dynamometer Driving Schedule.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "hwfet",
        csv: include_str!("../catalogues/cycles/hwfet.csv"),
        phases: &[],
        source: "40 CFR 600 appendix I: Highway Fuel Economy Driving Schedule.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "us06",
        csv: include_str!("../catalogues/cycles/us06.csv"),
        phases: &[],
        source: "40 CFR 86 appendix I: US06 schedule of the Supplemental FTP.",
        origin: origin!(),
    }
}
