//! The codes of what reading files of other programs finds.

gearloss_document::codes! {
    REXS_FILE = "E0801", "no REXS model",
        cause: "The file is not a REXS model in XML or JSON, or an archive with one, or its text has a syntax error.",
        help: "Export the model again as REXS, or correct the place that the message shows.";
    REXS_LIMIT = "E0802", "REXS file exceeds a limit",
        cause: "The file is larger than models of gearboxes are, or an archive unpacks to much more than its size.",
        help: "Export the model without results of calculations, and unpack it if it is an archive.";
    REXS_MODEL = "E0803", "contradictory REXS model",
        cause: "Components and relations contradict each other: an id occurs twice, a relation names a missing component, positions refer to each other \
                in a circle, or a part has no place.",
        help: "Correct the model in the program that exported it, and export it again.";
    REXS_VALUE = "E0804", "value in a REXS model that cannot be used",
        cause: "An attribute that is needed is missing, is not a number, or has an unknown unit or value.",
        help: "Complete the component in the program that exported it, or correct the attribute in the file.";
    REXS_PART = "E0805", "part of a REXS model that gearbox files do not describe",
        cause: "The model contains worm, bevel or hypoid stages, shafts that are not parallel, or planets of one set that differ.",
        help: "Import a model without this part, or describe the gearbox by hand: `gearloss new gearbox` writes a template.";
    BEARING_TABLE = "E0806", "table of bearings cannot be read",
        cause: "A heading is not known, a unit is stated nowhere, a cell is not a number, or the decimal sign is not clear.",
        help: "Assign columns with `--columns \"c=HEADING [kN]\"`, state `--decimal`, or correct the cell.";
    REXS_VERSION = "W0801", "unknown version of REXS",
        cause: "The file has another version than those whose ids are known.",
        help: "Check the report of the import for attributes that were not used.";
    BEARING_IMPLAUSIBLE = "W0802", "implausible bearing in a table",
        cause: "A row contradicts itself, or has ratings or speeds that no bearing of its size has: usually a wrong column or unit.",
        help: "Check the columns and units of the table.";
}
