"""A universal differential equation: the bench's own equations with a small network at the right port, which is given.

The network sees time, pressure, elongation, its rate and the flow, and is trained through the equations together with
the calibrated numbers (Rackauckas et al. 2020). What it has become is then told as an expression by genetic
programming.

The line and the wall settle within microseconds, so the equations are stepped implicitly: each step a few of Newton's
through which jax takes derivatives. A forecast is the calibrated scene plus what the network changes.
"""

import re
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from scipy.optimize import minimize

from answer import Answer
from case import NotForThisCase, evenly_driven
from noise import block_means
from operon import genetic_programming
from rig import Rig
from rows import channel_noise

jax.config.update("jax_enable_x64", True)

STEP_S = 0.05
NEWTON_STEPS = 4
WIDTH = 8
ROUNDS = 300
ROUNDS_TO_CHOOSE = 100
# Prior deviations: of a weight (what foretells best a run that was not trained on is taken), and of a calibrated
# number's logarithm.
WEIGHT_SDS = (0.3, 3.0)
NUMBER_SD = 0.3
# What a network of weights near one adds, as a share of what is usual there; of a coefficient it changes so much.
TYPICAL = 0.1
ADDS = ("syringe.flow", "line.outflow", "line.pressure_drop", "muscle.pull", "muscle.rest_length", "plunger")
SCALES = (
    "syringe.compliance",
    "line.compliance",
    "line.resistance",
    "muscle.area",
    "muscle.coil",
    "muscle.wall",
    "muscle.friction",
    "muscle.damping",
)
INPUTS = ("time", "pressure", "elongation", "elongation_rate", "flow")
SHAPES = ((WIDTH, len(INPUTS)), (WIDTH,), (WIDTH, WIDTH), (WIDTH,), (WIDTH,), (1,))
CALIBRATED = ("c1", "upstream", "m0", "m1", "presliding")
DAMPING_N_S_M = 0.1
STRING_N = 0.05


def answer(case, seed):
    """What the network at the given port foretells on the holdout, and as what expression."""
    if case.scene != "muscle_bench":
        raise NotForThisCase(f"{case.name}: the equations here are those of muscle_bench, not of {case.scene}")
    if case.given_port not in (*ADDS, *SCALES):
        raise NotForThisCase(f"{case.name}: no network can stand at port {case.given_port}")
    problem = Problem(case, case.given_port)
    start = problem.start(np.random.default_rng(seed))
    fitted, unseen = problem.runs[:-1], problem.runs[-1:]
    left = {None: problem.chi2(np.zeros_like(start), unseen)}
    for weight_sd in WEIGHT_SDS if fitted else ():
        left[weight_sd] = problem.chi2(trained(problem, start, fitted, weight_sd, ROUNDS_TO_CHOOSE), unseen)
    best = min(left, key=left.get)
    notes = {"port": case.given_port, "unseen_chi2": {str(sd): float(chi2) for sd, chi2 in left.items()}}
    if best is None:
        return Answer("unknown_physics", notes=notes)
    flat = trained(problem, start, problem.runs, best, ROUNDS)
    notes["law"] = problem.expression(flat, seed)
    return Answer("unknown_physics", correction=problem.correction(flat), notes=notes)


def trained(problem, start, drives, weight_sd, rounds):
    """Weights and calibrated numbers that explain these runs best."""
    loss = jax.jit(jax.value_and_grad(lambda flat: problem.loss(flat, drives, weight_sd)))

    def for_scipy(flat):
        value, slope = loss(flat)
        is_finite = np.isfinite(value) and np.isfinite(slope).all()
        return (float(value), np.asarray(slope)) if is_finite else (1e12, np.zeros(len(flat)))

    return minimize(for_scipy, start, jac=True, method="L-BFGS-B", options={"maxiter": rounds}).x


class State(NamedTuple):
    """Where the bench is at the end of a step, and what the network added there."""

    elongation_m: jax.Array
    syringe_pa: jax.Array
    muscle_pa: jax.Array
    sliding: jax.Array
    plunger_m: jax.Array
    added: jax.Array


class Drive:
    """Inputs and recordings of a run on the steps."""

    def __init__(self, case, run, noise):
        time_s, (plunger_mm, *_), own = evenly_driven(run)
        self.run = run
        self.t = np.arange(time_s[0], time_s[-1], STEP_S)
        self.plunger_m = np.interp(self.t, time_s, plunger_mm) * 1e-3
        size = max(1, round(STEP_S / run.interval_s))
        self.at = block_means(run.time_s[:, None], size)[:, 0]
        self.measured, self.sd, self.simulated, self.plain = {}, {}, {}, {}
        for column in case.outputs:
            self.simulated[column] = block_means(run.simulated[column][:, None], size)[:, 0]
            if run.measured:
                self.measured[column] = block_means(run.measured[column][:, None], size)[:, 0]
                own = noise[column]
                self.sd[column] = own.sd * np.sqrt(max(own.inflation, 1.0) / size)


class Problem:
    """The bench with a network at one port."""

    def __init__(self, case, port):
        self.case, self.port, self.rig = case, port, Rig(case.scene, case.numbers)
        noise = channel_noise(case)
        self.runs = [Drive(case, run, noise) for run in case.runs]
        self.holdout = Drive(case, case.holdout, noise)
        rig, numbers = self.rig, case.numbers["muscles"]
        self.values = {
            "c1": 1.0,
            "upstream": rig.upstream_m3_pa,
            "m0": rig.m0_n,
            "m1": rig.m1_n_pa,
            "presliding": rig.presliding_m,
        }
        self.coil_n_m = numbers["tube"]["coil"]["stiffness_n_m"]
        fastest = max(np.abs(np.gradient(d.plunger_m, STEP_S)).max() for d in self.runs)
        flow = rig.syringe_area_m2 * fastest
        pressure = max(np.abs(run.simulated["pressure_kpa"]).max() for run in case.runs) * 1e3
        elongation = max(np.abs(run.simulated["elongation_mm"]).max() for run in case.runs) * 1e-3
        rate = flow / rig.core_m2
        # Of what the network sees, and of what a step solves for.
        self.units = np.array([max(d.t[-1] for d in self.runs), pressure, elongation, rate, flow])
        self.scales = np.array([elongation, pressure, pressure])
        usual = {
            "syringe.flow": flow,
            "line.outflow": flow,
            "line.pressure_drop": pressure,
            "muscle.pull": pressure * rig.core_m2,
            "muscle.rest_length": elongation,
            "plunger": np.ptp(self.runs[0].plunger_m),
        }
        self.size = TYPICAL * usual.get(port, 1.0)
        bare = np.zeros(len(CALIBRATED) + sum(int(np.prod(shape)) for shape in SHAPES))
        for drive in (*self.runs, self.holdout):
            drive.plain = {c: np.asarray(v) for c, v in self.shown(bare, drive).items()}

    def start(self, random):
        """Calibrated numbers as they are, and weights that add nearly nothing."""
        spreads = (len(INPUTS) ** -0.5, 0.0, WIDTH**-0.5, 0.0, 1e-3, 0.0)
        layers = [s * random.normal(size=n) if s > 0.0 else np.zeros(n) for s, n in zip(spreads, SHAPES)]
        return np.concatenate([np.zeros(len(CALIBRATED)), *map(np.ravel, layers)])

    def unpack(self, flat):
        """Logarithms of the calibrated numbers, and the layers."""
        layers, at = [], len(CALIBRATED)
        for shape in SHAPES:
            count = int(np.prod(shape))
            layers.append(flat[at : at + count].reshape(shape))
            at += count
        return flat[: len(CALIBRATED)], layers

    def network(self, layers, inputs):
        """What stands at the port: an addition, or the change of a factor."""
        hidden = jnp.tanh(layers[0] @ inputs + layers[1])
        hidden = jnp.tanh(layers[2] @ hidden + layers[3])
        return self.size * (layers[4] @ hidden + layers[5][0])

    @partial(jax.jit, static_argnums=0)
    def play(self, flat, t, plunger_m):
        """Elongation (m) and syringe pressure (Pa) at the steps, and what the network sees."""
        logs, layers = self.unpack(flat)
        number = {k: self.values[k] * jnp.exp(log) for k, log in zip(CALIBRATED, logs)}

        def advance(before, at):
            left = partial(self.balances, number, layers, before, at)
            now = jnp.stack([before.elongation_m, before.syringe_pa, before.muscle_pa]) / self.scales
            for _ in range(NEWTON_STEPS):
                slope = jax.jacfwd(lambda v: left(v)[0])(now)
                now = now - jnp.linalg.solve(slope, left(now)[0])
            _, (sliding, value, inputs) = left(now)
            e, p_s, p_m = now * self.scales
            return State(e, p_s, p_m, sliding, at[1], value), (jnp.stack([e, p_s]), inputs)

        start = State(*(jnp.asarray(v, dtype=float) for v in (0.0, 0.0, 0.0, 0.0, plunger_m[0], 0.0)))
        return jax.lax.scan(advance, start, (jnp.asarray(t), jnp.asarray(plunger_m)))[1]

    def balances(self, number, layers, before, at, now):
        """What the balances of pull, line and volume leave at the end of a step; friction's state, and what the network
        adds and sees there."""
        rig, (time_s, x), (e, p_s, p_m) = self.rig, at, now * self.scales
        rate = (e - before.elongation_m) / STEP_S
        storing = number["upstream"] * (p_s - before.syringe_pa) / STEP_S
        driven = rig.syringe_area_m2 * (x - before.plunger_m) / STEP_S
        inputs = jnp.stack([time_s, p_m, e, rate, driven - storing]) / self.units
        value = self.network(layers, inputs)
        adds = {port: value if port == self.port else 0.0 for port in ADDS}
        factor = {port: 1.0 + value if port == self.port else 1.0 for port in SCALES}
        shift = adds["plunger"] - (before.added if self.port == "plunger" else 0.0)
        flow = driven + rig.syringe_area_m2 * shift / STEP_S + adds["syringe.flow"]
        flow -= storing * factor["syringe.compliance"]
        drop = rig.resistance_pa_s_m3 * factor["line.resistance"] * flow + adds["line.pressure_drop"]
        area = rig.core_m2 * factor["muscle.area"]
        stored = rig.downstream_m3_pa * factor["line.compliance"] * (p_m - before.muscle_pa) / STEP_S
        friction, sliding = self.friction(number, before, e, p_m)
        pull = self.elastic(number, factor, e - adds["muscle.rest_length"]) + adds["muscle.pull"] - STRING_N
        pull += -p_m * area + friction * factor["muscle.friction"] + DAMPING_N_S_M * factor["muscle.damping"] * rate
        volume = flow - stored - area * rate - adds["line.outflow"]
        left = [pull / (self.scales[2] * rig.core_m2), (p_s - p_m - drop) / self.scales[1], volume / self.units[4]]
        return jnp.stack(left), (sliding, value, inputs)

    def friction(self, number, before, e, p_m):
        """Friction of the muscle and its sliding state (Dahl) at the end of a step."""
        step = (e - before.elongation_m) / number["presliding"]
        sign = jnp.sign(step)
        sliding = sign + (before.sliding - sign) * jnp.exp(-jnp.abs(step))
        return (number["m0"] + number["m1"] * jnp.maximum(p_m, 0.0)) * sliding, sliding

    def elastic(self, number, factor, e):
        """Pull of wall and coil."""
        table = self.rig.elastic
        wall_n = number["c1"] * jnp.interp(e, jnp.asarray(table.elongation_m), jnp.asarray(table.wall_n))
        return wall_n * factor["muscle.wall"] + self.coil_n_m * e * factor["muscle.coil"]

    def shown(self, flat, drive):
        """What the channels show at the blocks of a run, in their units."""
        both, _ = self.play(flat, drive.t - drive.t[0], drive.plunger_m)
        of = {"elongation_mm": both[:, 0] * 1e3, "pressure_kpa": both[:, 1] * 1e-3}
        return {c: jnp.interp(drive.at, drive.t, of[c]) for c in self.case.outputs}

    def loss(self, flat, drives, weight_sd):
        """Half of chi^2 over these runs, with priors."""
        logs, layers = self.unpack(flat)
        prior = jnp.sum((logs / NUMBER_SD) ** 2) + sum(jnp.sum((layer / weight_sd) ** 2) for layer in layers)
        return 0.5 * (prior + self.chi2(flat, drives))

    def chi2(self, flat, drives):
        """What is left of these runs."""
        total = 0.0
        for drive in drives:
            own, plain = self.shown(flat, drive), drive.plain
            for column in self.case.outputs:
                # The scene itself, and what the network and the numbers change in these equations.
                foretold = drive.simulated[column] + own[column] - plain[column]
                rest = (drive.measured[column] - foretold) / drive.sd[column]
                total += jnp.sum(jnp.where(np.isfinite(drive.measured[column]), rest, 0.0) ** 2)
        return total

    def correction(self, flat):
        """What the network and the refitted numbers add on the holdout, by sample."""
        drive = self.holdout
        own = self.shown(flat, drive)
        changes = {c: np.asarray(own[c] - drive.plain[c]) for c in self.case.outputs}
        return {c: np.interp(drive.run.time_s, drive.at, change) for c, change in changes.items()}

    def expression(self, flat, seed):
        """The network as an expression of what it sees, over the states that the runs visit."""
        _, layers = self.unpack(jnp.asarray(flat))
        flat = jnp.asarray(flat)
        seen = [np.asarray(self.play(flat, drive.t - drive.t[0], drive.plunger_m)[1]) for drive in self.runs]
        inputs = np.concatenate(seen)
        target = np.asarray(jax.vmap(lambda q: self.network(layers, q))(jnp.asarray(inputs))) / self.size
        regressor = genetic_programming(seed)
        regressor.fit(inputs, target)
        words = regressor.get_model_string(regressor.model_, 4)
        return re.sub(r"X(\d+)", lambda m: f"[{INPUTS[int(m[1]) - 1]}]", words)
