//! The closest models in one sentence, and what to be careful about.

use gearloss_studies::analyses::validation::ValidationOutcome;

use super::ratio_text;
use crate::page::Page;

pub fn add(outcome: &ValidationOutcome, page: &mut Page) {
    let found = &outcome.validation;
    let Some(best) = found.models.first() else { return };
    page.headline = Some(format!(
        "Of {} {} models, `{}` is closest to the data: {} times their losses ({} to {}) at {} points",
        found.models.len(),
        found.mechanism.replace('_', " "),
        best.name,
        ratio_text(best.all.ratio),
        ratio_text(best.all.least),
        ratio_text(best.all.greatest),
        best.all.points
    ));
    for model in found.models.iter().take(4) {
        let detail = format!("{} to {}", ratio_text(model.all.least), ratio_text(model.all.greatest));
        page.key_figure(
            &format!("calculated over measured, {}", model.name),
            ratio_text(model.all.ratio),
            "-",
            detail,
        );
    }
    if best.all.in_range < 1.0 {
        page.careful.push(format!(
            "`{}` is outside its stated range at {} of {} points",
            best.name,
            best.at.iter().filter(|point| !point.in_range).count(),
            best.all.points
        ));
    }
    if found.models.iter().any(|model| model.failed_samples > 0) {
        let failed = found.models.iter().map(|model| model.failed_samples).max().unwrap_or(0);
        page.careful.push(format!(
            "up to {failed} samples of a model have no loss; its bands leave them out"
        ));
    }
}
