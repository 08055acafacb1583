//! Driving cycles as registered data.

use gearloss_framework::origin;
use gearloss_framework::registry::{ShippedCycle, inventory};

inventory::submit! {
    ShippedCycle {
        name: "wltc_class3a",
        csv: include_str!("../catalogues/cycles/wltc_class3a.csv"),
        source: "UN GTR No. 15 and UN Regulation No. 154: WLTC class 3a.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "wltc_class3b",
        csv: include_str!("../catalogues/cycles/wltc_class3b.csv"),
        source: "UN GTR No. 15 and UN Regulation No. 154: WLTC class 3b.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "nycc",
        csv: include_str!("../catalogues/cycles/nycc.csv"),
        source: "US EPA: New York City Cycle.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "udds",
        csv: include_str!("../catalogues/cycles/udds.csv"),
        source: "40 CFR 86 appendix I: Urban Dynamometer Driving Schedule.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "hwfet",
        csv: include_str!("../catalogues/cycles/hwfet.csv"),
        source: "40 CFR 600 appendix I: Highway Fuel Economy Driving Schedule.",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedCycle {
        name: "us06",
        csv: include_str!("../catalogues/cycles/us06.csv"),
        source: "40 CFR 86 appendix I: US06 schedule of the Supplemental FTP.",
        origin: origin!(),
    }
}
