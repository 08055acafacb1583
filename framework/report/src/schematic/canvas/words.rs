//! Labels at free positions near their owner.

use std::fmt::Write as _;

use super::{COVERED, Canvas, LETTERS, Rect, Voice, escaped, width_of};

/// A position for a label.
struct Spot {
    room: Rect,
    inside: bool,
    upright: bool,
    far: bool,
}

/// Positions for a label with their ranks, the best first.
fn spots(word: &Word) -> Vec<(f64, Spot)> {
    let o = &word.owner;
    let (w, h) = (width_of(&word.text), LETTERS + 2.0);
    let [mx, my] = o.middle();
    let mut spots: Vec<(f64, Spot)> = Vec::new();
    let mut add = |room: Rect, inside: bool, upright: bool, far: bool| {
        let spot = Spot {
            room,
            inside,
            upright,
            far,
        };
        spots.push((spots.len() as f64, spot));
    };
    if let Some(room) = word.within.filter(|room| room == o) {
        for y in [room.y[0] + 0.5 * h + 3.0, room.y[1] - 0.5 * h - 3.0] {
            if w <= room.width() && 2.0 * h <= room.height() {
                add(Rect::about(mx, y, w, h), true, false, false);
            }
        }
        for y in [room.y[0] + 0.5 * w + 3.0, room.y[1] - 0.5 * w - 3.0] {
            if h <= room.width() && w + 6.0 <= room.height() {
                add(Rect::about(mx, y, h, w), true, true, false);
            }
        }
    } else if let Some(room) = word.within {
        for y in [o.y[1] + 0.5 * h + 1.0, o.y[0] - 0.5 * h - 1.0] {
            let inside = Rect::about(mx, y, w, h);
            if inside.overlap(&room) > 0.95 * w * h {
                add(inside, true, false, false);
            }
        }
        for y in [o.y[1] + 0.5 * w + 1.0, o.y[0] - 0.5 * w - 1.0] {
            let upright = Rect::about(mx, y, h, w);
            if upright.overlap(&room) > 0.95 * w * h {
                add(upright, true, true, false);
            }
        }
    }
    let (above, below) = (o.y[0] - 0.5 * h - 2.0, o.y[1] + 0.5 * h + 2.0);
    let (left, right) = (o.x[0] - 0.5 * w - 3.0, o.x[1] + 0.5 * w + 3.0);
    if word.voice == Voice::Quiet {
        // Along the shaft.
        for share in [0.5, 0.3, 0.7, 0.1, 0.9, 0.2, 0.8, 0.4, 0.6] {
            let x = o.x[0] + share * o.width();
            add(Rect::about(x, above + 1.0, w, h), false, false, false);
            add(Rect::about(x, below - 1.0, w, h), false, false, false);
        }
    }
    for [x, y] in [
        [mx, above],
        [mx, below],
        [right, my],
        [left, my],
        [right, o.y[0] + 0.5 * h],
        [left, o.y[0] + 0.5 * h],
        [right, o.y[1] - 0.5 * h],
        [left, o.y[1] - 0.5 * h],
        [right - 0.5 * w, above],
        [left + 0.5 * w, above],
        [right - 0.5 * w, below],
        [left + 0.5 * w, below],
    ] {
        add(Rect::about(x, y, w, h), false, false, false);
    }
    for step in 1..=10 {
        let away = f64::from(step) * (h + 1.0);
        for x in [mx, mx + 0.5 * w, mx - 0.5 * w] {
            add(Rect::about(x, above - away, w, h), false, false, true);
            add(Rect::about(x, below + away, w, h), false, false, true);
        }
    }
    spots
}

pub(super) struct Word {
    pub text: String,
    pub owner: Rect,
    /// The gear in which the label may be.
    pub within: Option<Rect>,
    pub voice: Voice,
}

impl Canvas {
    /// Gives every label its best position.
    pub(in crate::schematic) fn write_words(&mut self) {
        let words = std::mem::take(&mut self.words);
        let mut taken: Vec<Rect> = Vec::new();
        for word in words {
            let cost = |(rank, spot): &(f64, Spot)| {
                let on_words: f64 = taken.iter().map(|t| t.overlap(&spot.room)).sum();
                let others = self
                    .obstacles
                    .iter()
                    .filter(|(o, _)| !(spot.inside && Some(*o) == word.within));
                let price = |price_of_thing: f64| {
                    if word.voice == Voice::Quiet {
                        price_of_thing
                    } else {
                        COVERED
                    }
                };
                let on_things: f64 = others.map(|(o, weight)| price(*weight) * o.overlap(&spot.room)).sum();
                16.0 * on_words + on_things + 5.0 * rank
            };
            let spots = spots(&word);
            let best = spots.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
            if let Some((_, spot)) = best {
                taken.push(spot.room);
                self.write_at(&word, &spot);
            }
        }
    }

    fn write_at(&mut self, word: &Word, spot: &Spot) {
        self.reach(&spot.room);
        let [x, y] = spot.room.middle();
        if spot.far {
            let [ox, oy] = word.owner.middle();
            let edge = if y < oy { word.owner.y[0] } else { word.owner.y[1] };
            let end = if y < oy { spot.room.y[1] } else { spot.room.y[0] };
            self.line(
                &[[ox, edge], [x, end]],
                "class=\"line\" fill=\"none\" stroke=\"#777\" stroke-width=\"0.7\"",
            );
        }
        let look = match word.voice {
            Voice::Plain => "fill=\"#000\"",
            Voice::Loud => "fill=\"#000\" font-weight=\"bold\"",
            Voice::Quiet => "fill=\"#555\" font-style=\"italic\"",
        };
        let turn = if spot.upright {
            format!(" transform=\"rotate(-90 {x:.2} {y:.2})\"")
        } else {
            String::new()
        };
        // The white outline makes letters readable on lines.
        let _ = writeln!(
            self.body,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"middle\" dominant-baseline=\"central\" {look} stroke=\"#fff\" \
             stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"{turn}>{}</text>",
            escaped(&word.text)
        );
    }
}
