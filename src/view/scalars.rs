//! Channels, joint coordinates, laws and energies over time.

use std::collections::BTreeMap;

use rerun::{EntityPath, RecordingStream, Scalars, SeriesLines};

use super::channels::{groups, label};
use super::colour::{Rgb, opaque, series};
use super::error::ViewError;
use super::layer::{Layer, path, time_column, times};
use crate::system::observe::{Frame, JointGraph, LawGraph, SceneGraph};

/// One line of a plot.
struct Line {
    entity: EntityPath,
    name: String,
    /// Place in its plot, which gives its colour.
    place: usize,
    channel: usize,
}

/// Every channel under the plot of its quantity and unit.
pub(super) struct Channels {
    lines: Vec<Line>,
}

impl Channels {
    pub(super) fn new(graph: &SceneGraph) -> Self {
        let line = |key: &str, place: usize, channel: usize| Line {
            entity: path(["plots", key, &graph.channels[channel]]),
            name: label(&graph.channels[channel]),
            place,
            channel,
        };
        let lines = groups(&graph.channels).into_iter().flat_map(|group| {
            let members = group.members.into_iter().enumerate();
            members.map(|(place, channel)| line(&group.key, place, channel)).collect::<Vec<_>>()
        });
        Channels { lines: lines.collect() }
    }
}

impl Layer for Channels {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        for line in &self.lines {
            style(out, &line.entity, &line.name, line.place)?;
        }
        Ok(())
    }

    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        for line in &self.lines {
            let values = frames.iter().map(|frame| frame.channels[line.channel]);
            let columns = Scalars::new(values).columns_of_unit_batches()?;
            out.send_columns(line.entity.clone(), [times(frames)], columns)?;
        }
        Ok(())
    }
}

/// Joint coordinates under `joints/<n>`, in the mechanism's order, starting at 1: degrees, of sliders mm.
pub(super) struct Joints {
    joints: Vec<JointGraph>,
}

impl Joints {
    pub(super) fn new(graph: &SceneGraph) -> Self {
        Self { joints: graph.joints.clone() }
    }
}

fn joint_entity(index: usize) -> EntityPath {
    path(["joints", &format!("{:02}", index + 1)])
}

impl Layer for Joints {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        for (i, joint) in self.joints.iter().enumerate() {
            style(out, &joint_entity(i), &format!("{} ({})", joint.name, joint.unit()), i)?;
        }
        Ok(())
    }

    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        for (i, joint) in self.joints.iter().enumerate() {
            let values = frames.iter().map(|frame| joint.shown(frame.joint_positions[i]));
            let columns = Scalars::new(values).columns_of_unit_batches()?;
            out.send_columns(joint_entity(i), [times(frames)], columns)?;
        }
        Ok(())
    }
}

/// Laws under `laws/<name>`, in the SI unit of their port.
pub(super) struct Laws {
    laws: Vec<LawGraph>,
}

impl Laws {
    pub(super) fn new(graph: &SceneGraph) -> Self {
        Self { laws: graph.laws.clone() }
    }
}

/// Entity of a law's value over time.
pub(super) fn law_entity(law: &LawGraph) -> EntityPath {
    path(["laws", &law.name])
}

impl Layer for Laws {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        for (i, law) in self.laws.iter().enumerate() {
            style(out, &law_entity(law), &law.text, i)?;
        }
        Ok(())
    }

    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        for (i, law) in self.laws.iter().enumerate() {
            let values = frames.iter().map(|frame| frame.laws[i].value);
            let columns = Scalars::new(values).columns_of_unit_batches()?;
            out.send_columns(law_entity(law), [times(frames)], columns)?;
        }
        Ok(())
    }
}

/// Energies under `energy/<name>`, J; a name may come and go.
#[derive(Default)]
pub(super) struct Energies {
    styled: Vec<String>,
}

impl Layer for Energies {
    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        let mut lines: BTreeMap<&str, (Vec<f64>, Vec<f64>)> = BTreeMap::new();
        for frame in frames {
            for (name, energy_j) in &frame.energy_j {
                let (times_s, values) = lines.entry(name).or_default();
                times_s.push(frame.time_s);
                values.push(*energy_j);
            }
        }
        for (name, (times_s, values)) in lines {
            let entity = path(["energy", name]);
            if !self.styled.iter().any(|styled| styled == name) {
                style(out, &entity, &name.replace('_', " "), self.styled.len())?;
                self.styled.push(name.to_owned());
            }
            let columns = Scalars::new(values).columns_of_unit_batches()?;
            out.send_columns(entity, [time_column(times_s)], columns)?;
        }
        Ok(())
    }
}

fn style(out: &RecordingStream, entity: &EntityPath, name: &str, place: usize) -> Result<(), ViewError> {
    named_line(out, entity, name, series(place), 2.0)
}

/// Name, colour and width (ui points) of a line.
pub(super) fn named_line(
    out: &RecordingStream,
    entity: &EntityPath,
    name: &str,
    colour: Rgb,
    width: f32,
) -> Result<(), ViewError> {
    let lines = SeriesLines::new().with_names([name]).with_colors([opaque(colour)]).with_widths([width]);
    out.log_static(entity.clone(), &lines)?;
    Ok(())
}
