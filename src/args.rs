//! Arguments of the commands.

use std::path::PathBuf;

use crate::shard::Shard;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use gearloss_workbench::form::LAYOUTS;

/// Power losses, efficiency and operating temperature of transmissions.
#[derive(Debug, Parser)]
#[command(name = "gearloss", version, about)]
pub struct Args {
    /// Command.
    #[command(subcommand)]
    pub command: Command,
}

/// Command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Checks gearbox and study files.
    Check(CheckArgs),
    /// Solves one operating point.
    Solve(SolveArgs),
    /// Shows every calculation step of one component's loss at one operating point.
    Explain(ExplainArgs),
    /// Runs a study and writes its results.
    Run(RunArgs),
    /// Counts the tasks of a study and proposes a number of shards for `run --shard K/N`.
    Shards(ShardsArgs),
    /// Makes the report of a run again from its files, without computing anything.
    Report(ReportArgs),
    /// Merges the parts of `run --shard` into the results of the whole study.
    Merge(MergeArgs),
    /// Lists mechanisms and models, or the inputs that a gearbox lacks for them.
    Models(ModelsArgs),
    /// Lists the designations of bearings and oils for gearbox files.
    Catalogue(CatalogueArgs),
    /// Compares every model with the measured sets of a corpus.
    Validate(ValidateArgs),
    /// Evaluates one model without a gearbox.
    Eval(EvalArgs),
    /// Prints a JSON Schema for editors.
    Schema(SchemaArgs),
    /// Fits a law to a table and prints it with its residuals.
    Fit(FitArgs),
    /// Converts files of another program: a REXS model into a gearbox and a study, results of OpenFOAM into a table.
    Import(ImportArgs),
    /// Writes a commented template: gearbox, study or plugin.
    New(NewArgs),
    /// Serves editors on standard input and output: findings, completion, explanations, renaming (Language Server Protocol).
    Lsp(LspArgs),
    /// Opens the workbench in the browser: a local page to edit, see and solve gearboxes and studies.
    Open(OpenArgs),
    /// Prints completions for a shell.
    Completions(CompletionsArgs),
    /// Writes the manual pages, one for each command.
    Man(ManArgs),
    /// Fills a template for `run --template`.
    #[command(hide = true)]
    FillTemplate,
}

/// Arguments of `completions`.
#[derive(Debug, ClapArgs)]
pub struct CompletionsArgs {
    /// Shell to complete in.
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Arguments of `man`.
#[derive(Debug, ClapArgs)]
pub struct ManArgs {
    /// Folder to write; created if it is missing. Pages of another version are replaced.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// Arguments of `open`.
#[derive(Debug, ClapArgs)]
pub struct OpenArgs {
    /// File or folder; default: the current folder.
    #[arg(value_name = "PATH", default_value = ".")]
    pub path: PathBuf,
    /// Does not open the browser; the printed address is for one on this computer.
    #[arg(long)]
    pub no_browser: bool,
    /// Stays when the last page is closed; otherwise it ends a minute later.
    #[arg(long)]
    pub keep: bool,
}

/// Arguments of `lsp`.
#[derive(Debug, ClapArgs)]
pub struct LspArgs {
    /// Uses the standard streams, which is the only way: for editors that always state it.
    #[arg(long)]
    pub stdio: bool,
}

/// Arguments of `fit`.
#[derive(Debug, ClapArgs)]
pub struct FitArgs {
    /// Law to fit.
    #[command(subcommand)]
    pub law: FitLaw,
}

/// A law to fit.
#[derive(Debug, Subcommand)]
pub enum FitLaw {
    /// Fits `planetary_drag/power_law` to a table over `speed [rpm]`, `nu [mm2/s]` and, if relevant, `volume [ml]`.
    PowerLaw {
        /// CSV file in the format of the drag model `table`.
        table: PathBuf,
    },
    /// Fits Eyring stress, pressure exponent and limiting stress of an oil to traction curves.
    Traction {
        /// CSV file with the columns `pressure [GPa]` (mean of the contact), `temperature [degC]` (of the film), `shear_rate [1/s]` or
        /// `sliding [m/s]` and `film [nm]`, `stress [MPa]` or `mu`, and optionally `slide_roll [%]`; points below 1 % are omitted.
        curves: PathBuf,
        #[command(flatten)]
        oil: OilArgs,
    },
    /// Fits the coefficient of boundary friction to a Stribeck curve.
    Stribeck {
        /// CSV file with the columns `lambda`, or `film [nm]` with `--rq`; measured `mu`; and `mu_film`, the friction of the film only.
        curve: PathBuf,
        /// Combined rms roughness of both flanks, such as `"0.28 um"`; required with `film` instead of `lambda`.
        #[arg(long, value_name = "ROUGHNESS")]
        rq: Option<String>,
        /// Exponent k of the share of boundary friction, 1 / (1 + lambda)^k.
        #[arg(long, default_value_t = 2.0)]
        exponent: f64,
    },
}

/// The oil that defines the viscosity.
#[derive(Debug, Clone, ClapArgs)]
#[group(required = true, multiple = true)]
pub struct OilArgs {
    /// Gearbox file that describes the oil.
    #[arg(long, value_name = "GEARBOX", conflicts_with = "oil")]
    pub gearbox: Option<PathBuf>,
    /// Lubricant of that gearbox; not needed if there is only one.
    #[arg(long, value_name = "ID", requires = "gearbox")]
    pub lubricant: Option<String>,
    /// The oil as an entry of `lubricants` in a gearbox: `"{ viscosity: { kv40: 27.3 mm2/s, kv100: 5.9 mm2/s } }"`.
    #[arg(long, value_name = "YAML")]
    pub oil: Option<String>,
}

/// Arguments of `new`.
#[derive(Debug, ClapArgs)]
pub struct NewArgs {
    /// Kind of template.
    #[command(subcommand)]
    pub what: NewWhat,
}

/// Kind of template.
#[derive(Debug, Subcommand)]
pub enum NewWhat {
    /// A gearbox with a common layout, ready to run: replace its values with yours.
    Gearbox(NewGearboxArgs),
    /// A study of a gearbox: efficiency map, comparison of models, loss breakdown, no-load losses.
    Study(NewStudyArgs),
    /// A crate with your own loss model: it compiles and contains a test to complete.
    Plugin(NewPluginArgs),
}

/// Arguments of `new gearbox`.
#[derive(Debug, ClapArgs)]
#[command(override_usage = "gearloss new gearbox [OPTIONS] <LAYOUT>")]
pub struct NewGearboxArgs {
    /// Layout of shafts and gears.
    #[arg(value_parser = layouts())]
    pub layout: Option<String>,
    /// File to write; an existing file is an error.
    #[arg(short, long, value_name = "FILE", default_value = "gearbox.yaml")]
    pub output: PathBuf,
}

/// Layouts that are asked for and do not exist.
const UNDESCRIBED: [&str; 5] = ["bevel", "hypoid", "cycloidal", "strain-wave", "helical-worm"];

/// Names of layouts with what they are.
fn layouts() -> PossibleValuesParser {
    let layouts = LAYOUTS.map(|layout| PossibleValue::new(layout.name).help(layout.about));
    // What cannot be described yet is refused with its reason.
    let others = UNDESCRIBED.map(|name| PossibleValue::new(name).hide(true));
    layouts.into_iter().chain(others).collect::<Vec<_>>().into()
}

/// Arguments of `new study`.
#[derive(Debug, ClapArgs)]
pub struct NewStudyArgs {
    /// Gearbox of the study; the template uses its gears, rating and first mesh.
    #[arg(long, value_name = "FILE", default_value = "gearbox.yaml")]
    pub gearbox: PathBuf,
    /// File to write; an existing file is an error.
    #[arg(short, long, value_name = "FILE", default_value = "study.yaml")]
    pub output: PathBuf,
}

/// Arguments of `new plugin`.
#[derive(Debug, ClapArgs)]
pub struct NewPluginArgs {
    /// Name of the crate, such as `acme-losses`.
    pub name: String,
    /// Folder to write [default: the name]; must be empty apart from `.git`.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Checkout of gearloss that the crate depends on [default: the checkout that this program was built from if it exists, otherwise this
    /// version on the crate registry].
    #[arg(long, value_name = "PATH")]
    pub gearloss: Option<PathBuf>,
}

/// Arguments of `import`.
#[derive(Debug, ClapArgs)]
pub struct ImportArgs {
    /// Format to import.
    #[command(subcommand)]
    pub from: ImportFrom,
}

/// Files of another program.
#[derive(Debug, Subcommand)]
pub enum ImportFrom {
    /// Gearbox, study and load cases from a REXS model (XML, JSON or archive; versions 1.0 to 2.0).
    ///
    /// Writes a commented gearbox.yaml, and study.yaml with load_cases.csv if the model has load cases. The end of gearbox.yaml lists what was
    /// taken, assumed and ignored, and what is missing for losses.
    Rexs {
        /// REXS file: .rexs, .rexsj, .rexsz or another name; the content decides.
        file: PathBuf,
        /// Folder to write; created if it is missing. Existing files are an error [default: name of the file without its ending, in the
        /// current folder].
        #[arg(short, long, value_name = "FOLDER")]
        output: Option<PathBuf>,
    },
    /// Catalogue of bearings from a maker's table: CSV or workbook, English or German headings, decimal comma or point.
    ///
    /// Prints what was taken and what is missing, and warns of implausible rows. The catalogue is used by `catalogues: { bearings: FILE }` of a
    /// gearbox.
    Bearings(BearingsArgs),
    /// Mean moments of OpenFOAM's `forces` function object, one run for each point of a table.
    OpenfoamForces(OpenfoamArgs),
}

/// Arguments of `import bearings`.
#[derive(Debug, ClapArgs)]
pub struct BearingsArgs {
    /// Table: CSV or .xlsx; the content decides.
    pub file: PathBuf,
    /// Assigns a column: `"c=Dyn. load rating [kN]"`. Keys: designation, kind, series, bore, outside, width, c, c0, e, y, y0, pu,
    /// calculation_factor, minimum_load_factor, reference_speed, limiting_speed. Can be repeated.
    #[arg(long, value_name = "KEY=HEADING")]
    pub columns: Vec<String>,
    /// Kind of all bearings, if no column states it, such as deep_groove_ball [default: from the series in the designation].
    #[arg(long)]
    pub kind: Option<String>,
    /// Decimal sign [default: detected].
    #[arg(long, value_enum)]
    pub decimal: Option<DecimalArg>,
    /// Sheet of a workbook [default: the first].
    #[arg(long, value_name = "NAME")]
    pub sheet: Option<String>,
    /// Line of the headings, or row of the sheet [default: the one with most of the known headings].
    #[arg(long, value_name = "N")]
    pub header_line: Option<u64>,
    /// Catalogue to write; an existing file is an error [default: NAME-catalogue.csv in the current folder].
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Arguments of `import openfoam-forces`.
#[derive(Debug, ClapArgs)]
pub struct OpenfoamArgs {
    /// CSV file of the runs: one column for each axis of the table, such as `speed [rpm]`, `nu [mm2/s]`, `volume [ml]`, and `folder` as
    /// the last column: output folder or file of the function object, relative to this file.
    pub runs: PathBuf,
    /// Axis of the moment.
    #[arg(long, value_enum)]
    pub axis: AxisArg,
    /// The axis is one of the coordinate system that the function object states [default: of the mesh].
    #[arg(long)]
    pub local_axes: bool,
    /// Start of the averaging time, such as `"0.5 s"`.
    #[arg(long, value_name = "TIME")]
    pub from: String,
    /// End of the averaging time [default: end of the run].
    #[arg(long, value_name = "TIME")]
    pub to: Option<String>,
    /// Factor on the moments, such as 3 if a third of the gearbox was simulated.
    #[arg(long, default_value_t = 1.0)]
    pub factor: f64,
    /// Table to write; an existing file is an error.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
}

/// Decimal sign of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DecimalArg {
    /// `1.5`
    Point,
    /// `1,5`
    Comma,
}

/// An axis of coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum AxisArg {
    /// First axis.
    X,
    /// Second axis.
    Y,
    /// Third axis.
    Z,
}

/// Models and overrides.
#[derive(Debug, Clone, Default, ClapArgs)]
pub struct ChoiceArgs {
    /// Model set: one of the gearbox's `model_sets`, or one from a linked crate.
    #[arg(long, value_name = "SET")]
    pub models: Option<String>,
    /// Changes a value of the resolved document; may be repeated. `*` matches one key.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub set: Vec<String>,
}

/// Arguments of `check`.
#[derive(Debug, ClapArgs)]
pub struct CheckArgs {
    /// Gearbox or study files, and folders of a corpus.
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub choice: ChoiceArgs,
    /// Prints the resolved document of a gearbox, with all defaults, catalogue values and models.
    #[arg(long)]
    pub resolved: bool,
    /// Prints what each analysis of a study computes: points, cycles, searches; of a gearbox the order in which torques and losses are
    /// found.
    #[arg(long, conflicts_with = "resolved")]
    pub plan: bool,
    /// Exit with code 1 if a result depends on evidence of this grade or lower, such as `recalled`.
    #[arg(long, value_name = "GRADE")]
    pub deny: Option<String>,
    /// Output format: text, or JSON with code, place and help of each finding.
    #[arg(long, value_enum, default_value = "table")]
    pub format: Format,
}

/// The operating point.
#[derive(Debug, Clone, ClapArgs)]
pub struct PointArgs {
    /// Gear; not needed if there is only one.
    #[arg(long)]
    pub gear: Option<String>,
    /// Torque that a port applies: `"10 Nm"` at `input`, or `"output=-200 Nm"`.
    #[arg(long, value_name = "[PORT=]TORQUE", allow_hyphen_values = true)]
    pub torque: Vec<String>,
    /// Speed of a port: `"8000 rpm"` at `input`, or `"output=300 rpm"`.
    #[arg(long, value_name = "[PORT=]SPEED", allow_hyphen_values = true)]
    pub speed: Vec<String>,
    /// Power that a port takes up, `"45 kW"` at `input` or `"output=-45 kW"`, in place of the torque or the speed of that port.
    #[arg(long, value_name = "[PORT=]POWER", allow_hyphen_values = true)]
    pub power: Vec<String>,
    /// Oil temperature, such as `"80 degC"` [default: from the gearbox].
    #[arg(long, value_name = "TEMPERATURE", allow_hyphen_values = true)]
    pub oil_temperature: Option<String>,
    /// Whether torque downstream is reduced by upstream losses.
    #[arg(long, value_enum, default_value_t = FlowArg::Real)]
    pub power_flow: FlowArg,
}

/// Real or ideal flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FlowArg {
    /// Torque is reduced by upstream losses.
    Real,
    /// Torques without losses.
    Ideal,
}

/// Output format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Tables as text.
    Table,
    /// JSON.
    Json,
}

/// Arguments of `solve`.
#[derive(Debug, ClapArgs)]
pub struct SolveArgs {
    /// Gearbox file.
    pub gearbox: PathBuf,
    #[command(flatten)]
    pub point: PointArgs,
    #[command(flatten)]
    pub choice: ChoiceArgs,
    /// Output format.
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
    /// Prints derivatives of losses, efficiency and balanced temperature over `torque:PORT`, `speed:PORT`, `oil_temperature` or a number
    /// of the resolved document; may be repeated.
    #[arg(long, value_name = "VARIABLE")]
    pub derivative: Vec<String>,
    /// Exit with code 1 if a model is used outside its range (`extrapolation`), or if the result depends on evidence of the given grade or
    /// lower.
    #[arg(long, value_name = "WHAT")]
    pub deny: Vec<String>,
}

/// Arguments of `explain`.
#[derive(Debug, ClapArgs)]
pub struct ExplainArgs {
    /// Gearbox file.
    pub gearbox: PathBuf,
    /// Component: an id such as `B1`, or a path such as `meshes.M1`.
    pub component: String,
    #[command(flatten)]
    pub point: PointArgs,
    #[command(flatten)]
    pub choice: ChoiceArgs,
}

/// Arguments of `run`.
#[derive(Debug, ClapArgs)]
pub struct RunArgs {
    /// Study file.
    pub study: PathBuf,
    /// Computes only part K of N, for `merge`; skips pieces that are already complete. Results are written to -o [default: `shards/K-of-N`
    /// next to the study].
    #[arg(long, value_name = "K/N", conflicts_with_all = ["template", "force", "deny", "verbose", "quiet", "open"])]
    pub shard: Option<Shard>,
    #[command(flatten)]
    pub results: ResultArgs,
}

/// Arguments of `shards`.
#[derive(Debug, ClapArgs)]
pub struct ShardsArgs {
    /// Study file.
    pub study: PathBuf,
}

/// Arguments of `merge`.
#[derive(Debug, ClapArgs)]
pub struct MergeArgs {
    /// Study file.
    pub study: PathBuf,
    /// Folders of all shards [default: the folders in `shards` next to the study].
    pub parts: Vec<PathBuf>,
    #[command(flatten)]
    pub results: ResultArgs,
}

/// Arguments of `report`.
#[derive(Debug, ClapArgs)]
pub struct ReportArgs {
    /// Folder of the results of a run.
    pub results: PathBuf,
    /// File to write [default: `report.html` in that folder].
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Template of the page, as of `run --template`.
    #[arg(long, value_name = "FILE")]
    pub template: Option<PathBuf>,
}

/// Output and exit code of a study.
#[derive(Debug, ClapArgs)]
pub struct ResultArgs {
    /// Folder for the results [default: `results` next to the study].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Template of the report [default: built-in].
    #[arg(long, value_name = "FILE")]
    pub template: Option<PathBuf>,
    /// Writes even if the folder contains other files.
    #[arg(long)]
    pub force: bool,
    /// `extrapolation`: exit with code 1 if a model is used outside its range at any point.
    #[arg(long, value_name = "WHAT")]
    pub deny: Vec<String>,
    #[command(flatten)]
    pub shown: ShownArgs,
}

/// What `run` prints and opens.
#[derive(Debug, Clone, Copy, Default, ClapArgs)]
pub struct ShownArgs {
    /// Prints all tables and notes.
    #[arg(short, long, conflicts_with = "quiet")]
    pub verbose: bool,
    /// Prints only errors, warnings and the path of the report.
    #[arg(short, long)]
    pub quiet: bool,
    /// Opens the report in the browser.
    #[arg(long)]
    pub open: bool,
}

/// Arguments of `models`.
#[derive(Debug, ClapArgs)]
pub struct ModelsArgs {
    /// Mechanism, such as `bearing`, or `rating`.
    pub mechanism: Option<String>,
    /// Model, such as `skf`, or the name of a rating.
    pub model: Option<String>,
    /// Lists the inputs that each model needs, and whether this gearbox has them.
    #[arg(long, value_name = "GEARBOX", conflicts_with = "format")]
    pub needs: Option<PathBuf>,
    /// Evaluates the check values of these models and prints them with their sources; exit code 1 if one is outside its tolerance.
    #[arg(long, conflicts_with_all = ["format", "needs"])]
    pub checks: bool,
    /// Output format: tables, or JSON with all data of the listed models.
    #[arg(long, value_enum, default_value = "table")]
    pub format: Format,
}

/// Arguments of `catalogue`.
#[derive(Debug, ClapArgs)]
pub struct CatalogueArgs {
    /// Catalogue to list.
    #[arg(value_enum)]
    pub of: CatalogueArg,
    /// Part of the designations to list, such as `6208` or `"VG 150"`, or a designation with suffixes, such as `6208-2RS1/C3` [default: all].
    pub text: Option<String>,
    /// Checks and searches this CSV file, or the tables of this folder, instead of the shipped catalogue.
    #[arg(long, value_name = "CSV")]
    pub file: Option<PathBuf>,
}

/// A catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CatalogueArg {
    /// Rolling bearings.
    Bearings,
    /// Lubricants.
    Oils,
    /// Materials of gears.
    Materials,
}

/// Arguments of `validate`.
#[derive(Debug, ClapArgs)]
pub struct ValidateArgs {
    /// Sets to compare with [default: all].
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,
    /// Folder of the sets, or of one set.
    #[arg(long, value_name = "FOLDER", default_value = "corpus")]
    pub corpus: PathBuf,
    /// Folder for `validation.html`, `validation.md` and `cells.csv` [default: `results` in the folder of the sets].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Arguments of `eval`.
#[derive(Debug, ClapArgs)]
pub struct EvalArgs {
    /// Mechanism and model, such as `bearing/skf`, or a rating, such as `rating/iso_281`.
    pub model: String,
    /// YAML file with `part`, `at` and optionally `model` or `rating` [default: the mechanism's example at its usual point].
    #[arg(long, value_name = "FILE")]
    pub input: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
}

/// Arguments of `schema`.
#[derive(Debug, ClapArgs)]
pub struct SchemaArgs {
    /// Kind of document.
    #[arg(value_enum)]
    pub kind: KindArg,
}

/// Kind of document.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum KindArg {
    /// A gearbox.
    Gearbox,
    /// A study.
    Study,
    /// Input of `eval`.
    Eval,
    /// Result of an analysis from `run`.
    Result,
    /// Output of `solve --format json`.
    Point,
    /// Output of `check --format json`.
    Check,
    /// Output of `models --format json`.
    Models,
}
