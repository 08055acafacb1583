"""Holds the peers to the program: losses at the corners, edges and middle of the map, and with other inputs, to 4e-5 of each.

Usage: python3 check.py [path of gearloss], else GEARLOSS names it, else target/release/gearloss. Ends with an error where one
differs.
"""

import json
import os
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "two-speed-ev"
MODEL_SETS, AFTER = "\nmodel_sets:", "\nmeasurements:"
# Three points on each smooth piece miss up to 3e-5 of the loss. With 32 points the peers agree with the program to 1e-6, which
# tests/peers.rs holds.
WITHIN = 4e-5
# Torque (Nm), speed (rpm), temperature (degC).
POINTS = [(t, n, 100.0) for t in (0.02, 0.5, 10.0, 20.0) for n in (22.0, 1000.0, 10000.0, 22000.0)]
POINTS += [(3.3, 14000.0, 40.0), (7.0, 700.0, 40.0)]
# The same inputs for the peers and for the program.
VARIED = (
    {"viscosity": 0.5, "rq": 0.9e-6 * 2.0**0.5, "mu_bl": 0.08, "radial": 1.7},
    [
        "lubricants.sump.viscosity.factor=0.5",
        "gears.*.surface.rq=0.9 um",
        "bearings.*.radial_factor=1.7",
        *(f"bearings.B{i}.model.mu_bl=0.08" for i in range(1, 7)),
    ],
)
VARIED_POINTS = [(0.5, 500.0, 100.0), (5.0, 8000.0, 100.0), (20.0, 22000.0, 100.0), (10.0, 3000.0, 40.0)]


def program(path=None):
    """Path of the program: as given, else as GEARLOSS says, else where cargo builds it."""
    path = Path(path or os.environ.get("GEARLOSS") or ROOT / "target" / "release" / "gearloss").resolve()
    if not path.exists():
        sys.exit(f"missing: {path}; build it with `cargo build --release`, or name it by GEARLOSS=...")
    return str(path)


def model_sets():
    """The sets of the study, as its file has them."""
    text = (EXAMPLE / "study.yaml").read_text()
    begin = text.index(MODEL_SETS)
    return text[begin : text.index(AFTER, begin)] + "\n"


def solved(gearloss, gearbox, point, changes):
    """Loss in W that the program finds."""
    torque, n, temperature = point
    command = [gearloss, "solve", str(gearbox), "--models", "joint", "--gear", "first", "--format", "json"]
    command += ["--torque", f"{torque!r} Nm", "--speed", f"{n!r} rpm", "--oil-temperature", f"{temperature!r} degC"]
    for change in changes:
        command += ["--set", change]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr}")
    return json.loads(done.stdout)["loss_w"]


def check(gearloss, peers):
    """Compares all peers, each a name and a function of points and inputs; gives the largest relative difference of each."""
    worst = dict.fromkeys(peers, 0.0)
    with tempfile.TemporaryDirectory() as folder:
        gearbox = Path(folder) / "gearbox.yaml"
        gearbox.write_text((EXAMPLE / "gearbox.yaml").read_text() + model_sets())
        for points, (inputs, changes) in ((POINTS, ({}, [])), (VARIED_POINTS, VARIED)):
            expected = [solved(gearloss, gearbox, point, changes) for point in points]
            for name, losses in peers.items():
                for point, loss, own in zip(points, expected, losses(points, **inputs)):
                    off = abs(own / loss - 1.0)
                    # Also what is no number fails.
                    if not off <= WITHIN:
                        sys.exit(f"{name} at {point} {inputs}: {own!r} W, the program {loss!r} W, {off:.1e} off")
                    worst[name] = max(worst[name], off)
    return worst


def peers():
    """The peers by name."""
    import joint_loop
    import joint_map

    found = {}
    for name, module in (("NumPy", joint_map), ("Python loop", joint_loop)):
        for method in joint_map.METHODS:
            found[f"{name}, {method}"] = partial(module.check_points, method=method)
    return found


def report(gearloss):
    """Checks and prints."""
    worst = check(gearloss, peers())
    print(f"check: {len(POINTS) + len(VARIED_POINTS)} points against the program, largest relative difference of the loss:")
    for name, off in worst.items():
        print(f"  {name}: {off:.1e}")


if __name__ == "__main__":
    report(program(*sys.argv[1:2]))
