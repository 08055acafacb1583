//! The share of two units with which they draw least.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::points::Offer;

/// Which units drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// Both are connected.
    Both,
    /// The rear unit is disconnected.
    FrontAlone,
    /// The front unit is disconnected.
    RearAlone,
    /// The vehicle stands.
    Standstill,
}

impl State {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Both => "both",
            Self::FrontAlone => "front_alone",
            Self::RearAlone => "rear_alone",
            Self::Standstill => "standstill",
        }
    }
}

/// What both units draw.
pub struct ByShare<'a> {
    /// The front unit at each of the shares.
    pub front: &'a [Offer],
    /// The rear unit at the same shares.
    pub rear: &'a [Offer],
    /// The front unit while the rear one is disconnected, and the rear one while the front one is, if they can be.
    pub alone: [Option<Offer>; 2],
}

/// The least of all shares and disconnections.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Least {
    /// Which units drive.
    pub state: State,
    /// Number of the share, if both drive.
    pub share: usize,
    /// Power of the front and of the rear machine. \[W\]
    pub drawn: [f64; 2],
    /// Excess over limits.
    pub excess: f64,
}

/// The least drawn power within the limits; beyond them the smallest excess. A disconnected machine is off.
pub fn least(by_share: &ByShare<'_>) -> Least {
    let pairs = by_share.front.iter().zip(by_share.rear).enumerate();
    let both = pairs.map(|(share, (front, rear))| Least {
        state: State::Both,
        share,
        drawn: [front.power, rear.power],
        excess: front.excess.max(rear.excess),
    });
    let [front, rear] = by_share.alone;
    let alone = |offer: Offer, state: State, drawn: [f64; 2]| Least {
        state,
        share: 0,
        drawn,
        excess: offer.excess,
    };
    let front = front.map(|offer| alone(offer, State::FrontAlone, [offer.power, 0.0]));
    let rear = rear.map(|offer| alone(offer, State::RearAlone, [0.0, offer.power]));
    let key = |least: &Least| (least.excess, least.drawn[0] + least.drawn[1]);
    let all = both.chain(front).chain(rear);
    let found = all.reduce(|best, other| if key(&other) < key(&best) { other } else { best });
    found.unwrap_or(Least {
        state: State::Both,
        share: 0,
        drawn: [0.0; 2],
        excess: f64::INFINITY,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// P = 40 + 0.5 w + 4e-4 w2 + 0.08 T2 + 2e-3 w |T| at 300 rad/s. \[W\]
    fn loss(torque: f64) -> f64 {
        40.0 + 0.5 * 300.0 + 4e-4 * 300.0 * 300.0 + 0.08 * torque * torque + 2e-3 * 300.0 * torque.abs()
    }

    fn offer(power: f64) -> Offer {
        Offer {
            power,
            loss: power,
            excess: 0.0,
        }
    }

    /// Both units at shares in steps of 0.01, and each alone with the drag of the other one, if it can be disconnected. \[Nm, W\]
    fn of_torque(torque: f64, drag: Option<f64>) -> Least {
        let at = |share: f64| offer(loss(share * torque));
        let front: Vec<Offer> = (0..=100).map(|i| at(f64::from(i) / 100.0)).collect();
        let rear: Vec<Offer> = (0..=100).map(|i| at(1.0 - f64::from(i) / 100.0)).collect();
        let alone = drag.map(|drag| offer(loss(torque) + drag));
        least(&ByShare {
            front: &front,
            rear: &rear,
            alone: [alone, alone],
        })
    }

    #[test]
    fn equal_units_without_disconnection_share_equally() {
        for (torque, equal, idle) in [(60.0, 632.0, 776.0), (100.0, 912.0, 1312.0)] {
            let found = of_torque(torque, None);
            assert_eq!((found.state, found.share), (State::Both, 50));
            assert!((found.drawn[0] + found.drawn[1] - equal).abs() < 1e-9, "{found:?}");
            assert!((loss(torque) + loss(0.0) - idle).abs() < 1e-9);
        }
    }

    /// One unit is better below T* = sqrt(2 (P_0 - P_d)/k2) = 73.48469 Nm of both.
    #[test]
    fn one_unit_is_better_below_the_threshold() {
        let drawn = |torque: f64| of_torque(torque, Some(10.0));
        let [low, high] = [60.0, 100.0].map(drawn);
        assert_eq!((low.state, low.drawn), (State::FrontAlone, [560.0, 0.0]));
        assert_eq!((high.state, high.share), (State::Both, 50));
        assert!((high.drawn[0] + high.drawn[1] - 912.0).abs() < 1e-9);
        let (mut below, mut above) = (60.0, 100.0);
        for _ in 0..60 {
            let middle = 0.5 * (below + above);
            if drawn(middle).state == State::Both {
                above = middle;
            } else {
                below = middle;
            }
        }
        assert!((below - 73.484_69).abs() < 5e-6, "{below}");
        assert!((below - (2.0 * (226.0 - 10.0) / 0.08_f64).sqrt()).abs() < 1e-9);
    }
}
