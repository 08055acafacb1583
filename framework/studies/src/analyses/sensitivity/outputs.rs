//! Outputs: means over the points of a grid, and the relative change of the loss at single points.

use gearloss_framework::transmission::{PartInfo, Transmission};
use schemars::JsonSchema;
use serde::Serialize;

use super::super::common::shares::{Shares, together};
use super::super::common::trial::why;
use crate::numbers::{RPM, tidy};
use crate::points::PointResult;
use crate::study::By;

/// Kind of an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OutputKind {
    /// All losses.
    Loss,
    /// Losses of a mechanism.
    Mechanism,
    /// Losses of a named term of a mechanism.
    Term,
    /// Output power over input power.
    Efficiency,
    /// Losses of gearbox, machines and inverters.
    UnitLoss,
    /// Power at the other ports over the power of the DC link, while generating the reciprocal.
    SystemEfficiency,
    /// Root mean square over the points of the relative change of the loss at each point from the values of the gearbox: it shows
    /// parameters that shift losses between regions without changing the mean.
    RelativeLoss,
}

impl OutputKind {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Loss => "loss",
            Self::Mechanism => "mechanism",
            Self::Term => "term",
            Self::Efficiency => "efficiency",
            Self::UnitLoss => "unit_loss",
            Self::SystemEfficiency => "system_efficiency",
            Self::RelativeLoss => "relative_loss",
        }
    }
}

/// One output.
pub struct Output {
    pub kind: OutputKind,
    /// `loss`, a mechanism, a mechanism and its term, `efficiency`, or `relative_loss`.
    pub name: String,
    /// Whether a term is load-dependent; absent for other outputs, and if models of a mechanism differ in it.
    pub load_dependent: Option<bool>,
}

impl Output {
    /// Unit in results.
    pub fn unit(&self) -> &'static str {
        match self.kind {
            OutputKind::Efficiency | OutputKind::SystemEfficiency | OutputKind::RelativeLoss => "-",
            OutputKind::Loss | OutputKind::UnitLoss | OutputKind::Mechanism | OutputKind::Term => "w",
        }
    }
}

/// All outputs in the order of their values: the loss, mechanisms, terms, the efficiency if a point has one, and the relative change of the
/// loss over the points if requested.
pub struct Outputs {
    pub list: Vec<Output>,
    /// By mechanism and by term; common to all transmissions that differ in numbers.
    shares: [Shares; 2],
    /// Points with an efficiency at the values of the gearbox: all means are taken over these points.
    efficient: Vec<usize>,
    /// True if all points have a drive unit.
    has_unit: bool,
    /// Points with an efficiency of the drive unit at the values of the gearbox.
    system: Vec<usize>,
    /// Losses at the values of the gearbox, of points with a loss; empty if the relative change is not requested.
    nominal: Vec<(usize, f64)>,
}

impl Outputs {
    /// With the points at the values of the gearbox; `relative` requests the relative change of the loss over the points, which has no
    /// slope there.
    pub fn new(t: &Transmission, nominal: &[PointResult], relative: bool) -> Self {
        let [mechanisms, terms] = [By::Mechanism, By::Term].map(|by| together(std::iter::once(t), by));
        let has = |(i, p): (usize, &PointResult)| p.efficiency.map(|_| i);
        let efficient: Vec<usize> = nominal.iter().enumerate().filter_map(has).collect();
        let output = |kind: OutputKind, name: &str| Output {
            kind,
            name: name.to_owned(),
            load_dependent: (kind == OutputKind::Term).then(|| load_dependent(t, name)).flatten(),
        };
        let mut list = vec![output(OutputKind::Loss, "loss")];
        list.extend(mechanisms.iter().map(|name| output(OutputKind::Mechanism, name)));
        list.extend(terms.iter().map(|name| output(OutputKind::Term, name)));
        let shares = [(By::Mechanism, &mechanisms), (By::Term, &terms)];
        if !efficient.is_empty() {
            list.push(output(OutputKind::Efficiency, "efficiency"));
        }
        let has_unit = !nominal.is_empty() && nominal.iter().all(|p| p.unit().is_some());
        let passes = |(i, p): (usize, &PointResult)| p.unit()?.system_efficiency.map(|_| i);
        let system: Vec<usize> = nominal.iter().enumerate().filter_map(passes).collect();
        if has_unit {
            list.push(output(OutputKind::UnitLoss, "unit_loss"));
        }
        if !system.is_empty() {
            list.push(output(OutputKind::SystemEfficiency, "system_efficiency"));
        }
        let loses = |(i, p): (usize, &PointResult)| p.loss.filter(|loss| *loss > 0.0).map(|loss| (i, loss));
        let nominal: Vec<(usize, f64)> = if relative {
            nominal.iter().enumerate().filter_map(loses).collect()
        } else {
            Vec::new()
        };
        if !nominal.is_empty() {
            list.push(output(OutputKind::RelativeLoss, "relative_loss"));
        }
        Self {
            list,
            shares: shares.map(|(by, names)| Shares::new(t, by).under(names)),
            efficient,
            has_unit,
            system,
            nominal,
        }
    }

    /// Maximum number of outputs of a transmission.
    pub fn most(t: &Transmission) -> usize {
        let names = [By::Mechanism, By::Term].map(|by| together(std::iter::once(t), by).len());
        5 + names.iter().sum::<usize>()
    }

    /// Values of the outputs at solved points.
    ///
    /// # Errors
    /// The first point without a loss, or without an efficiency that it should have.
    pub fn values(&self, t: &Transmission, points: &[PointResult]) -> Result<Vec<f64>, String> {
        let all = points
            .iter()
            .map(|p| p.loss.ok_or_else(|| format!("no loss at {}: {}", place(p), why(t, p))));
        let all: Vec<f64> = all.collect::<Result<_, _>>()?;
        let count = points.len().max(1) as f64;
        let mut values = vec![all.iter().sum::<f64>() / count];
        for shares in &self.shares {
            let mut sums = vec![0.0; shares.names.len()];
            for point in points {
                for (sum, watts) in sums.iter_mut().zip(shares.stack(point).unwrap_or_default()) {
                    *sum += watts;
                }
            }
            values.extend(sums.into_iter().map(|sum| sum / count));
        }
        if !self.efficient.is_empty() {
            let of = |i: &usize| {
                let point = &points[*i];
                let none = || format!("no efficiency at {}", place(point));
                point.efficiency.ok_or_else(none)
            };
            let list: Vec<f64> = self.efficient.iter().map(of).collect::<Result<_, _>>()?;
            values.push(list.iter().sum::<f64>() / list.len() as f64);
        }
        if self.has_unit {
            let none = |p: &PointResult| format!("no loss of the drive unit at {}", place(p));
            let all = points
                .iter()
                .map(|p| p.unit().map(|unit| unit.unit_loss_w).ok_or_else(|| none(p)));
            values.push(all.sum::<Result<f64, String>>()? / count);
        }
        if !self.system.is_empty() {
            let of = |i: &usize| {
                let point = &points[*i];
                let none = || format!("no efficiency of the drive unit at {}", place(point));
                point.unit().and_then(|unit| unit.system_efficiency).ok_or_else(none)
            };
            let sum = self.system.iter().map(of).sum::<Result<f64, String>>()?;
            values.push(sum / self.system.len() as f64);
        }
        if !self.nominal.is_empty() {
            let square = |(i, loss): &(usize, f64)| (all[*i] / loss - 1.0).powi(2);
            let mean = self.nominal.iter().map(square).sum::<f64>() / self.nominal.len() as f64;
            values.push(mean.sqrt());
        }
        if values.iter().all(|x| x.is_finite()) {
            Ok(values)
        } else {
            Err("a loss is too large".to_owned())
        }
    }
}

/// Whether the terms of a name are load-dependent; absent if models differ.
fn load_dependent(t: &Transmission, name: &str) -> Option<bool> {
    let of = |part: &PartInfo| {
        let terms = t.instances()[part.notes.instance()].entry.terms;
        let terms_of_part = terms
            .iter()
            .find(|term| format!("{} {}", part.mechanism, term.name) == name);
        terms_of_part.map(|term| term.load_dependent)
    };
    let mut all = t.parts().iter().filter_map(of);
    let first = all.next()?;
    all.all(|other| other == first).then_some(first)
}

fn place(p: &PointResult) -> String {
    format!("{} Nm, {:.0} rpm", tidy(p.torque), p.speed * RPM)
}
