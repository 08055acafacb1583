//! What measured sets say about models: the cells that `gearloss validate` computes from a corpus, as a crate ships them.

use serde_json::Value;

use super::Entry;
use super::cells::{JudgedCell, ShippedCells};
use crate::resolve::lookup;

/// A model at one measured set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComparedSet {
    /// Name of the set.
    pub set: &'static str,
    /// Kinds of the judged components, such as `tapered_roller`, joined by `+`; empty for components without kinds.
    pub part: &'static str,
    /// Whether constants of the model were derived from the set.
    pub seen: bool,
    /// Least and greatest calculated over measured loss, each the geometric mean over the points of the set: they differ for a model
    /// with several nested models. \[-\]
    pub ratio: [f64; 2],
    /// Whether some of its points are inside the ranges that the sources of the models state.
    pub in_range: bool,
}

/// A model against measured sets.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Compared {
    /// The measured sets, in the order of their names.
    pub sets: Vec<ComparedSet>,
}

impl Compared {
    /// The sets that count: those that the model has not seen.
    fn unseen(&self) -> impl Iterator<Item = &ComparedSet> {
        self.sets.iter().filter(|set| !set.seen)
    }

    /// Whether no measured set supports a statement about the model.
    pub fn is_empty(&self) -> bool {
        self.unseen().next().is_none()
    }

    /// The sets that judge it in a component of a kind: those of this kind, and those of components without kinds.
    pub fn of_kind(mut self, kind: Option<&str>) -> Self {
        self.sets
            .retain(|set| set.part.is_empty() || set.part.split('+').any(|part| Some(part) == kind));
        self
    }

    /// In words: `against 5 measured sets of tapered_roller: calculated over measured 0.73 to 1.7`; absent without a set.
    pub fn words(&self) -> Option<String> {
        let count = self.unseen().count();
        let least = self.unseen().map(|set| set.ratio[0]).fold(f64::INFINITY, f64::min);
        let greatest = self.unseen().map(|set| set.ratio[1]).fold(0.0, f64::max);
        let sets = if count == 1 { "set" } else { "sets" };
        let mut parts: Vec<&str> = self
            .unseen()
            .map(|set| set.part)
            .filter(|part| !part.is_empty())
            .collect();
        parts.sort_unstable();
        parts.dedup();
        let parts = if parts.is_empty() {
            String::new()
        } else {
            format!(" of {}", parts.join(", "))
        };
        let seen: Vec<&str> = self.sets.iter().filter(|set| set.seen).map(|set| set.set).collect();
        let apart = if seen.is_empty() {
            String::new()
        } else {
            format!("; derived from {}, which are judged apart", seen.join(", "))
        };
        (count > 0).then(|| {
            let [least, greatest] = [least, greatest].map(two_digits);
            let ratio = if least == greatest {
                least
            } else {
                format!("{least} to {greatest}")
            };
            let outside = if self.unseen().any(|set| set.in_range) {
                ""
            } else {
                ", everywhere outside a stated range"
            };
            format!("against {count} measured {sets}{parts}: calculated over measured {ratio}{outside}{apart}")
        })
    }
}

/// A ratio with two significant digits.
fn two_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.1e}").parse().unwrap_or(x);
    rounded.to_string()
}

impl Entry {
    /// What the linked cells say about the model, alone or nested in another.
    pub fn compared(&self) -> Compared {
        Compared::of(self.mechanism, self.name, ShippedCells::all())
    }

    /// The same in words, for a component of a kind or for any; absent for a model whose law the user states, and without loss.
    pub fn compared_in_words(&self, kind: Option<&str>) -> Option<String> {
        if self.is_user_defined() || self.name == "none" {
            return None;
        }
        let all = self.compared();
        let Some(kind) = kind else {
            let none = || "no measured set of the corpus judges this model".to_owned();
            return Some(all.words().unwrap_or_else(none));
        };
        let others = all.words();
        Some(all.of_kind(Some(kind)).words().unwrap_or_else(|| match others {
            Some(others) => format!("no measured set of the corpus judges this model for {kind}; {others}"),
            None => "no measured set of the corpus judges this model".to_owned(),
        }))
    }
}

/// The kind of a component of a resolved description, such as `tapered_roller` of `bearings.B1`.
pub fn kind_of(resolved: &Value, path: &str) -> Option<String> {
    let kind = lookup(resolved, path)?.get("kind")?.as_str()?;
    Some(kind.to_owned())
}

impl Compared {
    /// What tables of cells say about a model.
    fn of(mechanism: &str, name: &str, tables: impl Iterator<Item = &'static str>) -> Self {
        let own = format!("{mechanism}/{name}");
        let mut all = Self::default();
        // A table that a crate ships was written by the program: one that cannot be read says nothing.
        for cell in tables.flat_map(|csv| JudgedCell::read(csv).unwrap_or_default()) {
            // A drag has its slot behind a dot.
            let is_outer =
                cell.mechanism.split('.').next() == Some(mechanism) && cell.model.split('/').next() == Some(name);
            let is_nested = cell.nested.contains(&own.as_str());
            if !(is_outer || is_nested) || !cell.measured {
                continue;
            }
            let (set, ratio) = (cell.set, cell.ratio);
            match all.sets.iter_mut().find(|known| known.set == set) {
                Some(known) => {
                    known.ratio = [known.ratio[0].min(ratio), known.ratio[1].max(ratio)];
                    known.in_range |= cell.in_range > 0.0;
                }
                None => all.sets.push(ComparedSet {
                    set,
                    part: cell.part,
                    seen: cell.seen,
                    ratio: [ratio, ratio],
                    in_range: cell.in_range > 0.0,
                }),
            }
        }
        all.sets.sort_by_key(|set| set.set);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELLS: &str = "\
mechanism,model,nested,part,set,kind,seen,points,ratio,least,greatest,in_range,error,scatter
bearing,law,,tapered_roller,a,measured,no,3,0.734,0.5,1,1,,
bearing,law,,tapered_roller,b,measured,no,3,1.66,0.5,2,0.5,,
bearing,law,,tapered_roller,c,measured,yes,3,1.01,0.5,2,1,,
bearing,law,,tapered_roller,tool,calculated,no,3,9,0.5,10,1,,
gear_mesh,outer/inner,friction/inner,,d,measured,no,3,2.04,0.5,3,0,,
";

    fn compared(mechanism: &str, name: &str) -> Compared {
        Compared::of(mechanism, name, std::iter::once(CELLS))
    }

    fn words(mechanism: &str, name: &str) -> Option<String> {
        compared(mechanism, name).words()
    }

    #[test]
    fn sets_of_one_kind_say_nothing_about_another() {
        assert!(compared("bearing", "law").of_kind(Some("deep_groove_ball")).is_empty());
        assert!(!compared("bearing", "law").of_kind(Some("tapered_roller")).is_empty());
        assert!(!compared("gear_mesh", "outer").of_kind(None).is_empty());
    }

    #[test]
    fn measured_sets_count_those_that_were_seen_are_named_apart() {
        let said = "against 2 measured sets of tapered_roller: calculated over measured 0.73 to 1.7; derived from c, which are judged apart";
        assert_eq!(words("bearing", "law").as_deref(), Some(said));
    }

    #[test]
    fn a_nested_law_has_the_sets_of_its_outer_one() {
        let said = Some("against 1 measured set: calculated over measured 2, everywhere outside a stated range");
        assert_eq!(words("friction", "inner").as_deref(), said);
        assert_eq!(words("gear_mesh", "outer").as_deref(), said);
        assert_eq!(words("gear_mesh", "inner"), None);
    }
}
