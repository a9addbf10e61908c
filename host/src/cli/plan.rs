//! `peris plan`: what a scene needs, and why.

use super::source::load_lit;
use super::{CommandFailure, SCRIPT_HELP, ScriptArguments, SubcommandRow};
use crate::plan::Plan;
use crate::scene::Prepared;
use clap::{Args, FromArgMatches};

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "plan",
    summary: "Shows what rendering a scene needs, what is left out, and why.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, default_value = "teapot", value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: ScriptArguments,
    /// Leaves nothing out, as `render --everything` does
    #[arg(long)]
    everything: bool,
    /// As JSON
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let prepared = Prepared::new(&load_lit(&arguments.script, &arguments.definitions)?.scene)?;
    let view = prepared.view();
    let plan = if arguments.everything { Plan::everything(&prepared, &view) } else { Plan::new(&prepared, &view) };
    if arguments.json {
        say!("{}", serde_json::to_string_pretty(&plan)?);
    } else {
        say_on!("{}", plan.table());
    }
    Ok(())
}
