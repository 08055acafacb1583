//! Identifications as JSON.

use gearloss_numerics::inference::{Accuracy, BandMean, Reach, Scale, Standing, Verdict};
use gearloss_studies::identify::ModelKink;
use gearloss_studies::study::{Difference, FoldsEntry, IdentifyEntry};
use serde_json::{Value, json};

use super::super::super::solve::RPM;
use super::hold_out;
use super::outcome::Outcome;
use super::posterior;
use super::show::{RESOLVED, fold_name, fold_unit};
use crate::commands::run::shown::in_file;
use gearloss_studies::analyses::numbers::tidy;

/// All that was found for one set.
pub fn of(o: &Outcome<'_>, entry: &IdentifyEntry) -> Value {
    let inference = &o.fitted.inference;
    let count = inference.parameters().len();
    let correlations: Vec<Vec<Option<f64>>> = (0..count)
        .map(|j| (0..count).map(|k| inference.correlation(j, k)).collect())
        .collect();
    let ranged = inference.ranged_singular_values();
    json!({
        "model_set": o.name,
        "accuracy": match inference.accuracy() {
            Accuracy::Given => "given",
            Accuracy::Estimated => "estimated",
        },
        "notes": o.identification.notes(),
        "search": search(o),
        "misfit": misfit(o),
        "parameters": (0..count).map(|k| parameter(o, k)).collect::<Vec<_>>(),
        "correlations": correlations,
        "singular_values": inference.singular_values(),
        "condition": inference.condition(),
        "singular_values_of_ranges": ranged,
        "posterior": posterior::value(o),
        "resolved_combinations": inference.sized_singular_values().iter().filter(|value| **value > RESOLVED).count(),
        "checks": checks(o),
        "folds": folds(o, entry),
        "hold_out": hold_out::json_of(o),
        "points": points(o),
        "next": next(o),
        "outside": o.notes,
    })
}

fn search(o: &Outcome<'_>) -> Value {
    let (fit, minima) = (o.fitted.fit(), &o.fitted.minima);
    let minimum = |m: &gearloss_numerics::least_squares::Minimum| {
        let distances: Vec<Option<f64>> = (0..m.fit.theta.len()).map(|k| o.fitted.distance(m, k)).collect();
        json!({
            "cost": m.fit.cost, "share_of_starts": m.share, "starts": m.starts, "parameters": m.fit.theta,
            "standard_errors_away": distances,
        })
    };
    let kink = |k: &ModelKink| {
        let names = k
            .parameters
            .iter()
            .map(|p| o.identification.parameters()[*p].name.as_str());
        json!({
            "path": k.path, "model": k.model, "regimes": k.regimes, "jumps": k.jumps, "change": k.change, "lines": k.lines,
            "parameters": names.collect::<Vec<_>>(), "sentence": k.sentence(),
        })
    };
    let step = |i: &gearloss_numerics::least_squares::Iteration| {
        json!({
            "attempt": i.attempt, "cost": i.cost, "first_order": i.first_order, "relative_offset": i.relative_offset,
            "central_differences": i.central, "step": i.how.name(), "corrected": i.corrected, "radius": i.radius,
            "length": i.length, "predicted": i.predicted, "actual": Some(i.actual).filter(|x| x.is_finite()),
            "accepted": i.accepted,
        })
    };
    json!({
        "status": fit.status.name(),
        "reason": fit.reason.name(),
        "cost": fit.cost,
        "evaluations": minima.evaluations,
        "evaluations_of_best": fit.counts.evaluations,
        "steps": fit.counts.steps,
        "cone_programs": fit.counts.cone_solves,
        "cone_fallbacks": fit.counts.cone_failures,
        "undefined": fit.counts.undefined,
        "attempt": fit.attempt,
        "evaluations_without_derivatives": fit.counts.polishing,
        "kinks": o.fitted.kinks.iter().map(kink).collect::<Vec<_>>(),
        "kinship": minima.kinship.map(gearloss_numerics::least_squares::Kinship::name),
        "minima": minima.minima.iter().map(minimum).collect::<Vec<_>>(),
        "notes": fit.notes.iter().chain(&minima.notes).collect::<Vec<_>>(),
        "accuracy_factors": o.fitted.factors.iter().map(|(quantity, factor)| {
            json!({ "quantity": quantity.name(), "factor": factor })
        }).collect::<Vec<_>>(),
        "log": fit.log.iter().map(step).collect::<Vec<_>>(),
    })
}

fn misfit(o: &Outcome<'_>) -> Value {
    let of = |quantity: &gearloss_studies::study::Quantity| {
        let [before, after] = o.rms(*quantity);
        json!({
            "quantity": quantity.name(), "unit": quantity.unit(Difference::Points), "rms_before": before, "rms": after,
            "points": o.deviations(*quantity, 1).len(),
        })
    };
    let lack = o.checks.lack;
    json!({
        "quantities": o.quantities().iter().map(of).collect::<Vec<_>>(),
        "objective": o.fitted.inference.objective(),
        "sum_of_squares": o.fitted.inference.chi_square(),
        "degrees_of_freedom": o.fitted.inference.freedom(),
        "probability": lack.map(|l| l.probability),
        "widening": o.widening(),
        "standard_deviation_of_residuals": o.fitted.inference.scatter(),
    })
}

fn parameter(o: &Outcome<'_>, k: usize) -> Value {
    let inference = &o.fitted.inference;
    let (parameter, of) = (&o.identification.parameters()[k], &inference.parameters()[k]);
    let found = inference.determination_widened(k, o.widening().unwrap_or(1.0));
    let interval = inference.interval(k, 0.95, 1.0);
    let names =
        |list: &[usize]| -> Vec<&str> { list.iter().map(|k| inference.parameters()[*k].name.as_str()).collect() };
    let word = match found.verdict {
        Verdict::Held => "held",
        Verdict::OnBound(_) => "on_bound",
        Verdict::NotSeen => "not_seen",
        Verdict::WellDetermined => "well_determined",
        Verdict::OnlyInCombination => "only_in_combination",
        Verdict::RoughlyDetermined => "roughly_determined",
        Verdict::NotDetermined => "not_determined",
    };
    let bound = match of.standing {
        Standing::Active(side) => Some(side.name()),
        Standing::Free | Standing::Fixed => None,
    };
    let profile = o.profiles[k].as_ref().map(|profile| match profile {
        Ok(p) => json!({
            "failed": null,
            "ends": p.theta,
            "reach": p.ends.map(|end| match end.reach {
                Reach::Limit => "limit",
                Reach::Bound => "bound",
                Reach::Unresolved => "unresolved",
            }),
            "fits": p.ends.iter().map(|end| end.fits).sum::<usize>(),
            "nonlinear": p.nonlinear,
        }),
        Err(reason) => json!({ "failed": reason, "ends": null, "reach": null, "fits": null, "nonlinear": null }),
    });
    json!({
        "name": parameter.name,
        "path": parameter.path,
        "paths": parameter.paths(),
        "unit": parameter.unit.symbol,
        "scale": parameter.scale,
        "stated": parameter.stated,
        "published": parameter.published(),
        "start": parameter.start,
        "least": parameter.bounds[0],
        "greatest": parameter.bounds[1],
        "prior": parameter.prior.map(|p| json!({ "mean": p.mean, "deviation": p.deviation })),
        "value": o.fitted.theta()[k],
        "standard_deviation": inference.deviation(k),
        "interval": interval.map(|i| i.ends),
        "interval_without_bounds": interval.map(|i| i.uncut),
        "profile": profile,
        "bound": bound,
        "kink": o.fitted.is_kinked(k),
        "verdict": word,
        "sentence": inference.sentence(k),
        "partners": names(&found.partners),
        "size": (of.scale == Scale::Linear).then(|| of.own_size()),
        "half_width_over_size": found.relative,
        "half_width_over_size_alone": found.relative_alone,
        "range_filled": found.filled,
        "width_over_range": found.width,
        "width_over_range_alone": found.alone,
        "own_share": found.own,
    })
}

fn checks(o: &Outcome<'_>) -> Value {
    let c = &o.checks;
    let band = |b: &BandMean| json!({ "from": b.band[0], "to": b.band[1], "points": b.count, "mean": b.mean, "limit": b.limit });
    let measured = o.identification.measured();
    let lines = |places: &[usize]| -> Vec<u64> {
        let line = |place: &usize| measured.rows[o.identification.observations()[*place].row].line;
        places.iter().map(line).collect()
    };
    json!({
        "sentences": c.words(&o.identification),
        "anderson_darling": c.normality.map(|t| json!({ "statistic": t.corrected, "probability": t.probability })),
        "succession": c.succession.map(|s| json!({
            "durbin_watson": s.durbin_watson, "correlation": s.correlation, "runs": s.runs, "expected_runs": s.expected,
            "score": s.score, "points": s.points,
        })),
        "pure_error": c.pure.map(|p| json!({
            "pure": { "squares": p.pure[0], "degrees_of_freedom": p.pure[1] },
            "lack": { "squares": p.lack[0], "degrees_of_freedom": p.lack[1] },
            "ratio": p.ratio, "probability": p.probability,
        })),
        "residuals_over_torque": c.over_torque.iter().map(band).collect::<Vec<_>>(),
        "residuals_over_speed": c.over_speed.iter().map(band).collect::<Vec<_>>(),
        "outlier_lines": lines(&c.outliers),
        "weighty_lines": lines(&c.weighty),
    })
}

fn folds(o: &Outcome<'_>, entry: &IdentifyEntry) -> Value {
    match &o.folds {
        None | Some(Err(_)) => Value::Null,
        Some(Ok((folds, validation))) => {
            let rms = validation.fold_rms();
            let by_torque = fold_unit(&entry.folds) == "Nm";
            let fold = |(fold, rms): (&gearloss_numerics::inference::Fold, f64)| {
                let end = |place: usize| fold.band.filter(|_| by_torque).map(|band| band[place]);
                json!({
                    "name": fold_name(fold, &entry.folds), "from_nm": end(0), "to_nm": end(1),
                    "points": fold.points.len(), "rms": rms,
                })
            };
            let by = match &entry.folds {
                FoldsEntry::Torques(_) => "torque",
                FoldsEntry::By(by) => by.by.as_str(),
            };
            json!({ "by": by, "rms": validation.rms, "bands": folds.iter().zip(rms).map(fold).collect::<Vec<_>>() })
        }
    }
}

/// Measured numbers with what was calculated, and losses by mechanism with their bands.
fn points(o: &Outcome<'_>) -> Value {
    let measured = o.identification.measured();
    let point = |(i, observation): (usize, &gearloss_studies::identify::Observation)| {
        let row = &measured.rows[observation.row];
        let (_, gear, point) = &o.calculated[1].solved.rows[observation.row];
        let [before, after] = [0, 1].map(|k| o.pairs[k][i]);
        let losses = o.shares.as_ref().ok().map(|shares| {
            let of = |(k, mechanism): (usize, &&str)| {
                let part = &shares.rows[observation.row].parts[k];
                let share = shares.share(observation.row, k);
                json!({
                    "mechanism": mechanism, "loss_w": part.value, "band_w": shares.bands[observation.row][k],
                    "share": share.map(|(s, _)| s.value), "share_band": share.and_then(|(_, band)| band),
                })
            };
            shares.mechanisms.iter().enumerate().map(of).collect::<Vec<_>>()
        });
        let point = json!({
            "line": row.line, "name": row.name, "gear": gear, "torque_nm": measured.value(row, "torque"),
            "speed_rpm": tidy(point.speed * RPM), "oil_temperature_degc": point.oil,
            "quantity": observation.quantity.name(), "accuracy": observation.deviation,
            "measured_before": before.measured, "model_before": before.model,
            "measured": after.measured, "model": after.model,
            "residual": (after.model - after.measured) / observation.deviation,
            "standardised_residual": o.checks.standardised[i], "leverage": o.fitted.inference.leverage()[i],
            "losses": losses,
        });
        in_file(point, measured, row)
    };
    Value::Array(o.identification.observations().iter().enumerate().map(point).collect())
}

fn next(o: &Outcome<'_>) -> Value {
    let Some(Ok(next)) = &o.next else {
        return Value::Null;
    };
    let choice = |c: &gearloss_numerics::design::Choice| {
        let at = &next.candidates[c.candidate];
        let lacking = next
            .plan
            .lacking
            .iter()
            .find(|(k, _)| *k == c.candidate)
            .map_or(0, |(_, n)| *n);
        json!({
            "torque_nm": at.torque, "speed_rpm": tidy(at.speed * RPM), "oil_temperature_degc": at.oil, "gain": c.gain,
            "cost": c.cost, "lacking_in_other_plans": lacking,
        })
    };
    let precision = |p: &gearloss_numerics::design::Precision| json!({ "ln_determinant": p.ln_determinant, "trace": p.trace, "deviations_over_ranges": p.deviations });
    let names: Vec<&str> = next
        .plan
        .parameters
        .iter()
        .map(|k| o.identification.parameters()[*k].name.as_str())
        .collect();
    json!({
        "rule": next.rule, "gear": next.gear, "parameters": names, "other_plans": next.plan.others,
        "before": precision(&next.plan.plan.before), "after": precision(&next.plan.plan.after),
        "points": next.plan.plan.choices.iter().map(choice).collect::<Vec<_>>(),
    })
}
