"""Residuals of all runs and channels in one whitened vector, and columns beside it."""

from dataclasses import dataclass

import numpy as np

from noise import block_means, estimate_noise, whiten

# Shares of the noise's variance per sample below which an effect is not called missing physics, nor misfit that nothing
# explains: scenes are idealisations. `smam diagnose` has the same floors.
FLOOR_PER_SAMPLE = 0.002
FLOOR_UNNAMED_PER_SAMPLE = 0.015
# Of a hundred cases that lack nothing, one may be called missing physics by chance.
FALSE_ALARM_LEVEL = 0.01


@dataclass
class Segment:
    """One channel of one run: its blocks."""

    run: int
    column: str
    valid: np.ndarray
    noise: object


class Rows:
    """Blocks of `block_s` of every channel of every run. Values handed in are {(run, column): values by sample}."""

    def __init__(self, case, block_s, noise=None):
        self.case = case
        self.sizes = [max(1, round(block_s / run.interval_s)) for run in case.runs]
        self.noise = noise or channel_noise(case)
        self.segments = []
        for index, run in enumerate(case.runs):
            for column in case.outputs:
                blocks = self.blocks(index, run.measured[column] - run.simulated[column])
                means = self.noise[column].of_means(self.sizes[index])
                self.segments.append(Segment(index, column, np.isfinite(blocks), means))
        counts = [s.valid.sum() * self.sizes[s.run] for s in self.segments]
        self.samples = sum(counts)
        # So many samples of white noise of the same deviation would say as much about what is slow.
        self.white_samples = sum(n / self.noise[s.column].inflation for n, s in zip(counts, self.segments))

    def blocks(self, run, values):
        """Means over the blocks of a run."""
        return block_means(values, self.sizes[run])

    def stack(self, values):
        """Whitened blocks of samples."""
        return self.stack_blocks({key: self.blocks(key[0], v) for key, v in values.items()})

    def stack_blocks(self, blocks, noise=None):
        """Whitened blocks; a channel that is not named is zero."""
        parts = []
        for s in self.segments:
            own = blocks.get((s.run, s.column))
            own = np.zeros(len(s.valid)) if own is None else own
            shape = (-1,) + (1,) * (own.ndim - 1)
            own = np.where(s.valid.reshape(shape), own, 0.0)
            means = noise[s.column].of_means(self.sizes[s.run]) if noise else s.noise
            parts.append(whiten(own, s.valid, means))
        return np.concatenate(parts)

    def residual(self):
        """What the calibrated scene leaves."""
        return self.of_runs(lambda run, column: run.measured[column] - run.simulated[column])

    def tangents(self):
        """What the calibrated numbers could change: one column each."""
        keys = list(self.case.runs[0].tangents)
        columns = [self.of_runs(lambda run, column, k=k: run.tangents[k][column]) for k in keys]
        return np.column_stack(columns) if columns else np.zeros((len(self.run_of_row()), 0))

    def of_runs(self, values):
        """Stacks what a function says of run and column."""
        runs = self.case.runs
        return self.stack({(s.run, s.column): values(runs[s.run], s.column) for s in self.segments})

    def run_of_row(self):
        """Which run a row belongs to."""
        return np.concatenate([np.full(s.valid.sum(), s.run) for s in self.segments])

    def draw(self, random):
        """The same vector if there were nothing but noise: drawn by sample, its size and colour estimated anew."""
        values, noise = {}, {}
        for column in self.case.outputs:
            own, noise[column] = draw_channel(self.case, column, self.noise[column], random)
            values |= {(i, column): self.blocks(i, v) for i, v in enumerate(own)}
        return self.stack_blocks(values, noise)


def channel_noise(case):
    """Noise of every channel."""
    found = {}
    for column in case.outputs:
        residuals = [run.measured[column] - run.simulated[column] for run in case.runs]
        found[column] = estimate_noise(residuals, case.stated_sd[column], case.runs[0].interval_s)
    return found


def draw_channel(case, column, noise, random):
    """Drawn noise of a channel by run, missing where its recording is, and that noise estimated anew."""
    drawn = [np.where(np.isfinite(r.measured[column]), noise.draw(len(r.time_s), random), np.nan) for r in case.runs]
    return drawn, estimate_noise(drawn, case.stated_sd[column], case.runs[0].interval_s)


def orthonormal(columns):
    """Orthonormal basis of columns of full rank or less."""
    if columns.shape[1] == 0:
        return columns
    scaled = columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    u, s, _ = np.linalg.svd(scaled, full_matrices=False)
    return u[:, s > 1e-8 * s[0]]


def without(basis, values):
    """What is orthogonal to a basis."""
    return values - basis @ (basis.T @ values)
