#!/usr/bin/env python3
"""Makes sealed cases for the diagnosis of the sim-to-real gap.

A case is DIR/cases/ID/{recording.csv, model.json}; what was put into it stands in SEALED/ID.json, and nowhere else.
The IDs are shuffled numbers. Written independently of the program: nothing here calls it or shares its code.

Usage: generate.py DIR [--sealed SEALED] [--panel small|full|none|still|motion|many] [--count N] [--seed N]
                   [--minutes M] [--motion-minutes M] [--effect NAME]... [--class NAME]... [--list]
"""

import argparse
import json
import os
import sys

import numbers_or_skip  # noqa: F401  first: it may start another interpreter
import numpy as np

import textfile
from effects import CATALOGUE
from evidence import Description, nats
from foreign import FOREIGN
from sensor import Context, record, refitted, stream

TARGETS = {"marginal": (16.0, 34.0), "moderate": (74.0, 240.0), "clear": (850.0, 4000.0)}
CLASSES = {"marginal": (15.0, 35.0), "moderate": (70.0, 250.0), "clear": (800.0, np.inf)}
# Effects that a fit of N, B and K to the very recording cannot take up.
REFITTED = [
    "gauss_markov", "rtn", "temp_linear", "temp_quadratic", "temp_lag", "rate_ramp", "warmup", "bias_step", "tone",
    "heavy_tail", "spikes", "variance_change", "temp_noise", "common_mode", "lowpass"]


def known_class(name):
    return CATALOGUE.get(name) or FOREIGN[name]


def class_of(value):
    """The class that the evidence is in, or the nearest on a logarithmic scale."""
    if value < 49.0:
        return "marginal"
    return "moderate" if value < 447.0 else "clear"


def description(effects):
    out = Description()
    for e in effects:
        e.describe(out)
    return out


def evidence_of(context, effects, refit=False):
    """refit: the model's levels are those of a fit to the effect, so the true description keeps the true ones."""
    free = all(getattr(e, "free", False) for e in effects)
    return nats(context, description(effects), Description(), free=free, perfect=refit)


def evidence_given_others(context, effects, effect, refit=False):
    """What is lost if the effect alone is left out of the true description, and the sizes of the others' means are
    fitted again."""
    free = all(getattr(e, "free", False) for e in effects)
    others = [e for e in effects if e is not effect]
    beside = {}
    for e in others:
        for axis, series in description([e]).mean.items():
            beside.setdefault(axis, []).append(series)
    return nats(context, description(effects), description(others), free=free, perfect=refit, beside=beside)


def own_evidence(context, effect, axis, refit):
    """What the effect is worth on one of its axes, were it on no other; of what axes share: what is lost without it."""

    def on(axes):
        return float(evidence_of(context, [effect.only_on(axes)], refit))

    if not effect.shared:
        return on([axis])
    others = [a for a in effect.axes if a != axis]
    return on(effect.axes) - (on(others) if len(others) > 1 else 0.0)


def draw_axes(rng, cls):
    if cls.whole:
        return list("xyz")
    count = rng.choice([1, 2, 3], p=[0.35, 0.2, 0.45])
    count = max(int(count), cls.least_axes)
    return ["xyz"[i] for i in sorted(rng.choice(3, count, replace=False))]


def at_strength(context, cls, shape, axes, target):
    """The effect whose evidence is the target, or the end of its plausible range: bisection in the logarithm."""

    def made(strength):
        return cls(context, cls.to_params(shape, strength), axes)

    low, high = cls.range(context, shape)
    if low == high:
        return made(low)
    if evidence_of(context, [made(high)]) <= target:
        return made(high)
    if evidence_of(context, [made(low)]) >= target:
        return made(low)
    low, high = np.log(low), np.log(high)
    nearest = (np.inf, None)
    for _ in range(18):
        middle = 0.5 * (low + high)
        effect = made(np.exp(middle))
        value = evidence_of(context, [effect])
        off = abs(np.log(value / target)) if value > 0.0 else np.inf
        if off < nearest[0]:
            nearest = (off, effect)
        if off < 0.02:
            break
        low, high = (middle, high) if value < target else (low, middle)
    return nearest[1] or made(np.exp(high))


def draw_effect(context, name, strength_class, salt="", beside_others=False):
    """(effect, its evidence). beside_others: only such as leave a meaning to other effects of the recording."""
    return draw_between(context, name, TARGETS[strength_class], CLASSES[strength_class], strength_class, salt,
                        beside_others=beside_others)


def draw_between(context, name, targets, accepted, *path, beside_others=False):
    """Likewise, of evidence between two bounds in nats that are asked for, and two that are accepted."""
    cls = known_class(name)
    for attempt in range(64):
        rng = stream(context.seed, "effect", name, *path, attempt)
        axes = draw_axes(rng, cls)
        shape = cls.shape(rng, context, axes)
        low, high = targets
        target = float(np.exp(rng.uniform(np.log(low), np.log(high))))
        effect = at_strength(context, cls, shape, axes, target)
        if beside_others and effect.drowns_others():
            continue
        value = evidence_of(context, [effect])
        # After eight tries it is as strong as it can be.
        if accepted[0] <= value <= accepted[1] or attempt >= 7:
            return effect, value
    raise ValueError(f"no {name} that leaves a meaning to others, seed {context.seed}")


def context_of(spec, model=None):
    """The sensor and its world, from the part of a truth that says how they were made."""
    return Context(spec["seed"], spec["motion"], spec["minutes"], model=model, temperature=spec.get("temperature"),
                   fast=spec.get("fast"))


def world_for(spec):
    """Temperature and rates that the effects of the case need."""
    rng = stream(spec["seed"], "need")
    spec = dict(spec)
    for name, _ in spec["effects"]:
        cls = known_class(name)
        if cls.temperature == "sweep":
            spec["temperature"] = "sweep"
        elif cls.temperature and spec.get("temperature") != "sweep":
            spec["temperature"] = str(rng.choice(["drift", "sweep"]))
        if cls.fast:
            spec["fast"] = max(cls.fast, float(spec.get("fast") or 0.0))
    return spec


def truth_of(context, effects, e, value, refit=False):
    """Of one of the effects of a recording, whose evidence alone is the value."""
    return {
        "effect": e.name, "axes": e.axes, "where": {**e.where(), "axes": e.axes}, "params": e.params,
        "nats": round(float(value), 2),
        "nats_given_others": round(float(evidence_given_others(context, effects, e, refit)), 2),
        "class": class_of(value),
        "nats_of_axis": {} if e.whole else {a: round(own_evidence(context, e, a, refit), 2) for a in e.axes},
    }


def make_case(spec):
    """(columns, model, truth) of a specification: seed, motion, minutes, effects [(name, class)], refitted."""
    spec = world_for(spec)
    context = context_of(spec)
    many = len(spec["effects"]) > 2
    drawn = [draw_effect(context, name, c, i, many) for i, (name, c) in enumerate(spec["effects"])]
    effects = [e for e, _ in drawn]
    values = [v for _, v in drawn]
    if spec.get("refitted"):
        # Another recording of the same unit that has the effect too, fitted as if it had not.
        sister = Context(spec["seed"], spec["motion"], spec["minutes"], temperature=spec.get("temperature"))
        model = refitted(sister, record(sister, effects, "sister"))
        context = context_of(spec, model=model)
        values = [evidence_of(context, [e], True) for e in effects]
        for attempt in range(12):
            weak = [i for i, (_, c) in enumerate(spec["effects"]) if values[i] < CLASSES[c][0]]
            if not weak:
                break
            # The fit took up too much of it: another draw.
            for i in weak:
                effects[i], _ = draw_effect(sister, *spec["effects"][i], f"{i} again {attempt}")
            model = refitted(sister, record(sister, effects, f"sister {attempt}"))
            context = context_of(spec, model=model)
            values = [evidence_of(context, [e], True) for e in effects]
        for e in effects:
            e.context = context
    for e in effects:
        e.prepare(context.model)
    columns = record(context, effects)
    truth = {
        "verdict": "none",
        "effects": [],
        "foreign": False,
        "pair": len(effects) == 2,
        "many": many,
        "refitted": bool(spec.get("refitted")),
        "made": {k: spec.get(k) for k in ("seed", "motion", "minutes", "temperature", "fast")},
    }
    for (name, asked), e, value in zip(spec["effects"], effects, values):
        truth["verdict"] = "known" if name in CATALOGUE else "unexplained"
        truth["foreign"] = name not in CATALOGUE
        truth["effects"].append({**truth_of(context, effects, e, value, truth["refitted"]), "asked": asked})
    return columns, context.model, truth


def decimals_of(columns):
    return {name: 3 if name == "temp_C" else 5 if name.startswith(("ref_", "a")) else 6 for name in columns}


# ------------------------------------------------------------------ panels


def spec(seed, effects, motion, minutes, **more):
    return {"seed": int(seed), "effects": effects, "motion": bool(motion), "minutes": minutes, **more}


def moves(rng, name):
    needs = known_class(name).needs
    return needs == "motion" or (needs == "both" and bool(rng.random() < 0.5))


def families(name):
    return known_class(name).family


def draw_pair(rng, motion):
    names = [n for n, c in CATALOGUE.items() if c.needs in (("motion", "both") if motion else ("still", "both"))]
    # What corrupts the stamps or the codes is checked alone.
    names = [n for n in names if families(n) != "structure"]
    while True:
        a, b = rng.choice(names, 2, replace=False)
        if families(a) != families(b):
            return [(str(a), str(rng.choice(["moderate", "clear"]))), (str(b), str(rng.choice(["moderate", "clear"])))]


# Effects that need no motion but whose evidence holds beside a reference: there the noise of a sample is more than the
# sensor's own, which tails and spikes are measured by, and the temperature makes no sweep.
BESIDE_MOTION = ("white", "slow", "line", "drift", "level", "temperature")
# What it takes off the motion is a thousand times the evidence of anything beside it.
NOT_IN_MOTION = ("lowpass",)
MOTION_FAMILIES_LEAST = 2
MARGINAL_SHARE = 0.15  # of the effects of a recording with many
MOTION_EVERY = 4  # of the recordings with many


def names_beside(motion):
    """By family, the effects that a recording with many may have."""
    out = {}
    for name, cls in CATALOGUE.items():
        if motion:
            still = cls.needs == "still" and cls.family in BESIDE_MOTION and cls.temperature != "sweep"
            fits = (cls.needs != "still" or still) and name not in NOT_IN_MOTION
        else:
            fits = cls.needs != "motion"
        if fits:
            out.setdefault(cls.family, []).append(name)
    return out


def keep_apart(names):
    kinds = {n: {n, families(n)} for n in names}
    return any(kinds[b] & set(known_class(a).apart_from) for a in names for b in names)


def draw_many(rng, motion):
    """Three to six effects of different families. Tails and spikes are left out in motion, and what `keep_apart` says;
    losses, a clock and its jitter that the stamps hide, and a grid coarser than the noise, in draw_effect."""
    by_family = names_beside(motion)
    of_motion = [f for f, names in by_family.items() if f != "structure" and
                 any(known_class(n).needs == "motion" for n in names)]
    while True:
        chosen = rng.choice(sorted(by_family), rng.integers(3, 7), replace=False)
        names = [str(rng.choice(by_family[family])) for family in chosen]
        if keep_apart(names) or (motion and len(set(chosen) & set(of_motion)) < MOTION_FAMILIES_LEAST):
            continue
        out = []
        for name in names:
            classes = known_class(name).classes
            strong = [c for c in classes if c != "marginal"]
            marginal = "marginal" in classes and rng.random() < MARGINAL_SHARE
            out.append((name, "marginal" if marginal else str(rng.choice(strong))))
        return out


def many_panel(rng, count, minutes, motion_minutes):
    out = []
    for i in range(count):
        motion = i % MOTION_EVERY == MOTION_EVERY - 1
        out.append(spec(rng.integers(1, 2**31), draw_many(rng, motion), motion, motion_minutes if motion else minutes))
    return out


def full_panel(rng, count, minutes, motion_minutes, none):
    """`count` cases of each effect and class, and in proportion foreign, pairs and refitted models."""
    out = []

    def add(effects, motion, **more):
        out.append(spec(rng.integers(1, 2**31), effects, motion, motion_minutes if motion else minutes, **more))

    for name, cls in CATALOGUE.items():
        for c in cls.classes:
            for _ in range(count):
                add([(name, c)], moves(rng, name))
    for name, cls in FOREIGN.items():
        for c in cls.classes:
            for _ in range(count):
                add([(name, c)], moves(rng, name))
    for i in range(15 * count):
        motion = i % 3 == 2
        add(draw_pair(rng, motion), motion)
    for i in range(5 * count):
        name = str(rng.choice(REFITTED))
        c = str(rng.choice([k for k in CATALOGUE[name].classes if k != "marginal"]))
        add([(name, c)], False, refitted=True)
    for i in range(none):
        add([], i % 5 == 4)
    return out


SMALL = [  # effect, class, motion
    ([], False), ([], False), ([], True), ([("arw_scale", "clear")], False), ([("tone", "moderate")], False),
    ([("temp_linear", "clear")], False), ([("bias_step", "clear")], False), ([("gauss_markov", "clear")], False),
    ([("stale", "clear")], False), ([("misalignment", "clear")], True), ([("latency", "moderate")], True),
    ([("tone", "clear"), ("bias_step", "clear")], False), ([("resonance", "clear")], False),
    ([("noise_bursts", "clear")], False),
]


def panel(kind, count, seed, minutes, motion_minutes, only_effects=None, only_classes=None, none=None):
    rng = np.random.default_rng(seed)
    if kind == "small":
        minutes, motion_minutes = minutes or 20.0, motion_minutes or 8.0
        out = [spec(rng.integers(1, 2**31), effects, motion, motion_minutes if motion else minutes)
               for effects, motion in SMALL]
    elif kind == "none":
        minutes, motion_minutes = minutes or 120.0, motion_minutes or 18.0
        out = [spec(rng.integers(1, 2**31), [], i % 5 == 4, motion_minutes if i % 5 == 4 else minutes)
               for i in range(count or 200)]
    elif kind == "many":
        out = many_panel(rng, count or 40, minutes or 120.0, motion_minutes or 18.0)
    else:
        count = count or 1
        none = 25 * count if none is None else none
        out = full_panel(rng, count, minutes or 120.0, motion_minutes or 18.0, none)
        if kind in ("still", "motion"):
            out = [s for s in out if s["motion"] == (kind == "motion")]
    if only_effects:
        out = [s for s in out if any(e in only_effects for e, _ in s["effects"])
               or ("none" in only_effects and not s["effects"])]
    if only_classes:
        out = [s for s in out if all(c in only_classes for _, c in s["effects"])]
    numbers = rng.permutation(max(1000, 3 * len(out)))[: len(out)]
    cases = {f"c{number:05d}": s for number, s in zip(numbers, out)}
    return dict(sorted(cases.items()))


def write_case(case_id, case_spec, directory, sealed):
    columns, model, truth = make_case(case_spec)
    where = os.path.join(directory, "cases", case_id)
    os.makedirs(where, exist_ok=True)
    os.makedirs(sealed, exist_ok=True)
    textfile.write(os.path.join(where, "recording.csv"), columns, decimals_of(columns))
    with open(os.path.join(where, "model.json"), "w") as file:
        json.dump(model, file, indent=1)
    with open(os.path.join(sealed, case_id + ".json"), "w") as file:
        json.dump(truth, file, indent=1)
    return truth


def panel_arguments(parser):
    parser.add_argument("--panel", default="small", choices=["small", "full", "none", "still", "motion", "many"])
    parser.add_argument("--count", type=int, help="cases of each effect and class (full), or of all (none, many)")
    parser.add_argument("--none", type=int, help="cases without a gap (full); 25 times the count")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, help="of a recording at rest")
    parser.add_argument("--motion-minutes", type=float)
    parser.add_argument("--effect", action="append", help="only cases with this effect, or none")
    parser.add_argument("--class", dest="classes", action="append", choices=list(CLASSES))


def panel_from(arguments):
    return panel(arguments.panel, arguments.count, arguments.seed, arguments.minutes, arguments.motion_minutes,
                 arguments.effect, arguments.classes, arguments.none)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("directory")
    parser.add_argument("--sealed", help="where the truths go (DIRECTORY/sealed)")
    parser.add_argument("--list", action="store_true", help="count the cases, make none")
    panel_arguments(parser)
    arguments = parser.parse_args()
    cases = panel_from(arguments)
    if arguments.list:
        print(len(cases), "cases,", sum(s["motion"] for s in cases.values()), "with motion")
        return 0
    sealed = arguments.sealed or os.path.join(arguments.directory, "sealed")
    for number, (case_id, case_spec) in enumerate(cases.items(), 1):
        write_case(case_id, case_spec, arguments.directory, sealed)
        print(f"\r{number}/{len(cases)}", end="", file=sys.stderr)
    print(file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
