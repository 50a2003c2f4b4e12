"""The terms of the sparse regression, each with the effect of the catalogue that it is read as.

A term is a cause inside the calibrated simulation (a volume, a pull, a torque, a reading), of size one. `TABLE` is the
open mapping; the README shows it.
"""

from dataclasses import dataclass, field

import numpy as np

from noise import block_means
from rig import dahl, integral, low_pass, motion, play_operator, respond

# term family -> (element, effect of the catalogue, what stands in the balance)
TABLE = {
    "air": ("line", "trapped_air", "volume of a gas under the simulated pressure, kappa 1 and 1.4"),
    "pressure_flow": ("line", "leak", "flow linear in pressure"),
    "time_flow": ("line", "thermal_expansion", "volume linear in time"),
    "flow_loss": ("line", "line_restriction", "pressure lost over the line, linear and quadratic in the flow"),
    "plunger_play": ("syringe", "plunger_backlash", "volume of a play operator of the plunger, five widths"),
    "elongation_memory": ("muscle", "viscoelasticity", "pull by elongation minus its low-pass, six times"),
    "greatest_energy": ("muscle", "mullins_softening", "wall force times tanh((W_max - W)/0.02 J)"),
    "set": ("muscle", "plastic_set", "stiffness times integral of elongation above a threshold, four thresholds"),
    "opening": ("muscle", "coil_preload", "pull by tanh(e/0.25 mm)"),
    "constant_pull": ("muscle", "gravity_load", "constant pull"),
    "slack": ("cable", "cable_slack", "constant length between muscle and joint"),
    "wrap_friction": ("cable", "tendon_friction", "tension times wrap times sliding state"),
    "joint_friction": ("mechanism", "bearing_friction", "sliding state of the joint, two presliding angles"),
    "other_tension": ("mechanism", "tendon_coupling", "tension of the other cable as a torque"),
    "one_sided": ("mechanism", "external_contact", "one-sided spring on a joint, from six angles"),
    "channel_rate": ("sensor", "sensor_lag", "rate of the channel, and its second rate"),
    "channel_time": ("sensor", "sensor_drift", "time, on one channel"),
    "channel_level": ("sensor", "sensor_gain", "the channel itself"),
    "free_pull": ("muscle", None, "pulls by e^2, e^3, e p, p, p^2 and by speed"),
    "free_flow": ("line", None, "flows by p^2, p^3, e, and by speed times p"),
    "free_torque": ("mechanism", None, "torques by q, q^3 and joint speed"),
}
BLOCK_S = 0.05
SHARES = (0.2, 0.4, 0.6, 0.8)


@dataclass
class Term:
    """One column of the library in one run: causes by sample, of muscles, joints or channels."""

    family: str
    detail: str
    element: str
    channel: str | None = None
    volume: dict = field(default_factory=dict)
    force: dict = field(default_factory=dict)
    torque: dict = field(default_factory=dict)
    reading: dict = field(default_factory=dict)

    @property
    def effect(self):
        """The catalogue's name, or None."""
        return TABLE[self.family][1]

    @property
    def key(self):
        """What makes an answer: effect, element, channel."""
        return (self.effect or self.family, self.element, self.channel)


def terms(rig, case, run, limits):
    """All terms of a run; `limits` are ranges over all runs, so that every run has the same columns."""
    inside = motion(rig, run)
    found = []
    for i in range(rig.muscles):
        found += muscle_terms(rig, inside, i, limits)
    if rig.muscles > 1:
        found += common_terms(found)
    for j in range(len(rig.coordinates)):
        found += joint_terms(rig, inside, j, limits)
    for column in case.outputs:
        found += channel_terms(run, column)
    return found


def range_limits(rig, case):
    """Greatest elongation and extremes of the joints over all runs that the answer may rest on."""
    motions = [motion(rig, run) for run in case.runs]
    elongation = max(e.max() for m in motions for e in m.elongation_m)
    joints = [
        (min(m.joint[j].min() for m in motions), max(m.joint[j].max() for m in motions))
        for j in range(len(rig.coordinates))
    ]
    return {"elongation": elongation, "joints": joints}


def muscle_terms(rig, m, i, limits):
    """Causes in syringe, line, muscle and cable of one muscle."""
    made = []

    def add(family, detail, **causes):
        element = TABLE[family][0] + rig.suffix(i)
        made.append(Term(family, detail, element, None, **causes))

    t, e, p = m.time_s - m.time_s[0], m.elongation_m[i], m.pressure_pa[i]
    line_terms(rig, m, i, t, e, p, add)
    for width_um in (3, 10, 30, 80, 200):
        lost = rig.syringe_area_m2 * play_operator(m.plunger_m[i], width_um * 1e-6)
        add("plunger_play", f"{width_um} um", volume={i: lost})
    for tau_s in (0.1, 0.3, 1, 3, 10, 30):
        add("elongation_memory", f"{tau_s} s", force={i: e - low_pass(e, t, tau_s)})
    energy = rig.elastic.at(rig.elastic.energy_j, e)
    softer = np.tanh((np.maximum.accumulate(energy) - energy) / 0.02)
    add("greatest_energy", "", force={i: -rig.elastic.at(rig.elastic.wall_n, e) * softer})
    for share in SHARES:
        set_m = integral(np.maximum(e - share * limits["elongation"], 0.0), t)
        stiffness = rig.elastic.at(rig.elastic.stiffness_n_m, e)
        add("set", f"{share}", force={i: -stiffness * set_m})
    start = 0.0 if rig.start_m == 0.0 else 1.0
    add("opening", "", force={i: np.tanh(e / 0.25e-3) - start})
    add("constant_pull", "", force={i: np.ones(len(t))})
    free_terms(m, i, e, p, t, add)
    if rig.muscles > 1:
        cable_terms(rig, m, i, add)
    return made


def line_terms(rig, m, i, t, e, p, add):
    """Causes in the line."""
    absolute = np.maximum(1.0 + p / rig.atmosphere_pa, 0.02)
    for kappa in (1.0, 1.4):
        gas = absolute ** (-1.0 / kappa)
        add("air", f"kappa {kappa}", volume={i: gas - gas[0]})
    add("pressure_flow", "p", volume={i: -integral(p, t)})
    add("time_flow", "t", volume={i: t})
    flow = np.gradient(rig.core_m2 * e + rig.downstream_m3_pa * p, t)
    for detail, loss in (("Q", rig.resistance_pa_s_m3 * flow), ("Q|Q|", flow * np.abs(flow) * 1e19)):
        add("flow_loss", detail, volume={i: -rig.upstream_m3_pa * loss}, reading={rig.pressures[i]: loss * 1e-3})


def free_terms(m, i, e, p, t, add):
    """Causes that the catalogue does not know."""
    speed = np.gradient(e, t)
    pulls = {"e^2": e**2, "e^3": e**3, "e p": e * p, "p": p, "p^2": p**2, "de/dt": speed}
    for detail, pull in pulls.items():
        add("free_pull", detail, force={i: pull - pull[0]})
    for detail, flow in {"p^2": p**2, "p^3": p**3, "e": e, "p |de/dt|": p * np.abs(speed)}.items():
        add("free_flow", detail, volume={i: -integral(flow, t)})


def cable_terms(rig, m, i, add):
    """Causes between muscle and joint."""
    e = m.elongation_m[i]
    ones = np.ones(len(e))
    stiffness = rig.elastic.at(rig.elastic.stiffness_n_m, e)
    add("slack", "", volume={i: rig.core_m2 * ones}, force={i: -stiffness * ones})
    tension = np.maximum(m.pull_n[i], 0.0)
    for j, joint in enumerate(rig.coordinates):
        if joint.levers[i] == 0.0:
            continue
        drawn = joint.levers[i] * m.joint[j]
        lost = joint.levers[i] * tension * np.abs(m.joint[j]) * dahl(drawn, 1e-4)
        add("wrap_friction", "", torque={j: -lost})


def common_terms(single):
    """The same cause in both muscles at once: one make, one fluid."""
    first = [t for t in single if t.element.endswith("_1")]
    second = [t for t in single if t.element.endswith("_2")]
    both = []
    for a, b in zip(first, second):
        merged = {k: {**getattr(a, k), **getattr(b, k)} for k in ("volume", "force", "reading")}
        merged["torque"] = {j: a.torque.get(j, 0.0) + b.torque.get(j, 0.0) for j in {*a.torque, *b.torque}}
        both.append(Term(a.family, a.detail, a.element[:-2], None, **merged))
    return both


def joint_terms(rig, m, j, limits):
    """Causes at a joint; the bench's slider has none."""
    if rig.muscles == 1:
        return []
    q, t = m.joint[j], m.time_s - m.time_s[0]
    made = []

    def add(family, detail, torque):
        made.append(Term(family, f"{rig.coordinates[j].column} {detail}", TABLE[family][0], None, torque={j: torque}))

    for turn in (0.01, 0.05):
        add("joint_friction", f"{turn} rad", -dahl(q, turn))
    low, high = limits["joints"][j]
    for share in (0.3, 0.55, 0.8):
        add("one_sided", f"above {share}", -np.maximum(q - share * high, 0.0))
        if low < -0.2 * high:
            add("one_sided", f"below {share}", -np.minimum(q - share * low, 0.0))
    for i, joint_lever in enumerate(rig.coordinates[j].levers):
        if joint_lever == 0.0:
            add("other_tension", "", m.pull_n[i] - m.pull_n[i][0])
    for detail, torque in {"q": q, "q^3": q**3, "dq/dt": np.gradient(q, t)}.items():
        add("free_torque", detail, -torque)
    return made


def channel_terms(run, column):
    """Causes in a sensor."""
    t, y = run.time_s - run.time_s[0], run.simulated[column]
    rate = np.gradient(y, t)
    smooth = low_pass(rate, t, 0.02)
    columns = [
        ("channel_rate", "rate", -rate),
        ("channel_rate", "second rate", np.gradient(smooth, t)),
        ("channel_time", "t", t),
        ("channel_level", "y", y),
    ]
    return [Term(f, d, "sensor", column, reading={column: v}) for f, d, v in columns]


def shown(rig, case, run, run_terms, size):
    """What the terms of a run show: {column: (blocks, terms)}, in the columns' units."""
    inside = motion(rig, run)

    def by_block(values):
        return block_means(np.column_stack(values), size)

    states = {
        "elongation": by_block(inside.elongation_m),
        "pressure": by_block(inside.pressure_pa),
        "sliding": by_block(inside.sliding),
    }
    blocks = len(states["pressure"])

    def causes(kind, items):
        out = np.zeros((blocks, items, len(run_terms)))
        for k, term in enumerate(run_terms):
            for item, values in getattr(term, kind).items():
                out[:, item, k] = block_means(np.asarray(values), size)
        return out

    joints, pressures = respond(
        rig, states, causes("volume", rig.muscles), causes("force", rig.muscles), causes("torque", len(rig.coordinates))
    )
    columns = {c.column: joints[:, j] / c.unit for j, c in enumerate(rig.coordinates)}
    columns |= {c: pressures[:, i] * 1e-3 for i, c in enumerate(rig.pressures)}
    for k, term in enumerate(run_terms):
        for column, values in term.reading.items():
            columns[column][:, k] += block_means(np.asarray(values), size)
    return {c: columns[c] for c in case.outputs}
