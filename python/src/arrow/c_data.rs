//! The structures of the C stream interface: <https://arrow.apache.org/docs/format/CStreamInterface.html>.
//!
//! A stream has one batch. Everything it points to belongs to it or to the batch, which the consumer releases. Nothing here knows Python, so
//! that `.ci/miri` can run the tests of this file under Miri.

#![allow(unsafe_code)]

use std::collections::VecDeque;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr::{null, null_mut};

/// Nothing went wrong.
const FINE: c_int = 0;
/// Columns may have gaps: flag of a schema.
const NULLABLE: i64 = 2;

/// The cells of a column with what they point to.
pub enum Cells {
    /// Numbers, with what keeps them, the place of the first, and how many there are.
    Numbers {
        _owner: Box<dyn Send>,
        first: *const f64,
        length: usize,
    },
    /// Texts with 64-bit offsets; a bit of `valid` for each, and the number of gaps.
    Texts {
        valid: Vec<u8>,
        offsets: Vec<i64>,
        bytes: Vec<u8>,
        gaps: i64,
    },
}

impl Cells {
    /// Numbers, which stay where they are.
    ///
    /// # Safety
    /// There are as many from the first on, and nothing changes or frees them before the owner is dropped.
    pub unsafe fn numbers(owner: Box<dyn Send>, first: *const f64, length: usize) -> Self {
        Self::Numbers {
            _owner: owner,
            first,
            length,
        }
    }

    /// Texts; absent ones are gaps.
    pub fn texts<'t>(texts: impl Iterator<Item = Option<&'t str>>) -> Self {
        let (mut valid, mut offsets, mut bytes, mut gaps) = (Vec::new(), vec![0_i64], Vec::new(), 0);
        for (row, text) in texts.enumerate() {
            if row % 8 == 0 {
                valid.push(0);
            }
            match text {
                Some(text) => {
                    valid[row / 8] |= 1 << (row % 8);
                    bytes.extend_from_slice(text.as_bytes());
                }
                None => gaps += 1,
            }
            offsets.push(i64::try_from(bytes.len()).unwrap_or(i64::MAX));
        }
        Self::Texts {
            valid,
            offsets,
            bytes,
            gaps,
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Numbers { length, .. } => *length,
            Self::Texts { offsets, .. } => offsets.len() - 1,
        }
    }

    fn format(&self) -> &'static CStr {
        match self {
            Self::Numbers { .. } => c"g",
            Self::Texts { .. } => c"U",
        }
    }
}

#[repr(C)]
struct Schema {
    format: *const c_char,
    name: *const c_char,
    metadata: *const c_char,
    flags: i64,
    n_children: i64,
    children: *mut *mut Schema,
    dictionary: *mut Schema,
    release: Option<unsafe extern "C" fn(*mut Schema)>,
    private_data: *mut c_void,
}

#[repr(C)]
struct Array {
    length: i64,
    null_count: i64,
    offset: i64,
    n_buffers: i64,
    n_children: i64,
    buffers: *mut *const c_void,
    children: *mut *mut Array,
    dictionary: *mut Array,
    release: Option<unsafe extern "C" fn(*mut Array)>,
    private_data: *mut c_void,
}

#[repr(C)]
pub struct Stream {
    get_schema: Option<unsafe extern "C" fn(*mut Stream, *mut Schema) -> c_int>,
    get_next: Option<unsafe extern "C" fn(*mut Stream, *mut Array) -> c_int>,
    get_last_error: Option<unsafe extern "C" fn(*mut Stream) -> *const c_char>,
    release: Option<unsafe extern "C" fn(*mut Stream)>,
    private_data: *mut c_void,
}

// SAFETY: the pointers of a stream are its own, and the owners of cells behind them may be sent.
unsafe impl Send for Stream {}

/// What a schema points to.
struct OwnSchema {
    name: CString,
    metadata: Vec<u8>,
    children: Vec<*mut Schema>,
}

/// What an array points to.
struct OwnArray {
    /// Kept for `buffers`, which point into it.
    _cells: Option<Cells>,
    buffers: Vec<*const c_void>,
    children: Vec<*mut Array>,
}

/// What a stream has left.
struct OwnStream {
    /// Name, unit and format of each column.
    columns: Vec<(String, String, &'static CStr)>,
    /// The batch, until it is taken.
    batches: VecDeque<Vec<Cells>>,
    rows: i64,
}

impl Stream {
    /// A stream of columns with their names and units.
    ///
    /// # Errors
    /// If a column has another length than the table, whose consumer would read beyond its end.
    pub fn new(columns: Vec<(String, String, Cells)>, rows: usize) -> Result<Self, String> {
        if let Some((name, _, cells)) = columns.iter().find(|(.., cells)| cells.len() != rows) {
            return Err(format!("the column {name} has {} rows, the table {rows}", cells.len()));
        }
        let heads = columns
            .iter()
            .map(|(name, unit, cells)| (name.clone(), unit.clone(), cells.format()));
        let stream = OwnStream {
            columns: heads.collect(),
            rows: i64::try_from(rows).map_err(|error| error.to_string())?,
            batches: VecDeque::from([columns.into_iter().map(|(.., cells)| cells).collect()]),
        };
        Ok(Self {
            get_schema: Some(get_schema),
            get_next: Some(get_next),
            get_last_error: Some(get_last_error),
            release: Some(release_stream),
            private_data: Box::into_raw(Box::new(stream)).cast(),
        })
    }

    /// Releases the stream unless a consumer has moved it out, which leaves it without `release`.
    pub fn release(&mut self) {
        if let Some(release) = self.release {
            // SAFETY: the stream is of `new` and was not released.
            unsafe { release(self) };
        }
    }
}

/// The pairs of metadata in the encoding of Arrow: their number, then length and bytes of each key and value.
fn encoded(pairs: &[(&str, &str)]) -> Vec<u8> {
    let length = |n: usize| i32::try_from(n).unwrap_or_default().to_ne_bytes();
    let mut bytes = length(pairs.len()).to_vec();
    for text in pairs.iter().flat_map(|(key, value)| [key, value]) {
        bytes.extend_from_slice(&length(text.len()));
        bytes.extend_from_slice(text.as_bytes());
    }
    bytes
}

fn schema(name: &str, metadata: Vec<u8>, format: &'static CStr, children: Vec<Schema>) -> Schema {
    let children = children
        .into_iter()
        .map(|child| Box::into_raw(Box::new(child)))
        .collect();
    let mut kept = Box::new(OwnSchema {
        // Names of columns have no zero bytes.
        name: CString::new(name).unwrap_or_default(),
        metadata,
        children,
    });
    Schema {
        format: format.as_ptr(),
        name: kept.name.as_ptr(),
        metadata: if kept.metadata.is_empty() {
            null()
        } else {
            kept.metadata.as_ptr().cast()
        },
        flags: NULLABLE,
        n_children: i64::try_from(kept.children.len()).unwrap_or_default(),
        children: kept.children.as_mut_ptr(),
        dictionary: null_mut(),
        release: Some(release_schema),
        private_data: Box::into_raw(kept).cast(),
    }
}

/// An array of cells.
fn array(cells: Cells, rows: i64) -> Array {
    let (buffers, gaps): (Vec<*const c_void>, i64) = match &cells {
        // Gaps are NaN, as in the arrays.
        Cells::Numbers { first, .. } => (vec![null(), first.cast()], 0),
        Cells::Texts {
            valid,
            offsets,
            bytes,
            gaps,
        } => (
            vec![valid.as_ptr().cast(), offsets.as_ptr().cast(), bytes.as_ptr().cast()],
            *gaps,
        ),
    };
    owned(Some(cells), buffers, Vec::new(), rows, gaps)
}

fn owned(cells: Option<Cells>, buffers: Vec<*const c_void>, children: Vec<Array>, rows: i64, gaps: i64) -> Array {
    let children = children
        .into_iter()
        .map(|child| Box::into_raw(Box::new(child)))
        .collect();
    let mut kept = Box::new(OwnArray {
        _cells: cells,
        buffers,
        children,
    });
    Array {
        length: rows,
        null_count: gaps,
        offset: 0,
        n_buffers: i64::try_from(kept.buffers.len()).unwrap_or_default(),
        n_children: i64::try_from(kept.children.len()).unwrap_or_default(),
        buffers: kept.buffers.as_mut_ptr(),
        children: kept.children.as_mut_ptr(),
        dictionary: null_mut(),
        release: Some(release_array),
        private_data: Box::into_raw(kept).cast(),
    }
}

unsafe extern "C" fn get_schema(stream: *mut Stream, out: *mut Schema) -> c_int {
    // SAFETY: a consumer calls it with the stream made above, not released, and with room for a schema.
    unsafe {
        let stream_data = &*(*stream).private_data.cast::<OwnStream>();
        let column = |(name, unit, format): &(String, String, &'static CStr)| {
            let metadata = if unit.is_empty() {
                Vec::new()
            } else {
                encoded(&[("unit", unit)])
            };
            schema(name, metadata, format, Vec::new())
        };
        out.write(schema(
            "",
            Vec::new(),
            c"+s",
            stream_data.columns.iter().map(column).collect(),
        ));
    }
    FINE
}

unsafe extern "C" fn get_next(stream: *mut Stream, out: *mut Array) -> c_int {
    // SAFETY: as for the schema, with room for an array. The end of a stream is an array without `release`.
    unsafe {
        let stream_data = &mut *(*stream).private_data.cast::<OwnStream>();
        let next = stream_data.batches.pop_front().map(|cells| {
            let children = cells.into_iter().map(|cells| array(cells, stream_data.rows)).collect();
            owned(None, vec![null()], children, stream_data.rows, 0)
        });
        out.write(next.unwrap_or(Array {
            length: 0,
            null_count: 0,
            offset: 0,
            n_buffers: 0,
            n_children: 0,
            buffers: null_mut(),
            children: null_mut(),
            dictionary: null_mut(),
            release: None,
            private_data: null_mut(),
        }));
    }
    FINE
}

unsafe extern "C" fn get_last_error(_: *mut Stream) -> *const c_char {
    null()
}

unsafe extern "C" fn release_stream(stream: *mut Stream) {
    // SAFETY: called once by the consumer or the capsule; `private_data` is the box of the stream.
    unsafe {
        drop(Box::from_raw((*stream).private_data.cast::<OwnStream>()));
        (*stream).release = None;
    }
}

unsafe extern "C" fn release_schema(schema: *mut Schema) {
    // SAFETY: called once; the children that a consumer has moved out have no `release` any more.
    unsafe {
        let kept = Box::from_raw((*schema).private_data.cast::<OwnSchema>());
        for child in kept.children {
            let child = &mut *Box::from_raw(child);
            if let Some(release) = child.release {
                release(child);
            }
        }
        (*schema).release = None;
    }
}

unsafe extern "C" fn release_array(array: *mut Array) {
    // SAFETY: as for a schema.
    unsafe {
        let kept = Box::from_raw((*array).private_data.cast::<OwnArray>());
        for child in kept.children {
            let child = &mut *Box::from_raw(child);
            if let Some(release) = child.release {
                release(child);
            }
        }
        (*array).release = None;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp)]
    use super::*;

    /// A stream of numbers and texts with a gap.
    fn stream() -> Stream {
        let numbers = vec![1.5, f64::NAN, -2.0];
        let first = numbers.as_ptr();
        // SAFETY: the vector owns three numbers, and moving it leaves them where they are.
        let numbers = unsafe { Cells::numbers(Box::new(numbers), first, 3) };
        let texts = Cells::texts([Some("first"), None, Some("a")].into_iter());
        let columns = vec![
            ("loss".to_owned(), "W".to_owned(), numbers),
            ("gear".to_owned(), String::new(), texts),
        ];
        Stream::new(columns, 3).expect("all columns have three rows")
    }

    fn empty_array() -> Array {
        owned(None, Vec::new(), Vec::new(), 0, 0)
    }

    #[test]
    fn a_consumer_reads_and_releases_everything() {
        let mut sent = stream();
        let mut read = schema("", Vec::new(), c"+s", Vec::new());
        let mut batch = empty_array();
        // SAFETY: as a consumer does: what is written over was released before, and each is released once.
        unsafe {
            release_schema(&raw mut read);
            assert_eq!(sent.get_schema.expect("it has one")(&raw mut sent, &raw mut read), FINE);
            assert_eq!(read.n_children, 2);
            let gear = &**read.children.add(1);
            assert_eq!(
                (CStr::from_ptr(gear.name), CStr::from_ptr(gear.format)),
                (c"gear", c"U")
            );
            release_array(&raw mut batch);
            assert_eq!(sent.get_next.expect("it has one")(&raw mut sent, &raw mut batch), FINE);
            let [loss, gear] = [&**batch.children, &**batch.children.add(1)];
            let numbers = std::slice::from_raw_parts((*loss.buffers.add(1)).cast::<f64>(), 3);
            assert!(numbers[0] == 1.5 && numbers[1].is_nan() && numbers[2] == -2.0);
            assert_eq!((gear.length, gear.null_count), (3, 1));
            assert_eq!(*(*gear.buffers).cast::<u8>(), 0b101);
            let offsets = std::slice::from_raw_parts((*gear.buffers.add(1)).cast::<i64>(), 4);
            assert_eq!(offsets, [0, 5, 5, 6]);
            release_array(&raw mut batch);
            assert_eq!(sent.get_next.expect("it has one")(&raw mut sent, &raw mut batch), FINE);
            assert!(batch.release.is_none(), "one batch");
            release_schema(&raw mut read);
        }
        sent.release();
    }

    #[test]
    fn a_consumer_may_move_columns_out_and_leave_the_rest() {
        let mut sent = stream();
        let mut batch = empty_array();
        // SAFETY: a child that is moved out stays without `release` in its batch.
        unsafe {
            release_array(&raw mut batch);
            sent.get_next.expect("it has one")(&raw mut sent, &raw mut batch);
            sent.release();
            let place = *batch.children;
            let mut loss = place.read();
            (*place).release = None;
            release_array(&raw mut batch);
            let numbers = std::slice::from_raw_parts((*loss.buffers.add(1)).cast::<f64>(), 3);
            assert_eq!(numbers[0], 1.5);
            release_array(&raw mut loss);
        }
    }

    #[test]
    fn a_column_of_another_length_is_refused() {
        let texts = |count| Cells::texts(std::iter::repeat_n(Some("a"), count));
        let columns = vec![
            ("long".to_owned(), String::new(), texts(3)),
            ("short".to_owned(), String::new(), texts(2)),
        ];
        let error = Stream::new(columns, 3).err().expect("one is short");
        assert_eq!(error, "the column short has 2 rows, the table 3");
    }
}
