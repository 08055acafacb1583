//! The codes of what reports find.

gearloss_framework::document::codes! {
    EXPORT = "E0701", "map cannot be exported",
        cause: "The format of the other program cannot represent the map: it needs other axes, or values at every point.",
        help: "Change the grid, or remove the format from `export`.";
    TEMPLATE = "E0702", "invalid report template",
        cause: "The template has a syntax error, or it uses a value that the report does not provide.",
        help: "Correct it, or omit `--template`.";
}
