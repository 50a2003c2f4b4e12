"""Sparse regression of the residual on a library of causes (pysindy's optimisers), read through an open table."""

import warnings

import numpy as np
import pysindy

import library
from answer import Answer, effect
from refit import misfit_test
from rig import Rig
from rows import FALSE_ALARM_LEVEL, FLOOR_PER_SAMPLE, Rows, orthonormal, without

DRAWS = 199
MOST_TERMS = 8
THRESHOLDS = 8
RIDGE = 1e-3
# Laws are idealisations, and the library is linear: differences count in proportion to what is explained.
TOLERANCE = 0.005
# An effect that explains less of what is explained than this is left out.
LEAST_SHARE = 0.02
# With more of the misfit left than this, the library does not know what is missing.
MOST_LEFT = 0.3
# Terms that the catalogue does not know are tried where named ones leave more than this share of the misfit, and taken
# when they leave less than half of that.
WORTH_TRYING = 0.01
MUCH_BETTER = 0.5
SURE = 0.9
# A lesser effect that another could replace better is not named.
HALF = 0.5


def answer(case, seed):
    """Selects terms, reads them as effects, says what they foretell on the holdout."""
    problem = Problem(case, seed)
    if not problem.is_seen():
        test = misfit_test(case, seed)
        return Answer("unknown_physics" if test["is_misfit"] else "adequate", notes=problem.notes([]))
    support = problem.select(problem.named())
    if problem.share_left(support) > WORTH_TRYING:
        free = problem.select(problem.usable)
        if problem.share_left(free) < MUCH_BETTER * problem.share_left(support):
            support = free
    if not support:
        return Answer("unknown_physics", notes=problem.notes([]))
    return read(problem, support)


class Problem:
    """Whitened residual and library of one case."""

    def __init__(self, case, seed):
        self.case, self.rig = case, Rig(case.scene, case.numbers)
        self.rows = Rows(case, library.BLOCK_S)
        self.limits = library.range_limits(self.rig, case)
        by_run = [library.terms(self.rig, case, run, self.limits) for run in case.runs]
        blocks = {}
        for i, run in enumerate(case.runs):
            seen = library.shown(self.rig, case, run, by_run[i], self.rows.sizes[i])
            blocks |= {(i, column): values for column, values in seen.items()}
        self.terms, columns = by_run[0], self.rows.stack_blocks(blocks)
        self.tangents, self.y = self.rows.tangents(), self.rows.residual()
        self.basis = orthonormal(self.tangents)
        self.scale = np.linalg.norm(columns, axis=0)
        self.columns = columns / np.maximum(self.scale, 1e-300)
        self.own = without(self.basis, self.columns)
        self.length = np.linalg.norm(self.own, axis=0)
        self.usable = (self.scale > 0.0) & (self.length > 1e-3)
        self.unit = np.where(self.usable, self.own / np.maximum(self.length, 1e-3), 0.0)
        self.left = without(self.basis, self.y)
        self.threshold, self.chi2_of_noise = self.by_chance(seed)

    def by_chance(self, seed):
        """The correlation, in standard deviations, that the best term of the library reaches by chance in one case of a
        hundred, and never less than the floor of an idealised scene; and the chi^2 that noise alone so reaches."""
        random = np.random.default_rng(seed)
        draws = [without(self.basis, self.rows.draw(random)) for _ in range(DRAWS)]
        best = [np.abs(self.unit.T @ d).max() for d in draws]
        threshold, chi2 = (np.quantile(v, 1.0 - FALSE_ALARM_LEVEL) for v in (best, [d @ d for d in draws]))
        return float(max(threshold, np.sqrt(FLOOR_PER_SAMPLE * self.rows.samples))), float(chi2)

    def is_seen(self):
        """Whether any term explains more than chance."""
        return bool(np.abs(self.unit.T @ self.left).max() > self.threshold)

    def named(self):
        """Terms that stand for an effect of the catalogue."""
        return self.usable & np.array([t.effect is not None for t in self.terms])

    def select(self, pool):
        """The best support of a pool of terms, freed of what explains too little."""
        return self.prune(self.best_support(pool))

    def share_left(self, support):
        """Misfit left by a support beyond what noise alone may leave, of all misfit of the calibrated scene."""
        rows = len(self.y) - self.basis.shape[1]
        return max(self.chi2(support) - self.chi2_of_noise, 0.0) / max(self.chi2([]) - rows, 1.0)

    def best_support(self, pool):
        """Of all supports that the optimisers propose the sparsest within one standard error of the best, each run
        foretold from the others."""
        proposals = sorted(self.proposals(pool), key=lambda s: (len(s), sorted(s)))
        scored = [(self.cross_validated(s), s) for s in proposals]
        best = min((score for score, _ in scored), key=lambda s: s.sum())
        for score, support in scored:
            worse = score - best
            if worse.sum() <= np.sqrt(len(worse)) * worse.std() + TOLERANCE * self.explained(support):
                return list(support)
        return []

    def proposals(self, pool):
        """Supports along the paths of FROLS and STLSQ."""
        found = set()
        usable = np.flatnonzero(pool)
        # The optimisers use products of columns only: those of the triangular factor are the same, with fewer rows.
        rotation, matrix = np.linalg.qr(self.unit[:, usable])
        target = (rotation.T @ self.left)[:, None]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for count in range(1, MOST_TERMS + 1):
                fit = pysindy.FROLS(max_iter=count, alpha=RIDGE, unbias=False).fit(matrix, target)
                found.add(frozenset(usable[np.flatnonzero(fit.coef_[0])]))
            top = np.abs(matrix.T @ target).max()
            for threshold in np.geomspace(self.threshold, max(top, 1.01 * self.threshold), THRESHOLDS):
                fit = pysindy.STLSQ(threshold=threshold, alpha=0.1, unbias=False).fit(matrix, target)
                found.add(frozenset(usable[np.flatnonzero(fit.coef_[0])]))
        return [s for s in found if 0 < len(s) <= 3 * MOST_TERMS]

    def cross_validated(self, support):
        """Squared errors by row, each run foretold by a fit to the others."""
        matrix = np.column_stack(
            [
                self.tangents / np.maximum(np.linalg.norm(self.tangents, axis=0), 1e-300),
                self.columns[:, sorted(support)],
            ]
        )
        runs = self.rows.run_of_row()
        if runs.max() == 0:
            runs = (3 * np.arange(len(runs))) // len(runs)
        errors = np.zeros(len(self.y))
        for run in range(runs.max() + 1):
            fit = solve(matrix[runs != run], self.y[runs != run])
            errors[runs == run] = self.y[runs == run] - matrix[runs == run] @ fit
        return errors**2

    def chi2(self, support):
        """Of a joint fit of calibration and terms."""
        if not support:
            return float(self.left @ self.left)
        basis = orthonormal(self.own[:, sorted(support)])
        left = without(basis, self.left)
        return float(left @ left)

    def explained(self, support):
        """chi^2 that a support takes away."""
        return self.chi2([]) - self.chi2(support)

    def prune(self, support):
        """Leaves out effects that explain less than chance, than a share of all, or than what stays unexplained."""
        support = list(support)
        while support:
            unexplained = self.chi2(support) - len(self.y)
            least = max(self.threshold**2, LEAST_SHARE * self.explained(support))
            if len(self.groups(support)) > 1:
                least = max(least, unexplained)
            groups = self.groups(support)
            costs = {k: self.chi2([s for s in support if s not in g]) - self.chi2(support) for k, g in groups.items()}
            key = min(costs, key=costs.get)
            if costs[key] >= least:
                break
            support = [s for s in support if s not in groups[key]]
        return support

    def groups(self, support):
        """Terms of a support by effect and element."""
        found = {}
        for s in support:
            found.setdefault(self.terms[s].key, []).append(s)
        return found

    def everything_of(self, key):
        """All usable terms of an effect on an element."""
        return [k for k, t in enumerate(self.terms) if t.key == key and self.usable[k]]

    def correction(self, support):
        """What calibration and terms add on the holdout, by sample."""
        run, case = self.case.holdout, self.case
        norms = np.maximum(np.linalg.norm(self.tangents, axis=0), 1e-300)
        fit = solve(np.column_stack([self.tangents / norms, self.columns[:, support]]), self.y)
        calibration, sizes = fit[: len(norms)] / norms, fit[len(norms) :] / self.scale[support]
        terms = library.terms(self.rig, case, run, self.limits)
        size = max(1, round(library.BLOCK_S / run.interval_s))
        shown = library.shown(self.rig, case, run, [terms[s] for s in support], size)
        added = {}
        for column in case.outputs:
            middle = (np.arange(len(shown[column])) + 0.5) * size - 0.5
            added[column] = np.interp(np.arange(len(run.time_s)), middle, shown[column] @ sizes)
            added[column] += sum(c * run.tangents[k][column] for c, k in zip(calibration, run.tangents))
        return added

    def notes(self, support):
        """What a reader may want to check."""
        return {
            "threshold_sigma": self.threshold,
            "largest_sigma": float(np.abs(self.unit.T @ self.left).max()),
            "terms": [f"{self.terms[s].family} {self.terms[s].detail} ({self.terms[s].element})" for s in support],
            "chi2_per_row": [self.chi2([]) / len(self.y), self.chi2(support) / len(self.y)],
        }


def solve(matrix, target):
    """Least squares that bears columns that are nearly the same."""
    return np.linalg.lstsq(matrix, target, rcond=1e-9)[0]


def read(problem, support):
    """Terms as effects: each with the chance that it is itself and not the term that could best stand in for it."""
    groups = problem.groups(support)
    full = problem.chi2(support)
    costs = {k: problem.chi2([s for s in support if s not in g]) - full for k, g in groups.items()}
    share_left = problem.share_left(support)
    unknown = [k for k in groups if k[0] in library.TABLE]
    main, effects, sure = max(costs, key=costs.get), [], []
    for key in sorted(groups, key=lambda k: -costs[k]):
        if key in unknown:
            continue
        likely = chances(problem, support, key, groups[key])
        if key == main or own_chance(likely, key) >= HALF:
            effects += likely
            sure.append(own_chance(likely, key))
    if share_left > MOST_LEFT or main in unknown:
        verdict = "unknown_physics"
    else:
        verdict = "missing_physics" if min(sure) >= SURE else "ambiguous"
    effects = merged(effects)
    notes = problem.notes(support) | {"share_of_misfit_left": share_left, "unnamed": [" ".join(k[:2]) for k in unknown]}
    return Answer(verdict, main[1], effects, problem.correction(support), notes)


def merged(effects):
    """Each effect once, with the greatest of its probabilities: it may rival several."""
    found = {}
    for e in effects:
        key = (e["name"], e["element"], e.get("channel"))
        if key not in found or found[key]["probability"] < e["probability"]:
            found[key] = e
    return list(found.values())


def own_chance(effects, key):
    """Probability of an effect among itself and its rivals."""
    same = [e["probability"] for e in effects if (e["name"], e["element"], e.get("channel")) == key]
    return max(same, default=0.0)


def chances(problem, support, key, group):
    """The effect and its rivals: all terms of another effect put in place of all its own."""
    rest = [s for s in support if s not in group]
    keys = {t.key for t in problem.terms if t.effect} - {k for k in problem.groups(rest)}
    chi2 = {k: problem.chi2(rest + problem.everything_of(k)) for k in keys if problem.everything_of(k)}
    spread = 2.0 * (1.0 + TOLERANCE * problem.explained(support))
    weights = {k: np.exp(-(v - chi2[key]) / spread) for k, v in chi2.items()}
    total = sum(weights.values())
    named = sorted(((w / total, k) for k, w in weights.items()), key=lambda x: (-x[0], x[1][:2]))
    return [effect(k[0], k[1], p, k[2]) for p, k in named if k == key or p > 0.1]
