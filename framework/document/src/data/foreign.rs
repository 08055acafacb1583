//! Files of other kinds, recognised by their first bytes.

use super::{MeasuredFault, fault};

/// How tables of MATLAB are exported.
const MATLAB: &str = "export it in MATLAB by `writetable(T, 'NAME.csv')`, or `writematrix` and a header line";

/// First bytes, what the file is, and how its table is exported.
const KNOWN: [(&[u8], &str, &str); 22] = [
    (b"MATLAB 5.0 MAT-file", "a MAT-file of MATLAB", MATLAB),
    (
        b"MATLAB 7.3 MAT-file",
        "a MAT-file of MATLAB (version 7.3, HDF5)",
        MATLAB,
    ),
    (
        b"\x89HDF\r\n\x1a\n",
        "an HDF5 file",
        "export the data set as CSV, as by `h5dump` or pandas",
    ),
    (
        b"TDSm",
        "a TDMS file of LabVIEW",
        "export it as CSV or MDF 4 in DIAdem, or by `TdmsFile.read(FILE).as_dataframe().to_csv(...)` of npTDMS",
    ),
    (
        b"PAR1\x15",
        "a Parquet file",
        "write it by `pandas.read_parquet(FILE).to_csv(...)`",
    ),
    (
        b"ARROW1",
        "an Arrow (Feather) file",
        "write it by `pandas.read_feather(FILE).to_csv(...)`",
    ),
    (
        b"\x93NUMPY",
        "a NumPy file",
        "write it by `numpy.savetxt(..., delimiter=',', header=...)`",
    ),
    (b"SQLite format 3\0", "an SQLite database", "export the table as CSV"),
    (b"PK\x05\x06", "an empty zip archive", "choose the file with the data"),
    (b"\x1f\x8b", "a file packed by gzip", "unpack it: `gunzip FILE`"),
    (b"BZh", "a file packed by bzip2", "unpack it: `bunzip2 FILE`"),
    (b"\xfd7zXZ\0", "a file packed by xz", "unpack it: `unxz FILE`"),
    (
        b"\x28\xb5\x2f\xfd",
        "a file packed by Zstandard",
        "unpack it: `unzstd FILE`",
    ),
    (
        b"7z\xbc\xaf\x27\x1c",
        "a 7-Zip archive",
        "unpack it, and name the file with the data",
    ),
    (
        b"Rar!\x1a\x07",
        "a RAR archive",
        "unpack it, and name the file with the data",
    ),
    (
        b"%PDF",
        "a PDF document",
        "copy its table to a spreadsheet and save it as .xlsx or CSV",
    ),
    (
        b"{\\rtf",
        "a text document (RTF)",
        "copy its table to a spreadsheet and save it as .xlsx or CSV",
    ),
    (b"\x89PNG", "a picture (PNG)", "write its numbers into a CSV file"),
    (b"\xff\xd8\xff", "a picture (JPEG)", "write its numbers into a CSV file"),
    (b"<?xml", "an XML file", "export the table as CSV or workbook (.xlsx)"),
    (
        b"<!DOCTYPE",
        "an HTML page",
        "open it in a spreadsheet and save it as .xlsx or CSV",
    ),
    (
        b"<html",
        "an HTML page",
        "open it in a spreadsheet and save it as .xlsx or CSV",
    ),
];

/// The error for a file of another kind.
pub(super) fn recognise(bytes: &[u8]) -> Option<MeasuredFault> {
    let known = KNOWN.iter().find(|(begin, ..)| bytes.starts_with(begin));
    if let Some((_, what, help)) = known {
        return Some(fault(format!("{what}, which is not read"), *help));
    }
    is_json(bytes).then(|| {
        fault(
            "a JSON file, which is not read as a table",
            "write it by `pandas.read_json(FILE).to_csv(...)`",
        )
    })
}

/// A brace and what follows it in JSON, or a bracket and another one or a brace; a header may begin with a bracket.
fn is_json(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut signs = bytes.iter().copied().filter(|byte| !byte.is_ascii_whitespace());
    match (signs.next(), signs.next()) {
        (Some(b'{'), Some(next)) => matches!(next, b'"' | b'}'),
        (Some(b'['), Some(next)) => matches!(next, b'{' | b'['),
        _ => false,
    }
}
