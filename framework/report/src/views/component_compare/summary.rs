//! The spread of the models in one sentence.

use gearloss_studies::analyses::component_compare::ComponentCompareOutcome;
use gearloss_studies::numbers::RPM;

use crate::names::model;
use crate::page::Page;
use crate::text::{place, short, signed};

pub fn add(outcome: &ComponentCompareOutcome, page: &mut Page) {
    let c = &outcome.component_comparison;
    let (Some(torque), Some(speed)) = (c.torques.last(), c.speeds.last()) else {
        return;
    };
    let at = place(*torque, speed * RPM);
    let mut words = Vec::new();
    let component = model(&c.component);
    for model in &c.models {
        if let Some(loss) = model.points.last().and_then(|point| point.loss_w) {
            words.push(format!("`{}` {}", model.model, short(loss)));
            page.key_figure(
                &format!("{component} with {}", model.model),
                short(loss),
                "W",
                at.as_str(),
            );
        }
    }
    if words.is_empty() {
        return;
    }
    let mut headline = format!("Loss of {} at {at}: {} W", component, words.join(", "));
    let best = c
        .deviations
        .iter()
        .min_by(|a, b| a.rms_percent.total_cmp(&b.rms_percent));
    if let Some(best) = best {
        headline.push_str(&format!(
            "; closest to the measurement: `{}`, {} % rms, mean {} %",
            best.model,
            short(best.rms_percent),
            signed(best.mean_percent)
        ));
    }
    page.headline = Some(headline);
}
