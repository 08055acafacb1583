//! The codes of what resolving and building a gearbox finds.

gearloss_document::codes! {
    OTHER_DOCUMENT = "E0201", "wrong kind of document",
        cause: "The file is a study although a gearbox is expected, or vice versa.",
        help: "Name the correct file, or correct the first key.";
    EXTENDS = "E0202", "invalid `extends`",
        cause: "Files or model sets extend each other in a loop, or a gearbox extends a file that is not a gearbox.",
        help: "Remove one `extends` of the loop, or name a gearbox file.";
    UNKNOWN_NAME = "E0203", "undefined name",
        cause: "A reference to a shaft, gear, port, lubricant, model set, grid or another item uses a name that is not defined.",
        help: "Use one of the defined names, or define this one.";
    UNKNOWN_PATH = "E0204", "path matches nothing",
        cause: "An override or a varied quantity names a path that does not exist in the resolved description.",
        help: "`gearloss check --resolved` prints all paths.";
    UNKNOWN_DESIGNATION = "E0205", "unknown designation",
        cause: "No catalogue contains a bearing or oil with this designation.",
        help: "`gearloss catalogue` lists the designations; or state the values in the document.";
    CHOICE = "E0206", "incompatible choice",
        cause: "A model set, a catalogue value or an override is not compatible with the description to which it is applied.",
        help: "Change the choice, or the description at the path that the message names.";
    MODEL = "E0207", "model cannot be built",
        cause: "The parameters of a model contradict each other, a file of the model is invalid, or an input of the model is missing.",
        help: "Correct the parameter or the file, or choose another model.";
    REGISTRATION = "E0208", "incompatible linked crates",
        cause: "Two crates register the same name, or no crate with models is linked.",
        help: "Rename one of them, or link a crate with models.";
    EVAL = "E0209", "invalid input of `eval`",
        cause: "The model is unknown, or the input contains quantities that do not exist in its context or contradict each other.",
        help: "`gearloss models` lists models and their quantities.";
    GEARBOX = "E0300", "gearbox cannot be built",
        cause: "The description is complete, but parts of it contradict each other.",
        help: "Correct the value that the message names.";
    SHAFTS = "E0301", "invalid shafts or ports",
        cause: "A shaft has no axis, two ports name the same shaft, or there are no shafts or ports.",
        help: "Correct `shafts` and `ports`.";
    GEARING = "E0302", "invalid gear pair",
        cause: "The geometry of a gear pair is impossible, its gears do not mesh, or values that depend on each other are contradictory.",
        help: "Check numbers of teeth, module, centre distance, profile shift, hand of the helix and positions along the shafts.";
    UNDERDETERMINED = "E0303", "speed of a shaft is not determined",
        cause: "In a gear, the given speeds do not determine the speeds of all shafts.",
        help: "Engage another coupling, add a mesh, or list the shaft under `standstill`.";
    OVERDETERMINED = "E0304", "shaft locked or overdetermined",
        cause: "In a gear, meshes and couplings contradict each other, or more speeds are given than there are degrees of freedom.",
        help: "Engage fewer couplings, or correct the numbers of teeth.";
    POWER_FLOW = "E0305", "torques are not determined",
        cause: "The torque split of parallel paths is not stated, or the given torques depend on each other.",
        help: "Add `torque_shares`, or give the torque at another port.";
    GIVEN = "E0306", "invalid combination of given torques and speeds",
        cause: "A point gives a torque or speed twice, at a stationary port, or not as many of them as the gear requires.",
        help: "Give the number of torques and speeds that the message states.";
    NO_BEARING = "E0307", "shaft without bearings",
        cause: "A loaded shaft has no bearings, so its bearing losses would be missing from every sum.",
        help: "Add its bearings, with `model: none` where they have no loss, or write `bearings: none` at the shaft.";
    SUPPORT = "E0308", "invalid bearing arrangement",
        cause: "A shaft can tilt or move on its bearings, several bearings take its thrust, members support each other in a loop, an `induced_thrust` or \
                a spring does not fit a pair of bearings, or a bearing states a resistance to moments that it does not have.",
        help: "Correct the positions and the `axial` directions of the bearings, or `induced_thrust` and `spring_preload` of a pair.";
    COMPONENT = "E0309", "invalid position or model of a component",
        cause: "A component names the same member on both sides, or its model cannot be used there.",
        help: "Name different members, or choose another model.";
    LUBRICANT = "E0310", "lubricant is missing or contradictory",
        cause: "A component has no oil, or the properties of an oil are contradictory.",
        help: "Add or correct the lubricant.";
    DRAG = "E0311", "losses would be counted twice",
        cause: "Two models cover the same loss, or a drag model is chosen where it is not evaluated.",
        help: "Switch one of them off with `none`.";
    OIL_SPACE = "E0314", "impossible oil space",
        cause: "The inside of the housing is not a polygon, gears reach out of it, or it holds less oil than is filled.",
        help: "Correct `housing.inside` or the volume of the oil.";
    NO_STIFFNESS = "E0315", "stiffness of a bearing is not known",
        cause: "`radial_stiffness` or `tilting_stiffness` of a bearing states a load, but the loads of its rolling elements are not calculated or do not carry it.",
        help: "State the stiffness as a number, or the inside of the bearing under `internal`.";
    AXES = "E0320", "axes do not fit each other",
        cause: "The axes of two gears in mesh, of both members of a bearing or of a planetary set are not parallel or do not cross as they have to.",
        help: "Correct `axis` of a shaft, or describe the mesh in the section for such axes: `meshes`, `bevel_meshes`, `worm_meshes` or `crossed_helical_meshes`.";
    CROSSED = "E0321", "impossible pair of gears on axes that cross",
        cause: "The data of a bevel, hypoid, worm or crossed helical pair contradict each other or its axes, or a key does not apply to such gears.",
        help: "Correct the value that the message names; shaft angle, offset and positions follow from the axes.";
    BEVEL_DRAG = "E0325", "drag law that does not describe bevel gears",
        cause: "Most laws of churning and windage take the dimensions of a cylindrical gear, and those of a bevel gear are not defined in them.",
        help: "Choose a law that describes bevel gears, or switch the slot off at the gear with `none`.";
    CHAIN = "E0332", "invalid chain or belt",
        cause: "The wheels of a chain are not on two parallel shafts in one plane, its links do not fit the centre distance, or it lacks teeth, pitch or ratio.",
        help: "Correct the axes, `at`, the numbers of teeth, `pitch` and `links`, or the `ratio` of a belt.";
    DIFFERENTIAL = "E0333", "contradictory speeds of a differential",
        cause: "The speeds of both sides of a differential, or of the ports of `wheels`, are stated twice, or their number is wrong.",
        help: "State them once: `wheel_speeds` for ports of `wheels`, `speed_difference` otherwise.";
    JOINT = "E0334", "invalid joint",
        cause: "A joint names the same shaft on both sides.",
        help: "Name the shafts on both sides of the joint.";
    MACHINE = "E0345", "contradictory electric machine",
        cause: "A machine or its inverter has no losses, states them twice, or contains what the gearbox describes as well, so that it would be counted twice.",
        help: "Correct the key that the message names; `contains` lists what the loss map of the machine includes.";
    LOAD_SHARING = "E0350", "load sharing that a mesh cannot have",
        cause: "A load sharing is not defined for the geometry of its mesh, or a modification of a flank does not fit the path of contact.",
        help: "Correct the modification, or choose another load sharing.";
    SHARE_FILE = "E0351", "faulty file of load shares",
        cause: "A file of `load_sharing: { type: file }` cannot be read, is incomplete, or its shares do not carry the whole force.",
        help: "Correct the file at the place that the message names.";
    SHAFT_DEFLECTION = "E0352", "deflection of shafts that cannot be calculated",
        cause: "`shaft_deflection` of a mesh needs a rating that loads it, and bearings and diameters of both shafts over their whole length; gears on planets have none.",
        help: "State what the message names, or the `misalignment` of the mesh instead.";
    SHARES_OF_FLANKS = "E0353", "shares of both flanks for a model that does not distinguish them",
        cause: "A file of `load_sharing` has shares of the flank `coast`, and the model that names it does not know which flanks touch.",
        help: "Name a file without rows of `coast`, or a mesh model that integrates along the path of contact.";
    TRAVEL = "E0360", "a cycle cannot incline the oil",
        cause: "`housing.travel` lets grade and acceleration of a cycle incline the oil, but no level or no oil space is known, or it inclines the oil by more than 60 degrees.",
        help: "State `volume` with `housing.inside`, correct the cycle, or delete `travel`.";
    WINDOW = "E0361", "a window that no gear can throw oil through",
        cause: "The window of a pocket has no size, its wall is not beside its gear, or how much oil the gear lifts is not known.",
        help: "Correct the places of the window, or name a gear with a churning law and a stationary axis along x.";
    MATERIAL = "E0370", "incomplete material",
        cause: "A material lacks a value without which it cannot be calculated with: Young's modulus, Poisson's ratio, one of the three thermal properties, or the kind of one that is \
                softer than metals.",
        help: "State the value, or a `designation` of the catalogue.";
    PINS = "E0376", "load sharing of planets that cannot be",
        cause: "Planets cannot have the stated load sharing, or `pins` has values for another number of planets or lists a shaft twice.",
        help: "Correct the key that the message names.";
    PINS_UNDETERMINED = "E0377", "load sharing of planets that cannot be calculated",
        cause: "`pins` calculates the load sharing of one planet body in mesh with two gears on the central axis, by the tangential force of its pins.",
        help: "State `load_sharing` as a number instead.";
    THERMAL = "E0401", "invalid thermal description",
        cause: "The balance has no heat path, or values of the thermal section contradict each other.",
        help: "Correct the section `thermal`.";
    NETWORK = "E0402", "invalid thermal network",
        cause: "A node, link, flow or exchanger of the thermal network contradicts another one, or refers to itself.",
        help: "Correct the element that the message names.";
    NO_HEAT_PATH = "E0403", "node without a heat path",
        cause: "No path leads from a node to a fixed temperature, or oil flows in a loop without heat capacity.",
        help: "Add a link or a capacity.";
    OIL_NETWORK = "E0404", "invalid oil network",
        cause: "Elements of the oil network are not joined to a pump or to the sump, or their values contradict each other.",
        help: "Join them, or correct the values; [the page](oil-network.md) shows a complete network.";
    PLAUSIBILITY = "W0301", "probably wrong description",
        cause: "The description is valid, but a value is unusual enough to be a mistake.",
        help: "Check the value. If it is intended, no change is needed.";
    PROFILE_SHIFT = "W0302", "sign of a ring's profile shift is not stated",
        cause: "Both sign conventions for the profile shift of a ring gear are in use.",
        help: "Add `profile_shift_sign`.";
    THRUST = "W0303", "thrust without a bearing",
        cause: "No bearing of a shaft takes thrust in a direction in which it may occur.",
        help: "Set `axial` of a bearing.";
    UNCOUNTED = "W0304", "losses are not included",
        cause: "Planets have no bearings, so their bearing loads and losses are not included; or gears run in grease, whose churning has no law.",
        help: "Add the bearings or a measured drag, or accept that these losses are missing from the sum.";
    OVERLOADED = "W0305", "static safety below 1 at the rating",
        cause: "A bearing has a static safety below 1 at the rated torque.",
        help: "Use a larger bearing, or check the rating.";
    RATED_OUTSIDE = "W0306", "quantity of a rating is outside its bound at the rating",
        cause: "At the rated torque and speed, a component exceeds what a rating under `ratings` allows, such as its load or its speed.",
        help: "Change the component, or state another bound under `ratings`; `gearloss models rating` lists them.";
    CANNOT_CARRY = "W0307", "a bearing cannot carry what is assigned to it",
        cause: "`axial` or `spring_preload` of a bearing does not match its design: a needle roller cage or an NU bearing carries no thrust, a tapered roller \
                bearing carries thrust in one direction, a thrust bearing nothing else.",
        help: "Change `axial`, assign the thrust to another bearing, or choose another bearing.";
    INDUCED = "W0308", "induced thrust is not in the loads",
        cause: "The radial load of an angular contact or tapered roller bearing pushes the shaft towards an opposed bearing, but there is none, or its data do \
                not state how large this thrust is.",
        help: "State `axial: left` and `right` of the two bearings, and `y`, `contact_angle` or `induced_thrust`; `induced_thrust: 0` leaves the thrust out.";
    PRELOAD = "W0309", "preload may not be as meant",
        cause: "The expansion of the housing around preloaded bearings is not stated, or the preload alone exceeds the static rating of a bearing.",
        help: "State `housing: { material: ... }` in `preload`, or correct the preload.";
    OIL_LEVEL = "W0314", "doubtful oil level",
        cause: "Level and volume of the oil contradict each other, the level at rest is not known, the oil covers a shaft seal, or it reaches a bearing \
                neither at its level nor by splashing.",
        help: "Correct the level, the volume or the inside of the housing, or state how the part gets its oil.";
    OIL_SUPPLY = "W0315", "a pump or consumer has too little oil",
        cause: "At the rated speed, the inlet of a pump is in air or its pressure is too low, a relief valve never closes, a consumer has no flow, or a \
                chamber floods.",
        help: "Change the pump, the pipe or the nozzle that the message names.";
    STATED_OVER_DRAWING = "W0316", "a stated value replaces that of the drawing",
        cause: "A value is stated that follows from the drawing of the housing and the level of its oil, and the two differ by more than a tenth.",
        help: "Remove the stated value, or correct the outline or the level.";
    UNUSUAL_HAND = "W0320", "unusual combination of hand and offset",
        cause: "With this hand and offset of a hypoid pair the spiral angle of the pinion is smaller than that of the wheel, which is legal but rare: the \
                pinion becomes smaller.",
        help: "Check `hand` and the axes; if they are intended, no change is needed.";
    LONE_GEAR = "W0321", "gear in no mesh",
        cause: "A gear is named by no mesh. It carries no torque and churns at most; often a mesh was forgotten, and the gearbox has no fixed ratio.",
        help: "Add the mesh with its mate, or remove the gear if it is none of the gearbox.";
    CHAIN_DOUBTFUL = "W0332", "doubtful chain or belt",
        cause: "The slack strand of a chain sags more than usual, or the forces of a belt on its shafts are not known.",
        help: "Correct the number of links, or state the forces under `loads` of the shafts.";
    MACHINE_DOUBTFUL = "W0345", "losses of a machine may be incomplete",
        cause: "No inverter is described or contained in the loss map, or the temperature of the winding is not known.",
        help: "Describe what is missing, or accept that the oil's temperature is used and that the inverter is in no sum.";
    SHARES_COARSE = "W0350", "load sharing between its knots is not accurate",
        cause: "Between the loads at which the shares of the teeth are calculated, the loss factor is interpolated with a noticeable error.",
        help: "State more `phases` or `slices`, or a modification that opens less of the flanks.";
    SHARES_CORRECTED = "W0351", "shares of a file are corrected",
        cause: "The shares of all pairs of teeth in a file of `load_sharing: { type: file }` do not add up to one exactly.",
        help: "Write the file with more places along the path, two of them close to each other where a share jumps.";
    LEAN_UNUSED = "W0352", "misalignment without effect",
        cause: "A mesh states `misalignment` or `shaft_deflection`, and neither its model nor a rating has thin slices, which alone use it.",
        help: "State `load_sharing: { type: slices }` in the model of the mesh, or remove what has no effect.";
    MISSED_WINDOW = "W0360", "no oil comes through a window",
        cause: "The oil that the gear of a window throws at the rated speed passes the window of a pocket, or the gear throws none.",
        help: "Move the window, name another gear, or check the sense of rotation and the oil level.";
    LEVEL_HEIGHT = "W0362", "heights of the oil network do not follow the inclination",
        cause: "The housing is inclined or travels, and the place of a junction or of a mouth along and across the shafts is not stated.",
        help: "State `x` and `y` of the junction, or `inlet_x` and `inlet_y` of the pipe.";
    UNUSED_MATERIAL = "W0370", "material or modulus without effect",
        cause: "No gear is made of a material, or a mesh states the modulus of gears that name their material.",
        help: "Name the material at a gear, or remove what has no effect.";
    WHEEL_MATERIAL = "W0371", "material of a worm wheel is doubtful",
        cause: "The material of a worm wheel does not say what it is as such, or the mesh states another one.",
        help: "State `worm_wheel` of the material, and no `material` of the worm mesh.";
    METAL_LAW = "W0372", "law of metal flanks for a plastic gear",
        cause: "A law of friction is a regression or a theory of metal flanks, and a gear of the mesh is of plastic.",
        help: "Choose a law for plastics (`gearloss models mean_friction`), or state a coefficient.";
    EQUAL_PLANETS = "W0376", "planets are assumed to share equally",
        cause: "Four and more planets, or three between members that all have bearings, carry different loads as soon as their pins have position errors.",
        help: "State the errors in `pins`, or `load_sharing`: 1 if they share equally.";
}
