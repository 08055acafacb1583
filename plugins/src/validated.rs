//! What the measured sets of the corpus say about the models, as `gearloss validate` computes it.

use gearloss_framework::origin;
use gearloss_framework::registry::{ShippedCells, inventory};

inventory::submit! {
    ShippedCells {
        csv: include_str!("../catalogues/validation.csv"),
        origin: origin!(),
    }
}
