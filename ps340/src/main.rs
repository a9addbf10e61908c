//! The process `ps340`: an emulated PS 340 with its host lines and its operator line.

fn main() -> std::process::ExitCode {
    ps340::process::main()
}
