#!/usr/bin/env python3
"""Writes the MJCF twins of two stock rigs next to this file:

    antagonistic_pulley.xml       3 dof: pulley, two muscle ends
    bending_catheter.xml         11 dof: 8 notch hinges, jaw coordinate, two muscle ends
    bending_catheter_ball.xml    18 dof: as above with two jaw bodies and a free ball between them

Every number is a stock number of the rigs or follows from one; STOCK holds the former. SI units.
What MJCF cannot say is approximated thus:
  muscle    tangent of the wall-and-coil force at e_pre, plus A_c p; no Bouc-Wen friction, no e >= 0 stop
  hydraulics  one first-order lag on the pressure, time constant R_line (C_m + A_c^2/k): what the line
            and the compliance behind it leave at low frequency; fluid inertia and C_s are missing
  cable     an affine actuator on a fixed tendon with a force range that admits tension only; unlike the
            rigs' cable it may pull by its damping alone while still (by micrometres) slack
Muscle coordinates x are elongation minus e_pre, so all coordinates but the jaw start at zero.
"""
import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))

STOCK = dict(
    rest_length=50e-3, coil_bore=1.05e-3, coil_wire=0.20e-3, coil_mean=1.25e-3,
    coil_stiffness=28.3, tube_inner=0.51e-3, yeoh_c1=0.255e6, yeoh_c2=0.0155e6,
    axial_damping=0.1, end_mass=5e-3,
    line_length=1.0, line_bore=0.8e-3, viscosity=1.002e-3, c_m=2.6e-15,
    cable_stiffness=4000.0, cable_damping=0.4,
    pulley_radius=8e-3, pulley_inertia=2.5e-7, pulley_damping=2e-6, pulley_e_pre=25e-3,
    notches=8, notch_pitch=2.0e-3, bend_lever=2.62e-3, bend_stiffness=1.05e-3,
    bend_damping=2e-5, bend_inertia=2e-8, tube_outer=3.23e-3, tube_wall=0.3e-3, catheter_e_pre=35e-3,
    jaw_lever=1.5e-3, jaw_stiffness=0.9e-3, jaw_rest=0.7, jaw_damping=2e-6, jaw_inertia=2e-9,
    jaw_stop=0.05, ball_diameter=3e-3, ball_mass=20e-6,
)
# Choices of the contact twin that are not stock numbers.
JAW_FACE_M = (1.0e-3, 9.0e-3)    # inner jaw face, from and to, measured from the pivot
JAW_BALL_M = 6.0e-3              # ball centre from the pivot
GRIP_RAD = 0.25                  # jaw angle at which the faces are parallel and touch the ball
S_BALL_RADIUS = STOCK["ball_diameter"] / 2
CONTACT = dict(friction=0.8, solref="0.002 1", solimp="0.9999 0.9999 0.001")


def wall_and_coil_force(e, s=STOCK):
    """Force of the held Yeoh wall and the coil at elongation e (N): d/dL of the energy, by midpoint rule."""
    lam = 1.0 + e / s["rest_length"]
    r_in, r_c = s["tube_inner"] / 2, s["coil_bore"] / 2
    cells, total = 4000, 0.0
    step = (r_c - r_in) / cells
    for i in range(cells):
        ref = r_in + (i + 0.5) * step
        gap = (r_c**2 - ref**2) / ref**2
        hoop = 1 + gap * (1 - 1 / lam)              # hoop stretch squared
        hoop_slope = gap / lam**2
        radial = 1 / (lam**2 * hoop)                # radial stretch squared
        i1 = lam**2 + hoop + radial
        i1_slope = 2 * lam + hoop_slope - radial * (2 / lam + hoop_slope / hoop)
        total += (s["yeoh_c1"] + 2 * s["yeoh_c2"] * (i1 - 3)) * i1_slope * 2 * math.pi * ref * step
    return total + s["coil_stiffness"] * e


def muscle(e_pre, s=STOCK):
    """Tangent muscle at e_pre: area, stiffness, force, pressure that balances it, lag of the line."""
    area = math.pi * s["coil_bore"] ** 2 / 4
    de = 1e-5
    k = (wall_and_coil_force(e_pre + de, s) - wall_and_coil_force(e_pre - de, s)) / (2 * de)
    force = wall_and_coil_force(e_pre, s)
    resistance = 128 * s["viscosity"] * s["line_length"] / (math.pi * s["line_bore"] ** 4)
    return dict(area=area, k=k, force=force, p0=force / area, lag=resistance * (s["c_m"] + area**2 / k))


def num(x):
    return f"{x:.12g}"


def muscle_body(name, x_pos, m, s=STOCK):
    """End mass on a slide; the spring pulls with wall_and_coil_force(e_pre) at x = 0."""
    return (f'    <body name="{name}" pos="{x_pos} 0.03 0">\n'
            f'      <inertial pos="0 0 0" mass="{num(s["end_mass"])}" diaginertia="1e-7 1e-7 1e-7"/>\n'
            f'      <joint name="{name}" type="slide" axis="0 0 1" stiffness="{num(m["k"])}" '
            f'springref="{num(-m["force"] / m["k"])}" damping="{num(s["axial_damping"])}"/>\n'
            f'    </body>\n')


def pressure_actuator(name, joint, m):
    return (f'    <general name="{name}" joint="{joint}" dyntype="filterexact" dynprm="{num(m["lag"])}" '
            f'gaintype="fixed" gainprm="{num(m["area"])}"/>\n')


def cable_actuator(name, tendon, rest, s=STOCK):
    """Tension only: force = -k (length - rest) - c speed, clipped to <= 0. Its control is not used."""
    k, c = s["cable_stiffness"], s["cable_damping"]
    return (f'    <general name="{name}" tendon="{tendon}" gaintype="fixed" gainprm="0" biastype="affine" '
            f'biasprm="{num(k * rest)} {num(-k)} {num(-c)}" forcelimited="true" forcerange="-1000 0"/>\n')


def fixed_tendon(name, terms, extra=""):
    rows = "".join(f'      <joint joint="{j}" coef="{num(c)}"/>\n' for j, c in terms)
    return f'    <fixed name="{name}"{extra}>\n{rows}    </fixed>\n'


def head(model, flags):
    return (f'<!-- Written by make_twins.py from the stock numbers; edit that file, not this one. SI units. -->\n'
            f'<mujoco model="{model}">\n'
            f'  <compiler angle="radian"/>\n'
            f'  <option timestep="0.0005" integrator="implicitfast" gravity="0 0 0"{flags[0]}>\n'
            f'    <flag {flags[1]}/>\n  </option>\n')


def keyframe(qpos, act):
    return (f'  <keyframe>\n    <key name="stock" qpos="{" ".join(num(v) for v in qpos)}" '
            f'act="{" ".join(num(v) for v in act)}" ctrl="{" ".join(num(v) for v in act)} 0 0"/>\n  </keyframe>\n')


def pulley_xml(s=STOCK):
    m = muscle(s["pulley_e_pre"], s)
    r, inertia = s["pulley_radius"], num(s["pulley_inertia"])
    return (head("antagonistic_pulley", ("", 'contact="disable"'))
            + '  <worldbody>\n    <body name="pulley">\n'
            f'      <inertial pos="0 0 0" mass="0.005" diaginertia="{inertia} {inertia} {inertia}"/>\n'
            f'      <joint name="theta" type="hinge" axis="0 1 0" damping="{num(s["pulley_damping"])}"/>\n'
            f'      <geom type="cylinder" size="{num(r)} 0.002" zaxis="0 1 0" mass="0" contype="0" conaffinity="0"/>\n'
            '    </body>\n'
            + muscle_body("muscle_1", -0.01, m, s) + muscle_body("muscle_2", 0.01, m, s)
            + '  </worldbody>\n  <tendon>\n'
            + fixed_tendon("cable_1", [("muscle_1", -1), ("theta", -r)])
            + fixed_tendon("cable_2", [("muscle_2", -1), ("theta", r)])
            + '  </tendon>\n  <actuator>\n'
            + pressure_actuator("p_1", "muscle_1", m) + pressure_actuator("p_2", "muscle_2", m)
            + cable_actuator("t_1", "cable_1", 0.0, s) + cable_actuator("t_2", "cable_2", 0.0, s)
            + '  </actuator>\n' + keyframe([0, 0, 0], [m["p0"]] * 2) + '</mujoco>\n')


def link_inertia(s=STOCK):
    """Mass and inertias of one of n equal links (ring cross-section) that give bend_inertia about the base."""
    n, pitch = s["notches"], s["notch_pitch"]
    ro, ri = s["tube_outer"] / 2, s["tube_outer"] / 2 - s["tube_wall"]
    axial = (ro**2 + ri**2) / 2                          # per unit mass
    across = axial / 2 + pitch**2 / 12
    arms = sum(((i + 0.5) * pitch) ** 2 for i in range(n))
    mass = s["bend_inertia"] / (arms + n * across)
    return mass, mass * across, mass * axial


def catheter_xml(ball, s=STOCK):
    m = muscle(s["catheter_e_pre"], s)
    n, pitch = s["notches"], s["notch_pitch"]
    mass, across, axial = link_inertia(s)
    flags = (("", 'contact="disable"') if not ball else (' tolerance="1e-15" cone="elliptic" impratio="10"', 'contact="enable"'))
    out = [head("bending_catheter" + ("_ball" if ball else ""), flags), "  <worldbody>\n"]
    pad = "    "
    for i in range(n):
        out.append(f'{pad}<body name="link_{i + 1}" pos="0 0 {num(pitch if i else 0)}">\n')
        pad += "  "
        out.append(f'{pad}<inertial pos="0 0 {num(pitch / 2)}" mass="{num(mass)}" '
                   f'diaginertia="{num(across)} {num(across)} {num(axial)}"/>\n'
                   f'{pad}<joint name="notch_{i + 1}" type="hinge" axis="0 1 0" stiffness="{num(n * s["bend_stiffness"])}" '
                   f'damping="{num(n * s["bend_damping"])}"/>\n'
                   f'{pad}<geom type="cylinder" size="{num(s["tube_outer"] / 2)} {num(0.3 * pitch)}" '
                   f'pos="0 0 {num(pitch / 2)}" mass="0" contype="0" conaffinity="0"/>\n')
    # Jaws: together jaw_inertia, jaw_stiffness, jaw_damping, jaw_stop; light, centre of mass on the pivot.
    # Two mirrored jaws exchange no angular momentum with the bending, hence the armature of the single one.
    jaws = (("jaw", 1, 1.0),) if not ball else (("jaw_a", 1, 0.5), ("jaw_b", -1, 0.5))
    lo, hi = JAW_FACE_M
    for name, side, share in jaws:
        inertia = share * s["jaw_inertia"] if ball else 1e-13
        armature = "" if ball else f' armature="{num(s["jaw_inertia"])}"'
        # Inner faces stand parallel, a ball's diameter apart, at the grip angle.
        turn = -side * GRIP_RAD
        x, z = side * (S_BALL_RADIUS + 0.0004), (hi + lo) / 2
        place = (f'pos="{num(x * math.cos(turn) + z * math.sin(turn))} 0 {num(z * math.cos(turn) - x * math.sin(turn))}" '
                 f'euler="0 {num(turn)} 0"')
        solid = ('contype="1" conaffinity="2"' if ball else 'contype="0" conaffinity="0"')
        out.append(f'{pad}<body name="{name}" pos="0 0 {num(pitch)}">\n'
                   f'{pad}  <inertial pos="0 0 0" mass="{num(share * 1e-6)}" diaginertia="{num(inertia)} {num(inertia)} {num(inertia)}"/>\n'
                   f'{pad}  <joint name="{name}" type="hinge" axis="0 {side} 0" stiffness="{num(share * s["jaw_stiffness"])}" '
                   f'springref="{num(s["jaw_rest"])}" damping="{num(share * s["jaw_damping"])}"{armature}/>\n'
                   f'{pad}  <geom name="{name}" type="box" size="0.0004 0.001 {num((hi - lo) / 2)}" '
                   f'{place} mass="0" {solid}'
                   + (f' friction="{CONTACT["friction"]} 0 0" solref="{CONTACT["solref"]}" solimp="{CONTACT["solimp"]}"' if ball else "")
                   + f'/>\n{pad}</body>\n')
    for i in range(n):
        pad = pad[:-2]
        out.append(f"{pad}</body>\n")
    out.append(muscle_body("muscle_1", -0.01, m, s) + muscle_body("muscle_2", 0.01, m, s))
    tip = n * pitch
    if ball:
        radius = s["ball_diameter"] / 2
        i_ball = num(0.4 * s["ball_mass"] * radius**2)
        out.append(f'    <body name="ball" pos="0 0 {num(tip + JAW_BALL_M)}">\n'
                   f'      <inertial pos="0 0 0" mass="{num(s["ball_mass"])}" diaginertia="{i_ball} {i_ball} {i_ball}"/>\n'
                   f'      <freejoint name="ball"/>\n'
                   f'      <geom name="ball" type="sphere" size="{num(radius)}" mass="0" contype="2" conaffinity="1" '
                   f'friction="{CONTACT["friction"]} 0 0" solref="{CONTACT["solref"]}" solimp="{CONTACT["solimp"]}"/>\n'
                   f'    </body>\n')
    out.append("  </worldbody>\n")
    if ball:
        out.append(f'  <equality>\n    <joint joint1="jaw_b" joint2="jaw_a" polycoef="0 1 0 0 0" '
                   f'solref="{CONTACT["solref"]}" solimp="{CONTACT["solimp"]}"/>\n  </equality>\n')
    out.append("  <tendon>\n")
    out.append(fixed_tendon("cable_1", [("muscle_1", -1)] + [(f"notch_{i + 1}", -s["bend_lever"]) for i in range(n)]))
    out.append(fixed_tendon("cable_2", [("muscle_2", -1)] + [(j, share * s["jaw_lever"]) for j, _, share in jaws]))
    out.append(fixed_tendon("closed_stop", [(j, share) for j, _, share in jaws],
                            f' stiffness="{num(s["jaw_stop"])}" springlength="0 100"'))
    out.append("  </tendon>\n  <actuator>\n")
    out.append(pressure_actuator("p_1", "muscle_1", m) + pressure_actuator("p_2", "muscle_2", m))
    out.append(cable_actuator("t_1", "cable_1", 0.0, s))
    out.append(cable_actuator("t_2", "cable_2", s["jaw_lever"] * s["jaw_rest"], s))
    out.append("  </actuator>\n")
    qpos = [0] * n + [s["jaw_rest"]] * len(jaws) + [0, 0] + ([0, 0, tip + JAW_BALL_M, 1, 0, 0, 0] if ball else [])
    out.append(keyframe(qpos, [m["p0"]] * 2) + "</mujoco>\n")
    return "".join(out)


TWINS = {
    "antagonistic_pulley": lambda: pulley_xml(),
    "bending_catheter": lambda: catheter_xml(False),
    "bending_catheter_ball": lambda: catheter_xml(True),
}

if __name__ == "__main__":
    for name, make in TWINS.items():
        with open(os.path.join(HERE, name + ".xml"), "w", encoding="utf-8") as f:
            f.write(make())
        print(name + ".xml")
