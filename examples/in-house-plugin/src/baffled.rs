//! A baffle around an immersed gear: the drag of any other model times a measured factor.

use gearloss_framework::prelude::*;

terms! { BAFFLED = no_load("baffled"); }
observed! { FACTOR = ("factor", "-", "ratio of drag with and without the baffle"); }

/// Drag of a gear with a baffle.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Drag without the baffle.
    pub free: ModelRef<GearDrag>,
    /// CSV file of the factor: columns of the quantities that it depends on, such as `speed [rpm]`, then `factor [-]`.
    #[schemars(extend("x-refers-to" = "file"))]
    pub factor: String,
}

/// Drag of a gear with a baffle, prepared: the nested model is built and the file is read.
pub struct Baffled {
    free: Slot<GearDrag>,
    factor: Lookup<GearDrag>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Baffled, Diagnostic> {
    let reading = Reading {
        outside: Outside::Clamp,
        ..Reading::default()
    };
    Ok(Baffled {
        free: cx.slot("free", &params.free)?,
        factor: Lookup::read(&params.factor, &reading, "-", cx)?,
    })
}

impl GearDragModel for Baffled {
    fn covers(&self) -> Option<Covers> {
        self.free.covers()
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let free = self.free.loss(&at.nested(&self.free))?;
        let (factor, _) = self.factor.value(at)?;
        let watts = at.observe(&FACTOR, factor) * free.total_watts(at.speed);
        Ok(Loss::POWERS.with(&BAFFLED, watts))
    }
}

register!(GearDrag, "baffled", Params,
    source: "rig report 24, 2025",
    example: "{ type: baffled, free: { type: dawson }, factor: baffle.csv }",
    files: [("baffle.csv", "speed [rpm],factor [-]\n0,1\n1500,0.8\n")],
    evidence: [formula(Evidence::OneSource, "one gearbox, measured with and without its baffle")],
    terms: [BAFFLED], observed: [FACTOR],
    prepare: prepare);

#[cfg(test)]
mod tests {
    use gearloss_framework::testing::{assert_close, eval};

    /// The file of the example has 0.8 at 1500 rpm, so 0.9 at 750 rpm.
    #[test]
    fn the_factor_applies_to_the_free_drag() {
        for (speed, factor) in [(1500, 0.8), (-750, 0.9)] {
            let at = format!("at: {{ speed: {speed} rpm }}");
            let free = eval("gear_drag/dawson", &format!("{{ model: {{ type: dawson }}, {at} }}"));
            assert_close(eval("gear_drag/baffled", &at).total, factor * free.total, 1e-12);
        }
    }
}
