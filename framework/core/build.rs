//! Empty build script. Cargo requires one for a package with a `links` key; the key prevents a program from linking two versions of
//! the framework, each of which would have only some of the models.

fn main() {
    #[allow(clippy::print_stdout, reason = "build scripts instruct Cargo by printing")]
    {
        println!("cargo::rerun-if-changed=build.rs");
    }
}
