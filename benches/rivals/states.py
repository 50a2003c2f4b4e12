"""What may tell a black box where a rig is and where it has been: states of the simulation and its inputs."""

import numpy as np

from noise import block_means
from rig import dahl, integral, low_pass, motion, play_operator

PLAY_WIDTH_M = 3e-5


def states(rig, run):
    """Named states of a run, by sample. A name is kind, or kind and number of muscle, or kind and channel."""
    m = motion(rig, run)
    t = m.time_s - m.time_s[0]
    named = {("time", None): t}
    for i in range(rig.muscles):
        x, e, p = m.plunger_m[i], m.elongation_m[i], m.pressure_pa[i]
        named |= {
            ("plunger", i): x,
            ("plunger_speed", i): smooth_rate(x, t),
            ("plunger_play", i): play_operator(x, PLAY_WIDTH_M),
            ("pressure", i): p,
            ("pressure_rate", i): smooth_rate(p, t),
            ("pressure_integral", i): integral(p - p[0] * (rig.start_m > 0.0), t),
            ("elongation", i): e,
            ("elongation_rate", i): smooth_rate(e, t),
            ("elongation_memory_fast", i): e - low_pass(e, t, 1.0),
            ("elongation_memory_slow", i): e - low_pass(e, t, 10.0),
            ("below_greatest_elongation", i): np.maximum.accumulate(e) - e,
            ("sliding", i): m.sliding[i],
        }
        if rig.muscles > 1:
            named[("tension", i)] = m.pull_n[i]
    for j, c in enumerate(rig.coordinates if rig.muscles > 1 else ()):
        named |= {("joint", c.column): m.joint[j], ("joint_sliding", c.column): dahl(m.joint[j], 0.03)}
        named[("joint_rate", c.column)] = smooth_rate(m.joint[j], t)
    return named


def smooth_rate(values, time_s):
    """Rate of what a filter of 0.03 s leaves."""
    return np.gradient(low_pass(values, time_s, 0.03), time_s)


class Scaler:
    """States of the fitted runs as blocks, each of mean 0 and deviation 1; the same scaling elsewhere."""

    def __init__(self, rig, runs, block_s):
        self.rig, self.block_s = rig, block_s
        raw = [states(rig, run) for run in runs]
        blocks = [self.blocked(run, r) for run, r in zip(runs, raw)]
        everything = np.concatenate(blocks)
        self.mean, sd = everything.mean(axis=0), everything.std(axis=0)
        self.kept = sd > 1e-9 * np.abs(everything).max(axis=0)
        self.sd = np.where(self.kept, sd, 1.0)
        self.names = [n for n, k in zip(raw[0], self.kept) if k]
        self.runs = [self.scaled(b) for b in blocks]

    def size(self, run):
        """Samples of a block."""
        return max(1, round(self.block_s / run.interval_s))

    def blocked(self, run, named):
        """Block means, one column per state."""
        return block_means(np.column_stack(list(named.values())), self.size(run))

    def scaled(self, blocks):
        """Scaled, constant ones left out."""
        return ((blocks - self.mean) / self.sd)[:, self.kept]

    def of(self, run):
        """Scaled states of another run."""
        return self.scaled(self.blocked(run, states(self.rig, run)))


def by_sample(blocks, run, size):
    """Block values as samples, straight lines between the blocks' middles."""
    middle = (np.arange(len(blocks)) + 0.5) * size - 0.5
    return np.interp(np.arange(len(run.time_s)), middle, blocks)
