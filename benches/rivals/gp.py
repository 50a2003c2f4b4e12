"""A Gaussian process over states of the calibrated simulation as the law of what it lacks.

Evidence of single-input processes, low-rank, decides whether there is anything and which input matters most. What is
foretold comes from a sum of single-input processes or from one over the chosen inputs with a length of its own for each
(automatic relevance determination), whichever foretells runs it has not seen better.
"""

import warnings

import numpy as np
from scipy.optimize import minimize
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel

from answer import Answer, effect
from noise import block_means
from rig import Rig
from rows import FALSE_ALARM_LEVEL, FLOOR_PER_SAMPLE, channel_noise, draw_channel, orthonormal
from states import Scaler, by_sample

BLOCK_S = 0.1
DRAWS = 199
INDUCING = 16
LENGTHS = (0.5, 2.0)
AMPLITUDES = np.geomspace(0.03, 300.0, 17)
MOST_INPUTS = 6
ARD_ROWS = 350
# Evidence of so many nats more is needed for another input; differences count in proportion to what is explained.
LEAST_NATS = 5.0
TOLERANCE = 0.02
# A sensor's own error leaves the other channels alone: this share of the evidence is then in one.
ONE_CHANNEL = 0.99

# most telling input -> (element, effect) when several channels show it (or only one is recorded)
TABLE = {
    "time": ("line", "thermal_expansion"),
    "plunger_speed": ("line", "line_restriction"),
    "plunger_play": ("syringe", "plunger_backlash"),
    "pressure": ("line", "trapped_air"),
    "pressure_rate": ("line", "trapped_air"),
    "pressure_integral": ("line", "leak"),
    "elongation": ("muscle", "coil_preload"),
    "elongation_memory_fast": ("muscle", "viscoelasticity"),
    "elongation_memory_slow": ("muscle", "viscoelasticity"),
    "below_greatest_elongation": ("muscle", "mullins_softening"),
    "tension": ("mechanism", "tendon_coupling"),
    "joint": ("mechanism", "external_contact"),
    "joint_sliding": ("mechanism", "bearing_friction"),
    "plunger": ("syringe", None),
    "elongation_rate": ("muscle", None),
    "sliding": ("muscle", None),
    "joint_rate": ("mechanism", None),
}
# the same when only one of several recorded channels shows it
TABLE_ONE_CHANNEL = {
    "time": "sensor_drift",
    "pressure": "sensor_gain",
    "elongation": "sensor_gain",
    "joint": "sensor_gain",
    "plunger": "sensor_gain",
    "pressure_rate": "sensor_lag",
    "elongation_rate": "sensor_lag",
    "joint_rate": "sensor_lag",
    "plunger_speed": "sensor_lag",
}


def answer(case, seed):
    """Evidence, most telling input, prediction."""
    data = Data(case)
    gains = [data.single_gains(c) for c in case.outputs]
    total = sum(g.max() for g in gains)
    by_chance = data.by_chance(seed)
    floor = 0.5 * FLOOR_PER_SAMPLE * data.samples
    notes = {"log_evidence_ratio": float(total), "by_chance": by_chance, "floor": float(floor)}
    if total <= max(by_chance, floor):
        return Answer("adequate", notes=notes)
    correction, used = {}, {}
    for column, gain in zip(case.outputs, gains):
        correction[column], used[column] = data.foretell(column, gain, seed)
    verdict, element, effects = name(data, gains)
    return Answer(verdict, element, effects, correction, notes | {"inputs": used})


class Data:
    """States and residuals of a case in blocks; the calibrated numbers are refitted linearly first."""

    def __init__(self, case):
        self.case, self.rig = case, Rig(case.scene, case.numbers)
        self.scaler = Scaler(self.rig, case.runs, BLOCK_S)
        self.states = np.concatenate(self.scaler.runs)
        self.run = np.concatenate([np.full(len(s), i) for i, s in enumerate(self.scaler.runs)])
        self.noise = channel_noise(case)
        size = self.scaler.size(case.runs[0])
        self.scale = {c: n.of_means(size).slow_sd for c, n in self.noise.items()}
        self.keys = list(case.runs[0].tangents)
        self.residual = {
            c: self.blocks(lambda r, c=c: r.measured[c] - r.simulated[c]) / self.scale[c] for c in case.outputs
        }
        self.tangent = {c: self.moved(c) / self.scale[c] for c in case.outputs}
        self.samples = size * sum(np.isfinite(r).sum() for r in self.residual.values())
        self.raw = dict(self.residual)
        self.refit()
        self.features = [
            low_rank(self.states[:, [j]], length) for j in range(self.states.shape[1]) for length in LENGTHS
        ]
        self.eigen = {
            c: [decompose(f, self.tangent[c], np.isfinite(self.residual[c])) for f in self.features]
            for c in case.outputs
        }

    def blocks(self, values):
        """Block means over all runs."""
        return np.concatenate([block_means(values(r), self.scaler.size(r)) for r in self.case.runs])

    def moved(self, column):
        """What each calibrated number would change, in blocks."""
        count = sum(len(s) for s in self.scaler.runs)
        columns = [self.blocks(lambda r, k=k: r.tangents[k][column]) for k in self.keys]
        return np.column_stack(columns) if columns else np.zeros((count, 0))

    def refit(self):
        """Takes off what a change of the calibrated numbers explains, by least squares over all channels.

        What is foretold starts from the calibrated scene as it is: a refit without the missing law would bend it.
        """
        rows = {c: np.isfinite(r) for c, r in self.residual.items()}
        matrix = np.concatenate([self.tangent[c][rows[c]] for c in self.case.outputs])
        target = np.concatenate([self.residual[c][rows[c]] for c in self.case.outputs])
        norms = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
        shift = np.linalg.lstsq(matrix / norms, target, rcond=1e-8)[0] / norms
        for c in self.case.outputs:
            self.residual[c] = self.residual[c] - self.tangent[c] @ shift

    def single_gains(self, column):
        """Log evidence of a process over each input alone, over that of noise: best over lengths and amplitudes."""
        valid = np.isfinite(self.residual[column])
        gains = [gain(e, self.residual[column][valid]) for e in self.eigen[column]]
        return np.array(gains).reshape(-1, len(LENGTHS)).max(axis=1)

    def by_chance(self, seed):
        """The same sum of best gains that noise alone reaches in one case of a hundred."""
        random = np.random.default_rng(seed)
        totals = np.zeros(DRAWS)
        for column in self.case.outputs:
            valid = np.isfinite(self.residual[column])
            drawn = np.column_stack([self.drawn(column, random) for _ in range(DRAWS)])[valid]
            totals += np.max([gain(e, drawn) for e in self.eigen[column]], axis=0)
        return float(np.quantile(totals, 1.0 - FALSE_ALARM_LEVEL))

    def drawn(self, column, random):
        """Block means of drawn noise, scaled as it would have been estimated itself."""
        runs, noise = draw_channel(self.case, column, self.noise[column], random)
        sizes = [self.scaler.size(r) for r in self.case.runs]
        blocks = np.concatenate([block_means(v, size) for v, size in zip(runs, sizes)])
        return blocks / noise.of_means(sizes[0]).slow_sd

    def foretell(self, column, gains, seed):
        """What the better of two processes adds on the holdout, by sample."""
        valid = np.isfinite(self.residual[column])
        chosen = self.choose(column, gains, valid)
        run = self.case.holdout
        if not chosen:
            return 0.0, []
        x, y, group = self.states[valid][:, chosen], self.raw[column][valid], self.run[valid]
        makers = {
            "none": lambda a, b: lambda q: np.zeros(len(q)),
            "sum": fit_sum,
            "ard": lambda a, b: fit_ard(a, b, seed),
        }
        errors = {k: left_out_error(x, y, group, make) for k, make in makers.items()}
        best = min(errors, key=errors.get)
        predict = makers[best](x, y)
        blocks = predict(self.scaler.of(run)[:, chosen]) * self.scale[column]
        return by_sample(blocks, run, self.scaler.size(run)), [best, *(label(self.scaler.names[j]) for j in chosen)]

    def choose(self, column, gains, valid):
        """Inputs one by one, while the evidence of their sum grows."""
        y, chosen, best = self.raw[column][valid], [], 0.0
        while len(chosen) < MOST_INPUTS:
            scores = {j: sum_gain(self.states[valid][:, [*chosen, j]], y) for j in promising(gains, chosen)}
            if not scores:
                break
            j = max(scores, key=scores.get)
            if scores[j] < best + LEAST_NATS + TOLERANCE * best:
                break
            chosen, best = [*chosen, j], scores[j]
        return chosen


def promising(gains, chosen):
    """Inputs worth trying: any that says something alone, the best ones first."""
    order = np.argsort(-gains)
    return [int(j) for j in order if j not in chosen][:14]


def low_rank(x, length, query=None):
    """Columns whose products are the kernel exp(-d^2/(2 l^2)), by inducing points at quantiles of x (Nystroem)."""
    query = x if query is None else query
    points = np.unique(np.quantile(x[:, 0], np.linspace(0.0, 1.0, INDUCING)))[:, None]
    inner = np.exp(-0.5 * ((points - points.T) / length) ** 2)
    outer = np.exp(-0.5 * ((query - points.T) / length) ** 2)
    values, vectors = np.linalg.eigh(inner)
    return outer @ (vectors / np.sqrt(np.maximum(values, 1e-6)))


def decompose(features, tangents, valid):
    """Directions and strengths of a low-rank kernel, freed of what the calibration could change."""
    basis = orthonormal(tangents[valid])
    own = features[valid] - basis @ (basis.T @ features[valid])
    vectors, values, _ = np.linalg.svd(own, full_matrices=False)
    return vectors, values**2


def gain(eigen, y):
    """Best log evidence over noise of unit deviation, over amplitudes; of a vector, or of columns."""
    vectors, values = eigen
    powers = (vectors.T @ y) ** 2
    best = -np.inf
    for amplitude in AMPLITUDES:
        strength = amplitude**2 * values
        share = (strength / (1.0 + strength))[:, None]
        ratio = 0.5 * (share * powers.reshape(len(values), -1)).sum(axis=0) - 0.5 * np.log1p(strength).sum()
        best = np.maximum(best, ratio)
    return best if y.ndim == 2 else float(best[0])


def sum_features(x, query=None):
    """Columns of a sum of single-input kernels and a constant."""
    query = x if query is None else query
    columns = [low_rank(x[:, [j]], 1.0, query[:, [j]]) for j in range(x.shape[1])]
    return np.column_stack([*columns, np.ones(len(query))])


def sum_gain(x, y):
    """Log evidence of a sum of single-input processes."""
    vectors, values, _ = np.linalg.svd(sum_features(x), full_matrices=False)
    return gain((vectors, values**2), y)


def fit_sum(x, y):
    """Mean of a sum of single-input processes; inputs beyond what was seen count as the nearest seen."""
    low, high = x.min(axis=0), x.max(axis=0)

    features = sum_features(x)
    values, vectors = np.linalg.eigh(features.T @ features)
    values = np.maximum(values, 0.0)
    projected = vectors.T @ (features.T @ y)
    scores = [evidence(values, projected, a) for a in AMPLITUDES]
    ridge = 1.0 / AMPLITUDES[int(np.argmax(scores))] ** 2
    weights = vectors @ (projected / (values + ridge))
    return lambda q: sum_features(x, np.clip(q, low, high)) @ weights


def evidence(values, projected, amplitude):
    """Log evidence over noise of a linear model with weights of that deviation."""
    strength = amplitude**2 * values
    return 0.5 * (amplitude**2 * projected**2 / (1.0 + strength)).sum() - 0.5 * np.log1p(strength).sum()


def fit_ard(x, y, seed):
    """A process with a length for each input: lengths from some rows, mean from all (projected on those)."""
    random = np.random.default_rng(seed)
    rows = np.sort(random.permutation(len(x))[:ARD_ROWS])
    sd = max(float(np.std(y)), 1.0)
    kernel = ConstantKernel(sd**2, (1e-2, 1e8)) * RBF(np.full(x.shape[1], 2.0), (0.1, 100.0))
    process = GaussianProcessRegressor(kernel, alpha=1.0, optimizer=short_search, random_state=seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)
        process.fit(x[rows], y[rows])
    points = x[rows]
    cross = process.kernel_(x, points)
    inner = process.kernel_(points)
    weights = solve_positive(inner + cross.T @ cross, cross.T @ y)
    low, high = x.min(axis=0), x.max(axis=0)
    return lambda q: process.kernel_(np.clip(q, low, high), points) @ weights


def solve_positive(matrix, target):
    """Solution with a positive matrix that may be close to singular."""
    values, vectors = np.linalg.eigh(matrix)
    return vectors @ ((vectors.T @ target) / np.maximum(values, 1e-11 * values[-1]))


def short_search(objective, start, bounds):
    """L-BFGS-B with a bound on its effort."""
    found = minimize(objective, start, jac=True, bounds=bounds, method="L-BFGS-B", options={"maxiter": 25})
    return found.x, found.fun


def left_out_error(x, y, group, make):
    """Squared error on each run, foretold from the others; of a single run, on its thirds."""
    if group.max() == 0:
        group = 3 * np.arange(len(y)) // len(y)
    error = 0.0
    for g in np.unique(group):
        predict = make(x[group != g], y[group != g])
        error += float(((y[group == g] - predict(x[group == g])) ** 2).sum())
    return error


def label(state):
    """A state's name as text."""
    kind, where = state
    return kind if where is None else f"{kind} {where + 1 if isinstance(where, int) else where}"


def name(data, gains):
    """The effect of the most telling input; one only, never two."""
    total = sum(gains)
    shares = np.array([g.max() for g in gains]) / max(sum(g.max() for g in gains), 1e-300)
    one = len(gains) > 1 and shares.max() > ONE_CHANNEL
    column = data.case.outputs[int(shares.argmax())]
    chances = {}
    weights = np.exp((total - total.max()) / (1.0 + TOLERANCE * total.max()))
    for state, weight in zip(data.scaler.names, weights / weights.sum()):
        key = read(data.rig, state, one, column)
        chances[key] = chances.get(key, 0.0) + weight
    best = max(chances, key=chances.get)
    effects = [effect(k[0], k[1], p, k[2]) for k, p in sorted(chances.items(), key=lambda x: -x[1]) if k[0] and p > 0.1]
    if best[0] is None:
        return "unknown_physics", best[1], effects
    return ("missing_physics" if chances[best] >= 0.9 else "ambiguous"), best[1], effects


def read(rig, state, one, column):
    """Effect, element, channel that an input stands for."""
    kind, where = state
    if one and kind in TABLE_ONE_CHANNEL:
        return (TABLE_ONE_CHANNEL[kind], "sensor", column)
    element, found = TABLE[kind]
    numbered = isinstance(where, int) and element != "mechanism"
    return (found, element + (rig.suffix(where) if numbered else ""), None)
