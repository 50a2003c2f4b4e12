"""Symbolic regression (operon) of an unknown signal at one port of the calibrated simulation.

A signal that walks at random is sent into each port through the linearised rig; the port whose signal has most evidence
is where something is missing. What the signal is there at its best becomes an expression of the simulation's states, by
genetic programming. Of the expressions of every length the one is taken that explains the recordings best for its
length, its size fitted together with the calibrated numbers.
"""

import numpy as np
from pyoperon.sklearn import SymbolicRegressor

import library
from answer import Answer
from rig import Rig, integral
from rows import FALSE_ALARM_LEVEL, FLOOR_PER_SAMPLE, Rows, orthonormal, without
from sindy import solve
from states import Scaler, by_sample

BLOCK_S = 0.1
KNOT_S = 0.25
# Where a signal begins is known so much less than how far it walks from knot to knot.
FIRST = 10.0
# Paces of the walk, about the one at which it shows as much as the noise.
PACES = np.geomspace(0.1, 1e4, 16)
DRAWS = 199
# Places whose signals become expressions, and the search for these.
PLACES = 2
SYMBOLS = "add,sub,mul,aq,constant,variable,square,abs,tanh,exp"
LENGTH = 15
POPULATION = 1000
EVALUATIONS = 400_000
MOST_S = 30


def answer(case, seed):
    """Where the signal with most evidence is, as what expression, and what that foretells on the holdout."""
    problem = Problem(case, seed)
    places = sorted(problem.places, key=lambda place: -place.gain)
    notes = {p.name: round(p.gain, 1) for p in places} | {"by_chance": problem.by_chance}
    floor = 0.5 * FLOOR_PER_SAMPLE * problem.rows.samples
    if places[0].gain <= max(problem.by_chance, floor):
        return Answer("adequate", notes=notes)
    found = [law for place in places[:PLACES] for law in problem.laws(place, seed)]
    if not found:
        return Answer("unknown_physics", places[0].element, notes=notes)
    best = min(found, key=lambda law: law.score)
    notes |= {"place": best.place.name, "law": best.text, "score": best.score}
    return Answer("unknown_physics", best.place.element, correction=problem.correction(best), notes=notes)


class Place:
    """A port: the element that it is told for, and what a signal there is to the linearised rig."""

    def __init__(self, element, kind, item):
        self.element, self.kind, self.item = element, kind, item
        self.name = f"{kind} of {element if kind != 'reading' else item}"
        self.gain, self.signal = -np.inf, None

    def term(self, signal, time_s):
        """The cause that stands in the balances: flows as the volume that they bring."""
        values = integral(signal, time_s) if self.kind == "flow" else signal
        return library.Term(self.name, "", self.element, **{{"flow": "volume"}.get(self.kind, self.kind): {self.item: values}})


class Law:
    """An expression at a place, by what it leaves and how long it is."""

    def __init__(self, place, regressor, model, score):
        self.place, self.score = place, score
        self.values = lambda states: regressor.evaluate_model(model["tree"], states)
        self.text = regressor.get_model_string(model["tree"], 4)


class Problem:
    """Whitened residual of one case, and the evidence of a signal at each place."""

    def __init__(self, case, seed):
        self.case, self.rig = case, Rig(case.scene, case.numbers)
        self.rows = Rows(case, BLOCK_S)
        self.scaler = Scaler(self.rig, case.runs, KNOT_S)
        self.tangents, self.y = self.rows.tangents(), self.rows.residual()
        self.basis = orthonormal(self.tangents)
        self.left = without(self.basis, self.y)
        random = np.random.default_rng(seed)
        draws = np.column_stack([without(self.basis, self.rows.draw(random)) for _ in range(DRAWS)])
        self.places, best = self.all_places(), np.full(DRAWS, -np.inf)
        for place in self.places:
            best = np.maximum(best, self.weigh(place, draws))
        self.by_chance = float(np.quantile(best, 1.0 - FALSE_ALARM_LEVEL))

    def all_places(self):
        """Flow and pull of each muscle, torque of each joint, reading of each channel."""
        rig = self.rig
        muscles = [(e + rig.suffix(i), k, i) for i in range(rig.muscles) for e, k in (("line", "flow"), ("muscle", "force"))]
        joints = [("mechanism", "torque", j) for j in range(len(rig.coordinates))] if rig.muscles > 1 else []
        return [Place(*own) for own in [*muscles, *joints, *(("sensor", "reading", c) for c in self.case.outputs)]]

    def weigh(self, place, draws):
        """Evidence of a walk there, and the walk at its best; the evidence that drawn noise has."""
        walks, seen = self.walks(place)
        own = without(self.basis, seen)
        scale = max(np.linalg.norm(own, axis=0).max(), 1e-300)
        values, vectors = np.linalg.eigh(own.T @ own / scale**2)
        values = np.maximum(values, 0.0)
        along, of_draws = (vectors.T @ (own.T @ v) / scale for v in (self.left, draws))

        def gains(a, pace):
            """Logarithm of the evidence against none, for a column or several."""
            shrink = pace**2 / (1.0 + pace**2 * values)
            return 0.5 * (np.tensordot(shrink, a**2, 1) - np.log1p(pace**2 * values).sum())

        by_pace = [gains(along, pace) for pace in PACES]
        pace = PACES[int(np.argmax(by_pace))]
        place.gain = float(max(by_pace))
        sizes = vectors @ (pace**2 / (1.0 + pace**2 * values) * along)
        place.signal = [w @ sizes / scale for w in walks]
        return np.max([gains(of_draws, pace) for pace in PACES], axis=0)

    def walks(self, place):
        """By run the walks' values at its knots, and how all of them show: one column per step of a walk."""
        counts = [len(s) for s in self.scaler.runs]
        ends = np.cumsum(counts)
        walks, blocks = [], {}
        for i, (run, count) in enumerate(zip(self.case.runs, counts)):
            steps = np.tril(np.full((count, count), np.sqrt(KNOT_S)))
            steps[:, 0] *= FIRST
            own = np.zeros((count, ends[-1]))
            own[:, ends[i] - count : ends[i]] = steps
            walks.append(own)
            signals = [by_sample(steps[:, k], run, self.scaler.size(run)) for k in range(count)]
            t = run.time_s - run.time_s[0]
            shown = library.shown(self.rig, self.case, run, [place.term(s, t) for s in signals], self.rows.sizes[i])
            for column, values in shown.items():
                whole = np.zeros((len(values), ends[-1]))
                whole[:, ends[i] - count : ends[i]] = values
                blocks[(i, column)] = whole
        return walks, self.rows.stack_blocks(blocks)

    def laws(self, place, seed):
        """Expressions of every length for the signal there."""
        signal = np.concatenate(place.signal)
        states = np.concatenate(self.scaler.runs)
        spread = signal.std()
        if not spread > 0.0:
            return []
        regressor = SymbolicRegressor(
            allowed_symbols=SYMBOLS,
            objectives=["r2", "length"],
            max_length=LENGTH,
            population_size=POPULATION,
            pool_size=POPULATION,
            max_evaluations=EVALUATIONS,
            max_time=MOST_S,
            optimizer_iterations=3,
            n_threads=1,
            random_state=seed,
        )
        regressor.fit(states, (signal - signal.mean()) / spread)
        laws = [Law(place, regressor, model, 0.0) for model in regressor.pareto_front_]
        for law, model in zip(laws, regressor.pareto_front_):
            law.score = self.chi2(law) + model["length"] * np.log(len(self.y))
        return [law for law in laws if np.isfinite(law.score)]

    def column(self, law, run, blocks, size):
        """How an expression shows in a run."""
        signal = by_sample(np.nan_to_num(law.values(blocks)), run, self.scaler.size(run))
        t = run.time_s - run.time_s[0]
        one = by_sample(np.ones(len(blocks)), run, self.scaler.size(run))
        terms = [law.place.term(s, t) for s in (signal, one)]
        return library.shown(self.rig, self.case, run, terms, size)

    def fitted(self, law):
        """Calibration and size of an expression, and of a constant beside it; what they leave."""
        blocks = {}
        for i, run in enumerate(self.case.runs):
            shown = self.column(law, run, self.scaler.runs[i], self.rows.sizes[i])
            blocks |= {(i, column): values for column, values in shown.items()}
        matrix = np.column_stack([self.tangents, self.rows.stack_blocks(blocks)])
        norms = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
        fit = solve(matrix / norms, self.y) / norms
        return fit, self.y - matrix @ fit

    def chi2(self, law):
        """What an expression leaves."""
        left = self.fitted(law)[1]
        return float(left @ left)

    def correction(self, law):
        """What calibration and expression add on the holdout, by sample."""
        fit, _ = self.fitted(law)
        run = self.case.holdout
        size = max(1, round(BLOCK_S / run.interval_s))
        shown = self.column(law, run, self.scaler.of(run), size)
        added = {c: by_sample(values @ fit[-2:], run, size) for c, values in shown.items()}
        for size_of, key in zip(fit, run.tangents):
            for column in added:
                added[column] = added[column] + size_of * run.tangents[key][column]
        return added
