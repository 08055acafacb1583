//! Equilibrium of the inner ring on its rolling elements.
//!
//! Without gyroscopic moments the elements store energy that is a convex function of the displacement, because each deflection is a convex
//! function of it. So the equilibrium is a minimum, Newton's steps with the analytic stiffness descend to it, and steps that go too far are
//! halved.

use nalgebra::{SMatrix, SVector};

type Vector = SVector<f64, 5>;
type Matrix = SMatrix<f64, 5, 5>;

/// Quantities of the five degrees of freedom of the inner ring: displacements in m with tilts in rad, or loads in N with moments in Nm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Axes<T> {
    /// Along the axis.
    pub axial: T,
    /// Across the axis, in two directions y and z.
    pub radial: [T; 2],
    /// In the planes of y and z: a positive tilt moves the side of positive y, or z, in the positive axial direction.
    pub tilt: [T; 2],
}

impl<T: Copy> Axes<T> {
    /// Axial, radial y and z, tilt in the planes of y and z.
    pub fn array(&self) -> [T; 5] {
        let Self {
            axial,
            radial: [y, z],
            tilt: [of_y, of_z],
        } = *self;
        [axial, y, z, of_y, of_z]
    }

    fn from_array([axial, y, z, of_y, of_z]: [T; 5]) -> Self {
        Self {
            axial,
            radial: [y, z],
            tilt: [of_y, of_z],
        }
    }
}

/// What is known in the direction of one degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Given {
    /// The load.
    Load(f64),
    /// The displacement.
    Displacement(f64),
}

impl Axes<Given> {
    /// A ring under an axial load and a radial load in the direction of y, whose tilts are held at zero.
    pub fn loaded(axial: f64, radial: f64) -> Self {
        Self {
            axial: Given::Load(axial),
            radial: [Given::Load(radial), Given::Load(0.0)],
            tilt: [Given::Displacement(0.0); 2],
        }
    }

    /// The same with a moment in the plane of the radial load instead of a held tilt. \[Nm\]
    pub fn with_moment(self, moment: f64) -> Self {
        Self {
            tilt: [Given::Load(moment), Given::Load(0.0)],
            ..self
        }
    }

    /// The same with no displacement across the plane of y, where a load in it causes none; for a [`Mirrored`](super::Mirrored) row.
    pub fn mirrored(self) -> Self {
        let still = Given::Displacement(0.0);
        Self {
            radial: [self.radial[0], still],
            tilt: [self.tilt[0], still],
            ..self
        }
    }

    /// The same with a tilt in the plane of the radial load. \[rad\]
    pub fn with_tilt(self, tilt: f64) -> Self {
        Self {
            tilt: [Given::Displacement(tilt), Given::Displacement(0.0)],
            ..self
        }
    }
}

/// Force of one element on the ring at a displacement in its own plane: axial, radial, and the moment of a tilt over the radius of the row.
/// The displacement of a tilt is that at this radius. \[N, N/m\]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LocalForce {
    /// The force against the displacement.
    pub force: [f64; 3],
    /// Its derivatives.
    pub stiffness: [[f64; 3]; 3],
    /// Greatest of the forces that balance each other in it, of which 1e-14 is rounding: zero without contact. \[N\]
    pub size: f64,
}

/// A row of rolling elements around a ring.
pub trait Row {
    /// Cosine and sine of the position of each element, from y towards z.
    fn directions(&self) -> &[[f64; 2]];

    /// Radius at which a tilt is measured as a displacement. \[m\]
    fn radius(&self) -> f64;

    /// Force of the element with this number at a displacement in its plane: axial, radial, of the tilt at the radius. \[m\]
    fn force(&self, element: usize, displacement: [f64; 3]) -> LocalForce;

    /// A first guess of the axial and the radial displacement under an axial and a radial load. \[m\]
    fn guess(&self, axial: f64, radial: f64) -> [f64; 2];

    /// The displacement of the ring in the plane of an element.
    fn in_plane(&self, element: usize, displacement: &Axes<f64>) -> [f64; 3] {
        let [cos, sin] = self.directions()[element];
        let (radial, tilt) = (displacement.radial, displacement.tilt);
        [
            displacement.axial,
            radial[0] * cos + radial[1] * sin,
            (tilt[0] * cos + tilt[1] * sin) * self.radius(),
        ]
    }
}

/// A ring in equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// Displacement of the inner ring.
    pub displacement: Axes<f64>,
    /// Load on the inner ring, also in the directions whose displacement is given.
    pub load: Axes<f64>,
    /// Largest difference from the given loads, moments over the radius of the row. \[N\]
    pub residual: f64,
    /// Compliance in the directions whose load is given, with tilts as displacements at the radius. \[m/N\]
    compliance: Matrix,
    /// The radius of the row. \[m\]
    radius: f64,
}

impl Equilibrium {
    /// Stiffness in the direction of the axis, at constant loads in the other directions whose load is given; `None` if nothing resists, or
    /// the displacement is given. \[N/m\]
    pub fn axial_stiffness(&self) -> Option<f64> {
        self.stiffness(0)
    }

    /// The same in the direction of y. \[N/m\]
    pub fn radial_stiffness(&self) -> Option<f64> {
        self.stiffness(1)
    }

    /// The same against a tilt in the plane of y. \[Nm/rad\]
    pub fn tilting_stiffness(&self) -> Option<f64> {
        self.stiffness(3).map(|stiffness| stiffness * self.radius * self.radius)
    }

    fn stiffness(&self, axis: usize) -> Option<f64> {
        let stiffness = 1.0 / self.compliance[(axis, axis)];
        let most = (0..5).map(|i| 1.0 / self.compliance[(i, i)]).filter(|k| k.is_finite());
        let most = most.fold(0.0_f64, f64::max);
        Some(stiffness).filter(|k| k.is_finite() && *k > 1e-6 * most)
    }
}

/// No equilibrium was found: the elements cannot carry the load in its directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unbalanced;

/// Steps after which the search ends.
const STEPS: usize = 300;
/// Residual over the given loads at which an equilibrium is accepted, and at which the search ends.
const ACCEPTED: f64 = 1e-10;
const WANTED: f64 = 1e-11;
/// The share of the forces of the elements that counts as rounding.
const ROUNDING: f64 = 1e-14;

/// Forces of all elements at a displacement; tilts as displacements at the radius.
#[derive(Clone, Copy)]
struct Reaction {
    force: Vector,
    stiffness: Matrix,
    /// Sum of the forces that balance each other in the elements.
    sizes: f64,
}

fn reaction(row: &impl Row, u: &Vector) -> Reaction {
    let mut sum = Reaction {
        force: Vector::zeros(),
        stiffness: Matrix::zeros(),
        sizes: 0.0,
    };
    for (element, [cos, sin]) in row.directions().iter().enumerate() {
        let plane = [u[0], u[1] * cos + u[2] * sin, u[3] * cos + u[4] * sin];
        let own = row.force(element, plane);
        if own.size == 0.0 {
            continue;
        }
        // Direction in the plane of the element, and share of each degree of freedom.
        let shares = [(0, 1.0), (1, *cos), (1, *sin), (2, *cos), (2, *sin)];
        for (i, (to, share)) in shares.iter().enumerate() {
            sum.force[i] += share * own.force[*to];
            for (j, (from, other)) in shares.iter().enumerate() {
                sum.stiffness[(i, j)] += share * other * own.stiffness[*to][*from];
            }
        }
        sum.sizes += own.size;
    }
    sum
}

/// What is given, with tilts as displacements at the radius.
struct Problem {
    /// Given loads, zero in held directions.
    load: Vector,
    is_held: [bool; 5],
}

impl Problem {
    /// Differences between the forces of the elements and the loads.
    fn residual(&self, force: &Vector) -> Vector {
        Vector::from_fn(|i, _| if self.is_held[i] { 0.0 } else { force[i] - self.load[i] })
    }

    /// Stiffness in the directions that are not held.
    fn free(&self, stiffness: &Matrix) -> Matrix {
        Matrix::from_fn(|i, j| match (self.is_held[i] || self.is_held[j], i == j) {
            (false, _) => stiffness[(i, j)],
            (true, true) => 1.0,
            (true, false) => 0.0,
        })
    }

    /// The same with a small share on the diagonal that makes it definite, and its factors.
    fn definite(
        &self,
        stiffness: &Matrix,
        least: f64,
    ) -> Result<(Matrix, nalgebra::Cholesky<f64, nalgebra::Const<5>>), Unbalanced> {
        let free = self.free(stiffness);
        let size = (0..5).map(|i| stiffness[(i, i)]).fold(0.0_f64, f64::max);
        let mut shift = least.max(1e-13 * size);
        while shift.is_finite() {
            let shifted = free + Matrix::identity() * shift;
            match nalgebra::Cholesky::new(shifted) {
                Some(factors) => return Ok((shifted, factors)),
                None => shift = 100.0 * shift.max(f64::MIN_POSITIVE),
            }
        }
        // Overflow.
        Err(Unbalanced)
    }

    /// Follows the residual itself downhill, where inertia makes the stiffness unsymmetric and the search by energy ends (Levenberg and Marquardt):
    /// the smallest residual, its displacement and the forces there.
    fn correct(&self, row: &impl Row, mut u: Vector, mut at: Reaction) -> (f64, Vector, Reaction) {
        let mut off = self.residual(&at.force);
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            if off.amax() <= self.wanted(&at) || !(off.sum() + at.stiffness.sum()).is_finite() {
                break;
            }
            let slopes = self.free(&at.stiffness);
            let square = slopes.transpose() * slopes;
            let size = (0..5).map(|i| square[(i, i)]).fold(0.0_f64, f64::max);
            let damped = square + Matrix::identity() * (damping * size);
            let step = nalgebra::Cholesky::new(damped).map(|factors| factors.solve(&-(slopes.transpose() * off)));
            let moved = step.map(|step| {
                let next = u + step;
                (next, reaction(row, &next))
            });
            match moved {
                Some((next, reached)) if self.residual(&reached.force).norm() < off.norm() => {
                    (u, at) = (next, reached);
                    off = self.residual(&at.force);
                    damping *= 0.1;
                }
                _ if damping > 1e12 => break,
                _ => damping = 5.0 * damping.max(1e-18),
            }
        }
        (off.amax(), u, at)
    }

    /// The residual at which a search ends. \[N\]
    fn wanted(&self, at: &Reaction) -> f64 {
        (ROUNDING * at.sizes).max(WANTED * self.load.amax())
    }

    /// The largest residual of an equilibrium. \[N\]
    fn accepted(&self, at: &Reaction) -> f64 {
        (10.0 * ROUNDING * at.sizes).max(ACCEPTED * self.load.amax())
    }

    /// The inverse of this stiffness.
    fn compliance(&self, stiffness: &Matrix, least: f64) -> Result<Matrix, Unbalanced> {
        let (shifted, factors) = self.definite(stiffness, least)?;
        let exact = (!is_symmetric(stiffness)).then(|| shifted.try_inverse()).flatten();
        Ok(exact.unwrap_or_else(|| factors.inverse()))
    }

    /// Newton's step.
    fn step(&self, stiffness: &Matrix, least: f64, off: &Vector) -> Result<Vector, Unbalanced> {
        let (shifted, factors) = self.definite(stiffness, least)?;
        let exact = (!is_symmetric(stiffness)).then(|| shifted.lu().solve(&-off)).flatten();
        Ok(exact.unwrap_or_else(|| factors.solve(&-off)))
    }
}

/// A stiffness is, but for gyroscopic moments.
fn is_symmetric(stiffness: &Matrix) -> bool {
    *stiffness == stiffness.transpose()
}

/// Finds the displacement of the inner ring at which the elements balance the given loads, with a residual below 1e-10 of them.
///
/// # Errors
/// If no displacement does, such as under an axial load on cylindrical rollers, or without enough axial load on a bearing that takes it in one
/// direction.
pub fn balance(row: &impl Row, given: &Axes<Given>) -> Result<Equilibrium, Unbalanced> {
    search(row, given, None)
}

/// As [`balance`], from a displacement that is near, such as that of the same ring without inertia of its elements.
///
/// # Errors
/// As [`balance`].
pub fn balance_from(row: &impl Row, given: &Axes<Given>, start: &Axes<f64>) -> Result<Equilibrium, Unbalanced> {
    search(row, given, Some(start)).or_else(|_| search(row, given, None))
}

fn search(row: &impl Row, given: &Axes<Given>, start: Option<&Axes<f64>>) -> Result<Equilibrium, Unbalanced> {
    let radius = row.radius();
    let lengths = [1.0, 1.0, 1.0, radius, radius];
    let mut problem = Problem {
        load: Vector::zeros(),
        is_held: [false; 5],
    };
    let mut u = Vector::zeros();
    for (i, known) in given.array().into_iter().enumerate() {
        match known {
            Given::Load(load) => problem.load[i] = load / lengths[i],
            Given::Displacement(displacement) => {
                problem.is_held[i] = true;
                u[i] = displacement * lengths[i];
            }
        }
    }
    let load = &problem.load;
    let radial = load[1].hypot(load[2]);
    let [axial_guess, radial_guess] = row.guess(load[0], radial);
    if load[0] != 0.0 {
        u[0] = axial_guess;
    }
    if radial > 0.0 {
        u[1] += radial_guess * load[1] / radial;
        u[2] += radial_guess * load[2] / radial;
    }
    for (i, near) in start.into_iter().flat_map(Axes::array).enumerate() {
        if !problem.is_held[i] {
            u[i] = near * lengths[i];
        }
    }
    let applied = load.amax();
    let mut reach = [axial_guess.abs(), radial_guess.abs(), 1e-9 * radius]
        .into_iter()
        .fold(0.0, f64::max);
    let mut at = reaction(row, &u);
    let mut off = problem.residual(&at.force);
    let mut best = (off.amax(), u, at);
    for _ in 0..STEPS {
        let size = off.amax();
        // Forces beyond all numbers, such as those of an absurd speed.
        if !(off.sum() + at.stiffness.sum()).is_finite() {
            return Err(Unbalanced);
        }
        if size < best.0 {
            best = (size, u, at);
        }
        if size <= problem.wanted(&at) {
            break;
        }
        let mut step = problem.step(&at.stiffness, 1e-6 * size / reach, &off)?;
        let length = step.amax();
        if !length.is_finite() {
            return Err(Unbalanced);
        }
        let is_capped = length > reach;
        if is_capped {
            step *= reach / length;
        }
        let slope = off.dot(&step);
        let mut share = 1.0;
        let (next, reached, residual) = loop {
            let next = u + step * share;
            let reached = reaction(row, &next);
            let residual = problem.residual(&reached.force);
            // Downhill as far as here, or hardly uphill: the energy is convex.
            let rise = residual.dot(&step);
            if rise <= -0.25 * slope || share < 1e-6 {
                break (next, reached, residual);
            }
            share *= 0.5;
        };
        if is_capped && share == 1.0 {
            reach *= 2.0;
        }
        // Rounding: no further step changes anything.
        if next == u || (residual.amax() >= size && size <= ACCEPTED * applied) {
            break;
        }
        (u, at, off) = (next, reached, residual);
    }
    if best.0 > problem.accepted(&best.2) {
        best = problem.correct(row, best.1, best.2);
    }
    let (residual, u, at) = best;
    if !(residual <= problem.accepted(&at) && at.stiffness.sum().is_finite()) {
        return Err(Unbalanced);
    }
    let scaled =
        |v: &Vector, factor: fn(f64, f64) -> f64| Axes::from_array(std::array::from_fn(|i| factor(v[i], lengths[i])));
    let mut compliance = problem.compliance(&at.stiffness, 0.0)?;
    for i in (0..5).filter(|i| problem.is_held[*i] || at.sizes == 0.0) {
        compliance[(i, i)] = f64::INFINITY;
    }
    Ok(Equilibrium {
        displacement: scaled(&u, |x, length| x / length),
        load: scaled(&at.force, |x, length| x * length),
        residual,
        compliance,
        radius,
    })
}
