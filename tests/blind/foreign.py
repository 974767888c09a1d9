"""Effects that the catalogue does not make. The right answer to them is "unexplained", with the place, or the effect
of the contract that describes it, where there is one."""

import numpy as np

from effects import Acting, signs
from sensor import LSB_DPS, log_uniform, shaped


class Foreign(Acting):
    classes = ("moderate", "clear")
    free = False  # evidence against free N, B and K: a known term of another size must not explain it
    described_as = None  # the contract's effect that tells it, which the catalogue here does not make


class WanderingLine(Foreign):
    """A line whose frequency wanders by some hertz."""

    name, free = "wandering_line", True
    described_as = "narrowband"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"f_hz": float(rng.uniform(8.0, 42.0)), "spread_hz": float(rng.uniform(0.6, 2.5)),
                "slow_s": float(rng.uniform(20.0, 120.0))}

    @classmethod
    def range(cls, context, shape):
        return 1e-4, 0.2

    @classmethod
    def to_params(cls, shape, strength):
        return {"amplitude_dps": strength, **shape}

    def noise(self, axis, rng, around):
        p, n, rate = self.params, self.context.n, self.context.rate_hz
        slow = shaped(rng, n, rate, lambda f: 2.0 * p["slow_s"] / (1.0 + (2.0 * np.pi * f * p["slow_s"]) ** 2)
                      * np.exp(-((f / 0.5) ** 2)))
        phase = 2.0 * np.pi * np.cumsum(p["f_hz"] + p["spread_hz"] * slow) / rate
        return p["amplitude_dps"] * np.cos(phase + rng.uniform(0.0, 2.0 * np.pi))

    def describe(self, d):
        p = self.params
        for axis in self.acting_axes():
            d.extra[axis].append(lambda f: 0.25 * p["amplitude_dps"] ** 2 / (np.sqrt(2 * np.pi) * p["spread_hz"])
                                 * np.exp(-0.5 * ((f - p["f_hz"]) / p["spread_hz"]) ** 2))

    def where(self):
        p = self.params
        return {"freq_hz": [p["f_hz"] - 2.0 * p["spread_hz"], p["f_hz"] + 2.0 * p["spread_hz"]]}


class Resonance(Foreign):
    """A band of noise, as of a structure that rings."""

    name, free = "resonance", True
    described_as = "narrowband"

    @classmethod
    def shape(cls, rng, context, axes):
        f = float(rng.uniform(10.0, 40.0))
        return {"f_hz": f, "width_hz": f / float(rng.uniform(4.0, 12.0))}

    @classmethod
    def range(cls, context, shape):
        return 1e-4, 0.05

    @classmethod
    def to_params(cls, shape, strength):
        return {"density": strength, **shape}

    def _density(self, f):
        p = self.params
        return p["density"] ** 2 / (1.0 + (2.0 * (f - p["f_hz"]) / p["width_hz"]) ** 2) ** 2

    def noise(self, axis, rng, around):
        return shaped(rng, self.context.n, self.context.rate_hz, self._density)

    def describe(self, d):
        for axis in self.acting_axes():
            d.extra[axis].append(self._density)

    def where(self):
        p = self.params
        return {"freq_hz": [p["f_hz"] - p["width_hz"], p["f_hz"] + p["width_hz"]]}


class SteepNoise(Foreign):
    """Noise of density 1/f^3 in a band: neither a walk nor a drift."""

    name, free = "steep_noise", True

    @classmethod
    def range(cls, context, shape):
        return 1e-6, 0.05

    @classmethod
    def to_params(cls, shape, strength):
        return {"sigma_dps": strength, "f_hz": 0.02}

    def _density(self, f):
        knee = self.params["f_hz"]
        return self.params["sigma_dps"] ** 2 / knee * (f / knee) ** 2 / (1.0 + (f / knee) ** 2) ** 2.5

    def noise(self, axis, rng, around):
        return shaped(rng, self.context.n, self.context.rate_hz, self._density)

    def describe(self, d):
        for axis in self.acting_axes():
            d.extra[axis].append(self._density)

    def where(self):
        return {"freq_hz": [0.005, 0.1], "tau_s": [3.0, 100.0]}


class NoiseBursts(Foreign):
    """Noise that swells every so often, for a few seconds."""

    name = "noise_bursts"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"period_s": float(rng.uniform(60.0, 240.0)), "length_s": float(rng.uniform(5.0, 14.0)),
                "first_s": float(rng.uniform(0.0, 60.0))}

    @classmethod
    def range(cls, context, shape):
        return 0.01, 3.0

    @classmethod
    def to_params(cls, shape, strength):
        return {"gain": strength, **shape}

    def factor(self, t):
        p = self.params
        return 1.0 + p["gain"] * (np.mod(t - p["first_s"], p["period_s"]) < p["length_s"])

    def whitened(self, axis, white, around, rng):
        return white * self.factor(around.t)

    def describe(self, d):
        for axis in self.acting_axes():
            d.scale_level(axis, self.factor(self.context.slow.t) ** 2)

    def where(self):
        return {"time_s": [0.0, self.context.duration_s]}


class BreathingNoise(NoiseBursts):
    """Noise whose level swings with a period of some minutes."""

    name = "breathing_noise"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"period_s": float(log_uniform(rng, 30.0, 400.0)), "phase": float(rng.uniform(0, 2 * np.pi))}

    @classmethod
    def range(cls, context, shape):
        return 0.01, 0.6

    def factor(self, t):
        p = self.params
        return np.exp(p["gain"] * np.sin(2.0 * np.pi * t / p["period_s"] + p["phase"]))


class Sawtooth(Foreign):
    """A thermostat that the thermometer does not see: settlings that begin again and again."""

    name = "sawtooth"

    @classmethod
    def shape(cls, rng, context, axes):
        period = float(rng.uniform(400.0, 1000.0)) * min(1.0, context.duration_s / 5400.0)
        return {"period_s": period, "tau_s": period * float(rng.uniform(0.15, 0.4)),
                "first_s": float(rng.uniform(0.0, period)), "each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 3e-4, 0.3

    @classmethod
    def to_params(cls, shape, strength):
        return {"a_dps": [strength * v for v in shape["each"]], **{k: v for k, v in shape.items() if k != "each"}}

    def added(self, axis, around):
        p = self.params
        since = np.mod(around.t - p["first_s"], p["period_s"])
        return self.of("a_dps", axis) * np.exp(-since / p["tau_s"])

    def where(self):
        p = self.params
        return {"tau_s": [0.1 * p["period_s"], p["period_s"]], "time_s": [0.0, self.context.duration_s],
                "freq_hz": [0.3 / p["period_s"], 10.0 / p["period_s"]]}


class SlowSwing(Foreign):
    """A bias that swings with about 20 min, ever faster and wider."""

    name = "slow_swing"

    @classmethod
    def shape(cls, rng, context, axes):
        period = float(rng.uniform(900.0, 1500.0)) * min(1.0, context.duration_s / 7200.0)
        return {"period_s": period, "phase": float(rng.uniform(0.0, 2.0 * np.pi)),
                "each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 3e-4, 0.3

    @classmethod
    def to_params(cls, shape, strength):
        return {"a_dps": [strength * v for v in shape["each"]], **{k: v for k, v in shape.items() if k != "each"}}

    def added(self, axis, around):
        p, T = self.params, self.context.duration_s
        turns = around.t / p["period_s"] * (0.6 + 0.6 * around.t / T)
        return self.of("a_dps", axis) * (0.3 + 0.7 * around.t / T) * np.sin(2.0 * np.pi * turns + p["phase"])

    def where(self):
        p = self.params
        return {"tau_s": [0.1 * p["period_s"], p["period_s"]], "time_s": [0.0, self.context.duration_s],
                "freq_hz": [0.3 / p["period_s"], 3.0 / p["period_s"]]}


class SkewedNoise(Foreign):
    """White noise of the right level and no excess kurtosis, but askew: a beta density."""

    name = "skewed_noise"

    @classmethod
    def range(cls, context, shape):
        return 0.004, 0.6

    @classmethod
    def to_params(cls, shape, strength):
        return {"skewness": strength}

    def _exponents(self):
        """Exponents of Beta(a, b), a < b, of this skewness whose excess kurtosis is zero, by bisection of each."""

        def moments(a, b):
            s = a + b
            skew = 2.0 * (b - a) * np.sqrt(s + 1.0) / ((s + 2.0) * np.sqrt(a * b))
            kurtosis = 6.0 * ((a - b) ** 2 * (s + 1.0) - a * b * (s + 2.0)) / (a * b * (s + 2.0) * (s + 3.0))
            return skew, kurtosis

        # None where (a - b)^2 (s + 1) = a b (s + 2), s = a + b. With u = a / s that is
        # (1 - 2 u)^2 (s + 1) = u (1 - u) (s + 2).
        def on_curve(s):
            ratio = (s + 2.0) / (s + 1.0)
            u = 0.5 - 0.5 * np.sqrt(ratio / (4.0 + ratio))
            return u * s, (1.0 - u) * s

        low, high = 1.0, 1e9
        for _ in range(200):
            s = np.sqrt(low * high)
            if moments(*on_curve(s))[0] > self.params["skewness"]:
                low = s
            else:
                high = s
        return on_curve(low)

    def whitened(self, axis, white, around, rng):
        a, b = self._exponents()
        x = rng.beta(a, b, white.size)
        return (x - a / (a + b)) / np.sqrt(a * b / ((a + b) ** 2 * (a + b + 1.0)))

    def describe(self, d):
        # The leading term of the divergence from a normal density.
        for axis in self.acting_axes():
            d.other[f"skew_{axis}"] = self.context.n * self.params["skewness"] ** 2 / 12.0

    def where(self):
        return {"amplitude_sigma": [-50.0, 50.0]}


class OtherUnit(Foreign):
    """A stretch of minutes that another unit recorded: its noise and a bias of its own."""

    name = "other_unit"

    @classmethod
    def shape(cls, rng, context, axes):
        length = float(rng.uniform(0.03, 0.12)) * context.duration_s
        return {"from_s": float(rng.uniform(0.1, 0.8)) * context.duration_s, "length_s": length,
                "quieter": bool(rng.random() < 0.4), "each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 0.01, 1.0

    @classmethod
    def to_params(cls, shape, strength):
        return {"strength": strength, **shape}

    def inside(self, t):
        p = self.params
        return ((t >= p["from_s"]) & (t < p["from_s"] + p["length_s"])).astype(float)

    def added(self, axis, around):
        each = self.params["each"][self.axes.index("xyz"[axis])]
        return 0.05 * self.params["strength"] * each * self.inside(around.t)

    def factor(self, t):
        sign = -1.0 if self.params["quieter"] else 1.0
        return np.exp(sign * 0.7 * self.params["strength"] * self.inside(t))

    def whitened(self, axis, white, around, rng):
        return white * self.factor(around.t)

    def describe(self, d):
        super().describe(d)
        for axis in self.acting_axes():
            d.scale_level(axis, self.factor(self.context.slow.t) ** 2)

    def where(self):
        p = self.params
        return {"time_s": [p["from_s"], p["from_s"] + p["length_s"]]}


class StickyCode(Foreign):
    """One code of the converter is never shown, the one above in its place."""

    name = "sticky_code"

    @classmethod
    def range(cls, context, shape):
        return 1e-5, 0.3

    @classmethod
    def to_params(cls, shape, strength):
        return {"share": strength}

    def _code(self, axis):
        """The code above the bias whose expected share is the one asked for, as near as there is one."""
        sigma = self.context.sigma_dps(axis)
        codes = np.arange(0, 60)
        density = np.exp(-0.5 * (codes * LSB_DPS / sigma) ** 2) * LSB_DPS / (sigma * np.sqrt(2.0 * np.pi))
        k = int(np.argmin(np.abs(np.log(density / self.params["share"]))))
        return round(self.context.sensor.bias[axis] / LSB_DPS) + k, density[k]

    def converted(self, axis, value):
        code, _ = self._code(axis)
        codes = np.round(value / LSB_DPS)
        return np.where(codes == code, codes + 1, codes) * LSB_DPS

    def describe(self, d):
        for axis in self.acting_axes():
            # None where c are expected: c nats; and twice as many above, c (2 ln 2 - 1).
            d.other[f"code_{axis}"] = 2.0 * np.log(2.0) * self._code(axis)[1] * self.context.n

    def where(self):
        return {"structure": "code_grid", "amplitude_sigma": [-50.0, 50.0]}


class SpikeComb(Foreign):
    """Every k-th sample is a little higher, as of a task that runs beside."""

    name = "spike_comb"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"every": int(rng.integers(37, 400)), "offset": int(rng.integers(0, 37))}

    @classmethod
    def range(cls, context, shape):
        return 0.002, 0.3

    @classmethod
    def to_params(cls, shape, strength):
        return {"a_dps": strength, **shape}

    def noise(self, axis, rng, around):
        out = np.zeros(self.context.n)
        out[self.params["offset"] :: self.params["every"]] = self.params["a_dps"]
        return out

    def describe(self, d):
        for axis in self.acting_axes():
            count = self.context.n / self.params["every"]
            d.other[f"comb_{axis}"] = 0.5 * count * (self.params["a_dps"] / self.context.sigma_dps(axis)) ** 2

    def where(self):
        return {"freq_hz": [0.0, 50.0], "structure": "isolated_samples"}


class Bumps(Foreign):
    """Something moves the bench: all axes at the same instants, about an axis of any direction, and rings out."""

    name, whole, shared = "bumps", True, True
    described_as = "disturbance"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"count": int(rng.integers(2, 9)), "f_hz": float(rng.uniform(4.0, 20.0)),
                "decay_s": float(rng.uniform(0.1, 0.5))}

    @classmethod
    def range(cls, context, shape):
        return 0.01, 50.0

    @classmethod
    def to_params(cls, shape, strength):
        return {"size_dps": strength, **shape}

    def noise(self, axis, rng, around):
        p, t = self.params, around.t
        starts = np.sort(rng.uniform(0.02, 0.98, p["count"])) * self.context.duration_s
        directions = rng.standard_normal((p["count"], 3))
        directions /= np.sqrt((directions**2).sum(axis=1, keepdims=True))
        sizes = p["size_dps"] * rng.uniform(0.5, 1.5, p["count"])
        out = np.zeros(self.context.n)
        for start, size, direction in zip(starts, sizes, directions):
            since = np.maximum(t - start, 0.0)
            out += size * direction[axis] * np.exp(-since / p["decay_s"]) * np.sin(2.0 * np.pi * p["f_hz"] * since)
        return out

    def describe(self, d):
        """Of a variance of its own for as long as it rings, its course unknown; a bump of the mean size and energy."""
        p = self.params
        samples = p["decay_s"] * self.context.rate_hz  # power e^(-2t/tau): its sum squared over its squares
        for axis in range(3):
            d.other[f"bumps_{axis}"] = p["count"] * self.nats_of(samples, self.mean_energy(axis))

    def mean_energy(self, axis):
        """In a sample's variances: a third of the size's square each axis, and of sin^2 e^(-2t/tau) a fourth of tau."""
        p = self.params
        square = p["size_dps"] ** 2 * (13.0 / 12.0) / 3.0
        return square * 0.25 * p["decay_s"] * self.context.rate_hz / self.context.sigma_dps(axis) ** 2

    @staticmethod
    def nats_of(samples, energy):
        ratio = 1.0 + energy / samples
        return 0.5 * samples * (ratio - 1.0 - np.log(ratio))

    def where(self):
        return {"time_s": [0.0, self.context.duration_s]}


class DelayedStretch(Foreign):
    """One axis is late for a while."""

    name, needs = "delayed_stretch", "motion"

    @classmethod
    def shape(cls, rng, context, axes):
        T = context.duration_s
        return {"from_s": float(rng.uniform(0.2, 0.6)) * T, "length_s": float(rng.uniform(0.1, 0.3)) * T}

    @classmethod
    def range(cls, context, shape):
        return 1e-5, 0.08

    @classmethod
    def to_params(cls, shape, strength):
        return {"delay_s": strength, **shape}

    def added(self, axis, around):
        p = self.params
        late = self.context.motion(around.t - p["delay_s"])[axis] - self.context.motion(around.t)[axis]
        return late * ((around.t >= p["from_s"]) & (around.t < p["from_s"] + p["length_s"]))

    def where(self):
        p = self.params
        return {"time_s": [p["from_s"], p["from_s"] + p["length_s"]]}


class RateNoise(Foreign):
    """Noise that grows with the rate."""

    name, needs = "rate_noise", "motion"

    @classmethod
    def range(cls, context, shape):
        return 1e-5, 0.01

    @classmethod
    def to_params(cls, shape, strength):
        return {"per_dps": strength}

    def noise(self, axis, rng, around):
        return self.params["per_dps"] * around.W[axis] * rng.standard_normal(self.context.n)

    def describe(self, d):
        context = self.context
        for axis in self.acting_axes():
            power = context.floor_density * context.rate_hz + context.sensor.N[axis] ** 2 * context.rate_hz
            d.scale_level(axis, 1.0 + (self.params["per_dps"] * context.slow.W[axis]) ** 2 / power)

    def where(self):
        return {"rate_dps": [0.0, 500.0]}


class OverloadRecovery(Foreign):
    """A bias that a fast turn leaves behind and that fades in some seconds."""

    name, needs, fast = "overload_recovery", "motion", 440.0

    @classmethod
    def shape(cls, rng, context, axes):
        return {"tau_s": float(rng.uniform(6.0, 25.0))}

    @classmethod
    def range(cls, context, shape):
        return 1e-4, 3.0

    @classmethod
    def to_params(cls, shape, strength):
        return {"a_dps": strength, **shape}

    def added(self, axis, around):
        # Of the size of the turn, whatever its direction: the squared rate through a slow filter.
        drive = (around.W[axis] / 500.0) ** 2
        step = around.t[1] - around.t[0]
        length = 8 * int(self.params["tau_s"] / step)
        kernel = np.exp(-np.arange(length) * step / self.params["tau_s"]) * step / self.params["tau_s"]
        size = 1 << int(np.ceil(np.log2(drive.size + length)))
        out = np.fft.irfft(np.fft.rfft(drive, size) * np.fft.rfft(kernel, size), size)[: drive.size]
        return self.params["a_dps"] * out

    def where(self):
        return {"rate_dps": [50.0, 500.0], "tau_s": [2.0, 100.0], "time_s": [0.0, self.context.duration_s]}


class Backlash(Foreign):
    """The answer follows the rate with play: it turns back late."""

    name, needs = "backlash", "motion"

    @classmethod
    def range(cls, context, shape):
        return 0.001, 3.0

    @classmethod
    def to_params(cls, shape, strength):
        return {"play_dps": strength}

    def added(self, axis, around):
        w, half = around.S[axis], 0.5 * self.params["play_dps"]
        out, y = np.empty_like(w), 0.0
        for k, value in enumerate(w.tolist()):
            y = value - half if y < value - half else (value + half if y > value + half else y)
            out[k] = y
        return out - w

    def where(self):
        return {"rate_dps": [0.0, 500.0]}


FOREIGN = {cls.name: cls for cls in (
    WanderingLine, Resonance, SteepNoise, NoiseBursts, BreathingNoise, Sawtooth, SlowSwing, SkewedNoise, OtherUnit,
    StickyCode, SpikeComb, Bumps, DelayedStretch, RateNoise, OverloadRecovery, Backlash)}
