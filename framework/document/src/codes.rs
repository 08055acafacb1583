//! The codes of what reading a document finds.

crate::codes! {
    OTHER = "E0000", "internal error",
        cause: "A defect in the program or in a linked crate, not an error in the document.",
        help: "Report it, and attach the document that causes it.";
    UNREADABLE = "E0001", "file cannot be read",
        cause: "The file does not exist, is not a regular file, is too large, or is not UTF-8 text.",
        help: "Check the file name. File names in a document are relative to the document.";
    SYNTAX = "E0002", "invalid or unsupported YAML",
        cause: "The text is not valid YAML, or it uses anchors, tags, several documents or other features that are not supported.",
        help: "Correct the line that the message shows; an editor with YAML support marks most of these errors.";
    DUPLICATE_KEY = "E0003", "duplicate key",
        cause: "A mapping contains the same key twice, so one of the values would be lost.",
        help: "Delete one of them.";
    UNKNOWN_KEY = "E0101", "unknown key",
        cause: "The key is not defined at this position: it is misspelt, or it belongs to another section or model.",
        help: "Use the key that the message suggests, or use an editor that completes keys from the published schema.";
    MISSING_KEY = "E0102", "missing key",
        cause: "A required key is absent: it has no default.",
        help: "Add the key and its value.";
    UNKNOWN_TYPE = "E0103", "unknown type or value",
        cause: "A `type` names a model or analysis that is not linked into the program, or the value of a key is not one of its allowed values.",
        help: "Use one of the listed names. A model from your own crate is available only in a program that links the crate.";
    WRONG_TYPE = "E0104", "wrong type of value",
        cause: "The value has the wrong type, such as text instead of a number, or a list instead of a mapping.",
        help: "Write a value of the expected type.";
    OUT_OF_BOUNDS = "E0105", "value out of bounds",
        cause: "The number is outside the bounds that the schema states for its key.",
        help: "Check the value and its unit.";
    WRONG_UNIT = "E0106", "wrong or missing unit",
        cause: "The quantity has no unit, an unknown unit, or a unit of another dimension.",
        help: "Write the quantity with a unit of the stated dimension, such as `30 mm`.";
    WRONG_NAME = "E0107", "invalid name",
        cause: "A name contains characters other than letters, digits and underscores, or YAML does not read it as text.",
        help: "Choose another name.";
}
