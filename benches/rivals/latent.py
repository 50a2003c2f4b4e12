"""An unknown signal at each port of the calibrated simulation (a latent force), and Gaussian processes for the best.

A signal that walks at random is sent into each port through the linearised rig; the port whose signal has most evidence
is where something is missing (Alvarez, Luengo, Lawrence 2009). What the signal is there at its best becomes a sum of
Gaussian processes over the states of the simulation that say most of it.
"""

import numpy as np

import library
from answer import Answer
from gp import fit_sum, label, sum_gain
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
# Places whose signals become laws.
PLACES = 2
# A signal is taken to be known to this share of its spread; so many states may tell it.
KNOWN_TO = 0.1
MOST_STATES = 3
# What a further state must add, in nats.
LEAST_NATS = 5.0


def answer(case, seed):
    """Where the signal with most evidence is, and what it foretells on the holdout."""
    return answer_by(case, seed, processes)


def answer_by(case, seed, make_laws):
    """The same by any way to make laws of a signal."""
    problem = Problem(case, seed)
    places = sorted(problem.places, key=lambda place: -place.gain)
    notes = {p.name: round(p.gain, 1) for p in places} | {"by_chance": problem.by_chance}
    floor = 0.5 * FLOOR_PER_SAMPLE * problem.rows.samples
    if places[0].gain <= max(problem.by_chance, floor):
        return Answer("adequate", notes=notes)
    laws = [problem.weigh_law(law) for place in places[:PLACES] for law in make_laws(problem, place, seed)]
    laws = [law for law in laws if np.isfinite(law.score)]
    if not laws:
        return Answer("unknown_physics", places[0].element, notes=notes)
    best = min(laws, key=lambda law: law.score)
    notes |= {"place": best.place.name, "law": best.text, "score": round(best.score, 1)}
    return Answer("unknown_physics", best.place.element, correction=problem.correction(best), notes=notes)


def processes(problem, place, _):
    """A sum of processes over one state, two, and three: those that add most evidence."""
    signal, states = problem.signal_and_states(place)
    y, chosen, laws, best = signal / KNOWN_TO, [], [], 0.0
    while len(chosen) < MOST_STATES:
        gains = {j: sum_gain(states[:, [*chosen, j]], y) for j in range(states.shape[1]) if j not in chosen}
        j = max(gains, key=gains.get)
        if gains[j] < best + LEAST_NATS:
            break
        chosen, best = [*chosen, j], gains[j]
        predict, own = fit_sum(states[:, chosen], y), list(chosen)
        words = ", ".join(label(problem.scaler.names[k]) for k in own)
        laws.append(Law(place, lambda q, p=predict, own=own: p(q[:, own]), words, len(own)))
    return laws


class Place:
    """A port: the element that it is told for, and what a signal there is to the linearised rig."""

    def __init__(self, element, kind, item):
        self.element, self.kind, self.item = element, kind, item
        self.name = f"{kind} of {element if kind != 'reading' else item}"
        self.gain, self.signal = -np.inf, None

    def term(self, signal, time_s):
        """The cause that stands in the balances: flows as the volume that they bring."""
        values = integral(signal, time_s) if self.kind == "flow" else signal
        kind = "volume" if self.kind == "flow" else self.kind
        return library.Term(self.name, "", self.element, **{kind: {self.item: values}})


class Law:
    """What the signal at a place is said to depend on: values by scaled states, words, and how long it is to say."""

    def __init__(self, place, values, text, length):
        self.place, self.values, self.text, self.length, self.score = place, values, text, length, np.inf


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

    def signal_and_states(self, place):
        """The signal there over all runs, and the scaled states at its knots."""
        signal = np.concatenate(place.signal)
        return (signal - signal.mean()) / max(signal.std(), 1e-300), np.concatenate(self.scaler.runs)

    def all_places(self):
        """Flow and pull of each muscle, torque of each joint, reading of each channel."""
        rig = self.rig
        pairs = (("line", "flow"), ("muscle", "force"))
        muscles = [(e + rig.suffix(i), kind, i) for i in range(rig.muscles) for e, kind in pairs]
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

    def column(self, law, run, blocks, size):
        """How a law shows in a run, and a constant beside it."""
        signal = by_sample(np.nan_to_num(law.values(blocks)), run, self.scaler.size(run))
        t = run.time_s - run.time_s[0]
        one = by_sample(np.ones(len(blocks)), run, self.scaler.size(run))
        terms = [law.place.term(s, t) for s in (signal, one)]
        return library.shown(self.rig, self.case, run, terms, size)

    def fitted(self, law):
        """Calibration, size of a law, and a constant beside it; what they leave."""
        blocks = {}
        for i, run in enumerate(self.case.runs):
            shown = self.column(law, run, self.scaler.runs[i], self.rows.sizes[i])
            blocks |= {(i, column): values for column, values in shown.items()}
        matrix = np.column_stack([self.tangents, self.rows.stack_blocks(blocks)])
        norms = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
        fit = solve(matrix / norms, self.y) / norms
        return fit, self.y - matrix @ fit

    def weigh_law(self, law):
        """What a law leaves, and a price for its length."""
        left = self.fitted(law)[1]
        law.score = float(left @ left) + law.length * np.log(len(self.y))
        return law

    def correction(self, law):
        """What calibration and law add on the holdout, by sample."""
        fit, _ = self.fitted(law)
        run = self.case.holdout
        size = max(1, round(BLOCK_S / run.interval_s))
        shown = self.column(law, run, self.scaler.of(run), size)
        added = {c: by_sample(values @ fit[-2:], run, size) for c, values in shown.items()}
        for size_of, key in zip(fit, run.tangents):
            for column in added:
                added[column] = added[column] + size_of * run.tangents[key][column]
        return added
