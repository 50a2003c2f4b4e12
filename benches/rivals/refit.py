"""The calibrated scene and nothing else: says whether what it leaves is more than noise."""

import numpy as np

from answer import Answer
from rows import FALSE_ALARM_LEVEL, FLOOR_UNNAMED_PER_SAMPLE, Rows, orthonormal, without

BLOCK_S = 0.25
DRAWS = 199


def answer(case, seed):
    """chi^2 of block means, colour allowed for, against draws of noise that went through the same estimates."""
    test = misfit_test(case, seed)
    verdict = "unknown_physics" if test["is_misfit"] else "adequate"
    return Answer(verdict, notes={k: v for k, v in test.items() if k != "noise"})


def misfit_test(case, seed):
    """Excess of chi^2 after a linear refit of the calibrated numbers to all runs, and from where on it counts."""
    random = np.random.default_rng(seed)
    rows = Rows(case, BLOCK_S)
    basis = orthonormal(rows.tangents())

    def excess(vector):
        left = without(basis, vector)
        return float(left @ left - len(left) + basis.shape[1])

    found = excess(rows.residual())
    draws = [excess(rows.draw(random)) for _ in range(DRAWS)]
    by_chance = float(np.quantile(draws, 1.0 - FALSE_ALARM_LEVEL))
    floor = FLOOR_UNNAMED_PER_SAMPLE * rows.white_samples
    return {
        "excess_chi2": found,
        "by_chance": by_chance,
        "floor": float(floor),
        "excess_chi2_per_sample": found / rows.samples,
        "noise_inflation": {c: round(n.inflation, 3) for c, n in rows.noise.items()},
        "is_misfit": bool(found > max(by_chance, floor)),
    }
