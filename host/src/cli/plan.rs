//! `peris plan`: what a scene needs, and why.

use super::source::{load_lit, warn_of_short_scatters};
use super::{CommandFailure, SCRIPT_HELP, ScriptArguments, SubcommandRow, progress};
use crate::plan::Plan;
use crate::render::{RenderOrder, Renderer, ray_tracer};
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
    /// Renders one sample of each pixel, and tells how long those stages took of which that is known
    #[arg(long)]
    seconds: bool,
    /// Prints JSON
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let prepared = Prepared::new(&load_lit(&arguments.script, &arguments.definitions)?.scene)?;
    warn_of_short_scatters(&prepared);
    let view = prepared.view();
    let mut plan = if arguments.everything { Plan::everything(&prepared, &view) } else { Plan::new(&prepared, &view) };
    if arguments.seconds {
        let order = RenderOrder { samples: 1, ..RenderOrder::of(&prepared.settings) };
        ray_tracer(&prepared, &plan)?.render(&view, &order, &progress::watch())?;
        plan.set_seconds(&progress::totals());
    }
    if arguments.json {
        say!("{}", serde_json::to_string_pretty(&plan)?);
    } else {
        say_on!("{}", plan.table());
    }
    Ok(())
}
