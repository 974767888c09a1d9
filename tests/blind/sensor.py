"""A gyro with its world, and a recording of it. Units: deg/s, seconds, degrees Celsius, g; two-sided densities."""

import copy
import zlib

import numpy as np

from evidence import AXES, Bins, dct, fitted_levels
from world import Motion, Temperature, specific_force

LSB_DPS = 1.0 / 65.5
FULL_SCALE_DPS = 500.0
BLOCK = 100  # samples of the slow grid of a recording at rest
CUT = 3.0  # parameters are drawn normal within the stated uncertainty, and never farther than this


def stream(seed, *path):
    """An independent generator for each use of a case's seed."""
    return np.random.default_rng([seed] + [zlib.crc32(str(part).encode()) for part in path])


def log_uniform(rng, low, high, size=None):
    return np.exp(rng.uniform(np.log(low), np.log(high), size))


def normal(rng, size=None):
    return np.clip(rng.standard_normal(size), -CUT, CUT)


def draw_model(rng, motion):
    N = log_uniform(rng, 0.003, 0.009, 3)
    B = log_uniform(rng, 0.0005, 0.003, 3)
    K = log_uniform(rng, 3e-5, 3e-4, 3)
    # Units whose calibration saw no flicker, or no walk, and which have none.
    lacks = rng.random()
    if lacks < 0.15:
        B[:] = 0.0
    elif lacks < 0.25:
        K[:] = 0.0
    bias = rng.uniform(-1.5, 1.5, 3)
    M = np.eye(3)
    if motion:
        M += rng.normal(0.0, 0.004, (3, 3))
    return {
        "schema": "gyrolog-model/1",
        "rate_hz": 100.0,
        "full_scale_dps": FULL_SCALE_DPS,
        "lsb_dps": LSB_DPS,
        "saturation_dps": 500.26,
        "axes": {a: {"N": N[i], "B": B[i], "K": K[i], "bias": bias[i]} for i, a in enumerate("xyz")},
        "M": M.tolist(),
        "latency_s": 0.0,
        "timestamp_jitter_s": 2.0e-5,
        "convention": "two-sided PSD: N^2, B^2/(2 pi f), (K/(2 pi f))^2",
        "units": {"N": "dps/sqrt(Hz)", "B": "dps", "K": "dps*sqrt(Hz)"},
        "sd_rel": {"N": 0.005, "B": 0.08, "K": 0.20, "timestamp_jitter": 0.05},
        "sd_abs": {"M": 2.0e-4, "latency_s": 1.0e-4, "rate_rel": 5.0e-5},
        "ref_noise_dps": 0.02,
        "acc_noise_g": 0.003,
        "temp_noise_C": 0.03,
    }


class Sensor:
    """The true one: its parameters lie within the model's uncertainty about the model's."""

    def __init__(self, rng, model, motion):
        sd = model["sd_rel"]
        axes = [model["axes"][a] for a in "xyz"]
        self.N, self.B, self.K = (
            np.array([axis[key] for axis in axes]) * (1.0 + sd[key] * normal(rng, 3)) for key in "NBK")
        self.bias = np.array([axis["bias"] for axis in axes]) + rng.normal(0.0, 0.3, 3)
        self.M = np.array(model["M"]) + (model["sd_abs"]["M"] * normal(rng, (3, 3)) if motion else 0.0)
        self.latency_s = model["latency_s"] + model["sd_abs"]["latency_s"] * float(normal(rng))
        self.rate_rel = model["sd_abs"]["rate_rel"] * float(normal(rng))
        self.jitter_s = model["timestamp_jitter_s"] * (1.0 + sd["timestamp_jitter"] * float(normal(rng)))


class Surroundings:
    """What acts on the sensor at the instants t."""

    def __init__(self, context, t, turning=True):
        self.t = t
        self.T = context.temperature(t)
        self.W = self.S = self.f = None
        self.shown = None  # by the axis that is being made, so far
        if context.motion and turning:
            self.W = context.motion(t)
            self.S = context.sensor.M @ self.W  # what turns about the sensing axes, as they lie
            step = t[1] - t[0]
            self.f = specific_force(self.W, step, context.motion.acceleration(t))


class Context:
    """One sensor in one world, without its noise: made again from the seed by whoever scores."""

    def __init__(self, seed, motion, minutes, model=None, temperature=None, fast=None):
        self.seed = seed
        self.rate_hz = 100.0
        self.n = int(round(minutes * 60.0 * self.rate_hz))
        self.duration_s = self.n / self.rate_hz
        self.first_model = draw_model(stream(seed, "model"), motion)
        self.sensor = Sensor(stream(seed, "sensor"), self.first_model, motion)
        self.model = model or self.first_model
        self.temperature = Temperature(stream(seed, "heat"), self.duration_s, "drift" if motion else temperature)
        self.motion = Motion(stream(seed, "motion"), self.duration_s, fast) if motion else None
        self.bins = Bins(self.n, self.rate_hz)
        self.step_dps = LSB_DPS
        self.fresh_share = 1.0  # of the rows, those that show an update
        self.finest_step_dps = 1e-4  # a converter without steps: noise hides all below
        if motion:
            t = np.arange(self.n) / self.rate_hz
        else:
            t = (np.arange(self.n // BLOCK) + 0.5 * (1.0 - 1.0 / BLOCK)) * BLOCK / self.rate_hz
        self.slow = Surroundings(self, t)
        self._nuisance = None
        # What stands beside the sensor's own noise in all that is compared: steps, and the reference's noise.
        self.floor_density = self.step_dps**2 / 12.0 / self.rate_hz
        if motion:
            self.floor_density += self.model["ref_noise_dps"] ** 2 / self.rate_hz

    def stated(self, axis):
        entry = self.model["axes"]["xyz"[axis]]
        return entry["N"], entry["B"], entry["K"]

    def stated_sd(self, axis):
        own = self.model["axes"]["xyz"[axis]].get("sd", {})
        return [own.get(key, self.model["sd_rel"][key]) for key in "NBK"]

    def sigma_dps(self, axis):
        """Of a sample, by all that is white."""
        return np.sqrt(self.sensor.N[axis] ** 2 * self.rate_hz + self.step_dps**2 / 12.0)

    def slope(self):
        """d W / dt on the slow grid of a motion recording, (3, n)."""
        h = 1e-3
        return (self.motion(self.slow.t + h) - self.motion(self.slow.t - h)) / (2.0 * h)

    def unexplained_power(self, axis, series, density, beside=()):
        """(mean square of the coefficients in each bin, cost of the prior): what gains, delay and clock leave, and
        the series `beside` it, each of any size."""
        shape = self.slow.t.shape
        scale = 1.0 if self.motion else np.sqrt(BLOCK)
        d = scale * dct(np.broadcast_to(series, shape))
        X, prior = [scale * dct(np.broadcast_to(one, shape)) for one in beside], [0.0] * len(beside)
        if self.motion:
            d[0] = 0.0
            if self._nuisance is None:
                slope = self.slope()
                self._nuisance = (dct(self.slow.W), dct(slope), dct(slope * self.slow.t))
            W, slope, late = self._nuisance
            X += [*W, slope[axis], late[axis]]
            sd = self.model["sd_abs"]
            # One latency and one clock for the axes, each of which is charged a share.
            alike = np.sqrt(len(AXES))
            prior += [1.0 / s**2 for s in [sd["M"]] * 3 + [alike * sd["latency_s"], alike * sd["rate_rel"]]]
        if not X:
            return self.bins.power(d), 0.0
        X, prior = np.array(X), np.diag(prior)
        weight = np.repeat(1.0 / (density * self.rate_hz), self.bins.count.astype(int))
        XW = X * np.concatenate([[0.0], weight])[: d.size]
        normal_matrix = XW @ X.T + prior
        size = np.sqrt(np.diag(normal_matrix))
        # Of series that are one, or nearly, the least change is taken.
        beta = np.linalg.lstsq(normal_matrix / np.outer(size, size), (XW @ d) / size, rcond=1e-9)[0] / size
        return self.bins.power(d - beta @ X), 0.5 * beta @ prior @ beta


# ------------------------------------------------------------------ noise of n samples


def _circle(n):
    """A power of two of at least twice the record: what is shaped on it does not close within the record."""
    return 1 << int(np.ceil(np.log2(2 * n)))


def shaped(rng, n, rate_hz, density):
    """Gaussian noise of the density(f), f > 0, by shaping the transform of white noise."""
    length = _circle(n)
    f = np.arange(length // 2 + 1) * (rate_hz / length)
    gain = np.zeros(f.size)
    gain[1:] = np.sqrt(density(f[1:]) * rate_hz)
    return np.fft.irfft(gain * np.fft.rfft(rng.standard_normal(length)), length)[:n]


def flicker(rng, n, B):
    return shaped(rng, n, 1.0, lambda nu: B**2 / (2.0 * np.pi * nu))


def walk(rng, n, K, rate_hz):
    steps = rng.standard_normal(n) * (K / np.sqrt(rate_hz))
    steps[0] = 0.0
    return np.cumsum(steps)


def filtered(series, gain_of_f, rate_hz):
    """Series through a filter given in frequency, its end joined to itself mirrored."""
    n = series.size
    both = np.concatenate([series, series[::-1]])
    f = np.fft.rfftfreq(2 * n, 1.0 / rate_hz)
    return np.fft.irfft(np.fft.rfft(both) * gain_of_f(f), 2 * n)[:n]


def through_filters(effects, axis, white, around):
    """White noise from outside: the sensor's filter follows it."""
    for e in effects:
        if e.name == "lowpass" and e.on(axis):
            white = e.whitened(axis, white, around, None)
    return white


# ------------------------------------------------------------------ a recording


def record(context, effects, noise_name="noise"):
    """Columns of a recording: dict of name to array, in the order of the file. effects: Acting."""
    sensor, n, rate = context.sensor, context.n, context.rate_hz
    # A filter comes after all that shapes the white noise.
    effects = sorted(effects, key=lambda e: e.name == "lowpass")
    rng = stream(context.seed, noise_name)
    instants = stamps = believed = np.arange(n) / (rate * (1.0 + sensor.rate_rel))
    for e in effects:
        instants, stamps = e.times(stream(context.seed, noise_name, "t" + e.name), instants, stamps)
    stamps = stamps + rng.normal(0.0, sensor.jitter_s, n)

    ages = [e.age_s(stream(context.seed, noise_name, "r" + e.name)) for e in effects]
    shown = instants - sum(ages)
    around = Surroundings(context, shown, turning=False)
    rates = np.zeros((3, n))
    if context.motion:
        # The reference and the accelerometer are read at the stamped time, the gyro shows an older world.
        seen = shown - sensor.latency_s - sum(e.delay_s() for e in effects)
        around.W = None
        for e in effects:
            if around.W is None:
                around.W = e.world_rate(seen)
        if around.W is None:
            around.W = context.motion(seen)
        at_stamps = stamps_world = believed if any(e.hides_time() for e in effects) else instants
        reference = context.motion(stamps_world)
        force = specific_force(reference, 1.0 / rate, context.motion.acceleration(at_stamps))
        around.f = force
        rates = around.S = sensor.M @ around.W
    out = np.empty((3, n))
    for axis in range(3):
        value = rates[axis] + sensor.bias[axis]
        white = rng.standard_normal(n)
        for e in effects:
            if e.on(axis):
                around.shown = value
                value = value + e.added(axis, around)
        for e in effects:
            if e.on(axis):
                white = e.whitened(axis, white, around, stream(context.seed, noise_name, "w" + e.name, axis))
        value += sensor.N[axis] * np.sqrt(rate) * white
        drift = np.zeros(n)
        if sensor.B[axis] > 0.0:
            drift += flicker(rng, n, sensor.B[axis])
        if sensor.K[axis] > 0.0:
            drift += walk(rng, n, sensor.K[axis], rate)
        for e in effects:
            if e.on(axis):
                drift = e.drifted(axis, drift)
        value += drift
        for e in effects:
            if e.on(axis):
                own = stream(context.seed, noise_name, "n" + e.name, "" if e.shared else axis)
                noise = e.noise(axis, own, around)
                if e.family == "white" and np.ndim(noise):
                    noise = through_filters(effects, axis, noise, around)
                value += noise
        limit = FULL_SCALE_DPS + 17 * LSB_DPS
        step = LSB_DPS
        for e in effects:
            if e.on(axis):
                limit = min(limit, e.limit_dps(axis))
        value = np.clip(value, -limit, limit)
        for e in effects:
            if e.on(axis):
                value = e.converted(axis, value)
        value = step * np.round(value / step)
        for e in effects:
            if e.on(axis):
                value = step * np.round(
                    e.disturbed(axis, value, stream(context.seed, noise_name, "d" + e.name, axis)) / step)
        out[axis] = value
    columns = {"t_s": stamps, "gx_dps": out[0], "gy_dps": out[1], "gz_dps": out[2],
               "temp_C": around.T + rng.normal(0.0, context.model["temp_noise_C"], n)}
    if context.motion:
        for i, a in enumerate("xyz"):
            columns[f"ref_{a}_dps"] = reference[i] + rng.normal(0.0, context.model["ref_noise_dps"], n)
        for i, a in enumerate("xyz"):
            columns[f"a{a}_g"] = force[i] + rng.normal(0.0, context.model["acc_noise_g"], n)
    for e in effects:
        columns = e.rows(columns, stream(context.seed, noise_name, "r" + e.name))
    return columns


def refitted(context, columns):
    """The model as a calibration of this very recording would state it: N, B, K by Whittle's likelihood."""
    model = copy.deepcopy(context.first_model)
    f = context.bins.f
    fixed = np.full_like(f, LSB_DPS**2 / 12.0 / context.rate_hz)
    start = [0.005, 0.0015, 1e-4]
    parts = [start[0] ** 2 * np.ones_like(f), start[1] ** 2 / (2.0 * np.pi * f), (start[2] / (2.0 * np.pi * f)) ** 2]
    for axis, a in enumerate("xyz"):
        series = columns[f"g{a}_dps"][: context.n]
        series = np.pad(series, (0, context.n - series.size), mode="edge")
        power = context.bins.power(dct(series)) / context.rate_hz
        levels, _, information = fitted_levels(power, context.bins.count, parts, fixed, [np.inf, 4.0, 4.0])
        sd = np.sqrt(np.diag(np.linalg.inv(information)))
        entry = model["axes"][a]
        entry["sd"] = {}
        for key, level, uncertainty, first in zip("NBK", levels, sd, start):
            value = first * np.exp(level)
            absent = uncertainty > 1.0 or level < -4.0
            entry[key] = 0.0 if absent else float(value)
            # No calibration of one unit is better than its repetition on another day.
            entry["sd"][key] = float(max(0.005 if key == "N" else 0.02, min(uncertainty, 1.0)))
    return model
