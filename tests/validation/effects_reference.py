#!/usr/bin/python3
"""fatmc simulate --effect against a closed loop flown here, noise off.

The aircraft is flight_model.Model: Euler angles, wind-axis forces, trim by scipy. What an effect does is written here anew, in
its own way: derivatives and masses in the model's dictionary, structures by solving for accelerations, the rest in the loop.
Both fly Runge-Kutta steps of 0.02 s; what is left between them are Euler angles against a quaternion (1e-8 of the rates).

Each effect has to change the flight, and the change has to agree. Usage: effects_reference.py FATMC MODEL
"""
import copy
import csv
import os
import subprocess
import sys
import tempfile
import tomllib

import numpy as np

from flight_model import G, Model

DEGREE = np.pi / 180
TICK, STEP = 0.02, 0.02
AXIS = {"roll": 0, "pitch": 1, "yaw": 2}
EXPERIMENT = """kind = "experiment"
[excitation]
period_s = 2.0
periods = 2
ranges_hz = [[0.5, 3.0, 0.5]]
amplitude_rad_s = [0.12, 0.08, 0.12]
[controller]
gain = [0.1, 0.1, 0.1]
[environment]
turbulence_sigma_m_s = 0.0
[imu]
grade = "none"
[simulation]
rk4_step_s = 0.02
"""


class Hidden(Model):
    """The model with what its dictionary cannot say. `about` is the trim of the model without effects."""

    def __init__(self, m, about=None):
        self.point = np.zeros(3)      # of the derivatives, from the centre of gravity
        self.rotor = 0.0
        self.apparent = np.zeros(3)
        self.quadratic, self.cubic = np.zeros(3), np.zeros(3)
        self.flexible = None          # axis, f, damping, slope
        self.slosh = None             # m, f, damping, x, z
        self.play = np.zeros(3)       # half width
        self.share = np.ones(3)
        self.linkage = None
        self.about = about
        self.offset = np.zeros(3)     # on the recorded command
        self.delay = 0.0
        self.dead = np.zeros(3)       # half width, commands
        self.gain = np.full(3, 0.1)
        self.coordinator = 1.0
        self.lag = 0.0
        self.sensor, self.bias = np.eye(3), np.zeros(3)
        self.quantum = 0.0
        self.tone = None              # axis, amplitude, f, phase
        self.step = STEP
        self.m = m

    def trimmed(self):
        super().__init__(self.m)
        self.inertia = self.inertia + np.diag(self.apparent)
        self.start = np.concatenate([self.x0, np.zeros(8)])   # e, de of three axes, y, dy of the liquid
        self.linkage = self.x0[10:13].copy()
        return self

    def rhs(self, x, cmd, gust=np.zeros(6)):
        if len(x) == 16:
            return self.motion(x, cmd, np.zeros(3))
        rigid, e, de, y, dy = x[:16], x[16:19], x[19:22], x[22], x[23]
        push = 0.0
        if self.slosh is not None:
            mass, f, damping, ahead, down = self.slosh
            w = 2 * np.pi * f
            force = mass * (w * w * y + 2 * damping * w * dy)
            place = np.array([ahead, 0.0, down])

            def specific(side, turn):
                """Specific force at the tank when the liquid adds force `side` and moment `turn` to what it does as a solid."""
                d = self.motion(rigid, cmd, np.array([0.0, side, 0.0]), place, turn)
                omega = rigid[3:6]
                a = d[0:3] + np.cross(omega, rigid[0:3]) + np.cross(d[3:6], place) + np.cross(omega, np.cross(omega, place))
                phi, theta = rigid[6:8]
                return a - G * np.array([-np.sin(theta), np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta)])

            # What it leans on floor and front does so at y; neither component hangs on side or turn.
            turn = np.cross([0.0, y, 0.0], -mass * specific(0.0, np.zeros(3)))
            # side = force + mass a(side), and a is linear in side: two points give the line.
            a0, a1 = specific(0.0, turn)[1], specific(1.0, turn)[1]
            push = (force + mass * a0) / (1 - mass * (a1 - a0))
            ddy = -(specific(push, turn)[1] + w * w * y + 2 * damping * w * dy)
            d = self.motion(rigid, cmd, np.array([0.0, push, 0.0]), place, turn)
        else:
            ddy = 0.0
            d = self.motion(rigid, cmd, np.zeros(3))
        dde = np.zeros(3)
        if self.flexible is not None:
            axis, f, damping, slope = self.flexible
            w = 2 * np.pi * f
            s = self.surfaces(rigid) - self.x0[10:13]
            delta = [s[0], (s[2] + s[1]) / 2, (s[2] - s[1]) / 2][axis]
            dde[axis] = -w * w * (e[axis] + slope * delta) - 2 * damping * w * de[axis]
        return np.concatenate([d, de, dde, [dy, ddy]])

    def surfaces(self, x):
        s = x[10:13]
        if self.play.any() and self.linkage is not None:    # before there is a trim there is nothing to drag
            s = np.minimum(np.maximum(self.linkage, s - self.play), s + self.play)
        return self.share * s

    def motion(self, x, cmd, extra, at=np.zeros(3), turn=np.zeros(3)):
        """Model.rhs with the additions; `extra`: a further force at a place; `turn`: a further moment."""
        seen = x.copy()
        if self.play.any():
            seen[10:13] = self.surfaces(x)
        omega = x[3:6]
        # The inflow is that at the reference point; forces follow from it, inertia from the true motion.
        seen[0:3] = x[0:3] + np.cross(omega, self.point)
        force, moment, flow = self.loads(seen)
        moment = moment + np.cross(self.point, force)
        qs, alpha, beta, hats, (b, c) = flow
        lengths = np.array([b, c, b])
        moment = moment + qs * lengths * self.quadratic * hats * np.abs(hats)
        if self.cubic.any():
            angle = np.array([np.sin(beta), alpha - self.about, np.sin(beta)])
            moment = moment + qs * lengths * self.cubic * angle ** 3
        h = np.array([2 * np.pi * self.rotor * x[8], 0.0, 0.0])
        moment = moment - np.cross(omega, h)
        force, moment = force + extra, moment + np.cross(at, extra) + turn
        base = super().rhs(x, cmd)          # attitude, propeller, servos
        phi, theta = x[6:8]
        weight = G * np.array([-np.sin(theta), np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta)])
        base[0:3] = force / self.m["mass"]["mass_kg"] + weight - np.cross(omega, x[0:3])
        base[3:6] = np.linalg.solve(self.inertia, moment - np.cross(omega, self.inertia @ omega))
        if self.point.any():
            base[8] = super().rhs(seen, cmd)[8]     # the propeller meets the air at the reference point
        surface_rates = x[13:16]
        for i in range(3):
            limit = self.m["aileron" if i == 0 else "ruddervator"]["rate_limit_rad_s"]
            base[10 + i] = np.clip(surface_rates[i], -limit, limit)
        return base

    def loads(self, x):
        """Force and moment of air and propeller, by Model.rhs of a body of unit mass and inertia at rest in rotation."""
        unit = copy.copy(self)
        unit.m = dict(self.m, mass=dict(self.m["mass"], mass_kg=1.0))
        unit.inertia = np.eye(3)
        d = Model.rhs(unit, x, np.zeros(3))
        phi, theta = x[6:8]
        weight = G * np.array([-np.sin(theta), np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta)])
        force = d[0:3] - weight + np.cross(x[3:6], x[0:3])
        moment = d[3:6]     # w x w vanishes
        speed = np.linalg.norm(x[0:3])
        geo = self.m["geometry"]
        b, c = geo["span_m"], geo["chord_m"]
        hats = x[3:6] * np.array([b, c, b]) / (2 * speed)
        flow = (self.rho / 2 * speed ** 2 * geo["wing_area_m2"], np.arctan2(x[2], x[0]), np.arcsin(x[1] / speed), hats, (b, c))
        return force, moment, flow

    def advance(self, x, cmd, span):
        steps = max(1, int(np.ceil(span / self.step - 1e-9)))
        h = span / steps
        nodes = []
        for _ in range(steps):
            k1 = self.rhs(x, cmd)
            k2 = self.rhs(x + h / 2 * k1, cmd)
            k3 = self.rhs(x + h / 2 * k2, cmd)
            k4 = self.rhs(x + h * k3, cmd)
            x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            for i in range(3):
                servo = self.m["aileron" if i == 0 else "ruddervator"]
                x[13 + i] = np.clip(x[13 + i], -servo["rate_limit_rad_s"], servo["rate_limit_rad_s"])
                stop = servo["position_limit_rad"]
                if abs(x[10 + i]) > stop:
                    x[10 + i] = np.sign(x[10 + i]) * stop
                    if x[10 + i] * x[13 + i] > 0:
                        x[13 + i] = 0.0
            self.linkage = np.minimum(np.maximum(self.linkage, x[10:13] - self.play), x[10:13] + self.play)
            nodes.append((h, x[3:6] + x[19:22]))
        return x, nodes

    def fly(self, reference):
        x = self.start.copy()
        full = self.m["command"]["full_deflection_rad"]
        seen = before = x[3:6] + x[19:22]
        past = [np.zeros(3)] * (int(self.delay / TICK) + 3)
        out = []
        for t, r in enumerate(reference):
            w = seen if self.lag > 0 else x[3:6] + x[19:22]
            if self.tone is not None:
                axis, amplitude, f, phase = self.tone
                w = w.copy()
                w[axis] += amplitude * np.sin(2 * np.pi * f * t * TICK + phase)
            y = self.sensor @ w + self.bias
            if self.quantum > 0:
                y = np.rint(y / self.quantum) * self.quantum
            u = self.gain * (r - y)
            phi, theta = x[6:8]
            u[2] += self.gain[2] * self.coordinator * G / np.linalg.norm(x[0:3]) * np.sin(phi) * np.cos(theta)
            out.append(np.concatenate([u + self.offset, y]))
            past = [np.sign(u) * np.maximum(np.abs(u) - self.dead, 0.0)] + past[:-1]
            ticks = int(self.delay / TICK + 1e-9)
            rest = self.delay - ticks * TICK
            nodes = []
            if rest > 1e-12:
                x, first = self.advance(x, past[ticks + 1], rest)
                nodes += first
            x, second = self.advance(x, past[ticks], TICK - rest)
            for h, rates in nodes + second:
                if self.lag > 0:
                    # 1/(T s + 1) behind a rate that is linear over the step: its solution is that ramp less T times its slope.
                    slope = (rates - before) / h
                    steady = rates - self.lag * slope
                    seen = steady + np.exp(-h / self.lag) * (seen - (before - self.lag * slope))
                before = rates
        return np.array(out)


def scaled(table, key, factor):
    def change(a):
        a.m[table][key] *= factor
    return change


def servo(name, key, value):
    def change(a):
        a.m[name][key] = value(a.m[name][key])
    return change


def attribute(name, value):
    return lambda a: setattr(a, name, value)


def entry(name, index, value):
    def change(a):
        getattr(a, name)[index] = value
    return change


def rotated(axis, angle):
    """Components of a vector in a unit that is turned by the angle about the axis."""
    out = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out[i, i] = out[j, j] = np.cos(angle)
    out[i, j], out[j, i] = np.sin(angle), -np.sin(angle)
    return out


def effectiveness(a):
    a.m["lift"]["eta"] *= 0.8
    a.m["pitch"]["eta"] *= 0.8


def coupling(a):
    a.m["yaw"]["xi"] += 0.1 * a.m["roll"]["xi"]


def quadratic(a):
    a.quadratic[0] = 0.5 * a.m["roll"]["p"] / (0.1 * a.m["geometry"]["span_m"] / (2 * a.m["trim"]["speed_m_s"]))


def cubic(a):
    a.cubic[2] = 0.5 * a.m["yaw"]["beta"] / DEGREE ** 2


def apparent(a):
    a.apparent[2] = 0.2 * a.m["mass"]["izz_kg_m2"]


def surface_bias(a):
    a.offset[1] += 1.0 * DEGREE / a.m["command"]["full_deflection_rad"]


def dead_zone(a):
    a.dead[0] = 0.5 * 0.5 * DEGREE / a.m["command"]["full_deflection_rad"]


def play(a):
    a.play[1:] = 0.5 * 0.5 * DEGREE


def fast_servo(a):
    # Poles -40 (1.89 +- 1.604): |lambda| 0.02 s = 2.8, flown in two parts.
    a.m["aileron"]["damping"] *= 2.1
    a.step = STEP / 2


EFFECTS = [
    ("transport_delay:delay_s=0.05", attribute("delay", 0.05)),
    ("actuator_bandwidth:surface=aileron,factor=0.5", servo("aileron", "frequency_rad_s", lambda v: 0.5 * v)),
    ("actuator_damping:surface=aileron,factor=2.1", fast_servo),
    ("rate_limit:surface=ruddervator,limit_deg_s=4", servo("ruddervator", "rate_limit_rad_s", lambda v: 4 * DEGREE)),
    ("position_limit:surface=aileron,limit_deg=0.6", servo("aileron", "position_limit_rad", lambda v: 0.6 * DEGREE)),
    ("backlash:surface=ruddervator,width_deg=0.5", play),
    ("dead_zone:axis=roll,width_deg=0.5", dead_zone),
    ("control_effectiveness:axis=pitch,factor=0.8", effectiveness),
    ("surface_bias:axis=pitch,bias_deg=1", surface_bias),
    ("loop_gain:axis=yaw,factor=1.4", entry("gain", 2, 0.14)),
    ("turn_coordinator:factor=-1", attribute("coordinator", -1.0)),
    ("mass:factor=1.15", scaled("mass", "mass_kg", 1.15)),
    ("inertia:axis=yaw,factor=1.2", apparent),
    ("cg_shift:direction=forward,shift_m=0.02", attribute("point", np.array([-0.02, 0.0, 0.0]))),
    ("propeller_gyroscopics:inertia_kg_m2=0.03", attribute("rotor", 0.03)),
    ("roll_to_yaw_coupling:ratio=0.1", coupling),
    ("cm_alpha:factor=1.2", scaled("pitch", "alpha", 1.2)),
    ("cl_p:factor=0.8", scaled("roll", "p", 0.8)),
    ("quadratic_damping:axis=roll,ratio=0.5", quadratic),
    ("cubic_moment:axis=yaw,ratio=0.5", cubic),
    ("flexible_mode:axis=pitch,slope=0.01,frequency_hz=1.7,damping=0.03", attribute("flexible", (1, 1.7, 0.03, 0.01))),
    ("slosh:mass_kg=2,frequency_hz=0.9,damping=0.05,forward_m=0.3,down_m=0.1", attribute("slosh", (2, 0.9, 0.05, 0.3, 0.1))),
    ("gyro_lag:time_constant_s=0.04", attribute("lag", 0.04)),
    ("gyro_scale:axis=roll,error=0.1", attribute("sensor", np.diag([1.1, 1.0, 1.0]))),
    ("gyro_misalignment:axis=yaw,angle_deg=6", attribute("sensor", rotated(2, 6 * DEGREE))),
    ("gyro_bias:axis=roll,bias_deg_s=1", attribute("bias", np.array([1.0, 0.0, 0.0]) * DEGREE)),
    ("tone:axis=pitch,amplitude_deg_s=1,frequency_hz=1.3,phase_deg=40", attribute("tone", (1, DEGREE, 1.3, 40 * DEGREE))),
]


def main():
    fatmc, path = sys.argv[1:3]
    with open(path, "rb") as file:
        parent = tomllib.load(file)
    with tempfile.TemporaryDirectory() as folder:
        experiment, record = os.path.join(folder, "short.toml"), os.path.join(folder, "record.csv")
        with open(experiment, "w") as file:
            file.write(EXPERIMENT)

        def simulated(*options):
            subprocess.run([fatmc, "simulate", path, experiment, "--seed", "3", *options, "-o", record], check=True,
                           capture_output=True)
            with open(record) as file:
                rows = list(csv.DictReader(file))
            columns = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
            reference = np.stack([columns[n] for n in ("r_p", "r_q", "r_r")], axis=1)
            return reference, np.stack([columns[n] for n in ("xi_c", "eta_c", "zeta_c", "p", "q", "r")], axis=1)

        reference, plain = simulated()
        own = Hidden(copy.deepcopy(parent)).trimmed()
        base = own.fly(reference)
        alpha, eta = own.x0[7], own.trim_eta
        scale = np.abs(plain).max(axis=0)
        print(f"no effect: {np.max(np.abs(base - plain) / scale):.1e} of the signals")
        assert np.max(np.abs(base - plain) / scale) < 1e-6
        failed = 0
        for text, change in EFFECTS:
            _, theirs = simulated("--effect", text)
            aircraft = Hidden(copy.deepcopy(parent), alpha)
            change(aircraft)
            aircraft.trimmed()
            # Commands are counted from the trim of the model without the effect.
            aircraft.offset[1] += (eta - aircraft.trim_eta) / parent["command"]["full_deflection_rad"]
            ours = aircraft.fly(reference)
            size = np.max(np.abs(theirs - plain) / scale)
            error = np.max(np.abs((ours - theirs) / scale))
            good = error < 1e-5 * size and size > 1e-3
            failed += not good
            print(f"{'ok  ' if good else 'FAIL'} {text}: changes the signals by {size:.3f}, agrees to {error / size:.1e} of that")
        assert failed == 0, f"{failed} effects differ"


if __name__ == "__main__":
    main()
