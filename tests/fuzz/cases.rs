//! Cases: a command with the files that it reads, made of sound ones and changed.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use gearloss_framework::registry::Registry;

use super::mutate::{self, Words};
use super::random::Random;
use super::tree::Tree;

/// One case: files by name, and the command that reads them.
pub struct Case {
    pub files: BTreeMap<String, String>,
    pub command: Vec<String>,
}

/// Sound documents and tables that cases begin with.
pub struct Sound {
    gearboxes: Vec<(&'static str, Tree)>,
    study: Tree,
    /// Inputs of `eval` with their model.
    inputs: Vec<(String, Tree)>,
    tables: BTreeMap<&'static str, String>,
    words: Words,
}

/// Files of the repository that cases begin with, by their names there.
const GEARBOXES: [(&str, &str); 4] = [
    ("car.yaml", "examples/two-speed-ev/gearbox.yaml"),
    ("reducer.yaml", "examples/planetary-reducer/gearbox.yaml"),
    ("unit.yaml", "examples/electric-drive-unit/gearbox.yaml"),
    ("fine.yaml", "tests/cases/fine/input.yaml"),
];
const TABLES: [(&str, &str); 13] = [
    ("drag.csv", "examples/planetary-reducer/drag.csv"),
    ("motor_map.csv", "examples/electric-drive-unit/motor_map.csv"),
    ("stribeck.csv", "examples/electric-drive-unit/stribeck.csv"),
    ("traction.csv", "examples/electric-drive-unit/traction.csv"),
    ("bearings.csv", "plugins/catalogues/bearings.csv"),
    ("lubricants.csv", "plugins/catalogues/lubricants.csv"),
    ("bare.csv", "tests/results/bare.csv"),
    ("drive.csv", "tests/results/drive.csv"),
    ("measured.csv", "tests/results/measured.csv"),
    ("points.csv", "tests/results/points.csv"),
    ("rig.csv", "tests/results/rig.csv"),
    ("seal.csv", "tests/results/seal.csv"),
    ("warm.csv", "tests/results/warm.csv"),
];

/// Keys that say how much is to be computed. They may be wrong, but not so large that a sound study takes hours.
const AMOUNTS: [&str; 12] = [
    "samples",
    "trajectories",
    "starts",
    "repeat",
    "places",
    "points",
    "checks",
    "shown",
    "nodes",
    "step",
    "tolerance",
    "folds",
];

impl Sound {
    pub fn read(root: &Path) -> Self {
        let text = |file: &str| fs::read_to_string(root.join(file)).unwrap();
        let gearboxes: Vec<(&str, Tree)> = GEARBOXES.map(|(name, file)| (name, Tree::read(&text(file)))).into();
        let mut study = Tree::read(&text("tests/results/study.yaml"));
        let named = Tree::read("{ car: car.yaml, reducer: reducer.yaml, unit: unit.yaml }");
        study.set("gearboxes", named);
        let registry = Registry::linked().unwrap();
        let mut inputs = Vec::new();
        for mechanism in registry.mechanisms() {
            let quantities = (mechanism.quantities)();
            for entry in registry.models(mechanism.key) {
                let at = quantities
                    .iter()
                    .map(|q| (q.name.to_owned(), Tree::Scalar(q.usual.to_string())));
                let input = vec![
                    ("at".to_owned(), Tree::Map(at.collect())),
                    ("part".to_owned(), Tree::read(entry.part.unwrap_or(mechanism.example))),
                    ("model".to_owned(), Tree::read(entry.example)),
                ];
                inputs.push((format!("{}/{}", mechanism.key, entry.name), Tree::Map(input)));
            }
        }
        let tables: BTreeMap<&str, String> = TABLES
            .iter()
            .map(|(name, file)| {
                // Of a catalogue some lines are as good as all.
                let most = if file.contains("catalogues") { 40 } else { 1000 };
                let lines: Vec<String> = text(file).lines().take(most).map(|line| format!("{line}\n")).collect();
                (*name, lines.concat())
            })
            .collect();
        let mut documents: Vec<Tree> = gearboxes.iter().map(|(_, tree)| tree.clone()).collect();
        documents.push(study.clone());
        documents.extend(inputs.iter().map(|(_, tree)| tree.clone()));
        documents.push(Tree::read(
            "{ catalogues: { bearings: bearings.csv, lubricants: lubricants.csv }, extends: fine.yaml, imported_loads: { file: points.csv } }",
        ));
        Self {
            words: Words::from_documents(&documents),
            gearboxes,
            study,
            inputs,
            tables,
        }
    }

    /// The case of a number.
    pub fn case(&self, seed: u64, number: u64) -> Case {
        let mut random = Random::from_seed(seed, number);
        let random = &mut random;
        let mut files: BTreeMap<String, String> = self
            .tables
            .iter()
            .map(|(name, text)| ((*name).to_owned(), text.clone()))
            .collect();
        files.insert("run0/0/moment.dat".to_owned(), MOMENTS.to_owned());
        files.insert("runs.csv".to_owned(), RUNS.to_owned());
        let words = |list: &[&str]| list.iter().map(|word| (*word).to_owned()).collect::<Vec<String>>();
        let command = match random.below(20) {
            0..=3 => {
                let name = self.gearbox(&mut files, random);
                let mut command = words(&["check", &name]);
                if random.once_in(3) {
                    command.push("--resolved".to_owned());
                }
                command
            }
            4..=9 => {
                let name = self.gearbox(&mut files, random);
                let mut command = words(&["solve", &name]);
                let speeds = ["3000 rpm", "3000 rpm", "0 rpm", "-1e6 rpm", "1e-9 rpm", "input=100 rpm"];
                let torques = ["2 Nm", "2 Nm", "0 Nm", "-5 Nm", "1e9 Nm", "output=-3 Nm"];
                command.extend(words(&[
                    "--speed",
                    *random.one(&speeds),
                    "--torque",
                    *random.one(&torques),
                ]));
                if name == "car.yaml" {
                    command.extend(words(&["--gear", *random.one(&["first", "second", "neutral"])]));
                }
                for (option, value) in [
                    ("--models", "joint"),
                    ("--models", "nowhere"),
                    ("--power-flow", "ideal"),
                ] {
                    if random.once_in(8) && !command.iter().any(|word| word == option) {
                        command.extend(words(&[option, value]));
                    }
                }
                if random.once_in(2) {
                    command.extend(words(&["--format", "json"]));
                }
                command
            }
            10 | 11 => {
                let study = self.study(&mut files, random);
                files.insert("study.yaml".to_owned(), study);
                words(&["check", "study.yaml"])
            }
            12..=14 => {
                let study = self.study(&mut files, random);
                files.insert("study.yaml".to_owned(), study);
                words(&["run", "study.yaml", "-o", "results"])
            }
            15..=17 => {
                let (name, input) = random.one(&self.inputs);
                let mut input = input.clone();
                // What is not given is that of the usual point.
                if let Some(Tree::Map(at)) = input.at_mut(&[0]) {
                    at.retain(|_| random.once_in(2));
                }
                self.changed(&mut input, random);
                files.insert("input.yaml".to_owned(), input.text(random));
                words(&["eval", name, "--input", "input.yaml"])
            }
            18 => {
                for name in ["runs.csv", "run0/0/moment.dat"] {
                    let table = files.get_mut(name).unwrap();
                    for _ in 0..random.below(3) {
                        mutate::table(table, random);
                    }
                }
                words(&[
                    "import",
                    "openfoam-forces",
                    "runs.csv",
                    "--axis",
                    "z",
                    "--from",
                    "0.1 s",
                    "-o",
                    "made.csv",
                ])
            }
            _ => {
                let oil = ["--oil", "{ viscosity: { kv40: 27.3 mm2/s, kv100: 5.9 mm2/s } }"];
                let (name, law, more) = *random.one(&[
                    ("drag.csv", "power-law", [].as_slice()),
                    ("traction.csv", "traction", &oil),
                    ("stribeck.csv", "stribeck", &[]),
                ]);
                for _ in 0..=random.below(3) {
                    mutate::table(files.get_mut(name).unwrap(), random);
                }
                words(&[&["fit", law, name], more].concat())
            }
        };
        Case { files, command }
    }

    /// All gearboxes, one of them changed, or a table of it; says which.
    fn gearbox(&self, files: &mut BTreeMap<String, String>, random: &mut Random) -> String {
        // The electric drive unit takes longest.
        let which = *random.one(&[0, 0, 0, 1, 1, 3, 3, 3, 3, 2]);
        for (i, (name, tree)) in self.gearboxes.iter().enumerate() {
            let mut tree = tree.clone();
            if i == which {
                if random.once_in(8) {
                    tree.set(
                        "catalogues",
                        Tree::read("{ bearings: bearings.csv, lubricants: lubricants.csv }"),
                    );
                    for _ in 0..=random.below(3) {
                        let table = *random.one(&["bearings.csv", "lubricants.csv"]);
                        mutate::table(files.get_mut(table).unwrap(), random);
                    }
                } else if random.once_in(12) {
                    for table in ["drag.csv", "motor_map.csv"] {
                        mutate::table(files.get_mut(table).unwrap(), random);
                    }
                } else {
                    self.changed(&mut tree, random);
                }
            }
            let mut text = tree.text(random);
            if i == which && random.once_in(20) {
                mutate::text(&mut text, random);
            }
            files.insert((*name).to_owned(), text);
        }
        self.gearboxes[which].0.to_owned()
    }

    /// A study of one or two analyses; it, a table or a gearbox is changed.
    fn study(&self, files: &mut BTreeMap<String, String>, random: &mut Random) -> String {
        let mut study = self.study.clone();
        let Some(Tree::Map(all)) = study.get("analyses").cloned() else {
            unreachable!()
        };
        let some: Vec<(String, Tree)> = (0..=random.below(2)).map(|_| random.one(&all).clone()).collect();
        let used = |name: &str| {
            some.iter()
                .any(|(_, entry)| entry.get("gearbox") == Some(&Tree::Scalar(name.to_owned())))
        };
        // Those that are not used are left out, because all are read.
        let gearboxes: Vec<(String, Tree)> = ["car", "reducer", "unit"]
            .into_iter()
            .filter(|name| {
                *name == "car"
                    || used(name)
                    || some
                        .iter()
                        .any(|(_, entry)| entry.get("against").is_some() && *name == "reducer")
            })
            .map(|name| (name.to_owned(), Tree::Scalar(format!("{name}.yaml"))))
            .collect();
        study.set("gearboxes", Tree::Map(gearboxes));
        study.set("analyses", Tree::Map(some));
        match random.below(6) {
            0 => drop(self.gearbox(files, random)),
            1 => {
                for (name, tree) in &self.gearboxes {
                    files.insert((*name).to_owned(), tree.text(random));
                }
                let tables = [
                    "drive.csv",
                    "measured.csv",
                    "points.csv",
                    "rig.csv",
                    "seal.csv",
                    "warm.csv",
                    "bare.csv",
                ];
                for _ in 0..6 {
                    mutate::table(files.get_mut(*random.one(&tables)).unwrap(), random);
                }
            }
            _ => {
                for (name, tree) in &self.gearboxes {
                    files.insert((*name).to_owned(), tree.text(random));
                }
                // Mostly the analyses themselves.
                let whole = random.once_in(3);
                let mut part = if whole {
                    study.clone()
                } else {
                    study.get("analyses").cloned().unwrap_or(study.clone())
                };
                self.changed(&mut part, random);
                if whole {
                    study = part;
                } else {
                    study.set("analyses", part);
                }
            }
        }
        moderate(&mut study);
        study.text(random)
    }

    fn changed(&self, tree: &mut Tree, random: &mut Random) {
        // Mostly one change: what is wrong in several places is refused for the first.
        let most = if random.once_in(3) { 4 } else { 1 };
        for _ in 0..=random.below(most) {
            mutate::document(tree, &self.words, random);
        }
    }
}

/// Takes away amounts that are larger than those of the sound study.
fn moderate(study: &mut Tree) {
    for way in study.ways() {
        let key = study.key(&way).to_owned();
        if !AMOUNTS.contains(&key.as_str()) {
            continue;
        }
        let Some(Tree::Scalar(text)) = study.at_mut(&way) else {
            continue;
        };
        let end = text
            .find(|c: char| !(c.is_ascii_digit() || ".e".contains(c)))
            .unwrap_or(text.len());
        let Ok(x) = text[..end].parse::<f64>() else { continue };
        let is_small = key == "step" || key == "tolerance";
        if is_small && x > 0.0 && x < 0.1 {
            *text = format!("0.1{}", &text[end..]);
        } else if !is_small && x > 64.0 {
            *text = format!("64{}", &text[end..]);
        }
    }
}

/// One run of OpenFOAM, and what it leaves.
const RUNS: &str = "speed [rpm],nu [mm2/s],folder\n100,20,run0\n100,80,run0\n300,20,run0\n300,80,run0\n";
const MOMENTS: &str = "# Time total pressure viscous\n0.1 0 0 -0.01 0 0 -0.007 0 0 -0.003\n0.2 0 0 -0.012 0 0 -0.008 0 0 -0.004\n\
0.3 0 0 -0.011 0 0 -0.0075 0 0 -0.0035\n";
