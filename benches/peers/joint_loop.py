"""The joint model of the two-speed example in first gear, point by point in plain Python: see README.md.

What is the same at every point is prepared once, what hangs on the speed alone once for each point. The two ways are those of
joint_map.py: `passes` walks from the input to the output with all laws in every pass until the losses stand still to 1e-9 of the
power, `cascade` iterates only what hangs on itself in this gear state.
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
            unit = 1e-9 * sqrt(known["modulus"] / (2.0 * pi * mesh["line_length"]))
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

    def at_speeds(self, n):
        """All that hangs on the speed at the input alone."""
        w = n / RPM, n / RPM / self.first, n / RPM / self.first / self.second
        w_idle = w[2] * self.idle
        balls = [(self.at_speed(b, w[shaft] * RPM), ball) for shaft, b, ball in self.bearings]
        product = self.nu * (w[1] - w_idle) * RPM
        no_load = 1e-3 * self.needle["no_load"] * (1e-7 * product ** (2.0 / 3.0) if product >= 2000.0 else 160e-7)
        churned = sum(self.churning(wheel, w[2]) for wheel in self.wheels)
        return w, w_idle, balls, no_load, churned

    def braked(self, one, other, forces):
        """Moment of the two bearings of a shaft. Nm"""
        return self.moment(*one, forces) + self.moment(*other, forces)

    def passes(self, torque, n):
        """Loss for torque (Nm) and speed (rpm) at the input, both above zero, all laws in every pass. W"""
        w, w_idle, balls, no_load, churned = self.at_speeds(n)
        power = torque * w[0]
        slip = w[1] - w_idle
        own = 1e-3 * self.needle["moment_per_load"] * self.needle["load"]
        to_force = [mesh[0] for mesh in self.meshes]
        forces = [torque * to_force[0], 0.0, no_load * to_force[2]]
        before = moved = None
        for _ in range(60):
            braked = self.braked(balls[0], balls[1], forces) * w[0]
            into = power - braked
            forces[0] = into / w[0] * to_force[0]
            first = into * self.share(0, into / w[0], w[0])
            into -= first
            if not before:
                # The first guess.
                forces[1] = into / w[1] * to_force[1]
            carried = self.braked(balls[2], balls[3], forces) * w[1]
            moment = no_load + own * forces[2]
            forces[2] = moment * to_force[2]
            into -= carried + moment * w[1]
            forces[1] = into / w[1] * to_force[1]
            second = into * self.share(1, into / w[1], w[1])
            idle = moment * w_idle * self.share(2, moment, w_idle)
            last = self.braked(balls[4], balls[5], forces) * w[2]
            losses = braked, first, carried, moment * slip, second, idle, last
            if before:
                now = max(abs(a - b) for a, b in zip(losses, before))
                # What the next pass is going to move, if it falls as it did.
                if now * (now / moved if moved else 1.0) <= TOLERANCE * power:
                    return sum(losses) + churned
                moved = now
            before = losses
        raise ArithmeticError("no convergence")

    def cascade(self, torque, n):
        """The same shaft by shaft from the input: only the bearings of a shaft hang on what they take."""
        w, w_idle, balls, no_load, churned = self.at_speeds(n)
        power = torque * w[0]
        to_force = [mesh[0] for mesh in self.meshes]
        moment = no_load / (1.0 - 1e-3 * self.needle["moment_per_load"] * self.needle["load"] * to_force[2])
        forces = [0.0, 0.0, moment * to_force[2]]

        def settled(shaft, one, other, into):
            lost, moved = 0.0, None
            for _ in range(60):
                forces[shaft] = (into - lost) / w[shaft] * to_force[shaft]
                now = self.braked(one, other, forces) * w[shaft]
                change = abs(now - lost)
                lost = now
                if change * (change / moved if moved else 1.0) <= TOLERANCE * power:
                    forces[shaft] = (into - lost) / w[shaft] * to_force[shaft]
                    return lost
                moved = change
            raise ArithmeticError("no convergence")

        total = settled(0, balls[0], balls[1], power)
        into = power - total
        first = into * self.share(0, into / w[0], w[0])
        into -= first + moment * w[1]
        carried = settled(1, balls[2], balls[3], into)
        into -= carried
        second = into * self.share(1, into / w[1], w[1])
        idle = moment * w_idle * self.share(2, moment, w_idle) + moment * (w[1] - w_idle)
        return total + first + carried + second + idle + self.braked(balls[4], balls[5], forces) * w[2] + churned


def check_points(points, method="cascade", **inputs):
    """Losses at points of torque, speed and oil temperature."""
    known = constants.read()
    return [getattr(Gearbox(known, temperature=t, **inputs), method)(torque, n) for torque, n, t in points]
