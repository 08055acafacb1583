//! Published and independent values of volumes, levels and films; properties of the balance.
#![allow(clippy::unwrap_used)]

use super::*;
use crate::real::{Dual, LANES, Lane, Points, Real as _};
use proptest::prelude::*;

const MM: f64 = 1e-3;
const LITRE: f64 = 1e-3;

/// A trapezoid under a rectangle, 120 mm long.
fn case_a() -> Outline {
    let corners = [
        [0.0, 0.0],
        [200.0, 0.0],
        [260.0, 100.0],
        [260.0, 300.0],
        [-60.0, 300.0],
        [-60.0, 100.0],
    ];
    Outline {
        corners: corners.map(|corner| corner.map(|x| x * MM)).to_vec(),
        range: [-60.0 * MM, 60.0 * MM],
    }
}

const GEAR: Disc = Disc {
    height: 110.0 * MM,
    radius: 90.0 * MM,
    width: 30.0 * MM,
    slope: 1.0,
    rise: 0.0,
};

const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn space(discs: &[Disc], up: [f64; 3]) -> Space {
    let slope = 1.0 / up[1].hypot(up[2]);
    let inclined = |disc: &Disc| Disc {
        slope,
        rise: up[0] * disc.width * slope,
        ..*disc
    };
    let discs = discs.iter().map(inclined).collect();
    Space::new(&[case_a()], discs, up, 0.0).unwrap()
}

/// A sump without pockets.
struct Nothing;

impl<R> Catchers<R> for Nothing {
    fn caught<T: Points>(
        &self,
        _: impl Fn(R) -> T + Copy,
        _: impl Fn(usize) -> [T; 2] + Copy,
        _: T,
        _: T,
    ) -> Caught<T> {
        Caught {
            through: T::ZERO,
            bare: T::ZERO,
            held: T::ZERO,
        }
    }
}

/// Equal to the printed digits of the second number.
#[track_caller]
fn printed(value: f64, digits: &str) {
    let expected: f64 = digits.parse().unwrap();
    let decimals = digits.split('.').nth(1).map_or(0, str::len);
    let half = 0.5000001 * 10.0_f64.powf(-(decimals as f64));
    assert!((value - expected).abs() <= half, "{value} is not {digits}");
}

#[test]
fn volumes_below_a_level() {
    let (with, without) = (space(&[GEAR], UP), space(&[], UP));
    for (level, volume, area, empty) in [
        (30.0, "0.768115", "0.0258461", "0.7848"),
        (50.0, "1.29637", "0.0271751", "1.38"),
        (80.0, "2.15804", "0.0304288", "2.3808"),
        (150.0, "4.44963", "0.0335626", "5.04"),
    ] {
        let [v, a] = with.volume(level * MM);
        printed(v / LITRE, volume);
        printed(a, area);
        printed(without.volume(level * MM)[0] / LITRE, empty);
    }
    let [area, chord] = Disc { width: 1.0, ..GEAR }.below(50.0 * MM);
    printed(area * 1e3, "2.787734");
    printed(chord / MM, "134.1641");
}

#[test]
fn levels_of_a_volume() {
    let with = space(&[GEAR], UP);
    for (volume, level, per_litre) in [
        (0.6, "23.4896", "38.62"),
        (1.2, "46.4331", "37.225"),
        (2.0, "74.7512", "33.562"),
    ] {
        let found = with.level(volume * LITRE);
        printed(found / MM, level);
        printed(1e-3 / with.volume(found)[1] / MM, per_litre);
    }
    let without = space(&[], UP).level(1.2 * LITRE);
    printed(without / MM, "44.1518");
    // Steps of Newton's from 20 mm.
    let mut level = 20.0 * MM;
    for digits in ["45.7142857", "46.4339315", "46.4331293"] {
        let [volume, area] = with.volume(level);
        level -= (volume - 1.2 * LITRE) / area;
        printed(level / MM, digits);
    }
}

#[test]
fn inclined_levels() {
    let ten = 10.0_f64.to_radians();
    let grade = space(&[], [ten.sin(), 0.0, ten.cos()]).level(1.2 * LITRE);
    // At the middle plane, along z.
    printed(grade / ten.cos() / MM, "44.0633");
    // The outline turned by +10 deg about the origin: upwards is turned the other way in it.
    let bank = space(&[], [0.0, ten.sin(), ten.cos()]).level(1.2 * LITRE);
    printed(bank / MM, "59.6807");
}

/// The spaces of case A with its gear, on a level road.
fn travelling(direction: [f64; 3], discs: &[Disc]) -> Inclinations {
    let travel = Travel::new(UP, direction).unwrap();
    let at: Vec<(Vec<Disc>, f64)> = travel
        .ups()
        .map(|up| {
            let slope = 1.0 / up[1].hypot(up[2]);
            // The gear is 120 mm towards y and in the middle along x.
            let place = |disc: &Disc| up[1] * 0.12 + up[2] * disc.height;
            let turned = |disc: &Disc| Disc {
                slope,
                rise: up[0] * disc.width * slope,
                height: place(disc),
                ..*disc
            };
            (discs.iter().map(turned).collect(), 0.0)
        })
        .collect();
    Inclinations::new(travel, &[case_a()], &at, [0.0, 0.1])
}

/// A disc on an inclined axis displaces the sum of thin ones.
#[test]
fn inclined_discs_are_the_sum_of_thin_ones() {
    for rise in [1e-9, 3e-6, 0.004, -0.03, 0.25] {
        let whole = Disc {
            rise,
            slope: 1.2,
            ..GEAR
        };
        for level in [0.0, 15.0, 60.0, 130.0, 215.0, 300.0] {
            let level = level * MM;
            let count = 2000;
            let thin = (0..count).map(|i| {
                let place = (f64::from(i) + 0.5) / f64::from(count) - 0.5;
                let thin = Disc {
                    height: whole.height - place * rise / whole.slope,
                    width: whole.width / f64::from(count),
                    rise: 0.0,
                    ..whole
                };
                thin.below(level)
            });
            let sum = thin.fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
            let [volume, area] = whole.below(level);
            assert!((volume - sum[0]).abs() < 1e-9, "{rise} {level}: {volume} {}", sum[0]);
            assert!((area - sum[1]).abs() < 2e-5, "{rise} {level}: {area} {}", sum[1]);
        }
    }
}

#[test]
fn grade_and_acceleration_incline_the_apparent_vertical() {
    let ten = 10.0_f64.to_radians();
    assert!((apparent_grade(ten.tan(), 0.0, 9.80665) - ten).abs() < 1e-15);
    assert!((apparent_grade(0.0, 9.80665 * ten.tan(), 9.80665) - ten).abs() < 1e-15);
    let (slope, a) = (0.1_f64, 2.0);
    let exact = ((9.80665 * slope.sin() + a) / (9.80665 * slope.cos())).atan();
    assert!((apparent_grade(slope.tan(), a, 9.80665) - exact).abs() < 1e-15);
    // A level road leaves the built direction; a bank stays while the road rises.
    let bank = [0.0, ten.sin(), ten.cos()];
    let travel = Travel::new(bank, [1.0, 0.0, 0.0]).unwrap();
    assert_eq!(travel.up(0.0), bank);
    let up = travel.up(ten);
    assert!((up[0] - ten.sin()).abs() < 1e-15 && (up[1] - ten.cos() * bank[1]).abs() < 1e-15);
    assert!(Travel::new(UP, UP).is_none());
}

#[test]
fn a_cycle_inclines_as_grade_and_bank_do() {
    let ten = 10.0_f64.to_radians();
    for (direction, level) in [([1.0, 0.0, 0.0], "44.0633"), ([0.0, 1.0, 0.0], "59.6807")] {
        let spaces = travelling(direction, &[]);
        let found = spaces.space(ten).level(1.2 * LITRE);
        let along_z = if direction[0] > 0.0 { found / ten.cos() } else { found };
        printed(along_z / MM, level);
        // Whole degrees are exact, others within a micrometre.
        for degrees in [-31.0, -7.0, 1.0, 10.0, 7.3, -12.51, 0.4] {
            let angle = f64::to_radians(degrees);
            let exact = space(&[], spaces.travel().up(angle)).level(1.2 * LITRE);
            let tolerance = if degrees == degrees.round() { 1e-12 } else { 1e-6 };
            let found = spaces.space(angle).level(1.2 * LITRE);
            assert!((found - exact).abs() < tolerance, "{degrees} deg: {found} {exact}");
        }
    }
}

proptest! {
    /// Level and volume are inverse of each other at any inclination, with solids in the oil: no oil is lost.
    #[test]
    fn no_oil_is_lost_by_inclination(
        degrees in -59.0..59.0_f64, litres in 0.05..8.0_f64, across in any::<bool>()
    ) {
        let spaces = travelling(if across { [0.0, 1.0, 0.0] } else { [-1.0, 0.0, 0.0] }, &[GEAR]);
        let space = spaces.space(degrees.to_radians());
        let volume = litres * LITRE;
        let level = space.level(volume);
        prop_assert!((space.volume(level)[0] - volume).abs() < 1e-12, "{} l", space.volume(level)[0] * 1e3);
        prop_assert!(space.level(volume * 1.01) > level);
    }
}

#[test]
fn hull_of_two_circles() {
    let (a, r1, r2) = (0.15_f64, 0.12, 0.08);
    let p = ((r1 - r2) / a).acos();
    let exact = r1 * r1 * (std::f64::consts::PI - p) + r2 * r2 * p + (r1 + r2) * (a * a - (r1 - r2) * (r1 - r2)).sqrt();
    printed(exact, "0.06374569");
    let arc = |y: f64, r: f64, from: f64, to: f64| {
        (0..400).map(move |i| {
            let angle = from + (to - from) * f64::from(i) / 399.0;
            [y + r * angle.cos(), r * angle.sin()]
        })
    };
    let corners = arc(0.0, r1, p, std::f64::consts::TAU - p)
        .chain(arc(a, r2, -p, p))
        .collect();
    let range = [0.0, 1.0];
    printed(Outline { corners, range }.area(), "0.06374526");
    let corners = hull(&[([0.0, 0.0], r1), ([a, 0.0], r2)], CHORDS);
    let short = 1.0 - Outline { corners, range }.area() / exact;
    assert!(short > 0.0 && short < 5e-4, "{short}");
}

#[test]
fn sections_that_cross_or_hold_less_than_their_gears_are_found() {
    let bow = Outline {
        corners: vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]],
        range: [0.0, 1.0],
    };
    assert!(bow.crosses_itself() && !case_a().crosses_itself());
    let wide = Disc { width: 1.0, ..GEAR };
    assert!(Space::new(&[case_a()], vec![wide], UP, 0.0).is_err());
    let empty = Space::new(&[], Vec::new(), UP, 0.0).unwrap();
    assert_eq!((empty.level(1.0), empty.volume(1.0)), (0.0, [0.0, 0.0]));
}

#[test]
fn films() {
    for (flow, nu, thickness) in [
        (1e-3, 1e-5, "1.45167"),
        (1e-3, 1e-4, "3.12752"),
        (1e-2, 1e-5, "3.76017"),
    ] {
        printed(film(flow, nu) / MM, thickness);
    }
    // At Re = 400, in units of (3 nu^2/g)^(1/3), the laminar law gives 7.36806 and the turbulent one 7.37517.
    let nu = 1e-5_f64;
    let unit = (3.0 * nu * nu / 9.80665).cbrt();
    printed(film(400.0 * nu, nu) / unit, "7.37517");
    printed(400.0_f64.cbrt(), "7.36806");
}

#[test]
fn films_that_are_left_and_drawn() {
    // A flank of 5.6 mm half a turn after it left the oil at 10 m/s.
    printed(left_on_flank(1e-5, 5.6 * MM, 10.0) / 1e-6, "28.1467");
    // Slow surfaces carry what viscosity lifts, fast ones what they drag along 100 mm.
    printed(drawn(1e-5, 0.1, 0.1) / MM, "0.21289");
    printed(drawn(1e-5, 10.0, 0.1) / MM, "0.51102");
    printed(drawn(1e-5, 10.0, 1e9) / MM, "2.1289");
    // Walls of 0.16 m2 and 0.2 m height after a stop.
    printed(0.16 * left_on_wall(1e-5, 0.2, 10.0) / LITRE, "0.015233");
    printed(0.16 * left_on_wall(1e-4, 0.2, 60.0) / LITRE, "0.019666");
}

#[test]
fn effective_depths_of_shore() {
    for (nu, expected) in [
        (1e-5, "0.9999 0.9862 0.7796 0.5286 0.4169"),
        (4e-5, "0.9963 0.9163 0.6363 0.4590 0.3920"),
    ] {
        let found = [3.0, 5.0, 10.0, 20.0, 40.0].map(|v| effective_share(0.2, v / 0.08, 0.08, nu));
        assert_eq!(found.map(|r| format!("{r:.4}")).join(" "), expected);
    }
}

/// The gear of case A, with tooth spaces that carry 2 mm.
fn lift() -> Lift {
    Lift {
        height: GEAR.height,
        slope: 1.0,
        orbit: 0.0,
        radii: [90.0 * MM, 87.5 * MM, (0.09_f64 * 0.09 - 4.0 * 0.09 * 0.002).sqrt()],
        width: GEAR.width,
        teeth: 35.0,
    }
}

const WALLS: Walls = Walls {
    area: 0.16,
    length: 0.40,
    flight: 0.15,
};

/// Film levels, lifted flow, oil on the walls and in the air, effective level: rim speed, power, viscosity, volume.
fn estimates(v: f64, power: f64, nu: f64, stock: f64) -> (Band, f64, f64) {
    let space = space(&[GEAR], UP);
    let (lifts, lifted) = ([lift()], [lift().lifted(power, v / 0.09, 830.0)]);
    let running = Running {
        space: |_| AnySpace::from(&space),
        inside: space.inside(),
        walls: WALLS,
        lifts: &lifts,
        lifted: &lifted,
        rest: space.level(stock),
        stock,
        nu,
        catchers: Nothing,
        starts: !0,
    };
    let band = running.band();
    let outside = running.outside(|x| x, band.films[1], 1.0);
    // Mass is conserved; where the film grows without bound from a pool that is nearly empty, within the digits of the level.
    let excess = |level: f64| space.volume(level)[0] + running.outside(|x| x, level, 1.0).missing() - stock;
    let level = band.films[1];
    let closes = excess(level).abs() < 1e-12 * stock;
    assert!(
        closes || (excess(level - 1e-12) <= 0.0 && excess(level + 1e-12) >= 0.0),
        "{}",
        excess(level)
    );
    (band, outside.flow, outside.on_walls)
}

#[test]
fn both_estimates_of_the_running_level() {
    for (v, power, nu, films, flow, wall) in [
        (
            6.0,
            10.0,
            1e-5,
            ["42.2223", "39.9489", "39.7716"],
            "20.0803",
            "0.164148",
        ),
        (
            12.0,
            40.0,
            1e-5,
            ["42.2696", "40.1075", "38.3271"],
            "20.0803",
            "0.164148",
        ),
        (
            24.0,
            120.0,
            1e-5,
            ["42.6777", "40.7752", "39.2455"],
            "15.0602",
            "0.149138",
        ),
        (
            12.0,
            60.0,
            1e-4,
            ["36.1233", "30.8039", "28.6973"],
            "30.1205",
            "0.404823",
        ),
    ] {
        let (band, lifted, held) = estimates(v, power, nu, 1.2 * LITRE);
        for (level, digits) in band.films.iter().zip(films) {
            printed(level / MM, digits);
        }
        printed(lifted * 6e4, flow);
        printed(held / LITRE, wall);
    }
    let (band, flow, _) = estimates(12.0, 40.0, 1e-5, 0.6 * LITRE);
    printed(band.films[1] / MM, "20.4447");
    printed(flow * 6e4, "2.23226");
}

#[test]
fn effective_levels() {
    for (v, nu, level) in [
        (6.0, 1e-5, "45.8355"),
        (12.0, 1e-5, "39.6950"),
        (24.0, 1e-5, "33.4153"),
        (12.0, 1e-4, "34.185"),
    ] {
        let (band, ..) = estimates(v, 10.0, nu, 1.2 * LITRE);
        printed(band.effective / MM, level);
    }
}

#[test]
fn the_lifted_flow_has_a_bound() {
    let tall = Lift {
        radii: [88.1255 * MM, 86.0 * MM, 10.0 * MM],
        ..lift()
    };
    let omega = 1500.0 * std::f64::consts::PI / 30.0;
    let lifted = tall.lifted(51.0328, omega, 842.0);
    printed(lifted.flow * 6e4, "18.9778");
    printed(2.0 * lifted.flow * 6e4, "37.9556");
}

proptest! {
    #[test]
    fn volume_and_level_are_inverse_and_exact(level in 1.0..299.0_f64, bank in -40.0..40.0_f64, grade in -40.0..40.0_f64) {
        let up = crate::immersion::upward(grade.to_radians(), bank.to_radians());
        let inclined = space(&[], up);
        let full = 10.8 * LITRE;
        prop_assert!((inclined.full() - full).abs() < 1e-12 * full);
        let share = level / 300.0;
        let height = inclined.bottom() + share * (inclined.top() - inclined.bottom());
        let [volume, area] = inclined.volume(height);
        if volume > 1e-9 * full {
            prop_assert!((inclined.level(volume) - height).abs() < 1e-9);
            let step = 1e-7;
            let slope = (inclined.volume(height + step)[0] - inclined.volume(height - step)[0]) / (2.0 * step);
            prop_assert!((slope - area).abs() < 1e-5);
        }
        // The middle of a box by symmetry: half of its volume.
        let cube = Outline { corners: vec![[-0.1, -0.2], [0.1, -0.2], [0.1, 0.2], [-0.1, 0.2]], range: [-0.3, 0.3] };
        let cube = Space::new(&[cube], Vec::new(), up, 0.0).unwrap();
        prop_assert!((cube.volume(0.0)[0] - 0.024).abs() < 1e-12 * 0.048);
    }

    #[test]
    fn polygons_are_exact(level in 0.0..300.0_f64) {
        let z = level * MM;
        let bottom = |z: f64| 0.2 * z + 0.6 * z * z;
        let exact = 0.12 * if z < 0.1 { bottom(z) } else { bottom(0.1) + 0.32 * (z - 0.1) };
        prop_assert!((space(&[], UP).volume(z)[0] - exact).abs() <= 1e-12 * 10.8 * LITRE);
    }

    #[test]
    fn the_level_falls_with_lifted_oil_only(v in 0.0..60.0_f64, power in 0.0..500.0_f64, nu in 2e-6..1e-3_f64, stock in 0.2..8.0_f64) {
        let stock = stock * LITRE;
        let rest = space(&[GEAR], UP).level(stock);
        let (band, ..) = estimates(v.max(1e-3), power, nu, stock);
        let [high, central, low] = band.films;
        prop_assert!(low <= central && central <= high && high <= rest, "{band:?} {rest}");
        prop_assert!(band.effective <= rest && band.low() <= central && central <= band.high());
        prop_assert!(band.at(-1.0) == band.low() && band.at(0.0) == central && band.at(1.0) == band.high());
        if v <= 1.5 {
            prop_assert_eq!(central, rest);
        }
        let (still, ..) = estimates(0.0, 0.0, nu, stock);
        prop_assert!(still.films == [rest; 3] && (still.effective - rest).abs() < 1e-15, "{:?}", still);
        let (more, ..) = estimates(v.max(1e-3), 1.1 * power, nu, stock);
        prop_assert!(more.films[1] <= central + 1e-12);
    }

    #[test]
    fn lanes_have_the_bits_of_single_points(v in 0.0..40.0_f64, power in 0.0..200.0_f64, nu in 2e-6..3e-4_f64) {
        let space = space(&[GEAR], UP);
        let stock = 1.2 * LITRE;
        let point = |lane: usize| (power * (1.0 + lane as f64), v + lane as f64, nu * (1.0 + 0.1 * lane as f64));
        let lifts = [lift()];
        let rest = space.level(stock);
        let lifted = [lift().lifted(Lane::each(|i| point(i).0), Lane::each(|i| point(i).1 / 0.09), Lane::constant(830.0))];
        let together = Running { space: |_| AnySpace::from(&space), inside: space.inside(), walls: WALLS.map(Lane::constant), lifts: &lifts, lifted: &lifted, rest: Lane::constant(rest), stock: Lane::constant(stock), nu: Lane::each(|i| point(i).2), catchers: Nothing, starts: !0 };
        let found = together.band();
        for lane in 0..LANES {
            let (power, v, nu) = point(lane);
            let lifted = [lift().lifted(power, v / 0.09, 830.0)];
            let alone = Running { space: |_| AnySpace::from(&space), inside: space.inside(), walls: WALLS, lifts: &lifts, lifted: &lifted, rest, stock, nu, catchers: Nothing, starts: !0 }.band();
            for (all, one) in found.films.iter().chain([&found.effective]).zip(alone.films.iter().chain([&alone.effective])) {
                prop_assert_eq!(all[lane].to_bits(), one.to_bits());
            }
        }
    }
}

/// How far the level of a square sump falls, from half its side (m), while the gear throws off a power (W) at a rim speed (m/s), and what is
/// missing from it at the level found. \[m and m3\]
fn fall(half: f64, (power, v, nu): (f64, f64, f64)) -> [f64; 2] {
    let corners = vec![[-half, -half], [half, -half], [half, half], [-half, half]];
    let range = [-half, half];
    let lake = Space::new(&[Outline { corners, range }], vec![GEAR], UP, 0.0).unwrap();
    let (lifts, lifted) = ([lift()], [lift().lifted(power, v / 0.09, 830.0)]);
    let (rest, stock) = (50.0 * MM, lake.volume(50.0 * MM)[0]);
    let running = Running {
        space: |_| AnySpace::from(&lake),
        inside: lake.inside(),
        walls: WALLS,
        lifts: &lifts,
        lifted: &lifted,
        rest,
        stock,
        nu,
        catchers: Nothing,
        starts: !0,
    };
    let level = running.film_level(1.0);
    [rest - level, running.outside(|x| x, level, 1.0).missing()]
}

proptest! {
    /// The drop vanishes with the size of the sump: it is what is missing over the surface of the oil.
    #[test]
    fn a_huge_sump_does_not_fall(half in 1.0..50.0_f64, power in 0.0..300.0_f64, v in 0.0..40.0_f64, nu in 2e-6..3e-4_f64) {
        let at = (power, v, nu);
        let [fallen, missing] = fall(half, at);
        // The gear takes at most its own section of the surface.
        let surface = 4.0 * half * half;
        prop_assert!(fallen >= 0.0 && fallen <= missing / (surface - 0.18 * 0.03) + 1e-12, "{fallen} {missing}");
        prop_assert!(fallen >= missing / surface - 1e-12, "{fallen} {missing}");
        let [less, _] = fall(10.0 * half, at);
        prop_assert!(less <= fallen / 90.0 + 1e-12, "{less} {fallen}");
    }
}

#[test]
fn derivatives_of_the_level_are_those_of_differences() {
    let space = space(&[GEAR], UP);
    let lifts = [lift()];
    let rest = space.level(1.2 * LITRE);
    let level = |power: f64, nu: f64| {
        let lifted = [lift().lifted(power, 130.0, 830.0)];
        Running {
            space: |_| AnySpace::from(&space),
            inside: space.inside(),
            walls: WALLS,
            lifts: &lifts,
            lifted: &lifted,
            rest,
            stock: 1.2 * LITRE,
            nu,
            catchers: Nothing,
            starts: !0,
        }
        .film_level(1.0)
    };
    let lifted = [lift().lifted(Dual::variable(40.0, 0), Dual::constant(130.0), Dual::constant(830.0))];
    let dual = Running {
        space: |_| AnySpace::from(&space),
        inside: space.inside(),
        walls: WALLS.map(Dual::constant),
        lifts: &lifts,
        lifted: &lifted,
        rest: Dual::constant(rest),
        stock: Dual::constant(1.2 * LITRE),
        nu: Dual::variable(1e-5, 1),
        catchers: Nothing,
        starts: !0,
    };
    let found = dual.film_level(1.0);
    assert_eq!(found.value.to_bits(), level(40.0, 1e-5).to_bits());
    let by_power = (level(40.01, 1e-5) - level(39.99, 1e-5)) / 0.02;
    let by_nu = (level(40.0, 1.0001e-5) - level(40.0, 0.9999e-5)) / 2e-9;
    assert!((found.slopes[0] / by_power - 1.0).abs() < 1e-6, "{found:?} {by_power}");
    assert!((found.slopes[2] / by_nu - 1.0).abs() < 1e-6, "{found:?} {by_nu}");
}
