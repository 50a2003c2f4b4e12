#!/usr/bin/env python3
"""Times PyElastica on a Cosserat rod like the stock catheter's bending tube. JSON on stdout, progress on stderr.

    taskset -c 1 nice -n 5 python bench_pyelastica.py [--time-only] [--joints=N] [reps]

One rod, clamped at its base, turned at its tip by a moment: no cables, notches, jaws or hydraulics. The
moment is what would hold the bend of bench_mujoco.py's programme: stiffness * 100 degrees * bump at 0.5 Hz.
How stock numbers become a rod (STOCK of make_twins.py):
  length     L = notches * pitch. PyElastica bends a rod between its elements only, so a rod of n elements
             over L, the first of them clamped, bends over L (n-1)/n. Here n bending joints have n + 1
             elements of length L/n, the clamped one standing for the end of the straight tube.
  stiffness  EI = K L with K = bend_stiffness; a solid rod of the tube's outer radius, E = EI / (pi r^4 / 4),
             shear modulus E/3 (PyElastica's default). EA and GA follow; nothing of the stock rig fixes them.
  mass       m = 3 J / L^2, spread evenly: the inertia J = bend_inertia about the base, jaws included.
  damping    PyElastica has no viscous bending; its damper takes a share of every velocity. The rate
             nu = c / (m (L^2/20 + r^2/12)) dissipates the power of c = bend_damping at the tip while the rod
             bends evenly by a small angle.
Per number of joints: (1) the static angle against M L / EI; (2) a reference of half a period at REFERENCE_DT_S;
(3) the largest step whose tip angle stays within 0.1 % of the range of it; (4) CPU time per simulated second
at that step, median of `reps`. A run that has lost stability may stay finite: only its angle tells.
"""
import json
import math
import os
import platform
import statistics
import sys
import time

import elastica as ea
import numpy as np
from importlib.metadata import version

from make_twins import STOCK as S

PROGRAMME_S, SAMPLE_S = 1.0, 0.02          # half a period: from straight to the full bend
SINE_HZ, BEND_RAD = 0.5, math.radians(100.0)
REFERENCE_DT_S, TOLERANCE = 2.5e-6, 1e-3
LOST = 0.3                                 # part of the range from which a run counts as unstable
JOINTS = (8, 16)
# Steps tried, whole divisors of the sampling interval: 100 to 5 microseconds.
DIVISORS = [200, 250, 280, 320, 360, 400, 450, 500, 560, 640, 720, 800, 900, 1000, 1250, 1600, 2000, 2500, 4000]
ACCURATE_DT_S = {8: SAMPLE_S / 500, 16: SAMPLE_S / 900}   # found by the full run; used by --time-only

LENGTH_M, RADIUS_M = S["notches"] * S["notch_pitch"], S["tube_outer"] / 2
MASS_KG = 3 * S["bend_inertia"] / LENGTH_M**2
EI_N_M2 = S["bend_stiffness"] * LENGTH_M
YOUNGS_PA = EI_N_M2 / (math.pi * RADIUS_M**4 / 4)
DENSITY_KG_M3 = MASS_KG / (math.pi * RADIUS_M**2 * LENGTH_M)
DAMPING_1_S = S["bend_damping"] / (MASS_KG * (LENGTH_M**2 / 20 + RADIUS_M**2 / 12))


def damper_exact(dt):
    """The damper's own use: velocities fall by exp(-nu dt) a step, whatever drives them."""
    return DAMPING_1_S


def damper_corrected(dt):
    """Velocities fall by 1 / (1 + nu dt): a steady force then gives its true steady speed at any step."""
    return math.log1p(DAMPING_1_S * dt) / dt


DAMPERS = {"exact": damper_exact, "corrected": damper_corrected}


class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping):
    pass


class TipMoment(ea.NoForces):
    """Moment about y on the last element; the rod bends in its plane, so y is its material axis too."""

    def __init__(self, moment):
        super().__init__()
        self.moment = moment

    def apply_torques(self, system, time=0.0):
        system.external_torques[1, -1] += self.moment(time)


def programme(t):
    return S["bend_stiffness"] * BEND_RAD * (0.5 - 0.5 * math.cos(2 * math.pi * SINE_HZ * t))


def held(t):
    """For the static check: risen within 0.1 s, then constant."""
    return S["bend_stiffness"] * BEND_RAD * min(1.0, t / 0.1)


def build(elements, length, dt, damper, moment):
    simulator = Simulator()
    rod = ea.CosseratRod.straight_rod(
        elements, np.zeros(3), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), length, RADIUS_M,
        DENSITY_KG_M3, youngs_modulus=YOUNGS_PA, shear_modulus=YOUNGS_PA / 3)
    simulator.append(rod)
    simulator.constrain(rod).using(ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,))
    simulator.add_forcing_to(rod).using(TipMoment, moment)
    simulator.dampen(rod).using(ea.AnalyticalLinearDamper, uniform_damping_constant=DAMPERS[damper](dt), time_step=dt)
    simulator.finalize()
    return simulator, rod


def build_joints(joints, dt, damper, moment=programme):
    return build(joints + 1, LENGTH_M * (joints + 1) / joints, dt, damper, moment)


def tip_rad(rod):
    tangent = rod.director_collection[2, :, -1]
    return math.atan2(tangent[0], tangent[2])


def advance(simulator, t, dt, steps, stepper=ea.PositionVerlet()):
    step = stepper.step
    for _ in range(steps):
        t = step(simulator, t, dt)
    return t


def trajectory(joints, damper, divisor, ref=None):
    """Tip angles every SAMPLE_S; None once they are lost (finite garbage included)."""
    dt, t = SAMPLE_S / divisor, 0.0
    simulator, rod = build_joints(joints, dt, damper)
    angles = []
    for i in range(round(PROGRAMME_S / SAMPLE_S)):
        t = advance(simulator, t, dt, divisor)
        angles.append(tip_rad(rod))
        if ref is not None and not abs(angles[-1] - ref[i]) < LOST * np.ptp(ref):
            return None
    return np.array(angles)


def worst_error(angles, ref):
    return float(np.max(np.abs(angles - ref)) / np.ptp(ref))


def largest_accurate(joints, damper, ref):
    """Walks from large steps to small ones; three passes in a row settle it."""
    sweep, passed, stable = [], [], None
    for divisor in DIVISORS:
        angles = trajectory(joints, damper, divisor, ref)
        error = None if angles is None else worst_error(angles, ref)
        print(f"{joints} joints, {damper}: {1e6 * SAMPLE_S / divisor:.2f} us, error "
              + ("lost" if error is None else f"{100 * error:.4f} %"), file=sys.stderr, flush=True)
        sweep.append({"dt_s": SAMPLE_S / divisor, "error_percent_of_range": None if error is None else 100 * error})
        stable = None if error is None else (stable or SAMPLE_S / divisor)
        passed = passed + [(divisor, error)] if error is not None and error < TOLERANCE else []
        if len(passed) == 3:
            break
    if not passed:
        return {"largest_accurate_dt_s": None, "largest_stable_dt_s": stable, "sweep": sweep}
    dt = SAMPLE_S / passed[0][0]
    return {"largest_accurate_dt_s": dt, "error_percent_of_range": 100 * passed[0][1], "largest_stable_dt_s": stable,
            "step_set_by": "stability" if dt == stable else "accuracy", "sweep": sweep}


def speed(joints, damper, dt, reps):
    """Compiled before it counts: main() has run a few steps. Building a rod is not in the times."""
    times, steps = [], round(PROGRAMME_S / dt)
    for _ in range(reps):
        simulator, _ = build_joints(joints, dt, damper)
        c = time.process_time()
        advance(simulator, 0.0, dt, steps)
        times.append((time.process_time() - c) / PROGRAMME_S)
    median = statistics.median(times)
    return {"dt_s": dt, "cpu_s_per_simulated_s_median": median, "cpu_s_per_simulated_s_min": min(times),
            "cpu_s_per_simulated_s_max": max(times), "cpu_us_per_step_median": 1e6 * median * dt,
            "realtime_factor_simulated_s_per_cpu_s": 1 / median}


def static_checks(joints, dt=1e-5, seconds=0.5):
    """Tip angle under a held moment: closed form M L / EI, and what n elements over L without the extra one give."""
    want, rows = math.degrees(BEND_RAD), []
    for what, elements, length in ((f"{joints} joints, {joints + 1} elements", joints + 1, LENGTH_M * (joints + 1) / joints),
                                   (f"{joints} elements over the length", joints, LENGTH_M)):
        simulator, rod = build(elements, length, dt, "corrected", held)
        advance(simulator, 0.0, dt, round(seconds / dt))
        got = math.degrees(tip_rad(rod))
        rows.append({"what": what, "pyelastica_deg": got, "closed_form_deg": want, "difference_percent": 100 * (got / want - 1)})
        print(f"static, {what}: {got:.5f} deg, M L / EI = {want:.5f} deg", file=sys.stderr, flush=True)
    return rows


def main():
    args = [a for a in sys.argv[1:] if not a.startswith("--")]
    time_only, reps = "--time-only" in sys.argv, int(args[0]) if args else 5
    only = [int(a.partition("=")[2]) for a in sys.argv[1:] if a.startswith("--joints=")]
    load_before = os.getloadavg()
    advance(build_joints(8, 1e-5, "corrected")[0], 0.0, 1e-5, 20)      # numba compiles here
    result = {"pyelastica": version("pyelastica"), "python": platform.python_version(), "machine": platform.machine(),
              "reps": reps, "programme_s": PROGRAMME_S, "sine_hz": SINE_HZ, "reference_dt_s": REFERENCE_DT_S,
              "tolerance_percent_of_range": 100 * TOLERANCE,
              "rod": {"length_m": LENGTH_M, "radius_m": RADIUS_M, "mass_kg": MASS_KG, "ei_n_m2": EI_N_M2,
                      "youngs_pa": YOUNGS_PA, "density_kg_m3": DENSITY_KG_M3, "damping_1_s": DAMPING_1_S}, "joints": {}}
    for joints in only or JOINTS:
        entry = result["joints"][joints] = {}
        if not time_only:
            entry["static_checks"] = static_checks(joints)
            per_sample = round(SAMPLE_S / REFERENCE_DT_S)
            ref = trajectory(joints, "corrected", per_sample)
            entry["range_deg"] = math.degrees(np.ptp(ref))
            entry.update(largest_accurate(joints, "corrected", ref))
        dt = entry.setdefault("largest_accurate_dt_s", ACCURATE_DT_S.get(joints))
        if dt is None:
            continue
        if not time_only:
            plain = trajectory(joints, "exact", round(SAMPLE_S / dt), ref)
            entry["error_percent_of_range_without_the_damper_correction"] = (
                None if plain is None else 100 * worst_error(plain, ref))
        entry["speed"] = speed(joints, "corrected", dt, reps)
        print(f"{joints} joints: {entry['speed']['cpu_s_per_simulated_s_median']:.3f} CPU s per simulated s "
              f"at {1e6 * dt:.2f} us", file=sys.stderr, flush=True)
    result["load_average_before"], result["load_average_after"] = load_before, os.getloadavg()
    print(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
