"""A black box: polynomial NARX of what the calibrated scene leaves, simulated freely; it names nothing."""

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from answer import Answer
from noise import block_means
from rig import Rig
from rows import FLOOR_PER_SAMPLE, channel_noise
from states import Scaler, by_sample

BLOCK_S = 0.1
# Gain on runs not seen, in its own standard errors, from which on it is believed: the best of several orders is taken.
LEAST_SIGMA = 3.0
# Pieces of every run that are left out in turn to decide whether there is anything.
QUARTERS = 4
PIECE_S = 2.0
RIDGES = (10.0, 300.0, 10000.0)
REPEATS = 4


@dataclass(frozen=True)
class Order:
    """Degree of the polynomial in the states, number of own past values fed back, whether time is a state."""

    degree: int
    lags: int
    time: bool
    ridge: float


ORDERS = [Order(d, n, t, r) for d, n in ((1, 0), (1, 1), (1, 2), (2, 0), (2, 1)) for t in (False, True) for r in RIDGES]


def answer(case, seed):
    """Decides on left-out pieces whether there is anything; chooses the order, or nothing, on left-out runs."""
    del seed
    data = Data(case)
    pieces = np.concatenate([data.pieces(data.best_gain(c, data.quarters())[1]) for c in case.outputs])
    total, error = pieces.sum(), np.sqrt(len(pieces)) * pieces.std()
    floor = FLOOR_PER_SAMPLE * data.samples
    notes = {"gain_chi2": float(total), "gain_sigma": float(total / max(error, 1e-300)), "floor": float(floor)}
    if total <= max(LEAST_SIGMA * error, floor):
        return Answer("adequate", notes=notes)
    correction, orders = {}, {}
    for column in case.outputs:
        order, gain = data.best_gain(column, data.whole_runs())
        if gain.sum() > 0.0:
            correction[column], orders[column] = data.foretell(column, order), vars(order)
    return Answer("unknown_physics", correction=correction, notes=notes | {"orders": orders})


class Data:
    """Regressors and residuals in blocks, by run."""

    def __init__(self, case):
        self.case, self.rig = case, Rig(case.scene, case.numbers)
        self.scaler = Scaler(self.rig, case.runs, BLOCK_S)
        self.size = self.scaler.size(case.runs[0])
        self.noise = channel_noise(case)
        self.scale = {c: n.of_means(self.size).slow_sd for c, n in self.noise.items()}
        self.residual = {
            c: [block_means(r.measured[c] - r.simulated[c], self.size) / self.scale[c] for r in case.runs]
            for c in case.outputs
        }
        self.samples = self.size * sum(np.isfinite(r).sum() for rs in self.residual.values() for r in rs)
        self.cache = {}

    def inputs(self, order, run=None):
        """Regressors without feedback: polynomial in the states."""
        key = (order.degree, order.time)
        if run is not None:
            return polynomial(self.reduced(self.scaler.of(run), order.time), order.degree)
        if key not in self.cache:
            self.cache[key] = [polynomial(self.reduced(s, order.time), order.degree) for s in self.scaler.runs]
        return self.cache[key]

    def reduced(self, states, time):
        """States with or without time, within the range of the fitted ones."""
        kept = [j for j, (kind, _) in enumerate(self.scaler.names) if time or kind not in ("time", "pressure_integral")]
        return np.clip(states[:, kept], -4.0, 4.0)

    def whole_runs(self):
        """Each run left out in turn; of a single run, its quarters."""
        count = len(self.case.runs)
        if count == 1:
            return self.quarters()
        return [[np.full(len(s), i == fold) for i, s in enumerate(self.scaler.runs)] for fold in range(count)]

    def quarters(self):
        """A quarter of every run left out in turn."""
        place = [QUARTERS * np.arange(len(s)) // len(s) for s in self.scaler.runs]
        return [[p == fold for p in place] for fold in range(QUARTERS)]

    def best_gain(self, column, folds):
        """The order that foretells best what is left out, and what each block gains over the calibrated scene."""
        scores = {order: np.zeros(sum(len(s) for s in self.scaler.runs)) for order in ORDERS}
        for fold in folds:
            grams = {}
            for order in ORDERS:
                scores[order] += self.left_out(column, order, fold, grams)
        best = min(ORDERS, key=lambda o: scores[o].sum())
        squares = np.concatenate(self.residual[column]) ** 2
        return best, np.where(np.isfinite(squares), squares, 0.0) - scores[best]

    def left_out(self, column, order, fold, grams):
        """Squared errors by block of a fold, simulated by a model of the rest; elsewhere 0."""
        residual, inputs = self.residual[column], self.inputs(order)
        model = fit(inputs, residual, [~f for f in fold], order, grams)
        squares = []
        for x, r, mask in zip(inputs, residual, fold):
            error = (r - model(x)) ** 2 if mask.any() else np.zeros(len(r))
            squares.append(np.where(mask & np.isfinite(error), error, 0.0))
        return np.concatenate(squares)

    def pieces(self, values):
        """Sums over pieces of a run."""
        length = max(1, round(PIECE_S / BLOCK_S))
        edges = np.cumsum([0, *(len(s) for s in self.scaler.runs)])
        parts = [
            values[a:b][k : k + length].sum() for a, b in zip(edges[:-1], edges[1:]) for k in range(0, b - a, length)
        ]
        return np.array(parts)

    def foretell(self, column, order):
        """What a model of all runs adds on the holdout, by sample."""
        everything = [np.ones(len(s), dtype=bool) for s in self.scaler.runs]
        model = fit(self.inputs(order), self.residual[column], everything, order, {})
        blocks = model(self.inputs(order, self.case.holdout)) * self.scale[column]
        return by_sample(blocks, self.case.holdout, self.size)


def polynomial(states, degree):
    """States, their squares and products, and a constant."""
    columns = [np.ones(len(states)), *states.T]
    if degree > 1:
        columns += [states[:, i] * states[:, j] for i in range(states.shape[1]) for j in range(i + 1)]
    return np.column_stack(columns)


def fit(inputs, residual, masks, order, grams):
    """Ridge, then again with what the model itself says fed back in place of what was measured.

    `grams` keeps products of the regressors for the other orders of the same fold.
    """
    shown = [np.where(np.isfinite(r), r, 0.0) for r in residual]
    bound = 3.0 * max(np.abs(s).max() for s in shown)
    rows = [m & np.isfinite(r) for m, r in zip(masks, residual)]
    target = np.concatenate([r[k] for r, k in zip(residual, rows)])
    matrix = np.concatenate([x[k] for x, k in zip(inputs, rows)])
    key = (order.degree, order.time)
    if key not in grams:
        grams[key] = (matrix.T @ matrix, matrix.T @ target)
    weights = None
    for _ in range(REPEATS if order.lags else 1):
        past = np.concatenate([lagged(s, order.lags)[k] for s, k in zip(shown, rows)])
        weights = ridge(grams[key], matrix, past, target, order.ridge)
        if order.lags:
            shown = [simulate(x, weights, order.lags, bound) for x in inputs]
    return lambda x: simulate(x, weights, order.lags, bound)


def lagged(shown, lags):
    """The past of a channel, one column per lag."""
    past = [np.concatenate([np.zeros(n), shown[:-n]]) for n in range(1, lags + 1)]
    return np.column_stack(past) if past else np.zeros((len(shown), 0))


def ridge(gram, matrix, past, target, strength):
    """Least squares with a penalty on all but the constant; `gram` holds the products of the matrix and the target."""
    inner, outer = gram
    cross = matrix.T @ past
    whole = np.block([[inner, cross], [cross.T, past.T @ past]])
    penalty = np.full(len(whole), strength)
    penalty[0] = 1e-6
    return np.linalg.solve(whole + np.diag(penalty), np.concatenate([outer, past.T @ target]))


def simulate(inputs, weights, lags, bound):
    """Free run: the model's own past is fed back."""
    drive = inputs @ weights[: inputs.shape[1]]
    if lags == 0:
        return np.clip(drive, -bound, bound)
    feedback = weights[inputs.shape[1] :]
    with np.errstate(over="ignore", invalid="ignore"):
        shown = lfilter([1.0], np.concatenate([[1.0], -feedback]), drive)
    return np.clip(np.nan_to_num(shown, nan=bound, posinf=bound, neginf=-bound), -bound, bound)
