"""What does not depend on the operating point of the two-speed example in first gear under the set `joint`: joint_first.json.

The figures of the gearbox are those of examples/two-speed-ev/gearbox.yaml, those of its bearings as
`gearloss check --resolved examples/two-speed-ev/gearbox.yaml` prints them. Geometry after ISO 21771, loads by statics of shafts on
two bearings, constants of bearings after SKF and ISO/TR 14179-2. SI, but for what the bearing formulas want in mm.

Usage: python3 constants.py, which writes joint_first.json beside itself. check.py holds the result to the program.
"""

import json
from math import acos, asin, atan, cos, floor, hypot, log10, pi, radians, sin, sqrt, tan
from pathlib import Path

FILE = Path(__file__).with_name("joint_first.json")

SHAFTS = {"input": (133.4e-3, 124.2e-3), "intermediate": (92e-3, 69e-3), "output": (0.0, 0.0)}
# teeth, face widths, profile shift of the first gear, hand of the first gear (1 right), module, pressure and helix angle,
# centre distance, place, shafts
MESHES = {
    "M1": ((16, 83), (21e-3, 20e-3), 0.25, 1.0, 1.25e-3, 20.0, 26.0, 69e-3, 22e-3, ("input", "intermediate")),
    "M2": ((24, 101), (26e-3, 25e-3), 0.25, -1.0, 1.6e-3, 17.5, 29.0, 115e-3, 50e-3, ("intermediate", "output")),
    "M3": ((31, 96), (23e-3, 22e-3), 0.30, -1.0, 1.6e-3, 17.5, 27.0, 115e-3, 128e-3, ("intermediate", "output")),
}
# The sense of the tangential force on the first gear where the input drives and turns in the positive sense.
SENSE = {"M1": -1.0, "M2": 1.0, "M3": 1.0}
# shaft, place, takes thrust, bore, outside (mm), C0, height of the oil (mm), R1/1e-7, S1/1e-3, S2
BEARINGS = {
    "B1": ("input", 0.0, False, 17.0, 47.0, 6550.0, 0.0, 3.7, 2.84, 92.8),
    "B2": ("input", 66e-3, True, 17.0, 47.0, 6550.0, 0.0, 3.7, 2.84, 92.8),
    "B3": ("intermediate", 0.0, True, 25.0, 62.0, 11600.0, 0.0, 3.7, 2.84, 92.8),
    "B4": ("intermediate", 160e-3, False, 25.0, 62.0, 11600.0, 0.0, 3.7, 2.84, 92.8),
    "B5": ("output", 0.0, True, 25.0, 52.0, 7800.0, 14.0, 3.9, 3.23, 36.5),
    "B6": ("output", 160e-3, False, 25.0, 52.0, 7800.0, 14.0, 3.9, 3.23, 36.5),
}
OIL_LEVEL, OIL_VOLUME = -49e-3, 1.2e-3
RQ = hypot(0.375e-6, 0.375e-6)
MODULUS = 206e9 / (1.0 - 0.3**2)
# Three points on each smooth piece; the program takes seven.
GAUSS = ((-sqrt(0.6), 5.0 / 9.0), (0.0, 8.0 / 9.0), (sqrt(0.6), 5.0 / 9.0))
# V_M of the drag of balls at H/d_m of 0.35 and 0.40, between which both bearings of the output lie.
V_M = ((0.35, 4.33e-4), (0.40, 4.80e-4))
K_Z = 3.1


def involute(angle):
    """inv of an angle in rad."""
    return tan(angle) - angle


def pair(z, widths, shift, hand, module, pressure, helix, distance, at, shafts):
    """Geometry of a pair, and its path of contact as quadrature points."""
    alpha_n, beta = radians(pressure), radians(helix)
    module_t, alpha_t = module / cos(beta), atan(tan(alpha_n) / cos(beta))
    beta_b = asin(sin(beta) * cos(alpha_n))
    teeth = z[0] + z[1]
    a = 0.5 * module_t * teeth
    alpha_w = acos(a * cos(alpha_t) / distance)
    total = (involute(alpha_w) - involute(alpha_t)) * teeth / (2.0 * tan(alpha_n))
    shifts = (shift, total - shift)
    shortening = min(0.0, (distance - a) / module - total)
    reference = [module_t * n for n in z]
    base = [0.5 * d * cos(alpha_t) for d in reference]
    tip = [d + 2.0 * module * (1.0 + x + shortening) for d, x in zip(reference, shifts)]
    root = [d - 2.0 * module * (1.25 - x) for d, x in zip(reference, shifts)]
    tangent = distance * sin(alpha_w)
    reach = [sqrt((0.5 * d) ** 2 - r * r) for d, r in zip(tip, base)]
    start, end, pitch = tangent - reach[1], reach[0], base[0] * tan(alpha_w)
    base_pitch = pi * module_t * cos(alpha_t)
    ratio = z[1] / z[0]
    breaks = {start, end, pitch}
    for k in range(1, floor((end - start) / base_pitch) + 1):
        breaks |= {x for x in (start + k * base_pitch, end - k * base_pitch) if start < x < end}
    breaks = sorted(breaks)
    nodes = []
    for left, right in zip(breaks, breaks[1:]):
        for t, w in GAUSS:
            x, weight = 0.5 * (left + right) + 0.5 * (right - left) * t, 0.5 * (right - left) * w
            share = 1.0 / (1 + max(0, floor((x - start) / base_pitch)) + max(0, floor((end - x) / base_pitch)))
            rho = (x, tangent - x)
            sliding = (1.0 + 1.0 / ratio) * abs(x - pitch)
            sum_speed = rho[0] + rho[1] / ratio
            radius = rho[0] * rho[1] / (rho[0] + rho[1]) / cos(beta_b)
            nodes.append(
                {
                    "slide_roll": 2.0 * sliding / sum_speed,
                    "rolling": 0.5 * sum_speed,
                    "radius": radius,
                    "root_load": sqrt(share / radius),
                    "weight": weight / base_pitch * share * sliding,
                }
            )
    first, second = SHAFTS[shafts[0]], SHAFTS[shafts[1]]
    away = (second[0] - first[0], second[1] - first[1])
    return {
        "z": z,
        # G1 stands in the middle of G2 and so on, so the narrower face is the common one.
        "facewidth": min(widths),
        "base_radius": base[0],
        "working_radius": [distance * n / teeth for n in z],
        "cos_base_helix": cos(beta_b),
        "tan_alpha": tan(alpha_w),
        "hand_tan_beta": hand * tan(beta) * cos(alpha_t) / cos(alpha_w),
        "direction": [c / hypot(*away) for c in away],
        "at": at,
        "shafts": shafts,
        "reference_diameter": reference,
        "tooth_height": [0.5 * (t - r) for t, r in zip(tip, root)],
        "module": module,
        "alpha_n": alpha_n,
        "beta": beta,
        "widths": widths,
        "nodes": nodes,
    }


def force(mesh, sense, gear):
    """Force on a gear in x, y, z for one newton of tangential force in its sense, and the arm from the axis in y and z."""
    (ey, ez), turn = mesh["direction"], sense if gear == 0 else -sense
    press = mesh["tan_alpha"] if gear == 0 else -mesh["tan_alpha"]
    r = mesh["working_radius"][0] if gear == 0 else -mesh["working_radius"][1]
    return (-turn * mesh["hand_tan_beta"], -turn * ez - press * ey, turn * ey - press * ez), (r * ey, r * ez)


def loads(meshes):
    """Radial load in y and z and thrust of each bearing for one newton of tangential force of each mesh."""
    found = {}
    for name, (shaft, at, thrust, *_) in BEARINGS.items():
        other = next(b[1] for n, b in BEARINGS.items() if b[0] == shaft and n != name)
        rows = []
        for key, mesh in meshes.items():
            row = [0.0, 0.0, 0.0]
            if shaft in mesh["shafts"]:
                # Loose gears pass force, couple and thrust on to their shaft.
                (fx, fy, fz), (ry, rz) = force(mesh, SENSE[key], mesh["shafts"].index(shaft))
                arm = mesh["at"] - other
                row = [-(arm * fy - ry * fx) / (at - other), -(arm * fz - rz * fx) / (at - other), fx if thrust else 0.0]
            rows.append(row)
        found[name] = rows
    return found


def bearing(d, big_d, c0, height, r1, s1, s2):
    """Constants of the SKF model of a deep groove ball bearing, mm and N."""
    d_m, ratio = 0.5 * (d + big_d), K_Z * (d + big_d) / (big_d - d)
    drag = [0.0, 0.0]
    if height > 0.0:
        (x0, y0), (x1, y1) = V_M
        v_m = y0 + (y1 - y0) * (height / d_m - x0) / (x1 - x0)
        assert x0 < height / d_m < x1, "V_M is tabled between these only"
        t = 2.0 * acos((0.6 * d_m - height) / (0.6 * d_m))
        f_t = sin(0.5 * t) if t <= pi else 1.0
        r_s = 0.36 * d_m * d_m * (t - sin(t)) * 0.05 * ratio
        # a n^2 + b n^2 (n/nu)^-1.379
        drag = [0.4 * v_m * ratio * 1e-12 * d_m**5, 1.093e-7 * d_m**3 * (d_m * d_m * f_t) ** -1.379 * r_s]
    return {
        "d_m": d_m,
        "c0": c0,
        "rolling": r1 * 1e-7 * d_m**1.96,
        "r2": 1.7,
        "sliding_radial": s1 * 1e-3 * d_m**-0.26,
        "sliding": s1 * 1e-3 * d_m**-0.145,
        "s2": s2 * d_m**1.5,
        "starvation": 3e-8 * (d + big_d) * sqrt(K_Z / (2.0 * (big_d - d))),
        "drag": drag,
    }


def churning(mesh):
    """A wheel that dips: what the law of Changenet of 2011 asks for, S_m and the powers of h/D, V/D^3 and b/D taken in."""
    z, diameter, b = mesh["z"][1], mesh["reference_diameter"][1], mesh["widths"][1]
    radius = 0.5 * diameter
    dip = min(max(OIL_LEVEL + radius, 0.0), diameter)
    theta = acos(1.0 - dip / radius)
    teeth = 2.0 * z * theta * mesh["tooth_height"][1] * b / (pi * cos(mesh["alpha_n"]) * cos(mesh["beta"]))
    surface = radius * radius * (2.0 * theta - sin(2.0 * theta)) + 2.0 * radius * b * theta + teeth
    h, v, w = dip / diameter, OIL_VOLUME / diameter**3, b / diameter
    return {
        "torque": 0.5 * radius**3 * surface,
        "reynolds": radius * b,
        "froude": radius / 9.80665,
        "gamma": (radius * b * mesh["module"]) ** (1.0 / 3.0),
        "slow": h**0.45 * v**0.1 * w**0.21,
        "fast": h**0.1 * v**-0.35 * w**0.85,
    }


def oil():
    """Viscosity over temperature after ASTM D341 from kv100 and an index of 150 (ASTM D2270), density, full-film friction."""
    kv100, index = 6.4, 150.0
    # kv100 is where two ranges of the standard's table meet; the program takes the lower one, and so does this.
    h = (0.04985 * kv100 + 9.1613) * kv100 - 18.557
    kv40 = h / kv100 ** log10(1.0 + 0.00715 * (index - 100.0))
    y = [log10(log10(nu + 0.7)) for nu in (kv40, kv100)]
    x = [log10(t + 273.15) for t in (40.0, 100.0)]
    slope = (y[0] - y[1]) / (x[1] - x[0])
    return {"a": y[0] + slope * x[0], "b": slope, "rho15": 850.0, "expansion": 7e-4, "mu_ehl": 0.10}


def constants():
    """All of it."""
    meshes = {name: pair(*figures) for name, figures in MESHES.items()}
    bearings = {}
    supported = loads(meshes)
    for name, (_, _, _, d, big_d, c0, height, r1, s1, s2) in BEARINGS.items():
        bearings[name] = bearing(d, big_d, c0, height, r1, s1, s2) | {"loads": supported[name]}
    # The cage under the loose pinion G5 carries what its mesh presses.
    _, fy, fz = force(meshes["M3"], SENSE["M3"], 0)[0]
    d_m = 0.5 * (32.0 + 37.0)
    needle = {"load": hypot(fy, fz), "moment_per_load": 0.002 * d_m, "no_load": 12.0 * d_m**3}
    return {
        "made_by": "constants.py",
        "teeth": [mesh["z"] for mesh in meshes.values()],
        "meshes": [
            {
                "force": 1.0 / mesh["working_radius"][0],
                "normal": mesh["working_radius"][0] / mesh["base_radius"] / mesh["cos_base_helix"],
                "line_length": mesh["facewidth"] / mesh["cos_base_helix"],
                "nodes": {key: [node[key] for node in mesh["nodes"]] for key in mesh["nodes"][0]},
            }
            for mesh in meshes.values()
        ],
        "modulus": MODULUS,
        "rq": RQ,
        "bearings": bearings,
        "mu_bl": 0.15,
        "needle": needle,
        "wheels": [churning(meshes["M2"]), churning(meshes["M3"])],
        "oil": oil(),
    }


def read():
    """What stands in joint_first.json."""
    return json.loads(FILE.read_text())


if __name__ == "__main__":
    FILE.write_text(json.dumps(constants(), indent=1) + "\n")
