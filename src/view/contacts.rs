//! Contacts: a point where two bodies touch and an arrow for the normal force on the second.

use rerun::{Arrows3D, Points3D, Radius, RecordingStream};

use super::colour::{CONTACT, opaque};
use super::error::ViewError;
use super::layer::{Layer, path, time_column};
use super::options::ViewOptions;
use crate::mechanism::geometry::Contact;
use crate::system::observe::Frame;

pub(super) struct Contacts {
    arrow_m_per_n: f64,
    /// The last frame sent had contacts: an empty row must end them.
    shown: bool,
}

impl Contacts {
    pub(super) fn new(options: &ViewOptions) -> Self {
        Contacts { arrow_m_per_n: options.contact_arrow_m_per_n, shown: false }
    }

    /// Frames with contacts, and the first one after them.
    fn changing<'a>(&mut self, frames: &'a [Frame]) -> Vec<&'a Frame> {
        let keep = |frame: &&Frame| {
            let touches = !frame.contacts.is_empty();
            std::mem::replace(&mut self.shown, touches) || touches
        };
        frames.iter().filter(keep).collect()
    }

    fn arrow(&self, contact: &Contact) -> [f64; 3] {
        contact.normal.map(|part| part * contact.force_n * self.arrow_m_per_n)
    }
}

impl Layer for Contacts {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        let points = Points3D::update_fields().with_colors([opaque(CONTACT)]).with_radii([Radius::new_ui_points(4.0)]);
        let arrows = Arrows3D::update_fields().with_colors([opaque(CONTACT)]).with_radii([Radius::new_ui_points(1.5)]);
        out.log_static(path(["world", "contacts", "points"]), &points)?;
        out.log_static(path(["world", "contacts", "forces"]), &arrows)?;
        Ok(())
    }

    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        let frames = self.changing(frames);
        if frames.is_empty() {
            return Ok(());
        }
        let times = time_column(frames.iter().map(|frame| frame.time_s));
        let lengths: Vec<usize> = frames.iter().map(|frame| frame.contacts.len()).collect();
        let contacts = || frames.iter().flat_map(|frame| &frame.contacts);
        let places = || contacts().map(|contact| contact.point_m);
        let points = Points3D::update_fields().with_positions(places());
        let arrows = Arrows3D::update_fields()
            .with_origins(places())
            .with_vectors(contacts().map(|contact| self.arrow(contact)));
        let entity = path(["world", "contacts", "points"]);
        out.send_columns(entity, [times.clone()], points.columns(lengths.iter().copied())?)?;
        let entity = path(["world", "contacts", "forces"]);
        out.send_columns(entity, [times], arrows.columns(lengths.iter().copied())?)?;
        Ok(())
    }
}
