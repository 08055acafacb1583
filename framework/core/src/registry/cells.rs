//! Tables of cells: every model at every set of a corpus, as `gearloss validate` writes them.

use super::Origin;

/// Cells of a corpus that a crate ships.
#[derive(Debug, Clone, Copy)]
pub struct ShippedCells {
    /// CSV text as `gearloss validate` writes it, see [`JudgedCell`].
    pub csv: &'static str,
    /// Where they are registered.
    pub origin: Origin,
}

inventory::collect!(ShippedCells);

impl ShippedCells {
    /// The tables of all linked crates.
    pub fn all() -> impl Iterator<Item = &'static str> {
        inventory::iter::<Self>.into_iter().map(|cells| cells.csv)
    }
}

/// A model at a set: a line of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedCell<'a> {
    /// Mechanism; a drag has its slot behind a dot.
    pub mechanism: &'a str,
    /// Model with its nested models, joined by `/`.
    pub model: &'a str,
    /// The nested models, each as `mechanism/model`.
    pub nested: Vec<&'a str>,
    /// Kinds of the judged components, joined by `+`; empty for components without kinds.
    pub part: &'a str,
    /// Name of the set.
    pub set: &'a str,
    /// Whether the set was measured.
    pub measured: bool,
    /// Whether constants of the model were derived from the set.
    pub seen: bool,
    /// Geometric mean of calculated over measured loss over the points. \[-\]
    pub ratio: f64,
    /// Least and greatest ratio of a point. \[-\]
    pub ends: [f64; 2],
    /// Share of the points at which all models are inside their stated ranges. \[-\]
    pub in_range: f64,
    /// Standard deviation of the logarithm of the ratio from what the set does not state; zero if it states everything. \[-\]
    pub error: f64,
    /// Standard deviation of the logarithms of the ratios of the points; absent for a single point. \[-\]
    pub scatter: Option<f64>,
}

impl<'a> JudgedCell<'a> {
    /// The lines of a table.
    ///
    /// # Errors
    /// A column that is missing, or a cell that is not a positive number, with its line.
    pub fn read(csv: &'a str) -> Result<Vec<Self>, String> {
        let mut lines = csv.lines();
        let head: Vec<&str> = lines.next().unwrap_or_default().split(',').map(str::trim).collect();
        let place = |name: &str| {
            let found = head.iter().position(|column| *column == name);
            found.ok_or_else(|| format!("line 1: there is no column `{name}`"))
        };
        let texts = ["mechanism", "model", "nested", "part", "set", "kind", "seen"].map(place);
        let [mechanism, model, nested, part, set, kind, seen] = all(texts)?;
        let numbers = ["ratio", "least", "greatest", "in_range", "error", "scatter"].map(place);
        let [ratio, least, greatest, in_range, error, scatter] = all(numbers)?;
        let cell = |(i, line): (usize, &'a str)| {
            let cells: Vec<&str> = line.split(',').map(str::trim).collect();
            let text = |place: usize| cells.get(place).copied().unwrap_or_default();
            let number = |place: usize| {
                let written = text(place);
                let number: Option<f64> = written.parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0);
                number.ok_or_else(|| format!("line {}: `{written}` is no `{}`", i + 2, head[place]))
            };
            let positive = |place: usize| {
                let number = number(place)?;
                if number > 0.0 {
                    return Ok(number);
                }
                Err(format!("line {}: `{}` must be positive", i + 2, head[place]))
            };
            let optional = |place: usize| {
                if text(place).is_empty() {
                    return Ok(None);
                }
                number(place).map(Some)
            };
            Ok(Self {
                mechanism: text(mechanism),
                model: text(model),
                nested: text(nested).split('+').filter(|name| !name.is_empty()).collect(),
                part: text(part),
                set: text(set),
                measured: text(kind) == "measured",
                seen: text(seen) == "yes",
                ratio: positive(ratio)?,
                ends: [positive(least)?, positive(greatest)?],
                in_range: number(in_range)?,
                error: optional(error)?.unwrap_or(0.0),
                scatter: optional(scatter)?,
            })
        };
        lines
            .enumerate()
            .filter(|(_, line)| !line.trim().is_empty())
            .map(cell)
            .collect()
    }

    /// Whether it judges components of a kind: those of this kind, and components without kinds judge any.
    pub fn is_of_kind(&self, kind: Option<&str>) -> bool {
        self.part.is_empty() || self.part.split('+').any(|part| Some(part) == kind)
    }
}

/// The values, or the first error.
fn all<const N: usize>(results: [Result<usize, String>; N]) -> Result<[usize; N], String> {
    let mut values = [0; N];
    for (value, result) in values.iter_mut().zip(results) {
        *value = result?;
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const HEAD: &str = "mechanism,model,nested,part,set,kind,seen,points,ratio,least,greatest,in_range,error,scatter";

    #[test]
    fn a_table_is_read_by_its_names() {
        let csv = format!(
            "{HEAD}\ngear_mesh,outer/inner,friction/inner,,rig,measured,no,3,1.2,1,1.5,1,0.05,0.2\nbearing,law,,ball+roller,tool,calculated,yes,1,0.9,0.9,0.9,0.5,,\n"
        );
        let cells = JudgedCell::read(&csv).unwrap();
        assert_eq!(
            (cells[0].nested.as_slice(), cells[0].scatter, cells[0].error),
            (&["friction/inner"][..], Some(0.2), 0.05)
        );
        assert!(cells[0].measured && !cells[0].seen && cells[0].is_of_kind(Some("any")));
        assert_eq!((cells[1].scatter, cells[1].error, cells[1].seen), (None, 0.0, true));
        assert!(
            cells[1].is_of_kind(Some("roller")) && !cells[1].is_of_kind(Some("needle")) && !cells[1].is_of_kind(None)
        );
    }

    #[test]
    fn a_faulty_table_names_its_line() {
        let fault = |csv: &str| JudgedCell::read(csv).unwrap_err();
        assert_eq!(fault("mechanism,model\n"), "line 1: there is no column `nested`");
        let with = |ratio: &str| format!("{HEAD}\nbearing,law,,,rig,measured,no,3,{ratio},1,1.5,1,,\n");
        assert_eq!(fault(&with("x")), "line 2: `x` is no `ratio`");
        assert_eq!(fault(&with("0")), "line 2: `ratio` must be positive");
        assert_eq!(fault(&with("NaN")), "line 2: `NaN` is no `ratio`");
    }
}
