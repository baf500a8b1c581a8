#!/usr/bin/python3
"""Builds the FAT's linear dynamics from fat.toml alone and compares them with `fatmc linearize --format json`.

Independent: equations of motion written here in Euler angles, wind-axis forces rotated by alpha, trim by
scipy.optimize.root, derivatives by Richardson-extrapolated central differences, sampling by the Runge-Kutta
polynomial and by scipy's exact zero-order hold. Usage: flight_model.py FATMC MODEL
"""
import json
import subprocess
import sys
import tomllib

import numpy as np
from scipy import optimize, signal

G = 9.80665


def density(h):
    t = 288.15 - 0.0065 * h
    return 101325.0 * (t / 288.15) ** (G / (287.05287 * 0.0065)) / (287.05287 * t)


class Model:
    def __init__(self, m):
        self.m = m
        self.rho = density(m["trim"]["altitude_m"])
        mass = m["mass"]
        self.inertia = np.array([[mass["ixx_kg_m2"], 0, -mass["ixz_kg_m2"]],
                                 [0, mass["iyy_kg_m2"], 0],
                                 [-mass["ixz_kg_m2"], 0, mass["izz_kg_m2"]]])
        v = m["trim"]["speed_m_s"]

        def level(z):
            alpha, eta, tau, n = z
            x = np.zeros(16)
            x[0], x[2], x[7] = v * np.cos(alpha), v * np.sin(alpha), alpha
            x[8], x[9], x[11], x[12] = n, tau, eta, eta
            self.trim_eta, self.trim_tau = eta, tau
            self.x0 = x
            return self.rhs(x, np.zeros(3))[[0, 2, 4, 8]]

        found = optimize.root(level, [0.04, 0.0, 0.5, 75.0], method="hybr", tol=1e-14)
        level(found.x)
        assert np.abs(self.rhs(self.x0, np.zeros(3))).max() < 1e-9, found.message

    def rhs(self, x, cmd, gust=np.zeros(6)):
        m = self.m
        geo, prop = m["geometry"], m["propulsion"]
        s, b, c = geo["wing_area_m2"], geo["span_m"], geo["chord_m"]
        velocity, omega = x[0:3], x[3:6]
        phi, theta, n, tau = x[6:10]
        surfaces, rates = x[10:13], x[13:16]
        xi, eta, zeta = surfaces[0], (surfaces[2] + surfaces[1]) / 2, (surfaces[2] - surfaces[1]) / 2
        air = velocity - gust[:3]
        turn = omega - gust[3:]
        speed = np.linalg.norm(air)
        alpha = np.arctan2(air[2], air[0])
        beta = np.arcsin(air[1] / speed)
        qbar = self.rho / 2 * speed ** 2
        ph, qh, rh = turn[0] * b / (2 * speed), turn[1] * c / (2 * speed), turn[2] * b / (2 * speed)

        def sym(d):
            return d["zero"] + d["alpha"] * alpha + d["q"] * qh + d["eta"] * eta

        def anti(d):
            return d["beta"] * np.sin(beta) + d["p"] * ph + d["r"] * rh + d["xi"] * xi + d["zeta"] * zeta

        lift = sym(m["lift"])
        drag = m["drag"]["zero"] + m["drag"]["induced"] * lift ** 2
        # drag along the air velocity, lift at right angles in the plane of symmetry
        e_v = np.array([np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)])
        e_l = np.array([np.sin(alpha), 0.0, -np.cos(alpha)])
        force = qbar * s * (-drag * e_v + lift * e_l + np.array([0.0, anti(m["side"]), 0.0]))
        j = air[0] / (n * prop["diameter_m"])
        ct = np.polyval(prop["thrust"][::-1], j)
        cq = np.polyval(prop["torque"][::-1], j)
        thrust = self.rho * n ** 2 * prop["diameter_m"] ** 4 * ct
        load = self.rho * n ** 2 * prop["diameter_m"] ** 5 * cq
        force = force + np.array([thrust, 0.0, 0.0])
        moment = qbar * s * np.array([b * anti(m["roll"]), c * sym(m["pitch"]), b * anti(m["yaw"])])
        moment = moment + np.cross([0.0, 0.0, -prop["offset_m"]], [thrust, 0.0, 0.0])
        weight = G * np.array([-np.sin(theta), np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta)])
        dv = force / m["mass"]["mass_kg"] + weight - np.cross(omega, velocity)
        dw = np.linalg.solve(self.inertia, moment - np.cross(omega, self.inertia @ omega))
        dphi = omega[0] + np.tan(theta) * (omega[1] * np.sin(phi) + omega[2] * np.cos(phi))
        dtheta = omega[1] * np.cos(phi) - omega[2] * np.sin(phi)
        dn = (prop["stall_torque_n_m"] * tau - prop["torque_slope_n_m_s"] * n - load) / (2 * np.pi * prop["inertia_kg_m2"])
        dtau = (self.trim_tau - tau) / prop["esc_time_constant_s"]
        full = m["command"]["full_deflection_rad"]
        demand = np.array([-full * cmd[0], self.trim_eta - full * (cmd[1] - cmd[2]), self.trim_eta - full * (cmd[1] + cmd[2])])
        dd = []
        for i in range(3):
            servo = m["aileron"] if i == 0 else m["ruddervator"]
            w, d = servo["frequency_rad_s"], servo["damping"]
            dd.append(w * w * (demand[i] - surfaces[i]) - 2 * d * w * rates[i])
        return np.concatenate([dv, dw, [dphi, dtheta, dn, dtau], rates, dd])

    def jacobian(self, which):
        size = {"x": 16, "u": 3}[which]
        out = np.zeros((16, size))

        def f(step, j):
            x, u = self.x0.copy(), np.zeros(3)
            (x if which == "x" else u)[j] += step
            return self.rhs(x, u)

        for j in range(size):
            d = [(f(h, j) - f(-h, j)) / (2 * h) for h in (2e-3, 1e-3)]
            out[:, j] = (4 * d[1] - d[0]) / 3
        return out


def gap(ours, theirs):
    return np.abs(np.asarray(ours) - np.asarray(theirs)).max() / np.abs(theirs).max()


def match(poles, wanted):
    """Largest distance of a wanted value to its partner, each used once."""
    cost = np.abs(np.subtract.outer(wanted, poles)) / np.maximum(1e-3, np.abs(wanted))[:, None]
    rows, columns = optimize.linear_sum_assignment(cost)
    return cost[rows, columns].max()


def main():
    fatmc, path = sys.argv[1:3]
    with open(path, "rb") as file:
        model = Model(tomllib.load(file))
    ours = json.loads(subprocess.run([fatmc, "linearize", path, "--format", "json"], check=True, capture_output=True).stdout)
    a, b = model.jacobian("x"), model.jacobian("u")
    c = np.zeros((3, 16))
    c[[0, 1, 2], [3, 4, 5]] = 1
    poles = np.array([complex(*z) for z in ours["poles"]])
    rate = ours["sampled"]["rate_hz"]
    h = 1 / rate
    eye = np.eye(16)
    series = eye + h * a / 2 @ (eye + h * a / 3 @ (eye + h * a / 4))
    phi, gamma = eye + h * a @ series, h * series @ b
    exact = signal.cont2discrete((a, b, c, np.zeros((3, 3))), h)[:2]
    checks = [
        ("A", gap(ours["A"], a), 1e-8),
        ("B", gap(ours["B"], b), 1e-8),
        ("C", gap(ours["C"], c), 0.0),
        ("poles", match(poles, np.linalg.eigvals(a)), 1e-6),
        ("sampled A, Runge-Kutta polynomial", gap(ours["sampled"]["A"], phi), 1e-8),
        ("sampled B, Runge-Kutta polynomial", gap(ours["sampled"]["B"], gamma), 1e-8),
        # Fifth-order truncation of the fastest pole, -56.4 1/s: (1.13)^5/120 = 1.5e-2 of one entry.
        ("sampled A, exact hold", gap(ours["sampled"]["A"], exact[0]), 1.5e-2),
    ]
    # Zeros by polynomial roots of the numerator from scipy, where it is well conditioned: as the zeros of the response.
    for i, y in enumerate(ours["outputs"]):
        for j, u in enumerate(ours["inputs"]):
            for re, im in ours["zeros"][f"{y}/{u}"]:
                s = complex(re, im)
                if abs(s) < 1e-6 or np.abs(np.linalg.eigvals(a) - s).min() < 1e-3:
                    continue
                at = abs(c[i] @ np.linalg.solve(s * eye - a, b[:, j]))
                near = abs(c[i] @ np.linalg.solve(s * 1.1 * eye - a, b[:, j]))
                checks.append((f"zero {s:.4g} of {y}/{u}", at / near, 1e-4))
    failed = 0
    for name, value, bar in checks:
        failed += not value <= bar
        print(f"{'ok  ' if value <= bar else 'FAIL'} {name}: {value:.2e} (bar {bar:g})")
    if len(checks) < 20:
        print("FAIL too few zeros were checked")
        failed += 1
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
