//! What a study writes of each analysis: its name, its meaning, and the names that it uses.

use super::Entry;
use crate::register_entry;
use crate::study::{
    BreakdownEntry, CompareEntry, ComponentCompareEntry, ContactPathEntry, CycleAnalysisEntry, FluidSweepEntry,
    MapEntry, OperatingPointsEntry, RmsSurfaceEntry, SensitivityEntry, SpinLossEntry, SweepEntry,
    TemperatureSweepEntry, ThermalLimitEntry, TournamentEntry, UncertaintyEntry, Uses,
};

impl Entry for MapEntry {
    const TYPE: &'static str = "map";
    const MEANING: &'static str = "Losses and efficiency over a grid.";

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.grid.as_ref(),
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
                .at(&self.gear)
                .bind(&self.bind)
                .with("points", self.points.as_ref())
                .with("measured", self.measured.as_ref())
        }
    }
}

register_entry!(MapEntry);

impl Entry for CompareEntry {
    const TYPE: &'static str = "compare";
    const MEANING: &'static str = "Difference between sets of models over a grid.";

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.grid.as_ref(),
            ..Uses::new(self.gearbox.as_ref(), self.base.iter().chain(&self.against))
                .at(&self.gear)
                .bind(&self.bind)
                .with("data", self.data.as_ref())
        }
    }
}

register_entry!(CompareEntry);

impl Entry for BreakdownEntry {
    const TYPE: &'static str = "breakdown";
    const MEANING: &'static str = "Where losses arise, over speed or torque.";

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets)
            .at(&self.gear)
            .with("measured", self.measured.as_ref())
    }
}

register_entry!(BreakdownEntry);

impl Entry for SpinLossEntry {
    const TYPE: &'static str = "spin_loss";
    const MEANING: &'static str = "Losses without load: in every gear state, neutral included, also towed.";

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).at(&self.gears)
    }
}

register_entry!(SpinLossEntry);

impl Entry for TemperatureSweepEntry {
    const TYPE: &'static str = "temperature_sweep";
    const MEANING: &'static str = "Where losses arise, over the temperature of the oil.";

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).at(&self.gear)
    }
}

register_entry!(TemperatureSweepEntry);

impl Entry for ComponentCompareEntry {
    const TYPE: &'static str = "component_compare";
    const MEANING: &'static str = "Several models of one component over speed.";

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_set)
            .at(&self.gear)
            .with("measured", self.measured.as_ref())
    }
}

register_entry!(ComponentCompareEntry);

impl Entry for ContactPathEntry {
    const TYPE: &'static str = "contact_path";
    const MEANING: &'static str =
        "Speeds, load, pressure, friction, film and loss along the path of contact of one mesh.";

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).at(&self.gear)
    }
}

register_entry!(ContactPathEntry);

impl Entry for OperatingPointsEntry {
    const TYPE: &'static str = "operating_points";
    const MEANING: &'static str =
        "Losses of a list of operating points from a file, as stacked bars, with room for what was measured.";

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets)
            .at(&self.gear)
            .bind(&self.bind)
            .with("data", Some(&self.data))
    }
}

register_entry!(OperatingPointsEntry);

impl Entry for ThermalLimitEntry {
    const TYPE: &'static str = "thermal_limit";
    const MEANING: &'static str = "The torque, or the speed, at which the balance reaches a given temperature.";

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).at(&self.gear)
    }
}

register_entry!(ThermalLimitEntry);

impl Entry for SweepEntry {
    const TYPE: &'static str = "sweep";
    const MEANING: &'static str = "Losses and efficiency over the values of one path, or of two.";

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).at(&self.gear)
    }
}

register_entry!(SweepEntry);

impl Entry for TournamentEntry {
    const TYPE: &'static str = "tournament";
    const MEANING: &'static str = "Every combination of models, ranked by a measurement.";

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.grid.as_ref(),
            ..Uses::new(self.gearbox.as_ref(), &self.model_set)
                .at(&self.gear)
                .with("data", self.data.as_ref())
        }
    }
}

register_entry!(TournamentEntry);

impl Entry for UncertaintyEntry {
    const TYPE: &'static str = "uncertainty";
    const MEANING: &'static str = "Bands of efficiency, loss and temperature from uncertain inputs.";

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: Some(&self.grid),
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
        }
    }
}

register_entry!(UncertaintyEntry);

impl Entry for SensitivityEntry {
    const TYPE: &'static str = "sensitivity";
    const MEANING: &'static str = "What the losses depend on: slopes, screening, shares of the variance.";

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: Some(&self.grid),
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
        }
    }
}

register_entry!(SensitivityEntry);

impl Entry for RmsSurfaceEntry {
    const TYPE: &'static str = "rms_surface";
    const MEANING: &'static str = "How well models meet a measurement over two quantities of the gearbox.";

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.against)
            .at(&self.gear)
            .bind(&self.bind)
            .with("data", Some(&self.data))
    }
}

register_entry!(RmsSurfaceEntry);

impl Entry for CycleAnalysisEntry {
    const TYPE: &'static str = "cycle";
    const MEANING: &'static str = "Losses, energies and temperatures of duties, such as driving cycles.";

    fn uses(&self) -> Uses<'_> {
        Uses::driving(&self.drive)
    }
}

register_entry!(CycleAnalysisEntry);

impl Entry for FluidSweepEntry {
    const TYPE: &'static str = "fluid_sweep";
    const MEANING: &'static str = "Mean losses of duties over one property of an oil, and where they are least.";

    fn uses(&self) -> Uses<'_> {
        Uses::driving(&self.drive)
    }
}

register_entry!(FluidSweepEntry);
