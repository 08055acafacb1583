//! The archive of an FMU. Equal contents give equal bytes: all dates are the same, and the order of files is fixed.

use std::io::Write;

use rawzip::{CompressionMethod, ZipArchiveWriter};

use crate::content::{Content, token};
use crate::library::Library;
use crate::{description, reference};

/// Version of the standard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

/// The default experiment, with reference inputs and outputs.
#[derive(Debug, Clone, Default)]
pub struct Experiment {
    /// Step between two communication points. \[s\]
    pub step: f64,
    /// Inputs: values of the variables of [`Content::slots`](crate::model::Model::slots) that are inputs, in order, for each step.
    pub inputs: Vec<Vec<f64>>,
}

/// An FMU.
#[derive(Debug, Clone)]
pub struct Fmu<'a> {
    /// Name of the model; letters, digits and other characters.
    pub name: String,
    /// Description as one line.
    pub description: String,
    /// Name and version of the writing program.
    pub tool: String,
    /// What it computes.
    pub content: &'a Content,
    /// Names and descriptions of the shares of the loss of a map, dot-separated and as a sentence.
    pub shares: &'a [(&'a str, &'a str)],
    /// The experiment.
    pub experiment: Experiment,
    /// Libraries; at least one.
    pub libraries: &'a [Library],
}

impl Fmu<'_> {
    /// The name as an identifier of C, which is the name of the library.
    pub fn identifier(&self) -> String {
        let letters = self
            .name
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
        let identifier: String = letters.collect();
        if identifier.starts_with(|c: char| c.is_ascii_alphabetic()) {
            identifier
        } else {
            format!("m_{identifier}")
        }
    }

    /// The bytes of the archive.
    ///
    /// # Errors
    /// If the archive becomes too large for its format.
    pub fn bytes(&self, version: Version) -> Result<Vec<u8>, String> {
        let content = self.content.encode();
        let token = String::from_utf8_lossy(&token(&content)).into_owned();
        let identifier = self.identifier();
        let mut files = vec![(
            "modelDescription.xml".to_owned(),
            description::xml(self, version, &token).into_bytes(),
        )];
        for library in self.libraries {
            let [two, extension, three] = library.platform.names();
            let folder = if version == Version::Two { two } else { three };
            files.push((
                format!("binaries/{folder}/{identifier}.{extension}"),
                library.bytes().to_vec(),
            ));
        }
        let resource = match self.content {
            Content::Map(_) => "resources/map.bin",
            Content::Network(_) => "resources/network.bin",
        };
        files.push((resource.to_owned(), content));
        files.push((
            "documentation/index.html".to_owned(),
            description::page(self).into_bytes(),
        ));
        files.extend(reference::files(self));
        zip(files).map_err(|error| error.to_string())
    }
}

/// A zip archive of files, deflated.
fn zip(files: Vec<(String, Vec<u8>)>) -> Result<Vec<u8>, rawzip::Error> {
    let mut archive = ZipArchiveWriter::new(Vec::new());
    for (name, bytes) in files {
        // The earliest date of the format; it says nothing.
        let date = rawzip::time::UtcDateTime::from_components(1980, 1, 1, 0, 0, 0, 0);
        let mut file = archive.new_file(&name).compression_method(CompressionMethod::DEFLATE);
        if let Some(date) = date {
            file = file.last_modified(date);
        }
        let (mut entry, config) = file.start()?;
        let packed = miniz_oxide::deflate::compress_to_vec(&bytes, 8);
        entry.write_all(&packed)?;
        let _ = config;
        let descriptor = rawzip::DataDescriptorOutput::new(rawzip::crc32(&bytes), bytes.len() as u64);
        entry.finish(descriptor)?;
    }
    archive.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::content::tests::network;

    fn fmu(content: &Content, libraries: &[Library], version: Version) -> Vec<u8> {
        let fmu = Fmu {
            name: "warm up/own".into(),
            description: "losses < 1 % & \"more\"".into(),
            tool: "test".into(),
            content,
            shares: &[],
            experiment: Experiment {
                step: 0.5,
                inputs: vec![vec![100.0, 5.0, 20.0, 0.0, 1e-4, 0.1, 15.0]; 3],
            },
            libraries,
        };
        fmu.bytes(version).expect("it is small")
    }

    /// Names and contents of an archive.
    fn files(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
        let archive = rawzip::ZipArchive::from_slice(bytes).expect("it is an archive");
        let mut files = Vec::new();
        for entry in archive.entries() {
            let entry = entry.expect("its entries can be read");
            let name = String::from_utf8_lossy(entry.file_path().as_ref()).into_owned();
            let stored = archive.get_entry(entry.wayfinder()).expect("it is there");
            let content = miniz_oxide::inflate::decompress_to_vec(stored.data()).expect("it is deflated");
            assert_eq!(rawzip::crc32(&content), entry.crc32(), "{name}");
            files.push((name, content));
        }
        files
    }

    #[test]
    fn an_fmu_has_its_files_and_always_the_same_bytes() {
        let content = Content::Network(network());
        let libraries: Vec<Library> = Library::own().into_iter().collect();
        for version in [Version::Two, Version::Three] {
            let bytes = fmu(&content, &libraries, version);
            assert_eq!(bytes, fmu(&content, &libraries, version));
            let files = files(&bytes);
            let of = |name: &str| {
                let found = files.iter().find(|(known, _)| known == name);
                found.map(|(_, content)| content.clone()).unwrap_or_default()
            };
            let resource = of("resources/network.bin");
            assert_eq!(Content::decode(&resource), Some(content.clone()));
            let xml = String::from_utf8(of("modelDescription.xml")).expect("it is text");
            let token = String::from_utf8_lossy(&token(&resource)).into_owned();
            for part in [
                token.as_str(),
                "losses &lt; 1 % &amp; &quot;more&quot;",
                "modelIdentifier=\"warm_up_own\"",
                "temperature.sump",
            ] {
                assert!(xml.contains(part), "{part}: {xml}");
            }
            assert!(xml.contains("<ModelExchange") && xml.contains("<CoSimulation"));
            // The sump has a heat capacity, the oil behind the cooler has none.
            assert_eq!(xml.matches("der(temperature.").count(), 1, "{xml}");
            // A head, and a row for each of the points.
            for name in ["inputs.csv", "outputs.csv"] {
                let text = of(&format!("extra/org.fmi-standard.fmi-ls-ref/{name}"));
                assert_eq!(String::from_utf8_lossy(&text).lines().count(), 4, "{name}");
            }
            assert!(files.iter().all(|(name, _)| !name.contains('\\')));
            let count = files.iter().filter(|(name, _)| name.starts_with("binaries/")).count();
            assert_eq!(count, libraries.len());
        }
    }
}
