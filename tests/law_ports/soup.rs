//! Whatever is written as a law: an answer, never a panic.

use proptest::prelude::*;
use smam::laws::{LawTable, PORTS, Surroundings};

const TOKENS: [&str; 44] = [
    "+",
    "-",
    "*",
    "/",
    "^",
    "(",
    ")",
    ",",
    ">",
    ">=",
    "<",
    "<=",
    " ",
    "=",
    "**",
    "1",
    "0",
    "2e-3",
    "1e999",
    ".",
    "1.e",
    "e",
    "abs",
    "sign",
    "min",
    "max",
    "exp",
    "ln",
    "sqrt",
    "sin",
    "cos",
    "tanh",
    "elongation_m",
    "pressure_pa",
    "speed_m_s",
    "time_s",
    "angle_rad",
    "elongation_2_m",
    "a",
    "s",
    "é",
    "−",
    "·",
    "\u{0}",
];

/// Expressions that are right in themselves.
fn expression() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        Just("elongation_m".to_owned()),
        Just("time_s".to_owned()),
        Just("pressure_pa".to_owned()),
        (-5.0_f64..5.0).prop_map(|x| format!("({x:.3})")),
        (0_u32..5).prop_map(|x| x.to_string()),
    ];
    leaf.prop_recursive(6, 60, 3, |inner| {
        let function = prop::sample::select(vec!["abs", "sign", "exp", "ln", "sqrt", "sin", "cos", "tanh", "-"]);
        let operator = prop::sample::select(vec!["+", "-", "*", "/", "^", ">", "<="]);
        prop_oneof![
            (function, inner.clone()).prop_map(|(f, x)| format!("{f}({x})")),
            (inner.clone(), operator, inner.clone()).prop_map(|(a, o, b)| format!("({a}) {o} ({b})")),
            (inner.clone(), inner).prop_map(|(a, b)| format!("max({a}, {b})")),
        ]
    })
}

/// Reads a law and, where it is one, looks at all that it knows of itself.
fn read(port: String, adds: String, rate: Option<String>) -> Result<(), TestCaseError> {
    let mut table = LawTable { name: "x".to_owned(), port, adds: Some(adds), ..LawTable::default() };
    if let Some(rate) = rate {
        let state = smam::laws::StateTable { rate: Some(rate), ..Default::default() };
        table.state.insert("s".to_owned(), state);
    }
    match table.law(&Surroundings::default()) {
        Ok(law) => prop_assert!(!law.text().is_empty() && law.variables().len() <= law.symbols.len()),
        Err(e) => prop_assert!(!e.message.is_empty() && !e.remedy.is_empty(), "{e:?}"),
    }
    Ok(())
}

proptest! {
    #[test]
    fn token_soups_do_not_panic(
        port in prop::sample::select(PORTS.map(|spec| spec.name()).to_vec()),
        adds in prop::collection::vec(prop::sample::select(TOKENS.to_vec()), 0..30),
        rate in prop::option::of(prop::collection::vec(prop::sample::select(TOKENS.to_vec()), 0..12)),
    ) {
        read(port, adds.concat(), rate.map(|r| r.concat()))?;
    }

    #[test]
    fn valid_expressions_do_not_panic(adds in expression(), rate in prop::option::of(expression())) {
        read("muscle.pull".to_owned(), adds, rate)?;
    }

    #[test]
    fn any_text_is_answered(port in ".{0,20}", adds in ".{0,40}") {
        read(port, adds, None)?;
    }
}
