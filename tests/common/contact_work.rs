//! How much work the friction law `ehl_mixed` does on the paths of a solved point.

use gearloss_framework::contact::path::Path;
use gearloss_framework::evaluate::Solution;
use gearloss_framework::language::Language;
use gearloss_framework::loss::Notes;
use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
use gearloss_framework::mechanism::tooth_friction::ToothFrictionModel as _;
use gearloss_framework::registry::{Build, Files};
use gearloss_framework::resolve::{Resolved, lookup};
use gearloss_framework::transmission::Transmission;
use gearloss_plugins::tooth_friction::ehl_mixed::place::{Place, Settled};
use gearloss_plugins::tooth_friction::ehl_mixed::{EhlMixed, Params};

/// The law and the path of every mesh, from the resolved document: a `path_integral` with `ehl_mixed`.
pub fn laws(language: &Language, resolved: &Resolved, t: &Transmission) -> Vec<(EhlMixed, Path)> {
    let files = Files::default();
    let build = Build::new(language.registry(), &files);
    let law = |(_, path, part): (usize, &str, &gearloss_framework::mechanism::gear_mesh::MeshPart)| {
        let model = lookup(&resolved.value, &format!("{path}.model")).unwrap();
        let mut friction = model["tooth_friction"].clone();
        friction.as_object_mut().unwrap().remove("type");
        let params: Params = serde_json::from_value(friction).unwrap();
        let factor = params.inlet_heating.factor();
        let law = EhlMixed::of_part(&params, factor, part.clone(), &build).unwrap();
        let sharing = serde_json::from_value(model["load_sharing"].clone()).unwrap();
        let path = Path::new(&part.pair, sharing, law.order()).unwrap();
        (law, path)
    };
    t.cylindrical_meshes().map(law).collect()
}

/// Ways along the path, passes over its places, and places, of each mesh; nothing of one that rests or carries nothing.
pub fn work(laws: &[(EhlMixed, Path)], solution: &Solution<'_>) -> Vec<(u32, u32, usize)> {
    let of = |(i, (law, path)): (usize, &(EhlMixed, Path))| {
        let at = solution.mesh_at(i).unwrap();
        if at.torque == 0.0 || at.speed == 0.0 {
            return (0, 0, 0);
        }
        let mean = MeanFrictionAt::at_pitch_point(&at, Notes::MUTED);
        let along = path
            .at_operating_point(&mean, Notes::MUTED)
            .with(|to| to.bodies = at.bodies().unwrap_or(None));
        let mut mu = vec![0.0; path.len()];
        let (tally, _) = law.settle(&along, &mut mu, None, None::<fn(&Place<'_>, &Settled)>);
        (tally.runs, tally.passes, path.len())
    };
    laws.iter().enumerate().map(of).collect()
}
