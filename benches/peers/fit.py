"""Inputs found from the rig's points in first gear: SciPy's least_squares over the NumPy model, and `gearloss run`.

Both search in the same coordinates between the same bounds from the same start for the least sum of squares of the differences
of efficiency under the set `joint`, all points with one weight. Each has its own solver and its own differences; the program then
tells intervals and checks and writes a report.

Usage: python3 fit.py [path of gearloss]. Checks the model and that both end at the same cost.
"""

import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# Before NumPy is loaded.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np
from scipy.optimize import least_squares

import check
import constants
import joint_map

# Of the NumPy model and of the program; start and bounds; unit and how much it is; counted by its logarithm.
INPUTS = {
    "viscosity": ("lubricants.sump.viscosity.factor", 1.0, 0.4, 2.5, "", 1.0, True),
    # Two flanks together in the model, each by itself in the program.
    "rq": ("gears.*.surface.rq", 0.375, 0.1, 1.0, " um", 1e-6 * 2.0**0.5, False),
    "radial": ("bearings.*.radial_factor", 1.0, 0.5, 2.0, "", 1.0, True),
    "mu_bl": ("bearings.*.model.mu_bl", 0.15, 0.05, 0.25, "", 1.0, False),
}
PROBLEMS = (("rq", "mu_bl"), ("viscosity", "rq", "radial"))
# Standard deviation of every efficiency: scales the cost, decides nothing.
ACCURACY = 0.005
# How far the costs of both may differ, relative.
SAME = 1e-6
TIGHT = {"ftol": 1e-12, "xtol": 1e-12, "gtol": 1e-12}
REPEATS = 5
HEAD = """gearloss: study/1
title: Fit of a few inputs
gearboxes: { ours: gearbox.yaml }
conditions: { torque_at: input, speed_at: input, power_flow: real }
grids:
  one: { gear: first, torque: [10 Nm], speed: [10000 rpm] }
analyses:
"""
STARTING = "  fit: { type: map, grid: one, model_sets: [joint], write: [] }\n"
IDENTIFY = """  fit:
    type: identify
    model_sets: [joint]
    data: { file: rig.csv, stated_as: standard }
    gear: first
    starts: 1
    profiles: false
    folds: 0
    write: [json]
    parameters:
"""


def points():
    """Torque, speed, temperature and efficiency of the points in first gear."""
    with (check.EXAMPLE / "rig.csv").open() as file:
        rows = list(csv.reader((line for line in file if not line.startswith("#")), delimiter=";"))
    names, numbers = rows[0], [row for row in rows[2:] if row and row[0] == "first"]
    places = [names.index(name) for name in ("T_in", "n_in", "T_oil", "eta")]
    table = np.array([[float(row[place].replace(",", ".")) for place in places] for row in numbers])
    table[:, 3] *= 0.01
    return table


class Scipy:
    """SciPy over the NumPy model."""

    def __init__(self, table, names):
        self.torque, self.n, self.temperature = table[None, :, 0], table[:, 1], table[:, 2]
        self.power = table[:, 0] * table[:, 1] / joint_map.RPM
        self.efficiency, self.known, self.names = table[:, 3], constants.read(), names
        self.calls = 0

    def residual(self, u):
        """Calculated less measured efficiency over its accuracy."""
        self.calls += 1
        values = {name: x * INPUTS[name][5] for name, x in zip(self.names, self.values(u))}
        losses = joint_map.Gearbox(self.known, **values).losses(self.torque, self.n, self.temperature)[0]
        return (1.0 - losses / self.power - self.efficiency) / ACCURACY

    def values(self, u):
        """The inputs from their coordinates."""
        return [float(np.exp(x)) if INPUTS[name][6] else float(x) for x, name in zip(u, self.names)]

    def fit(self, options):
        """Seconds, cost, inputs, calls."""
        start, low, high = (
            [np.log(INPUTS[name][i]) if INPUTS[name][6] else INPUTS[name][i] for name in self.names] for i in (1, 2, 3)
        )
        self.calls = 0
        begun = time.process_time()
        found = least_squares(self.residual, start, bounds=(low, high), method="trf", x_scale="jac", **options)
        return time.process_time() - begun, float(found.cost), self.values(found.x), self.calls


class Program:
    """`gearloss run` over the same points."""

    def __init__(self, gearloss, folder, table):
        self.gearloss, self.folder = gearloss, Path(folder)
        (self.folder / "gearbox.yaml").write_text((check.EXAMPLE / "gearbox.yaml").read_text() + check.model_sets())
        with (self.folder / "rig.csv").open("w") as file:
            file.write("torque [Nm],speed [rpm],oil_temperature [degC],efficiency [-],efficiency_accuracy [-]\n")
            for row in table:
                file.write(",".join(repr(float(x)) for x in row) + f",{ACCURACY}\n")

    def run(self, analysis):
        """Seconds of a study with one analysis, and the folder of its results."""
        study, results = self.folder / "study.yaml", self.folder / "results"
        study.write_text(HEAD + analysis)
        command = [self.gearloss, "run", str(study), "--output", str(results), "--force"]
        with (self.folder / "said").open("w") as said:
            child = subprocess.Popen(command, stdout=said, stderr=said)
            _, status, used = os.wait4(child.pid, 0)
        if os.waitstatus_to_exitcode(status) != 0:
            sys.exit((self.folder / "said").read_text())
        return used.ru_utime + used.ru_stime, results

    def fit(self, names):
        """Seconds less those of a start, cost, inputs, evaluations."""
        analysis = IDENTIFY
        for name in names:
            path, start, low, high, unit, _, log = INPUTS[name]
            scale = ", scale: log" if log else ""
            analysis += f'      {name}: {{ path: "{path}", start: {start}{unit}, from: {low}{unit}, to: {high}{unit}{scale} }}\n'
        starting, _ = self.run(STARTING)
        seconds, results = self.run(analysis)
        search = json.loads((results / "fit.json").read_text())["identifications"][0]["search"]
        return seconds - starting, search["cost"], search["minima"][0]["parameters"], search["evaluations"]


def main():
    """Fits alternately and prints."""
    gearloss = check.program(*sys.argv[1:2])
    check.report(gearloss)
    table = points()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(gearloss, folder, table)
        for names in PROBLEMS:
            scipy = Scipy(table, names)
            runs = {
                "gearloss run": lambda names=names: program.fit(names),
                "SciPy trf": lambda scipy=scipy: scipy.fit({}),
                "SciPy trf, 1e-12": lambda scipy=scipy: scipy.fit(TIGHT),
            }
            found = {name: [] for name in runs}
            for _ in range(REPEATS):
                for name, run in runs.items():
                    found[name].append(run())
            print(f"\n{', '.join(names)} from {len(table)} points")
            print(f"{'solver':18} {'CPU s, min':>10} {'median':>8} {'calls':>6} {'us/point':>9} {'cost':>13}  inputs")
            best = min(fits[0][1] for fits in found.values())
            for name, fits in found.items():
                seconds = [fit[0] for fit in fits]
                _, cost, inputs, calls = fits[0]
                each = 1e6 * min(seconds) / calls / len(table)
                inputs = ", ".join(f"{x:.6f}" for x in inputs)
                print(
                    f"{name:18} {min(seconds):10.3f} {statistics.median(seconds):8.3f} {calls:6} {each:9.2f} {cost:13.6f}  {inputs}"
                )
                if not cost <= best * (1.0 + SAME):
                    sys.exit(f"{name} ends {cost / best - 1.0:.1e} above the lowest cost")


if __name__ == "__main__":
    main()
