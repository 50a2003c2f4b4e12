"""Numbers of the three stock rigs, and how small causes show: the chain linearised about the calibrated simulation.

Quasi-static, friction's memory included. Per muscle i with elongation e_i = e_0 - sum_j lever_ij q_j:

    volume   A_c de_i + C dp_i = dV_i
    pull     dT_i = k(e) de_i + (m0 + m1 p) dz_i - (A_c - m1 z_i) dp_i + dF_i
    joint    sum_i lever_ij dT_i = K_j dq_j - dtau_j
"""

from dataclasses import dataclass

import numpy as np

WALL_LAYERS = 60
DEGREE = np.pi / 180.0
# Fine steps of elongation at which the elastic pull is tabulated.
TABLE_STEP_M = 5e-5


@dataclass(frozen=True)
class Coordinate:
    """A joint: the channel that shows it, that channel's unit in SI, levers by muscle, stiffness, where it rests."""

    column: str
    unit: float
    levers: tuple
    stiffness: float
    start: float = 0.0


# As in scenes/: levers m (pulley, tendon, jaw), stiffness N m/rad (tube of 8 notches in series, both jaws together).
COORDINATES = {
    "muscle_bench": (Coordinate("elongation_mm", 1e-3, (-1.0,), 0.0),),
    "antagonistic_pulley": (Coordinate("angle_deg", DEGREE, (0.008, -0.008), 0.0),),
    "bending_catheter": (
        Coordinate("bend_deg", DEGREE, (2.62e-3, 0.0), 1.05e-3),
        Coordinate("jaw_deg", DEGREE, (0.0, -1.5e-3), 0.9e-3, start=0.7),
    ),
}
PRESSURES = {
    "muscle_bench": ("pressure_kpa",),
    "antagonistic_pulley": ("pressure_1_kpa", "pressure_2_kpa"),
    "bending_catheter": ("pressure_1_kpa", "pressure_2_kpa"),
}


class Rig:
    """The numbers of a calibrated scene that the balances need."""

    def __init__(self, scene, numbers):
        self.coordinates = COORDINATES[scene]
        self.pressures = PRESSURES[scene]
        self.scene = scene
        hydraulics, muscles = numbers["hydraulics"], numbers["muscles"]
        self.syringe_area_m2 = np.pi * hydraulics["syringe"]["bore_m"] ** 2 / 4.0
        self.upstream_m3_pa = hydraulics["upstream_compliance_m3_pa"]
        self.downstream_m3_pa = hydraulics["downstream_compliance_m3_pa"]
        line, fluid = hydraulics["line"], hydraulics["fluid"]
        self.resistance_pa_s_m3 = 128.0 * fluid["viscosity_pa_s"] * line["length_m"] / (np.pi * line["bore_m"] ** 4)
        self.atmosphere_pa = fluid["atmospheric_pressure_pa"]
        friction = muscles["friction"]
        self.m0_n, self.m1_n_pa = friction["m0_n"], friction["m1_n_pa"]
        self.presliding_m = friction["presliding_length_m"]
        self.core_m2 = np.pi * muscles["tube"]["outer_diameter_m"] ** 2 / 4.0
        self.start_m = muscles["pre_elongation_ratio"] * muscles["rest_length_m"]
        self.elastic = Elastic(muscles)

    @property
    def muscles(self):
        """How many."""
        return len(self.pressures)

    def suffix(self, muscle):
        """What is put behind the name of an element of a muscle."""
        return f"_{muscle + 1}" if self.muscles > 1 else ""


class Elastic:
    """Wall and coil: energy, pull and stiffness over elongation, tabulated."""

    def __init__(self, muscles):
        tube, length = muscles["tube"], muscles["rest_length_m"]
        self.elongation_m = np.arange(-0.1 * length, 3.0 * length, TABLE_STEP_M)
        outer, inner = tube["outer_diameter_m"] / 2.0, tube["inner_diameter_m"] / 2.0
        edges = np.linspace(inner, outer, WALL_LAYERS + 1)
        radius = (edges[1:] + edges[:-1])[:, None] / 2.0
        stretch = (1.0 + self.elongation_m / length)[None, :]
        hoop = np.sqrt(outer**2 - (outer**2 - radius**2) / stretch) / radius
        i1 = stretch**2 + hoop**2 + 1.0 / (stretch * hoop) ** 2 - 3.0
        law = tube["material"]
        density = law["c1_pa"] * i1 + law.get("c2_pa", 0.0) * i1**2 + law.get("c3_pa", 0.0) * i1**3
        layer_m2 = 2.0 * np.pi * radius * (edges[1] - edges[0])
        self.energy_j = length * (density * layer_m2).sum(axis=0)
        coil = tube["coil"]
        self.wall_n = np.gradient(self.energy_j, TABLE_STEP_M)
        self.pull_n = self.wall_n + coil["stiffness_n_m"] * self.elongation_m
        self.stiffness_n_m = np.gradient(self.pull_n, TABLE_STEP_M)

    def at(self, table, elongation_m):
        """A tabulated quantity."""
        return np.interp(elongation_m, self.elongation_m, table)


@dataclass
class Motion:
    """What the calibrated simulation says of the inside of one run, SI, by sample; lists by muscle or by joint."""

    time_s: np.ndarray
    plunger_m: list
    elongation_m: list
    pressure_pa: list
    sliding: list
    pull_n: list
    joint: list


def motion(rig, run):
    """Reads the inside of a run off its simulation."""
    joints = [run.simulated[c.column] * c.unit for c in rig.coordinates]
    plungers = [v * 1e-3 for _, v in sorted(run.inputs.items())]
    elongations, pressures, slidings, pulls = [], [], [], []
    for i, column in enumerate(rig.pressures):
        offset = rig.start_m if rig.scene != "muscle_bench" else 0.0
        e = offset - sum(c.levers[i] * (q - c.start) for c, q in zip(rig.coordinates, joints))
        p = run.simulated[column] * 1e3
        z = dahl(e, rig.presliding_m)
        elongations.append(e)
        pressures.append(p)
        slidings.append(z)
        friction_n = (rig.m0_n + rig.m1_n_pa * np.maximum(p, 0.0)) * z
        pulls.append(rig.elastic.at(rig.elastic.pull_n, e) - p * rig.core_m2 + friction_n)
    return Motion(run.time_s, plungers, elongations, pressures, slidings, pulls, joints)


def dahl(path, length):
    """Sliding state of a path: dz = |du| (sgn du - z), u = path/length; starts at 0."""
    z = np.zeros(len(path))
    for k, step in enumerate(np.diff(path) / length):
        sign = np.sign(step)
        z[k + 1] = sign + (z[k] - sign) * np.exp(-abs(step))
    return z


def play_operator(path, width):
    """What follows a path with a dead zone, minus the path."""
    ahead = np.zeros(len(path))
    for k, step in enumerate(np.diff(path)):
        ahead[k + 1] = min(max(ahead[k] - step, -width / 2.0), width / 2.0)
    return ahead


def low_pass(values, time_s, constant_s):
    """First-order filter that starts settled."""
    out = np.empty(len(values))
    out[0] = values[0]
    shares = 1.0 - np.exp(-np.diff(time_s) / constant_s)
    for k, share in enumerate(shares):
        out[k + 1] = out[k] + share * (0.5 * (values[k] + values[k + 1]) - out[k])
    return out


def integral(values, time_s):
    """Running integral from the start."""
    steps = np.diff(time_s) * 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[0.0], np.cumsum(steps)])


def respond(rig, inside, volume, force, torque):
    """How added volumes (m3) and pulls (N) of the muscles and torques of the joints show.

    `inside` holds block values of a `Motion`; the others are (blocks, items, columns). Returns joints and pressures in
    the same form, SI.
    """
    levers = np.array([c.levers for c in rig.coordinates]).T
    stiffness = np.diag([c.stiffness for c in rig.coordinates])
    compliance = rig.upstream_m3_pa + rig.downstream_m3_pa
    blocks, muscles, columns = volume.shape
    joints = np.zeros((blocks, levers.shape[1], columns))
    slide = np.zeros((muscles, columns))
    elongated = np.zeros((muscles, columns))
    pressures = np.zeros((blocks, muscles, columns))
    steps = np.diff(inside["elongation"], axis=0, prepend=inside["elongation"][:1])
    for k in range(blocks):
        e, p, z, de = inside["elongation"][k], inside["pressure"][k], inside["sliding"][k], steps[k]
        k_e = rig.elastic.at(rig.elastic.stiffness_n_m, e)
        friction = rig.m0_n + rig.m1_n_pa * np.maximum(p, 0.0)
        area = rig.core_m2 - rig.m1_n_pa * z
        gain = np.clip(1.0 - np.sign(de) * z, 0.0, 1.0) / rig.presliding_m
        keep = np.exp(-np.abs(de) / rig.presliding_m)
        memory = keep[:, None] * slide - gain[:, None] * elongated
        pull_slope = k_e + friction * gain + area * rig.core_m2 / compliance
        fixed = friction[:, None] * memory - (area / compliance)[:, None] * volume[k] + force[k]
        matrix = levers.T @ (pull_slope[:, None] * levers) + stiffness
        joints[k] = np.linalg.solve(matrix, levers.T @ fixed + torque[k])
        now = -levers @ joints[k]
        slide = memory + gain[:, None] * now
        elongated = now
        pressures[k] = (volume[k] - rig.core_m2 * now) / compliance
    return joints, pressures
