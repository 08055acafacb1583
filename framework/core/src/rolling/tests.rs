//! Values of independent calculations (SciPy), printed values of other programs and catalogues, limits and symmetries.

mod axial;
mod balls;
mod high_speed;
mod integrals;
mod properties;
mod rollers;
mod search;

use super::*;

const MM: f64 = 1e-3;
const UM: f64 = 1e-6;

/// Seven balls of 11.5 mm on 43.5 mm: the ball bearing of the public program and of the commercial one with which it is compared.
fn seven_balls(clearance: f64) -> BallGeometry {
    BallGeometry {
        number: 7,
        diameter: 11.5 * MM,
        pitch_diameter: 43.5 * MM,
        conformity: [0.52, 0.53],
        contact_angle: 0.0,
        clearance,
        balls: Material::STEEL,
        rings: Material::STEEL,
    }
}

/// Fourteen rollers of 11 mm by 12 mm.
fn fourteen_rollers() -> RollerGeometry {
    RollerGeometry {
        number: 14,
        diameter: 11.0 * MM,
        length: 12.0 * MM,
        pitch_diameter: 60.0 * MM,
        contact_angle: 0.0,
        clearance: 0.02 * MM,
        slices: 30,
        profile: Profile::Logarithmic,
        rollers: Material::STEEL,
        rings: Material::STEEL,
    }
}

#[track_caller]
fn balanced(row: &impl Row, given: Axes<Given>) -> Equilibrium {
    match balance(row, &given) {
        Ok(found) => found,
        Err(Unbalanced) => panic!("no equilibrium"),
    }
}
