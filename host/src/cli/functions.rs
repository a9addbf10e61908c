//! `peris functions`: what a scene script may call.

use super::{CommandFailure, Exit, SubcommandRow};
use crate::script::{self, functions};
use crate::spelling;
use clap::{Args, FromArgMatches};

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "functions",
    summary: "Lists the functions of scene scripts, or explains one.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// The function to explain; without it, all are listed
    name: Option<String>,
    /// The whole reference, as Markdown
    #[arg(long)]
    reference: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    if arguments.reference {
        say_on!("{}", script::reference());
    } else if let Some(name) = &arguments.name {
        let function = functions().find(|f| f.name == name);
        let unknown = || {
            let known: Vec<&str> = functions().map(|function| function.name).collect();
            let question =
                spelling::question(name, &known).map_or_else(String::new, |question| format!("; {question}"));
            CommandFailure::new(Exit::Usage, anyhow::anyhow!("there is no function {name}{question}"))
        };
        let function = function.ok_or_else(unknown)?;
        say!("{}", function.help());
    } else {
        let width = functions().map(|f| f.name.len()).max().unwrap_or(0);
        for function in functions() {
            say!("{:<width$}  {}", function.name, function.summary);
        }
    }
    Ok(())
}
