//! The program `peris`.

use std::process::ExitCode;

fn main() -> ExitCode {
    host::cli::main()
}
