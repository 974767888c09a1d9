"""What happens to a sensor: its temperature, and its turning on a table or in a hand.

All is an expression in time, so that it can be asked at any instant without interpolation.
"""

import numpy as np


def smooth(x):
    """0 below 0, 1 above 1, twice differentiable between."""
    x = np.clip(x, 0.0, 1.0)
    return x * x * x * (x * (6.0 * x - 15.0) + 10.0)


class Temperature:
    """Of the die, degrees Celsius. kinds: steady, drift, sweep."""

    def __init__(self, rng, duration_s, kind=None):
        self.kind = kind or rng.choice(["drift", "sweep", "steady"], p=[0.5, 0.3, 0.2])
        self.start_C = rng.uniform(19.0, 29.0)
        self.duration_s = duration_s
        self.rise_C = 0.0
        if self.kind == "drift":
            self.rise_C = rng.choice([-1.0, 1.0]) * rng.uniform(2.5, 8.0)
            self.bend = rng.uniform(0.3, 3.0)
        elif self.kind == "sweep":
            self.rise_C = rng.choice([-1.0, 1.0], p=[0.3, 0.7]) * rng.uniform(6.0, 14.0)
            self.top = rng.uniform(0.35, 0.65)
            self.back = rng.uniform(0.6, 1.1)
        waves = 4
        self.wave_hz = rng.uniform(0.4, 4.0, waves) / duration_s
        self.wave_C = rng.normal(0.0, 0.06 if self.kind == "steady" else 0.12, waves)
        self.wave_rad = rng.uniform(0.0, 2.0 * np.pi, waves)

    def __call__(self, t):
        share = np.asarray(t) / self.duration_s
        out = np.full(share.shape, self.start_C)
        if self.kind == "drift":
            out += self.rise_C * np.expm1(-self.bend * share) / np.expm1(-self.bend)
        elif self.kind == "sweep":
            up = 0.5 - 0.5 * np.cos(np.pi * np.clip(share / self.top, 0.0, 1.0))
            down = 0.5 - 0.5 * np.cos(np.pi * np.clip((share - self.top) / (1.0 - self.top), 0.0, 1.0))
            out += self.rise_C * (up - self.back * down)
        for f, a, p in zip(self.wave_hz, self.wave_C, self.wave_rad):
            out += a * np.sin(2.0 * np.pi * f * np.asarray(t) + p)
        return out


class Motion:
    """True rates (deg/s, sensor axes) and linear acceleration (g): a row of exercises with short rests between."""

    KINDS = ["plateau", "sweep", "reversal", "wobble", "tilt", "shake"]

    def __init__(self, rng, duration_s, fast=None):
        self.top_dps = fast if fast else rng.choice([180.0, 300.0, 440.0, 485.0])
        self.parts = []
        at = rng.uniform(8.0, 15.0)
        order = []
        while at < duration_s - 40.0:
            if not order:
                order = list(rng.permutation(self.KINDS)) + ["wobble"]
            kind = order.pop()
            length = rng.uniform(25.0, 45.0)
            self.parts.append((at, at + length, kind, self._draw(rng, kind, length)))
            at += length + rng.uniform(2.0, 6.0)

    def _draw(self, rng, kind, length):
        axis = int(rng.integers(3))
        if kind == "plateau":
            levels = rng.uniform(0.15, 1.0, 4) * self.top_dps * np.array([1.0, -1.0, 1.0, -1.0])
            levels[rng.integers(4)] *= self.top_dps / np.abs(levels).max() if rng.random() < 0.5 else 1.0
            levels = np.clip(levels, -self.top_dps, self.top_dps)
            return {"axis": axis, "levels": levels, "side": rng.normal(0.0, 0.02, 3)}
        if kind == "sweep":
            return {"axis": axis, "amplitude": rng.uniform(0.3, 1.0) * self.top_dps, "f0": rng.uniform(0.05, 0.2),
                    "f1": rng.uniform(0.3, 1.2), "side": rng.normal(0.0, 0.03, 3)}
        if kind == "reversal":
            return {"amplitude": rng.uniform(1.0, 12.0, 3), "f": rng.uniform(0.03, 0.12, 3),
                    "phase": rng.uniform(0.0, 2.0 * np.pi, 3)}
        if kind == "wobble":
            f = np.exp(rng.uniform(np.log(0.25), np.log(5.0), (3, 16)))
            a = rng.rayleigh(1.0, (3, 16)) / f**0.5
            rms = rng.uniform(0.05, 0.16) * self.top_dps
            a *= rms / np.sqrt(0.5 * (a**2).sum(axis=1, keepdims=True))
            return {"f": f, "a": a, "p": rng.uniform(0.0, 2.0 * np.pi, (3, 16))}
        if kind == "tilt":
            return {"axis": axis, "degrees": rng.uniform(40.0, 110.0, 2) * rng.choice([-1.0, 1.0])}
        return {"f": rng.uniform(1.0, 6.0, 3), "g": rng.uniform(0.05, 0.35, 3), "p": rng.uniform(0, 2 * np.pi, 3),
                "shiver_dps": rng.uniform(0.2, 2.0, 3)}

    def __call__(self, t):
        """Rates at the instants t, which may be in any order: (3, len(t))."""
        return self._sum(t, self._rate)

    def acceleration(self, t):
        return self._sum(t, self._shake)

    def _sum(self, t, part):
        out = np.zeros((3, len(t)))
        for begin, end, kind, what in self.parts:
            inside = np.flatnonzero((t > begin) & (t < end))
            if inside.size:
                tau = t[inside] - begin
                length = end - begin
                fade = smooth(tau / 1.5) * smooth((length - tau) / 1.5)
                part(out, inside, tau, length, fade, kind, what)
        return out

    @staticmethod
    def _rate(out, at, tau, length, fade, kind, what):
        if kind == "plateau":
            step = length / len(what["levels"])
            value = np.zeros(tau.size)
            for i, level in enumerate(what["levels"]):
                value += level * smooth((tau - i * step) / 1.2) * smooth(((i + 1) * step - tau) / 1.2)
            for axis in range(3):
                out[axis, at] += value * (1.0 if axis == what["axis"] else what["side"][axis])
        elif kind == "sweep":
            phase = 2.0 * np.pi * (what["f0"] * tau + 0.5 * (what["f1"] - what["f0"]) * tau**2 / length)
            for axis in range(3):
                gain = 1.0 if axis == what["axis"] else what["side"][axis]
                out[axis, at] += gain * what["amplitude"] * fade * np.sin(phase)
        elif kind == "reversal":
            for axis in range(3):
                out[axis, at] += what["amplitude"][axis] * fade * np.sin(
                    2.0 * np.pi * what["f"][axis] * tau + what["phase"][axis])
        elif kind == "wobble":
            for axis in range(3):
                for f, a, p in zip(what["f"][axis], what["a"][axis], what["p"][axis]):
                    out[axis, at] += a * fade * np.sin(2.0 * np.pi * f * tau + p)
        elif kind == "tilt":
            # There, a rest, and a part of the way back: the slope of a smooth angle.
            for begin, degrees in ((1.0, what["degrees"][0]), (0.55 * length, -what["degrees"][1])):
                x = np.clip((tau - begin) / 5.0, 0.0, 1.0)
                out[what["axis"], at] += degrees / 5.0 * 30.0 * x**2 * (1.0 - x) ** 2
        elif kind == "shake":
            for axis in range(3):
                out[axis, at] += what["shiver_dps"][axis] * fade * np.sin(
                    2.0 * np.pi * 1.3 * what["f"][axis] * tau + what["p"][axis] + 1.0)

    @staticmethod
    def _shake(out, at, tau, length, fade, kind, what):
        if kind == "shake":
            for axis in range(3):
                out[axis, at] += what["g"][axis] * fade * np.sin(
                    2.0 * np.pi * what["f"][axis] * tau + what["p"][axis])


def _product(a, b):
    return np.array([
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ])


def specific_force(rates_dps, step_s, acceleration_g):
    """Gravity in the sensor's axes while it turns, upright at first, and what shakes it: (3, n), g."""
    angle = np.radians(rates_dps) * step_s
    size = np.sqrt((angle**2).sum(axis=0))
    half = np.where(size > 0.0, np.sin(size / 2.0) / np.maximum(size, 1e-300), 0.5)
    q = np.vstack([np.cos(size / 2.0), half * angle])
    reach = 1
    # Products of ever longer runs: after each pass q[k] is the product of the last 2 * reach turns up to k.
    while reach < q.shape[1]:
        later = _product(q[:, :-reach], q[:, reach:])
        q[:, reach:] = later
        reach *= 2
    q /= np.sqrt((q**2).sum(axis=0))
    w, x, y, z = q
    return np.array([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)]) + acceleration_g
