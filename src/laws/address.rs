//! Where a law of one rig acts: a port, and which element, joint or channel.

use std::fmt;

use super::port::{Carrier, Port, PortSpec};
use super::ports::PORTS;
use crate::nearest::did_you_mean;

/// What others call a term of an element.
const USUAL: [(&str, &str); 12] = [
    ("viscosity", "damping"),
    ("drag", "damping"),
    ("force", "pull"),
    ("preload", "pull"),
    ("stiffness", "wall"),
    ("elasticity", "wall"),
    ("spring", "coil"),
    ("length", "rest_length"),
    ("leak", "outflow"),
    ("slack", "stretch"),
    ("friction", "transmission"),
    ("moment", "torque"),
];

/// The nearest port to a text that is none, in words (`, did you mean "muscle_2.damping"?`): of its own element where it has one.
pub fn nearest_port(text: &str) -> String {
    let (element, term) = text.split_once('.').unwrap_or((text, ""));
    let kind = numbered(element).map_or(element, |(name, _)| name).split('(').next().unwrap_or(element);
    let all: Vec<String> = PORTS.iter().map(PortSpec::name).collect();
    let own = |term: &str| format!("{element}.{term}");
    let its = PORTS.iter().filter(|p| p.element == kind && !p.term.is_empty());
    let its: Vec<String> = its.map(|p| own(p.term)).collect();
    let usual = USUAL.iter().filter(|(word, _)| *word == term).map(|(_, right)| own(right));
    let meant = usual.into_iter().find(|name| its.contains(name)).unwrap_or_else(|| text.to_owned());
    let known = if its.is_empty() { &all } else { &its };
    did_you_mean(&meant, &known.iter().map(String::as_str).collect::<Vec<_>>())
}

/// Name and number of an element: `line_2`, also written `line2`, `line 2` or `line[2]`.
pub fn numbered(element: &str) -> Option<(&str, usize)> {
    let bracketed = element.strip_suffix(']').filter(|e| e.contains('['));
    let element = bracketed.unwrap_or(element);
    let name = element.trim_end_matches(|c: char| c.is_ascii_digit());
    let number = element[name.len()..].parse().ok()?;
    let separators: &[char] = if bracketed.is_some() { &['['] } else { &['_', ' '] };
    Some((name.strip_suffix(separators).unwrap_or(name), number))
}

/// A port of one rig: `muscle_2.friction`, `joint(pulley).torque`, `sensor.angle_deg`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Address {
    pub port: Port,
    /// Counts from 0; none means all there are.
    pub number: Option<usize>,
    /// Name of the joint or of the channel.
    pub of: Option<String>,
}

impl Address {
    /// Reads the address of a port.
    ///
    /// ```
    /// use smam::laws::{Address, Port};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let second = Address::parse("muscle_2.friction").map_err(|(message, _)| message)?;
    /// assert_eq!((second.port, second.number), (Port::Friction, Some(1)));
    /// assert_eq!(second.to_string(), "muscle_2.friction");
    /// assert!(Address::parse("muscle.frction").is_err_and(|(message, _)| message.contains("muscle.friction")));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// What is none, with the nearest that is one, and what to write instead.
    pub fn parse(text: &str) -> Result<Self, (String, String)> {
        let text = text.trim();
        let unknown = || {
            (format!("port = \"{text}\" is no port{}", nearest_port(text)), "`smam laws` lists the ports".to_owned())
        };
        let (element, term) = text.split_once('.').unwrap_or((text, ""));
        if element == "sensor" && !term.is_empty() {
            return Ok(Self { port: Port::Sensor, number: None, of: Some(term.to_owned()) });
        }
        let named = element.strip_suffix(')').and_then(|e| e.split_once('('));
        let (element, of) = named.map_or((element, None), |(e, name)| (e, Some(name.trim().to_owned())));
        let find =
            |element: &str| PORTS.iter().find(|p| p.element == element && p.term == term && p.port != Port::Sensor);
        if let Some(spec) = find(element) {
            if of.is_some() && spec.carrier != Carrier::Joint {
                let remedy = format!("number the elements of a rig that has several: {element}_1");
                return Err((format!("port = \"{text}\": only joints go by name"), remedy));
            }
            return Ok(Self { port: spec.port, number: None, of });
        }
        if let Some((name, 0)) = numbered(element).filter(|(name, _)| find(name).is_some_and(PortSpec::is_numbered)) {
            let remedy = format!("the first is {name}_1");
            return Err((format!("port = \"{text}\": elements are numbered from 1"), remedy));
        }
        let found = numbered(element).and_then(|(name, number)| Some((find(name)?, number.checked_sub(1)?)));
        match found {
            Some((spec, number)) if of.is_none() && spec.is_numbered() => {
                Ok(Self { port: spec.port, number: Some(number), of: None })
            }
            _ => Err(unknown()),
        }
    }

    /// Which of `count` elements it means; none where there is none.
    pub fn indices(&self, count: usize) -> std::ops::Range<usize> {
        self.number.map_or(0..count, |n| n.min(count)..(n + 1).min(count))
    }

    /// Name of the element that it belongs to in answers: `line_1`, `mechanism`, `sensor`.
    pub fn element(&self) -> String {
        let name = match self.port.spec().element {
            "plunger" => "syringe",
            "joint" => "mechanism",
            // As the effects of the catalogue on them.
            "axis" => "syringe",
            "strip" => "muscle",
            "chamber" => "line",
            other => other,
        };
        self.number.map_or_else(|| name.to_owned(), |n| format!("{name}_{}", n + 1))
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let spec = self.port.spec();
        f.write_str(spec.element)?;
        if let Some(number) = self.number {
            write!(f, "_{}", number + 1)?;
        }
        match (&self.of, self.port) {
            (Some(channel), Port::Sensor) => return write!(f, ".{channel}"),
            (Some(joint), _) => write!(f, "({joint})")?,
            (None, _) => {}
        }
        if spec.term.is_empty() { Ok(()) } else { write!(f, ".{}", spec.term) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_go_there_and_back() {
        for text in [
            "plunger",
            "plunger_2",
            "line.outflow",
            "line_1.pressure_drop",
            "muscle_2.rest_length",
            "joint.torque",
            "joint(notch_3).stiffness",
            "sensor.angle_deg",
        ] {
            assert_eq!(Address::parse(text).unwrap_or_else(|e| panic!("{e:?}")).to_string(), text);
        }
        for wrong in ["", "muscle", "muscle_0.friction", "muscle.speed", "joint_1.torque", "muscle(a).pull", "sensor"] {
            assert!(Address::parse(wrong).is_err(), "{wrong}");
        }
        let nought = Address::parse("muscle_0.friction").expect_err("there is none");
        assert!(nought.0.contains("numbered from 1") && nought.1.contains("muscle_1"), "{nought:?}");
        for written in ["line2.outflow", "line 2.outflow", "line[2].outflow"] {
            assert_eq!(Address::parse(written).map(|a| a.to_string()).as_deref(), Ok("line_2.outflow"), "{written}");
        }
        for wrong in ["line2].outflow", "line[2.outflow", "line-2.outflow", "line[].outflow"] {
            assert!(Address::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_nearest_port_is_one_of_the_same_element() {
        for (text, near) in [
            ("muscle_2.viscosity", "muscle_2.damping"),
            ("line.leak", "line.outflow"),
            ("cable_1.friction", "cable_1.transmission"),
            ("joint(pulley).moment", "joint(pulley).torque"),
            ("muscle.frction", "muscle.friction"),
            ("plungr", "plunger"),
        ] {
            assert_eq!(nearest_port(text), format!(", did you mean \"{near}\"?"), "{text}");
            assert!(Address::parse(near).is_ok(), "{near}");
        }
        assert_eq!(nearest_port("weather"), "");
    }
}
