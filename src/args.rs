//! Arguments of the commands.

use std::path::PathBuf;

use crate::commands::run::Shard;
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};

/// Power losses, efficiency and operating temperature of transmissions.
#[derive(Debug, Parser)]
#[command(name = "gearloss", version, about)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Checks gearbox and study files: reads, resolves and builds them.
    Check(CheckArgs),
    /// Solves one operating point.
    Solve(SolveArgs),
    /// Shows every step of the loss of one component at one operating point.
    Explain(ExplainArgs),
    /// Runs a study and writes its results.
    Run(RunArgs),
    /// Joins the parts of `run --shard` to the results of the whole study.
    Merge(MergeArgs),
    /// Lists mechanisms and models, or what a gearbox lacks for them.
    Models(ModelsArgs),
    /// Lists the designations of bearings and oils that a gearbox may name.
    Catalogue(CatalogueArgs),
    /// Evaluates one model alone.
    Eval(EvalArgs),
    /// Prints a JSON Schema for editors.
    Schema(SchemaArgs),
    /// Fits a law to a table and prints it with its residuals.
    Fit(FitArgs),
    /// Makes a table from the files of another program.
    Import(ImportArgs),
    /// Writes a commented file to start from.
    New(NewArgs),
}

/// Arguments of `fit`.
#[derive(Debug, ClapArgs)]
pub struct FitArgs {
    /// The law.
    #[command(subcommand)]
    pub law: FitLaw,
}

/// A law to fit.
#[derive(Debug, Subcommand)]
pub enum FitLaw {
    /// Fits `planetary_drag/power_law` to a table over `speed [rpm]`, `nu [mm2/s]` and, where it counts, `volume [ml]`.
    PowerLaw {
        /// CSV file, as a drag model `table` reads it.
        table: PathBuf,
    },
    /// Eyring stress, exponent over pressure and limiting stress of an oil from traction curves.
    Traction {
        /// CSV file: `pressure [GPa]` (mean of the contact), `temperature [degC]` (of the film), `shear_rate [1/s]` or `sliding [m/s]`
        /// and `film [nm]`, `stress [MPa]` or `mu`; and, if wanted, `slide_roll [%]`, below 1 % of which points are left out.
        curves: PathBuf,
        #[command(flatten)]
        oil: OilArgs,
    },
    /// Coefficient of boundary friction from a Stribeck curve.
    Stribeck {
        /// CSV file: `lambda`, or `film [nm]` with `--rq`; measured `mu`, and `mu_film`, the friction of the film alone.
        curve: PathBuf,
        /// Rms roughness of both flanks together, such as `"0.28 um"`; for films in place of `lambda`.
        #[arg(long, value_name = "ROUGHNESS")]
        rq: Option<String>,
        /// Exponent of the share of boundary friction over one plus the film ratio.
        #[arg(long, default_value_t = 2.0)]
        exponent: f64,
    },
}

/// Whose viscosity holds.
#[derive(Debug, Clone, ClapArgs)]
#[group(required = true, multiple = true)]
pub struct OilArgs {
    /// Gearbox file that describes the oil.
    #[arg(long, value_name = "GEARBOX", conflicts_with = "oil")]
    pub gearbox: Option<PathBuf>,
    /// Its name among the `lubricants` of that file; not needed where there is only one.
    #[arg(long, value_name = "ID", requires = "gearbox")]
    pub lubricant: Option<String>,
    /// The oil itself, as below `lubricants` of a gearbox: `"{ viscosity: { kv40: 27.3 mm2/s, kv100: 5.9 mm2/s } }"`.
    #[arg(long, value_name = "YAML")]
    pub oil: Option<String>,
}

/// Arguments of `new`.
#[derive(Debug, ClapArgs)]
pub struct NewArgs {
    /// What to start.
    #[command(subcommand)]
    pub what: NewWhat,
}

/// What to start.
#[derive(Debug, Subcommand)]
pub enum NewWhat {
    /// A gearbox of a usual layout, which runs as it is: replace its figures by your own.
    Gearbox(NewGearboxArgs),
    /// A study of a gearbox: map, comparison of models, stack-up of losses, losses without load.
    Study(NewStudyArgs),
    /// A crate with a loss model of your own: it compiles as it is and has a test for you to finish.
    Plugin(NewPluginArgs),
}

/// Arguments of `new gearbox`.
#[derive(Debug, ClapArgs)]
#[command(override_usage = "gearloss new gearbox [OPTIONS] <LAYOUT>")]
pub struct NewGearboxArgs {
    /// How the shafts and gears are laid out.
    #[arg(value_enum)]
    pub layout: Option<Layout>,
    /// File to write; refused where it exists.
    #[arg(short, long, value_name = "FILE", default_value = "gearbox.yaml")]
    pub output: PathBuf,
}

/// How shafts and gears are laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Layout {
    /// Reducer with one helical stage.
    SingleStage,
    /// Reducer with two helical stages on parallel shafts.
    TwoStage,
    /// Planetary set: sun in, ring held, carrier out, planets on needle cages.
    Planetary,
    /// Two speeds: loose wheels on needle cages, a synchronizer between them, neutral.
    TwoSpeed,
    /// Two countershafts that share the power between coaxial shafts.
    DualCountershaft,
}

/// Arguments of `new study`.
#[derive(Debug, ClapArgs)]
pub struct NewStudyArgs {
    /// Gearbox that the study is about; its gear states, rating and first mesh are written into the study.
    #[arg(long, value_name = "FILE", default_value = "gearbox.yaml")]
    pub gearbox: PathBuf,
    /// File to write; refused where it exists.
    #[arg(short, long, value_name = "FILE", default_value = "study.yaml")]
    pub output: PathBuf,
}

/// Arguments of `new plugin`.
#[derive(Debug, ClapArgs)]
pub struct NewPluginArgs {
    /// Name of the crate, such as `acme-losses`.
    pub name: String,
    /// Folder to write; absent, the name. Refused where it holds anything but `.git`.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Checkout of gearloss that the crate is built on; absent, the one that this program was built from while it is there,
    /// else this version in the registry of crates.
    #[arg(long, value_name = "PATH")]
    pub gearloss: Option<PathBuf>,
}

/// Arguments of `import`.
#[derive(Debug, ClapArgs)]
pub struct ImportArgs {
    /// What to read.
    #[command(subcommand)]
    pub from: ImportFrom,
}

/// Files of another program.
#[derive(Debug, Subcommand)]
pub enum ImportFrom {
    /// Means of the moments that OpenFOAM's `forces` function object has written, one run for each point of a table.
    OpenfoamForces {
        /// CSV file of the runs: a column for each axis of the table, such as `speed [rpm]`, `nu [mm2/s]`, `volume [ml]`, and
        /// last `folder`: the output folder of the function object, or a file, relative to this file.
        runs: PathBuf,
        /// Axis that the moment is about.
        #[arg(long, value_enum)]
        axis: AxisArg,
        /// Time from which on the mean is taken, such as `"0.5 s"`.
        #[arg(long, value_name = "TIME")]
        from: String,
        /// Time up to which the mean is taken; else all.
        #[arg(long, value_name = "TIME")]
        to: Option<String>,
        /// Factor on the moments, such as 3 where a third of the gearbox was simulated.
        #[arg(long, default_value_t = 1.0)]
        factor: f64,
        /// Table to write; refused where the file exists.
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
    },
}

/// An axis of coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum AxisArg {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

/// Models and overrides.
#[derive(Debug, Clone, Default, ClapArgs)]
pub struct ChoiceArgs {
    /// Set of models: one of the gearbox's `model_sets`, or one that a linked crate ships.
    #[arg(long, value_name = "SET")]
    pub models: Option<String>,
    /// Changes a value of the resolved document; may be given several times. `*` stands for one key.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub set: Vec<String>,
}

/// Arguments of `check`.
#[derive(Debug, ClapArgs)]
pub struct CheckArgs {
    /// Gearbox or study files.
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub choice: ChoiceArgs,
    /// Prints the resolved document of a gearbox: every default, catalogue value and model in its place.
    #[arg(long)]
    pub resolved: bool,
    /// Makes it a finding to rest on evidence of this grade or a weaker one, such as `recalled`.
    #[arg(long, value_name = "GRADE")]
    pub deny: Option<String>,
    /// Text, or JSON with code, place and help of each finding.
    #[arg(long, value_enum, default_value = "table")]
    pub format: Format,
}

/// The operating point.
#[derive(Debug, Clone, ClapArgs)]
pub struct PointArgs {
    /// Gear state; not needed where there is only one.
    #[arg(long)]
    pub gear: Option<String>,
    /// Torque that a port applies: `"10 Nm"` at `input`, or `"output=-200 Nm"`.
    #[arg(long, value_name = "[PORT=]TORQUE", allow_hyphen_values = true)]
    pub torque: Vec<String>,
    /// Speed of a port: `"8000 rpm"` at `input`, or `"output=300 rpm"`.
    #[arg(long, value_name = "[PORT=]SPEED", allow_hyphen_values = true)]
    pub speed: Vec<String>,
    /// Temperature of the oil, such as `"80 degC"`; else that of the gearbox.
    #[arg(long, value_name = "TEMPERATURE", allow_hyphen_values = true)]
    pub oil_temperature: Option<String>,
    /// Whether losses change the torques of what comes after them.
    #[arg(long, value_enum, default_value_t = FlowArg::Real)]
    pub power_flow: FlowArg,
}

/// Real or ideal flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FlowArg {
    /// Torque after a stage is reduced by the losses before it.
    Real,
    /// Torques without losses.
    Ideal,
}

/// How to print.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A table to read.
    Table,
    /// JSON to process.
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
    /// How to print.
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
    /// Makes it a finding to leave the stated range of a model: `extrapolation`, or to rest on a grade of evidence.
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
    /// Computes only part K of N, for `merge`: what is not yet there of it. Its folder is `shards/K-of-N` beside the study, or
    /// that of -o.
    #[arg(long, value_name = "K/N", conflicts_with_all = ["template", "force", "deny"])]
    pub shard: Option<Shard>,
    #[command(flatten)]
    pub results: ResultArgs,
}

/// Arguments of `merge`.
#[derive(Debug, ClapArgs)]
pub struct MergeArgs {
    /// Study file.
    pub study: PathBuf,
    /// Folders of all shards; absent, those in `shards` beside the study.
    pub parts: Vec<PathBuf>,
    #[command(flatten)]
    pub results: ResultArgs,
}

/// Where the results of a study go, and how it ends.
#[derive(Debug, ClapArgs)]
pub struct ResultArgs {
    /// Folder for the results; absent, `results` beside the study.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Template of the report, in place of the built-in one.
    #[arg(long, value_name = "FILE")]
    pub template: Option<PathBuf>,
    /// Writes into a folder that holds other files.
    #[arg(long)]
    pub force: bool,
    /// Makes it a finding to leave the stated range of a model at any point: `extrapolation`.
    #[arg(long, value_name = "WHAT")]
    pub deny: Vec<String>,
}

/// Arguments of `models`.
#[derive(Debug, ClapArgs)]
pub struct ModelsArgs {
    /// Mechanism, such as `bearing`.
    pub mechanism: Option<String>,
    /// Model, such as `skf`.
    pub model: Option<String>,
    /// Says for each model which inputs it needs and whether this gearbox has them.
    #[arg(long, value_name = "GEARBOX", conflicts_with = "format")]
    pub needs: Option<PathBuf>,
    /// Tables, or JSON with everything of the models listed.
    #[arg(long, value_enum, default_value = "table")]
    pub format: Format,
}

/// Arguments of `catalogue`.
#[derive(Debug, ClapArgs)]
pub struct CatalogueArgs {
    /// Which catalogue.
    #[arg(value_enum)]
    pub of: CatalogueArg,
    /// Part of the designations to list, such as `6208` or `"VG 150"`; absent, all.
    pub text: Option<String>,
}

/// A catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CatalogueArg {
    /// Rolling bearings.
    Bearings,
    /// Lubricants.
    Oils,
}

/// Arguments of `eval`.
#[derive(Debug, ClapArgs)]
pub struct EvalArgs {
    /// Mechanism and model, such as `bearing/skf`.
    pub model: String,
    /// YAML file with `part`, `at` and, if wanted, `model`; absent, the mechanism's example at its usual point.
    #[arg(long, value_name = "FILE")]
    pub input: Option<PathBuf>,
    /// How to print.
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
    /// What `run` writes for an analysis.
    Result,
    /// What `solve --format json` prints.
    Point,
    /// What `check --format json` prints.
    Check,
    /// What `models --format json` prints.
    Models,
}

impl AxisArg {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}
