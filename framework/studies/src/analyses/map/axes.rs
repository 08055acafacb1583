//! Axes of the grid of a map.

/// Axes of a grid for one gearbox.
#[derive(Debug, Clone)]
pub struct Axes {
    /// Torques. [Nm]
    pub torques: Vec<f64>,
    /// Speeds. [rad/s]
    pub speeds: Vec<f64>,
    /// Ratings of speed and torque if the axes use fractions of them.
    pub shares: [Option<f64>; 2],
}
