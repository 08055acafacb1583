//! The fields of a form, from the template of its layout.

use gearloss_editor::outline::{self, Content, Node};
use serde::Serialize;

use super::bearings;
use super::layouts::Layout;
use super::materials;

/// Fields under one heading.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Group {
    /// Heading.
    pub title: String,
    /// Fields.
    pub fields: Vec<Field>,
    /// Shown on demand.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub folded: bool,
}

/// A value to be typed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Field {
    /// Path in the description.
    pub path: String,
    /// What it is.
    pub label: String,
    /// How it is typed.
    pub kind: FieldKind,
    /// Value of the template; empty if it has none and needs none.
    pub value: String,
    /// What it means.
    pub help: String,
    /// The values of a choice.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pub choices: &'static [&'static str],
    /// A value of a field that may stay empty.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub example: Option<&'static str>,
}

/// How the oil temperature is found.
pub(super) const MODE: &str = "thermal.mode";

/// How a value is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FieldKind {
    /// Any text.
    Text,
    /// A whole number.
    Integer,
    /// A number without unit.
    Number,
    /// A number with a unit.
    Quantity,
    /// Designation of a bearing.
    Bearing,
    /// Designation of an oil.
    Oil,
    /// Designation of a material.
    Material,
    /// One of several words.
    Choice,
}

/// Sections of meshes with the keys, labels and meanings of their fields.
const MESHES: [(&str, &[(&str, &str, FieldKind, &str)]); 3] = [
    (
        "bevel_meshes",
        &[
            (
                "outer_diameter",
                "Outer diameter of the wheel",
                FieldKind::Quantity,
                "of its pitch cone",
            ),
            (
                "spiral_angle",
                "Spiral angle",
                FieldKind::Quantity,
                "in the middle of the face; of hypoid gears that of the pinion",
            ),
            (
                "cutter.radius",
                "Radius of the cutter",
                FieldKind::Quantity,
                "of hypoid gears; determines the pitch cones",
            ),
        ],
    ),
    (
        "worm_meshes",
        &[
            ("module", "Axial module", FieldKind::Quantity, "of the worm"),
            (
                "worm_diameter",
                "Reference diameter",
                FieldKind::Quantity,
                "of the worm",
            ),
            ("pressure_angle", "Pressure angle", FieldKind::Quantity, ""),
        ],
    ),
    (
        "meshes",
        &[
            ("normal_module", "Normal module", FieldKind::Quantity, ""),
            ("pressure_angle", "Pressure angle", FieldKind::Quantity, ""),
            ("helix_angle", "Helix angle", FieldKind::Quantity, ""),
        ],
    ),
];

/// The value at a path of a document.
pub(super) fn at<'n>(document: &'n Node, path: &str) -> Option<&'n Node> {
    path.split('.').try_fold(document, |node, key| node.get(key))
}

/// The groups of the form of a layout.
pub(super) fn groups(layout: &Layout) -> Vec<Group> {
    let document = outline::read(layout.text, None);
    let form = Reader {
        layout,
        document: &document,
    };
    let mut groups = vec![group(
        "Gearbox",
        vec![
            form.field("title", "Title", FieldKind::Text, ""),
            form.field("rating.torque", "Maximum torque", FieldKind::Quantity, "at the input"),
            form.field("rating.speed", "Maximum speed", FieldKind::Quantity, "at the input"),
        ],
    )];
    groups.extend(form.meshes());
    groups.push(group("Planets", form.planets()));
    let bearings = form.bearings();
    let details = bearings.fields.iter().filter_map(bearings::details).collect::<Vec<_>>();
    groups.push(bearings);
    groups.extend(details);
    groups.push(group(
        "Oil",
        vec![
            form.field("lubricants.sump.designation", "Oil", FieldKind::Oil, "of the catalogue"),
            form.field("housing.oil.volume", "Volume", FieldKind::Quantity, ""),
            form.field(
                "housing.oil.level",
                "Level at standstill",
                FieldKind::Quantity,
                "above the axis that the text names; below it if negative",
            ),
            form.field(
                MODE,
                "Oil temperature is",
                FieldKind::Choice,
                "fixed: as below; balance: found from the losses and the heat that the casing gives off",
            ),
            form.field("thermal.oil", "Oil temperature", FieldKind::Quantity, "if it is fixed"),
            form.field(
                "thermal.ambient",
                "Ambient temperature",
                FieldKind::Quantity,
                "for the heat balance",
            ),
            form.field("surface.ra", "Roughness Ra of the flanks", FieldKind::Quantity, ""),
        ],
    ));
    groups.push(form.places());
    groups.retain(|group| !group.fields.is_empty());
    groups
}

/// A group of the fields whose values the template has.
fn group(title: &str, fields: Vec<Option<Field>>) -> Group {
    Group {
        title: title.to_owned(),
        fields: fields.into_iter().flatten().collect(),
        folded: false,
    }
}

struct Reader<'a> {
    layout: &'a Layout,
    document: &'a Node,
}

impl Reader<'_> {
    /// A field, if the template has its value.
    fn field(&self, path: &str, label: &str, kind: FieldKind, help: &str) -> Option<Field> {
        let value = at(self.document, path)?.text()?;
        Some(Field {
            path: path.to_owned(),
            label: label.to_owned(),
            kind,
            value: value.to_owned(),
            help: help.to_owned(),
            choices: if kind == FieldKind::Choice {
                &["fixed", "balance"]
            } else {
                &[]
            },
            example: None,
        })
    }

    /// Ids of a section without the second of twins.
    fn ids(&self, section: &str) -> Vec<&str> {
        let entries = at(self.document, section).map(Node::entries).unwrap_or_default();
        let ids = entries.iter().map(|entry| entry.key.as_str());
        let is_second = |id: &str| self.layout.twins.is_some_and(|[_, second]| id.contains(second));
        // Bearings of twins are named by their first letter.
        let is_bearing_of_second = |id: &str| {
            let shaft = at(self.document, &format!("{section}.{id}.shaft")).and_then(Node::text);
            shaft.is_some_and(is_second)
        };
        ids.filter(|id| !is_second(id) && !is_bearing_of_second(id)).collect()
    }

    fn meshes(&self) -> Vec<Group> {
        let mut shown: Vec<String> = Vec::new();
        let mut groups = Vec::new();
        let all = MESHES.iter().flat_map(|(section, keys)| {
            let ids = self.ids(section);
            ids.into_iter().map(move |mesh| (*section, *keys, mesh))
        });
        for (section, keys, mesh) in all {
            let gears = match at(self.document, &format!("{section}.{mesh}.gears")).map(|node| &node.content) {
                Some(Content::List(gears)) => gears.iter().filter_map(Node::text).collect::<Vec<_>>(),
                _ => Vec::new(),
            };
            let mut fields = Vec::new();
            let new: Vec<&str> = gears
                .iter()
                .copied()
                .filter(|gear| !shown.iter().any(|known| known == gear))
                .collect();
            for (key, label, kind) in [
                ("z", "Teeth", FieldKind::Integer),
                ("facewidth", "Face width", FieldKind::Quantity),
                ("profile_shift", "Profile shift", FieldKind::Number),
                ("tip_diameter", "Tip diameter", FieldKind::Quantity),
            ] {
                for gear in &new {
                    let help = if key == "profile_shift" {
                        "that of the mating gear follows from the centre distance"
                    } else {
                        ""
                    };
                    fields.push(self.field(
                        &format!("gears.{gear}.{key}"),
                        &format!("{label} of {gear}"),
                        kind,
                        help,
                    ));
                }
            }
            fields.extend(new.iter().map(|gear| Some(materials::field(gear))));
            shown.extend(new.iter().map(ToString::to_string));
            for (key, label, kind, help) in keys {
                fields.push(self.field(&format!("{section}.{mesh}.{key}"), label, *kind, help));
            }
            let mut known = self.layout.distances.iter();
            let known = known.find(|known| known.section == section && known.mesh == mesh);
            fields.push(known.map(|known| {
                let (label, help) = if known.key == "offset" {
                    ("Offset", "of the axes; determines their places")
                } else {
                    (
                        "Centre distance",
                        "follows from the teeth unless it is typed; determines the places of the axes",
                    )
                };
                Field {
                    path: known.path(),
                    label: label.to_owned(),
                    kind: FieldKind::Quantity,
                    value: format!("{} mm", known.value),
                    help: help.to_owned(),
                    choices: &[],
                    example: None,
                }
            }));
            groups.push(group(&format!("Mesh {mesh}: {}", gears.join(" and ")), fields));
        }
        groups
    }

    fn bearings(&self) -> Group {
        let fields = self.ids("bearings").into_iter().map(|id| {
            let shaft = at(self.document, &format!("bearings.{id}.shaft")).and_then(Node::text);
            let help = shaft.map_or_else(String::new, |shaft| format!("on shaft {shaft}"));
            let path = format!("bearings.{id}.designation");
            self.field(&path, &format!("Bearing {id}"), FieldKind::Bearing, &help)
        });
        let seals = self.ids("seals").into_iter().map(|id| {
            let path = format!("seals.{id}.diameter");
            self.field(&path, &format!("Diameter of seal {id}"), FieldKind::Quantity, "")
        });
        group("Bearings and seals", fields.chain(seals).collect())
    }

    fn planets(&self) -> Vec<Option<Field>> {
        let sets = self.ids("planetary_sets").into_iter();
        sets.flat_map(|id| {
            let set = format!("planetary_sets.{id}");
            let count = self.field(&format!("{set}.count"), "Number of planets", FieldKind::Integer, "");
            let help = "most loaded planet over the mean; 1 if all share equally";
            let sharing = self.field(
                &format!("{set}.load_sharing"),
                "Load sharing K_gamma",
                FieldKind::Number,
                help,
            );
            let sharing = sharing.map(|field| Field {
                example: Some("1.25"),
                ..field
            });
            [count, sharing]
        })
        .collect()
    }

    fn places(&self) -> Group {
        let mut fields = Vec::new();
        for (section, what) in [("gears", "gear"), ("bearings", "bearing")] {
            for id in self.ids(section) {
                let path = format!("{section}.{id}.at");
                fields.push(self.field(&path, &format!("Position of {what} {id}"), FieldKind::Quantity, ""));
            }
        }
        group("Positions along the shafts (middle of the face)", fields)
    }
}
