//! Nothing is built here. Cargo asks a package with a `links` key for a build script; the key keeps a program from linking two
//! versions of the framework, of which each would see its own half of the models.

fn main() {
    #[allow(clippy::print_stdout, reason = "this is how a build script speaks to Cargo")]
    {
        println!("cargo::rerun-if-changed=build.rs");
    }
}
