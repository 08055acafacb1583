//! The program `gearloss` with the models of this crate.

use in_house_plugin as _;

fn main() -> std::process::ExitCode {
    gearloss::main()
}
