"""The effects of the catalogue, each by its definition, with params named as the models name them.

An effect has a shape, drawn once, and a strength; params(shape, strength) is what the truth records. `describe`
says what it does to the likelihood, the other members what it does to the samples.
"""

import numpy as np

from evidence import AXES, folded_lowpass
from sensor import LSB_DPS, filtered, flicker, log_uniform, shaped, walk

REFERENCE_C = 25.0


class Acting:
    """One effect with its params, on its axes. The methods that an effect does not have do nothing."""

    name = ""
    needs = "still"  # still, motion, both
    family = ""
    whole = False  # the sensor as a whole: axes are always all
    shared = False  # one realisation for all axes
    temperature = None  # kind of temperature it needs
    fast = None  # largest rate it needs
    classes = ("marginal", "moderate", "clear")
    least_axes = 1
    apart_from = ()  # effects and families beside which its evidence is not known

    def __init__(self, context, params, axes):
        self.context = context
        self.params = params
        self.axes = list(axes)

    @classmethod
    def shape(cls, rng, context, axes):
        return {}

    @classmethod
    def range(cls, context, shape):
        raise NotImplementedError(cls.name)

    @classmethod
    def to_params(cls, shape, strength):
        raise NotImplementedError(cls.name)

    def on(self, axis):
        return AXES[axis] in self.axes

    def of(self, name, axis, otherwise=None):
        value = self.params.get(name, otherwise)
        if isinstance(value, dict):
            return float(value.get(AXES[axis], otherwise or 0.0))
        if isinstance(value, (list, tuple)):
            return float(value[self.axes.index(AXES[axis])])
        if value is None:
            raise KeyError(f"no {name}")
        return float(value)

    def acting_axes(self):
        return [axis for axis in range(3) if self.on(axis)]

    def only_on(self, axes):
        """The same effect on some of its axes."""
        params = dict(self.params)
        for name, value in params.items():
            if isinstance(value, list) and len(value) == len(self.axes):
                params[name] = [value[self.axes.index(a)] for a in axes]
        return type(self)(self.context, params, axes)

    def drowns_others(self):
        """Whether other effects of the recording mean nothing until this one is known to the sample."""
        return self.hides_time()

    # What the model file lacks for the effect to be one.
    def prepare(self, model):
        pass

    # What it does to samples.
    def times(self, rng, instants, stamps):
        return instants, stamps

    def hides_time(self):
        return False

    def delay_s(self):
        return 0.0

    def age_s(self, rng):
        """Of what each sample shows, beyond the delay; `rng` as for rows()."""
        return 0.0

    def world_rate(self, instants):
        return None

    def added(self, axis, around):
        return 0.0

    def whitened(self, axis, white, around, rng):
        return white

    def drifted(self, axis, drift):
        return drift

    def noise(self, axis, rng, around):
        return 0.0

    def limit_dps(self, axis):
        return np.inf

    def converted(self, axis, value):
        return value

    def disturbed(self, axis, value, rng):
        return value

    def rows(self, columns, rng):
        return columns

    # What it does to the likelihood: by default all that `added` adds.
    def describe(self, d):
        for axis in self.acting_axes():
            shift = self.added(axis, self.context.slow)
            if not np.isscalar(shift):
                d.add_mean(axis, shift)

    def where(self):
        return {}


def signs(rng, count):
    return rng.choice([-1.0, 1.0], count) * rng.uniform(0.5, 1.0, count)


# ------------------------------------------------------------------ noise


class ArwScale(Acting):
    name, family = "arw_scale", "white"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"up": bool(rng.random() < 0.6)}

    @classmethod
    def range(cls, context, shape):
        return 0.003, np.log(2.0)

    @classmethod
    def to_params(cls, shape, strength):
        return {"factor": float(np.exp(strength if shape["up"] else -strength))}

    def whitened(self, axis, white, around, rng):
        return white * self.of("factor", axis)

    def describe(self, d):
        for axis in self.acting_axes():
            d.white[axis] *= self.of("factor", axis) ** 2

    def where(self):
        return {"tau_s": [0.01, 2.0], "freq_hz": [5.0, 50.0]}


class NoiseColour(Acting):
    """One zero and one pole on the white noise, whose slow part stays as it is."""

    name, family = "noise_colour", "white"
    # Neighbours share what is one sample's: tails are fewer, and a level is known less well, than those two count.
    apart_from = ("tails", "level")

    @classmethod
    def shape(cls, rng, context, axes):
        return {"up": bool(rng.random() < 0.5), "middle_of_rate": float(rng.uniform(0.08, 0.4))}

    @classmethod
    def range(cls, context, shape):
        return 0.003, np.log(6.0)

    @classmethod
    def to_params(cls, shape, strength):
        return {"gain": float(np.exp(strength if shape["up"] else -strength)),
                "middle_of_rate": shape["middle_of_rate"]}

    def _power(self, f, axis):
        """|g (1 - zero / u) / (1 - pole / u)|^2 on the unit circle, 1 at zero and gain^2 at half the rate."""
        root = np.sqrt(self.of("gain", axis))
        x = np.tan(np.pi * self.of("middle_of_rate", axis))
        zero, pole = (root - x) / (root + x), (1.0 - root * x) / (1.0 + root * x)
        back = np.exp(-2j * np.pi * f / self.context.rate_hz)
        return np.abs((1.0 - pole) / (1.0 - zero) * (1.0 - zero * back) / (1.0 - pole * back)) ** 2

    def whitened(self, axis, white, around, rng):
        return filtered(white, lambda f: np.sqrt(self._power(f, axis)), self.context.rate_hz)

    def describe(self, d):
        for axis in self.acting_axes():
            d.colour[axis].append(lambda f, axis=axis: self._power(f, axis))

    def where(self):
        middle_hz = self.params["middle_of_rate"] * self.context.rate_hz
        return {"freq_hz": [0.5 * middle_hz, 0.5 * self.context.rate_hz], "tau_s": [0.005, 1.0 / middle_hz]}


class FlickerMissing(Acting):
    name, family = "flicker_missing", "slow"

    @classmethod
    def range(cls, context, shape):
        return 0.0003, 0.006

    @classmethod
    def to_params(cls, shape, strength):
        return {"B_dps": strength}

    def noise(self, axis, rng, around):
        return flicker(rng, self.context.n, self.of("B_dps", axis))

    def describe(self, d):
        for axis in self.acting_axes():
            B = self.of("B_dps", axis)
            d.extra[axis].append(lambda f, B=B: B**2 / (2.0 * np.pi * f))

    def where(self):
        # From where it stands above white noise of a typical unit to the record's end.
        return {"tau_s": [1.0, 0.3 * self.context.duration_s], "freq_hz": [2.0 / self.context.duration_s, 1.0]}


class RrwMissing(Acting):
    name, family = "rrw_missing", "slow"

    @classmethod
    def range(cls, context, shape):
        return 2e-5, 2e-3

    @classmethod
    def to_params(cls, shape, strength):
        return {"K_dps_sqrt_hz": strength}

    def noise(self, axis, rng, around):
        return walk(rng, self.context.n, self.of("K_dps_sqrt_hz", axis), self.context.rate_hz)

    def describe(self, d):
        for axis in self.acting_axes():
            K = self.of("K_dps_sqrt_hz", axis)
            d.extra[axis].append(lambda f, K=K: (K / (2.0 * np.pi * f)) ** 2)

    def where(self):
        return {"tau_s": [10.0, 0.5 * self.context.duration_s], "freq_hz": [0.5 / self.context.duration_s, 0.2]}


class GaussMarkov(Acting):
    name, family = "gauss_markov", "slow"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"tau_s": float(log_uniform(rng, 0.3, min(200.0, context.duration_s / 25.0)))}

    @classmethod
    def range(cls, context, shape):
        return 0.0004, 0.05

    @classmethod
    def to_params(cls, shape, strength):
        return {"sigma_dps": strength, "tau_s": shape["tau_s"]}

    def noise(self, axis, rng, around):
        """By summing shaped noise: the density of the sampled process, aliases included."""
        sigma, tau = self.of("sigma_dps", axis), self.of("tau_s", axis)
        return shaped(rng, self.context.n, self.context.rate_hz, lambda f: self._density(f, sigma, tau))

    def _density(self, f, sigma, tau):
        rate = self.context.rate_hz
        a = np.exp(-1.0 / (rate * tau))
        return sigma**2 / rate * (1.0 - a * a) / (1.0 - 2.0 * a * np.cos(2.0 * np.pi * f / rate) + a * a)

    def describe(self, d):
        for axis in self.acting_axes():
            sigma, tau = self.of("sigma_dps", axis), self.of("tau_s", axis)
            d.extra[axis].append(lambda f, s=sigma, tau=tau: self._density(f, s, tau))

    def where(self):
        tau = float(np.ravel(self.params["tau_s"])[0])
        return {"tau_s": [0.5 * tau, 4.0 * tau], "freq_hz": [0.03 / tau, 0.6 / tau]}


class Rtn(Acting):
    name, family = "rtn", "slow"

    @classmethod
    def shape(cls, rng, context, axes):
        dwell = float(log_uniform(rng, 1.0, min(200.0, context.duration_s / 20.0)))
        return {"dwell_high_s": dwell, "dwell_low_s": float(dwell * log_uniform(rng, 0.5, 2.0))}

    @classmethod
    def range(cls, context, shape):
        return 0.0008, 0.1

    @classmethod
    def to_params(cls, shape, strength):
        return {"amplitude_dps": strength, **shape}

    def noise(self, axis, rng, around):
        """Dwell after dwell, begun some dwells before the record."""
        high, low = self.of("dwell_high_s", axis), self.of("dwell_low_s", axis)
        pairs = int(self.context.duration_s / (high + low) * 2.0) + 60
        dwells = np.empty(2 * pairs)
        dwells[0::2] = rng.exponential(high, pairs)
        dwells[1::2] = rng.exponential(low, pairs)
        begin = rng.uniform(5.0, 10.0) * (high + low)
        switches = np.cumsum(dwells) - begin
        state = np.searchsorted(switches, around.t)
        return self.of("amplitude_dps", axis) * ((state % 2 == 0) - high / (high + low))

    def describe(self, d):
        for axis in self.acting_axes():
            A, high, low = (self.of(k, axis) for k in ("amplitude_dps", "dwell_high_s", "dwell_low_s"))
            variance = A**2 * high * low / (high + low) ** 2
            tau = 1.0 / (1.0 / high + 1.0 / low)
            d.extra[axis].append(lambda f, v=variance, tau=tau: 2.0 * v * tau / (1.0 + (2.0 * np.pi * f * tau) ** 2))

    def where(self):
        p = self.params
        tau = 1.0 / (1.0 / p["dwell_high_s"] + 1.0 / p["dwell_low_s"])
        return {"tau_s": [0.5 * tau, 4.0 * tau], "freq_hz": [0.03 / tau, 0.6 / tau], "amplitude_sigma": [0.0, 1e9],
                "time_s": [0.0, self.context.duration_s]}


class Lowpass(Acting):
    name, family, needs = "lowpass", "white", "both"
    classes = ("clear",)
    # Filtered samples are nearly normal, and fewer of them are independent, than those two count.
    apart_from = ("tails", "level")

    @classmethod
    def shape(cls, rng, context, axes):
        return {"fc_hz": float(log_uniform(rng, 5.0, 42.0)), "order": int(rng.integers(1, 3))}

    @classmethod
    def range(cls, context, shape):
        return 1.0, 1.0

    @classmethod
    def to_params(cls, shape, strength):
        return dict(shape)

    def _response(self, f, axis):
        s = 1j * f / self.of("fc_hz", axis)
        return 1.0 / (1.0 + s) if self.of("order", axis, 1) == 1 else 1.0 / (1.0 + np.sqrt(2.0) * s + s * s)

    def whitened(self, axis, white, around, rng):
        rate, length = self.context.rate_hz, white.size
        f = np.fft.rfftfreq(length, 1.0 / rate)
        grid = np.linspace(0.0, rate / 2.0, 2049)
        power = folded_lowpass(grid, self.of("fc_hz", axis), self.of("order", axis, 1), rate)
        gain = np.interp(f, grid, np.sqrt(power))
        return np.fft.irfft(np.fft.rfft(white) * gain, length)

    def drifted(self, axis, drift):
        return filtered(drift, lambda f: self._response(f, axis), self.context.rate_hz)

    def added(self, axis, around):
        """What the filter takes off the motion, which has nothing near half the rate, as the other effects left it."""
        if around.W is None:
            return 0.0
        shown = around.S[axis] if around.shown is None else around.shown
        return filtered(shown, lambda f: self._response(f, axis), self.context.rate_hz) - shown

    def describe(self, d):
        for axis in self.acting_axes():
            d.filter[axis] = (self.of("fc_hz", axis), self.of("order", axis, 1))
        super().describe(d)

    def where(self):
        fc = self.params["fc_hz"]
        return {"freq_hz": [min(0.4 * fc, 25.0), 50.0], "tau_s": [0.005, 3.0 / fc]}


class Tone(Acting):
    name, family = "tone", "line"
    apart_from = ("clock_rate",)  # another rate folds the line to another place than `where` says

    @classmethod
    def shape(cls, rng, context, axes):
        kind = rng.random()
        rate = context.rate_hz
        if kind < 0.35:  # mains and its harmonics, not on the sampler's own lines
            f = rng.choice([50.0, 60.0]) * rng.choice([1.0, 1.0, 2.0, 3.0]) * (1.0 + rng.normal(0.0, 4e-4))
        else:
            f = log_uniform(rng, 3.0, 200.0)
        folded = abs(f - rate * np.round(f / rate))
        if folded < 0.4 or folded > 0.5 * rate - 0.4:
            return cls.shape(rng, context, axes)
        return {"f_hz": float(f), "phase_rad": [float(p) for p in rng.uniform(0.0, 2.0 * np.pi, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 1e-4, 0.1

    @classmethod
    def to_params(cls, shape, strength):
        return {"f_hz": shape["f_hz"], "amplitude_dps": strength, "phase_rad": shape["phase_rad"]}

    def alias_hz(self, axis=None):
        f = float(np.ravel(self.params["f_hz"])[0])
        # The unit's own rate, at which it updates.
        rate = self.context.rate_hz * (1.0 + self.context.sensor.rate_rel) * self.context.fresh_share
        return abs(f - rate * np.round(f / rate))

    def noise(self, axis, rng, around):
        f, A, p = (self.of(k, axis) for k in ("f_hz", "amplitude_dps", "phase_rad"))
        return A * np.cos(2.0 * np.pi * f * around.t + p)

    def describe(self, d):
        for axis in self.acting_axes():
            d.lines[axis].append((self.alias_hz(), self.of("amplitude_dps", axis)))

    def where(self):
        f = self.alias_hz()
        return {"freq_hz": [f - 0.02, f + 0.02]}


class HeavyTail(Acting):
    name, family = "heavy_tail", "tails"

    @classmethod
    def range(cls, context, shape):
        return 1.0 / 150.0, 1.0 / 3.5

    @classmethod
    def to_params(cls, shape, strength):
        return {"nu": 1.0 / strength}

    def whitened(self, axis, white, around, rng):
        nu = self.of("nu", axis)
        # A normal deviate over the root of an independent chi-square: the draw that is there is the normal one.
        return white / np.sqrt(rng.chisquare(nu, white.size) / (nu - 2.0))

    def describe(self, d):
        for axis in self.acting_axes():
            d.nu[axis] = self.of("nu", axis)

    def where(self):
        return {"amplitude_sigma": [2.5, 50.0], "structure": "isolated_samples"}


class Spikes(Acting):
    name, family = "spikes", "tails"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"per_hour": float(log_uniform(rng, 1.5, 25.0)),
                "sigma_dps": float(context.sigma_dps(AXES.index(axes[0])))}

    @classmethod
    def range(cls, context, shape):
        return 5.0, 40.0

    @classmethod
    def to_params(cls, shape, strength):
        return {"per_hour": shape["per_hour"], "smallest_dps": 0.8 * strength * shape["sigma_dps"],
                "largest_dps": 1.25 * strength * shape["sigma_dps"]}

    def disturbed(self, axis, value, rng):
        value = value.copy()
        # The number that is expected, and not one that chance may make none.
        count = max(1, int(round(self.of("per_hour", axis) * self.context.duration_s / 3600.0)))
        at = rng.choice(np.arange(5, value.size - 5, 3), count, replace=False)
        value[at] += rng.choice([-1.0, 1.0], count) * rng.uniform(
            self.of("smallest_dps", axis), self.of("largest_dps", axis), count)
        return value

    def describe(self, d):
        for axis in self.acting_axes():
            d.spikes[axis].append(tuple(self.of(k, axis) for k in ("per_hour", "smallest_dps", "largest_dps")))

    def where(self):
        return {"structure": "isolated_samples", "amplitude_sigma": [4.0, 60.0]}


class VarianceChange(Acting):
    name, family = "variance_change", "level"

    @classmethod
    def shape(cls, rng, context, axes):
        T = context.duration_s
        step = rng.random() < 0.6
        at = rng.uniform(0.15, 0.75) * T if step else rng.uniform(0.0, 0.3) * T
        return {"at_s": float(at), "ramp_s": 0.0 if step else float(rng.uniform(0.3, 0.65) * T),
                "up": bool(rng.random() < 0.6)}

    @classmethod
    def range(cls, context, shape):
        return 0.002, np.log(2.0)

    @classmethod
    def to_params(cls, shape, strength):
        return {"factor": float(np.exp(strength if shape["up"] else -strength)), "at_s": shape["at_s"],
                "ramp_s": shape["ramp_s"]}

    def factor(self, axis, t):
        at, ramp = self.of("at_s", axis), self.of("ramp_s", axis, 0.0)
        share = np.clip((t - at) / ramp, 0.0, 1.0) if ramp > 0.0 else (t >= at).astype(float)
        return 1.0 + (self.of("factor", axis) - 1.0) * share

    def whitened(self, axis, white, around, rng):
        return white * self.factor(axis, around.t)

    def describe(self, d):
        for axis in self.acting_axes():
            d.scale_level(axis, self.factor(axis, self.context.slow.t) ** 2)

    def where(self):
        at, ramp = self.params["at_s"], self.params["ramp_s"]
        return {"time_s": [at, at + ramp if ramp > 0.0 else self.context.duration_s]}


class TempNoise(Acting):
    name, family, temperature = "temp_noise", "level", "sweep"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"sign": float(rng.choice([-1.0, 1.0], p=[0.25, 0.75]))}

    @classmethod
    def range(cls, context, shape):
        return 2e-4, 0.02

    @classmethod
    def to_params(cls, shape, strength):
        return {"per_C": shape["sign"] * strength, "reference_C": REFERENCE_C}

    def factor(self, axis, T):
        return np.maximum(0.05, 1.0 + self.of("per_C", axis) * (T - self.of("reference_C", axis, REFERENCE_C)))

    def whitened(self, axis, white, around, rng):
        return white * self.factor(axis, around.T)

    def describe(self, d):
        for axis in self.acting_axes():
            d.scale_level(axis, self.factor(axis, self.context.slow.T) ** 2)

    def where(self):
        return {"temperature": True}


class CommonMode(Acting):
    name, family, shared = "common_mode", "white", True
    least_axes = 2

    @classmethod
    def shape(cls, rng, context, axes):
        return {"gain_" + a: float(rng.uniform(0.5, 1.0)) for a in axes}

    @classmethod
    def range(cls, context, shape):
        return 1e-4, 0.006

    @classmethod
    def to_params(cls, shape, strength):
        return {"N_dps_per_sqrt_hz": strength, **shape}

    def gain(self, axis):
        return float(self.params.get("gain_" + AXES[axis], 1.0)) if self.on(axis) else 0.0

    def noise(self, axis, rng, around):
        density = float(np.ravel(self.params["N_dps_per_sqrt_hz"])[0])
        return self.gain(axis) * density * np.sqrt(self.context.rate_hz) * rng.standard_normal(self.context.n)

    def describe(self, d):
        density = float(np.ravel(self.params["N_dps_per_sqrt_hz"])[0])
        d.common.append((density**2, np.array([self.gain(axis) for axis in range(3)])))

    def where(self):
        return {"structure": "cross_axis"}


# ------------------------------------------------------------------ slow bias


class Narrowband(Acting):
    """A damped oscillator in white noise, sampled; narrow against its frequency, wide against the bins."""

    name, family = "narrowband", "line"
    apart_from = ("clock_rate",)

    @classmethod
    def shape(cls, rng, context, axes):
        rate = context.rate_hz
        f = float(log_uniform(rng, 4.0, 0.45 * rate))
        width = f * float(log_uniform(rng, 0.06, 0.4))
        return {"f_hz": f if rng.random() < 0.7 else rate - f, "width_hz": width}

    @classmethod
    def range(cls, context, shape):
        return 0.0004, 0.5

    @classmethod
    def to_params(cls, shape, strength):
        return {"sigma_dps": strength, **shape}

    def _density(self, f, sigma):
        rate, p = self.context.rate_hz, self.params
        kept = np.exp(-np.pi * p["width_hz"] / rate)
        total = 0.0
        for f_line in (p["f_hz"], -p["f_hz"]):
            total = total + (1.0 - kept**2) / np.abs(1.0 - kept * np.exp(2j * np.pi * (f - f_line) / rate)) ** 2
        return 0.5 * sigma**2 / rate * total

    def noise(self, axis, rng, around):
        sigma = self.of("sigma_dps", axis)
        return shaped(rng, self.context.n, self.context.rate_hz, lambda f: self._density(f, sigma))

    def describe(self, d):
        for axis in self.acting_axes():
            sigma = self.of("sigma_dps", axis)
            d.extra[axis].append(lambda f, sigma=sigma: self._density(f, sigma))

    def where(self):
        rate, p = self.context.rate_hz, self.params
        seen = abs(p["f_hz"] - rate * round(p["f_hz"] / rate))
        return {"freq_hz": [seen - p["width_hz"], seen + p["width_hz"]]}


class RateRamp(Acting):
    name, family = "rate_ramp", "drift"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 1e-6, 2e-4

    @classmethod
    def to_params(cls, shape, strength):
        return {"ramp_dps_per_s": [strength * v for v in shape["each"]]}

    def added(self, axis, around):
        return self.of("ramp_dps_per_s", axis) * around.t

    def where(self):
        T = self.context.duration_s
        return {"tau_s": [0.05 * T, 0.5 * T], "time_s": [0.0, T], "freq_hz": [0.0, 20.0 / T]}


class Warmup(Acting):
    name, family = "warmup", "drift"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"tau_s": float(log_uniform(rng, 60.0, np.clip(context.duration_s / 4.0, 90.0, 900.0))),
                "each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 0.002, 3.0

    @classmethod
    def to_params(cls, shape, strength):
        return {"a_dps": [strength * v for v in shape["each"]], "tau_s": shape["tau_s"]}

    def added(self, axis, around):
        return self.of("a_dps", axis) * np.exp(-around.t / self.of("tau_s", axis))

    def where(self):
        tau = self.params["tau_s"]
        return {"time_s": [0.0, 3.0 * tau], "tau_s": [0.3 * tau, 4.0 * tau]}


class BiasStep(Acting):
    name, family = "bias_step", "drift"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"at_s": float(rng.uniform(0.1, 0.9) * context.duration_s),
                "each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 0.0005, 0.5

    @classmethod
    def to_params(cls, shape, strength):
        return {"step_dps": [strength * v for v in shape["each"]], "at_s": shape["at_s"]}

    def added(self, axis, around):
        return self.of("step_dps", axis) * (around.t >= self.of("at_s", axis))

    def where(self):
        return {"time_s": [self.params["at_s"]] * 2}


class TempLinear(Acting):
    name, family = "temp_linear", "temperature"
    temperature = "either"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 3e-4, 0.3

    @classmethod
    def to_params(cls, shape, strength):
        return {"c1_dps_per_C": [strength * v for v in shape["each"]], "reference_C": REFERENCE_C}

    def added(self, axis, around):
        return self.of("c1_dps_per_C", axis) * (around.T - self.of("reference_C", axis, REFERENCE_C))

    def where(self):
        return {"temperature": True}


class TempQuadratic(Acting):
    name, family, temperature = "temp_quadratic", "temperature", "sweep"

    @classmethod
    def shape(cls, rng, context, axes):
        # The parabola's vertex lies within the sweep, or the curve would be nearly a line.
        T = context.slow.T
        vertex = T.min() + rng.uniform(0.3, 0.7) * np.ptp(T)
        return {"sign": float(rng.choice([-1.0, 1.0])), "vertex_C": float(vertex)}

    @classmethod
    def range(cls, context, shape):
        return 2e-5, 0.02

    @classmethod
    def to_params(cls, shape, strength):
        c2 = shape["sign"] * strength
        return {"c1_dps_per_C": -2.0 * c2 * (shape["vertex_C"] - REFERENCE_C), "c2_dps_per_C2": c2,
                "reference_C": REFERENCE_C}

    def added(self, axis, around):
        T = around.T - self.of("reference_C", axis, REFERENCE_C)
        return self.of("c1_dps_per_C", axis, 0.0) * T + self.of("c2_dps_per_C2", axis, 0.0) * T**2

    def where(self):
        return {"temperature": True}


class TempCubic(Acting):
    name, family, temperature = "temp_cubic", "temperature", "sweep"

    @classmethod
    def shape(cls, rng, context, axes):
        # Up and down again within the sweep: between its turns it is neither a line nor a parabola.
        T = context.slow.T
        span = np.ptp(T)
        return {"sign": float(rng.choice([-1.0, 1.0])), "middle_C": float(T.min() + rng.uniform(0.4, 0.6) * span),
                "turn_C": float(rng.uniform(0.25, 0.35) * span)}

    @classmethod
    def range(cls, context, shape):
        return 1e-6, 1e-3

    @classmethod
    def to_params(cls, shape, strength):
        """sign strength ((T - middle)^3 - 3 turn^2 (T - middle)) about the reference, but for its constant."""
        c3, m = shape["sign"] * strength, shape["middle_C"] - REFERENCE_C
        return {"c1_dps_per_C": 3.0 * c3 * (m**2 - shape["turn_C"] ** 2), "c2_dps_per_C2": -3.0 * c3 * m,
                "c3_dps_per_C3": c3, "reference_C": REFERENCE_C}

    def added(self, axis, around):
        T = around.T - self.of("reference_C", axis, REFERENCE_C)
        return sum(self.of(name, axis, 0.0) * T**n for n, name in
                   enumerate(("c1_dps_per_C", "c2_dps_per_C2", "c3_dps_per_C3"), 1))

    def where(self):
        return {"temperature": True}


class TempLag(Acting):
    name, family, temperature = "temp_lag", "temperature", "sweep"

    @classmethod
    def shape(cls, rng, context, axes):
        sign = float(rng.choice([-1.0, 1.0]))
        if rng.random() < 0.7:
            longest = np.clip(context.duration_s / 7.0, 150.0, 900.0)
            return {"sign": sign, "tau_s": float(log_uniform(rng, 120.0, longest))}
        return {"sign": sign, "play_C": float(rng.uniform(0.15, 0.4) * np.ptp(context.slow.T))}

    @classmethod
    def range(cls, context, shape):
        return 3e-4, 0.3

    @classmethod
    def to_params(cls, shape, strength):
        out = {k: v for k, v in shape.items() if k != "sign"}
        return {"c1_dps_per_C": shape["sign"] * strength, "reference_C": REFERENCE_C, **out}

    def follower(self, axis):
        """The lagging temperature on a grid of a second: trapezoidal steps of tau y' = T - y, then the play."""
        t = np.arange(0.0, self.context.duration_s + 2.0)
        T = self.context.temperature(t)
        tau, play = self.of("tau_s", axis, 0.0), self.of("play_C", axis, 0.0)
        u = T.copy()
        if tau > 0.0:
            a = (2.0 * tau - 1.0) / (2.0 * tau + 1.0)
            b = 1.0 / (2.0 * tau + 1.0)
            for k in range(1, u.size):
                u[k] = a * u[k - 1] + b * (T[k] + T[k - 1])
        if play > 0.0:
            y = u.copy()
            for k in range(1, y.size):
                y[k] = min(max(y[k - 1], u[k] - 0.5 * play), u[k] + 0.5 * play)
            u = y
        return t, u

    def added(self, axis, around):
        t, u = self.follower(axis)
        return self.of("c1_dps_per_C", axis) * (np.interp(around.t, t, u) - self.of("reference_C", axis, REFERENCE_C))

    def where(self):
        return {"temperature": True}


# ------------------------------------------------------------------ sampler and converter


class Quantization(Acting):
    name, family, classes = "quantization", "structure", ("clear",)

    @classmethod
    def shape(cls, rng, context, axes):
        # Codes as coarse, or the sensor's own where the model has none.
        return {"codes": 1 if len(axes) == 3 and rng.random() < 0.4 else int(rng.choice([2, 3, 4, 6, 8]))}

    @classmethod
    def range(cls, context, shape):
        return 1.0, 1.0

    @classmethod
    def to_params(cls, shape, strength):
        return {"lsb_dps": shape["codes"] * LSB_DPS}

    def prepare(self, model):
        if np.ravel(self.params["lsb_dps"])[0] < 1.5 * LSB_DPS:
            model["lsb_dps"] = 0.0

    def drowns_others(self):
        """A step above the white noise's deviation hides the noise's density and all that is smaller."""
        return any(self.of("lsb_dps", axis) > self.context.sigma_dps(axis) for axis in self.acting_axes())

    def converted(self, axis, value):
        step = self.of("lsb_dps", axis)
        return step * np.floor(value / step + 0.5)

    def describe(self, d):
        for axis in self.acting_axes():
            d.structure["grid_" + AXES[axis]] = self.of("lsb_dps", axis)

    def where(self):
        return {"structure": "code_grid"}


class Stale(Acting):
    """Samples that repeat: in a beat, or at random, in runs of a mean number."""

    name, family, whole, classes = "stale", "structure", True, ("clear",)
    RUN_MOST = 3.0

    @classmethod
    def shape(cls, rng, context, axes):
        return {"run_length": float(rng.uniform(1.0, cls.RUN_MOST)) if rng.random() < 0.5 else 0.0}

    @classmethod
    def range(cls, context, shape):
        return max(1e-4, 4.0 / context.n), 0.45

    @classmethod
    def to_params(cls, shape, strength):
        return {"eps": strength, "run_length": shape["run_length"]}

    def _in_beat(self):
        return float(self.params.get("run_length", 0.0)) == 0.0

    def prepare(self, model):
        if self._in_beat():
            self.context.fresh_share = 1.0 - float(self.params["eps"])

    def _updates(self, rng, n):
        """Of a beat, how many updates there were by each row; a whole number at the moment of one."""
        return np.arange(n) * (1.0 - float(self.params["eps"])) + rng.random()

    def age_s(self, rng):
        """A row of a beat shows the world as of the sensor's last update."""
        if not self._in_beat():
            return 0.0
        since = np.mod(self._updates(rng, self.context.n), 1.0)
        return since / (1.0 - float(self.params["eps"])) / self.context.rate_hz

    def _new(self, rng, n):
        """Which rows repeat none."""
        eps, run = float(self.params["eps"]), float(self.params.get("run_length", 0.0))
        if self._in_beat():
            source = np.floor(self._updates(rng, n)).astype(int)
            # New where the count moves.
            return np.concatenate([[True], np.diff(source) > 0])
        # Runs of repeats and of new rows in turn, each of geometric length, the first one of new rows.
        fresh = run * (1.0 - eps) / eps
        pairs = int(1.5 * n / (run + fresh)) + 50
        lengths = np.empty(2 * pairs, int)
        lengths[0::2] = rng.geometric(1.0 / max(fresh, 1.0), pairs)
        lengths[1::2] = rng.geometric(1.0 / max(run, 1.0), pairs)
        return np.repeat(np.arange(2 * pairs) % 2 == 0, lengths)[:n]

    def rows(self, columns, rng):
        n = len(columns["t_s"])
        new = self._new(rng, n)
        row = np.maximum.accumulate(np.where(new, np.arange(n), 0))
        return {name: column if name == "t_s" or name.startswith("ref_") else column[row]
                for name, column in columns.items()}

    def describe(self, d):
        d.structure["stale"] = float(self.params["eps"])

    def where(self):
        return {"structure": "duplicated_samples"}


class Dropped(Acting):
    name, family, needs, whole = "dropped", "structure", "both", True

    @classmethod
    def shape(cls, rng, context, axes):
        hidden = bool(context.motion) and rng.random() < 0.6
        return {"longest": int(rng.integers(1, 13)), "in_stamps": 0 if hidden else 1,
                "hours": context.duration_s / 3600.0}

    @classmethod
    def range(cls, context, shape):
        return 1.0, 150.0

    @classmethod
    def to_params(cls, shape, strength):
        return {"per_hour": max(1.0, round(strength)) / shape["hours"], "longest": shape["longest"],
                "in_stamps": shape["in_stamps"]}

    def _losses(self, rng):
        """(where, how many) of each burst, sorted, away from the ends and from each other."""
        count = max(1, int(round(self.params["per_hour"] * self.context.duration_s / 3600.0)))
        cells = np.arange(40, self.context.n - 400, 30)
        at = np.sort(rng.choice(cells, min(count, cells.size), replace=False))
        return at, rng.integers(1, int(self.params["longest"]) + 1, at.size)

    def hides_time(self):
        return not self.params["in_stamps"]

    def times(self, rng, instants, stamps):
        if self.params["in_stamps"]:
            return instants, stamps
        at, lost = self._losses(rng)
        late = np.zeros(instants.size)
        late[at] = lost
        return instants + np.cumsum(late) / self.context.rate_hz, stamps

    def rows(self, columns, rng):
        if not self.params["in_stamps"]:
            return columns
        keep = np.ones(len(columns["t_s"]), bool)
        for at, lost in zip(*self._losses(rng)):
            keep[at : at + lost] = False
        return {name: column[keep] for name, column in columns.items()}

    def describe(self, d):
        # A loss that the stamps hide moves all that follows by whole periods.
        kind = "gaps" if self.params.get("in_stamps", 1) else "slips"
        d.structure[kind] = float(self.params["per_hour"]) * self.context.duration_s / 3600.0

    def where(self):
        return {"structure": "timestamp_gaps" if self.params.get("in_stamps", 1) else "growing_lag"}


class ClockRate(Acting):
    name, family, needs, whole = "clock_rate", "structure", "both", True

    @classmethod
    def shape(cls, rng, context, axes):
        hidden = bool(context.motion) and rng.random() < 0.5
        return {"sign": float(rng.choice([-1.0, 1.0])), "in_stamps": 0 if hidden else 1}

    @classmethod
    def range(cls, context, shape):
        return 5e-5, 0.01

    @classmethod
    def to_params(cls, shape, strength):
        return {"rel": shape["sign"] * strength, "in_stamps": shape["in_stamps"]}

    def hides_time(self):
        return not self.params["in_stamps"]

    def times(self, rng, instants, stamps):
        real = instants / (1.0 + float(self.params["rel"]))
        return (real, real) if self.params["in_stamps"] else (real, stamps)

    def describe(self, d):
        d.structure["rate"] = d.structure.get("rate", 0.0) + float(self.params["rel"])

    def where(self):
        return {"structure": "timestamp_rate" if self.params.get("in_stamps", 1) else "growing_lag"}


class ClockJitter(Acting):
    name, family, needs, whole = "clock_jitter", "structure", "both", True

    @classmethod
    def shape(cls, rng, context, axes):
        return {"in_stamps": 0 if context.motion and rng.random() < 0.5 else 1}

    @classmethod
    def range(cls, context, shape):
        return 2e-6, 3e-3

    @classmethod
    def to_params(cls, shape, strength):
        return {"sd_s": strength, "in_stamps": shape["in_stamps"]}

    def hides_time(self):
        return not self.params["in_stamps"]

    def times(self, rng, instants, stamps):
        scatter = rng.normal(0.0, float(self.params["sd_s"]), instants.size)
        return (instants, stamps + scatter) if self.params["in_stamps"] else (instants + scatter, stamps)

    def describe(self, d):
        sd = float(self.params["sd_s"])
        if self.params.get("in_stamps", 1) or not self.context.motion:
            d.structure["jitter"] = sd
            return
        for axis in range(3):
            noise = self.context.floor_density * self.context.rate_hz + self.context.sigma_dps(axis) ** 2
            d.scale_level(axis, 1.0 + (self.context.slope()[axis] * sd) ** 2 / noise)

    def where(self):
        return {"structure": "timestamp_jitter"}


# ------------------------------------------------------------------ answer to motion


class ScaleFactor(Acting):
    name, family, needs = "scale_factor", "gain", "motion"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 1e-4, 0.03

    @classmethod
    def to_params(cls, shape, strength):
        return {"eps": [strength * v for v in shape["each"]]}

    def added(self, axis, around):
        return self.of("eps", axis) * around.W[axis]

    def where(self):
        return {"rate_dps": [20.0, 500.0]}


class Misalignment(Acting):
    name, family, needs = "misalignment", "gain", "motion"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"each": [[0.0 if a == b else float(v) for b, v in zip("xyz", signs(rng, 3))] for a in axes]}

    @classmethod
    def range(cls, context, shape):
        return 1e-4, 0.02

    @classmethod
    def to_params(cls, shape, strength):
        return {"from_" + b: [strength * row[j] for row in shape["each"]] for j, b in enumerate("xyz")}

    def added(self, axis, around):
        return sum(self.of("from_" + b, axis, 0.0) * around.W[j] for j, b in enumerate("xyz") if j != axis)

    def where(self):
        return {"structure": "cross_axis", "rate_dps": [20.0, 500.0]}


class Nonlinearity(Acting):
    name, family, needs, fast = "nonlinearity", "curve", "motion", 440.0

    @classmethod
    def shape(cls, rng, context, axes):
        return {"power": int(rng.integers(2, 4)), "each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 3e-5, 2e-3

    @classmethod
    def to_params(cls, shape, strength):
        values = [strength * v for v in shape["each"]]
        none = [0.0] * len(values)
        return {"quadratic": values if shape["power"] == 2 else none, "cubic": values if shape["power"] == 3 else none}

    def added(self, axis, around):
        scale = float(self.context.model["full_scale_dps"])
        w = around.S[axis] / scale
        return scale * (self.of("quadratic", axis, 0.0) * w**2 + self.of("cubic", axis, 0.0) * w**3)

    def where(self):
        return {"rate_dps": [100.0, 500.0]}


class Asymmetry(Acting):
    name, family, needs = "asymmetry", "curve", "motion"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"each": [float(v) for v in signs(rng, len(axes))]}

    @classmethod
    def range(cls, context, shape):
        return 3e-5, 0.01

    @classmethod
    def to_params(cls, shape, strength):
        return {"gain": [strength * v for v in shape["each"]]}

    def added(self, axis, around):
        return self.of("gain", axis) * np.abs(around.S[axis])

    def where(self):
        return {"rate_dps": [5.0, 500.0]}


class DeadZone(Acting):
    name, family, needs = "dead_zone", "curve", "motion"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"jump": int(rng.random() < 0.5)}

    @classmethod
    def range(cls, context, shape):
        return 0.003, 0.5

    @classmethod
    def to_params(cls, shape, strength):
        return {"width_dps": strength, "jump": shape["jump"]}

    def added(self, axis, around):
        w, width = around.S[axis], self.of("width_dps", axis)
        beyond = np.abs(w) > width
        answer = np.where(beyond, w - (1.0 - self.of("jump", axis, 0.0)) * width * np.sign(w), 0.0)
        return answer - w

    def where(self):
        return {"rate_dps": [0.0, self.params["width_dps"]]}


class Saturation(Acting):
    name, family, needs, fast = "saturation", "curve", "motion", 440.0

    @classmethod
    def shape(cls, rng, context, axes):
        # Each axis clips somewhat below the fastest that it turned.
        shown = context.sensor.M @ context.slow.W + context.sensor.bias[:, None]
        return {"top_dps": [float(np.abs(shown[AXES.index(a)]).max()) for a in axes]}

    @classmethod
    def range(cls, context, shape):
        return 0.01, 0.4 * min(shape["top_dps"])

    @classmethod
    def to_params(cls, shape, strength):
        return {"limit_dps": [top - strength for top in shape["top_dps"]]}

    def limit_dps(self, axis):
        return self.of("limit_dps", axis)

    def describe(self, d):
        for axis in self.acting_axes():
            w = (self.context.sensor.M @ self.context.slow.W)[axis] + self.context.sensor.bias[axis]
            limit = self.of("limit_dps", axis)
            d.add_mean(axis, np.clip(w, -limit, limit) - w)

    def where(self):
        limits = np.ravel(self.params["limit_dps"])
        return {"rate_dps": [0.95 * float(min(limits)), 1.05 * float(max(limits))]}


class Latency(Acting):
    name, family, needs, whole = "latency", "lag", "motion", True

    @classmethod
    def range(cls, context, shape):
        return 5e-5, 0.010

    @classmethod
    def to_params(cls, shape, strength):
        return {"delay_s": strength}

    def delay_s(self):
        return float(np.ravel(self.params["delay_s"])[0])

    def describe(self, d):
        late = self.context.motion(self.context.slow.t - self.delay_s()) - self.context.slow.W
        for axis in range(3):
            d.add_mean(axis, late[axis])

    def where(self):
        return {"any": True}


class GSensitivity(Acting):
    name, family, needs = "g_sensitivity", "force", "motion"

    @classmethod
    def shape(cls, rng, context, axes):
        return {"each": [[float(v) for v in signs(rng, 3)] for _ in axes]}

    @classmethod
    def range(cls, context, shape):
        return 5e-4, 0.5

    @classmethod
    def to_params(cls, shape, strength):
        return {b + "_dps_per_g": [strength * row[j] for row in shape["each"]] for j, b in enumerate("xyz")}

    def added(self, axis, around):
        return sum(self.of(b + "_dps_per_g", axis, 0.0) * around.f[j] for j, b in enumerate("xyz"))

    def where(self):
        return {"acceleration": True}


CATALOGUE = {cls.name: cls for cls in (
    ArwScale, NoiseColour, FlickerMissing, RrwMissing, GaussMarkov, Lowpass, Tone, Narrowband, RateRamp, Warmup, BiasStep,
    TempLinear, TempQuadratic, TempCubic, TempLag, TempNoise, Rtn, Spikes, HeavyTail, VarianceChange, Quantization, Stale,
    Dropped, ClockRate, ClockJitter, CommonMode, ScaleFactor, Misalignment, Nonlinearity, Saturation, DeadZone, Latency,
    GSensitivity, Asymmetry)}
