//! Corrections in analyses: whether a gearbox is the one that was identified.

use crate::analyses::{Engine, Run, Stopped};
use crate::codes;
use crate::correction::ReadyCorrection;

impl ReadyCorrection {
    /// Solves the points of the correction with the gearbox of a run, which must lose there what the identified one did.
    ///
    /// # Errors
    /// Where the gearbox differs most; an interruption.
    pub(crate) fn check(&self, engine: &Engine<'_>, path: &str, run: &Run<'_>) -> Result<(), Stopped> {
        let mut points = run.with_list(self.list());
        points.watch = None;
        let solved = engine.solve_here(&points)?;
        let losses: Vec<Option<f64>> = solved.points.iter().map(|point| point.loss_torque).collect();
        let help = "use the model set that the identification provides under `then`, under the conditions of its study";
        self.fits(&losses).map_err(|reason| {
            let message = format!("the correction belongs to another gearbox or other parameters: {reason}");
            engine.wrong_as(codes::CORRECTION, path, message, help)
        })
    }
}
