use super::build::print;
use super::stop::Stop;
use crate::script::{Builtin, BuiltinKind, builtins};

const EXAMPLES: &str = "\
Examples:
  ogee builtins
  ogee builtins rotate_extrude";

/// List what the script language brings along
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// Show only these
    #[arg(value_name = "NAME")]
    names: Vec<String>,
}

pub(super) fn run(args: &Args) -> Result<(), Stop> {
    let known = |name: &&String| builtins().any(|builtin| builtin.name == **name);
    if let Some(unknown) = args.names.iter().find(|name| !known(name)) {
        return Err(Stop::Error(format!("there is no builtin `{unknown}`; `ogee builtins` lists them")));
    }
    let asked =
        |builtin: &&Builtin| args.names.is_empty() || args.names.iter().any(|name| name == builtin.name);
    let mut rows: Vec<&Builtin> = builtins().filter(asked).collect();
    rows.sort_by_key(|builtin| (builtin.is_missing(), builtin.kind, builtin.name));
    let mut text = String::new();
    for group in rows.chunk_by(|a, b| (a.is_missing(), a.kind) == (b.is_missing(), b.kind)) {
        text += title(group[0]);
        for builtin in group {
            text += &format!("  {}\n      {}\n", usage(builtin), builtin.help);
        }
    }
    print(&text)
}

fn title(builtin: &Builtin) -> &'static str {
    match builtin.kind {
        _ if builtin.is_missing() => "Not there yet\n",
        BuiltinKind::Module => "Modules\n",
        BuiltinKind::Function => "Functions\n",
        BuiltinKind::Variable => "Variables\n",
    }
}

fn usage(builtin: &Builtin) -> String {
    if builtin.is_missing() || builtin.kind == BuiltinKind::Variable {
        builtin.name.to_owned()
    } else {
        format!("{}({})", builtin.name, builtin.parameters.join(", "))
    }
}
