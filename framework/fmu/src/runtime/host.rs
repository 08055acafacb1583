//! What the system provides: memory, files, the end of the process.

#[cfg(not(any(hosted, test)))]
mod system {
    use alloc::ffi::CString;
    use alloc::vec::Vec;
    use core::alloc::{GlobalAlloc, Layout};
    use core::ffi::{c_char, c_int, c_void};

    #[link(name = "c")]
    unsafe extern "C" {
        fn malloc(size: usize) -> *mut c_void;
        fn realloc(old: *mut c_void, size: usize) -> *mut c_void;
        fn free(memory: *mut c_void);
        fn abort() -> !;
        fn fopen(path: *const c_char, mode: *const c_char) -> *mut c_void;
        fn fread(to: *mut c_void, size: usize, count: usize, file: *mut c_void) -> usize;
        fn fclose(file: *mut c_void) -> c_int;
    }

    /// The allocator of the C library; it aligns to 16 bytes, and nothing here needs more.
    struct Memory;

    // SAFETY: malloc, realloc and free fulfil the contract for alignments up to 16; larger ones are refused.
    unsafe impl GlobalAlloc for Memory {
        unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
            if layout.align() > 16 {
                return core::ptr::null_mut();
            }
            // SAFETY: any size is allowed.
            unsafe { malloc(layout.size()).cast() }
        }

        unsafe fn dealloc(&self, memory: *mut u8, _: Layout) {
            // SAFETY: it came from malloc.
            unsafe { free(memory.cast()) }
        }

        unsafe fn realloc(&self, memory: *mut u8, _: Layout, size: usize) -> *mut u8 {
            // SAFETY: it came from malloc, with an alignment of at most 16.
            unsafe { realloc(memory.cast(), size).cast() }
        }
    }

    // Where the border is only checked, as a part of another crate, that one has its own.
    #[cfg(not(clippy))]
    #[global_allocator]
    static MEMORY: Memory = Memory;

    #[cfg(not(clippy))]
    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        // SAFETY: always allowed.
        unsafe { abort() }
    }

    /// The bytes of a file up to a length.
    pub fn read(path: &[u8], longest: usize) -> Option<Vec<u8>> {
        let path = CString::new(path).ok()?;
        // SAFETY: both texts end with a zero byte.
        let file = unsafe { fopen(path.as_ptr(), c"rb".as_ptr()) };
        if file.is_null() {
            return None;
        }
        let mut bytes = Vec::new();
        let is_whole = loop {
            let at = bytes.len();
            bytes.resize(at + (1 << 16), 0);
            let Some(room) = bytes.get_mut(at..) else { break false };
            // SAFETY: there is room for as many bytes, and the file is open.
            let count = unsafe { fread(room.as_mut_ptr().cast(), 1, room.len(), file) };
            bytes.truncate(at + count);
            if count == 0 {
                break true;
            }
            if bytes.len() > longest {
                break false;
            }
        };
        // SAFETY: the file is open.
        unsafe { fclose(file) };
        is_whole.then_some(bytes)
    }
}

#[cfg(any(hosted, test))]
mod system {
    use std::io::Read;

    /// The bytes of a file up to a length.
    pub fn read(path: &[u8], longest: usize) -> Option<Vec<u8>> {
        let file = std::fs::File::open(core::str::from_utf8(path).ok()?).ok()?;
        let mut bytes = Vec::new();
        file.take(longest as u64 + 1).read_to_end(&mut bytes).ok()?;
        (bytes.len() <= longest).then_some(bytes)
    }
}

pub use system::read;
