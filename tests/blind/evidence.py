"""Evidence in nats: how much better the data are explained by one description than by another.

Expected log-likelihood ratio of the description that made the data against another one, whose N, B, K, M,
latency and clock are fitted within what the model file states about them; the turn-on bias is free. The parts:

  spectrum and mean   In the DCT-II basis of the whole record the noise is diagonal (of a random walk exactly, of
                      the rest nearly), a coefficient has the variance S(f) rate, f = k rate / (2 n), and the first
                      one, the bias, is left out. With P = S_true + (difference of the means)^2:
                      sum of (P/S - 1 - ln(S_true/S)) / 2 + the prior's cost, the least over N, B, K.
  lines               A^2 n / (4 S(f) rate): phase known, and so a little too much.
  level in time       sum of (r - 1 - ln r) / 2 over samples, r the ratio of variances, each of mean 1.
  tails               n times the divergence of the standardised densities.
  spikes              log(1 + p u / phi) at a spike, with u the density of its size.
  axes in common      n (tr(R^-1 R_true) - 3 + ln det R / det R_true) / 2, R the correlation matrices.
  structure           counts: what each repeat, gap or step says, with a cap, for it would be infinite.

For telegraph noise the spectral part is a lower bound: the two levels say more.
"""

import numpy as np

AXES = "xyz"
GAP_NATS = 25.0  # of a gap in the stamps; the true figure is (10 ms / 20 us)^2 / 2
SLIP_NATS = 500.0  # of a loss that shows in the motion only, for a lower bound


def dct(x):
    """Orthonormal DCT-II along the last axis, by one complex transform of the samples in folded order."""
    n = x.shape[-1]
    folded = np.concatenate([x[..., ::2], x[..., 1::2][..., ::-1]], axis=-1)
    turn = np.exp(-0.5j * np.pi * np.arange(n) / n)
    out = np.real(np.fft.fft(folded, axis=-1) * turn) * np.sqrt(2.0 / n)
    out[..., 0] /= np.sqrt(2.0)
    return out


class Bins:
    """Coefficients 1 to n - 1 of a record, one by one at first, then 32 an octave."""

    def __init__(self, n, rate_hz):
        edges = np.unique(np.concatenate([
            np.arange(1, 65),
            np.round(64.0 * 2.0 ** np.arange(0.0, np.log2(n / 64.0), 1.0 / 32.0)).astype(int),
        ]))
        self.start = edges[(edges >= 1) & (edges < n)]
        stop = np.append(self.start[1:], n)
        self.count = (stop - self.start).astype(float)
        self.f = 0.5 * (self.start + stop - 1) * rate_hz / (2.0 * n)
        self.n = n
        self.rate_hz = rate_hz

    def power(self, coefficients):
        """Mean square in each bin; coefficients beyond the last one given are zero."""
        squares = np.zeros(self.n)
        squares[: coefficients.size] = coefficients**2
        return np.add.reduceat(squares, self.start) / self.count


def fitted_levels(power, count, parts, fixed, prior_sd, iterations=60):
    """The least of sum count (power/S + ln S)/2 + sum (a/sd)^2/2 over a, S = fixed + sum exp(2 a_i) parts_i.

    Returns (a, value, information matrix). Fisher's scoring with a step that shrinks until it pays.
    """
    use = [i for i, part in enumerate(parts) if np.any(part > 0.0)]
    a = np.zeros(len(parts))
    weight = np.array([0.0 if not np.isfinite(sd) else 1.0 / sd**2 for sd in prior_sd])

    def spectrum(at):
        return fixed + sum(np.exp(2.0 * at[i]) * parts[i] for i in use)

    def value(at):
        s = spectrum(at)
        return 0.5 * np.sum(count * (power / s + np.log(s))) + 0.5 * np.sum(weight * at**2)

    best = value(a)
    information = np.diag(weight)
    damping = 1e-6
    for _ in range(iterations):
        if not use:
            break
        s = spectrum(a)
        slopes = np.array([2.0 * np.exp(2.0 * a[i]) * parts[i] / s for i in use])
        gradient = 0.5 * slopes @ (count * (1.0 - power / s)) + weight[use] * a[use]
        information = 0.5 * (slopes * count) @ slopes.T + np.diag(weight[use])
        moved = False
        while damping < 1e9:
            step = np.linalg.solve(information + damping * np.diag(np.diag(information) + 1e-12), -gradient)
            trial = a.copy()
            trial[use] = np.clip(a[use] + np.clip(step, -1.0, 1.0), -12.0, 12.0)
            now = value(trial)
            if now < best:
                moved = best - now > 1e-6
                a, best, damping = trial, now, max(damping / 10.0, 1e-9)
                break
            damping = 10.0 * max(damping, 1e-9)
        if not moved:
            break
    full = np.zeros((len(parts), len(parts)))
    if use:
        full[np.ix_(use, use)] = information
    return a, best, full


def folded_lowpass(f, fc_hz, order, rate_hz):
    """Sum of |H|^2 over the aliases of f: continuous white noise through a Butterworth filter, then sampled."""
    total = np.zeros_like(f)
    for m in range(-400, 401):
        total += 1.0 / (1.0 + ((f + m * rate_hz) / fc_hz) ** (2 * order))
    return total


class Description:
    """What makes a recording, beyond the model: all that its likelihood needs."""

    def __init__(self):
        self.white = np.ones(3)  # factor of the white noise's power
        self.colour = [[], [], []]  # functions of the frequency: factors of the white noise's power
        self.filter = [None] * 3  # (fc_hz, order)
        self.extra = [[], [], []]  # densities, functions of f
        self.mean = {}  # axis: series on the context's slow grid
        self.level = {}  # axis: power of the white noise in time, on the slow grid
        self.nu = [np.inf] * 3
        self.lines = [[], [], []]  # (f_hz, amplitude_dps)
        self.spikes = [[], [], []]  # (per_hour, smallest_dps, largest_dps)
        self.common = []  # (density^2, gains)
        self.structure = {}  # name: number
        self.other = {}  # name: nats of what no description of ours can hold
        self.stated = {}  # axis: (N, B, K) where they are not the given model's

    def add_mean(self, axis, series):
        self.mean[axis] = self.mean.get(axis, 0.0) + series

    def scale_level(self, axis, power):
        self.level[axis] = self.level.get(axis, 1.0) * power


def _spectrum(context, description, axis, N, B, K):
    """(white, flicker, walk, fixed) parts of S on the context's bins."""
    f = context.bins.f
    white = N**2 * description.white[axis] * np.ones_like(f)
    passed = 1.0
    if axis in description.level:
        white = white * np.mean(description.level[axis])
    for factor in description.colour[axis]:
        white = white * factor(f)
    if description.filter[axis]:
        fc_hz, order = description.filter[axis]
        passed = folded_lowpass(f, fc_hz, order, context.rate_hz)
        white = white * passed
    fixed = np.full_like(f, context.floor_density)
    for density in description.extra[axis]:
        fixed = fixed + density(f)
    for square, gains in description.common:
        fixed = fixed + square * gains[axis] ** 2 * passed
    slow = 1.0 / (1.0 + (f / fc_hz) ** (2 * order)) if description.filter[axis] else 1.0
    return white, slow * B**2 / (2.0 * np.pi * f), slow * (K / (2.0 * np.pi * f)) ** 2, fixed


def _spectral_nats(context, true, other, axis, free, apart, perfect, beside):
    sensor, bins = context.sensor, context.bins
    rate = context.rate_hz
    known = _spectrum(context, true, axis, sensor.N[axis], sensor.B[axis], sensor.K[axis])
    s_true = sum(known)
    difference = true.mean.get(axis, 0.0) - other.mean.get(axis, 0.0)
    excess, prior_cost = np.zeros_like(s_true), 0.0
    if not np.isscalar(difference):
        excess, prior_cost = context.unexplained_power(axis, difference, s_true, beside)
        excess = excess / rate
    total = 0.0
    if apart:
        total += 0.5 * np.sum(bins.count * excess / s_true)
        excess = 0.0
    # The true description is fitted too, so that what the model's uncertainty covers counts on neither side.
    for description, power, sign in ((other, s_true + excess, 1.0), (true, s_true, -1.0)):
        parts = _spectrum(context, description, axis, *description.stated.get(axis, context.stated(axis)))
        sd = context.stated_sd(axis) if not free else [np.inf] * 3
        _, value, _ = fitted_levels(power, bins.count, parts[:3], parts[3], sd)
        if perfect and sign < 0.0:
            value = 0.5 * np.sum(bins.count * (1.0 + np.log(s_true)))
        total += sign * value
    return total + prior_cost


def _level_nats(context, true, other, axis):
    floor = context.floor_density * context.rate_hz
    white = context.sensor.N[axis] ** 2 * context.rate_hz

    def level(description):
        power = floor + white * description.white[axis] * description.level.get(axis, np.ones(1))
        return power / np.mean(power)

    r = level(true) / level(other)
    return 0.5 * context.n * np.mean(r - 1.0 - np.log(r))


def _log_student(x, nu):
    """Log density of unit variance."""
    if not np.isfinite(nu):
        return -0.5 * x**2 - 0.5 * np.log(2.0 * np.pi)
    from math import lgamma

    scale = np.sqrt((nu - 2.0) / nu)
    y = x / scale
    return (lgamma(0.5 * (nu + 1.0)) - lgamma(0.5 * nu) - 0.5 * np.log(nu * np.pi) - np.log(scale)
            - 0.5 * (nu + 1.0) * np.log1p(y * y / nu))


def student_divergence(nu, rival):
    x = np.linspace(-60.0, 60.0, 48001)
    p, q = _log_student(x, nu), _log_student(x, rival)
    return float(np.sum(np.exp(p) * (p - q)) * (x[1] - x[0]))


def spike_nats(sizes_sigma, low_sigma, high_sigma, share):
    """Of each spike of a given size, its rate and range of sizes known."""
    v2 = sizes_sigma**2 + 1.0
    width = max(high_sigma - low_sigma, 1.0)
    log_ratio = np.log(share) - np.log(2.0 * width) + 0.5 * v2 + 0.5 * np.log(2.0 * np.pi)
    return np.logaddexp(0.0, log_ratio)


def _spike_total(context, true, other, axis):
    sigma = context.sigma_dps(axis)
    hours = context.n / context.rate_hz / 3600.0
    total = 0.0
    for per_hour, low, high in true.spikes[axis]:
        count = per_hour * hours
        sizes = np.linspace(low, high, 64) / sigma
        worth = spike_nats(sizes, low / sigma, high / sigma, max(count, 1.0) / context.n) - 1.0
        missed = np.ones(64)
        for rival_per_hour, rival_low, rival_high in other.spikes[axis]:
            inside = (sizes >= 0.8 * rival_low / sigma) & (sizes <= 1.25 * rival_high / sigma)
            ratio = max(rival_per_hour, 1e-9) / per_hour
            loss = (ratio - 1.0 - np.log(ratio)) / np.maximum(worth, 1e-3)
            missed = np.where(inside, np.minimum(missed, loss), missed)
        total += count * np.mean(missed * np.maximum(worth, 0.0))
    return total


def _common_nats(context, true, other):
    def correlation(description):
        matrix = np.zeros((3, 3))
        for axis in range(3):
            matrix[axis, axis] = context.sensor.N[axis] ** 2 * description.white[axis] + context.floor_density
        for square, gains in description.common:
            matrix += square * np.outer(gains, gains)
        d = np.sqrt(np.diag(matrix))
        return matrix / np.outer(d, d)

    a, b = correlation(true), correlation(other)
    nats = np.trace(np.linalg.solve(b, a)) - 3.0 + np.log(np.linalg.det(b) / np.linalg.det(a))
    return 0.5 * context.n * nats


def _line_nats(context, true, other, axis):
    density = sum(_spectrum(context, true, axis, context.sensor.N[axis], context.sensor.B[axis],
                            context.sensor.K[axis]))
    duration_s = context.n / context.rate_hz
    total = 0.0
    rivals = list(other.lines[axis])
    for f, amplitude in true.lines[axis]:
        s = np.interp(f, context.bins.f, density)
        square = amplitude**2
        if rivals:
            at = int(np.argmin([abs(r[0] - f) for r in rivals]))
            rival_f, rival_amplitude = rivals[at]
            if abs(rival_f - f) * duration_s < 20.0:
                rivals.pop(at)
                alike = abs(np.sinc((rival_f - f) * duration_s))
                square = amplitude**2 + rival_amplitude**2 - 2.0 * amplitude * rival_amplitude * alike
        total += square * context.n / (4.0 * s * context.rate_hz)
    for f, amplitude in rivals:
        total += amplitude**2 * context.n / (4.0 * np.interp(f, context.bins.f, density) * context.rate_hz)
    return total


def _structure_nats(context, true, other):
    a, b = true.structure, other.structure
    n, total = context.n, 0.0

    def poisson(count, rival):
        return count * np.log(count / rival) - count + rival

    if "stale" in a:
        # Nobody knows which they are: new samples repeat by chance, too.
        by_chance = n
        for axis in range(3):
            by_chance /= max(2.0, np.sqrt(4.0 * np.pi) * context.sigma_dps(axis) / context.step_dps)
        total += poisson(a["stale"] * n + by_chance, b.get("stale", 0.0) * n + by_chance)
    for kind, worth in (("gaps", GAP_NATS), ("slips", SLIP_NATS)):
        if kind in a:
            total += poisson(a[kind], b[kind]) if b.get(kind) else a[kind] * worth
    # A clock is known to rate_rel, whatever the stamps say.
    sd = context.model["sd_abs"]["rate_rel"]
    total += 0.5 * ((a.get("rate", 0.0) - b.get("rate", 0.0)) / sd) ** 2
    if "jitter" in a or "jitter" in b:
        own = context.model["timestamp_jitter_s"]
        ratio = np.hypot(own, a.get("jitter", 0.0)) / np.hypot(own, b.get("jitter", 0.0))
        sd = context.model["sd_rel"]["timestamp_jitter"]
        # So many stamps leave the stated uncertainty as the only excuse.
        total += 0.5 * (np.log(ratio) / sd) ** 2
    for axis in AXES:
        step, rival = a.get("grid_" + axis), b.get("grid_" + axis)
        if step and not (rival and abs(rival / step - 1.0) < 0.01):
            total += min(n * np.log(step / context.finest_step_dps), 5000.0)
    return total


def nats(context, true, other, free=False, apart=False, perfect=False, beside=None):
    """Evidence for `true`, which made the data, against `other`.

    free: N, B and K are fitted without any prior. apart: a difference of the means is weighed by the true spectrum,
    so that no level fitted to it takes it up; it then counts as its square, as a distance does. perfect: against the
    true levels, even where the model states others. beside: by axis, series whose size `other` may choose.
    """
    total = 0.0
    for axis in range(3):
        spectral = (true.white[axis] != other.white[axis] or true.filter[axis] != other.filter[axis]
                    or true.colour[axis] or other.colour[axis]
                    or true.extra[axis] or other.extra[axis] or true.common or other.common
                    or axis in true.level or axis in other.level
                    or axis in true.mean or axis in other.mean)
        if spectral:
            total += _spectral_nats(context, true, other, axis, free, apart, perfect, (beside or {}).get(axis, ()))
        if axis in true.level or axis in other.level:
            total += _level_nats(context, true, other, axis)
        if true.nu[axis] != other.nu[axis]:
            total += context.n * student_divergence(true.nu[axis], other.nu[axis])
        if true.lines[axis] or other.lines[axis]:
            total += _line_nats(context, true, other, axis)
        if true.spikes[axis]:
            total += _spike_total(context, true, other, axis)
    if true.common or other.common:
        total += _common_nats(context, true, other)
    total += _structure_nats(context, true, other)
    total += sum(worth for name, worth in true.other.items() if name not in other.other)
    return max(0.0, total)
