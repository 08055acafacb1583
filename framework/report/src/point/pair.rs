//! How the axial loads of a pair of bearings follow from each other.

use gearloss_framework::evaluate::Solution;
use gearloss_framework::resolve::Resolved;
use gearloss_framework::transmission::Transmission;
use gearloss_studies::pairs::{PairCard, pair_cards, preload_records};

use crate::text::{Lines, last_key, significant};

/// The steps of the axial load of a bearing by its path, if it is in a pair.
pub(super) fn explain_pair(
    transmission: &Transmission,
    resolved: &Resolved,
    solution: &Solution<'_>,
    bearing: &str,
    out: &mut Lines,
) {
    let cards = pair_cards(transmission, resolved);
    let is_of = |card: &PairCard| card.bearings.iter().any(|own| own.bearing == bearing);
    let Some((number, card)) = cards.iter().enumerate().find(|(_, card)| is_of(card)) else {
        return;
    };
    let Some(loads) = solution.pair_loads(number, false).filter(|_| solution.has_flow()) else {
        return;
    };
    let is_preloaded = card.preload.is_some();
    out.line(format!(
        "  axial loads of the {}, {}, before load factors:",
        card.name(),
        card.mounting_words()
    ));
    for own in &card.bearings {
        out.line(format!(
            "    {}({}) = {} ({})",
            if is_preloaded { "half loaded from Fa/Fr" } else { "r" },
            last_key(&own.bearing),
            significant(own.induced_thrust),
            own.follows_from
        ));
    }
    let [left, right] = ["left", "right"].map(|takes| {
        let side = card.bearings.iter().filter(|own| own.takes == takes);
        let ids: Vec<&str> = side.map(|own| last_key(&own.bearing)).collect();
        ids.join("+")
    });
    for (side, induced) in [&left, &right].into_iter().zip(loads.induced).filter(|_| !is_preloaded) {
        out.line(format!("    S({side}) = r Fr = {} N", significant(induced)));
    }
    out.line(format!("    Ka = {} N, positive towards +x", significant(loads.thrust)));
    let axial = loads.axial.map(significant);
    if let (Some(preload), Some(at)) = (&card.preload, solution.preload(number)) {
        let records = preload_records(transmission, solution);
        let own = records
            .iter()
            .find(|record| record.bearings.iter().any(|path| path == bearing));
        let [shaft, housing] = at.temperatures.map(significant);
        out.line(format!(
            "    d at {} degC = {} um, {} N",
            significant(preload.mounting_temperature_degc),
            significant(preload.closing_um),
            significant(preload.force_n)
        ));
        out.line(format!(
            "    d = {} um, {} N, shaft {shaft} degC ({} um/K), housing {housing} degC ({} um/K)",
            significant(1e6 * at.closing),
            significant(at.force),
            significant(preload.per_kelvin_of_shaft_um),
            significant(preload.per_kelvin_of_housing_um)
        ));
        out.line(format!(
            "    delta({left}) + delta({right}) = d and Fa({right}) - Fa({left}) = Ka by the load distributions:"
        ));
        for ((side, axial), closing) in [&left, &right].into_iter().zip(axial).zip(at.closings) {
            out.line(format!(
                "    Fa({side}) = {axial} N, delta({side}) = {} um",
                significant(1e6 * closing)
            ));
        }
        if own.is_some_and(|own| own.lost) {
            out.line("    the preload is lost: less than half of the rolling elements of a bearing carry");
        }
        return;
    }
    if let Some(spring) = &card.spring {
        let (force, sprung) = (significant(spring.force_n), last_key(&spring.bearing));
        out.line(format!("    Fs = {force} N, spring on {sprung}"));
        let [on_left, on_right] = if transmission.pairs()[number]
            .spring
            .is_some_and(|spring| spring.side == 0)
        {
            ["max(Fs, -Ka)", "max(Fs + Ka, 0)"]
        } else {
            ["max(Fs - Ka, 0)", "max(Fs, Ka)"]
        };
        out.line(format!("    Fa({left}) = {on_left} = {} N", axial[0]));
        out.line(format!("    Fa({right}) = {on_right} = {} N", axial[1]));
    } else {
        out.line(format!(
            "    Fa({right}) = max(S({right}), S({left}) + Ka) = {} N",
            axial[1]
        ));
        out.line(format!("    Fa({left}) = Fa({right}) - Ka = {} N", axial[0]));
        out.line(format!(
            "    of each of them induced: {} N",
            significant(loads.mutual())
        ));
    }
}
