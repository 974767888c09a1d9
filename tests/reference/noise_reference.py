#!/usr/bin/env python3
"""Compares gyrolog's simulated noise with realisations that numpy makes by other formulas.

Each process is simulated, made again here, and both are put through the same estimators: power in every
octave of frequency, Allan variance in every octave of tau, distribution, dwell times, covariance of the
axes. Two means must agree within LIMIT of their joint standard errors, two distributions within
Kolmogorov and Smirnov's bound. All seeds are fixed.

Usage: noise_reference.py NOISE_SAMPLES [-v]
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blind"))
import numbers_or_skip  # noqa: E402, F401  it may start another interpreter

import numpy as np  # noqa: E402

SAMPLES = 1 << 14
SEEDS = 20  # three records each
RECORDS = 3 * SEEDS
LIMIT = 4.5  # standard errors; some 250 comparisons of about 60 records
KOLMOGOROV = 2.23  # passed once in ten thousand times


# ------------------------------------------------------------------ realisations, in deg/s


def white(rng, density, rate_hz):
    return rng.normal(0.0, density * np.sqrt(rate_hz), (RECORDS, SAMPLES))


def flicker(rng, B):
    """By shaping the transform of white noise; the record is a sixteenth of its circle."""
    length = 16 * SAMPLES
    nu = np.fft.rfftfreq(length)
    gain = np.zeros(nu.size)
    gain[1:] = B / np.sqrt(2.0 * np.pi * nu[1:])
    return np.array(
        [np.fft.irfft(gain * np.fft.rfft(rng.standard_normal(length)))[:SAMPLES] for _ in range(RECORDS)]
    )


def random_walk(rng, K, rate_hz):
    steps = rng.normal(0.0, K / np.sqrt(rate_hz), (RECORDS, SAMPLES))
    steps[:, 0] = 0.0
    return np.cumsum(steps, axis=1)


def gauss_markov(rng, sigma, tau_s, rate_hz):
    """From its covariance, put on a circle of twice the length (Davies and Harte, 1987)."""
    lag = np.minimum(np.arange(2 * SAMPLES), 2 * SAMPLES - np.arange(2 * SAMPLES))
    power = np.fft.fft(sigma**2 * np.exp(-lag / (rate_hz * tau_s))).real
    assert power.min() > 0.0
    z = rng.standard_normal((RECORDS // 2, 2 * SAMPLES)) + 1j * rng.standard_normal((RECORDS // 2, 2 * SAMPLES))
    x = np.fft.fft(z * np.sqrt(power / (2 * SAMPLES)), axis=1)[:, :SAMPLES]
    return np.concatenate([x.real, x.imag])


def telegraph(rng, amplitude, dwell_high_s, dwell_low_s, rate_hz):
    """Poisson events over the record, sorted; at each one the level is drawn anew."""
    high_share = dwell_high_s / (dwell_high_s + dwell_low_s)
    duration_s = SAMPLES / rate_hz
    t_s = np.arange(SAMPLES) / rate_hz
    records = []
    for _ in range(RECORDS):
        events = rng.poisson(duration_s * (1.0 / dwell_high_s + 1.0 / dwell_low_s))
        at_s = np.sort(rng.uniform(0.0, duration_s, events))
        high = rng.uniform(size=events + 1) < high_share
        records.append(amplitude * (high[np.searchsorted(at_s, t_s, side="right")] - 0.5))
    return np.array(records)


def student(rng, nu, density, rate_hz):
    return density * np.sqrt(rate_hz * (nu - 2.0) / nu) * rng.standard_t(nu, (RECORDS, SAMPLES))


def angle_noise(rng, Q, rate_hz):
    """As rounding makes it: errors of the angle spread evenly over one step."""
    half_step = Q * np.sqrt(3.0)
    return rate_hz * np.diff(rng.uniform(-half_step, half_step, (RECORDS, SAMPLES + 1)), axis=1)


def common_mode(rng, density, gains, rate_hz):
    shared = rng.normal(0.0, density * np.sqrt(rate_hz), (SEEDS, 1, SAMPLES))
    own = rng.normal(0.0, OWN_DENSITY * np.sqrt(rate_hz), (SEEDS, 3, SAMPLES))
    return (own + shared * np.array(gains)[None, :, None]).reshape(RECORDS, SAMPLES)


OWN_DENSITY = 0.005


# ------------------------------------------------------------------ estimates, a row for each record


def octave_powers(records):
    """Hann-windowed periodogram, averaged from bin k to 2k - 1 for k = 2, 4, 8, ..."""
    window = np.hanning(SAMPLES + 1)[:-1]
    spectrum = np.abs(np.fft.rfft((records - records.mean(axis=1, keepdims=True)) * window)) ** 2
    first = [1 << i for i in range(1, SAMPLES.bit_length() - 2)]
    names = [f"power from {k / SAMPLES:.2g} of the rate" for k in first]
    return names, np.array([spectrum[:, k : 2 * k].mean(axis=1) for k in first]).T


def allan_variances(records):
    """For tau = 1, 2, 4, ... samples up to an eighth of the record."""
    names, columns = [], []
    averages, m = records, 1
    while m <= SAMPLES // 8:
        names.append(f"Allan variance at {m} samples")
        columns.append(0.5 * (np.diff(averages, axis=1) ** 2).mean(axis=1))
        averages, m = 0.5 * (averages[:, 0::2] + averages[:, 1::2]), 2 * m
    return names, np.array(columns).T


def axis_covariances(records):
    axes = records.reshape(SEEDS, 3, SAMPLES)
    pairs = [(a, b) for a in range(3) for b in range(a, 3)]
    names = [f"covariance of {'xyz'[a]} and {'xyz'[b]}" for a, b in pairs]
    return names, np.array([(axes[:, a] * axes[:, b]).mean(axis=1) for a, b in pairs]).T


def samples_of(records):
    return {"samples": records.ravel()}


def dwells_of(records):
    """Lengths of the runs on each level, without the first one and the last one of a record."""
    runs = {"dwell times, high": [], "dwell times, low": []}
    for record in records:
        changes = np.flatnonzero(np.diff(record)) + 1
        lengths = np.diff(changes)
        high = record[changes[:-1]] > 0.0
        runs["dwell times, high"].append(lengths[high])
        runs["dwell times, low"].append(lengths[~high])
    return {name: np.concatenate(parts) for name, parts in runs.items()}


def kolmogorov_distance(a, b):
    a, b = np.sort(a), np.sort(b)
    both = np.concatenate([a, b])
    distance = np.abs(
        np.searchsorted(a, both, side="right") / a.size - np.searchsorted(b, both, side="right") / b.size
    ).max()
    return distance * np.sqrt(a.size * b.size / (a.size + b.size))


# ------------------------------------------------------------------ comparison


class Comparison:
    def __init__(self, program, verbose):
        self.program = program
        self.verbose = verbose
        self.compared = 0
        self.failures = []

    def simulate(self, rate_hz, noise, effects):
        axis = {"N": 0.0, "B": 0.0, "K": 0.0, "bias": 0.0} | noise
        model = {
            "schema": "gyrolog-model/1",
            "rate_hz": rate_hz,
            "full_scale_dps": 1e6,
            "lsb_dps": 0.0,
            "saturation_dps": 1e6,
            "axes": {name: axis for name in "xyz"},
            "M": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
            "latency_s": 0.0,
            "timestamp_jitter_s": 0.0,
            "sd_rel": {},
            "sd_abs": {},
            "ref_noise_dps": 0.0,
            "acc_noise_g": 0.0,
            "temp_noise_C": 0.0,
            "effects": effects,
        }
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(model, file)
            file.flush()
            out = subprocess.run(
                [self.program, file.name, str(rate_hz), "1", str(SEEDS), str(SAMPLES)],
                check=True,
                stdout=subprocess.PIPE,
            ).stdout
        return np.frombuffer(out).reshape(RECORDS, SAMPLES)

    def report(self, process, what, detail, agrees):
        self.compared += 1
        if not agrees:
            self.failures.append(f"{process}: {what}: {detail}")
        if self.verbose or not agrees:
            print(f"{'ok  ' if agrees else 'FAIL'} {process}: {what}: {detail}")

    def means(self, process, names, simulated, reference, stated_error):
        for name, ours, theirs in zip(names, simulated.T, reference.T):
            ratio = ours.mean() / theirs.mean()
            error = np.sqrt(ours.var(ddof=1) / ours.size + theirs.var(ddof=1) / theirs.size) / abs(theirs.mean())
            detail = f"{ratio:.4f} of numpy's, standard error {error:.4f}, stated error {stated_error}"
            self.report(process, name, detail, abs(ratio - 1.0) <= stated_error + LIMIT * error)

    def distributions(self, process, simulated, reference):
        for name, ours in simulated.items():
            distance = kolmogorov_distance(ours, reference[name])
            detail = f"Kolmogorov and Smirnov {distance:.2f}, limit {KOLMOGOROV}"
            self.report(process, name, detail, distance <= KOLMOGOROV)

    def process(self, name, rate_hz, reference, noise={}, effects=[], stated_error=0.0, rows=(), spread=None):
        """rows: estimates besides octaves and Allan variances; spread: what distributions are compared."""
        simulated = self.simulate(rate_hz, noise, effects)
        for estimate in (octave_powers, allan_variances, *rows):
            names, ours = estimate(simulated)
            self.means(name, names, ours, estimate(reference)[1], stated_error)
        if spread:
            self.distributions(name, spread(simulated), spread(reference))


def effect(name, **params):
    return [{"effect": name, "params": params}]


def main(arguments):
    compare = Comparison(arguments[0], "-v" in arguments)
    rng = np.random.default_rng(20240607)

    compare.process("white noise", 100.0, white(rng, 0.01, 100.0), noise={"N": 0.01}, spread=samples_of)
    for rate_hz in (10.0, 1000.0):
        # The construction's own error: flicker_noise.hpp.
        compare.process(f"flicker, {rate_hz:g} Hz", rate_hz, flicker(rng, 0.02), noise={"B": 0.02}, stated_error=0.037)
        compare.process(
            f"random walk, {rate_hz:g} Hz", rate_hz, random_walk(rng, 0.003, rate_hz), noise={"K": 0.003}
        )
    compare.process("flicker_missing", 100.0, flicker(rng, 0.02), effects=effect("flicker_missing", B_dps=0.02),
                    stated_error=0.037)
    compare.process("rrw_missing", 100.0, random_walk(rng, 0.003, 100.0),
                    effects=effect("rrw_missing", K_dps_sqrt_hz=0.003))
    for tau_s in (0.02, 3.0):
        compare.process(f"gauss_markov, {tau_s:g} s", 100.0, gauss_markov(rng, 0.01, tau_s, 100.0),
                        effects=effect("gauss_markov", sigma_dps=0.01, tau_s=tau_s))
    for high_s, low_s, rate_hz in ((0.5, 1.5, 100.0), (0.2, 0.05, 10.0)):
        compare.process(f"rtn, {high_s:g} s and {low_s:g} s", rate_hz, telegraph(rng, 0.02, high_s, low_s, rate_hz),
                        effects=effect("rtn", amplitude_dps=0.02, dwell_high_s=high_s, dwell_low_s=low_s),
                        spread=dwells_of)
    for nu in (3.5, 8.0):
        compare.process(f"heavy_tail, nu = {nu:g}", 100.0, student(rng, nu, 0.01, 100.0), noise={"N": 0.01},
                        effects=effect("heavy_tail", nu=nu), spread=samples_of)
    compare.process("angle noise", 100.0, angle_noise(rng, 1e-3, 100.0), noise={"Q": 1e-3})
    compare.process("angle_noise", 100.0, angle_noise(rng, 1e-3, 100.0), effects=effect("angle_noise", Q_dps_s=1e-3))
    compare.process("common_mode", 100.0, common_mode(rng, 0.004, (1.0, 0.7, -0.5), 100.0),
                    noise={"N": OWN_DENSITY},
                    effects=effect("common_mode", N_dps_per_sqrt_hz=0.004, gain_y=0.7, gain_z=-0.5),
                    rows=(axis_covariances,))

    print(f"{compare.compared} comparisons, {len(compare.failures)} outside their limits")
    return 1 if compare.failures else 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
