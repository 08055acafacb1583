//! Pressure and film of the flanks of bevel and hypoid gears along their path of contact.
//!
//! Source: as `flank_contact`, on the flanks that carry: path, line load and radii of the virtual cylindrical gears of ISO 10300-1 annex A, speeds
//! across the line of contact of the real gears. The normal force is that without friction, which is larger. The load is even along the path by
//! default: crowned teeth have a higher pressure in its middle, by 10 % for the hypoid example of ISO/TR 10300-30.
//! These are indicators, not safety factors of ISO 10300. A flash temperature is not rated: that of hypoid flanks (ISO/TR 22849) was not readable.

use gearloss_framework::contact::sharing::{Sharing, SharingEntry};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::LoadSharing;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::bevel_mesh::{BevelMesh, BevelMeshAt};
use gearloss_framework::rating::{Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::flank_contact::{AT_PITCH, FILM, FlankContact, LAMBDA, LAMBDA_RA, PRESSURE, Prepared};

/// Hertzian pressure and film ratio of bevel and hypoid flanks.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Load sharing among pairs of teeth in contact.
    #[serde(default = "uniform")]
    pub load_sharing: LoadSharing,
    /// Film ratio lambda below which the mesh is reported; zero: never. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least_film_ratio: f64,
    /// Hertzian pressure above which the mesh is reported; default: never. [MPa]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub greatest_pressure: Option<f64>,
}

fn uniform() -> LoadSharing {
    LoadSharing::Uniform
}

/// The ratings of the drive and of the coast flanks.
struct Both([Prepared; 2]);

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Both, Diagnostic> {
    let part = cx.own_part::<BevelMesh>()?;
    let sharing = Sharing::Fixed(params.load_sharing);
    let of_flanks = |i: usize| {
        let params = FlankContact {
            load_sharing: SharingEntry::Fixed(params.load_sharing),
            film: gearloss_framework::contact::Film::default(),
            thermal: true,
            least_film_ratio: params.least_film_ratio,
            greatest_pressure: params.greatest_pressure,
            permissible_film_ratio: None,
            least_safety: 1.0,
        };
        Prepared::new(params, &part.flanks[i].pair, &sharing, None)
    };
    Ok(Both([of_flanks(0), of_flanks(1)]))
}

impl Rating<BevelMesh> for Both {
    fn rate(&self, at: &BevelMeshAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        let flank = at.flank()?;
        self.0[flank].rate_flanks(&at.on_flank(flank), to);
        Ok(())
    }
}

register_rating!(BevelMesh, "bevel_flank", Params,
    source: "Hertz 1881; Dowson and Higginson 1961; ISO 10300-1 annex A for the virtual gears",
    evidence: [
        formula(Evidence::Derived, "pressure and film of cylindrical flanks on the virtual gears"),
        default_of("load_sharing", Evidence::Assumed, "even load along the path: 10 % less pressure than the middle of crowned teeth"),
    ],
    checks: [
        Check {
            input: "{ at: { torque: 250 Nm } }",
            values: &[("p_HC", "960.698 MPa")],
            tolerance: 1e-4,
            because: "the lengths of the calculation are rounded",
            source: "calculated by hand: 15298.49 N on 33.31456 mm of contact with a radius of 17.92617 mm and a reduced modulus of 226.374 GPa",
        },
    ],
    figures: [AT_PITCH, PRESSURE, FILM, LAMBDA, LAMBDA_RA],
    prepare: prepare);
