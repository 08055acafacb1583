//! How far an analysis has come, for whom it concerns.

/// Who is told of progress, and may break an analysis off.
pub trait Progress: Sync {
    /// Work of so many steps begins.
    fn begin(&self, label: &str, count: usize) -> Box<dyn Steps + '_>;

    /// False where the analysis shall break off.
    fn goes_on(&self) -> bool;
}

/// Steps of work; the work ends where this is dropped.
pub trait Steps: Sync + Send {
    /// So many more are done.
    fn advance(&self, count: usize);
}

/// Nobody is told, and nothing breaks off.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: usize) -> Box<dyn Steps + '_> {
        Box::new(Self)
    }

    fn goes_on(&self) -> bool {
        true
    }
}

impl Steps for Silent {
    fn advance(&self, _: usize) {}
}

/// Work that has begun.
pub struct Running<'a> {
    progress: &'a dyn Progress,
    steps: Box<dyn Steps + 'a>,
}

impl<'a> Running<'a> {
    pub(super) fn new(progress: &'a dyn Progress, label: &str, count: usize) -> Self {
        Self {
            progress,
            steps: progress.begin(label, count),
        }
    }

    /// So many more steps are done; false where the work shall break off.
    pub fn advance(&self, count: usize) -> bool {
        self.steps.advance(count);
        self.progress.goes_on()
    }

    /// False where the work shall break off.
    pub fn goes_on(&self) -> bool {
        self.progress.goes_on()
    }
}
