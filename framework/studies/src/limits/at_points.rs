//! Limited quantities at solved points.

use gearloss_framework::description::Ordered;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{ComponentRating, Point, Ratings, Solution};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::rating::Figure;
use gearloss_framework::resolve::Resolved;
use gearloss_framework::thermal::network::Network;
use gearloss_framework::transmission::Transmission;

use super::reached::{Place, Reached};
use super::{Limit, Owner, Scope, words};
use crate::numbers::{RPM, tidy};
use crate::points::{Numbered, PointResult, Points};
use crate::study::{LimitEntry, LimitedQuantity, Study};

/// The limits of the study that apply to points, for one gearbox with its models.
pub struct Watch {
    limits: Vec<Limit>,
    /// Ratings of the limited components; absent if no rating is limited.
    ratings: Option<Ratings>,
}

impl Watch {
    /// For a gearbox; `None` if the study limits nothing at points.
    ///
    /// # Errors
    /// Wrong limits, and ratings that cannot be built.
    pub fn new(scope: Scope<'_>, gearbox: &Gearbox, resolved: &Resolved) -> Result<Option<Self>, Findings> {
        let mut limits = Limit::of_study(scope)?;
        limits.retain(|limit| !limit.quantity.is_of_cycles());
        if limits.is_empty() {
            return Ok(None);
        }
        let ratings = ratings(scope, &limits, gearbox, resolved)?;
        Ok(Some(Self { limits, ratings }))
    }

    /// The limits.
    pub fn limits(&self) -> &[Limit] {
        &self.limits
    }

    /// Adds the limited quantities to solved points, and gives what each limit reaches.
    ///
    /// # Errors
    /// If the points do not fit.
    pub fn mark(
        &self,
        t: &Transmission,
        points: &Points,
        solved: &mut Numbered<'_>,
    ) -> Result<Vec<Reached>, Vec<Diagnostic>> {
        let case = points.case(t)?;
        let mut scratch = t.scratch(&case);
        let mut reached = vec![Reached::default(); self.limits.len()];
        let (mut speeds, mut torques) = (vec![0.0; case.speed_ports.len()], vec![0.0; case.torque_ports.len()]);
        for (_, point) in solved {
            let Some(oil) = point.oil.filter(|_| point.status.has_flow()) else {
                point.limits = vec![f64::NAN; self.limits.len()];
                continue;
            };
            let rated = match &self.ratings {
                None => Vec::new(),
                Some(ratings) => {
                    speeds.iter_mut().take(1).for_each(|speed| *speed = point.speed);
                    torques.iter_mut().take(1).for_each(|torque| *torque = point.torque);
                    let prescribed = Point {
                        speeds: &speeds,
                        torques: &torques,
                        flow: points.flow,
                        ..Point::default()
                    };
                    let alone = [oil];
                    let temperatures = if point.nodes.is_empty() {
                        &alone[..]
                    } else {
                        &point.nodes
                    };
                    let solution: Solution<'_> = t.evaluate(&case, &prescribed, temperatures, &mut scratch);
                    ratings.at(&solution)
                }
            };
            let values: Vec<f64> = (self.limits.iter().zip(&mut reached))
                .map(|(limit, reached)| {
                    let (value, part) = limit.at_point(t, point, &rated);
                    let place = || Place {
                        component: part.map(|part| t.parts()[part].path.clone()),
                        cycle: None,
                        gear: Some(points.gear.clone()),
                        torque_nm: Some(point.torque),
                        speed_rpm: Some(tidy(point.speed * RPM)),
                        oil_temperature_degc: Some(oil),
                    };
                    reached.note(limit, value, place);
                    value
                })
                .collect();
            point.beyond = self.limits.iter().zip(&values).any(|(limit, value)| {
                // An unknown value is reported by its absence.
                value.is_finite() && limit.violation(*value) > 0.0
            });
            point.limits = values;
        }
        Ok(reached)
    }
}

/// A limited quantity as a column.
#[derive(Debug, Clone)]
pub struct LimitColumn {
    /// Name of the limit in the study.
    pub name: String,
    /// What is limited.
    pub words: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// Whether it is the temperature of the oil.
    pub is_of_oil: bool,
}

impl LimitColumn {
    /// The limits of a study at points, in the order of [`PointResult::limits`].
    pub fn all(language: &Language, study: &Study) -> Vec<Self> {
        let entries = study.entry.limits.iter();
        let at_points = entries.filter(|(_, entry)| !entry.quantity.is_of_cycles());
        let column = |(name, entry): (&str, &LimitEntry)| {
            let figure = figure_of(language, entry);
            Self {
                name: name.to_owned(),
                words: words(entry, figure),
                unit: figure.map_or(entry.quantity.unit(), |figure| figure.unit),
                is_of_oil: entry.is_of_oil(),
            }
        };
        at_points.map(column).collect()
    }

    /// Name of the column of a table.
    pub fn key(&self) -> String {
        let unit = self.unit.replace('/', "_").to_lowercase();
        match self.unit {
            "-" => format!("limit_{}", self.name),
            _ => format!("limit_{}_{unit}", self.name),
        }
    }

    /// Values by the names of the limits.
    pub fn by_name(columns: &[Self], values: &[f64]) -> Ordered<Option<f64>> {
        let pairs = columns.iter().zip(values);
        let known = |value: &f64| Some(*value).filter(|value| value.is_finite());
        Ordered(
            pairs
                .map(|(column, value)| (column.name.clone(), known(value)))
                .collect(),
        )
    }
}

/// The quantity of a rating that an entry names.
fn figure_of(language: &Language, entry: &LimitEntry) -> Option<Figure> {
    let (rating, symbol) = entry.rating.as_ref()?.split_once('.')?;
    let plugin = language.registry().rating_named(rating).ok()?;
    plugin.figures.iter().find(|figure| figure.symbol == symbol).copied()
}

/// The ratings that are limited; `None` if none are.
///
/// # Errors
/// Ratings that cannot be built.
pub fn ratings(
    scope: Scope<'_>,
    limits: &[Limit],
    gearbox: &Gearbox,
    resolved: &Resolved,
) -> Result<Option<Ratings>, Findings> {
    if !limits.iter().any(Limit::is_rating) {
        return Ok(None);
    }
    let mut ratings = gearbox.ratings(scope.language, resolved, scope.transmission)?;
    keep_limited(&mut ratings, limits, scope.transmission);
    Ok(Some(ratings))
}

/// Drops ratings that are not limited.
pub fn keep_limited(ratings: &mut Ratings, limits: &[Limit], t: &Transmission) {
    ratings.retain(|rating, part| limits.iter().any(|limit| limit.rates(rating, &t.parts()[part].path)));
}

impl Limit {
    /// The limited value at a solved point, and the component of a rating; NaN where it is unknown.
    fn at_point(&self, t: &Transmission, point: &PointResult, rated: &[ComponentRating]) -> (f64, Option<usize>) {
        let value = match &self.of {
            Owner::Oil => {
                let node = t.network().map(Network::oil);
                node.and_then(|node| point.nodes.get(node).copied()).or(point.oil)
            }
            Owner::Node(name) => {
                let names = t.network().map_or(&[][..], Network::names);
                let node = names.iter().position(|known| known == name);
                node.map_or(point.oil, |node| point.nodes.get(node).copied())
            }
            Owner::Gear(gear) => t.ratios(*gear).first().and_then(|(_, ratio)| *ratio).map(f64::abs),
            Owner::Gearbox if self.quantity == LimitedQuantity::Efficiency => point.efficiency,
            Owner::Gearbox => point.loss,
            Owner::Unit => point.unit().and_then(|unit| match self.quantity {
                LimitedQuantity::DcPower => Some(unit.dc_power_w),
                LimitedQuantity::MachineLoss => Some(unit.machine_loss_w + unit.inverter_loss_w),
                LimitedQuantity::UnitLoss => Some(unit.unit_loss_w),
                _ => unit.system_efficiency,
            }),
            Owner::Cycle(_) | Owner::AllCycles | Owner::OtherCycle => None,
            Owner::Rating { rating, symbol, .. } => {
                let ratings = rated.iter().filter(|rated| rated.plugin.entry.name == *rating);
                let ratings = ratings.filter(|rated| self.rates(rating, &t.parts()[rated.part].path));
                let values = ratings.flat_map(|rating| {
                    let figures = rating.result.as_ref().map_or(&[][..], |rated| rated.figures());
                    let figures = figures.iter().filter(|figure| figure.figure.symbol == *symbol);
                    figures.map(|figure| (figure.value, rating.part))
                });
                let worst = values.min_by(|a, b| self.margin(a.0).total_cmp(&self.margin(b.0)));
                return worst.map_or((f64::NAN, None), |(value, part)| (value, Some(part)));
            }
        };
        (value.unwrap_or(f64::NAN), None)
    }
}
