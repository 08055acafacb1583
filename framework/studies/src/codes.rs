//! The codes of what reading and running a study finds.

gearloss_framework::document::codes! {
    STUDY = "E0501", "study does not fit",
        cause: "A part of the study contradicts another one or the gearbox.",
        help: "Correct the key that the message names.";
    ANALYSIS = "E0502", "analysis does not fit",
        cause: "Keys of an analysis contradict each other, or the analysis cannot be run under the conditions or with the data of the study.",
        help: "Correct the key that the message names.";
    AXIS = "E0503", "axis or grid does not fit",
        cause: "The values of an axis do not rise or fall throughout, refer to a rating that is absent, or make too many points.",
        help: "Correct the axis.";
    TOO_LARGE = "E0504", "too many points",
        cause: "An analysis would hold more points than memory allows.",
        help: "Use fewer samples, values or points; a `map` over a grid takes more, piece by piece.";
    NOT_FOUND_YET = "E0505", "model set without values",
        cause: "An analysis uses a model set that another analysis has not found.",
        help: "Correct the other analysis, write it above, or choose another set.";
    DUTY = "E0506", "duty or vehicle does not fit",
        cause: "A cycle, a spectrum or a vehicle is incomplete or contradictory, or does not fit the gearbox.",
        help: "Correct `cycles` or `vehicles`.";
    BROKEN_OFF = "E0507", "a duty broke off",
        cause: "At some time of a duty there is no solution.",
        help: "The results up to there are kept; look at the point with `explain`.";
    DATA = "E0601", "measured data do not fit",
        cause: "A file of data lacks a column, has cells that cannot be read, or units or accuracies that contradict the study.",
        help: "Correct the file, or its description under `measurements`.";
    VARIED = "E0602", "varied quantity does not fit",
        cause: "A parameter or input names a path that is no number or has no value, or a range that the gearbox does not allow.",
        help: "Correct `path`, `from` and `to`.";
    IDENTIFICATION = "E0603", "identification does not fit",
        cause: "There are too few points for the parameters, or residuals and parameters do not fit the data.",
        help: "Give more points, or identify fewer parameters.";
    HOLD_OUT = "E0604", "held-out rows or folds do not fit",
        cause: "The rule for held-out rows or folds matches no rows, all rows, or rows without the quantity.",
        help: "Correct `hold_out` or `folds`.";
    NO_CONVERGENCE = "E0605", "a search found no solution",
        cause: "A least squares search did not converge, or the model has no value where it starts.",
        help: "Start from other values, or narrow the ranges.";
}
