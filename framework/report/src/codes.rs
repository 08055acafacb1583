//! The codes of what reports find.

gearloss_framework::document::codes! {
    EXPORT = "E0701", "map cannot be exported",
        cause: "The other program cannot take the map: it needs other axes, or values at every point.",
        help: "Change the grid, or take the format out of `export`.";
    TEMPLATE = "E0702", "template of the report is wrong",
        cause: "The template is no valid template, or it uses a value that the report does not have.",
        help: "Correct it, or omit `--template`.";
}
