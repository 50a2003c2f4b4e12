//! From the text of an expression to its tree.
//!
//! Powers bind tighter than a minus before them and group to the right (`-x^2 = -(x^2)`, `2^3^2 = 2^9`), and `2e-3` is a
//! number: as in textbooks and in Python. Why not a crate's parser: docs/adr/0017.

use super::tree::{Function, Node, Operator};

/// What is wrong with the text, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntaxError {
    /// Bytes before the place.
    pub at: usize,
    pub message: String,
    pub remedy: String,
}

/// Brackets and signs within each other, at most: a text of brackets alone must not exhaust the stack.
const DEEPEST: usize = 60;
/// Greatest size of an expression, in nodes.
const GREATEST: usize = 400;

/// Tells the place of a name, or message and remedy.
pub type Resolve<'a> = dyn FnMut(&str) -> Result<usize, (String, String)> + 'a;

/// Reads an expression; `symbol` tells the place of a name, or why there is none.
///
/// # Errors
/// Words, signs and brackets that do not make an expression; what `symbol` refuses.
pub fn parse(text: &str, symbol: &mut Resolve<'_>) -> Result<Node, SyntaxError> {
    let mut reader = Reader { text, at: 0, depth: 0, symbol };
    let node = reader.comparison()?;
    reader.skip_space();
    if reader.at < text.len() {
        return Err(reader.unexpected("an operator or the end"));
    }
    if node.size() > GREATEST {
        let remedy = "shorten it; a sum of many terms can be several laws at the same port";
        return Err(SyntaxError { at: 0, message: "the expression is too long".to_owned(), remedy: remedy.to_owned() });
    }
    Ok(node)
}

struct Reader<'a, 'b, 'c> {
    text: &'a str,
    at: usize,
    depth: usize,
    symbol: &'b mut Resolve<'c>,
}

impl<'a> Reader<'a, '_, '_> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip_space(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    /// Takes the first of these signs that comes next.
    fn take(&mut self, signs: &[&'static str]) -> Option<&'static str> {
        self.skip_space();
        let found = signs.iter().find(|sign| self.rest().starts_with(**sign))?;
        self.at += found.len();
        Some(found)
    }

    fn error(&self, message: String, remedy: &str) -> SyntaxError {
        SyntaxError { at: self.at, message, remedy: remedy.to_owned() }
    }

    fn unexpected(&self, wanted: &str) -> SyntaxError {
        let found = match self.rest().chars().next() {
            Some(c) => format!("\"{c}\""),
            None => "the end".to_owned(),
        };
        let remedy = "write numbers, names, + - * / ^, comparisons (> >= < <=), brackets and the functions abs, sign, min, \
                      max, exp, ln, sqrt, sin, cos, tanh; every product needs its *";
        self.error(format!("{wanted} is expected, {found} was found"), remedy)
    }

    fn deeper<T>(&mut self, part: impl FnOnce(&mut Self) -> Result<T, SyntaxError>) -> Result<T, SyntaxError> {
        if self.depth >= DEEPEST {
            return Err(self.error("brackets stand too deep in each other".to_owned(), "write it with fewer brackets"));
        }
        self.depth += 1;
        let result = part(self);
        self.depth -= 1;
        result
    }

    fn comparison(&mut self) -> Result<Node, SyntaxError> {
        let left = self.sum()?;
        let Some(sign) = self.take(&[">=", "<=", ">", "<"]) else { return Ok(left) };
        let right = self.sum()?;
        if self.take(&[">=", "<=", ">", "<"]).is_some() {
            let remedy = "multiply two comparisons instead: (a < x) * (x < b)";
            return Err(self.error("comparisons stand in a row".to_owned(), remedy));
        }
        Ok(match sign {
            ">" => Node::Two(Operator::Above, Box::new(left), Box::new(right)),
            ">=" => Node::Two(Operator::AtLeast, Box::new(left), Box::new(right)),
            "<" => Node::Two(Operator::Above, Box::new(right), Box::new(left)),
            _ => Node::Two(Operator::AtLeast, Box::new(right), Box::new(left)),
        })
    }

    fn sum(&mut self) -> Result<Node, SyntaxError> {
        let mut left = self.product()?;
        while let Some(sign) = self.take(&["+", "-", "−"]) {
            let right = self.product()?;
            let operator = if sign == "+" { Operator::Add } else { Operator::Subtract };
            left = Node::Two(operator, Box::new(left), Box::new(right));
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Node, SyntaxError> {
        let mut left = self.signed()?;
        while let Some(sign) = self.take(&["*", "·", "/"]) {
            if sign == "*" && self.rest().starts_with('*') {
                return Err(self.error("** is no operator here".to_owned(), "write a power as x^2"));
            }
            let right = self.signed()?;
            let operator = if sign == "/" { Operator::Divide } else { Operator::Multiply };
            left = Node::Two(operator, Box::new(left), Box::new(right));
        }
        Ok(left)
    }

    fn signed(&mut self) -> Result<Node, SyntaxError> {
        match self.take(&["-", "−", "+"]) {
            Some("+") => self.deeper(Self::signed),
            Some(_) => self.deeper(|reader| Ok(negative(reader.signed()?))),
            None => self.power(),
        }
    }

    fn power(&mut self) -> Result<Node, SyntaxError> {
        let base = self.atom()?;
        if self.take(&["^"]).is_none() {
            return Ok(base);
        }
        let exponent = self.deeper(Self::signed)?;
        Ok(Node::Two(Operator::Power, Box::new(base), Box::new(exponent)))
    }

    fn atom(&mut self) -> Result<Node, SyntaxError> {
        self.skip_space();
        match self.rest().chars().next() {
            Some('(') => {
                self.at += 1;
                let inside = self.deeper(Self::comparison)?;
                self.close()?;
                Ok(inside)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_ascii_alphabetic() || c == '_' => self.word(),
            _ => Err(self.unexpected("a number, a name or a bracket")),
        }
    }

    fn close(&mut self) -> Result<(), SyntaxError> {
        match self.take(&[")"]) {
            Some(_) => Ok(()),
            None => Err(self.unexpected("a closing bracket")),
        }
    }

    fn number(&mut self) -> Result<Node, SyntaxError> {
        let bytes = self.rest().as_bytes();
        let digits = |from: usize| from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
        let mut end = digits(0);
        let mut is_whole = true;
        if bytes.get(end) == Some(&b'.') {
            is_whole = false;
            end = digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let signed = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let after = digits(signed.min(bytes.len()));
            if after > signed {
                is_whole = false;
                end = after;
            }
        }
        let text = &self.rest()[..end];
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.at += end;
                Ok(Node::Number(value, is_whole))
            }
            _ => Err(self.error(format!("\"{text}\" is no finite number"), "write it like 0.4 or 2e-3")),
        }
    }

    fn word(&mut self) -> Result<Node, SyntaxError> {
        let (start, rest) = (self.at, self.rest());
        let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
        let name = &rest[..end];
        self.at += end;
        self.skip_space();
        if self.rest().starts_with('(') {
            return self.call(name, start);
        }
        let place = (self.symbol)(name);
        place.map(Node::Symbol).map_err(|(message, remedy)| SyntaxError { at: start, message, remedy })
    }

    fn call(&mut self, name: &str, start: usize) -> Result<Node, SyntaxError> {
        let function = Function::NAMED.iter().find(|(known, _)| *known == name).map(|(_, f)| *f);
        let joins = match name {
            "min" => Some(Operator::Min),
            "max" => Some(Operator::Max),
            _ => None,
        };
        if function.is_none() && joins.is_none() {
            let known: Vec<&str> = Function::NAMED.iter().map(|(name, _)| *name).chain(["min", "max"]).collect();
            let usual =
                [("log", "ln"), ("pow", "a^b"), ("step", "(x > a)"), ("heaviside", "(x > 0)"), ("atan", "tanh")];
            let meant = usual.iter().find(|(word, _)| *word == name).map(|(_, own)| format!(", write {own}"));
            let near = meant.unwrap_or_else(|| crate::nearest::did_you_mean(name, &known));
            let message = format!("there is no function \"{name}\"{near}");
            return Err(SyntaxError { at: start, message, remedy: format!("use {}", known.join(", ")) });
        }
        self.at += 1;
        let mut arguments = vec![self.deeper(Self::comparison)?];
        while self.take(&[","]).is_some() {
            arguments.push(self.deeper(Self::comparison)?);
        }
        self.close()?;
        let count = arguments.len();
        let wrong = |wanted: &str| SyntaxError {
            at: start,
            message: format!("{name} takes {wanted}, {count} stand there"),
            remedy: format!("write {name} with {wanted}"),
        };
        let mut arguments = arguments.into_iter();
        match (function, joins, arguments.next()) {
            (Some(function), _, Some(only)) if count == 1 => Ok(Node::Of(function, Box::new(only))),
            (None, Some(operator), Some(first)) if count > 1 => {
                Ok(arguments.fold(first, |a, b| Node::Two(operator, Box::new(a), Box::new(b))))
            }
            (Some(_), ..) => Err(wrong("one argument")),
            _ => Err(wrong("two arguments or more")),
        }
    }
}

/// A number with its sign is one number.
fn negative(x: Node) -> Node {
    match x {
        Node::Number(value, is_whole) => Node::Number(-value, is_whole),
        x => Node::Of(Function::Negate, Box::new(x)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::program::Program;

    fn symbols(name: &str) -> Result<usize, (String, String)> {
        match name {
            "x" => Ok(0),
            "y" => Ok(1),
            _ => Err((format!("{name} is unknown"), "use x or y".to_owned())),
        }
    }

    fn value(text: &str) -> f64 {
        let node = parse(text, &mut symbols).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        let program = Program::new(&[node]);
        program.value(&[3.0, 0.5])
    }

    #[test]
    fn expressions_mean_what_textbooks_mean() {
        for (text, expected) in [
            ("-x^2", -9.0),
            ("2^3^2", 512.0),
            ("2e-3*1e3", 2.0),
            ("1 - 2 - 3", -4.0),
            ("8/2/2", 2.0),
            ("2^-1", 0.5),
            ("-2*-3", 6.0),
            ("x > 2", 1.0),
            ("(x <= 3) * (y < 0.5)", 0.0),
            ("max(x - 1, 0, y)", 2.0),
            ("min(x, y)", 0.5),
            ("abs(-x) + sign(-y)", 2.0),
            ("sqrt(x + 6) * tanh(0)", 0.0),
            (".5 + 2.", 2.5),
            ("ln(exp(x))", 3.0),
            ("x^2.5", 3.0_f64.powf(2.5)),
            ("x^y", 3.0_f64.sqrt()),
        ] {
            assert!((value(text) - expected).abs() < 1e-12, "{text} = {}", value(text));
        }
    }

    #[test]
    fn what_is_wrong_is_placed() {
        for (text, at, word) in [
            ("1 + ", 4, "the end"),
            ("2 x", 2, "operator"),
            ("(x", 2, "closing"),
            ("x)", 1, "operator"),
            ("foo(x)", 0, "no function"),
            ("log(x)", 0, "write ln"),
            ("expp(x)", 0, "did you mean \"exp\""),
            ("x + z", 4, "z is unknown"),
            ("exp(x, y)", 0, "one argument"),
            ("max(x)", 0, "two arguments"),
            ("x ** 2", 3, "**"),
            ("1 < x < 2", 7, "in a row"),
            ("1e999", 0, "finite"),
            ("", 0, "the end"),
            ("x § y", 2, "operator"),
        ] {
            let error = parse(text, &mut symbols).expect_err(text);
            assert!(error.at == at && error.message.contains(word), "{text}: {error:?}");
            assert!(!error.remedy.is_empty());
        }
        let deep = "(".repeat(10_000);
        assert!(parse(&deep, &mut symbols).expect_err("deep").message.contains("too deep"));
        let long = vec!["x"; 1000].join("+");
        assert!(parse(&long, &mut symbols).expect_err("long").message.contains("too long"));
    }
}
