//! Libraries inside of FMUs, and the platforms that load them.

use std::borrow::Cow;
use std::fmt;

/// The library of the platform for which this crate was compiled; empty if there is none.
const OWN: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/library"));

/// A platform.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Platform {
    /// Linux on x86-64.
    LinuxX86,
    /// Linux on 64-bit Arm.
    LinuxArm,
    /// Windows on x86-64.
    WindowsX86,
    /// Windows on 64-bit Arm.
    WindowsArm,
    /// macOS on x86-64.
    MacX86,
    /// macOS on 64-bit Arm.
    MacArm,
}

impl Platform {
    /// Folder of FMI 2.0, extension of the library, and folder of FMI 3.0. FMI 2.0 has no name for 64-bit Arm: there the names are
    /// those of FMI 3.0, except on macOS, where one folder is for all.
    pub fn names(self) -> [&'static str; 3] {
        match self {
            Self::LinuxX86 => ["linux64", "so", "x86_64-linux"],
            Self::LinuxArm => ["aarch64-linux", "so", "aarch64-linux"],
            Self::WindowsX86 => ["win64", "dll", "x86_64-windows"],
            Self::WindowsArm => ["aarch64-windows", "dll", "aarch64-windows"],
            Self::MacX86 => ["darwin64", "dylib", "x86_64-darwin"],
            Self::MacArm => ["darwin64", "dylib", "aarch64-darwin"],
        }
    }
}

/// A library for FMUs.
#[derive(Debug, Clone)]
pub struct Library {
    /// Its platform.
    pub platform: Platform,
    bytes: Cow<'static, [u8]>,
}

/// A file that is no library for FMUs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnknownLibrary {
    /// Not a library of a known system and processor.
    Platform,
    /// Without the functions of FMI.
    Functions,
}

impl fmt::Display for UnknownLibrary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Platform => "is not a library for Linux, Windows or macOS on x86-64 or 64-bit Arm",
            Self::Functions => "is not the library of an FMU that gearloss writes",
        })
    }
}

impl std::error::Error for UnknownLibrary {}

impl Library {
    /// The library of the platform for which this program was compiled; `None` if there is none.
    pub fn own() -> Option<Self> {
        Some(Self {
            platform: platform(OWN)?,
            bytes: Cow::Borrowed(OWN),
        })
    }

    /// A library as read from a file.
    ///
    /// # Errors
    /// If it is none.
    pub fn read(bytes: Vec<u8>) -> Result<Self, UnknownLibrary> {
        let platform = platform(&bytes).ok_or(UnknownLibrary::Platform)?;
        let has = |name: &[u8]| bytes.windows(name.len()).any(|part| part == name);
        if !(has(b"fmi2DoStep") && has(b"fmi3DoStep") && has(b"GEARLOSS")) {
            return Err(UnknownLibrary::Functions);
        }
        Ok(Self {
            platform,
            bytes: Cow::Owned(bytes),
        })
    }

    /// Its bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

/// The platform of a library, from its header: ELF, Portable Executable or Mach-O.
fn platform(bytes: &[u8]) -> Option<Platform> {
    let number = |at: usize| Some(u16::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
    let long = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
    if bytes.starts_with(b"\x7fELF\x02\x01") {
        return match number(18)? {
            62 => Some(Platform::LinuxX86),
            183 => Some(Platform::LinuxArm),
            _ => None,
        };
    }
    if bytes.starts_with(b"MZ") {
        let header = long(0x3c)? as usize;
        if bytes.get(header..)?.first_chunk()? != b"PE\0\0" {
            return None;
        }
        return match number(header + 4)? {
            0x8664 => Some(Platform::WindowsX86),
            0xaa64 => Some(Platform::WindowsArm),
            _ => None,
        };
    }
    match (long(0)?, long(4)?) {
        (0xfeed_facf, 0x0100_0007) => Some(Platform::MacX86),
        (0xfeed_facf, 0x0100_000c) => Some(Platform::MacArm),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_platform_follows_from_the_header() {
        let windows = |machine: [u8; 2]| {
            let mut bytes = vec![0; 0x90];
            bytes[..2].copy_from_slice(b"MZ");
            bytes[0x3c] = 0x80;
            bytes[0x80..0x84].copy_from_slice(b"PE\0\0");
            bytes[0x84..0x86].copy_from_slice(&machine);
            bytes
        };
        let elf = |machine: u8| [&b"\x7fELF\x02\x01"[..], &[0; 12], &[machine, 0]].concat();
        assert_eq!(platform(&elf(62)), Some(Platform::LinuxX86));
        assert_eq!(platform(&elf(183)), Some(Platform::LinuxArm));
        assert_eq!(platform(&elf(3)), None);
        assert_eq!(platform(&windows([0x64, 0x86])), Some(Platform::WindowsX86));
        assert_eq!(platform(&windows([0x64, 0xaa])), Some(Platform::WindowsArm));
        assert_eq!(
            platform(&[0xcf, 0xfa, 0xed, 0xfe, 0x0c, 0, 0, 1]),
            Some(Platform::MacArm)
        );
        assert_eq!(platform(b""), None);
        assert_eq!(platform(b"MZ"), None);
    }

    #[test]
    fn another_library_is_refused() {
        let elf = [&b"\x7fELF\x02\x01"[..], &[0; 12], &[62, 0]].concat();
        assert_eq!(Library::read(elf).err(), Some(UnknownLibrary::Functions));
        assert_eq!(Library::read(b"text".to_vec()).err(), Some(UnknownLibrary::Platform));
    }

    /// The versions of the C library that the own library needs, from the names in it.
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[test]
    fn the_own_library_is_small_and_needs_an_old_c_library() {
        let library = Library::own().expect("this target has a library");
        assert!(library.bytes().len() < 100_000, "{} bytes", library.bytes().len());
        assert!(Library::read(library.bytes().to_vec()).is_ok());
        let text = String::from_utf8_lossy(library.bytes());
        let versions = text.match_indices("GLIBC_").map(|(at, name)| {
            let rest = text[at + name.len()..].chars();
            let digits: String = rest.take_while(|c| c.is_ascii_digit() || *c == '.').collect();
            let mut numbers = digits.split('.').filter_map(|number| number.parse::<u32>().ok());
            [numbers.next().unwrap_or(0), numbers.next().unwrap_or(0)]
        });
        let newest = versions.max().expect("it needs a C library");
        assert!(newest <= [2, 17], "it needs GLIBC {}.{}", newest[0], newest[1]);
        // Nothing is exported that another library of the same process could take for its own.
        assert!(!text.contains("_Unwind_Resume") && !text.contains("rust_eh_personality"));
    }
}
