//! The width of the registers in which the points of a batch are computed. It is chosen when the program runs, and changes no bit.

use std::sync::OnceLock;

use pulp::Arch;

/// Environment variable that limits the width, to compare widths on one processor: one of [`WIDTHS`].
pub const LIMIT: &str = "GEARLOSS_REGISTERS";

/// Widths on x86-64, by the instructions that use them: two, four and eight numbers.
pub const WIDTHS: [&str; 3] = ["sse2", "avx2", "avx512"];

/// The instructions of this program on this processor.
pub(super) fn arch() -> Arch {
    static ARCH: OnceLock<Arch> = OnceLock::new();
    *ARCH.get_or_init(|| limited(std::env::var(LIMIT).ok().as_deref()))
}

/// Name of the registers that batches use: one of [`WIDTHS`], or of those of another processor. A development build has the smallest.
pub fn registers() -> &'static str {
    if cfg!(debug_assertions) {
        return name(Arch::Scalar);
    }
    name(arch())
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
pub(super) fn limited(limit: Option<&str>) -> Arch {
    match limit {
        Some("sse2") => Arch::Scalar,
        Some("avx2") => pulp::x86::V3::try_new().map_or(Arch::Scalar, Arch::V3),
        _ => Arch::new(),
    }
}

#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
pub(super) fn limited(_: Option<&str>) -> Arch {
    Arch::new()
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn name(arch: Arch) -> &'static str {
    match arch {
        Arch::V4(_) => "avx512",
        Arch::V3(_) => "avx2",
        _ => "sse2",
    }
}

#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
fn name(arch: Arch) -> &'static str {
    match arch {
        Arch::Scalar => "scalar",
        _ => "vector",
    }
}
