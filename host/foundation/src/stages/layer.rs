//! The layer of a `tracing` subscriber that listens to stages.

use super::span::TARGET;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Level, Metadata, Subscriber};
use tracing_subscriber::layer::{Context, Layer, SubscriberExt};
use tracing_subscriber::registry::LookupSpan;

/// What is told of stages. An `id` is that of one stage, as long as it is open.
#[derive(Clone, Debug, PartialEq)]
pub enum StageEvent {
    /// A stage, or a part of one, began in the thread that tells so.
    Begin {
        /// Its own.
        id: u64,
        /// That of the innermost stage within which it is.
        parent: Option<u64>,
        /// What is done, such as `rendering`.
        name: &'static str,
        /// All that is to be done, in `unit`; 0 where that is not known.
        all: f64,
        /// What is counted, such as `samples`.
        unit: String,
        /// Whether the stages within it are its own affair.
        is_opaque: bool,
        /// The number of a part, such as that of a row; none for a stage.
        part: Option<u64>,
    },
    /// More of a stage is done; in any thread.
    Progress {
        /// That of the stage.
        id: u64,
        /// How much, in the unit of the stage.
        done: f64,
    },
    /// A stage has ended.
    End {
        /// That of the stage.
        id: u64,
    },
}

/// Listens to stages.
pub struct StageLayer<F> {
    observer: F,
    has_parts: bool,
}

impl<F: Fn(StageEvent) + Send + Sync + 'static> StageLayer<F> {
    /// A layer that tells an observer, which is called from the threads that work.
    ///
    /// - `has_parts`: whether it is told of parts of stages, of which there are many, too.
    pub fn new(observer: F, has_parts: bool) -> StageLayer<F> {
        StageLayer { observer, has_parts }
    }

    /// The layer with the filter that it needs beside others.
    pub fn filtered<S: Subscriber + for<'a> LookupSpan<'a>>(self) -> impl Layer<S> {
        let most = if self.has_parts { Level::DEBUG } else { Level::INFO };
        self.with_filter(tracing_subscriber::filter::Targets::new().with_target(TARGET, most))
    }
}

impl<S: Subscriber + for<'a> LookupSpan<'a>, F: Fn(StageEvent) + Send + Sync + 'static> Layer<S> for StageLayer<F> {
    fn on_new_span(&self, attributes: &Attributes<'_>, id: &Id, context: Context<'_, S>) {
        let mut fields = StageFields::default();
        attributes.record(&mut fields);
        let is_stage = |metadata: &Metadata<'_>| metadata.target() == TARGET && *metadata.level() == Level::INFO;
        let outer = context.span(id).and_then(|span| span.scope().skip(1).find(|outer| is_stage(outer.metadata())));
        let parent = outer.map(|outer| outer.id().into_u64());
        let name = attributes.metadata().name();
        let StageFields { all, unit, is_opaque, part, .. } = fields;
        (self.observer)(StageEvent::Begin { id: id.into_u64(), parent, name, all, unit, is_opaque, part });
    }

    fn on_record(&self, id: &Id, values: &Record<'_>, _: Context<'_, S>) {
        let mut fields = StageFields::default();
        values.record(&mut fields);
        if let Some(done) = fields.done {
            (self.observer)(StageEvent::Progress { id: id.into_u64(), done });
        }
    }

    fn on_close(&self, id: Id, _: Context<'_, S>) {
        (self.observer)(StageEvent::End { id: id.into_u64() });
    }
}

/// Does work, and tells an observer of its stages. Within it, nothing else that listens to `tracing` is told.
pub fn observed<T>(observer: impl Fn(StageEvent) + Send + Sync + 'static, work: impl FnOnce() -> T) -> T {
    let layer = StageLayer::new(observer, false).filtered();
    tracing::subscriber::with_default(tracing_subscriber::registry().with(layer), work)
}

/// The fields of the span of a stage.
#[derive(Default)]
struct StageFields {
    all: f64,
    unit: String,
    is_opaque: bool,
    part: Option<u64>,
    done: Option<f64>,
}

impl Visit for StageFields {
    fn record_f64(&mut self, field: &Field, value: f64) {
        match field.name() {
            "all" => self.all = value,
            "done" => self.done = Some(value),
            _ => {}
        }
    }

    fn record_u64(&mut self, field: &Field, value: u64) {
        if field.name() == "number" {
            self.part = Some(value);
        }
    }

    fn record_bool(&mut self, field: &Field, value: bool) {
        self.is_opaque |= value && field.name() == "opaque";
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        if field.name() == "unit" {
            self.unit = value.to_owned();
        }
    }

    fn record_debug(&mut self, _: &Field, _: &dyn std::fmt::Debug) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::{Workers, stage};
    use std::sync::{Arc, Mutex};

    #[test]
    fn stages_on_worker_threads_are_within_the_stage_that_called_them() {
        let events = Arc::new(Mutex::new(Vec::new()));
        let told = events.clone();
        observed(
            move |event| told.lock().expect("no panic").push(event),
            || {
                let outer = stage!("rendering", 2.0, "samples");
                Workers::new(None).expect("threads").install(|| drop(stage!("tracing photons")));
                outer.progress(2.0);
            },
        );
        let events = std::mem::take(&mut *events.lock().expect("no panic"));
        let StageEvent::Begin { id: first, parent: None, name: "rendering", all: 2.0, .. } = events[0] else {
            panic!("{events:?}")
        };
        let StageEvent::Begin { id: second, parent: Some(parent), name: "tracing photons", .. } = events[1] else {
            panic!("{events:?}")
        };
        assert_eq!(parent, first);
        let rest = [
            StageEvent::End { id: second },
            StageEvent::Progress { id: first, done: 2.0 },
            StageEvent::End { id: first },
        ];
        assert_eq!(events[2..], rest);
    }
}
