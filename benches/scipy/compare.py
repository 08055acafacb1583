"""Evaluations and times of our solver and of SciPy's least_squares(method="trf") on the same residuals.

Both begin at the same start, in the same coordinates, inside the same bounds, and every call of the residual function
counts, those for differences among them. A cost counts as reached at the first call within a share of the lowest cost that
any solver ends with, where the search stood there: our solver tells where it did, and of SciPy's calls those do not count
that differ from an earlier one in a single coordinate.

Needs numpy and scipy, and the library of this folder: see run.sh.
"""

import argparse
import ctypes
import os
import sys
import time
from pathlib import Path

import numpy
import scipy
from scipy.optimize import least_squares

ROOT = Path(__file__).resolve().parents[2]
STUDY = ROOT / "examples" / "two-speed-ev" / "study.yaml"
SHARES = (1e-4, 1e-6, 1e-8)
# Relative difference of costs of the same minimum.
SAME = 1e-4
OURS = "gearloss"
ROOM = 1 << 20
TIGHT = {"ftol": 1e-12, "xtol": 1e-12, "gtol": 1e-12}
# Two-sided times the noise of the residuals, of which SciPy knows nothing unless it is told.
WIDE = {"diff_step": 1e-4}
SOLVERS = (
    ("trf", {}),
    ("trf, 1e-12", TIGHT),
    ("trf, steps 1e-4", WIDE),
    ("trf, steps 1e-4, 1e-12", {**WIDE, **TIGHT}),
)


class Outcome(ctypes.Structure):
    """What a fit came to, as in src/lib.rs."""

    _fields_ = [
        ("cost", ctypes.c_double),
        ("seconds", ctypes.c_double),
        ("evaluations", ctypes.c_uint64),
        ("steps", ctypes.c_uint64),
        ("threads", ctypes.c_uint64),
        ("converged", ctypes.c_int32),
    ]


def load(path):
    """The library with the types of its functions."""
    library = ctypes.CDLL(str(path))
    pointer, text, size = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t
    for name, given_back, taken in (
        ("new", pointer, (text, text, text, text, size)),
        ("check", pointer, (ctypes.c_uint32,)),
        ("free", None, (pointer,)),
        ("rows", size, (pointer,)),
        ("parameters", size, (pointer,)),
        ("box", None, (pointer, pointer, pointer, pointer)),
        ("name", None, (pointer, size, text, size)),
        ("eval", ctypes.c_int32, (pointer, pointer, pointer)),
        ("fit", ctypes.c_int32, (pointer, pointer, ctypes.POINTER(Outcome))),
        ("trace", size, (pointer, pointer, size)),
        ("words", None, (pointer, text, size)),
    ):
        function = getattr(library, f"gearloss_residual_{name}")
        function.restype, function.argtypes = given_back, taken
    return library


class Residual:
    """One problem of the library."""

    def __init__(self, library, study=None, seed=None):
        self.library = library
        if study is None:
            self.handle = library.gearloss_residual_check(seed)
        else:
            error = ctypes.create_string_buffer(ROOM)
            texts = [str(part).encode() for part in study]
            self.handle = library.gearloss_residual_new(*texts, error, ROOM)
            if not self.handle:
                sys.exit(f"{study[1]} under {study[2]}: {error.value.decode()}")
        self.rows = library.gearloss_residual_rows(self.handle)
        n = library.gearloss_residual_parameters(self.handle)
        self.start, self.lower, self.upper = (numpy.empty(n) for _ in range(3))
        library.gearloss_residual_box(self.handle, *(x.ctypes.data for x in (self.start, self.lower, self.upper)))

    def __del__(self):
        self.library.gearloss_residual_free(self.handle)

    def names(self):
        """Names of the parameters."""
        name = ctypes.create_string_buffer(ROOM)
        for j in range(len(self.start)):
            self.library.gearloss_residual_name(self.handle, j, name, ROOM)
            yield name.value.decode()

    def __call__(self, u):
        u, r = numpy.ascontiguousarray(u, dtype=float), numpy.empty(self.rows)
        if self.library.gearloss_residual_eval(self.handle, u.ctypes.data, r.ctypes.data):
            return numpy.full(self.rows, numpy.nan)
        return r

    def ours(self, start):
        """A fit with our own solver."""
        outcome = Outcome()
        failed = self.library.gearloss_residual_fit(self.handle, start.ctypes.data, ctypes.byref(outcome))
        words = ctypes.create_string_buffer(ROOM)
        self.library.gearloss_residual_words(self.handle, words, ROOM)
        if failed:
            sys.exit(words.value.decode())
        calls = self.library.gearloss_residual_trace(self.handle, None, 0)
        trace = numpy.empty((calls, len(start) + 2))
        self.library.gearloss_residual_trace(self.handle, trace.ctypes.data, calls)
        costs = numpy.where(trace[:, -1] == 1.0, trace[:, -2], numpy.inf)
        return Run(OURS, costs, outcome.seconds, outcome.cost, outcome.evaluations, words.value.decode().splitlines())

    def scipy(self, name, options, start):
        """A fit with SciPy, every call noted down."""
        calls, costs = [], []

        def residual(u):
            r = self(u)
            # Differences follow their point, so that a look at the latest calls suffices.
            difference = any(numpy.count_nonzero(before != u) == 1 for before in calls[-2 * len(u) :])
            calls.append(u.copy())
            costs.append(numpy.inf if difference else 0.5 * r @ r)
            return r

        bounds = (self.lower, self.upper)
        begun = time.perf_counter()
        fit = least_squares(residual, start, jac="2-point", bounds=bounds, method="trf", x_scale="jac", **options)
        seconds = time.perf_counter() - begun
        return Run(name, numpy.array(costs), seconds, fit.cost, len(calls), [fit.message])

    def all(self, start):
        """Fits with all solvers."""
        return [self.ours(start), *(self.scipy(name, options, start) for name, options in SOLVERS)]


class Run:
    """One fit: costs of its calls, infinite where the search did not stand, wall time, last cost, calls, how it ended."""

    def __init__(self, name, costs, seconds, cost, evaluations, end):
        self.name, self.costs, self.seconds, self.cost = name, costs, seconds, cost
        self.evaluations, self.end = evaluations, end

    def reached(self, level):
        """Number of the first call at a cost no greater than a level."""
        below = numpy.flatnonzero(self.costs <= level)
        return int(below[0]) + 1 if len(below) else None


def head(column):
    """Names of the columns."""
    shares = " ".join(f"{'to ' + format(share, '.0e'):>9}" for share in SHARES)
    return f"{column:24} {shares} {'calls':>7} {'wall s':>8} {'ms/call':>8}"


def compare(title, residual, log):
    """Prints the table of one problem from its own start."""
    print(f"\n{title}: {residual.rows} residuals of {', '.join(residual.names())}")
    residual(residual.start)
    runs = residual.all(residual.start)
    best = min(run.cost for run in runs)
    print(f"{head('solver')} {'cost':>16} {'above best':>11}")
    for run in runs:
        to = " ".join(f"{run.reached(best * (1 + share)) or 'never':>9}" for share in SHARES)
        each = 1e3 * run.seconds / run.evaluations
        above = run.cost / best - 1
        print(f"{run.name:24} {to} {run.evaluations:7} {run.seconds:8.2f} {each:8.2f} {run.cost:16.9f} {above:11.1e}")
    for run in runs:
        print(f"  {run.name}: {run.end[0]}")
        if log:
            for line in run.end[1:]:
                print(f"    {line}")
            lowest = numpy.inf
            for i, cost in enumerate(run.costs):
                if cost < lowest:
                    lowest = cost
                    print(f"    call {i + 1}: cost {cost:.9f}, {cost / best - 1:.1e} above the best")


def many(residual, count):
    """Prints medians over other starts, of those from which all solvers end in the same minimum."""
    random = numpy.random.default_rng(1)
    lower, width = residual.lower, residual.upper - residual.lower
    starts = [lower + width * random.uniform(size=len(width)) for _ in range(count)]
    fits = [residual.all(start) for start in starts]
    lowest = min(run.cost for runs in fits for run in runs)
    same = [runs for runs in fits if all(run.cost <= lowest * (1 + SAME) for run in runs)]
    for j, run in enumerate(fits[0]):
        there = sum(runs[j].cost <= lowest * (1 + SAME) for runs in fits)
        print(f"  {run.name}: {there} of {count} random starts lead within {SAME:.0e} of the lowest cost")
    if not same:
        return
    print(f"medians of {len(same)} starts, and how many of them came as near")
    print(head("solver"))
    for j, run in enumerate(same[0]):
        own = [runs[j] for runs in same]
        columns = []
        for share in SHARES:
            levels = [min(run.cost for run in runs) * (1 + share) for runs in same]
            to = [run.reached(level) or numpy.inf for run, level in zip(own, levels)]
            median, near = numpy.median(to), numpy.count_nonzero(numpy.isfinite(to))
            columns.append(f"{format(median, '.0f') if numpy.isfinite(median) else 'never':>5} {f'({near})':>4}"[:10])
        calls, seconds = (numpy.median([getattr(run, key) for run in own]) for key in ("evaluations", "seconds"))
        print(f"{run.name:24}{''.join(columns)} {calls:7.0f} {seconds:8.2f} {1e3 * seconds / calls:8.2f}")


def main():
    """Compares on all problems."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--library", required=True, type=Path, help="the library of this folder, built by cargo")
    parser.add_argument("--starts", type=int, default=0, help="random starts beside the problem's own")
    parser.add_argument("--log", action="store_true", help="print all steps")
    arguments = parser.parse_args()
    library = load(arguments.library.resolve())
    load_average = ", ".join(f"{x:.1f}" for x in os.getloadavg()) if hasattr(os, "getloadavg") else "unknown"
    print(
        f"Python {sys.version.split()[0]}, numpy {numpy.__version__}, scipy {scipy.__version__}, "
        f"{os.cpu_count()} cores, load {load_average}"
    )
    print('"to 1e-6": calls until the cost is within 1e-6 of the best that any solver ends with')
    for title, problem in (
        ("two-speed-ev, eight parameters under joint", {"study": (STUDY, "eight", "joint")}),
        ("two-speed-ev, its entry identify under complete", {"study": (STUDY, "identify", "complete")}),
        ("loss map of the solver's tests", {"seed": 1}),
    ):
        residual = Residual(library, **problem)
        compare(title, residual, arguments.log)
        if arguments.starts:
            many(residual, arguments.starts)


if __name__ == "__main__":
    main()
