//! Conductances of the links.

use gearloss_fmu::network as fmu;
use gearloss_fmu::table::{Axis, Table};
use gearloss_framework::thermal::network::LinkState;

use super::losses::Tabulated;
use super::ranges::{SINGLE, short, spaced, temperature_axis};

impl Tabulated<'_> {
    /// Conductances of the links, over what they depend on.
    pub fn links(&self) -> Result<Vec<fmu::Link>, String> {
        let links: Vec<(String, [usize; 2])> = self
            .network
            .links()
            .map(|(path, ends)| (path.to_owned(), ends))
            .collect();
        let of = |(i, (path, ends)): (usize, &(String, [usize; 2]))| {
            let conductance = self.conductance(i, *ends).map_err(|what| format!("{path}: {what}"))?;
            Ok(fmu::Link {
                between: ends.map(|node| node as u32),
                conductance,
            })
        };
        links.iter().enumerate().map(of).collect()
    }

    fn conductance(&self, link: usize, ends: [usize; 2]) -> Result<fmu::Conductance, String> {
        let temperatures = spaced(self.ranges.temperatures, SINGLE);
        let axes = [
            temperature_axis(ends[0], temperatures.clone()),
            temperature_axis(ends[1], temperatures),
            Axis {
                quantity: fmu::SPEED,
                points: self.ranges.speeds.clone(),
            },
            Axis {
                quantity: fmu::VEHICLE,
                points: self.ranges.vehicle.clone(),
            },
            Axis {
                quantity: fmu::OIL_FLOW,
                points: self.ranges.flows.clone(),
            },
        ];
        let at = |x: [f64; 5]| {
            let state = LinkState {
                temperatures: [x[0], x[1]],
                speeds: &self.t.speeds(&self.case, &[x[2]]),
                vehicle_speed: x[3],
                oil_flow: x[4],
            };
            let found = self.network.conductance(link, &state);
            found.map_err(|undefined| format!("{} {} has no value", undefined.what, undefined.value))
        };
        // Some state inside of the ranges, without symmetry.
        let base: [f64; 5] = std::array::from_fn(|k| {
            let points = &axes[k].points;
            points[points.len() * (k + 3) / 9]
        });
        let before = at(base)?;
        let mut wanted = Vec::new();
        for (k, axis) in axes.iter().enumerate() {
            for x in &axis.points {
                let mut changed = base;
                changed[k] = *x;
                if (at(changed)? - before).abs() > 1e-9 * before.abs() {
                    wanted.push(k);
                    break;
                }
            }
        }
        if wanted.is_empty() {
            return Ok(fmu::Conductance::Given(before));
        }
        let sizes: Vec<usize> = wanted.iter().map(|k| axes[*k].points.len()).collect();
        let mut values = Vec::with_capacity(sizes.iter().product());
        for place in 0..sizes.iter().product::<usize>() {
            let (mut rest, mut x) = (place, base);
            for (k, size) in wanted.iter().zip(&sizes).rev() {
                x[*k] = axes[*k].points[rest % size];
                rest /= size;
            }
            values.push(short(at(x)?));
        }
        Ok(fmu::Conductance::Table(Table {
            axes: wanted.iter().map(|k| axes[*k].clone()).collect(),
            channels: 1,
            values,
        }))
    }
}
