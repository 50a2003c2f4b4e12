#!/usr/bin/env python3
"""Times MuJoCo on the twins of make_twins.py at equal accuracy. JSON on stdout, progress on stderr.

    taskset -c 1 nice -n 5 python bench_mujoco.py [--time-only] [--case=NAME] [reps]

Per model: (1) static answers against hand formulas; (2) a reference run of a 10 s pressure programme at
a 1e-5 s step; (3) per integrator the largest step whose worst error over the programme stays under 0.1 %
of each output's range, all smaller steps of the grid near it passing too; (4) steps per second of process
CPU time at that step, median of `reps`, and the real-time factor (simulated / CPU seconds).
--time-only does (4) alone at the steps in ACCURATE_DT_S. The steps run inside mujoco.rollout (a C loop with
a fresh control every step), so no Python time is in the figures.
"""
import json
import math
import os
import platform
import statistics
import sys
import time

import mujoco
import numpy as np
from mujoco import rollout

import make_twins as twins

HERE = os.path.dirname(os.path.abspath(__file__))
S = twins.STOCK
PROGRAMME_S, SAMPLE_S = 10.0, 0.02
REFERENCE_DT_S, TOLERANCE = 1e-5, 1e-3
SINE_HZ = 0.5
GRIP_CLOSING_RAD = 1.2    # the grip pressure is the one that would close free jaws by this much
# Steps tried, all of them whole divisors of the sampling interval.
DIVISORS = [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 16, 18, 20, 22, 25, 28, 32, 36, 40, 45, 50, 56, 64,
            72, 80, 90, 100, 125, 160, 200, 250, 320, 400, 500, 640, 800, 1000]
BALL_DIVISORS = [4, 8, 10, 12, 14, 16, 20, 25, 32, 40, 50, 64, 80, 100, 160, 250, 400, 640]
INTEGRATORS = {"Euler": "mjINT_EULER", "implicitfast": "mjINT_IMPLICITFAST", "discrete": "mjINT_DISCRETE"}
INTEGRATORS = {k: getattr(mujoco.mjtIntegrator, v) for k, v in INTEGRATORS.items() if hasattr(mujoco.mjtIntegrator, v)}
ACCURATE_DT_S = {   # found by the full run; used by --time-only
    "antagonistic_pulley": {"Euler": SAMPLE_S / 36, "implicitfast": SAMPLE_S / 90, "discrete": SAMPLE_S / 500},
    "antagonistic_pulley_taut": {"Euler": SAMPLE_S / 20, "implicitfast": SAMPLE_S / 90, "discrete": SAMPLE_S / 90},
    "bending_catheter": {"Euler": SAMPLE_S / 25, "implicitfast": SAMPLE_S / 20, "discrete": SAMPLE_S / 36},
    "bending_catheter_ball": {"discrete": SAMPLE_S / 80},
}


# ---- hand formulas: pressure drops (below stock) that hold a pose with taut cables ------------------
def pulley_drop(theta, m):
    """Half the pressure difference that turns the pulley by theta."""
    return m["k"] * S["pulley_radius"] * theta / m["area"]


def tendon_drop(angle, stiffness, lever, m):
    """Drop that pulls a cable over `lever` against a spring of `stiffness` by `angle`."""
    tension = stiffness * angle / lever
    return (tension * (1 + m["k"] / S["cable_stiffness"]) + m["k"] * lever * angle) / m["area"]


def bend_drop(theta, m):
    return tendon_drop(theta, S["bend_stiffness"], S["bend_lever"], m)


def jaw_drop(closing, m):
    return tendon_drop(closing, S["jaw_stiffness"], S["jaw_lever"], m)


# ---- programmes: pressures (Pa) at times t -----------------------------------------------------------
def bump(t, hz):
    return 0.5 - 0.5 * np.cos(2 * np.pi * hz * t)


def pulley_programme(bias):
    def programme(t):
        m = twins.muscle(S["pulley_e_pre"])
        dp = pulley_drop(math.radians(40.0), m) * np.sin(2 * np.pi * SINE_HZ * t)
        return m["p0"] - bias - dp, m["p0"] - bias + dp
    return programme


def catheter_programme(t):
    m = twins.muscle(S["catheter_e_pre"])
    return (m["p0"] - bend_drop(math.radians(100.0), m) * bump(t, SINE_HZ),
            m["p0"] - jaw_drop(S["jaw_rest"] - 0.1, m) * bump(t, SINE_HZ / 2))


def ball_programme(t):
    """The jaws close on the ball in the first second and keep a drop that presses it."""
    m = twins.muscle(S["catheter_e_pre"])
    return (m["p0"] - bend_drop(math.radians(100.0), m) * bump(np.maximum(t - 1.0, 0.0), SINE_HZ),
            m["p0"] - jaw_drop(GRIP_CLOSING_RAD, m) * bump(np.minimum(t, 1.0), 0.5))


def pulley_outputs(q):
    return {"pulley_deg": np.degrees(q[:, 0])}


def catheter_outputs(q):
    n = S["notches"]
    return {"bend_deg": np.degrees(q[:, :n].sum(axis=1)), "jaw_deg": np.degrees(q[:, n])}


CASES = {   # name: file, programme, outputs
    "antagonistic_pulley": ("antagonistic_pulley", pulley_programme(0.0), pulley_outputs),
    "antagonistic_pulley_taut": ("antagonistic_pulley", pulley_programme(0.2e6), pulley_outputs),
    "bending_catheter": ("bending_catheter", catheter_programme, catheter_outputs),
    "bending_catheter_ball": ("bending_catheter_ball", ball_programme, catheter_outputs),
}


def load(name, integrator, dt):
    model = mujoco.MjModel.from_xml_path(os.path.join(HERE, name + ".xml"))
    model.opt.integrator, model.opt.timestep = integrator, dt
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data


def controls(model, programme, dt, steps):
    """Pressures at the middle of each step: no half-step delay from holding them over the step."""
    u = np.zeros((steps, model.nu))
    u[:, 0], u[:, 1] = programme((np.arange(steps) + 0.5) * dt)
    return u


def trajectory(case, integrator, divisor, ref=None):
    """Positions every SAMPLE_S, or None once the run has blown up (or is far from ref)."""
    name, programme, outputs = CASES[case]
    dt = SAMPLE_S / divisor
    model, data = load(name, integrator, dt)
    samples = round(PROGRAMME_S / SAMPLE_S)
    u = controls(model, programme, dt, samples * divisor)
    q = np.zeros((samples, model.nq))
    step = mujoco.mj_step
    for i in range(samples):
        for row in u[i * divisor:(i + 1) * divisor]:
            data.ctrl[:] = row
            step(model, data)
        q[i] = data.qpos
        if any(w.number for w in data.warning) or not np.all(np.isfinite(q[i])):
            return None
        if ref is not None and worst_error(q[:i + 1], ref, outputs) > 0.3:
            return None
    return q


def worst_error(q, ref, outputs):
    """Worst error as a part of the reference's range, over all outputs."""
    got, want = outputs(q), outputs(ref)
    return max(float(np.max(np.abs(got[k] - want[k][:len(got[k])])) / np.ptp(want[k])) for k in want)


def largest_accurate(case, integrator, ref):
    """Walks from large steps to small ones; three passes in a row settle it. Returns dt, sweep, largest stable dt."""
    sweep, passed, stable = [], [], None
    for divisor in BALL_DIVISORS if case.endswith("ball") else DIVISORS:
        q = trajectory(case, integrator, divisor, ref)
        error = None if q is None else worst_error(q, ref, CASES[case][2])
        sweep.append({"dt_s": SAMPLE_S / divisor, "error_percent_of_range": None if error is None else 100 * error})
        stable = None if error is None else (stable or SAMPLE_S / divisor)
        passed = passed + [divisor] if error is not None and error < TOLERANCE else []
        if len(passed) == 3:
            break
    return (SAMPLE_S / passed[0] if passed else None), sweep, stable


def speed(case, integrator, dt, reps):
    name, programme, _ = CASES[case]
    model, data = load(name, integrator, dt)
    steps = round(PROGRAMME_S / dt)
    u = controls(model, programme, dt, steps)[None]
    size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    start = np.zeros((1, size))
    mujoco.mj_getState(model, data, start[0], mujoco.mjtState.mjSTATE_FULLPHYSICS)
    out = np.zeros((1, steps, size))
    sensors = np.zeros((1, steps, model.nsensordata))

    def run():
        rollout.rollout([model], [data], start, u, state=out, sensordata=sensors, nstep=steps, skip_checks=True)

    c = time.process_time()
    run()
    repeat = max(1, math.ceil(0.25 / (time.process_time() - c)))
    rates = []
    for _ in range(reps):
        c = time.process_time()
        for _ in range(repeat):
            run()
        rates.append(repeat * steps / (time.process_time() - c))
    median = statistics.median(rates)
    return {"dt_s": dt, "steps_per_cpu_s_median": round(median), "steps_per_cpu_s_min": round(min(rates)),
            "steps_per_cpu_s_max": round(max(rates)), "cpu_us_per_step_median": round(1e6 / median, 3),
            "realtime_factor_simulated_s_per_cpu_s": round(median * dt, 1)}


# ---- static answers ------------------------------------------------------------------------------------
def settle(name, p1, p2, integrator="implicitfast", seconds=4.0, dt=1e-4):
    """Ramps the pressures from stock over one second, then holds them."""
    model, data = load(name, INTEGRATORS[integrator], dt)
    p0 = data.ctrl[:2].copy()
    steps = round(seconds / dt)
    for i in range(steps):
        data.ctrl[:2] = p0 + (np.array([p1, p2]) - p0) * min(1.0, i * dt)
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    return model, data


def compare(rows, what, unit, got, want):
    rows.append({"what": what, f"mujoco_{unit}": float(got), f"hand_{unit}": float(want),
                 "difference_percent": 100 * abs(float(got) / float(want) - 1)})


def static_checks():
    rows = []
    n, kc = S["notches"], S["cable_stiffness"]
    # Pulley, both cables taut: T1 = T2, x_i = (T - A drop_i)/k, T = kc * stretch_i.
    m = twins.muscle(S["pulley_e_pre"])
    d1, d2 = 0.5e6, 0.1e6
    _, data = settle("antagonistic_pulley", m["p0"] - d1, m["p0"] - d2)
    compare(rows, "pulley angle, drops 0.5 and 0.1 MPa", "deg", np.degrees(data.qpos[0]),
            math.degrees(m["area"] * (d1 - d2) / (2 * m["k"] * S["pulley_radius"])))
    for i in (1, 2):
        compare(rows, f"pulley cable {i} tension", "n", -data.actuator(f"t_{i}").force[0],
                m["area"] * (d1 + d2) / 2 / (1 + m["k"] / kc))
    # Catheter: bend and jaw from the drops; bend and jaw from the tensions MuJoCo reports.
    m = twins.muscle(S["catheter_e_pre"])
    for bend in (45.0, 100.0, 135.0):
        _, data = settle("bending_catheter", m["p0"] - bend_drop(math.radians(bend), m), m["p0"] - jaw_drop(0.4, m))
        got = math.degrees(data.qpos[:n].sum())
        tension = -data.actuator("t_1").force[0]
        compare(rows, f"bend for the drop of {bend:g} deg", "deg", got, bend)
        compare(rows, f"bend = lever * tension / stiffness at {bend:g} deg", "deg", got,
                math.degrees(S["bend_lever"] * tension / S["bend_stiffness"]))
    compare(rows, "one notch, an eighth of the bend", "deg", math.degrees(data.qpos[0]), 135.0 / n)
    compare(rows, "jaw for the drop of 0.4 rad", "deg", math.degrees(data.qpos[n]), math.degrees(S["jaw_rest"] - 0.4))
    compare(rows, "jaw = rest - lever * tension / stiffness", "deg", math.degrees(data.qpos[n]), math.degrees(
        S["jaw_rest"] + S["jaw_lever"] * data.actuator("t_2").force[0] / S["jaw_stiffness"]))
    # Jaw past its closed stop: spring and stop in parallel.
    k_all = S["jaw_stiffness"] + S["jaw_stop"]
    torque = 1.5 * S["jaw_stiffness"] * S["jaw_rest"]
    angle = (S["jaw_stiffness"] * S["jaw_rest"] - torque) / k_all
    tension = torque / S["jaw_lever"]
    drop = (tension * (1 + m["k"] / kc) + m["k"] * S["jaw_lever"] * (S["jaw_rest"] - angle)) / m["area"]
    _, data = settle("bending_catheter", m["p0"], m["p0"] - drop)
    compare(rows, "jaw on its closed stop", "deg", math.degrees(data.qpos[n]), math.degrees(angle))
    # Ball: geometry gives the jaw angle, moments give the grip force of one jaw.
    model, data = settle("bending_catheter_ball", m["p0"], m["p0"] - jaw_drop(GRIP_CLOSING_RAD, m), "discrete")
    reach = float(np.linalg.norm(data.body("ball").xpos - data.body("jaw_a").xpos))
    compare(rows, "jaw on the ball", "deg", math.degrees(data.qpos[n]), math.degrees(twins.GRIP_RAD))
    tension = -data.actuator("t_2").force[0]
    moment = S["jaw_lever"] * tension - S["jaw_stiffness"] * (S["jaw_rest"] - data.qpos[n])
    normal, force = [], np.zeros(6)
    for i in range(data.ncon):
        mujoco.mj_contactForce(model, data, i, force)
        normal.append(force[0])
    compare(rows, "grip force of one jaw (mean of both)", "n", np.mean(normal), moment / (2 * reach))
    return rows


def main():
    args = [a for a in sys.argv[1:] if not a.startswith("--")]
    time_only, reps = "--time-only" in sys.argv, int(args[0]) if args else 7
    only = [a.partition("=")[2] for a in sys.argv[1:] if a.startswith("--case=")]
    mujoco.set_mju_user_warning(lambda text: None)
    result = {"mujoco": mujoco.__version__, "python": platform.python_version(), "machine": platform.machine(),
              "reps": reps, "programme_s": PROGRAMME_S, "sine_hz": SINE_HZ, "reference_dt_s": REFERENCE_DT_S,
              "tolerance_percent_of_range": 100 * TOLERANCE, "cases": {}}
    if not time_only:
        result["static_checks"] = static_checks()
        worst = max(r["difference_percent"] for r in result["static_checks"])
        print(f"static checks: worst difference {worst:.4f} %", file=sys.stderr)
    for case in only or CASES:
        entry = result["cases"][case] = {"integrators": {}}
        if not time_only:
            # With the ball, only "discrete" solves contacts and the stiff hinge damping together.
            fast = INTEGRATORS["discrete" if case.endswith("ball") else "implicitfast"]
            per_sample = round(SAMPLE_S / REFERENCE_DT_S)
            ref = trajectory(case, fast, per_sample)
            entry["range"] = {k: float(np.ptp(v)) for k, v in CASES[case][2](ref).items()}
            half = trajectory(case, fast, per_sample // 2)
            entry["reference_change_at_twice_the_step_percent_of_range"] = 100 * worst_error(half, ref, CASES[case][2])
        for label, integrator in INTEGRATORS.items():
            row = entry["integrators"][label] = {}
            if time_only:
                dt = ACCURATE_DT_S.get(case, {}).get(label)
            else:
                dt, row["sweep"], row["largest_stable_dt_s"] = largest_accurate(case, integrator, ref)
            row["largest_accurate_dt_s"] = dt
            if dt is not None:
                row["speed"] = speed(case, integrator, dt, reps)
            print(case, label, "dt", dt, row.get("speed"), file=sys.stderr, flush=True)
    result["load_average_1min"] = os.getloadavg()[0]
    json.dump(result, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
