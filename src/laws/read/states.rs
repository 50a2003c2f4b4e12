//! The memory of a law: `state.NAME` with its rate, start and unit, or what it follows.

use super::{LawError, Reader, Used, refuse};
use crate::laws::Dimension;
use crate::laws::law::{Memory, StateTrees};
use crate::laws::table::StateTable;
use crate::laws::tree::Node;
use crate::laws::units::{Unit, said};

impl Reader<'_> {
    /// Rate, start, and what it follows.
    pub(super) fn state(
        &self,
        name: &str,
        table: &StateTable,
        used: &mut Used,
    ) -> Result<(StateTrees, Unit), LawError> {
        let given = [&table.rate, &table.greatest, &table.play_of].into_iter().flatten().count();
        if given != 1 {
            return Err(refuse(
                format!("state.{name}: exactly one of rate, greatest and play_of is needed"),
                format!(
                    "write state.{name} = {{ rate = \"(elongation_m - {name}) / tau_s\", start = \"elongation_m\" }}"
                ),
            ));
        }
        if table.play_of.is_some() != table.width.is_some() {
            let remedy = format!("write state.{name} = {{ play_of = \"plunger_m\", width = \"width_m\" }}");
            return Err(refuse(format!("state.{name}: play_of and width go together"), remedy));
        }
        let mut part = |key: &str, text: &Option<String>| match text {
            Some(text) => self.tree(&format!("state.{name}.{key}"), text, used),
            None => Ok(Node::number(0.0)),
        };
        let rate = part("rate", &table.rate)?;
        let greatest = part("greatest", &table.greatest)?;
        let play = part("play_of", &table.play_of)?;
        let width = part("width", &table.width)?;
        let start = part("start", &table.start)?;
        let follows = if table.greatest.is_some() { greatest } else { play };
        let unit = self.unit_of_state(name, table, (&start, &follows), used)?;
        Ok((StateTrees { rate, start, follows, width }, unit))
    }

    /// As said, as the name ends, as what it starts from or follows; else it is open.
    fn unit_of_state(
        &self,
        name: &str,
        table: &StateTable,
        (start, follows): (&Node, &Node),
        used: &Used,
    ) -> Result<Unit, LawError> {
        if let Some(text) = &table.unit {
            let unit = Dimension::parse(text).map_err(|e| refuse(format!("state.{name}.unit: {e}"), "use SI units"))?;
            return Ok(Unit::Known(unit));
        }
        if let Some(unit) = Dimension::of_name(name) {
            return Ok(Unit::Known(unit));
        }
        let open = vec![Unit::Open; self.states.len()];
        let told = |node: &Node| self.unit(node, used, &open).ok().filter(|u| matches!(u, Unit::Known(_)));
        let by_start = table.start.as_ref().and_then(|_| told(start));
        Ok(by_start.or_else(|| told(follows)).unwrap_or(Unit::Open))
    }

    /// Whether the units of its parts come out.
    pub(super) fn check_state(
        &self,
        name: &str,
        tree: &StateTrees,
        used: &Used,
        units: &[Unit],
    ) -> Result<(), LawError> {
        let own = units[self.states.iter().position(|(s, _)| *s == name).unwrap_or(0)];
        let second = Dimension::of_name("x_s").unwrap_or(Dimension::NONE);
        for (key, part, per_second) in
            [("rate", &tree.rate, true), ("start", &tree.start, false), ("width", &tree.width, false)]
        {
            let key = format!("state.{name}.{key}");
            let unit = self.unit(part, used, units).map_err(|e| self.wrong_unit(&key, &e))?;
            let Unit::Known(own) = own else { continue };
            let wanted = if per_second { own / second } else { own };
            if !unit.can_be(wanted) {
                return Err(self.wrong_unit(&key, &format!("{wanted} is wanted, the expression is in {}", said(unit))));
            }
        }
        let follows =
            self.unit(&tree.follows, used, units).map_err(|e| self.wrong_unit(&format!("state.{name}"), &e))?;
        match (own, follows) {
            (Unit::Known(own), follows) if !follows.can_be(own) => Err(self.wrong_unit(
                &format!("state.{name}"),
                &format!("it is in {own}, what it follows in {}", said(follows)),
            )),
            _ => Ok(()),
        }
    }
}

/// How it remembers.
pub(super) fn memory(table: &StateTable) -> Memory {
    match (&table.rate, &table.greatest) {
        (Some(_), _) => Memory::Rate,
        (None, Some(_)) => Memory::Greatest,
        (None, None) => Memory::Play,
    }
}
