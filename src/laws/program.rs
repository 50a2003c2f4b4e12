//! An expression as a flat list of instructions, for any number type.

use crate::scalar::Scalar;

use super::tree::{Function, Node, Operator};

/// What an instruction does with its operands; those whose name ends in a number have one as their second.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Code {
    Constant,
    Of(Function),
    Two(Operator),
    AddNumber,
    TimesNumber,
    /// The number less the operand.
    NumberLess,
    /// The number over the operand.
    NumberOver,
    /// The operand times the number, and the offset.
    Affine,
    PowerWhole(i32),
    PowerNumber,
    Where,
}

/// One instruction: operands are registers, the result goes to the register after all that are there.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Instruction {
    code: Code,
    operands: [u16; 4],
    number: f64,
    offset: f64,
}

/// Expressions compiled together: what they have in common is computed once.
///
/// Registers hold the symbols first, in the order of [`Program::symbols`], then one result each.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    symbols: Vec<usize>,
    instructions: Vec<Instruction>,
    /// How many of the instructions the first output needs.
    first: usize,
    outputs: Vec<u16>,
}

impl Program {
    /// Compiles expressions; each becomes one output.
    pub fn new(expressions: &[Node]) -> Self {
        let mut symbols = Vec::new();
        expressions.iter().for_each(|node| collect(node, &mut symbols));
        let mut program = Self { symbols, instructions: Vec::new(), first: 0, outputs: Vec::new() };
        for node in expressions {
            let register = program.compile(node);
            program.outputs.push(register);
            if program.outputs.len() == 1 {
                program.first = program.instructions.len();
            }
        }
        program
    }

    /// The symbols whose values it needs, in this order.
    pub fn symbols(&self) -> &[usize] {
        &self.symbols
    }

    /// Number of registers that it needs.
    pub fn registers(&self) -> usize {
        self.symbols.len() + self.instructions.len()
    }

    /// Evaluates with the values of its symbols; afterwards [`Program::output`] reads the results from the registers, which must be
    /// [`Program::registers`] at least.
    #[inline]
    pub fn run<D: Scalar>(&self, values: impl Iterator<Item = D>, registers: &mut [D]) {
        fill(registers, values);
        self.run_from(0, self.instructions.len(), registers);
    }

    /// Evaluates the first output alone, and returns it.
    #[inline]
    pub fn run_first<D: Scalar>(&self, values: impl Iterator<Item = D>, registers: &mut [D]) -> D {
        fill(registers, values);
        self.run_from(0, self.first, registers);
        self.output(0, registers)
    }

    /// Evaluates the other outputs from the registers as [`Program::run_first`] left them.
    #[inline]
    pub(crate) fn run_rest<D: Scalar>(&self, registers: &mut [D]) {
        self.run_from(self.first, self.instructions.len(), registers);
    }

    #[inline]
    fn run_from<D: Scalar>(&self, from: usize, to: usize, registers: &mut [D]) {
        let symbols = self.symbols.len();
        for (i, instruction) in self.instructions[from..to].iter().enumerate() {
            registers[symbols + from + i] = instruction.result(registers);
        }
    }

    /// A result of the last run.
    #[inline]
    pub fn output<D: Scalar>(&self, index: usize, registers: &[D]) -> D {
        registers[usize::from(self.outputs[index])]
    }

    /// Whether a result is 0 whatever the symbols are.
    #[inline]
    pub(crate) fn is_nothing(&self, index: usize) -> bool {
        let at = usize::from(self.outputs[index]).checked_sub(self.symbols.len()).map(|i| &self.instructions[i]);
        at.is_some_and(|i| i.code == Code::Constant && i.number == 0.0)
    }

    /// The first result, of plain numbers by symbol.
    pub fn value(&self, by_symbol: &[f64]) -> f64 {
        let mut registers = vec![0.0; self.registers()];
        self.run_first(self.symbols.iter().map(|s| by_symbol[*s]), &mut registers)
    }

    fn compile(&mut self, node: &Node) -> u16 {
        match node {
            Node::Number(value, _) => self.push(Code::Constant, [0; 4], *value),
            // Every symbol of the expressions has been collected.
            Node::Symbol(symbol) => self.symbols.iter().position(|s| s == symbol).unwrap_or(0) as u16,
            Node::Of(function, x) => {
                let x = self.compile(x);
                self.push(Code::Of(*function), [x, 0, 0, 0], 0.0)
            }
            Node::Two(operator, a, b) => self.compile_two(*operator, a, b),
            Node::Where(parts) => {
                let [a, b, then, otherwise] = &**parts;
                let operands = [self.compile(a), self.compile(b), self.compile(then), self.compile(otherwise)];
                self.push(Code::Where, operands, 0.0)
            }
        }
    }

    fn compile_two(&mut self, operator: Operator, a: &Node, b: &Node) -> u16 {
        use Operator as O;
        let one = |program: &mut Self, code, x: &Node, number: f64| {
            let (x, number) = match (code, x) {
                // The sign goes with the number.
                (Code::TimesNumber, Node::Of(Function::Negate, x)) => (&**x, -number),
                _ => (x, number),
            };
            let x = program.compile(x);
            program.push(code, [x, 0, 0, 0], number)
        };
        if let (O::Add, Some((x, factor, offset))) = (operator, affine(a, b)) {
            let x = self.compile(x);
            return self.push_instruction(Instruction {
                code: Code::Affine,
                operands: [x, 0, 0, 0],
                number: factor,
                offset,
            });
        }
        match (operator, a.constant(), b.constant()) {
            (_, Some(x), Some(y)) => self.push(Code::Constant, [0; 4], operator.at(x, y)),
            (O::Add, Some(x), _) => one(self, Code::AddNumber, b, x),
            (O::Add, _, Some(y)) => one(self, Code::AddNumber, a, y),
            (O::Subtract, _, Some(y)) => one(self, Code::AddNumber, a, -y),
            (O::Subtract, Some(x), _) => one(self, Code::NumberLess, b, x),
            (O::Multiply, Some(x), _) => one(self, Code::TimesNumber, b, x),
            (O::Multiply, _, Some(y)) => one(self, Code::TimesNumber, a, y),
            (O::Divide, Some(x), _) => one(self, Code::NumberOver, b, x),
            (O::Divide, _, Some(y)) if y.recip().is_finite() => one(self, Code::TimesNumber, a, y.recip()),
            (O::Power, _, Some(y)) if y.fract() == 0.0 && y.abs() <= 64.0 => {
                one(self, Code::PowerWhole(y as i32), a, 0.0)
            }
            (O::Power, _, Some(y)) => one(self, Code::PowerNumber, a, y),
            _ => {
                let operands = [self.compile(a), self.compile(b), 0, 0];
                self.push(Code::Two(operator), operands, 0.0)
            }
        }
    }

    /// The register of an instruction's result; one that is there already is taken again.
    fn push(&mut self, code: Code, operands: [u16; 4], number: f64) -> u16 {
        self.push_instruction(Instruction { code, operands, number, offset: 0.0 })
    }

    fn push_instruction(&mut self, instruction: Instruction) -> u16 {
        let known = self.instructions.iter().position(|other| *other == instruction);
        let at = known.unwrap_or_else(|| {
            self.instructions.push(instruction);
            self.instructions.len() - 1
        });
        (self.symbols.len() + at) as u16
    }
}

#[inline]
fn fill<D>(registers: &mut [D], values: impl Iterator<Item = D>) {
    registers.iter_mut().zip(values).for_each(|(register, value)| *register = value);
}

/// The parts of `factor * x + offset`, whichever way round it is written.
fn affine<'a>(a: &'a Node, b: &'a Node) -> Option<(&'a Node, f64, f64)> {
    let (product, offset) = match (a.constant(), b.constant()) {
        (None, Some(offset)) => (a, offset),
        (Some(offset), None) => (b, offset),
        _ => return None,
    };
    let Node::Two(Operator::Multiply, x, y) = product else { return None };
    match (x.constant(), y.constant()) {
        (Some(factor), None) => Some((y, factor, offset)),
        (None, Some(factor)) => Some((x, factor, offset)),
        _ => None,
    }
}

fn collect(node: &Node, symbols: &mut Vec<usize>) {
    match node {
        Node::Number(..) => {}
        Node::Symbol(symbol) if symbols.contains(symbol) => {}
        Node::Symbol(symbol) => symbols.push(*symbol),
        Node::Of(_, x) => collect(x, symbols),
        Node::Two(_, a, b) => [a, b].into_iter().for_each(|part| collect(part, symbols)),
        Node::Where(parts) => parts.iter().for_each(|part| collect(part, symbols)),
    }
}

impl Instruction {
    #[inline(always)]
    fn result<D: Scalar>(&self, registers: &[D]) -> D {
        let at = |i: usize| registers[usize::from(self.operands[i])];
        let c = D::constant;
        match self.code {
            Code::Constant => c(self.number),
            Code::AddNumber => at(0) + self.number,
            Code::TimesNumber => at(0) * self.number,
            Code::NumberLess => -at(0) + self.number,
            Code::NumberOver => at(0).recip() * self.number,
            Code::Affine => at(0) * self.number + self.offset,
            Code::PowerWhole(2) => at(0) * at(0),
            Code::PowerWhole(3) => at(0) * at(0) * at(0),
            Code::PowerWhole(n) => at(0).powi(n),
            Code::PowerNumber => at(0).powf(self.number),
            Code::Where => at(0).select_above(at(1), at(2), at(3)),
            Code::Of(function) => of(function, at(0)),
            Code::Two(operator) => two(operator, at(0), at(1)),
        }
    }
}

#[inline(always)]
fn of<D: Scalar>(function: Function, x: D) -> D {
    match function {
        Function::Negate => -x,
        Function::Abs => x.abs(),
        Function::Sign => {
            let [minus, zero, plus] = [-1.0, 0.0, 1.0].map(D::constant);
            x.select_above(zero, plus, zero.select_above(x, minus, zero))
        }
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Sqrt => x.sqrt(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tanh => x.tanh(),
    }
}

#[inline(always)]
fn two<D: Scalar>(operator: Operator, a: D, b: D) -> D {
    let [zero, one] = [0.0, 1.0].map(D::constant);
    match operator {
        Operator::Add => a + b,
        Operator::Subtract => a - b,
        Operator::Multiply => a * b,
        Operator::Divide => a / b,
        Operator::Power => a.powd(b),
        Operator::Min => a.select_above(b, b, a),
        Operator::Max => a.select_above(b, a, b),
        Operator::Above => a.select_above(b, one, zero),
        Operator::AtLeast => b.select_above(a, zero, one),
    }
}

#[cfg(test)]
mod tests {
    use num_dual::Dual64;
    use proptest::prelude::*;

    use super::*;
    use crate::laws::syntax::parse;
    use crate::scalar::Lanes;

    const NAMES: [&str; 3] = ["x", "y", "z"];

    fn read(text: &str) -> Node {
        let mut symbols = |name: &str| {
            NAMES.iter().position(|n| *n == name).ok_or_else(|| (format!("{name} is unknown"), String::new()))
        };
        parse(text, &mut symbols).unwrap_or_else(|e| panic!("{text}: {e:?}"))
    }

    const TEXTS: [&str; 12] = [
        "x*y + z^3 - x/(1 + y^2)",
        "exp(-abs(x)/2e-1) * tanh(y)",
        "ln(1 + abs(z)) + sqrt(4 + x)",
        "max(x - y, 0) * min(z, x)",
        "sin(x)*cos(y) - sign(z)*x^2",
        "(x > y) * z + (x >= z) * y",
        "2 - x + 3/(2 + y) - (z + 1)^-2",
        "abs(x)^1.7/(1 + y^2)",
        "(2 + x)^y",
        "-x^2 + -(y - z)",
        "x*y + (x*y)^2 + exp(x*y)",
        "1/(1 + exp(-(x - y)/0.5))",
    ];

    proptest! {
        /// One by one, side by side and with derivatives: the same numbers to the last bit; derivatives against differences.
        #[test]
        fn all_number_types_agree(x in -1.5_f64..1.5, y in -1.5_f64..1.5, z in -1.5_f64..1.5) {
            for text in TEXTS {
                let node = read(text);
                let program = Program::new(std::slice::from_ref(&node));
                let at = [x, y, z];
                let plain = program.value(&at);
                let mut lanes = vec![Lanes([0.0; 2]); program.registers()];
                program.run(program.symbols().iter().map(|s| Lanes([at[*s], 0.3])), &mut lanes);
                prop_assert_eq!(program.output(0, &lanes).0[0].to_bits(), plain.to_bits(), "{}", text);
                for symbol in 0..3 {
                    let mut duals = vec![Dual64::from(0.0); program.registers()];
                    let dual = |s: &usize| Dual64::new(at[*s], f64::from(u8::from(*s == symbol)));
                    program.run(program.symbols().iter().map(dual), &mut duals);
                    let exact = program.output(0, &duals);
                    prop_assert!((exact.re - plain).abs() <= 1e-12 * plain.abs().max(1.0));
                    let derived = Program::new(&[node.derivative(symbol)]).value(&at);
                    prop_assert!((derived - exact.eps).abs() <= 1e-9 * exact.eps.abs().max(1.0), "{} by {}: {} {}", text, symbol, derived, exact.eps);
                }
            }
        }

        /// What is written of a tree reads as the same tree's value.
        #[test]
        fn text_goes_there_and_back(x in -1.5_f64..1.5, y in -1.5_f64..1.5, z in -1.5_f64..1.5) {
            let names = NAMES.map(str::to_owned);
            for text in TEXTS {
                let node = read(text);
                let again = read(&node.text(&names).to_string());
                let (a, b) = (Program::new(&[node]).value(&[x, y, z]), Program::new(&[again]).value(&[x, y, z]));
                prop_assert!((a - b).abs() <= 1e-12 * a.abs().max(1.0), "{}", text);
            }
        }
    }

    #[test]
    fn what_is_common_is_computed_once() {
        let program = Program::new(&[read("x*y + (x*y)^2 + exp(x*y)")]);
        assert_eq!(program.instructions.len(), 5);
    }

    #[test]
    fn signs_and_constants_are_folded() {
        // abs, the quotient, exp, and one for the rest.
        let program = Program::new(&[read("1 + 0.4*exp(-abs(x)/2e-3)")]);
        assert_eq!(program.instructions.len(), 4);
        assert!((program.value(&[-3e-3, 0.0, 0.0]) - (1.0 + 0.4 * (-(3e-3_f64) / 2e-3).exp())).abs() < 1e-15);
    }
}
