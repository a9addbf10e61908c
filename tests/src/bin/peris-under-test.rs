//! The program `peris`, built with the tests so that they always have it.

#[global_allocator]
static MEMORY: host::memory::Counted = host::memory::Counted;

fn main() -> std::process::ExitCode {
    host::cli::main()
}
