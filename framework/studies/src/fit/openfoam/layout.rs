//! Which numbers of a line are moments: decided by the comments at the top of a file and by its name, never by the number of columns
//! alone, because files of forces have as many columns as files of moments.

/// What the vectors of a file are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Content {
    /// Forces only: `force.dat`.
    Forces,
    /// Moments only: `moment.dat`.
    Moments,
    /// Forces, then moments: `forces.dat`.
    Both,
}

/// Axes of the moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// Axes of the mesh.
    Global,
    /// Axes of the coordinate system that the function object states.
    Local,
}

/// One vector of a line.
#[derive(Debug, Clone, PartialEq)]
struct Vector {
    /// `forces`, `moment`, `localForces`, `localMoment`, in lower case; empty where the whole file has one quantity.
    quantity: String,
    /// `total`, `pressure`, `viscous`, `porous`, in lower case.
    part: String,
}

/// The comments at the top of a file and its name.
#[derive(Debug, Clone, Default)]
pub(super) struct Heading {
    content: Option<Content>,
    /// The moments are in local axes by the name of the file.
    local: bool,
    vectors: Vec<Vector>,
}

/// Why a line has no moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoMoments {
    /// The file has forces.
    Forces,
    /// Neither comments nor name say what it has.
    Unknown,
    /// It has no moments in these axes.
    Axes(Frame),
    /// The line has another number of numbers than the format.
    Count(&'static str),
    /// The line has another number of numbers than the heading.
    Heading(usize),
}

impl Heading {
    /// What the name of a file says: `moment.dat`, `force_0.5.dat`, `forces.dat`, `localMoment.dat`.
    pub fn of_name(name: &str) -> Self {
        let stem = name.split(['.', '_']).next().unwrap_or_default().to_lowercase();
        let (local, stem) = match stem.strip_prefix("local") {
            Some(stem) => (true, stem),
            None => (false, stem.as_str()),
        };
        Self {
            content: content(stem),
            local,
            vectors: Vec::new(),
        }
    }

    /// Takes a comment: a title such as `# Moment`, or the names of the columns after `# Time`.
    pub fn take(&mut self, comment: &str) {
        let text = comment.trim_start_matches('#').trim();
        let mut words = text.split_whitespace();
        let first = words.next().unwrap_or_default().to_lowercase();
        if first == "time" {
            self.vectors = vectors(text.get(4..).unwrap_or_default());
        } else if words.next().is_none()
            && let Some(content) = content(&first)
        {
            self.content = Some(content);
        }
    }

    /// Places of the pressure and the viscous moment in a line with so many numbers. `nested` marks a line with double parentheses.
    pub fn places(&self, count: usize, nested: bool, frame: Frame) -> Result<[usize; 2], NoMoments> {
        let named = self.vectors.iter().any(|vector| !vector.quantity.is_empty());
        if named {
            let wanted = if frame == Frame::Local { "localmoment" } else { "moment" };
            return self.named(count, wanted).ok_or(NoMoments::Axes(frame))?;
        }
        match self.content {
            _ if nested => {}
            Some(Content::Moments) if !self.vectors.is_empty() => {
                self.of_frame(frame)?;
                return self.named(count, "").ok_or(NoMoments::Unknown)?;
            }
            Some(Content::Moments) => {
                self.of_frame(frame)?;
                return match count {
                    10 | 13 => Ok([4, 7]),
                    _ => Err(NoMoments::Count("10 or 13")),
                };
            }
            Some(Content::Forces) => return Err(NoMoments::Forces),
            Some(Content::Both) => {}
            None => return Err(NoMoments::Unknown),
        }
        // Forces and moments by pressure and viscous, or by pressure, viscous and porous; then the same in local axes.
        let global = match count {
            13 | 25 => 7,
            19 | 37 => 10,
            _ => return Err(NoMoments::Count("13, 19, 25 or 37")),
        };
        match (frame, count) {
            (Frame::Global, _) => Ok([global, global + 3]),
            (Frame::Local, 25 | 37) => {
                let local = global + (count - 1) / 2;
                Ok([local, local + 3])
            }
            (Frame::Local, _) => Err(NoMoments::Axes(frame)),
        }
    }

    /// A file of moments has one frame only; before 2021 its name says which.
    fn of_frame(&self, frame: Frame) -> Result<(), NoMoments> {
        if self.local && frame == Frame::Global {
            return Err(NoMoments::Axes(frame));
        }
        Ok(())
    }

    /// Places by the names of the columns.
    fn named(&self, count: usize, quantity: &str) -> Option<Result<[usize; 2], NoMoments>> {
        let place = |part: &str| {
            let of_part = |vector: &Vector| vector.part == part && vector.quantity.trim_end_matches('s') == quantity;
            self.vectors.iter().position(of_part)
        };
        let [pressure, viscous] = [place("pressure")?, place("viscous")?];
        let all = 1 + 3 * self.vectors.len();
        Some(if count == all {
            Ok([1 + 3 * pressure, 1 + 3 * viscous])
        } else {
            Err(NoMoments::Heading(all))
        })
    }
}

/// What a title or the name of a file stands for.
fn content(word: &str) -> Option<Content> {
    match word {
        "moment" | "moments" => Some(Content::Moments),
        "forces" => Some(Content::Both),
        "force" => Some(Content::Forces),
        _ => None,
    }
}

/// The vectors of a heading: `forces(pressure viscous) moment(pressure viscous)`, or `total_x total_y total_z pressure_x ...` with or
/// without parentheses. Empty if it is neither.
fn vectors(text: &str) -> Vec<Vector> {
    let mut all = Vec::new();
    let mut rest = text.trim();
    while let Some((name, tail)) = rest.split_once('(') {
        let Some((inside, tail)) = tail.split_once(')') else {
            return Vec::new();
        };
        let name = name.trim().to_lowercase();
        let words = inside.split([' ', ',', '\t']).filter(|word| !word.is_empty());
        if name.is_empty() {
            all.extend(words.map(|word| (String::new(), word.to_lowercase())));
        } else {
            all.extend(words.map(|word| (name.clone(), word.to_lowercase())));
        }
        rest = tail.trim();
    }
    all.extend(rest.split_whitespace().map(|word| (String::new(), word.to_lowercase())));
    let components: Vec<Vector> = all
        .iter()
        .filter_map(|(quantity, word)| match word.rsplit_once('_') {
            None if !quantity.is_empty() => Some((quantity, word.as_str())),
            Some((part, "x")) => Some((quantity, part)),
            _ => None,
        })
        .map(|(quantity, part)| Vector {
            quantity: quantity.clone(),
            part: part.to_owned(),
        })
        .collect();
    // Every component of each vector has a name, or none has.
    let flat = all.iter().filter(|(quantity, _)| quantity.is_empty()).count();
    let of_flat = components.iter().filter(|vector| vector.quantity.is_empty()).count();
    if flat == 3 * of_flat { components } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn heading(name: &str, comments: &[&str]) -> Heading {
        let mut heading = Heading::of_name(name);
        for comment in comments {
            heading.take(comment);
        }
        heading
    }

    const FLAT: &str = "# Time total_x total_y total_z pressure_x pressure_y pressure_z viscous_x viscous_y viscous_z";

    #[test]
    fn title_and_name_decide_what_a_file_has() {
        let places = |name: &str, comments: &[&str]| heading(name, comments).places(10, false, Frame::Global);
        assert_eq!(places("moment.dat", &["# Moment", FLAT]), Ok([4, 7]));
        assert_eq!(places("moment_0.5.dat", &[FLAT]), Ok([4, 7]));
        assert_eq!(places("moment.dat", &[]), Ok([4, 7]));
        assert_eq!(places("force.dat", &["# Force", FLAT]), Err(NoMoments::Forces));
        assert_eq!(places("force_0.5.dat", &[]), Err(NoMoments::Forces));
        // The title is nearer to the numbers than the name.
        assert_eq!(places("moment.dat", &["# Force", FLAT]), Err(NoMoments::Forces));
        assert_eq!(places("copy.dat", &["# Moment", FLAT]), Ok([4, 7]));
        assert_eq!(places("copy.dat", &[FLAT]), Err(NoMoments::Unknown));
    }

    #[test]
    fn local_axes_are_taken_only_when_stated() {
        let both = "# Time forces(pressure viscous) moment(pressure viscous) localForces(pressure viscous) localMoments(pressure viscous)";
        let heading = heading("forces.dat", &[both]);
        assert_eq!(heading.places(25, true, Frame::Global), Ok([7, 10]));
        assert_eq!(heading.places(25, true, Frame::Local), Ok([19, 22]));
        assert_eq!(heading.places(13, true, Frame::Global), Err(NoMoments::Heading(25)));
        let bare = Heading::of_name("forces.dat");
        assert_eq!(bare.places(37, true, Frame::Global), Ok([10, 13]));
        assert_eq!(bare.places(37, true, Frame::Local), Ok([28, 31]));
        assert_eq!(bare.places(19, true, Frame::Local), Err(NoMoments::Axes(Frame::Local)));
        let local = Heading::of_name("localMoment.dat");
        assert_eq!(local.places(10, false, Frame::Local), Ok([4, 7]));
        assert_eq!(
            local.places(10, false, Frame::Global),
            Err(NoMoments::Axes(Frame::Global))
        );
    }

    #[test]
    fn columns_are_found_by_name() {
        let heading = heading(
            "moment.dat",
            &[
                "# Moment",
                "# Time (viscous_x viscous_y viscous_z) (pressure_x pressure_y pressure_z)",
            ],
        );
        assert_eq!(heading.places(7, false, Frame::Global), Ok([4, 1]));
    }
}
