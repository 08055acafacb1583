//! The codes of what resolving and building a gearbox finds.

gearloss_document::codes! {
    OTHER_DOCUMENT = "E0201", "document of another kind",
        cause: "The file is a study where a gearbox is expected, or the reverse.",
        help: "Name the other file, or correct the first key.";
    EXTENDS = "E0202", "`extends` cannot be followed",
        cause: "Files or model sets extend each other in a circle, or a gearbox extends something that is no gearbox.",
        help: "Take one of them out of the circle.";
    UNKNOWN_NAME = "E0203", "name refers to nothing",
        cause: "A shaft, gear, port, lubricant, model set, grid or the like is referred to by a name that is not defined.",
        help: "Use one of the defined names, or define it.";
    UNKNOWN_PATH = "E0204", "path matches nothing",
        cause: "An override or a varied quantity names a path that the resolved description does not have.",
        help: "`gearloss check --resolved` prints all paths.";
    UNKNOWN_DESIGNATION = "E0205", "unknown designation",
        cause: "No catalogue has a bearing or oil of this designation.",
        help: "`gearloss catalogue` lists the designations; or state the values in the document.";
    CHOICE = "E0206", "choice does not fit",
        cause: "A model set, a catalogue value or an override does not fit the description that it is applied to.",
        help: "Change the choice, or the description at the path that the message names.";
    MODEL = "E0207", "model cannot be built",
        cause: "The parameters of a model contradict each other, a file of the model is wrong, or the component lacks an input of the model.",
        help: "Correct the parameter or the file, or choose another model.";
    REGISTRATION = "E0208", "linked crates do not fit together",
        cause: "Two crates register the same name, or no crate with models is linked.",
        help: "Rename one of them, or link the crate.";
    EVAL = "E0209", "input of `eval` does not fit",
        cause: "The model is unknown, or the input has quantities that its context does not have or that contradict each other.",
        help: "`gearloss models` lists models and their quantities.";
    GEARBOX = "E0300", "gearbox cannot be built",
        cause: "The description is complete, but its parts contradict each other.",
        help: "Correct the value that the message names.";
    SHAFTS = "E0301", "shafts or ports do not fit",
        cause: "A shaft has no axis, a port names a shaft twice, or there are no shafts or ports.",
        help: "Correct `shafts` and `ports`.";
    GEARING = "E0302", "gears do not fit",
        cause: "The geometry of a gear pair is impossible, its gears do not meet, or values that depend on each other contradict.",
        help: "Check teeth, module, centre distance, profile shift, helix hand and places along the shafts.";
    UNDERDETERMINED = "E0303", "a shaft is free",
        cause: "In a gear state, the given speeds do not determine the speeds of all shafts.",
        help: "Engage a further coupling, mesh the shaft, or list it in `standstill`.";
    OVERDETERMINED = "E0304", "a shaft is locked or overdetermined",
        cause: "In a gear state, meshes and couplings contradict each other, or more speeds are given than are free.",
        help: "Engage fewer couplings, or correct the numbers of teeth.";
    POWER_FLOW = "E0305", "torques are not determined",
        cause: "Parallel paths share torque and no rule says how, or the given torques depend on each other.",
        help: "Add `torque_shares`, or give the torque at another port.";
    GIVEN = "E0306", "given torques and speeds do not fit",
        cause: "A point gives a torque or speed twice, at a port that stands still, or another number of them than the gear state needs.",
        help: "Give as many torques and speeds as the message states.";
    NO_BEARING = "E0307", "shaft without bearings",
        cause: "A loaded shaft has no bearings, so its bearing losses would be missing from every sum.",
        help: "Add its bearings, with `model: none` where they have no loss, or write `bearings: none` at the shaft.";
    SUPPORT = "E0308", "bearing arrangement does not fit",
        cause: "A shaft can tilt or move on its bearings, several bearings take its thrust, or bearings carry each other in a circle.",
        help: "Correct the places and the `axial` directions of the bearings.";
    COMPONENT = "E0309", "component does not fit its place",
        cause: "A component names the same member on both sides, or its model does not fit where it is chosen.",
        help: "Name different members, or choose another model.";
    LUBRICANT = "E0310", "lubricant is missing or contradictory",
        cause: "A component has no oil, or the properties of an oil contradict each other.",
        help: "Add or correct the lubricant.";
    DRAG = "E0311", "losses would be counted twice",
        cause: "Two models cover the same loss, or a drag model is chosen where it is not evaluated.",
        help: "Switch one of them off with `none`.";
    THERMAL = "E0401", "thermal description does not fit",
        cause: "The balance has no path for heat, or values of the thermal section contradict each other.",
        help: "Correct the section `thermal`.";
    NETWORK = "E0402", "thermal network does not fit",
        cause: "A node, link, flow or exchanger of the thermal network contradicts another one, or refers to itself.",
        help: "Correct the element that the message names.";
    NO_HEAT_PATH = "E0403", "node without a heat path",
        cause: "No path leads from a node to a fixed temperature, or oil flows in a loop without heat capacity.",
        help: "Add a link or a capacity.";
    PLAUSIBILITY = "W0301", "probably wrong description",
        cause: "The description is valid, but a value is unusual enough to be a mistake.",
        help: "Check the value; nothing needs to be done where it is meant.";
    PROFILE_SHIFT = "W0302", "sign of a ring's profile shift is not stated",
        cause: "Documents count the profile shift of a ring towards either side.",
        help: "Add `profile_shift_sign`.";
    THRUST = "W0303", "thrust without a bearing",
        cause: "No bearing of a shaft takes thrust in a direction in which it may occur.",
        help: "Set `axial` of a bearing.";
    UNCOUNTED = "W0304", "losses are not counted",
        cause: "Planets have no bearings, so loads and losses there are not counted.",
        help: "Add the bearings, or accept that the sum has no such losses.";
    OVERLOADED = "W0305", "static safety below 1 at the rating",
        cause: "A bearing has a static safety below 1 at the rated torque.",
        help: "Use a larger bearing, or check the rating.";
}
