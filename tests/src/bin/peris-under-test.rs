//! The program `peris`, built with the tests so that they always have it.

fn main() -> std::process::ExitCode {
    host::cli::main()
}
