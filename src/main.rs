//! The program `gearloss`.

use std::process::ExitCode;

fn main() -> ExitCode {
    gearloss::main()
}
