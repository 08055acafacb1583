//! Paths whose values are chosen together.

use serde_json::Value;

/// One path or several, and the values that each choice gives them.
#[derive(Debug, Clone, PartialEq)]
pub struct Together {
    /// Resolved paths.
    pub paths: Vec<String>,
    /// The choices: a value for each path.
    pub rows: Vec<Vec<Value>>,
}

/// Where below the entry something is wrong, what, and how to correct it.
pub type Wrong = (String, String, String);

impl Together {
    /// Of the keys `path`, `paths` and `values` of an entry.
    ///
    /// # Errors
    /// Unless there is either one path, or several with as many values in each choice.
    pub fn new(path: Option<&str>, paths: &[String], values: &[Value]) -> Result<Self, Wrong> {
        let wrong = |key: &str, message: &str, help: &str| Err((key.to_owned(), message.to_owned(), help.to_owned()));
        match (path, paths) {
            (Some(path), []) => Ok(Self {
                paths: vec![path.to_owned()],
                rows: values.iter().map(|value| vec![value.clone()]).collect(),
            }),
            (None, []) => wrong(
                "",
                "no path is stated",
                "add `path`, or several `paths` that move together",
            ),
            (Some(_), _) => wrong("", "both `path` and `paths` are stated", "delete one of them"),
            (None, [_]) => wrong(
                ".paths",
                "there is only one path",
                "write `path` for it, or add the others",
            ),
            (None, paths) => {
                if let Some(i) = (1..paths.len()).find(|i| paths[..*i].contains(&paths[*i])) {
                    return wrong(&format!(".paths.{i}"), "this path is already in the list", "delete it");
                }
                let row = |(i, value): (usize, &Value)| match value.as_array() {
                    Some(row) if row.len() == paths.len() => Ok(row.clone()),
                    _ => {
                        let message = format!("a list of {} values is needed, one for each path", paths.len());
                        let help = "write for example `values: [[24, 83], [30, 77]]`".to_owned();
                        Err((format!(".values.{i}"), message, help))
                    }
                };
                Ok(Self {
                    paths: paths.to_vec(),
                    rows: values.iter().enumerate().map(row).collect::<Result<_, _>>()?,
                })
            }
        }
    }

    /// The paths as text.
    pub fn words(&self) -> String {
        self.paths.join(", ")
    }

    /// The choice that a description has already, if `has` says whether a path has a value there.
    pub fn described(&self, has: impl Fn(&str, &Value) -> bool) -> Option<usize> {
        let is_described = |row: &Vec<Value>| self.paths.iter().zip(row).all(|(path, value)| has(path, value));
        self.rows.iter().position(is_described)
    }

    /// Overrides of a choice.
    pub fn overrides(&self, choice: usize) -> Vec<(String, Value)> {
        self.paths
            .iter()
            .cloned()
            .zip(self.rows[choice].iter().cloned())
            .collect()
    }
}

/// Words of values that belong together.
pub fn joined(words: impl Iterator<Item = String>) -> String {
    words.collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::resolve::lookup;
    use serde_json::json;

    use super::*;

    #[test]
    fn a_choice_has_a_value_for_each_path() {
        let paths = ["gears.P2.z", "gears.W2.z"].map(str::to_owned);
        let pairs = [json!([24, 83]), json!([30, 77])];
        let both = Together::new(None, &paths, &pairs).unwrap();
        assert_eq!(both.words(), "gears.P2.z, gears.W2.z");
        assert_eq!(
            both.overrides(1),
            [(paths[0].clone(), json!(30)), (paths[1].clone(), json!(77))]
        );
        let described = json!({ "gears": { "P2": { "z": 24 }, "W2": { "z": 83 } } });
        assert_eq!(
            both.described(|path, value| lookup(&described, path) == Some(value)),
            Some(0)
        );
        let one = Together::new(Some("gears.P2.z"), &[], &[json!(24)]).unwrap();
        assert_eq!(one.overrides(0), [(paths[0].clone(), json!(24))]);
        assert_eq!(
            one.described(|path, value| lookup(&described, path) == Some(value)),
            Some(0)
        );
    }

    #[test]
    fn every_contradiction_is_placed() {
        let paths = ["a", "b"].map(str::to_owned);
        let place = |path, paths: &[String], values: &[Value]| Together::new(path, paths, values).unwrap_err().0;
        assert_eq!(place(None, &[], &[]), "");
        assert_eq!(place(Some("a"), &paths, &[]), "");
        assert_eq!(place(None, &paths[..1], &[]), ".paths");
        assert_eq!(place(None, &[paths[0].clone(), paths[0].clone()], &[]), ".paths.1");
        assert_eq!(place(None, &paths, &[json!([1, 2]), json!([1])]), ".values.1");
    }
}
