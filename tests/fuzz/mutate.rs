//! Changes of documents and tables, most of which leave them readable, so that what stands behind the reading is reached, too.

use std::collections::BTreeMap;

use super::random::Random;
use super::tree::{Tree, Way};

/// What stands in sound documents: values by their keys.
pub struct Words {
    values: BTreeMap<String, Vec<Tree>>,
    keys: Vec<String>,
    scalars: Vec<String>,
}

/// Numbers at the ends of what can be written.
const NUMBERS: [&str; 30] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "0.5",
    "-0.5",
    "7",
    "12.5",
    "50",
    "100",
    "999",
    "1000",
    "5000",
    "65535",
    "65536",
    "100000",
    "1e6",
    "1e9",
    "-1e9",
    "1e12",
    "4294967296",
    "9007199254740993",
    "18446744073709551616",
    "1e-9",
    "1e-300",
    "1e300",
    "1e308",
    "1e400",
];

/// What is no number, or no plain one.
const ODD: [&str; 32] = [
    "",
    "none",
    "null",
    "true",
    "false",
    "~",
    ".inf",
    "nan",
    "1,5",
    "1_000",
    "0x10",
    "12:30",
    "1.2.3",
    "--1",
    "- 1",
    "1 2",
    "mm",
    "1 mm mm",
    "*",
    "a.b.c",
    "..",
    ".",
    "/dev/zero",
    "/dev/null",
    "gearbox.yaml",
    "study.yaml",
    "nowhere.csv",
    "é\u{fffd}\u{202e}",
    "<!--<script>",
    "=1+1",
    "con",
    "&a",
];

const UNITS: [&str; 24] = [
    "mm", "m", "um", "nm", "Nm", "N", "rpm", "1/s", "degC", "K", "mm2/s", "m2/s", "mPa s", "deg", "rad", "kg", "kg/m3",
    "W", "kW", "W/(m2 K)", "s", "%", "l", "1/K",
];

impl Words {
    pub fn from_documents(documents: &[Tree]) -> Self {
        let mut words = Self {
            values: BTreeMap::new(),
            keys: Vec::new(),
            scalars: Vec::new(),
        };
        for document in documents {
            words.learn(document);
        }
        words.keys = words.values.keys().cloned().collect();
        words.scalars.sort();
        words.scalars.dedup();
        words
    }

    fn learn(&mut self, tree: &Tree) {
        match tree {
            Tree::Scalar(text) => self.scalars.push(text.clone()),
            Tree::List(list) => list.iter().for_each(|tree| self.learn(tree)),
            Tree::Map(map) => {
                for (key, tree) in map {
                    let known = self.values.entry(key.clone()).or_default();
                    if !known.contains(tree) && tree.ways().len() < 60 {
                        known.push(tree.clone());
                    }
                    self.learn(tree);
                }
            }
        }
    }

    /// A value that stands somewhere under a key.
    fn value(&self, key: &str, random: &mut Random) -> Option<&Tree> {
        self.values
            .get(key)
            .filter(|known| !known.is_empty())
            .map(|known| random.one(known))
    }

    fn any(&self, random: &mut Random) -> (&str, &Tree) {
        loop {
            let key = random.one(&self.keys);
            if let Some(value) = self.value(key, random) {
                return (key, value);
            }
        }
    }
}

/// Changes a document in one place.
pub fn document(tree: &mut Tree, words: &Words, random: &mut Random) {
    let mut ways = tree.ways();
    // The whole is replaced seldom: nothing but its reading is tested then.
    if ways.len() > 1 && !random.once_in(200) {
        ways.remove(0);
    }
    let way = random.one(&ways).clone();
    match random.below(16) {
        0..=5 => scalars(tree, &way, words, random),
        6 | 7 => {
            // What another document has here.
            if let Some(value) = words.value(tree.key(&way), random).cloned() {
                replace(tree, &way, value);
            }
        }
        8 | 9 => insert(tree, &way, words, random),
        10 => remove(tree, &way),
        11 => rename(tree, &way, words, random),
        12 => {
            // Two parts change places.
            let other = random.one(&ways).clone();
            if let (Some(a), Some(b)) = (tree.subtree(&way).cloned(), tree.subtree(&other).cloned()) {
                replace(tree, &way, b);
                replace(tree, &other, a);
            }
        }
        13 => {
            // A part stands in a second place.
            let other = random.one(&ways).clone();
            if let Some(part) = tree.subtree(&way).filter(|part| part.ways().len() < 200).cloned() {
                replace(tree, &other, part);
            }
        }
        14 => grow(tree, &way, random),
        _ => {
            let (key, value) = words.any(random);
            let value = match random.below(4) {
                0 => Tree::List(vec![value.clone()]),
                1 => Tree::Map(vec![(key.to_owned(), value.clone())]),
                _ => value.clone(),
            };
            replace(tree, &way, value);
        }
    }
}

fn replace(tree: &mut Tree, way: &[usize], value: Tree) {
    if let Some(place) = tree.at_mut(way) {
        *place = value;
    }
}

/// Changes a scalar at the way, or somewhere below.
fn scalars(tree: &mut Tree, way: &[usize], words: &Words, random: &mut Random) {
    let Some(part) = tree.subtree(way) else { return };
    let below: Vec<Way> = part
        .ways()
        .into_iter()
        .filter(|way| matches!(part.subtree(way), Some(Tree::Scalar(_))))
        .collect();
    if below.is_empty() {
        return;
    }
    let way = [way, random.one(&below).as_slice()].concat();
    if let Some(Tree::Scalar(text)) = tree.at_mut(&way) {
        *text = changed(text, &words.scalars, random);
    }
}

/// A number with what follows it.
fn number(text: &str) -> Option<(f64, &str)> {
    let end = text
        .find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c)))
        .unwrap_or(text.len());
    Some((text[..end].parse().ok()?, &text[end..]))
}

/// Another scalar.
fn changed(text: &str, scalars: &[String], random: &mut Random) -> String {
    match (random.below(10), number(text)) {
        (0..=3, Some((x, unit))) => format!(
            "{}{unit}",
            x * random.one(&[0.01, 0.1, 0.5, 0.9, 1.0 + 1e-9, 1.1, 2.0, 10.0, 100.0, -1.0])
        ),
        (4 | 5, Some((_, unit))) => format!("{}{unit}", random.one(&NUMBERS)),
        (6, Some((x, _))) => format!("{x} {}", random.one(&UNITS)),
        (7, Some((_, unit))) => format!("{}{unit}", "9".repeat(1 + random.below(400))),
        (0..=4, None) => random.one(scalars).clone(),
        (5, _) => (*random.one(&NUMBERS)).to_owned(),
        (8, _) => typo(text, random),
        (9, _) if random.once_in(20) => "long ".repeat(1 + random.below(4000)),
        _ => (*random.one(&ODD)).to_owned(),
    }
}

/// A word with one letter wrong.
fn typo(text: &str, random: &mut Random) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    if letters.is_empty() {
        return "x".to_owned();
    }
    let place = random.below(letters.len());
    match random.below(4) {
        0 => drop(letters.remove(place)),
        1 => letters.insert(place, *random.one(&['e', '_', ' ', '1', '.', ':', '{'])),
        2 => letters[place] = 'x',
        _ => letters.swap(place, 0),
    }
    letters.into_iter().collect()
}

/// Adds a key and a value that some document has.
fn insert(tree: &mut Tree, way: &[usize], words: &Words, random: &mut Random) {
    let (key, value) = words.any(random);
    match tree.at_mut(way) {
        Some(Tree::Map(map)) => {
            let place = random.below(map.len() + 1);
            map.insert(place, (key.to_owned(), value.clone()));
        }
        Some(Tree::List(list)) => {
            let place = random.below(list.len() + 1);
            list.insert(place, value.clone());
        }
        _ => {}
    }
}

fn remove(tree: &mut Tree, way: &[usize]) {
    let Some((last, above)) = way.split_last() else { return };
    match tree.at_mut(above) {
        Some(Tree::Map(map)) => drop(map.remove(*last)),
        Some(Tree::List(list)) => drop(list.remove(*last)),
        _ => {}
    }
}

fn rename(tree: &mut Tree, way: &[usize], words: &Words, random: &mut Random) {
    let Some((last, above)) = way.split_last() else { return };
    if let Some(Tree::Map(map)) = tree.at_mut(above) {
        let key = &mut map[*last].0;
        *key = match random.below(4) {
            0 => random.one(&words.keys).clone(),
            1 => (*random.one(&ODD)).to_owned(),
            _ => typo(key, random),
        };
    }
}

/// Repeats what stands in a list or a map, under other ids.
fn grow(tree: &mut Tree, way: &[usize], random: &mut Random) {
    let most = if random.once_in(10) { 300 } else { 4 };
    let times = 1 + random.below(most);
    match tree.at_mut(way) {
        Some(Tree::Map(map)) if !map.is_empty() => {
            let (key, value) = random.one(map).clone();
            map.extend((0..times).map(|i| (format!("{key}{i}"), value.clone())));
        }
        Some(Tree::List(list)) if !list.is_empty() => {
            let value = random.one(list).clone();
            list.extend(std::iter::repeat_n(value, times));
        }
        Some(other) => {
            for _ in 0..times.min(60) {
                let inner = std::mem::replace(other, Tree::List(Vec::new()));
                *other = if random.once_in(2) {
                    Tree::List(vec![inner])
                } else {
                    Tree::Map(vec![("a".to_owned(), inner)])
                };
            }
        }
        None => {}
    }
}

/// Changes a text without regard to what it says.
pub fn text(text: &mut String, random: &mut Random) {
    let mut letters: Vec<char> = text.chars().collect();
    let start = random.below(letters.len() + 1);
    let end = (start + random.below(12)).min(letters.len());
    let piece = *random.one(&[
        "", "{", "]", ": ", "\n  ", "\t", "&a *a", "\"", "- ", "#", "\u{0}", "\u{feff}", "---\n", "? ", "| ", "!!x ",
    ]);
    letters.splice(start..end, piece.chars());
    *text = letters.into_iter().collect();
}

/// Changes a table in one place.
pub fn table(csv: &mut String, random: &mut Random) {
    let mut lines: Vec<Vec<String>> = csv
        .lines()
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect();
    if lines.is_empty() {
        return;
    }
    let line = random.below(lines.len());
    let column = random.below(lines[line].len());
    match random.below(12) {
        0..=4 => {
            let cells: Vec<String> = lines.iter().flatten().take(400).cloned().collect();
            lines[line][column] = changed(&lines[line][column], &cells, random);
        }
        5 => drop(lines.remove(line)),
        6 => {
            let again = lines[line].clone();
            lines.insert(random.below(lines.len()), again);
        }
        7 => {
            let other = random.below(lines.len());
            lines.swap(line, other);
        }
        8 => drop(lines[line].remove(column)),
        9 => {
            let cell = lines[line][column].clone();
            lines[line].insert(column, cell);
        }
        10 => {
            // A whole column.
            for cells in &mut lines {
                if let Some(cell) = cells.get_mut(column).filter(|cell| number(cell).is_some()) {
                    (*random.one(&NUMBERS)).clone_into(cell);
                }
            }
        }
        _ => {
            let start = random.below(lines.len());
            lines.truncate(start);
        }
    }
    let separator = if random.once_in(10) {
        *random.one(&[";", "\t", " "])
    } else {
        ","
    };
    *csv = lines.iter().map(|cells| cells.join(separator) + "\n").collect();
    if random.once_in(10) {
        text(csv, random);
    }
}
