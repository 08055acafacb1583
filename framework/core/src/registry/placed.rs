//! A placed component with its model, the unit of evaluation.

use std::any::Any;
use std::borrow::Cow;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::Value;

use super::build::Build;
use super::{Entry, from_resolved};
use crate::attach::{Attach, Common, Level, Names, Spot, State, Stiffness};
use crate::document::Diagnostic;
use crate::evaluate::{Reading, readings};
use crate::loads::{AngularRow, Carries, Induced, StaticRating};
use crate::loss::{Loss, NoteBase, Notebook, Notes, Undefined};
use crate::mechanism::{Answers, Component, Slot};
use crate::rating::{Rated, RatingSlot};
use crate::real::{Dual, Lane, Points as _};

/// Seals [`Placed`] within the framework.
pub(crate) mod sealed {
    pub trait Sealed {}
}

/// A placed component with its model. Only the framework creates it.
pub trait Placed: sealed::Sealed + Send + Sync {
    /// Loss of one copy; its model notes into the book.
    fn loss(&self, state: &State<'_>, book: &Notebook<'_>) -> Result<Loss, Undefined>;
    /// The same at several points; NaN where it is undefined.
    fn losses(&self, state: &State<'_, Lane>, book: &Notebook<'_, Lane>) -> Loss<Lane>;
    /// The same with derivatives.
    fn loss_with_derivatives(
        &self,
        state: &State<'_, Dual>,
        book: &Notebook<'_, Dual>,
    ) -> Result<Loss<Dual>, Undefined>;
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
    /// Number of the element of the oil network that its model names.
    fn supply(&self) -> Option<u16> {
        None
    }
    /// Number of the support, for components that carry load.
    fn support(&self) -> Option<u16>;
    /// Static load rating, if known.
    fn static_rating(&self) -> Option<StaticRating> {
        None
    }
    /// The loads that it can carry by its design.
    fn carries(&self) -> Carries {
        Carries::ANY
    }
    /// The thrust that a radial load induces by its design.
    fn induced(&self) -> Induced {
        Induced::None
    }
    /// How it is displaced by an axial load.
    ///
    /// # Errors
    /// Why this is not known.
    fn angular_row(&self) -> Result<AngularRow, Cow<'static, str>> {
        Err("it carries no load".into())
    }
    /// One of its stiffnesses under a radial load. \[N\]
    ///
    /// # Errors
    /// Why this is not known.
    fn stiffness(&self, _stiffness: Stiffness, _load: f64) -> Result<f64, Cow<'static, str>> {
        Err("it carries no load".into())
    }
    /// Number of its oil, if it has one only.
    fn oil(&self) -> Option<u16> {
        None
    }
    /// Radius of its lowest point over which an oil height matters; `None` if none does. \[m\]
    fn lowest(&self) -> Option<f64> {
        None
    }
    /// True if its loss may depend on the oil height at its place while rotating, which is at most a height above the datum. \[m\]
    fn reads_level(&self, _highest: f64) -> bool {
        false
    }
    /// Its name in messages, such as its designation.
    fn name(&self) -> String {
        String::new()
    }
    /// Builds a rating of its mechanism at a path, which only this component evaluates; `None` if it has no ratings.
    fn build_rating(
        &self,
        _path: &str,
        _entry: &Entry,
        _value: &Value,
        _build: &mut Build<'_>,
    ) -> Result<Option<BuiltRating>, Diagnostic> {
        Ok(None)
    }
    /// Evaluates a rating that it has built.
    fn rate(&self, _rating: &dyn Any, _state: &State<'_>, _book: &Notebook<'_>) -> Result<Rated, Undefined> {
        Ok(Rated::default())
    }
}

/// A type-erased [`RatingSlot`].
pub(crate) type BuiltRating = Box<dyn Any + Send + Sync>;

struct PlacedAs<C: Component> {
    part: Arc<C::Part>,
    seat: <C::Attachment as Attach>::Seat,
    spot: Spot,
    model: Slot<C>,
}

impl<C: Component> sealed::Sealed for PlacedAs<C> {}

impl<C: Component> PlacedAs<C> {
    #[inline(always)]
    fn answer<R: Answers>(&self, state: &State<'_, R>, book: &Notebook<'_, R>) -> Result<Loss<R>, Undefined> {
        let site = C::Attachment::site(self.seat, &self.spot, state);
        R::answer::<C>(
            &*self.model,
            &C::context(&self.part, site, book.notes(self.model.notes)),
        )
    }
}

impl<C: Component> Placed for PlacedAs<C> {
    fn loss(&self, state: &State<'_>, book: &Notebook<'_>) -> Result<Loss, Undefined> {
        self.answer(state, book)
    }
    fn losses(&self, state: &State<'_, Lane>, book: &Notebook<'_, Lane>) -> Loss<Lane> {
        let answer = Lane::wide(
            #[inline(always)]
            || self.answer(state, book),
        );
        // Undefined points are NaN.
        answer.unwrap_or(Loss::POWERS)
    }
    fn loss_with_derivatives(
        &self,
        state: &State<'_, Dual>,
        book: &Notebook<'_, Dual>,
    ) -> Result<Loss<Dual>, Undefined> {
        self.answer(state, book)
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
    fn supply(&self) -> Option<u16> {
        self.spot.supply
    }
    fn support(&self) -> Option<u16> {
        C::Attachment::support(self.seat)
    }
    fn static_rating(&self) -> Option<StaticRating> {
        C::static_rating(&self.part)
    }
    fn carries(&self) -> Carries {
        C::carries(&self.part)
    }
    fn induced(&self) -> Induced {
        C::induced(&self.part)
    }
    fn angular_row(&self) -> Result<AngularRow, Cow<'static, str>> {
        C::angular_row(&self.part)
    }
    fn stiffness(&self, stiffness: Stiffness, load: f64) -> Result<f64, Cow<'static, str>> {
        C::stiffness(&self.part, stiffness, load)
    }
    fn oil(&self) -> Option<u16> {
        Some(self.spot.oil)
    }
    fn lowest(&self) -> Option<f64> {
        C::lowest(&self.part)
    }
    fn reads_level(&self, highest: f64) -> bool {
        let (
            Level::Sump {
                height, slope, orbit, ..
            },
            Some(lowest),
        ) = (self.spot.level, C::lowest(&self.part))
        else {
            return false;
        };
        !self.model.off && (highest - height) * slope + orbit + lowest > 0.0
    }
    fn name(&self) -> String {
        C::name(&self.part)
    }
    fn build_rating(
        &self,
        path: &str,
        entry: &Entry,
        value: &Value,
        build: &mut Build<'_>,
    ) -> Result<Option<BuiltRating>, Diagnostic> {
        Ok(Some(Box::new(build.rating::<C>(path, &self.part, entry, value)?)))
    }
    fn rate(&self, rating: &dyn Any, state: &State<'_>, book: &Notebook<'_>) -> Result<Rated, Undefined> {
        // Another component's rating would be a bug; it rates nothing.
        let Some(slot) = rating.downcast_ref::<RatingSlot<C>>() else {
            return Ok(Rated::default());
        };
        let site = C::Attachment::site(self.seat, &self.spot, state);
        slot.rate(&C::context(&self.part, site, book.notes(slot.notes)))
    }
}

/// A component between two members that the framework places itself, such as the lock of a differential.
pub(crate) fn place_between<C, A>(part: Arc<C::Part>, seat: A::Seat, spot: Spot, model: Slot<C>) -> Box<dyn Placed>
where
    C: Component<Attachment = A>,
    A: Attach,
{
    Box::new(PlacedAs::<C> {
        part,
        seat,
        spot,
        model,
    })
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

/// The entry of a component as read, without its model.
struct Described<C: Component> {
    place: <C::Attachment as Attach>::Place,
    common: Common,
    part: Arc<C::Part>,
}

fn place<C: Component>(
    value: &Value,
    names: &mut Names<'_>,
    build: &mut Build<'_>,
) -> Result<Option<Box<dyn Placed>>, Diagnostic> {
    let path = names.path().to_owned();
    let read = |e: serde_json::Error| Diagnostic::error(path.clone(), e.to_string());
    let kept = build.memory.get::<Arc<Described<C>>>(&path);
    let kept = kept.filter(|_| build.memory.is_same_but_model(&path)).map(Arc::clone);
    let (seat, described) = if let Some(kept) = kept {
        (C::Attachment::seat(&kept.place, names), kept)
    } else {
        let place = from_resolved(value).map_err(read)?;
        // Unknown names are reported even if the part is wrong.
        let seat = C::Attachment::seat(&place, names);
        let described = Arc::new(Described::<C> {
            place,
            common: from_resolved(value).map_err(read)?,
            part: build.part_again(&path, from_resolved(value).map_err(read)?),
        });
        build.memory.keep(&path, Arc::clone(&described));
        (seat, described)
    };
    let spot = names.spot(&described.common);
    let part = Arc::clone(&described.part);
    let model = build.slot_at::<C>(&[&path, ".model"].concat(), &part, &value["model"])?;
    let (Some(seat), Some(spot)) = (seat, spot) else {
        return Ok(None);
    };
    let supply = build.supply(&model);
    Ok(Some(Box::new(PlacedAs::<C> {
        part,
        seat,
        spot: Spot { supply, ..spot },
        model,
    })))
}
