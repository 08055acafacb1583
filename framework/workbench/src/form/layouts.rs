//! The common layouts of gearboxes: commented templates with what their forms need to know.

/// A layout of shafts and gears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    /// Name.
    pub name: &'static str,
    /// What it is.
    pub about: &'static str,
    /// The commented gearbox.
    pub text: &'static str,
    /// Options of `gearloss solve` for a typical point.
    pub point: &'static str,
    /// A word in names of components, and the one in the names of those with the same data.
    pub(super) twins: Option<[&'static str; 2]>,
    /// Centre distances.
    pub(super) distances: &'static [Distance],
    /// Fields whose value another one takes over until its own is typed.
    pub(super) follows: &'static [(&'static str, &'static str)],
    /// Sun, planets and ring of a planetary set.
    pub(super) planetary: Option<[&'static str; 3]>,
}

/// A distance of axes, which determines their places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distance {
    /// Section of the mesh in whose group it is shown.
    pub section: &'static str,
    /// The mesh.
    pub mesh: &'static str,
    /// Key of the mesh under which it is shown: a centre distance or an offset.
    pub key: &'static str,
    /// What it is in the template. \[mm\]
    pub value: f64,
    /// Where it is written: a path, for an axis with the number of the coordinate, and how many of it are added there.
    pub cells: &'static [(&'static str, Option<usize>, f64)],
}

/// All layouts.
pub const LAYOUTS: [Layout; 9] = [
    Layout {
        name: "single-stage",
        about: "Reducer with one helical stage",
        text: include_str!("layouts/single-stage.yaml"),
        point: "--torque \"90 Nm\" --speed \"1500 rpm\"",
        twins: None,
        distances: &[Distance {
            section: "meshes",
            key: "centre_distance",
            mesh: "stage",
            value: 98.0,
            cells: &[("shafts.pinion_shaft.axis", Some(0), 1.0)],
        }],
        follows: &[],
        planetary: None,
    },
    Layout {
        name: "two-stage",
        about: "Reducer with two helical stages on parallel shafts",
        text: include_str!("layouts/two-stage.yaml"),
        point: "--torque \"45 Nm\" --speed \"1500 rpm\"",
        twins: None,
        distances: &[
            Distance {
                section: "meshes",
                key: "centre_distance",
                mesh: "first",
                value: 91.0,
                cells: &[("shafts.input.axis", Some(0), 1.0)],
            },
            Distance {
                section: "meshes",
                key: "centre_distance",
                mesh: "second",
                value: 118.0,
                cells: &[
                    ("shafts.input.axis", Some(0), 1.0),
                    ("shafts.intermediate.axis", Some(0), 1.0),
                ],
            },
        ],
        follows: &[],
        planetary: None,
    },
    Layout {
        name: "three-stage",
        about: "Reducer with three helical stages, slow shafts in pairs of tapered roller bearings",
        text: include_str!("layouts/three-stage.yaml"),
        point: "--torque \"15 Nm\" --speed \"1500 rpm\"",
        twins: None,
        distances: &[
            Distance {
                section: "meshes",
                key: "centre_distance",
                mesh: "first",
                value: 76.0,
                cells: &[("shafts.input.axis", Some(0), 1.0)],
            },
            Distance {
                section: "meshes",
                key: "centre_distance",
                mesh: "second",
                value: 101.0,
                cells: &[
                    ("shafts.input.axis", Some(0), 1.0),
                    ("shafts.second.axis", Some(0), 1.0),
                ],
            },
            Distance {
                section: "meshes",
                key: "centre_distance",
                mesh: "third",
                value: 141.0,
                cells: &[
                    ("shafts.input.axis", Some(0), 1.0),
                    ("shafts.second.axis", Some(0), 1.0),
                    ("shafts.third.axis", Some(0), 1.0),
                ],
            },
        ],
        follows: &[],
        planetary: None,
    },
    Layout {
        name: "planetary",
        about: "Planetary set: sun input, fixed ring, carrier output, planets on needle cages",
        text: include_str!("layouts/planetary.yaml"),
        point: "--gear reducing --torque \"60 Nm\" --speed \"3000 rpm\"",
        twins: None,
        distances: &[Distance {
            section: "meshes",
            key: "centre_distance",
            mesh: "sun_planet",
            value: 40.5,
            cells: &[
                ("meshes.sun_planet.centre_distance", None, 1.0),
                ("meshes.planet_ring.centre_distance", None, 1.0),
            ],
        }],
        follows: &[
            ("meshes.sun_planet.normal_module", "meshes.planet_ring.normal_module"),
            ("meshes.sun_planet.pressure_angle", "meshes.planet_ring.pressure_angle"),
        ],
        planetary: Some(["sun", "planets", "ring"]),
    },
    Layout {
        name: "two-speed",
        about: "Two speeds and neutral: idler gears on needle cages with a synchronizer",
        text: include_str!("layouts/two-speed.yaml"),
        point: "--gear first --torque \"80 Nm\" --speed \"3000 rpm\"",
        twins: None,
        distances: &[Distance {
            section: "meshes",
            key: "centre_distance",
            mesh: "M1",
            value: 100.0,
            // The input is above the output, at an angle.
            cells: &[("shafts.input.axis", Some(0), 0.8), ("shafts.input.axis", Some(1), 0.6)],
        }],
        follows: &[],
        planetary: None,
    },
    Layout {
        name: "dual-countershaft",
        about: "Two countershafts in parallel between coaxial shafts",
        text: include_str!("layouts/dual-countershaft.yaml"),
        point: "--torque \"400 Nm\" --speed \"1500 rpm\"",
        twins: Some(["left", "right"]),
        distances: &[Distance {
            section: "meshes",
            key: "centre_distance",
            mesh: "in_left",
            value: 112.5,
            cells: &[("shafts.left.axis", Some(0), -1.0), ("shafts.right.axis", Some(0), 1.0)],
        }],
        follows: &[],
        planetary: None,
    },
    Layout {
        name: "bevel-helical",
        about: "Reducer with a spiral bevel stage and a helical stage",
        text: include_str!("layouts/bevel-helical.yaml"),
        point: "--torque \"45 Nm\" --speed \"1500 rpm\"",
        twins: None,
        distances: &[Distance {
            section: "meshes",
            key: "centre_distance",
            mesh: "helical",
            value: 123.0,
            cells: &[
                ("shafts.intermediate.axis", Some(0), 1.0),
                ("shafts.input.axis.through", Some(1), 1.0),
            ],
        }],
        follows: &[],
        planetary: None,
    },
    Layout {
        name: "worm",
        about: "Worm drive with the worm below its wheel",
        text: include_str!("layouts/worm.yaml"),
        point: "--torque \"18 Nm\" --speed \"1500 rpm\"",
        twins: None,
        distances: &[Distance {
            section: "worm_meshes",
            key: "centre_distance",
            mesh: "stage",
            value: 100.0,
            cells: &[("shafts.wheel_shaft.axis.through", Some(2), 1.0)],
        }],
        follows: &[],
        planetary: None,
    },
    Layout {
        name: "axle",
        about: "Drive axle: hypoid gears, differential and half shafts",
        text: include_str!("layouts/axle.yaml"),
        point: "--torque \"150 Nm\" --speed \"1500 rpm\"",
        twins: None,
        distances: &[Distance {
            section: "bevel_meshes",
            key: "offset",
            mesh: "final",
            value: 15.0,
            cells: &[
                ("bevel_meshes.final.offset", None, 1.0),
                ("shafts.cage.axis.through", Some(2), 1.0),
                ("shafts.left_shaft.axis.through", Some(2), 1.0),
                ("shafts.right_shaft.axis.through", Some(2), 1.0),
            ],
        }],
        follows: &[],
        planetary: None,
    },
];

impl Distance {
    /// Path of its field.
    pub fn path(&self) -> String {
        format!("{}.{}.{}", self.section, self.mesh, self.key)
    }
}

impl Layout {
    /// The layout of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        LAYOUTS.iter().find(|layout| layout.name == name)
    }
}
