//! Values of the axes of grids and sweeps, with their errors.

use crate::study::{AxisError, Grid, SpeedAxis, TorqueAxis};
use gearloss_framework::transmission::Transmission;

use crate::analyses::{Planner, Stopped};
use crate::codes;

/// Values of an axis, or the error with its path.
pub fn axis(cx: &Planner<'_>, path: &str, values: Result<Vec<f64>, AxisError>) -> Result<Vec<f64>, Stopped> {
    values.map_err(|error| {
        let help = if error == AxisError::NoRating {
            "add `rating: { torque: 20 Nm, speed: 22000 rpm }` to the gearbox, or give the axis its own values"
        } else {
            "give a step that divides the range"
        };
        cx.wrong_as(codes::AXIS, path, error.to_string(), help)
    })
}

/// Maximum number of points of one grid.
const MOST_POINTS: usize = 20_000_000;

/// Torques and speeds of a grid for a gearbox; both are monotonic.
pub fn grid_axes(cx: &Planner<'_>, name: &str, grid: &Grid, t: &Transmission) -> Result<(Vec<f64>, Vec<f64>), Stopped> {
    let path = format!("grids.{name}");
    let axes = (
        torques(cx, &format!("{path}.torque"), &grid.torque, t)?,
        speeds(cx, &format!("{path}.speed"), &grid.speed, t)?,
    );
    for (list, key) in [(&axes.0, "torque"), (&axes.1, "speed")] {
        let along = |rises: bool| list.windows(2).all(|w| if rises { w[0] < w[1] } else { w[0] > w[1] });
        if !along(true) && !along(false) {
            let message = "the values of a grid axis are not monotonic";
            return Err(cx.wrong_as(
                codes::AXIS,
                &format!("{path}.{key}"),
                message,
                "sort them and remove duplicates",
            ));
        }
    }
    if axes.0.len().saturating_mul(axes.1.len()) > MOST_POINTS {
        let message = format!("the grid has more than {MOST_POINTS} points");
        return Err(cx.wrong_as(codes::AXIS, &path, message, "use larger steps"));
    }
    Ok(axes)
}

/// Torques of an axis for a gearbox.
pub fn torques(cx: &Planner<'_>, path: &str, axis_of: &TorqueAxis, t: &Transmission) -> Result<Vec<f64>, Stopped> {
    axis(cx, path, axis_of.values(t.rating.map(|r| r.torque)))
}

/// Speeds of an axis for a gearbox.
pub fn speeds(cx: &Planner<'_>, path: &str, axis_of: &SpeedAxis, t: &Transmission) -> Result<Vec<f64>, Stopped> {
    axis(cx, path, axis_of.values(t.rating.map(|r| r.speed)))
}
