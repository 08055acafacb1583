//! A placed component with its model, the unit of evaluation.

use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::Value;

use super::build::Build;
use super::from_resolved;
use crate::attach::{Attach, Common, Names, Spot, State};
use crate::document::Diagnostic;
use crate::evaluate::{Reading, readings};
use crate::lanes::{LaneNotes, LossLanes};
use crate::loads::{LoadLanes, StaticRating};
use crate::loss::{Loss, NoteBase, Notebook, Notes, Undefined};
use crate::mechanism::{Component, Slot};

/// Seals [`Placed`] within the framework.
pub(crate) mod sealed {
    pub trait Sealed {}
}

/// A placed component with its model. Only the framework creates it.
pub trait Placed: sealed::Sealed + Send + Sync {
    /// Loss of one copy; its model notes into the book.
    fn loss(&self, state: &State<'_>, book: &Notebook<'_>) -> Result<Loss, Undefined>;
    /// Batched losses of one copy at several loads of its support, with all other quantities as in the state; false if its
    /// mechanism has no batched evaluation.
    fn losses(&self, _state: &State<'_>, _loads: &LoadLanes, _book: &Notebook<'_>, _losses: &mut LossLanes) -> bool {
        false
    }
    /// Notes of its model at these loads; false if [`Placed::losses`] has no batched evaluation.
    fn note(&self, _state: &State<'_>, _loads: &LoadLanes, _notes: LaneNotes<'_>) -> bool {
        false
    }
    /// False if [`Placed::note`] writes the same notes at all loads.
    fn notes_depend_on_load(&self) -> bool {
        true
    }
    /// The context of the model at a state, one copy.
    fn readings(&self, state: &State<'_>) -> Vec<Reading>;
    /// The two members that take the reaction; `None` for the housing.
    fn between(&self) -> [Option<u16>; 2];
    /// True if the loss may depend on torque or load.
    fn loaded(&self) -> bool;
    /// True if its model is `none`.
    fn off(&self) -> bool;
    /// Position of its model's notes.
    fn notes(&self) -> NoteBase;
    /// Number of the support, for components that carry load.
    fn support(&self) -> Option<u16>;
    /// Static load rating, if known.
    fn static_rating(&self) -> Option<StaticRating> {
        None
    }
}

struct PlacedAs<C: Component> {
    part: Arc<C::Part>,
    seat: <C::Attachment as Attach>::Seat,
    spot: Spot,
    model: Slot<C>,
}

impl<C: Component> sealed::Sealed for PlacedAs<C> {}

impl<C: Component> Placed for PlacedAs<C> {
    fn loss(&self, state: &State<'_>, book: &Notebook<'_>) -> Result<Loss, Undefined> {
        let site = C::Attachment::site(self.seat, &self.spot, state);
        C::answer(&self.model, &C::context(&self.part, site, book.notes(self.model.notes)))
    }
    fn losses(&self, state: &State<'_>, loads: &LoadLanes, book: &Notebook<'_>, losses: &mut LossLanes) -> bool {
        let site = C::Attachment::site(self.seat, &self.spot, state);
        let at = C::context(&self.part, site, book.notes(self.model.notes));
        C::losses(&self.model, &at, loads, losses)
    }
    fn note(&self, state: &State<'_>, loads: &LoadLanes, notes: LaneNotes<'_>) -> bool {
        let site = C::Attachment::site(self.seat, &self.spot, state);
        C::note(&self.model, &C::context(&self.part, site, notes.all()), loads, notes)
    }
    fn notes_depend_on_load(&self) -> bool {
        C::notes_depend_on_load(&self.model)
    }
    fn readings(&self, state: &State<'_>) -> Vec<Reading> {
        let site = C::Attachment::site(self.seat, &self.spot, state);
        readings::<C>(&C::context(&self.part, site, Notes::MUTED))
    }
    fn between(&self) -> [Option<u16>; 2] {
        C::Attachment::between(self.seat)
    }
    fn loaded(&self) -> bool {
        C::Attachment::LOADED
    }
    fn off(&self) -> bool {
        self.model.off
    }
    fn notes(&self) -> NoteBase {
        self.model.notes
    }
    fn support(&self) -> Option<u16> {
        C::Attachment::support(self.seat)
    }
    fn static_rating(&self) -> Option<StaticRating> {
        C::static_rating(&self.part)
    }
}

/// A mechanism's section of the document.
#[derive(Clone, Copy)]
pub struct Section {
    /// Name of the section.
    pub name: &'static str,
    /// Schemas whose fields make up an entry: place, part, common keys.
    pub schemas: fn(&mut SchemaGenerator) -> Vec<Schema>,
    /// Places a component and builds its model. Unknown ids become findings.
    pub place: fn(&Value, &mut Names<'_>, &mut Build<'_>) -> Result<Option<Box<dyn Placed>>, Diagnostic>,
}

impl Section {
    /// The section of a component.
    pub(crate) const fn new<C: Component>() -> Self {
        Self {
            name: C::SECTION,
            schemas: |generator| {
                vec![
                    <C::Attachment as Attach>::Place::json_schema(generator),
                    C::Part::json_schema(generator),
                    Common::json_schema(generator),
                ]
            },
            place: place::<C>,
        }
    }
}

fn place<C: Component>(
    value: &Value,
    names: &mut Names<'_>,
    build: &mut Build<'_>,
) -> Result<Option<Box<dyn Placed>>, Diagnostic> {
    let path = names.path().to_owned();
    let read = |e: serde_json::Error| Diagnostic::error(path.clone(), e.to_string());
    let seat = C::Attachment::seat(&from_resolved(value).map_err(read)?, names);
    let common: Common = from_resolved(value).map_err(read)?;
    let part: Arc<C::Part> = Arc::new(from_resolved(value).map_err(read)?);
    let spot = names.spot(&common);
    let model = build.slot_at::<C>(&format!("{path}.model"), &part, &value["model"])?;
    let (Some(seat), Some(spot)) = (seat, spot) else {
        return Ok(None);
    };
    Ok(Some(Box::new(PlacedAs::<C> {
        part,
        seat,
        spot,
        model,
    })))
}
