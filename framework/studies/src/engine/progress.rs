//! Progress of an analysis.

/// Receives progress and can interrupt an analysis.
pub trait Progress: Sync {
    /// Work of `steps` steps starts.
    fn begin(&self, label: &str, count: usize) -> Box<dyn Steps + '_>;

    /// False if the analysis must stop.
    fn should_continue(&self) -> bool;
}

/// Steps of work; the work ends when this is dropped.
pub trait Steps: Sync + Send {
    /// Further steps are done.
    fn advance(&self, count: usize);
}

/// No reports and no interruption.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: usize) -> Box<dyn Steps + '_> {
        Box::new(Self)
    }

    fn should_continue(&self) -> bool {
        true
    }
}

impl Steps for Silent {
    fn advance(&self, _: usize) {}
}

/// Work in progress.
pub struct Running<'a> {
    progress: &'a dyn Progress,
    steps: Box<dyn Steps + 'a>,
}

impl<'a> Running<'a> {
    pub(crate) fn new(progress: &'a dyn Progress, label: &str, count: usize) -> Self {
        Self {
            progress,
            steps: progress.begin(label, count),
        }
    }

    /// Further steps are done; false if the work must stop.
    pub fn advance(&self, count: usize) -> bool {
        self.steps.advance(count);
        self.progress.should_continue()
    }

    /// False if the work must stop.
    pub fn should_continue(&self) -> bool {
        self.progress.should_continue()
    }
}
