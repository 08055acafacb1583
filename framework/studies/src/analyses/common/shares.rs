//! Losses of a point summed by mechanism, component, stage, term or the usual sums.

use crate::distinct::distinct;
use crate::points::{PointResult, SUMS};
use crate::study::By;
use gearloss_framework::transmission::{PartInfo, PartKind, Transmission};

/// Names of the shares of a transmission, and the share of every component.
pub struct Shares {
    by: By,
    /// The names, in the order of the document.
    pub names: Vec<String>,
    /// Index of the share of each component, or of each of its terms.
    places: Vec<Vec<usize>>,
}

impl Shares {
    /// The shares of one transmission.
    pub fn new(t: &Transmission, by: By) -> Self {
        let mut names: Vec<String> = Vec::new();
        if by == By::Unit {
            names.extend(["gearbox", "machines", "inverters"].map(str::to_owned));
            return Self {
                by,
                names,
                places: Vec::new(),
            };
        }
        if by == By::Sum {
            names.extend(SUMS.iter().map(|(name, _)| (*name).to_owned()));
            return Self {
                by,
                names,
                places: Vec::new(),
            };
        }
        let mut place = |name: String| {
            names.iter().position(|n| *n == name).unwrap_or_else(|| {
                names.push(name);
                names.len() - 1
            })
        };
        let places = t
            .parts()
            .iter()
            .map(|part| match by {
                By::Term => {
                    let entry = &t.instances()[part.notes.instance()].entry;
                    let terms = entry.terms.iter();
                    terms
                        .map(|term| place(format!("{} {}", part.mechanism, term.name)))
                        .collect()
                }
                _ => vec![place(name_of(t, part, by))],
            })
            .collect();
        Self { by, names, places }
    }

    /// The same with the combined names of several transmissions.
    pub fn under(mut self, names: &[String]) -> Self {
        let place = |name: &String| names.iter().position(|n| n == name).unwrap_or(0);
        let moved: Vec<usize> = self.names.iter().map(place).collect();
        for place in self.places.iter_mut().flatten() {
            *place = moved[*place];
        }
        self.names = names.to_vec();
        self
    }

    /// Sums of values of all components, by share; for shares without terms.
    pub fn sums(&self, parts: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.names.len()];
        for (places, value) in self.places.iter().zip(parts) {
            if let Some(place) = places.first() {
                sums[*place] += value;
            }
        }
        sums
    }

    /// The shares of a point in W; absent if its loss is absent. Shares by term need a point with terms.
    pub fn stack(&self, point: &PointResult) -> Option<Vec<f64>> {
        point.loss?;
        let mut stack = vec![0.0; self.names.len()];
        match self.by {
            By::Sum => stack.copy_from_slice(&point.sums),
            By::Unit => {
                let unit = point.unit()?;
                stack = vec![point.loss?, unit.machine_loss_w, unit.inverter_loss_w];
            }
            By::Term => {
                for (places, terms) in self.places.iter().zip(&point.terms) {
                    for (place, watts) in places.iter().zip(terms) {
                        stack[*place] += watts;
                    }
                }
            }
            By::Mechanism | By::Component | By::Stage => {
                stack = self.sums(&point.parts);
            }
        }
        Some(stack)
    }
}

/// Combined names of several transmissions, in the order of the first, without shares that have no loss under any model.
pub fn together<'a>(all: impl Iterator<Item = &'a Transmission> + Clone, by: By) -> Vec<String> {
    let mut names: Vec<String> = distinct(all.clone().flat_map(|t| Shares::new(t, by).names));
    // Shares with `none` everywhere are omitted.
    if !matches!(by, By::Sum | By::Unit) {
        names.retain(|name| {
            all.clone().any(|t| {
                let shares = Shares::new(t, by);
                t.parts().iter().zip(&shares.places).any(|(part, places)| {
                    let entry = &t.instances()[part.notes.instance()].entry;
                    entry.name != "none" && places.iter().any(|p| shares.names[*p] == *name)
                })
            })
        });
    }
    names
}

/// Name of the share of a component.
fn name_of(t: &Transmission, part: &PartInfo, by: By) -> String {
    let component = part.path.split(".drag.").next().unwrap_or(&part.path);
    match by {
        By::Component => component.to_owned(),
        By::Stage => stage(t, part, component),
        _ => part.mechanism.to_owned(),
    }
}

/// A mesh with the drags of its gears, a planetary set, or the shaft of a component.
fn stage(t: &Transmission, part: &PartInfo, component: &str) -> String {
    if let Some(gear) = component.strip_prefix("gears.") {
        return t.mesh_of_gear(gear).unwrap_or(component).to_owned();
    }
    match part.kind {
        PartKind::Component(i) if !component.starts_with("planetary_sets.") => t
            .member_of_component(i)
            .map_or_else(|| component.to_owned(), |member| format!("shafts.{member}")),
        _ => component.to_owned(),
    }
}
