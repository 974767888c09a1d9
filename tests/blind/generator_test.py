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

import evidence
import generate
import judge
import run
import score
import textfile
from effects import (
    CATALOGUE, ArwScale, BiasStep, CommonMode, GaussMarkov, HeavyTail, Lowpass, RateRamp, Rtn, ScaleFactor, TempLinear,
    Tone, VarianceChange)
from foreign import FOREIGN, SkewedNoise
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

    def test_is_at_its_class_or_at_the_end_of_the_plausible_range(self):
        for name in ("heavy_tail", "spikes", "common_mode", "variance_change", "clock_rate", "latency", "dead_zone"):
            cls = generate.known_class(name)
            case = generate.world_for(generate.spec(5, [(name, "moderate")], cls.needs == "motion", 15.0))
            _, value = generate.draw_effect(generate.context_of(case), name, "moderate")
            self.assertTrue(generate.in_class(value, "moderate"), f"{name} {value}")


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
                    self.assertIn(json.load(file)["verdict"], judge.VERDICTS)
            self.assertEqual(len(keys), 1)
            self.assertEqual(sorted(os.listdir(directory)), ["cases", "elsewhere"])

    def test_numbers_of_cases_say_nothing_of_their_order_in_the_panel(self):
        cases = generate.panel("full", 1, 12, 120.0, 18.0)
        without = [i for i, case in enumerate(cases.values()) if not case["effects"]]
        # Those without effect were drawn last: of all runs of that many cases none holds them all.
        self.assertGreater(max(without) - min(without), 2 * len(without))
        self.assertNotEqual(list(cases), list(generate.panel("full", 1, 13, 120.0, 18.0)))

    def test_same_specification_makes_the_same_case(self):
        case = generate.spec(21, [("rtn", "clear")], False, 5.0)
        a, b = generate.make_case(case), generate.make_case(case)
        self.assertTrue(all(np.array_equal(a[0][c], b[0][c]) for c in a[0]))
        self.assertEqual(json.dumps(a[2]), json.dumps(b[2]))

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


def answer_to(truth, **change):
    causes = [{"effect": e["effect"], "score": 0.9, "tie_group": [], "axes": e["axes"], "where": e["where"],
               "params": e["params"], "sd": {}, "shrink_alone": 1.0} for e in truth["effects"]]
    gap = {"value": 3.0, "floor": 1.0, "lo": 2.0, "hi": 4.0}
    return {"schema": "gyrolog-diagnosis/1", "verdict": truth["verdict"], "p_none": 0.001, "causes": causes,
            "where": {}, "gap_before": gap, "gap_after": gap, "shrink": 1.0, "shrink_lo": 0.9, "shrink_hi": 1.0,
            **change}


class Judgement(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        _, cls.model, cls.truth = generate.make_case(generate.spec(31, [("temp_linear", "clear")], False, 30.0))

    def test_right_params_shrink_the_gap_wholly_and_wrong_ones_by_what_they_leave(self):
        answer = answer_to(self.truth)
        self.assertEqual(judge.complaints(answer), [])
        self.assertGreater(judge.true_shrink(self.truth, self.model, answer, None)[0], 0.999)
        answer["causes"][0]["params"] = {
            **self.truth["effects"][0]["params"],
            "c1_dps_per_C": [0.8 * c for c in self.truth["effects"][0]["params"]["c1_dps_per_C"]]}
        shrink, unread = judge.true_shrink(self.truth, self.model, answer, None)
        self.assertAlmostEqual(shrink, 1.0 - 0.2**2, delta=0.002)
        self.assertEqual(unread, [])
        # The same, axis by axis, as a program gives what differs between them; no other params are read then.
        effect = self.truth["effects"][0]
        answer["causes"][0]["params_by_axis"] = {
            a: {"c1_dps_per_C": c} for a, c in zip(effect["axes"], effect["params"]["c1_dps_per_C"])}
        self.assertGreater(judge.true_shrink(self.truth, self.model, answer, None)[0], 0.999)

    def test_a_wrong_cause_shrinks_nothing_and_is_not_right(self):
        answer = answer_to(self.truth)
        answer["causes"][0].update(effect="arw_scale", params={"factor": 1.1})
        self.assertLess(judge.true_shrink(self.truth, self.model, answer, None)[0], 0.01)
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
        kept = judge.true_shrink(truth, fitted, answer, {**fitted, "effects": [entry]})[0]
        mended = judge.true_shrink(truth, fitted, answer, {**first, "effects": [entry]})[0]
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

    def test_malformed_answers_are_named(self):
        answer = answer_to(self.truth, p_none=float("nan"))
        self.assertEqual(judge.complaints(answer), ["p_none"])
        self.assertEqual(judge.complaints([]), ["not an object"])
        self.assertIn("known without a cause", judge.complaints(answer_to(self.truth, causes=[])))
        self.assertIn("shrink", judge.complaints(answer_to(self.truth, shrink=None)))


if __name__ == "__main__":
    unittest.main(testRunner=unittest.TextTestRunner(stream=sys.stdout, verbosity=1))
