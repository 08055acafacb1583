"""The joint map by all peers alternately on one core, one thread each: seconds, points per second, ratios. See README.md.

Usage: python3 run.py [path of gearloss] [--core N] [--rounds N] [--size N]. GEARLOSS_PEERS names the program of the folder
`program`, else it is where cargo builds it; without it the library alone is left out, and that is said.
"""

import argparse
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

# Before NumPy is loaded, here and in what is started from here.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np

import check
import constants
import joint_loop
import joint_map

HERE = Path(__file__).resolve().parent
LIBRARY = "gearloss, library"
RUN = "gearloss run"
STUDY = """gearloss: study/1
title: Joint map
gearboxes: {{ ours: gearbox.yaml }}
conditions: {{ torque_at: input, speed_at: input, oil_temperature: 100 degC, power_flow: real }}
grids:
  map:
    gear: first
    torque: {{ from: {t} Nm, to: 20 Nm, step: {t} Nm }}
    speed: {{ from: {n} rpm, to: 22000 rpm, step: {n} rpm }}
analyses:
  map: {{ type: map, grid: map, model_sets: [joint], write: [] }}
"""
# The plain loop goes over a coarser map: its time per point is the same.
LOOP = 100
# Sums of losses over the same map differ by the three Gauss points of the scripts, which have an error of up to 3e-5 of a loss.
SAME = 1e-5


def child(command):
    """Wall and CPU seconds of a process, and what it says."""
    with tempfile.TemporaryFile("w+") as said, tempfile.TemporaryFile("w+") as wrong:
        begun = time.perf_counter()
        process = subprocess.Popen(command, stdout=said, stderr=wrong)
        _, status, used = os.wait4(process.pid, 0)
        wall = time.perf_counter() - begun
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        wrong.seek(0)
        if process.returncode != 0:
            sys.exit(f"{' '.join(command)}: {wrong.read()}")
        return np.array([wall, used.ru_utime + used.ru_stime]), said.read()


def own(work):
    """Wall and CPU seconds of something done here."""
    begun = np.array([time.perf_counter(), time.process_time()])
    work()
    return np.array([time.perf_counter(), time.process_time()]) - begun


def all_of(loss, points):
    """Losses point by point."""
    return [loss(*point) for point in points]


# How often a start is timed.
STARTS = 10


def start_of(command):
    """The least CPU time of a command for one point, which is taken from both times of a map: by the clock, a start may be other work.
    What else runs can only add to it, and a start that was slow by chance would make the map after it look fast."""
    return min(child(command)[0][1] for _ in range(STARTS))


class Library:
    """The program's library without results and report. One process over all rounds, as NumPy has one: memory is new to both once."""

    def __init__(self, path, gearbox, size):
        self.process = subprocess.Popen([path, gearbox, str(size)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.words = {}

    def cpu(self):
        """CPU seconds of the process so far; none where the system does not tell."""
        told = Path(f"/proc/{self.process.pid}/schedstat")
        return 1e-9 * float(told.read_text().split()[0]) if told.exists() else None

    def __call__(self):
        before = self.cpu()
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        said = self.process.stdout.readline().split()
        if not said:
            sys.exit(f"the library ended early: {self.process.wait()}")
        self.words = dict(zip(said[::2], said[1::2]))
        wall = float(self.words["seconds"])
        return np.array([wall, wall if before is None else self.cpu() - before])


class Run:
    """A map by `gearloss run`, less that of one point."""

    def __init__(self, gearloss, folder, size):
        self.commands = []
        for points in (1, size):
            study = folder / f"map-{points}.yaml"
            study.write_text(STUDY.format(t=20.0 / points, n=22000.0 / points))
            self.commands.append([gearloss, "run", str(study), "--output", str(folder / f"map-{points}"), "--force"])
        self.start = start_of(self.commands[0])

    def __call__(self):
        return child(self.commands[1])[0] - self.start


def machine(gearloss):
    """Where and with what this ran."""
    cpu = platform.processor()
    if Path("/proc/cpuinfo").exists():
        names = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
        cpu = names[0].split(":", 1)[1].strip() if names else cpu
    version = subprocess.run([gearloss, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    # What NumPy was compiled for beyond the baseline, and this processor has.
    simd = np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
    print(f"{time.strftime('%Y-%m-%d')}, {cpu}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}, {platform.platform()}")
    print(f"{version}, Python {platform.python_version()}, NumPy {np.__version__} ({' '.join(simd) or 'baseline'})")


def main():
    """Checks, runs all in turn, prints."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("gearloss", nargs="?", help="the program; else GEARLOSS names it")
    parser.add_argument("--core", type=int, default=0)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", type=int, default=1000, help="torques and speeds of the map")
    arguments = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {arguments.core})
    gearloss, size = check.program(arguments.gearloss), arguments.size
    machine(gearloss)
    check.report(gearloss)

    known = constants.read()
    numpy, loop = joint_map.Gearbox(known), joint_loop.Gearbox(known)
    torque, n = joint_map.grid(size)
    coarse = [(20.0 * i / LOOP, 22000.0 * j / LOOP) for i in range(1, LOOP + 1) for j in range(1, LOOP + 1)]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        gearbox = folder / "gearbox.yaml"
        gearbox.write_text((check.EXAMPLE / "gearbox.yaml").read_text() + check.model_sets())
        target = Path(os.environ.get("CARGO_TARGET_DIR", HERE / "program" / "target"))
        path = Path(os.environ.get("GEARLOSS_PEERS", target / "release" / "gearloss-peers"))
        runs = {}
        if path.exists():
            runs[LIBRARY] = (Library(path, gearbox, size), size**2)
        else:
            print(f"missing: {path}; the library alone is left out. Build it with cargo, see README.md.")
        runs[RUN] = (Run(gearloss, folder, size), size**2)
        for method in joint_map.METHODS:
            runs[f"NumPy, {method}"] = (partial(own, partial(numpy.losses, torque, n, method=method)), size**2)
        # The same points as if each had a speed of its own.
        every = torque.repeat(size, axis=1).reshape(1, -1), np.tile(n, size)
        runs["NumPy, scattered"] = (partial(own, partial(numpy.losses, *every, method="cascade")), size**2)
        for method in joint_map.METHODS:
            runs[f"Python loop, {method}"] = (partial(own, partial(all_of, getattr(loop, method), coarse)), len(coarse))
        seconds = {name: [] for name in runs}
        for _ in range(arguments.rounds):
            for name, (work, _) in runs.items():
                seconds[name].append(work())

    print(f"\nmap of {size} x {size} points (Python loop {LOOP} x {LOOP}), {arguments.rounds} rounds, core {arguments.core}")
    print(f"{'':20} {'us/point of CPU':>20} {'us/point by the clock':>22} {'points/s of CPU':>16}")
    print(f"{'':20} {'min':>10} {'median':>9} {'min':>12} {'median':>9} {'at min':>16}")
    least = {}
    for name, (_, points) in runs.items():
        wall, cpu = 1e6 * np.array(seconds[name]).T / points
        least[name] = min(cpu)
        print(
            f"{name:20} {min(cpu):10.3f} {statistics.median(cpu):9.3f} {min(wall):12.3f} {statistics.median(wall):9.3f} "
            f"{1e6 / min(cpu):16,.0f}"
        )
    print("\ntimes as fast as, CPU at min")
    print(f"{'':20} " + " ".join(f"{name:>20}" for name in runs))
    for name in runs:
        print(f"{name:20} " + " ".join(f"{least[other] / least[name]:20.2f}" for other in runs))
    if LIBRARY in runs:
        words = runs[LIBRARY][0].words
        print(f"\nthe library: {words['passes']} passes and {words['calls']} calls of loss models per point")
        total = numpy.losses(torque, n).sum()
        off = abs(total / float(words["sum"]) - 1.0)
        print(f"sum of all losses of the map: NumPy and the library differ by {off:.1e}")
        if not off <= SAME:
            sys.exit("the maps differ")


if __name__ == "__main__":
    main()
