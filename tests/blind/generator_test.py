#!/usr/bin/env python3
"""The blind check's own check: the generator makes what it says, the evidence is what it says, the truth stays sealed.

Likelihoods are worked out here in the time domain, by other formulas than evidence.py's.
"""

import json
import math
import os
import sys
import tempfile
import unittest

import numbers_or_skip  # noqa: F401  first: it may start another interpreter
import numpy as np

import answer_form
import evidence
import generate
import halves
import judge
import reliability
import run
import score
import textfile
import units
from effects import (
    CATALOGUE, ArwScale, BiasStep, CommonMode, GaussMarkov, HeavyTail, Lowpass, RateRamp, Rtn, ScaleFactor, Stale,
    TempLinear, Tone, VarianceChange)
from foreign import FOREIGN, Bumps, SkewedNoise
from sensor import LSB_DPS, Context, Sensor, draw_model, flicker, record, refitted, shaped, stream, walk

LIMIT = 4.5  # standard errors


def quiet(context, B=0.0, K=0.0):
    """The context with nothing but white noise, and B and K as given; the model knows them all the same."""
    for a, N in zip("xyz", context.sensor.N):
        context.model["axes"][a].update(N=float(N), B=B, K=K)
    context.sensor.B[:] = B
    context.sensor.K[:] = K
    return context


class Noise(unittest.TestCase):
    def test_spectrum_of_a_recording_without_effect_is_the_sensors(self):
        ratios = []
        for seed in range(11, 15):
            context = Context(seed, False, 30.0, temperature="drift")
            columns = record(context, [])
            for axis, a in enumerate("xyz"):
                power = context.bins.power(evidence.dct(columns[f"g{a}_dps"])) / context.rate_hz
                s = context.sensor
                f = context.bins.f
                expected = (s.N[axis] ** 2 + s.B[axis] ** 2 / (2 * np.pi * f) + (s.K[axis] / (2 * np.pi * f)) ** 2
                            + LSB_DPS**2 / 12.0 / context.rate_hz)
                ratios.append(power / expected)
        count = context.bins.count
        # Octaves: a mean of chi-square variables of one degree of freedom each.
        octave = np.floor(np.log2(context.bins.start)).astype(int)
        for o in range(octave.max() + 1):
            mine = octave == o
            total = len(ratios) * count[mine].sum()
            mean = sum((r[mine] * count[mine]).sum() for r in ratios) / total
            self.assertLess(abs(mean - 1.0), LIMIT * np.sqrt(2.0 / total) + 0.002, f"octave {o}")

    def test_true_parameters_scatter_about_the_models_as_it_states(self):
        off = {key: [] for key in "NBK"}
        for seed in range(300):
            model = draw_model(stream(seed, "model"), True)
            sensor = Sensor(stream(seed, "sensor"), model, True)
            for key in "NBK":
                stated = np.array([model["axes"][a][key] for a in "xyz"])
                there = stated > 0.0
                off[key] += list((getattr(sensor, key)[there] / stated[there] - 1.0) / model["sd_rel"][key])
        for key, z in off.items():
            self.assertLess(abs(np.mean(z)), LIMIT / np.sqrt(len(z)), key)
            self.assertLess(abs(np.var(z) - 1.0), LIMIT * np.sqrt(2.0 / len(z)) + 0.03, key)  # cut at 3 sigma

    def test_flicker_and_walk_have_their_densities_in_every_octave(self):
        n, seeds = 1 << 13, 40
        bins = evidence.Bins(n, 100.0)
        octave = np.floor(np.log2(bins.start)).astype(int)
        f = bins.f
        for make, density in (
                (lambda rng: flicker(rng, n, 0.002), 0.002**2 / (2 * np.pi * f)),
                (lambda rng: walk(rng, n, 2e-4, 100.0), (2e-4 / 100.0 / (2 * np.sin(np.pi * f / 100.0))) ** 2)):
            ratio = np.mean([bins.power(evidence.dct(make(stream(s, "fw")))) / 100.0 / density
                             for s in range(seeds)], axis=0)
            for o in range(octave.max() + 1):
                count = bins.count[octave == o]
                error = LIMIT * np.sqrt(2.0 / (seeds * count.sum()))
                # Leakage of 1/f into its neighbours, and what lies below the longer circle.
                mean = (ratio[octave == o] * count).sum() / count.sum()
                self.assertLess(abs(mean - 1.0), error + 0.06, f"octave {o}")

    def test_sampled_gauss_markov_noise_has_its_variance_and_correlation(self):
        context = Context(1, False, 30.0)
        gm = GaussMarkov(context, {"sigma_dps": 0.02, "tau_s": 1.5}, ["x"])
        x = np.concatenate([gm.noise(0, stream(s, "gm"), context.slow) for s in range(12)])
        # Variance of a mean square of a process with correlation time tau: 2 sigma^4 tau / T.
        error = np.sqrt(2.0 * 1.5 / (12 * 1800.0))
        self.assertLess(abs(np.mean(x**2) / 0.02**2 - 1.0), LIMIT * error)
        self.assertAlmostEqual(np.mean(x[:-150] * x[150:]) / np.mean(x**2), np.exp(-1.0), delta=LIMIT * error)

    def test_telegraph_noise_stands_on_its_levels_as_long_as_it_says(self):
        context = Context(2, False, 120.0)
        rtn = Rtn(context, {"amplitude_dps": 0.02, "dwell_high_s": 3.0, "dwell_low_s": 5.0}, ["x"])
        t = type("Around", (), {"t": np.arange(context.n) / 100.0})
        high = np.concatenate([rtn.noise(0, stream(s, "rtn"), t) > 0.0 for s in range(3)])
        ups = np.count_nonzero(~high[:-1] & high[1:])
        self.assertLess(abs(ups - 3 * 7200 / 8.0), LIMIT * np.sqrt(3 * 7200 / 8.0))
        self.assertAlmostEqual(np.mean(high), 3.0 / 8.0, delta=LIMIT * 0.5 / np.sqrt(ups))

    def test_filtered_white_noise_has_the_variance_and_the_memory_of_the_filter(self):
        context = Context(3, False, 60.0)
        for order, fc in ((1, 12.0), (2, 20.0)):
            low = Lowpass(context, {"fc_hz": fc, "order": order}, ["x"])
            x = low.whitened(0, stream(order, "lp").standard_normal(context.n), None, None)
            w = 2.0 * np.pi * fc
            variance = w / 2.0 / 100.0 if order == 1 else w / (2.0 * np.sqrt(2.0)) / 100.0
            lag = np.exp(-w / 100.0)
            if order == 2:
                a = w / np.sqrt(2.0) / 100.0
                lag = np.exp(-a) * (np.cos(a) + np.sin(a))
            error = LIMIT * np.sqrt(2.0 * 4.0 / context.n)
            self.assertLess(abs(np.var(x) / variance - 1.0), error + 0.003)
            self.assertLess(abs(np.mean(x[:-1] * x[1:]) / np.var(x) - lag), error + 0.003)

    def test_filtered_drift_keeps_its_slow_part_and_loses_its_fast_one(self):
        context = Context(3, False, 60.0)
        t = np.arange(context.n) / 100.0
        low = Lowpass(context, {"fc_hz": 10.0, "order": 2}, ["x"])
        for f, gain in ((0.5, 1.0), (10.0, np.sqrt(0.5)), (40.0, 1.0 / np.sqrt(257.0))):
            x = low.drifted(0, np.cos(2.0 * np.pi * f * t))
            self.assertAlmostEqual(np.sqrt(2.0 * np.var(x)), gain, delta=0.003)

    def test_samples_repeat_in_a_beat_or_at_random_in_runs_of_their_length(self):
        context = Context(4, False, 20.0)
        n, eps = context.n, 0.1
        for run in (0.0, 1.0, 2.5):
            stale = Stale(context, {"eps": eps, "run_length": run}, list("xyz"))
            count = np.arange(n)
            rows = stale.rows({"t_s": count, "gx_dps": count, "temp_C": count}, stream(4, "stale"))
            self.assertTrue(np.array_equal(rows["t_s"], np.arange(n)))
            self.assertTrue(np.array_equal(rows["gx_dps"], rows["temp_C"]))
            repeats = np.concatenate([[False], np.diff(rows["gx_dps"]) == 0])
            runs = np.count_nonzero(np.diff(repeats.astype(int)) == 1)
            # Each run and the rows before it are geometric: of a number of them the relative deviation is below this.
            error = LIMIT * 2.0 / np.sqrt(runs)
            self.assertAlmostEqual(repeats.mean() / eps, 1.0, delta=error if run else 2.0 / (eps * n))
            self.assertAlmostEqual(repeats.sum() / runs / max(run, 1.0), 1.0, delta=error if run else 1e-9)
            since = np.diff(np.flatnonzero(np.diff(repeats.astype(int)) == 1))
            self.assertEqual(np.std(since) < 1.0, run == 0.0)

    def test_a_line_folds_at_the_rate_of_updates(self):
        context = Context(4, False, 20.0)
        effects = [Tone(context, {"f_hz": 60.0, "amplitude_dps": 1.0, "phase_rad": 0.3}, ["x"]),
                   Stale(context, {"eps": 0.0722, "run_length": 0.0}, list("xyz"))]
        for effect in effects:
            effect.prepare(context.model)
        rows = record(context, effects)["gx_dps"]
        power = np.abs(np.fft.rfft((rows - rows.mean()) * np.hanning(rows.size)))
        f = np.argmax(power) * context.rate_hz / rows.size
        self.assertAlmostEqual(f, (1.0 - 0.0722) * 100.0 - 60.0, delta=0.01)
        self.assertAlmostEqual(f, effects[0].alias_hz(), delta=0.01)

    def test_bumps_move_all_axes_at_the_same_instants_with_their_energy(self):
        context = Context(5, False, 20.0)
        bumps = Bumps(context, {"size_dps": 2.0, "count": 200, "f_hz": 11.0, "decay_s": 0.2}, list("xyz"))
        around = type("Around", (), {"t": np.arange(context.n) / 100.0})
        moved = np.array([bumps.noise(axis, stream(5, "bumps"), around) for axis in range(3)])
        # None between two of them, and at each on every axis.
        quiet = np.abs(moved).max(axis=0) < 1e-6
        self.assertGreater(quiet.mean(), 0.3)
        starts = np.flatnonzero(quiet[:-1] & ~quiet[1:])
        self.assertGreater(starts.size, 100)
        self.assertTrue(np.all(np.abs(moved[:, starts + 3]) > 0.0))
        for axis in range(3):
            energy = np.sum(moved[axis] ** 2) / context.sigma_dps(axis) ** 2
            # A direction's square has a relative deviation of 0.9, a size's of 0.6.
            self.assertAlmostEqual(energy / 200.0 / bumps.mean_energy(axis), 1.0, delta=LIMIT * 1.1 / np.sqrt(200.0))

    def test_evidence_of_a_bump_is_that_of_samples_with_its_variance(self):
        rng = stream(6, "bump")
        samples, energy = 20, 60.0
        ratio = 1.0 + energy / samples
        x = rng.normal(0.0, np.sqrt(ratio), (4000, samples))
        log_ratio = np.sum(0.5 * x**2 * (1.0 - 1.0 / ratio) - 0.5 * np.log(ratio), axis=1)
        self.assertAlmostEqual(Bumps.nats_of(samples, energy), log_ratio.mean(),
                               delta=LIMIT * log_ratio.std() / np.sqrt(4000.0))

    def test_skewed_noise_is_askew_and_no_more(self):
        context = Context(4, False, 120.0)
        x = SkewedNoise(context, {"skewness": 0.4}, ["x"]).whitened(0, np.empty(context.n), None, stream(1, "skew"))
        n = context.n
        self.assertLess(abs(np.mean(x**2) - 1.0), LIMIT * np.sqrt(2.0 / n))
        self.assertLess(abs(np.mean(x**3) - 0.4), LIMIT * np.sqrt(15.0 / n))
        self.assertLess(abs(np.mean(x**4) - 3.0), LIMIT * np.sqrt(96.0 / n))

    def test_noise_shaped_on_a_longer_circle_does_not_close(self):
        ends = [(x[0] - x[-1]) ** 2 for x in (shaped(stream(s, "c"), 4096, 1.0, lambda f: f**-2.0) for s in range(60))]
        next_door = [(x[1] - x[0]) ** 2 for x in (shaped(stream(s, "c"), 4096, 1.0, lambda f: f**-2.0)
                                                 for s in range(60))]
        self.assertGreater(np.mean(ends), 200.0 * np.mean(next_door))


class Evidence(unittest.TestCase):
    """Likelihood ratios of real samples: their mean is the evidence asked for, their variance twice that."""

    MINUTES = 20.0
    TARGET = 60.0
    SEEDS = 8

    def ratios(self, cls, shape_of, ratio, bias=0.0):
        values, asked = [], []
        for seed in range(self.SEEDS):
            context = quiet(Context(seed + 50, False, self.MINUTES, temperature="drift"))
            shape = shape_of(context)
            effect = generate.at_strength(context, cls, shape, ["y"], self.TARGET)
            asked.append(generate.evidence_of(context, [effect]))
            x = record(context, [effect])["gy_dps"]
            variance = context.sensor.N[1] ** 2 * 100.0 + LSB_DPS**2 / 12.0
            t = np.arange(x.size) / 100.0 / (1.0 + context.sensor.rate_rel)
            values.append(ratio(context, effect, x, t, variance))
        self.assertLess(abs(np.mean(asked) / self.TARGET - 1.0), 0.03)
        self.assertLess(abs(np.mean(values) - np.mean(asked)), LIMIT * np.sqrt(2.0 * self.TARGET / self.SEEDS)
                        + 1.0 + bias * self.TARGET)

    @staticmethod
    def of_mean(x, shift, variance):
        x, shift = x - x.mean(), shift - shift.mean()
        return 0.5 * (np.sum(x**2) - np.sum((x - shift) ** 2)) / variance

    def test_of_a_ramp(self):
        self.ratios(RateRamp, lambda c: {"each": [1.0]}, lambda c, e, x, t, v: self.of_mean(
            x, e.params["ramp_dps_per_s"][0] * t, v))

    def test_of_a_line(self):
        self.ratios(Tone, lambda c: {"f_hz": 113.3, "phase_rad": [0.7]}, lambda c, e, x, t, v: self.of_mean(
            x, e.params["amplitude_dps"] * np.cos(2 * np.pi * 113.3 * t + 0.7), v))

    def test_of_a_slope_over_temperature(self):
        self.ratios(TempLinear, lambda c: {"each": [-1.0]}, lambda c, e, x, t, v: self.of_mean(
            x, e.params["c1_dps_per_C"][0] * c.temperature(t), v))

    def test_of_another_white_level_beyond_what_the_model_states(self):
        def ratio(context, effect, x, t, variance):
            power, n = np.var(x), x.size
            N, sd = context.stated(1)[0], context.model["sd_rel"]["N"]
            a = np.linspace(-25.0 * sd, 25.0 * sd, 20001)

            def best(factor):
                v = (N * factor * np.exp(a)) ** 2 * 100.0 + LSB_DPS**2 / 12.0
                return np.max(-0.5 * n * (np.log(v) + power / v) - 0.5 * (a / sd) ** 2)

            return best(effect.params["factor"]) - best(1.0)

        self.ratios(ArwScale, lambda c: {"up": True}, ratio)

    def test_of_repeats_is_that_of_their_number_against_chance(self):
        values, asked = [], []
        for seed in range(self.SEEDS):
            context = quiet(Context(seed + 160, False, self.MINUTES))
            sigma = np.array([context.sigma_dps(axis) for axis in range(3)])
            # Noise so fine that hardly any repeat is by chance, or so coarse that most are.
            context.step_dps = float(np.mean(sigma)) / (40.0, 4.0)[seed % 2]
            effect = Stale(context, {"eps": 40.0 / context.n, "run_length": 0.0}, list("xyz"))
            asked.append(generate.evidence_of(context, [effect]))
            noise = np.round(stream(seed, "repeats").standard_normal((context.n, 3)) * sigma / context.step_dps)
            rows = effect.rows({"gx_dps": noise, "t_s": np.arange(context.n)}, stream(seed, "stale"))["gx_dps"]
            repeats = np.count_nonzero(np.all(np.diff(rows, axis=0) == 0.0, axis=1))
            chance = context.n * np.prod(context.step_dps / (np.sqrt(4.0 * np.pi) * sigma))
            values.append(repeats * np.log((40.0 + chance) / chance) - 40.0)
        off = np.subtract(values, asked)
        self.assertGreater(min(asked), 5.0)
        self.assertGreater(max(asked), 100.0)
        self.assertLess(abs(np.mean(off)), LIMIT * np.std(off, ddof=1) / np.sqrt(self.SEEDS))

    def test_of_heavy_tails(self):
        def ratio(context, effect, x, t, variance):
            z, nu = (x - x.mean()) / np.sqrt(variance), effect.params["nu"]
            student = (math.lgamma((nu + 1) / 2) - math.lgamma(nu / 2) - 0.5 * math.log(math.pi * (nu - 2))
                       - (nu + 1) / 2 * np.log1p(z**2 / (nu - 2)))
            return np.sum(student + 0.5 * z**2 + 0.5 * math.log(2 * math.pi))

        # Rounding makes a sample a little more normal: some per cent of the evidence.
        self.ratios(HeavyTail, lambda c: {}, ratio, bias=0.08)

    def test_of_a_level_that_changes(self):
        def ratio(context, effect, x, t, variance):
            late = t >= effect.params["at_s"]
            white = context.sensor.N[1] ** 2 * 100.0
            v = variance + np.where(late, white * (effect.params["factor"] ** 2 - 1.0), 0.0)
            # The other model has one level, free: the evidence beyond the mean level alone is asked for.
            mean = np.mean(x**2) - np.mean(x) ** 2
            x = x - x.mean()
            level = np.mean(v) / mean
            changed = -0.5 * np.sum(np.log(v / level) + x**2 * level / v)
            return changed + 0.5 * x.size * (np.log(mean) + 1.0) + self.level_nats(context, effect)

        self.ratios(VarianceChange, lambda c: {"at_s": 500.0, "ramp_s": 0.0, "up": True}, ratio)

    @staticmethod
    def level_nats(context, effect):
        """The part of the evidence that the mean level alone has, beyond the model's statement."""
        share = 1.0 - effect.params["at_s"] / context.duration_s
        mean = 1.0 + share * (effect.params["factor"] ** 2 - 1.0)
        return generate.evidence_of(context, [ArwScale(context, {"factor": float(np.sqrt(mean))}, effect.axes)])

    def test_of_noise_in_common(self):
        values, asked = [], []
        for seed in range(self.SEEDS):
            context = quiet(Context(seed + 80, False, self.MINUTES, temperature="drift"))
            for a in "xyz":
                context.model["axes"][a]["sd"] = {"N": 1e-6}
            effect = generate.at_strength(context, CommonMode, {"gain_x": 0.7, "gain_z": 1.0}, ["x", "z"], self.TARGET)
            asked.append(generate.evidence_of(context, [effect]))
            columns = record(context, [effect])
            x = np.array([columns["gx_dps"] - columns["gx_dps"].mean(), columns["gz_dps"] - columns["gz_dps"].mean()])
            own = np.diag(context.sensor.N[[0, 2]] ** 2 * 100.0 + LSB_DPS**2 / 12.0)
            gains = np.array([0.7, 1.0]) * effect.params["N_dps_per_sqrt_hz"] * 10.0
            both = own + np.outer(gains, gains)
            scatter = x @ x.T

            def log_likelihood(c):
                return -0.5 * (x.shape[1] * np.log(np.linalg.det(c)) + np.trace(np.linalg.solve(c, scatter)))

            values.append(log_likelihood(both) - log_likelihood(own))
        self.assertLess(abs(np.mean(values) - np.mean(asked)), LIMIT * np.sqrt(2.0 * self.TARGET / self.SEEDS) + 1.0)

    def test_of_a_gain_in_motion_beyond_what_the_model_states(self):
        values = []
        for seed in range(self.SEEDS):
            context = quiet(Context(seed + 20, True, 8.0))
            effect = generate.at_strength(context, ScaleFactor, {"each": [1.0]}, ["y"], self.TARGET)
            columns = record(context, [effect])
            reference = np.array([columns[f"ref_{a}_dps"] for a in "xyz"])
            late = context.slope()[1]
            M = np.array(context.model["M"])
            y = columns["gy_dps"] - M[1] @ reference
            variance = context.sensor.N[1] ** 2 * 100.0 + LSB_DPS**2 / 12.0 + 0.02**2 * (M[1] @ M[1])
            X = np.vstack([np.ones_like(y), context.slow.W, late, late * context.slow.t]) / np.sqrt(variance)
            prior = np.diag(np.array([0.0] + [2e-4] * 3 + [1e-4, 5e-5]))
            prior[1:, 1:] = np.diag(1.0 / np.diag(prior)[1:] ** 2)

            def best(residual):
                residual = residual / np.sqrt(variance)
                b = X @ residual
                return -0.5 * (residual @ residual - b @ np.linalg.solve(X @ X.T + prior, b))

            values.append(best(y - effect.params["eps"][0] * context.slow.W[1]) - best(y))
        # The true gain, delay and clock are drawn: they add to the scatter as their statement says.
        self.assertLess(abs(np.mean(values) - self.TARGET), LIMIT * np.sqrt(2.0 * self.TARGET / self.SEEDS) + 1.5)

    def test_of_a_step_on_a_walk_is_that_of_the_full_covariance(self):
        context = quiet(Context(7, False, 15.0), K=2e-4)
        context.model["sd_rel"]["K"] = 1e-6
        step = BiasStep(context, {"step_dps": [0.01], "at_s": 320.0}, ["x"])
        n = context.slow.t.size
        k = np.arange(1, n + 1, dtype=float)
        # Averages over a second of white noise and of a walk.
        covariance = (context.sensor.N[0] ** 2 + LSB_DPS**2 / 12.0 / 100.0) * np.eye(n) + 4e-8 * (
            np.minimum.outer(k, k) - 0.5 + np.eye(n) / 6.0)
        d = np.where(context.slow.t >= 320.0, 0.01, 0.0)
        one = np.ones(n)
        solved = np.linalg.solve(covariance, np.column_stack([d, one]))
        exact = 0.5 * (d @ solved[:, 0] - (one @ solved[:, 0]) ** 2 / (one @ solved[:, 1]))
        self.assertAlmostEqual(generate.evidence_of(context, [step]) / exact, 1.0, delta=0.05)

    def test_beside_others_is_what_no_size_of_theirs_explains(self):
        context = quiet(Context(8, False, self.MINUTES, temperature="drift"))
        for a in "xyz":
            context.model["axes"][a]["sd"] = {"N": 1e-6}
        ramp = RateRamp(context, {"ramp_dps_per_s": [4e-6]}, ["y"])
        slope = TempLinear(context, {"c1_dps_per_C": [0.004]}, ["y"])
        line = Tone(context, {"f_hz": 21.7, "amplitude_dps": 0.001, "phase_rad": [0.0]}, ["y"])
        t = np.arange(context.n) / 100.0
        variance = context.sensor.N[1] ** 2 * 100.0 + LSB_DPS**2 / 12.0
        y = 4e-6 * t
        X = np.column_stack([np.ones_like(t), context.temperature(t)])
        residual = y - X @ np.linalg.lstsq(X, y, rcond=None)[0]
        exact = 0.5 * residual @ residual / variance
        beside = generate.evidence_given_others(context, [ramp, slope, line], ramp)
        self.assertAlmostEqual(beside / exact, 1.0, delta=0.03)
        self.assertLess(beside, 0.7 * generate.evidence_of(context, [ramp]))
        # A line and a ramp have nothing in common.
        alone = generate.evidence_of(context, [line])
        self.assertAlmostEqual(generate.evidence_given_others(context, [ramp, slope, line], line) / alone, 1.0,
                               delta=0.02)

    def test_is_at_its_class_or_at_the_end_of_the_plausible_range(self):
        for name in ("heavy_tail", "spikes", "common_mode", "variance_change", "clock_rate", "latency", "dead_zone"):
            cls = generate.known_class(name)
            case = generate.world_for(generate.spec(5, [(name, "moderate")], cls.needs == "motion", 15.0))
            _, value = generate.draw_effect(generate.context_of(case), name, "moderate")
            low, high = generate.CLASSES["moderate"]
            self.assertTrue(low <= value <= high, f"{name} {value}")


class Sealed(unittest.TestCase):
    def test_every_effect_makes_a_recording_that_differs_from_the_same_without(self):
        for name, cls in {**CATALOGUE, **FOREIGN}.items():
            motion = cls.needs == "motion"
            case = generate.world_for(generate.spec(9, [(name, "clear")], motion, 5.0 if motion else 8.0))
            context = generate.context_of(case)
            effect, value = generate.draw_effect(context, name, "clear")
            self.assertGreater(value, 0.0, name)
            with_it, without = record(context, [effect]), record(context, [])
            self.assertEqual(list(with_it), list(without), name)
            self.assertTrue(all(np.all(np.isfinite(c)) for c in with_it.values()), name)
            # An effect in the samples acts on its own axes only.
            for a in "xyz":
                changed = not np.array_equal(with_it[f"g{a}_dps"], without[f"g{a}_dps"])
                if a not in effect.axes:
                    self.assertFalse(changed, f"{name} {a}")
            self.assertTrue(any(not np.array_equal(with_it[c], without[c]) for c in without), name)

    def test_truth_stands_in_its_own_directory_and_nothing_else_betrays_it(self):
        with tempfile.TemporaryDirectory() as directory:
            sealed = os.path.join(directory, "elsewhere")
            cases = generate.panel("small", None, 4, 1.0, 2.0)
            keys = set()
            for case_id, case in list(cases.items())[:6]:
                case = {**case, "minutes": 3.0}
                generate.write_case(case_id, case, directory, sealed)
                where = os.path.join(directory, "cases", case_id)
                self.assertEqual(sorted(os.listdir(where)), ["model.json", "recording.csv"])
                with open(os.path.join(where, "model.json")) as file:
                    model = json.load(file)
                keys.add(tuple(model))
                self.assertFalse({"effects", "truth", "seed"} & set(model))
                with open(os.path.join(sealed, case_id + ".json")) as file:
                    self.assertIn(json.load(file)["verdict"], answer_form.VERDICTS)
            self.assertEqual(len(keys), 1)
            self.assertEqual(sorted(os.listdir(directory)), ["cases", "elsewhere"])

    def test_numbers_of_cases_say_nothing_of_their_order_in_the_panel(self):
        cases = generate.panel("full", 1, 12, 120.0, 18.0)
        without = [i for i, case in enumerate(cases.values()) if not case["effects"]]
        # Those without effect were drawn last: of all runs of that many cases none holds them all.
        self.assertGreater(max(without) - min(without), 2 * len(without))
        self.assertNotEqual(list(cases), list(generate.panel("full", 1, 13, 120.0, 18.0)))

    def test_same_specification_makes_the_same_case(self):
        several = [("rtn", "clear"), ("tone", "moderate"), ("bias_step", "clear")]
        for effects in ([("rtn", "clear")], several):
            case = generate.spec(21, effects, False, 5.0)
            a, b = generate.make_case(case), generate.make_case(case)
            self.assertTrue(all(np.array_equal(a[0][c], b[0][c]) for c in a[0]))
            self.assertEqual(json.dumps(a[2]), json.dumps(b[2]))

    def test_many_are_three_to_six_of_different_families_whose_evidence_is_known_together(self):
        cases = generate.panel("many", 400, 3, 120.0, 18.0)
        self.assertEqual(len(cases), 400)
        self.assertEqual(sum(c["motion"] for c in cases.values()), 100)
        self.assertEqual({len(c["effects"]) for c in cases.values()}, {3, 4, 5, 6})
        drawn = {True: set(), False: set()}
        for case in cases.values():
            names = [name for name, _ in case["effects"]]
            self.assertEqual(len({generate.families(n) for n in names}), len(names))
            beside_filter = {"heavy_tail", "spikes", "variance_change", "temp_noise"} & {*names}
            self.assertFalse("lowpass" in names and beside_filter)
            self.assertFalse("clock_rate" in names and "tone" in names)
            drawn[case["motion"]] |= {*names}
            in_motion = sum(CATALOGUE[n].needs == "motion" for n in names)
            self.assertTrue(in_motion >= 2 if case["motion"] else in_motion == 0, names)
        self.assertEqual(drawn[True] & {"lowpass", "spikes", "heavy_tail", "temp_quadratic", "temp_lag", "temp_noise"},
                         set())
        self.assertEqual(drawn[True] | drawn[False], {*CATALOGUE})
        # Of effects that can be of any strength.
        asked = [c for case in cases.values() for name, c in case["effects"] if len(CATALOGUE[name].classes) == 3]
        for name, share in (("marginal", 0.15), ("moderate", 0.425), ("clear", 0.425)):
            sd = math.sqrt(share * (1.0 - share) / len(asked))
            self.assertLess(abs(asked.count(name) / len(asked) - share), LIMIT * sd, name)

    def test_of_many_none_hides_the_others_and_one_that_needs_a_sweep_has_it(self):
        coarse = [("quantization", "clear"), ("temp_noise", "clear"), ("temp_linear", "clear")]
        hidden = [("clock_jitter", "clear"), ("scale_factor", "clear"), ("dead_zone", "clear")]
        for seed in range(6):
            _, _, truth = generate.make_case(generate.spec(seed, coarse, False, 8.0))
            self.assertTrue(truth["many"] and not truth["pair"])
            self.assertEqual(truth["made"]["temperature"], "sweep")
            N = Sensor(stream(seed, "sensor"), draw_model(stream(seed, "model"), False), False).N
            grid = truth["effects"][0]
            noise_dps = min(N["xyz".index(a)] for a in grid["axes"]) * 10.0
            self.assertLess(grid["params"]["lsb_dps"], 1.2 * noise_dps)
            _, _, truth = generate.make_case(generate.spec(seed, hidden, True, 3.0))
            self.assertEqual(truth["effects"][0]["params"]["in_stamps"], 1)

    def test_text_holds_the_numbers_as_printf_would(self):
        rng = np.random.default_rng(1)
        columns = {"a": rng.normal(0.0, 300.0, 3000), "b": rng.normal(0.0, 1e-6, 3000), "t": np.arange(3000) / 100.0}
        columns["a"][:4] = [0.0, -0.4999994, 1e5, -99999.9999996]
        decimals = {"a": 6, "b": 5, "t": 3}
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, "x.csv")
            textfile.write(path, columns, decimals, rows_at_once=777)
            with open(path) as file:
                self.assertEqual(file.readline(), "a,b,t\n")
                lines = file.read().splitlines()
        for k, line in enumerate(lines):
            for text, name in zip(line.split(","), columns):
                self.assertAlmostEqual(float(text), columns[name][k], delta=0.5000001 * 10.0 ** -decimals[name])
                self.assertEqual(len(text.split(".")[1]), decimals[name])
                self.assertNotEqual(float(text) == 0.0 and text[0] == "-", True)
        self.assertEqual(len(lines), 3000)


def cause_of(effect, share, **change):
    """The true parameters, as a program gives them: those that differ between the axes axis by axis."""
    shared = {name: value for name, value in effect["params"].items() if not isinstance(value, list)}
    own = {a: {**shared, **{name: value[i] for name, value in effect["params"].items() if isinstance(value, list)}}
           for i, a in enumerate(effect["axes"])}
    return {"effect": effect["effect"], "sense": "recording_has", "score": 0.9, "tie_group": [effect["effect"]],
            "axes": effect["axes"], "where": {k: v for k, v in effect["where"].items() if k != "any"},
            "params": own[effect["axes"][0]], "sd": {}, "share": share, "share_lo": share, "share_hi": share,
            **({"params_by_axis": own} if len(shared) < len(effect["params"]) else {}), **change}


def answer_to(truth, closed=1.0, **change):
    """That closes a share of the gap by the true causes, and the rest by what has no name."""
    share = closed / max(len(truth["effects"]), 1)
    gap = {"value": 3.0, "floor": 1.0, "lo": 2.0, "hi": 4.0}
    named = {**gap, "value": math.sqrt(1.0 + (1.0 - closed) * 8.0), "lo": 0.5}
    return {"schema": "gyrolog-diagnosis/2", "verdict": truth["verdict"], "p_none": 0.001,
            "causes": [cause_of(e, share) for e in truth["effects"]], "unnamed": [], "left": [], "where": {},
            "gap_before": gap, "gap_named": named, "gap_after": {**gap, "value": 1.0, "lo": 0.5},
            "shrink": closed, "shrink_lo": closed - 0.05, "shrink_hi": closed + 0.05, "shrink_modelled": 1.0, **change}


class Judgement(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        _, cls.model, cls.truth = generate.make_case(generate.spec(31, [("temp_linear", "clear")], False, 30.0))

    def test_right_params_shrink_the_gap_wholly_and_wrong_ones_by_what_they_leave(self):
        answer = answer_to(self.truth)
        self.assertEqual(answer_form.complaints(answer), [])
        self.assertGreater(judge.Case(self.truth, self.model).shrink(answer, None)[0], 0.999)
        for own in answer["causes"][0]["params_by_axis"].values():
            own["c1_dps_per_C"] *= 0.8
        shrink, unread = judge.Case(self.truth, self.model).shrink(answer, None)
        self.assertAlmostEqual(shrink, 1.0 - 0.2**2, delta=0.002)
        self.assertEqual(unread, [])
        # A corrected model counts before what the causes say.
        entry = {k: self.truth["effects"][0][k] for k in ("effect", "axes", "params")}
        corrected = {**self.model, "effects": [entry]}
        self.assertGreater(judge.Case(self.truth, self.model).shrink(answer, corrected)[0], 0.999)

    def test_a_wrong_cause_shrinks_nothing_and_is_not_right(self):
        answer = answer_to(self.truth)
        answer["causes"][0] = {**cause_of(self.truth["effects"][0], 1.0), "effect": "arw_scale", "tie_group": [],
                               "params": {"factor": 1.1}}
        del answer["causes"][0]["params_by_axis"]
        self.assertLess(judge.Case(self.truth, self.model).shrink(answer, None)[0], 0.01)
        self.assertFalse(judge.names(answer["causes"][0], "temp_linear"))
        answer["causes"][0]["tie_group"] = ["arw_scale", "temp_linear", "rate_ramp"]
        self.assertTrue(judge.names(answer["causes"][0], "temp_linear"))
        answer["causes"][0]["tie_group"] += ["warmup"]
        self.assertFalse(judge.names(answer["causes"][0], "temp_linear"))

    def test_a_place_needs_the_key_that_matters_and_the_axes(self):
        effect = {"effect": "tone", "axes": ["x", "y"], "where": {"freq_hz": [39.98, 40.02], "axes": ["x", "y"]},
                  "nats_of_axis": {"x": 300.0, "y": 2.0}}

        def place(where, axes):
            return judge.place_right(effect, {"where": {}}, {"effect": "tone", "axes": axes, "where": where}, 7200.0)

        self.assertEqual(place({"freq_hz": [39.9, 40.1]}, ["x", "y"]), (True, True))
        self.assertEqual(place({"freq_hz": [39.9, 40.1]}, ["x"]), (False, True))
        self.assertEqual(place({"freq_hz": [39.9, 40.1]}, ["y"]), (False, False))
        self.assertEqual(place({"freq_hz": [38.0, 39.0]}, ["x", "y"]), (False, False))
        self.assertEqual(place({"freq_hz": [1.0, 49.0]}, ["x", "y"]), (False, False))
        self.assertEqual(place({}, ["x", "y"]), (False, False))

    def test_a_corrected_model_that_keeps_levels_fitted_to_the_effect_is_not_right(self):
        _, first, truth = generate.make_case(generate.spec(5, [("gauss_markov", "clear")], False, 15.0))
        fitted = {**first, "axes": {a: {**e, "N": 1.1 * e["N"]} for a, e in first["axes"].items()}}
        truth["refitted"] = True
        entry = {k: truth["effects"][0][k] for k in ("effect", "axes", "params")}
        answer = answer_to(truth)
        kept = judge.Case(truth, fitted).shrink(answer, {**fitted, "effects": [entry]})[0]
        mended = judge.Case(truth, fitted).shrink(answer, {**first, "effects": [entry]})[0]
        self.assertGreater(mended, 0.95)
        self.assertLess(kept, 0.9)

    def test_a_fit_to_the_very_recording_takes_up_what_it_can(self):
        case = generate.spec(6, [("temp_linear", "clear")], False, 30.0)
        context = generate.context_of(generate.world_for(case))
        effect, _ = generate.draw_effect(context, "temp_linear", "clear")
        model = refitted(context, record(context, [effect], "sister"))
        for axis, a in enumerate("xyz"):
            walk_there = model["axes"][a]["K"] / max(context.sensor.K[axis], 1e-6)
            self.assertLess(abs(model["axes"][a]["N"] / context.sensor.N[axis] - 1.0), 0.02)
            self.assertEqual(a in effect.axes, walk_there > 5.0, a)

    def test_a_program_that_fails_or_says_nothing_is_listed_and_counts_as_wrong(self):
        with tempfile.TemporaryDirectory() as directory:
            program = os.path.join(directory, "program")
            with open(program, "w") as file:
                file.write("#!/bin/sh\nexit 3\n")
            os.chmod(program, 0o755)
            cases = {"c1": generate.spec(1, [], False, 2.0), "c2": generate.spec(2, [("tone", "clear")], False, 2.0)}
            run.run(program, directory, cases, 1, False, {})
            self.assertFalse(os.path.exists(os.path.join(directory, "cases", "c1", "recording.csv")))
            _, figures = score.score(directory)
            self.assertEqual([r["problems"] for r in figures["invalid"]], [["exit 3", "no JSON"]] * 2)
            self.assertEqual(figures["false_alarms"]["hits"], 1)
            self.assertEqual(figures["by_class"]["clear"]["detected"]["of"], 1)
            self.assertEqual(figures["by_class"]["clear"]["detected"]["hits"], 0)
            with open(program, "a") as file:
                file.write("# another\n")
            with self.assertRaises(SystemExit):
                run.run(program, directory, cases, 1, False, {})

    def test_parameters_are_held_against_the_truth_in_their_stated_deviations(self):
        effect = {"effect": "bias_step", "axes": ["x", "z"], "params": {"step_dps": [0.10, -0.20], "at_s": 100.0}}
        own = {"x": {"step_dps": 0.11, "at_s": 97.0}, "z": {"step_dps": -0.20, "at_s": 97.0}}
        sd = {"step_dps": 0.005, "at_s": 2.0}
        cause = {"effect": "bias_step", "axes": ["x", "z"], "params": own["x"], "sd": sd, "params_by_axis": own,
                 "sd_by_axis": {"x": sd, "z": sd}}
        said = judge.deviations(effect, cause)
        self.assertEqual(sorted(name for name, _ in said), ["at_s", "step_dps", "step_dps"])
        self.assertEqual(sorted(round(off, 6) for _, off in said), [-1.5, 0.0, 2.0])
        # Said once for both axes, the sizes of which differ: only the time can be held against the truth.
        del cause["params_by_axis"], cause["sd_by_axis"]
        self.assertEqual(judge.deviations(effect, cause), [("at_s", -1.5)])
        line = {"effect": "tone", "axes": ["x"], "params": {"f_hz": 150.0, "amplitude_dps": 0.01, "phase_rad": [0.1]}}
        cause = {"effect": "tone", "axes": ["x"], "params": {"f_hz": 50.0, "amplitude_dps": 0.012, "phase_rad": 3.0},
                 "sd": {"f_hz": 1e-4, "amplitude_dps": 0.001, "phase_rad": 0.1}}
        self.assertEqual([(n, round(off, 6)) for n, off in judge.deviations(line, cause)], [("amplitude_dps", 2.0)])

    def test_chance_and_scores_are_held_against_what_came_true(self):
        table = {row["level"]: row for row in reliability.of_p([0.005] * 3 + [0.3] * 57 + [0.95] * 40)}
        self.assertEqual([table[p]["share"] for p in reliability.P_LEVELS], [0.03, 0.03, 0.03, 0.03, 0.6, 0.6, 0.6])
        self.assertAlmostEqual(table[0.01]["sds_off"], 0.02 / math.sqrt(0.01 * 0.99 / 100))
        self.assertAlmostEqual(table[0.9]["sds_off"], -10.0)
        scores = reliability.of_scores([(0.8, True), (0.9, True), (0.7, False), (1.0, True), (0.0, False)])
        self.assertAlmostEqual(scores["value"], (0.04 + 0.01 + 0.49) / 5)
        self.assertEqual([(b["from"], b["of"], round(b["right"], 3)) for b in scores["bins"]],
                         [(0.0, 1, 0.0), (0.7, 2, 0.5), (0.9, 1, 1.0), (0.97, 1, 1.0)])
        self.assertIsNone(reliability.of_scores([])["value"])


def scored(truth, model, answer, corrected=None):
    """(row, figures) of one answer. The tables are made as well."""
    with tempfile.TemporaryDirectory() as directory:
        for name in ("sealed", "answers", "cases/c1"):
            os.makedirs(os.path.join(directory, name))
        for name, content in (("sealed/c1.json", truth), ("cases/c1/model.json", model), ("answers/c1.json", answer),
                              ("answers/c1.model.json", corrected),
                              ("run.json", {"outcomes": {"c1": {"seconds": 1.0, "code": 0}}})):
            if content is not None:
                with open(os.path.join(directory, name), "w") as file:
                    json.dump(content, file)
        rows, figures = score.score(directory)
    for table in score.tables(figures):
        score.as_text(*table)
        score.as_markdown(*table)
    return rows[0], figures


class Form(unittest.TestCase):
    TRUTH = {"verdict": "known", "effects": [
        {"effect": "temp_linear", "axes": ["x"], "where": {"temperature": True}, "params": {"c1_dps_per_C": 0.02}},
        {"effect": "tone", "axes": ["z"], "where": {"freq_hz": [39.9, 40.1]}, "params": {"f_hz": 40.0}}]}

    def said(self, **change):
        return answer_form.complaints(answer_to(self.TRUTH, 0.6, **{"verdict": "partly", **change}))

    def test_answer_of_the_contract_has_none(self):
        self.assertEqual(self.said(), [])
        self.assertEqual(self.said(unnamed=[{"form": "density", "axes": ["z"], "where": {"freq_hz": [31.0, 31.8]},
                                             "share": 0.21}],
                                   left=[{"where": {"axes": ["z"], "time_s": [402, 409]}, "size": 2.1}]), [])
        # Without a gap there is nothing to be closed.
        self.assertEqual(self.said(verdict="none", causes=[], shrink=None, shrink_modelled=None), [])

    def test_each_key_that_is_not_the_contracts_is_named(self):
        for key in ("schema", "verdict", "p_none", "causes", "unnamed", "left", "where", "gap_before", "gap_named",
                    "gap_after", "shrink", "shrink_modelled"):
            self.assertEqual(self.said(**{key: None}), [key])
        self.assertEqual(answer_form.complaints([]), ["not an object"])
        self.assertEqual(self.said(schema="gyrolog-diagnosis/1"), ["schema"])
        self.assertEqual(self.said(p_none=float("nan")), ["p_none"])
        self.assertEqual(self.said(shrink_lo=0.7), ["shrink"])
        self.assertEqual(self.said(gap_named={"value": 2.0, "floor": 1.0, "lo": 2.1, "hi": 3.0}), ["gap_named"])
        self.assertEqual(self.said(unnamed=[{"form": "shape", "axes": ["w"], "where": {}, "share": None}]),
                         ["unnamed[0]: form", "unnamed[0]: axes", "unnamed[0]: share"])
        self.assertEqual(self.said(left=[{"where": {"time_s": [9, 4]}, "size": -1.0}]),
                         ["left[0]: size", "left[0]: where: time_s"])

    def test_each_part_of_a_cause_that_is_not_the_contracts_is_named(self):
        for part, values in {
                "effect": ["gremlins", None, ["tone"]], "sense": [None, "both"], "score": [1.1, True, "0.9"],
                "tie_group": [None, ["gremlins"], "tone"], "axes": [None, ["w"], ["x", "x"]],
                "params": [None, {"c1_dps_per_C": "0.02"}, {"c1_dps_per_C": float("inf")}],
                "sd": [None, {"c1_dps_per_C": -1.0}, {"other": 1.0}], "share": [None, 0.9],
                "where": [None]}.items():
            for value in values:
                answer = answer_to(self.TRUTH, 0.6, verdict="partly")
                answer["causes"][0][part] = value
                if part == "params":
                    answer["causes"][0]["sd"] = {}
                self.assertEqual(answer_form.complaints(answer), [f"causes[0]: {part}"], (part, value))
        for key, value in {"temperature": 1, "structure": "holes", "freq_hz": [2.0, 1.0], "tau_s": 3.0, "weather": True,
                           "axes": "x"}.items():
            answer = answer_to(self.TRUTH, 0.6, verdict="partly")
            answer["causes"][1]["where"] = {key: value}
            self.assertEqual(answer_form.complaints(answer), [f"causes[1]: where: {key}"])
        answer = answer_to(self.TRUTH, 0.6, verdict="partly")
        answer["causes"][0]["effect"] = "rrw_excess"
        self.assertEqual(answer_form.complaints(answer), ["causes[0]: sense"])
        answer["causes"][0]["sense"] = "model_has"
        self.assertEqual(answer_form.complaints(answer), [])

    def test_numbers_that_do_not_go_with_each_other_are_named(self):
        self.assertEqual(self.said(shrink=0.62), ["shrink is not what gap_named says"])
        self.assertEqual(self.said(shrink_modelled=0.9), ["shrink_modelled is not what gap_after says"])
        self.assertEqual(self.said(verdict="known", causes=[]), ["known without a cause"])
        answer = answer_to(self.TRUTH, 0.6, verdict="partly")
        answer["causes"][0].update(share=0.1, share_lo=0.1)
        self.assertEqual(answer_form.complaints(answer), ["causes are not ranked by share"])
        unlikely = answer_to(self.TRUTH, 0.6, verdict="partly")
        for cause in unlikely["causes"]:
            cause["score"] = 0.4
        self.assertEqual(answer_form.complaints(unlikely), ["partly without a cause of score 0.5"])
        self.assertEqual(answer_form.complaints({**unlikely, "verdict": "unexplained"}), [])
        self.assertEqual(answer_form.complaints(answer_to(self.TRUTH, 0.95, verdict="partly")),
                         ["partly, and less than a tenth is left"])
        self.assertEqual(self.said(verdict="unexplained"), ["unexplained, and a cause closes a tenth"])


class Several(unittest.TestCase):
    """Recordings with many effects, answered by hand and scored."""

    @classmethod
    def setUpClass(cls):
        effects = [("temp_linear", "clear"), ("tone", "moderate"), ("common_mode", "clear"), ("spikes", "moderate")]
        cls.columns, cls.model, cls.truth = generate.make_case(generate.spec(44, effects, False, 30.0))

    def scored(self, answer, corrected=None):
        row, figures = scored(self.truth, self.model, answer, corrected)
        self.assertEqual(row["problems"], [])
        return row, figures

    def test_truth_says_what_each_is_worth_beside_the_others(self):
        for e in self.truth["effects"]:
            self.assertGreater(e["nats"], 50.0)
            self.assertAlmostEqual(e["nats_given_others"] / e["nats"], 1.0, delta=0.25)

    def test_true_shares_add_up_and_the_shrink_of_a_part_is_what_the_rest_leaves(self):
        case = judge.Case(self.truth, self.model)
        causes = [cause_of(e, 0.25) for e in self.truth["effects"]]
        shares = [case.share(c) for c in causes]
        self.assertAlmostEqual(sum(shares), 1.0, delta=0.02)
        for k in range(len(causes)):
            rest = {"causes": causes[:k] + causes[k + 1 :]}
            self.assertAlmostEqual(case.shrink(rest, None)[0], 1.0 - shares[k], delta=0.02)
        # On some of its axes a cause has a part of it, on a wrong one none.
        several = [k for k, e in enumerate(self.truth["effects"]) if len(e["axes"]) > 1 and e["effect"] != "common_mode"]
        self.assertTrue(several)
        for k in several:
            parts = [case.share({**causes[k], "axes": [a]}) for a in self.truth["effects"][k]["axes"]]
            self.assertAlmostEqual(sum(parts), shares[k], delta=0.02)
            self.assertLess(max(parts), 0.95 * shares[k])
        # What the axes share is taken out whole.
        shared = next(k for k, e in enumerate(self.truth["effects"]) if e["effect"] == "common_mode")
        one_axis = {**causes[shared], "axes": self.truth["effects"][shared]["axes"][:1]}
        self.assertAlmostEqual(case.share(one_axis), shares[shared])
        self.assertEqual(case.share({**causes[0], "effect": "rate_ramp", "tie_group": []}), 0.0)

    def test_each_cause_names_one_effect_by_its_name_or_in_a_tie_on_axes_that_it_has(self):
        effects = self.truth["effects"]
        right = [cause_of(e, 0.25) for e in effects]
        self.assertEqual(judge.named_effects(right, effects), [0, 1, 2, 3])
        self.assertEqual(judge.named_effects([], effects), [])
        tied = {**right[0], "effect": "rate_ramp", "tie_group": ["rate_ramp", "temp_linear", "tone"]}
        self.assertEqual(len(judge.named_effects([tied], effects)), 1)
        # The tie goes to the effect that the other cause does not name, whichever of the two comes first.
        tied_everywhere = {**tied, "axes": []}
        other = {**right[0], "effect": "rtn", "tie_group": ["rtn", "temp_linear"]}
        for pair in ([tied_everywhere, right[0]], [right[0], tied_everywhere], [tied_everywhere, other],
                     [other, tied_everywhere]):
            self.assertEqual(judge.named_effects(pair, effects), [0, 1])
        self.assertEqual(judge.named_effects([{**tied, "tie_group": tied["tie_group"] + ["warmup"]}], effects), [])
        self.assertEqual(judge.named_effects([{**right[0], "sense": "model_has"}], effects), [])
        elsewhere = {**effects[0], "axes": ["x"], "nats_of_axis": {"x": 9.0}}
        self.assertFalse(judge.is_right({**right[0], "axes": ["y", "z"]}, elsewhere))
        self.assertTrue(judge.is_right({**right[0], "axes": ["x", "z"]}, elsewhere))

    def test_right_answer_has_the_best_figures(self):
        _, figures = self.scored(answer_to(self.truth))
        f = figures["many"]
        self.assertEqual((f["named"]["hits"], f["named"]["of"]), (4, 4))
        self.assertEqual((f["true"]["hits"], f["true"]["of"]), (4, 4))
        self.assertLess(f["shrink"]["error"], 0.001)
        self.assertEqual(f["shrink"]["coverage"]["hits"], 1)
        self.assertAlmostEqual(figures["reliability"]["many"]["value"], 0.01)
        self.assertEqual(figures["reliability"]["few"]["of"], 0)
        # None of it counts among recordings with one effect.
        self.assertEqual(figures["by_class"]["clear"]["named"]["of"] + figures["pairs"]["both"]["of"], 0)

    def test_wrong_answer_has_the_figures_that_it_earned(self):
        answer = answer_to(self.truth, 0.7, verdict="partly")
        false = {**answer["causes"][0], "effect": "rtn", "tie_group": ["rtn"], "params": {}, "score": 0.6}
        false.pop("params_by_axis", None)
        answer["causes"][0] = false
        entries = [{k: e[k] for k in ("effect", "axes", "params")} for e in self.truth["effects"][1:]]
        row, figures = self.scored(answer, {**self.model, "effects": entries})
        f, share = figures["many"], judge.Case(self.truth, self.model).share(cause_of(self.truth["effects"][0], 0.0))
        self.assertEqual((f["named"]["hits"], f["named"]["of"]), (3, 4))
        self.assertEqual((f["true"]["hits"], f["true"]["of"]), (3, 4))
        self.assertEqual(f["verdicts"], {"partly": 1})
        self.assertAlmostEqual(row["shrink"], 1.0 - share, delta=0.02)
        self.assertAlmostEqual(f["shrink"]["error"], abs(row["shrink"] - 0.7))
        self.assertAlmostEqual(figures["reliability"]["many"]["value"], (3 * 0.01 + 0.36) / 4)
        self.assertEqual(f["shrink"]["coverage"]["hits"], int(abs(row["shrink"] - 0.7) <= 0.055))
        self.assertEqual(next(e["false"] for e in f["by_effect"] if e["effect"] == "rtn"), 1)
        self.assertEqual(row["causes"][0]["true_share"], 0.0)
        # Only effects of 50 nats and more are asked for; beside the others one of them has less.
        effects = [dict(e) for e in self.truth["effects"]]
        effects[0]["nats"], effects[1]["nats_given_others"] = 49.0, 49.0
        f = scored({**self.truth, "effects": effects}, self.model, answer)[1]["many"]
        self.assertEqual([(f[key]["hits"], f[key]["of"]) for key in ("named", "named_beside_others", "named_weaker")],
                         [(3, 3), (2, 3), (0, 1)])
        slope = next(e for e in f["by_effect"] if e["effect"] == "temp_linear")
        self.assertEqual((slope["named"]["of"], slope["named_weaker"]["of"]), (0, 1))
        # Called none, it names nothing, whatever it lists.
        _, figures = self.scored({**answer, "verdict": "none"})
        self.assertEqual(figures["many"]["named"]["hits"], 0)
        self.assertEqual(figures["reliability"]["many"]["of"], 0)


class Halves(unittest.TestCase):
    """What a verdict `partly` counts for, and a name that the contract has and the catalogue here has not."""

    @classmethod
    def setUpClass(cls):
        cls.made = {name: generate.make_case(generate.spec(31, [(name, "clear")], False, 8.0))[1:]
                    for name in ("tone", "resonance", "sawtooth")}

    def figures_of(self, truth_of, verdict, effect):
        model, truth = self.made[truth_of]
        answer = answer_to(truth, 0.6, verdict=verdict)
        answer["causes"] = [cause_of({**truth["effects"][0], "effect": effect, "params": {"f_hz": 1.0}}, 0.05)]
        row, figures = scored(truth, model, answer)
        self.assertEqual(row["problems"], [])
        return figures

    def test_right_cause_of_a_part_is_half_right(self):
        for verdict, effect, named, half in (("known", "tone", 1, 0), ("partly", "tone", 0, 1), ("known", "rtn", 0, 0),
                                             ("partly", "rtn", 0, 0), ("unexplained", "tone", 0, 0)):
            figures = self.figures_of("tone", verdict, effect)["by_class"]["clear"]
            self.assertEqual((figures["named"]["hits"], figures["half"]["hits"]), (named, half), (verdict, effect))
            self.assertEqual(figures["named"]["of"], 1)

    def test_foreign_effect_is_unexplained_or_what_the_contract_calls_it(self):
        for truth_of, verdict, effect, right, wrong, half in (
                ("resonance", "unexplained", "rtn", 1, 0, 0), ("resonance", "known", "narrowband", 1, 0, 0),
                ("resonance", "known", "tone", 0, 1, 0), ("resonance", "partly", "tone", 0, 0, 1),
                ("sawtooth", "known", "narrowband", 0, 1, 0), ("sawtooth", "partly", "warmup", 0, 0, 1),
                ("sawtooth", "unexplained", "warmup", 1, 0, 0)):
            figures = self.figures_of(truth_of, verdict, effect)
            said = (figures["foreign"]["clear"]["unexplained"]["hits"], figures["foreign_misnamed"]["hits"],
                    figures["foreign_half_misnamed"]["hits"])
            self.assertEqual(said, (right, wrong, half), (truth_of, verdict, effect))


class RealHalves(unittest.TestCase):
    """The distance by which halves.py holds simulations against a recording."""

    RATE_HZ, ROWS, SIMULATIONS = 100.0, 4096, 24

    def measured(self, seed, scale=1.0, change=None):
        rates_dps = scale * np.random.default_rng(seed).standard_normal((self.ROWS, 3))
        return halves.measures(rates_dps if change is None else change(rates_dps), self.RATE_HZ)

    def gap(self, recording, **of_simulations):
        return halves.gap_squares(recording, [self.measured((7, k), **of_simulations)
                                              for k in range(self.SIMULATIONS)])

    def test_of_the_true_model_nothing_is_left(self):
        totals = [halves.total(self.gap(self.measured((8, k)))) for k in range(40)]
        self.assertLess(abs(np.mean(totals)), LIMIT * np.std(totals, ddof=1) / math.sqrt(len(totals)))

    def test_noise_of_twice_the_size_is_six_decibels_off(self):
        squares = self.gap(self.measured((8, 0), scale=2.0))
        for family in ("density", "allan"):
            self.assertAlmostEqual(math.sqrt(squares[family]), 20.0 * math.log10(2.0), delta=1.0)
        self.assertGreater(squares["density"], 10.0 * abs(squares["autocorrelation"]))

    def test_each_family_sees_what_it_is_for(self):
        def repeated(x):
            return np.where(np.arange(len(x))[:, None] % 10 == 9, np.roll(x, 1, axis=0), x)

        def shared(x):
            return x + x[:, :1]

        def swelling(x):
            return x * (1.0 + 0.8 * np.sin(2.0 * np.pi * np.arange(len(x))[:, None] / len(x)))

        def drifting(x):
            return x + np.linspace(-1.0, 1.0, len(x))[:, None]

        def smooth(x):
            return 0.5 * (x + np.roll(x, 1, axis=0))

        def spiky(x):
            return np.where(np.arange(len(x))[:, None] % 50 == 0, 8.0 * x, x)
        for family, change in (("repeats", repeated), ("between_axes", shared), ("level", swelling),
                               ("course", drifting), ("autocorrelation", smooth), ("tails", spiky)):
            squares = self.gap(self.measured((8, 1), change=change))
            none = self.gap(self.measured((8, 1)))
            self.assertGreater(squares[family], max(4.0, 10.0 * abs(none[family])), family)


class Units(unittest.TestCase):
    """Units of several effects, recorded twice."""

    NAMES = ["tone", "narrowband", "stale", "arw_scale", "rrw_missing", "temp_linear", "bumps", "quantization"]

    @classmethod
    def setUpClass(cls):
        cls.unit = generate.spec(77, [(name, "of a unit") for name in cls.NAMES], False, 6.0)
        cls.made = units.Unit(cls.unit)
        cls.first, cls.second = cls.made.first(), cls.made.second()
        cls.model, cls.truth = cls.made.model(), cls.made.truth()

    def test_have_six_to_nine_effects_at_most_one_of_a_group(self):
        cases = units.panel(300, 3, (15.0, 30.0))
        counts = [len(c["effects"]) for c in cases.values()]
        self.assertEqual({*counts}, {6, 7, 8, 9})
        drawn = set()
        for case in cases.values():
            names = {name for name, _ in case["effects"]}
            self.assertEqual(len(names), len(case["effects"]))
            self.assertTrue(all(len(names & {*of}) <= 1 for _, of in units.GROUPS))
            self.assertTrue(15.0 <= case["minutes"] <= 30.0 and not case["motion"])
            drawn |= names
        self.assertEqual(drawn, {name for _, of in units.GROUPS for name in of})

    def test_model_has_white_noise_and_a_bias_only_and_tells_nothing_of_the_truth(self):
        self.assertTrue(all({*axis} == {"N", "bias"} for axis in self.model["axes"].values()))
        self.assertNotIn("effects", self.model)
        self.assertFalse({"B", "K"} & {*self.model["sd_rel"]})
        self.assertEqual(self.model["lsb_dps"], 0.0)  # the unit's own step is one of its effects
        with tempfile.TemporaryDirectory() as directory:
            units.write_unit("u01", {**self.unit, "minutes": 2.0}, directory)
            self.assertEqual({*os.listdir(os.path.join(directory, "u01"))}, {"first.csv", "second.csv", "white.json"})
            self.assertEqual(os.listdir(os.path.join(directory, "sealed")), ["u01.json"])

    def test_second_recording_has_the_same_constants_and_nothing_else_of_the_first(self):
        effects = {e["effect"]: e for e in self.truth["effects"]}
        self.assertEqual([e.name for e in self.made.again], [name for name in self.NAMES if name != "bumps"])
        steps = [np.diff(columns["gx_dps"]) for columns in (self.first, self.second)]
        self.assertAlmostEqual(np.mean(steps[0] == 0.0), np.mean(steps[1] == 0.0), delta=0.01)
        self.assertLess(abs(np.corrcoef(*steps)[0, 1]), 0.03)
        self.assertGreater(np.abs(self.first["temp_C"] - self.second["temp_C"]).max(), 0.3)
        self.assertLess(abs(self.first["temp_C"][0] - self.second["temp_C"][0]), 1.5)
        for axis in effects["temp_linear"]["axes"]:
            c1 = effects["temp_linear"]["params"]["c1_dps_per_C"][effects["temp_linear"]["axes"].index(axis)]
            slopes = [np.polyfit(c["temp_C"], c[f"g{axis}_dps"], 1)[0] for c in (self.first, self.second)]
            self.assertLess(abs(slopes[0] - slopes[1]), 0.3 * abs(c1) + 0.003)

    def test_lines_wander_and_nobody_touches_the_bench_again(self):
        context = generate.context_of(self.unit)
        rng = stream(1, "wandered")
        tone = Tone(context, {"f_hz": 20.0, "amplitude_dps": 0.1, "phase_rad": [0.0]}, ["x"])
        off = np.array([units.wandered(tone, context, rng).params["f_hz"] / 20.0 - 1.0 for _ in range(400)])
        self.assertAlmostEqual(np.std(off) / units.WANDERED_REL, 1.0, delta=LIMIT / np.sqrt(800.0))
        self.assertEqual(tone.params["f_hz"], 20.0)
        bumps = Bumps(context, {"size_dps": 2.0, "count": 2, "f_hz": 11.0, "decay_s": 0.2}, list("xyz"))
        self.assertIsNone(units.wandered(bumps, context, rng))
        slope = TempLinear(context, {"c1_dps_per_C": [0.1], "reference_C": 25.0}, ["x"])
        self.assertEqual(units.wandered(slope, context, rng).params, slope.params)

    def test_unit_itself_closes_the_gap_and_its_first_model_does_not(self):
        plain = generate.context_of(self.made.made)
        white = [units.measured(record(units.white_only(plain), [], f"white {k}")) for k in range(8)]
        gap = halves.total(halves.gap_squares(units.measured(self.second), white))
        self.assertGreater(gap, 10.0)
        self.assertLess(abs(halves.total(units.gap_of_unit(self.made, 8))), 0.2 * gap)

    def test_figures_are_those_that_an_answer_earned(self):
        strong = [dict(e, nats=max(e["nats"], 100.0)) for e in self.truth["effects"]]
        strong[0]["nats"] = 99.0
        truth = {**self.truth, "effects": strong}
        causes = [cause_of({**e, "effect": "disturbance" if e["effect"] == "bumps" else e["effect"]}, 0.125)
                  for e in strong]
        causes[1] = {**causes[1], "effect": "rtn", "tie_group": ["rtn"], "params": {}}
        causes[1].pop("params_by_axis", None)
        squares = {"white": {"density": 100.0, "allan": 300.0}, "analyze": {"density": 100.0, "allan": 100.0},
                   "named": {"density": 10.0, "allan": 6.0}, "unnamed": {"density": 1.0, "allan": 1.0},
                   "unit": {"density": 0.0, "allan": 0.0}}
        answer = {**answer_to(truth), "causes": causes}
        row = units.judged("u01", truth, {"answer": answer, "gap_squares": squares})
        self.assertEqual(row["problems"], [])
        f = units.figures([row])
        count = len(strong)
        self.assertEqual((f["named"]["hits"], f["named"]["of"]), (count - 2, count - 1))
        self.assertEqual((f["named_weaker"]["hits"], f["named_weaker"]["of"]), (1, 1))
        self.assertEqual((f["true"]["hits"], f["true"]["of"]), (count - 1, count))
        self.assertAlmostEqual(row["closed"]["analyze"], 0.5)
        self.assertAlmostEqual(row["closed"]["named"], 0.96)
        self.assertEqual((f["closed"]["named"]["reached"], f["closed"]["analyze"]["reached"]), (1, 0))
        text = "\n".join(score.as_text(*table) for table in units.tables([row]))
        self.assertIn(f"**{strong[1]['effect']}", text)
        self.assertIn("rtn", text)
        # An answer that is none names nothing, and still has its gap.
        f = units.figures([units.judged("u01", truth, {"answer": {"schema": "other", "causes": []},
                                                       "gap_squares": squares})])
        self.assertEqual(f["named"]["hits"], 0)


if __name__ == "__main__":
    unittest.main(testRunner=unittest.TextTestRunner(stream=sys.stdout, verbosity=1))
