//! The codes of what reading a document finds.

crate::codes! {
    OTHER = "E0000", "internal error",
        cause: "A fault of the program or of a linked crate, not of the document.",
        help: "Report it with the document that leads to it.";
    UNREADABLE = "E0001", "file cannot be read",
        cause: "There is no such file, it is no regular file, it is too large, or it is not UTF-8.",
        help: "Check the name. Names in a document are relative to the document.";
    SYNTAX = "E0002", "not YAML as documents use it",
        cause: "The text is not YAML, or it uses anchors, tags, several documents or other features that documents do not have.",
        help: "Correct the line that the message shows; an editor with a YAML mode shows most of these faults.";
    DUPLICATE_KEY = "E0003", "duplicate key",
        cause: "One mapping has the same key twice, so one of the values would be lost.",
        help: "Delete one of them.";
    UNKNOWN_KEY = "E0101", "unknown key",
        cause: "The key has no meaning at its place: it is misspelt, or it belongs to another section or model.",
        help: "Use the key that the message suggests, or complete keys in an editor with the published schema.";
    MISSING_KEY = "E0102", "missing key",
        cause: "A key without a default is absent.",
        help: "Add the key with a value.";
    UNKNOWN_TYPE = "E0103", "unknown type or word",
        cause: "A `type` names no model or analysis that is linked into the program, or a key takes one of some words and has another one.",
        help: "Use one of the listed names. A model of your own crate is known to the program that links the crate.";
    WRONG_TYPE = "E0104", "wrong type of value",
        cause: "The value is a text where a number is expected, a list where a mapping is expected, or the like.",
        help: "Write a value of the expected type.";
    OUT_OF_BOUNDS = "E0105", "value out of bounds",
        cause: "The number is beyond the bounds that the schema states for its key.",
        help: "Check the value and its unit.";
    WRONG_UNIT = "E0106", "wrong or missing unit",
        cause: "The quantity has no unit, an unknown unit, or a unit of another dimension.",
        help: "Write the quantity with a unit of the stated dimension, such as `30 mm`.";
    WRONG_NAME = "E0107", "name cannot be used",
        cause: "A name has other characters than letters, digits and underscores, or YAML reads it as something else than a text.",
        help: "Choose another name.";
}
