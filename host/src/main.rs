//! The program `peris`.

use host::memory::Counted;
use std::process::ExitCode;

#[global_allocator]
static MEMORY: Counted = Counted;

fn main() -> ExitCode {
    host::cli::main()
}
