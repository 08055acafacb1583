//! Positions of planets and their rings above or below the axis of the carrier.

use super::super::things::{Contact, Kind, Things};
use super::Axes;

/// Heights of the planets' axes relative to their carrier: planets touch the sun, or the planet next to it.
pub(super) fn orbits(things: &Things, radii: &[f64], scale: f64) -> Vec<f64> {
    let member = |g: usize| things.wheels[g].member;
    let mut found: Vec<Option<f64>> = things
        .members
        .iter()
        .map(|m| (!matches!(m.kind, Kind::Planet(_))).then_some(0.0))
        .collect();
    // Suns: the largest sum of radii, so that no gears of a stepped planet cover each other.
    let has_sun = |body: usize| {
        let suns = things
            .contacts
            .iter()
            .filter(|c| c.gears.iter().any(|g| member(*g) == body));
        suns.filter(|c| c.gears.iter().all(|g| !things.wheels[*g].ring))
            .filter(|c| c.gears.iter().any(|g| !things.is_planet(member(*g))))
            .map(|c| radii[c.gears[0]] + radii[c.gears[1]])
            .fold(None, |most: Option<f64>, r| Some(most.map_or(r, |m| m.max(r))))
    };
    for body in 0..found.len() {
        if things.is_planet(body) {
            found[body] = has_sun(body).map(|r| -r);
        }
    }
    let pairs = || {
        things
            .contacts
            .iter()
            .filter(|c| c.gears.iter().all(|g| things.is_planet(member(*g))))
    };
    // Of two planets in mesh that both touch a sun one moves to the other side.
    for pair in pairs() {
        let [a, b] = pair.gears.map(member);
        if let (Some(x), Some(y)) = (found[a], found[b])
            && x * y > 0.0
        {
            found[b] = Some(-y);
        }
    }
    for _ in 0..things.contacts.len() {
        for pair in pairs() {
            let [a, b] = pair.gears;
            let sum = radii[a] + radii[b];
            for (near, far) in [(a, b), (b, a)] {
                if let (Some(x), None) = (found[member(near)], found[member(far)]) {
                    found[member(far)] = Some(x + if x > 0.0 { sum } else { -sum });
                }
            }
        }
    }
    (0..found.len())
        .map(|body| found[body].unwrap_or_else(|| -inside_a_ring(things, radii, body).unwrap_or(0.03 * scale)))
        .collect()
}

/// Orbit of a planet that meshes with rings alone.
fn inside_a_ring(things: &Things, radii: &[f64], body: usize) -> Option<f64> {
    let in_ring = |c: &&Contact| things.wheels[c.gears[0]].member == body && things.wheels[c.gears[1]].ring;
    let contact = things.contacts.iter().find(in_ring)?;
    Some((radii[contact.gears[1]] - radii[contact.gears[0]]).max(0.0))
}

/// Rings touch the tips of their planets.
pub(super) fn fit_rings(things: &Things, axes: &mut Axes) {
    for contact in &things.contacts {
        let [mate, ring] = contact.gears;
        let body = things.wheels[mate].member;
        if things.wheels[ring].ring && things.is_planet(body) {
            let orbit = axes.orbits[body];
            axes.halves[ring] = if orbit > 0.0 { 1.0 } else { -1.0 };
            axes.radii[ring] = orbit.abs() + axes.radii[mate];
        }
    }
}
