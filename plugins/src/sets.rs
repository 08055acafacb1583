//! Named model sets.

use gearloss_framework::origin;
use gearloss_framework::registry::{ShippedSet, inventory};

inventory::submit! {
    ShippedSet {
        name: "iso14179_2",
        meaning: "All components according to ISO/TR 14179-2, splash torque at the speed of the pinion.",
        yaml: "
gear_mesh: { type: iso14179_2 }
bevel_mesh: { type: mean_friction, mean_friction: { type: schlenk } }
worm_mesh: { type: din_3996 }
gear_drag: { churning: { type: iso14179_2, speed_of: pinion } }
bearing: { type: iso14179_2 }
seal: { type: iso14179_2 }
synchronizer: { type: cone_gap }
",
        origin: origin!(),
    }
}

inventory::submit! {
    ShippedSet {
        name: "joint",
        meaning: "Local friction along the path of contact, churning by flow regimes, bearings by rolling, sliding and drag.",
        yaml: "
gear_mesh: { type: path_integral, tooth_friction: { type: xu } }
bevel_mesh: { type: path_integral, tooth_friction: { type: xu } }
worm_mesh: { type: din_3996 }
crossed_helical_mesh: { type: point_contact, tooth_friction: { type: xu } }
gear_drag: { churning: { type: changenet_2011 } }
bearing: { type: skf }
seal: { type: iso14179_2 }
synchronizer: { type: cone_gap }
",
        origin: origin!(),
    }
}
