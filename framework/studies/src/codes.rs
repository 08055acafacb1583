//! The codes of what reading and running a study finds.

gearloss_framework::document::codes! {
    STUDY = "E0501", "contradictory study",
        cause: "A part of the study contradicts another part or the gearbox.",
        help: "Correct the key that the message names.";
    ANALYSIS = "E0502", "invalid analysis",
        cause: "Keys of an analysis contradict each other, or the analysis cannot be run under the conditions or with the data of the study.",
        help: "Correct the key that the message names.";
    AXIS = "E0503", "invalid axis or grid",
        cause: "The values of an axis are not monotonic, refer to a missing rating, or result in too many points.",
        help: "Correct the axis.";
    TOO_LARGE = "E0504", "too many points",
        cause: "An analysis would hold more points in memory than the maximum.",
        help: "Use fewer samples, values or points. A `map` over a grid can have more, because it is solved in pieces.";
    NOT_FOUND_YET = "E0505", "model set without values",
        cause: "An analysis uses a model set that another analysis should produce but did not.",
        help: "Correct the other analysis, place it before this one, or choose another set.";
    DUTY = "E0506", "invalid duty cycle or vehicle",
        cause: "A cycle, a spectrum or a vehicle is incomplete or contradictory, or does not fit the gearbox.",
        help: "Correct `cycles` or `vehicles`.";
    BROKEN_OFF = "E0507", "simulation of a duty cycle stopped early",
        cause: "There is no solution at some time of the duty cycle.",
        help: "The results up to that time are kept; examine the point with `explain`.";
    FOLLOWS = "E0520", "invalid formula of a value that follows others",
        cause: "A formula under `conditions.follows` cannot be read, depends on something that is not a number, or its value is changed directly as well.",
        help: "Correct the formula, or change only what it depends on.";
    OBJECTIVE = "E0521", "invalid objective of a search",
        cause: "`minimise` names a quantity that the cycles do not have, such as the consumption of a vehicle without a battery.",
        help: "Describe the battery and the machine, or minimise the mean loss.";
    GEAR_CHOICE = "E0530", "invalid choice of gears",
        cause: "Gears cannot be chosen in a cycle: its torques already depend on the gear, no gear connects the ports, or keys of `gear` contradict each other.",
        help: "Use a cycle with the speed of a vehicle or loads at the wheels, and correct the key that the message names.";
    SHIFT_MAP = "E0531", "invalid map of gears",
        cause: "A file under `gear: { map: ... }` cannot be read, has no gear for a speed and torque of its grid, or names a gear that the gearbox does not have.",
        help: "Correct the file: columns `speed [rpm]`, `torque [Nm]` and `gear`, with the same torques at each speed.";
    AXLE_SPLIT = "E0532", "invalid front and rear unit",
        cause: "Two units cannot drive a cycle: one has no machine or no given temperature, its disconnected state does not separate wheels and input, or the cycle states no speed of a vehicle.",
        help: "Correct the key that the message names.";
    BATTERY = "E0540", "contradictory battery",
        cause: "A battery states neither a constant efficiency nor its cells, or both, or values of its cells contradict each other.",
        help: "State `efficiency`, or `cells` with voltage and resistance, and correct the key that the message names.";
    BEYOND_ENVELOPE = "E0541", "cycle beyond the envelope of a machine",
        cause: "A cycle asks for more torque or speed than a machine has whose envelope says `beyond: refuse`.",
        help: "Write `beyond: limit`, correct the envelope, or choose a larger machine.";
    NO_MACHINE = "E0542", "quantity of a machine that is not described",
        cause: "An analysis asks for quantities of the drive unit, but the gearbox has no machine, or its machine belongs to a thermal network that is not used.",
        help: "Describe it under `machines` of the gearbox, or choose a quantity of the gearbox.";
    DATA = "E0601", "invalid measured data",
        cause: "A data file lacks a column, has cells that cannot be read, or has units or accuracies that contradict the study.",
        help: "Correct the file, or its description under `measurements`.";
    VARIED = "E0602", "invalid varied quantity",
        cause: "A parameter or input names a path that is not a number or has no value, or has a range outside that of the path.",
        help: "Correct `path`, `from` and `to`.";
    IDENTIFICATION = "E0603", "invalid identification",
        cause: "There are too few points or means for the parameters, residuals and parameters are not compatible with the data, or a mean over cycles states no loss and no ratio of losses.",
        help: "Give more points, identify fewer parameters, or correct the key that the message names.";
    HOLD_OUT = "E0604", "invalid selection of held-out rows or folds",
        cause: "The rule for held-out rows or folds matches no rows, all rows, or rows without the quantity.",
        help: "Correct `hold_out` or `folds`.";
    NO_CONVERGENCE = "E0605", "search found no solution",
        cause: "A least squares search did not converge, or the model has no value at its start.",
        help: "Start from other values, or narrow the ranges.";
    CORPUS = "E0606", "incomplete or contradictory set of a corpus",
        cause: "The source of a set lacks a key, its table does not have the columns, units or numbers that the source states, or nothing judges models by it.",
        help: "Correct `data.csv`, `source.md` or `study.yaml` of the set.";
    CELLS = "E0607", "invalid table of cells of a corpus",
        cause: "A file under `model_error` cannot be read, lacks a column of the tables that `gearloss validate` writes, or has a cell that is no positive number.",
        help: "Run `gearloss validate --corpus FOLDER` again and give its `cells.csv`.";
    NOTHING_UNCERTAIN = "E0608", "bands without an uncertain input",
        cause: "An analysis for bands has no inputs, and no measured set judges a model of the gearbox.",
        help: "State `inputs`, or give the cells of own sets under `model_error`.";
    CORRECTION = "E0610", "invalid correction",
        cause: "An identification cannot make a correction from its rows, or a correction that another analysis reads is missing, damaged, or belongs to another gearbox or other parameters.",
        help: "Give rows with a measured loss; run the identification again, and use the model set that it provides under `then`.";
    MACHINE_DEMAND = "W0543", "points beyond the map or the envelope of a machine",
        cause: "An analysis solves points whose torque or speed is beyond what the loss map of a machine covers, or beyond its envelope.",
        help: "Extend the map, correct the envelope, or state other points. The loss at the edge of the map is used, and points are not limited.";
}
