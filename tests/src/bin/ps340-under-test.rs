//! The process `ps340`, built with the tests so that they always have it.

fn main() -> std::process::ExitCode {
    ps340::process::main()
}
