//! Views in rows, columns and tabs, logged as a blueprint.
//!
//! Rerun's own blueprint API sets no view properties (camera, axes, legends), so the archetypes
//! behind it are logged here one by one.

use rerun::blueprint::components::{ColumnShare, ContainerKind, IncludedContent, QueryExpression};
use rerun::blueprint::components::{RootContainer, RowShare, ViewClass};
use rerun::datatypes::{Float32, Uuid};
use rerun::external::re_sdk_types::blueprint::archetypes::{ContainerBlueprint, ViewBlueprint, ViewContents};
use rerun::{AsComponents, RecordingStream, RecordingStreamResult};

/// Kinds of views, by Rerun's names for them.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Space,
    Plane,
    Series,
    States,
    Log,
    Document,
}

/// One view.
pub(super) struct View {
    pub(super) kind: Kind,
    pub(super) title: String,
    /// Entities shown: this one and all below it; also the view's origin.
    pub(super) origin: String,
    /// Archetype's short name and its value.
    pub(super) properties: Vec<(&'static str, Box<dyn AsComponents>)>,
}

/// A view, or panes with their shares of the room.
pub(super) enum Pane {
    View(View),
    Row(Vec<(f32, Pane)>),
    Column(Vec<(f32, Pane)>),
    Tabs(Vec<Pane>),
}

/// Writes panes into a blueprint stream, numbering them.
pub(super) struct Writer<'a> {
    out: &'a RecordingStream,
    count: u128,
}

impl Kind {
    fn class(self) -> &'static str {
        match self {
            Kind::Space => "3D",
            Kind::Plane => "2D",
            Kind::Series => "TimeSeries",
            Kind::States => "StateTimeline",
            Kind::Log => "TextLog",
            Kind::Document => "TextDocument",
        }
    }
}

impl<'a> Writer<'a> {
    pub(super) fn new(out: &'a RecordingStream) -> Self {
        Writer { out, count: 0 }
    }

    /// Logs a pane and all within; returns the container to use as the root.
    pub(super) fn root(&mut self, pane: Pane) -> RecordingStreamResult<RootContainer> {
        let shared = match pane {
            Pane::View(_) => Pane::Tabs(vec![pane]),
            other => other,
        };
        self.pane(shared)?;
        Ok(RootContainer(Uuid { bytes: self.count.to_be_bytes() }))
    }

    fn pane(&mut self, pane: Pane) -> RecordingStreamResult<String> {
        match pane {
            Pane::View(view) => self.view(&view),
            Pane::Row(panes) => self.container(ContainerKind::Horizontal, panes),
            Pane::Column(panes) => self.container(ContainerKind::Vertical, panes),
            Pane::Tabs(panes) => {
                let even = panes.into_iter().map(|pane| (1.0, pane)).collect();
                self.container(ContainerKind::Tabs, even)
            }
        }
    }

    fn container(&mut self, kind: ContainerKind, panes: Vec<(f32, Pane)>) -> RecordingStreamResult<String> {
        let (mut shares, mut paths) = (Vec::new(), Vec::new());
        for (share, pane) in panes {
            shares.push(share);
            paths.push(self.pane(pane)?);
        }
        let contents = paths.iter().map(|path| IncludedContent(path.as_str().into()));
        let container = ContainerBlueprint::new(kind)
            .with_contents(contents)
            .with_col_shares(shares.iter().map(|share| ColumnShare(Float32(*share))))
            .with_row_shares(shares.iter().map(|share| RowShare(Float32(*share))));
        let path = format!("container/{}", self.next_id());
        self.out.log(path.as_str(), &container)?;
        Ok(path)
    }

    fn view(&mut self, view: &View) -> RecordingStreamResult<String> {
        let path = format!("view/{}", self.next_id());
        let blueprint = ViewBlueprint::new(ViewClass(view.kind.class().into()))
            .with_display_name(view.title.as_str())
            .with_space_origin(view.origin.as_str());
        self.out.log(path.as_str(), &blueprint)?;
        let query = QueryExpression("$origin/**".into());
        self.out.log(format!("{path}/ViewContents"), &ViewContents::new([query]))?;
        for (name, value) in &view.properties {
            self.out.log(format!("{path}/{name}"), value.as_ref())?;
        }
        Ok(path)
    }

    /// Numbers of their own rather than random ones: the same scene gives the same blueprint.
    fn next_id(&mut self) -> String {
        self.count += 1;
        let hex = format!("{:032x}", self.count);
        format!("{}-{}-{}-{}-{}", &hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..])
    }
}
