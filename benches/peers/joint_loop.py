"""The joint model of the two-speed example in first gear, point by point in plain Python: see README.md.

What is the same at every point is prepared once, what hangs on the speed alone once for each point, and a pass walks from the input to
the output with the newest torques, until the losses stand still to 1e-9 of the power.
"""

from math import cbrt, exp, log, log10, pi, sin, sqrt

import constants

RPM = 30.0 / pi
TOLERANCE = 1e-9
# Shaft of each ball bearing from the input on.
SHAFTS = (("B1", 0), ("B2", 0), ("B3", 1), ("B4", 1), ("B5", 2), ("B6", 2))
STEEP = 24.6 * pi / 180.0
# Regression of Xu and others 2007.
B = (-8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305)
B3, B4 = B[3:5]


class Gearbox:
    """The gearbox at one temperature and one set of the inputs that a fit may vary."""

    def __init__(self, known, temperature=100.0, viscosity=1.0, rq=None, mu_bl=None, radial=1.0):
        (z1, z2), (z3, z4), (z5, z6) = known["teeth"]
        self.first, self.second, self.idle = z2 / z1, z4 / z3, z6 / z5
        oil = known["oil"]
        self.nu = viscosity * (10.0 ** 10.0 ** (oil["a"] - oil["b"] * log10(temperature + 273.15)) - 0.7)
        self.rho = oil["rho15"] * (1.0 - oil["expansion"] * (temperature - 15.0))
        self.mu_bl, self.mu_ehl = mu_bl or known["mu_bl"], oil["mu_ehl"]
        eta = self.nu * self.rho * 1e-3
        rough = 1e6 * (rq or known["rq"])
        self.meshes = []
        for mesh in known["meshes"]:
            nodes = mesh["nodes"]
            # Unit pressure in GPa over the root of the normal force.
            unit = 1e-9 * sqrt(known["modulus"] / (2.0 * pi * mesh["facewidth"]))
            front = exp(B[0] + B[8] * exp(rough) + B[1] * log(unit) + B[6] * log(eta))
            path = [
                (
                    front
                    * weight
                    * root_load ** B[1]
                    * slide_roll ** B[2]
                    * rolling ** B[5]
                    * radius ** B[7],
                    unit * root_load * slide_roll * log10(eta),
                )
                for weight, root_load, slide_roll, rolling, radius in zip(
                    nodes["weight"], nodes["root_load"], nodes["slide_roll"], nodes["rolling"], nodes["radius"]
                )
            ]
            self.meshes.append((mesh["force"], mesh["normal"], path))
        self.bearings = []
        for name, shaft in SHAFTS:
            b = known["bearings"][name]
            y, z, x = zip(*b["loads"])
            thrust = x if any(x) else None
            rolling, sliding = b["rolling"], b["sliding" if thrust else "sliding_radial"]
            loads = tuple(radial * c for c in y), tuple(radial * c for c in z), thrust
            self.bearings.append((shaft, b, (*loads, rolling, b["r2"], sliding, b["s2"], b["c0"])))
        self.needle = known["needle"] | {"load": radial * known["needle"]["load"]}
        self.wheels = known["wheels"]

    def at_speed(self, bearing, n):
        """What a ball bearing keeps while the load changes: factors of G_rr and of G_sl, and the drag. N mm"""
        nu, d_m = self.nu, bearing["d_m"]
        viscous = nu * n
        starved = exp(-bearing["starvation"] * viscous) / (1.0 + 1.84e-9 * (n * d_m) ** 1.28 * nu**0.64)
        boundary = exp(-2.6e-8 * viscous**1.4 * d_m)
        low, high = bearing["drag"]
        drag = n * n * (low + high * (n / nu) ** -1.379) if low else 0.0
        return starved * viscous**0.6, boundary * self.mu_bl + (1.0 - boundary) * self.mu_ehl, drag

    @staticmethod
    def moment(kept, ball, forces):
        """Moment of a ball bearing under the tangential forces of the meshes. Nm"""
        (y1, y2, y3), (z1, z2, z3), thrust, rolling, r2, sliding, s2, c0 = ball
        first, second, idle = forces
        y = y1 * first + y2 * second + y3 * idle
        z = z1 * first + z2 * second + z3 * idle
        radial = sqrt(y * y + z * z)
        if thrust is None:
            g_rr = rolling * radial**0.54
            g_sl = sliding * radial ** (5.0 / 3.0)
        else:
            axial = abs(thrust[0] * first + thrust[1] * second + thrust[2] * idle)
            pushed = axial / sin(STEEP * (axial / c0) ** 0.24)
            g_rr = rolling * (radial + r2 * pushed) ** 0.54
            g_sl = sliding * cbrt(radial**5 + s2 * pushed * axial**3)
        at_speed, mu, drag = kept
        return 1e-3 * (at_speed * g_rr + mu * g_sl + drag)

    def churning(self, wheel, w):
        """Power that a wheel loses in the oil. W"""
        re = 1e6 * w * wheel["reynolds"] / self.nu
        fr, gamma = w * w * wheel["froude"], w * w * wheel["gamma"]
        thick = re < 4000.0
        slow = (1.366 * re**-0.21 if thick else 0.239) * wheel["slow"] * fr**-0.6
        if gamma > 750.0:
            fast = (20.797 * re**-0.21 if thick else 3.644) * wheel["fast"] * fr**-0.88
            t = min((gamma - 750.0) / 500.0, 1.0)
            slow = slow * (1.0 - t) + fast * t
        return self.rho * w**3 * wheel["torque"] * slow

    def share(self, mesh, torque, w):
        """Share of its power that a mesh loses, for the torque and speed of its first gear."""
        force, normal, path = self.meshes[mesh]
        pressed = normal * force * torque
        root = sqrt(pressed)
        friction = 0.0
        for front, rise in path:
            x = rise * root
            friction += front * exp(B3 * x + B4 * exp(-x))
        return friction * root ** B[1] * w ** B[5] * normal * force

    def loss(self, torque, n):
        """Loss for torque (Nm) and speed (rpm) at the input, both above zero: the sum and the number of passes. W"""
        speeds = [n / RPM]
        speeds += [speeds[0] / self.first, speeds[0] / self.first / self.second]
        w_idle = speeds[2] * self.idle
        slip = speeds[1] - w_idle
        balls = [(self.at_speed(b, speeds[shaft] * RPM), ball) for shaft, b, ball in self.bearings]
        product = self.nu * slip * RPM
        no_load = self.needle["no_load"] * (1e-7 * product ** (2.0 / 3.0) if product >= 2000.0 else 160e-7)
        churned = sum(self.churning(wheel, speeds[2]) for wheel in self.wheels)
        power = torque * speeds[0]

        forces = [torque * self.meshes[0][0], torque * self.first * self.meshes[1][0], 0.0]
        before, moved = None, None
        for passes in range(1, 60):
            braked = (self.moment(*balls[0], forces) + self.moment(*balls[1], forces)) * speeds[0]
            into = power - braked
            turning_moment = into / speeds[0]
            forces[0] = turning_moment * self.meshes[0][0]
            first = into * self.share(0, turning_moment, speeds[0])
            carried = (self.moment(*balls[2], forces) + self.moment(*balls[3], forces)) * speeds[1]
            needle = 1e-3 * (no_load + self.needle["moment_per_load"] * self.needle["load"] * forces[2])
            forces[2] = needle * self.meshes[2][0]
            into = into - first - carried - needle * speeds[1]
            turning_moment = into / speeds[1]
            forces[1] = turning_moment * self.meshes[1][0]
            second = into * self.share(1, turning_moment, speeds[1])
            idle = needle * w_idle * self.share(2, needle, w_idle)
            last = (self.moment(*balls[4], forces) + self.moment(*balls[5], forces)) * speeds[2]
            losses = (braked, first, carried, needle * slip, second, idle, last)
            if before:
                now = max(abs(a - b) for a, b in zip(losses, before))
                # What the next pass is going to move, if it falls as it did.
                if now * (now / moved if moved else 1.0) <= TOLERANCE * power:
                    break
                moved = now
            before = losses
        return sum(losses) + churned, passes


def check_points(points, **inputs):
    """Losses at points of torque, speed and oil temperature."""
    known = constants.read()
    return [Gearbox(known, temperature=t, **inputs).loss(torque, n)[0] for torque, n, t in points]
