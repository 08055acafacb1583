"""The joint model of the two-speed example in first gear as NumPy over all points at once: see README.md.

Torques are a column and speeds a row, so that what hangs on the speed alone is computed once for each speed and broadcast. Points
go in chunks that stay in the cache; the path of contact adds an axis in front. Two ways to the same losses, both to 1e-9 of the
power:

`passes`   walks from the input to the output with the newest torques, all laws in every pass, until the losses stand still: the
           iteration that a program for any gearbox needs, and that fits any change of this one.
`cascade`  uses that in this gear state nothing upstream hangs on what is downstream: the few laws that do hang on each other are
           iterated alone, the idle branch is solved in closed form, and each mesh is evaluated once.
"""

import argparse
import time
from math import factorial

import numpy as np

import constants

RPM = 30.0 / np.pi
TOLERANCE = 1e-9
METHODS = ("passes", "cascade")
SAFETY = 0.5
# Points in one chunk: the path of contact makes 2 x 12 arrays of them, which fit into 1 MB of cache.
CHUNK = 4096
# (-1)^n/(2n + 1)! from n = 7 down to 1.
SINE = [(-1.0) ** n / float(factorial(2 * n + 1)) for n in range(7, 0, -1)]
# Regression of Xu and others 2007.
B = (-8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305)


def sine(x):
    """The sine of angles below 0.6 rad, to rounding: its series is several times as fast as NumPy's, which is for any angle."""
    square = x * x
    series = square * SINE[0]
    for c in SINE[1:]:
        series += c
        series *= square
    series += 1.0
    series *= x
    return series


class Mesh:
    """One mesh: its path of contact with all that is fixed taken in."""

    def __init__(self, known, modulus):
        nodes = {key: np.array(values) for key, values in known["nodes"].items()}
        # Unit pressure in GPa over the root of the torque of the first gear.
        unit = 1e-9 * np.sqrt(modulus * known["normal"] * known["force"] / (2.0 * np.pi * known["line_length"]))
        self.force = known["force"]
        self.rise = (unit * nodes["root_load"] * nodes["slide_roll"])[:, None]
        self.inner, self.outer = -self.rise, B[3] * self.rise
        geometry = nodes["root_load"] ** B[1] * nodes["slide_roll"] ** B[2]
        geometry *= nodes["rolling"] ** B[5] * nodes["radius"] ** B[7] * nodes["weight"]
        self.front = geometry * unit ** B[1] * known["normal"] * known["force"]
        self.room = {}

    def share(self, torque, per_speed, lg_eta):
        """Share of its power that the mesh loses; `per_speed` is what hangs on speed and oil."""
        root = np.sqrt(torque)
        size = root.size
        if size not in self.room:
            self.room = {size: np.empty((2, len(self.rise), size))}
        x, e = self.room[size]
        steep = (root * lg_eta).reshape(1, -1)
        np.multiply(self.inner, steep, out=e)
        np.exp(e, out=e)
        e *= B[4]
        np.multiply(self.outer, steep, out=x)
        e += x
        np.exp(e, out=e)
        friction = (self.front @ e).reshape(root.shape)
        np.log(root, out=root)
        root *= B[1]
        np.exp(root, out=root)
        friction *= root
        friction *= per_speed
        return friction


class Balls:
    """One ball bearing: its load in y, z and x for each mesh, and the SKF model without what hangs on speed."""

    def __init__(self, known, radial):
        y, z, x = np.array(known["loads"]).T
        self.y, self.z, self.x = radial * y, radial * z, x
        # Under one mesh alone the size of the load is enough.
        self.alone = np.hypot(self.y, self.z) if np.count_nonzero(y) == 1 else None
        self.axial = bool(np.any(x))
        self.known = known

    def at_speed(self, n, nu, mu_bl, mu_ehl):
        """Factors of the rolling and of the sliding variable, and the drag, times the speed: W per unit."""
        d_m = self.known["d_m"]
        product = nu * n
        ln_product = np.log(product)
        starved = np.exp(-self.known["starvation"] * product) * np.exp(0.6 * ln_product)
        starved /= 1.0 + 1.84e-9 * (n * d_m) ** 1.28 * nu**0.64
        boundary = np.exp(-2.6e-8 * np.exp(1.4 * ln_product) * d_m)
        low, high = self.known["drag"]
        drag = n * n * (low + high * (n / nu) ** -1.379) if low else 0.0 * n
        watts = 1e-3 * n / RPM
        if self.axial:
            fronts = self.known["rolling"], self.known["sliding"]
        else:
            fronts = self.known["rolling"], self.known["sliding_radial"]
        return fronts[0] * watts * starved, fronts[1] * watts * (mu_ehl + boundary * (mu_bl - mu_ehl)), watts * drag

    def power(self, kept, forces):
        """Power lost under the tangential forces of the meshes."""
        if self.alone is not None:
            mesh = int(np.argmax(self.alone))
            radial = self.alone[mesh] * forces[mesh]
            square = None
        else:
            used = [i for i in range(3) if self.y[i] or self.z[i]]
            y, z = (sum(c[i] * forces[i] for i in used) for c in (self.y, self.z))
            square = y * y
            z *= z
            square += z
            radial = None
        rolling, sliding, drag = kept
        if not self.axial:
            ln = np.log(radial) if square is None else 0.5 * np.log(square)
            power = np.exp(0.54 * ln)
            power *= rolling
            ln *= 5.0 / 3.0
            np.exp(ln, out=ln)
            ln *= sliding
            power += ln
            power += drag
            return power
        if radial is None:
            radial = np.sqrt(square)
        axial = np.abs(sum(self.x[i] * forces[i] for i in range(3) if self.x[i]))
        pushed = np.log(axial)
        pushed *= 0.24
        np.exp(pushed, out=pushed)
        pushed *= 24.6 * np.pi / 180.0 / self.known["c0"] ** 0.24
        np.divide(axial, sine(pushed), out=pushed)
        both = self.known["r2"] * pushed
        both += radial
        np.log(both, out=both)
        both *= 0.54
        np.exp(both, out=both)
        both *= rolling
        axial *= axial * axial
        pushed *= axial
        pushed *= self.known["s2"]
        radial *= (radial * radial) ** 2
        pushed += radial
        np.cbrt(pushed, out=pushed)
        pushed *= sliding
        both += pushed
        both += drag
        return both


class Gearbox:
    """The gearbox with the inputs that a fit may vary."""

    def __init__(self, known, viscosity=1.0, rq=None, mu_bl=None, radial=1.0):
        (z1, z2), (z3, z4), (z5, z6) = known["teeth"]
        self.first, self.second, self.idle = z2 / z1, z4 / z3, z6 / z5
        self.oil, self.viscosity = known["oil"], viscosity
        self.mu_bl = known["mu_bl"] if mu_bl is None else mu_bl
        rough = 1e6 * (known["rq"] if rq is None else rq)
        self.rough = np.exp(B[0] + B[8] * np.exp(rough))
        self.meshes = [Mesh(mesh, known["modulus"]) for mesh in known["meshes"]]
        self.bearings = {name: Balls(b, radial) for name, b in known["bearings"].items()}
        self.needle, self.radial = known["needle"], radial
        self.wheels = known["wheels"]

    def churning(self, wheel, w, nu, rho):
        """Power that a wheel loses in the oil."""
        re = 1e6 * w * wheel["reynolds"] / nu
        fr, gamma = w * w * wheel["froude"], w * w * wheel["gamma"]
        thick = re < 4000.0
        low = re**-0.21 if np.any(thick) else 0.0
        c_m = np.where(thick, 1.366 * low, 0.239) * wheel["slow"] * fr**-0.6
        if np.any(gamma > 750.0):
            fast = np.where(thick, 20.797 * low, 3.644) * wheel["fast"] * fr**-0.88
            c_m += (fast - c_m) * np.clip((gamma - 750.0) / 500.0, 0.0, 1.0)
        return rho * w**3 * wheel["torque"] * c_m

    def at_speed(self, n, temperature):
        """All that hangs on speed and oil alone, for a row of speeds."""
        oil = self.oil
        nu = self.viscosity * (10.0 ** 10.0 ** (oil["a"] - oil["b"] * np.log10(temperature + 273.15)) - 0.7)
        rho = oil["rho15"] * (1.0 - oil["expansion"] * (temperature - 15.0))
        eta = nu * rho * 1e-3
        w = [n / RPM]
        w += [w[0] / self.first, w[0] / self.first / self.second]
        w_idle = w[2] * self.idle
        slip = w[1] - w_idle
        shafts = {"B1": 0, "B2": 0, "B3": 1, "B4": 1, "B5": 2, "B6": 2}
        kept = {
            name: b.at_speed(w[shafts[name]] * RPM, nu, self.mu_bl, oil["mu_ehl"]) for name, b in self.bearings.items()
        }
        product = nu * slip * RPM
        thick = np.where(product >= 2000.0, 1e-7 * np.maximum(product, 2000.0) ** (2.0 / 3.0), 160e-7)
        churned = sum(self.churning(wheel, w[2], nu, rho) for wheel in self.wheels)
        oiled = self.rough * eta ** B[6]
        mesh = [oiled * speed ** B[5] for speed in (w[0], w[1], w_idle)]
        return w, w_idle, slip, kept, self.needle["no_load"] * thick, churned, mesh, np.log10(eta)

    def losses(self, torque, n, temperature=100.0, method="cascade"):
        """Losses in W for torques (Nm) and speeds (rpm) at the input, above zero: (torques, speeds) for a column and a row."""
        rows, columns = torque.shape[0], len(n)
        answer = np.empty((rows, columns))
        temperature = np.broadcast_to(np.asarray(temperature, dtype=float), n.shape)
        wide = min(columns, CHUNK)
        high = max(1, CHUNK // wide)
        for c in range(0, columns, wide):
            part = slice(c, c + wide)
            kept, one = self.at_speed(n[part], temperature[part]), self.passes
            if method == "cascade":
                kept, one = kept + self.idling(kept), self.cascade
            column = torque if torque.shape[1] == 1 else torque[:, part]
            for r in range(0, rows, high):
                answer[r : r + high, part] = one(column[r : r + high], kept)
        return answer

    def braked(self, names, forces, bearings):
        """Power that the bearings of one shaft lose."""
        return sum(self.bearings[name].power(bearings[name], forces) for name in names)

    def idling(self, kept):
        """Moment of the cage under the idle pinion, and all losses that hang on the speed alone."""
        _, w_idle, slip, _, thick, churned, mesh, lg_eta = kept
        idle = self.meshes[2]
        # The force that the cage carries comes from its own moment: constant + factor x moment.
        own = 1e-3 * self.needle["moment_per_load"] * self.needle["load"] * self.radial * idle.force
        moment = 1e-3 * thick / (1.0 - own)
        return moment, moment * slip + moment * w_idle * idle.share(moment, mesh[2], lg_eta) + churned

    def cascade(self, torque, kept):
        """Shaft by shaft from the input: only the bearings of a shaft hang on what they take."""
        w, _, _, bearings, _, _, mesh, lg_eta, moment, spun = kept
        power = torque * w[0]
        first, second, idle = self.meshes

        def settled(names, into, force, forces, which):
            # Newton's way with the slope between the first two answers; that slope is in doubt by about its own share.
            forces[which] = into * force
            lost = self.braked(names, forces, bearings)
            slope = None
            for _ in range(60):
                forces[which] = (into - lost) * force
                left = self.braked(names, forces, bearings)
                left -= lost
                if slope is None:
                    slope = left / lost
                    steep = np.max(np.abs(slope)) ** 2
                    slope = 1.0 - slope
                size = np.max(np.abs(left / power)) * steep
                left /= slope
                lost += left
                if size <= SAFETY * TOLERANCE:
                    return lost
            raise ArithmeticError("no convergence")

        forces = [None, 0.0, moment * idle.force]
        lost = settled(("B1", "B2"), power, first.force / w[0], forces, 0)
        into = power - lost
        forces[0] = into * (first.force / w[0])
        rubbed = into * first.share(into / w[0], mesh[0], lg_eta)
        total = lost + rubbed
        into -= rubbed
        into -= moment * w[1]
        lost = settled(("B3", "B4"), into, second.force / w[1], forces, 1)
        total += lost
        into -= lost
        forces[1] = into * (second.force / w[1])
        total += into * second.share(into / w[1], mesh[1], lg_eta)
        total += self.braked(("B5", "B6"), forces, bearings)
        total += spun
        return total

    def passes(self, torque, kept):
        """All laws in every pass, with the newest torques."""
        w, w_idle, slip, bearings, thick, churned, mesh, lg_eta = kept
        power = torque * w[0]
        first, second, idle = self.meshes
        own = 1e-3 * self.needle["moment_per_load"] * self.needle["load"] * self.radial
        forces = [torque * first.force + 0.0 * w[0], None, 1e-3 * idle.force * thick]
        before, moved = None, None
        for _ in range(60):
            losses = [self.braked(("B1", "B2"), forces, bearings)]
            into = power - losses[0]
            turning = into / w[0]
            forces[0] = turning * first.force
            losses.append(into * first.share(turning, mesh[0], lg_eta))
            if before is None:
                # The first guess, near enough that a pass is saved.
                forces[1] = (into - losses[1]) * (second.force / w[1])
            losses.append(self.braked(("B3", "B4"), forces, bearings))
            moment = 1e-3 * thick + own * forces[2]
            forces[2] = moment * idle.force
            losses.append(moment * slip)
            into -= losses[1]
            into -= losses[2]
            into -= moment * w[1]
            turning = into / w[1]
            forces[1] = turning * second.force
            losses.append(into * second.share(turning, mesh[1], lg_eta))
            losses.append(moment * w_idle * idle.share(moment, mesh[2], lg_eta))
            losses.append(self.braked(("B5", "B6"), forces, bearings))
            if before is not None:
                size = max(np.max(np.abs(a - b) / power) for a, b in zip(losses, before))
                if size * (size / moved if moved else 1.0) <= SAFETY * TOLERANCE:
                    return sum(losses) + churned
                moved = size
            before = losses
        raise ArithmeticError("no convergence")


def check_points(points, method="cascade", **inputs):
    """Losses at points of torque, speed and oil temperature."""
    torque, n, temperature = np.array(points, dtype=float).T
    return Gearbox(constants.read(), **inputs).losses(torque[None, :], n, temperature, method)[0]


def grid(size):
    """Torques and speeds of a square map."""
    steps = np.arange(1, size + 1) / size
    return 20.0 * steps[:, None], 22000.0 * steps


def main():
    """Times the map of a size (points along each axis) and prints points per second; checks first."""
    import check

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("gearloss", nargs="?", help="the program, to check against; else GEARLOSS names it")
    parser.add_argument("--size", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    check.report(check.program(arguments.gearloss))
    gearbox = Gearbox(constants.read())
    torque, n = grid(arguments.size)
    for method in METHODS:
        times = []
        for _ in range(arguments.repeats):
            begun = time.perf_counter()
            gearbox.losses(torque, n, method=method)
            times.append(time.perf_counter() - begun)
        print(f"{method}: {arguments.size**2 / min(times):,.0f} points/s")


if __name__ == "__main__":
    main()
