#!/usr/bin/env python3
"""Units with six to nine effects at once, each recorded twice: what is named from the first recording, and how much of
the gap is closed on the second.

A unit is a sensor of `sensor.py` with effects of `effects.py` and `foreign.py`, as real parts have them together. Its
second recording has the same constants. Noise, instants of events and the course of the temperature are others, its
lines have wandered by some thousandths, and nobody has touched the bench. The first recording is diagnosed from a model
that has white noise and a bias only. The corrected model then simulates recordings like the second one, and the
measures of halves.py tell how much nearer they are than those of the first model. More recordings of the unit itself on
that day tell how near one recording can be: a walk, say, is another one each time.

DIR/ID/first.csv, second.csv, white.json   recordings, and the model that is diagnosed; recordings go without --keep
DIR/ID/*.json, log.txt                     models and answer of the program, as halves.py has them
DIR/ID/result.json                         answer and gaps; a unit that has one is not run again
DIR/sealed/ID.json                         the truth
DIR/table.md, table.json                   the figures

Usage: units.py PROGRAM DIR [--count 10] [--seed N] [--minutes 15 30] [--simulations 60] [--measured 24] [--jobs 2]
                [--only ID] [--keep]
"""

import argparse
import json
import multiprocessing
import os
import sys

import numbers_or_skip  # noqa: F401
import numpy as np

import halves
import many
import run
import score
import textfile
from effects import Narrowband, Tone
from foreign import Bumps, WanderingLine
from generate import (
    context_of, decimals_of, draw_between, evidence_of, keep_apart, spec, truth_of, world_for)
from proportion import percent
from sensor import Surroundings, record, stream
from world import Temperature

FEWEST, MOST = 6, 9
# How often a unit has one of each group. One of a group at most: more could not be told apart, or one hides the other.
GROUPS = (
    (1.0, ("narrowband", "wandering_line")),
    (0.3, ("tone",)),
    (0.6, ("stale",)),
    (0.5, ("noise_colour", "lowpass")),
    (0.6, ("arw_scale",)),
    (0.6, ("flicker_missing",)),
    (0.6, ("rrw_missing",)),
    (0.6, ("rtn", "gauss_markov")),
    (0.8, ("temp_linear", "temp_quadratic", "temp_cubic", "temp_lag")),
    (0.2, ("temp_noise",)),
    (0.6, ("bumps",)),
    (0.3, ("heavy_tail", "spikes")),
    (0.4, ("quantization",)),
    (0.2, ("common_mode",)),
    (0.2, ("dropped", "clock_rate", "clock_jitter")),
)
NATS_LEAST = 100.0  # of an effect alone, to be asked for
TARGETS = (120.0, 12000.0)  # nats that are drawn; what cannot have them is what it can be
WANDERED_REL = 0.004  # standard deviation of a line's frequency from one recording to the next
NAMED_GOAL, CLOSED_GOAL = 0.85, 0.95


def draw_names(rng):
    while True:
        names = [str(rng.choice(of)) for share, of in GROUPS if rng.random() < share]
        if FEWEST <= len(names) <= MOST and not keep_apart(names):
            return names


def panel(count, seed, minutes):
    """ID to specification."""
    rng = np.random.default_rng(seed)
    cases = {}
    for number in range(1, count + 1):
        names = [(name, "of a unit") for name in draw_names(rng)]
        cases[f"u{number:02d}"] = spec(rng.integers(1, 2**31), names, False, float(np.round(rng.uniform(*minutes), 1)))
    return cases


def white_only(context):
    """The context of a sensor that has no flicker and no walk but those of its effects, and whose model has none."""
    for entry in context.model["axes"].values():
        entry.update(B=0.0, K=0.0)
    context.sensor.B[:] = 0.0
    context.sensor.K[:] = 0.0
    return context


def another_day(context, unit):
    """The same unit in the same room: the temperature begins within a degree and goes nearly as far, on another way."""
    rng = stream(unit["seed"], "another day")
    out = white_only(context_of(unit))
    first, course = context.temperature, Temperature(rng, context.duration_s, context.temperature.kind)
    course.start_C = first.start_C + rng.uniform(-1.0, 1.0)
    course.rise_C = first.rise_C * rng.uniform(0.8, 1.0)
    out.temperature = course
    out.slow = Surroundings(out, out.slow.t)
    return out


def wandered(effect, context, rng):
    """The effect in the second recording, or none of what came from outside."""
    if isinstance(effect, Bumps):
        return None
    params = dict(effect.params)
    if isinstance(effect, (Tone, Narrowband, WanderingLine)):
        params["f_hz"] *= 1.0 + WANDERED_REL * rng.standard_normal()
    return type(effect)(context, params, effect.axes)


class Unit:
    """A specification's unit on the two days of its recordings."""

    def __init__(self, unit):
        self.made = world_for(unit)
        self.context = white_only(context_of(self.made))
        self.drawn = [draw_between(self.context, name, TARGETS, (NATS_LEAST, np.inf), "unit", i, beside_others=True)
                      for i, (name, _) in enumerate(self.made["effects"])]
        self.effects = [e for e, _ in self.drawn]
        self.later = another_day(self.context, self.made)
        rng = stream(self.made["seed"], "wandered")
        self.again = [e for e in (wandered(effect, self.later, rng) for effect in self.effects) if e is not None]
        for e in self.effects:
            e.prepare(self.context.model)

    def first(self):
        return record(self.context, self.effects)

    def second(self, noise_name="another day"):
        return record(self.later, self.again, noise_name)

    def model(self):
        return plain_model(self.context.model)

    def truth(self):
        return {
            "verdict": "known", "foreign": False, "pair": False, "many": True, "refitted": False,
            "made": {k: self.made.get(k) for k in ("seed", "motion", "minutes", "temperature", "fast")},
            "effects": [truth_of(self.context, self.effects, e, value) for e, value in self.drawn],
        }


def plain_model(model):
    """White noise and bias of the model, its converter, and what it states of itself."""
    return {**{k: v for k, v in model.items() if k != "M"},
            "axes": {a: {"N": entry["N"], "bias": entry["bias"]} for a, entry in model["axes"].items()},
            "sd_rel": {k: v for k, v in model["sd_rel"].items() if k not in "BK"}}


def write_unit(unit_id, unit, directory):
    own = os.path.join(directory, unit_id)
    sealed = os.path.join(directory, "sealed")
    os.makedirs(own, exist_ok=True)
    os.makedirs(sealed, exist_ok=True)
    made = Unit(unit)
    for name, columns in (("first", made.first()), ("second", made.second())):
        textfile.write(os.path.join(own, name + ".csv"), columns, decimals_of(columns))
    for path, what in ((os.path.join(own, "white.json"), made.model()),
                       (os.path.join(sealed, unit_id + ".json"), made.truth())):
        with open(path, "w") as file:
            json.dump(what, file, indent=1)
    return made


def measured(columns):
    """By halves.py, to the decimals that a file has."""
    decimals, t_s = decimals_of(columns), columns["t_s"]
    rates_dps = np.stack([np.round(columns[f"g{a}_dps"], decimals[f"g{a}_dps"]) for a in "xyz"], axis=1)
    return halves.measures(rates_dps, (len(t_s) - 1) / (t_s[-1] - t_s[0]))


def gap_of_unit(made, count):
    """Of the unit itself in place of a model's simulations: the chance that is in one recording."""
    return halves.gap_squares(measured(made.second()), [measured(made.second(f"day {k}")) for k in range(count)])


def run_one(work):
    program, directory, unit_id, unit, simulations, count, keep = work
    own = os.path.join(directory, unit_id)
    result = os.path.join(own, "result.json")
    if not os.path.exists(result):
        made = write_unit(unit_id, unit, directory)
        answer, gaps = halves.held_against(
            program, own, count, diagnose=["--simulations", str(simulations), "--threads", "1", "--seed", "1"])
        gaps["unit"] = gap_of_unit(made, count)
        with open(result, "w") as file:
            json.dump({"answer": answer, "gap_squares": gaps}, file, indent=1)
        if not keep:
            for name in ("first.csv", "second.csv"):
                os.remove(os.path.join(own, name))
    return unit_id


def closed(gap_squares):
    """{model: share of the first model's gap's square}"""
    before = halves.total(gap_squares["white"])
    return {model: 1.0 - halves.total(squares) / before for model, squares in gap_squares.items() if model != "white"}


def judged(unit_id, truth, result):
    answer = result["answer"]
    row, _ = score.names_judged(unit_id, truth, answer)
    row["closed"] = closed(result["gap_squares"])
    row["gap"] = float(np.sqrt(max(0.0, halves.total(result["gap_squares"]["white"]))))
    row["stated"] = [answer.get("shrink"), answer.get("shrink_modelled")]
    row["causes_axes"] = ["".join(c["axes"]) for c in answer["causes"]]
    return row


def figures(rows):
    out = many.named_figures(rows, NATS_LEAST)
    out["closed"] = {}
    for model in rows[0]["closed"]:
        shares = [r["closed"][model] for r in rows]
        out["closed"][model] = {"median": float(np.median(shares)), "least": float(min(shares)),
                                "reached": sum(s >= CLOSED_GOAL for s in shares), "of": len(shares)}
    return out


def effect_words(effect, missed):
    words = f"{effect['effect']} {''.join(effect['axes'])} {effect['nats']:.0f}/{effect['nats_given_others']:.0f}"
    return f"**{words}**" if missed else words


def unit_row(row):
    named = row.get("named_effects", [])
    effects = [effect_words(e, i not in named) for i, e in enumerate(row["truth"]["effects"])]
    false = [f"{c['effect']} {axes}" for c, axes in zip(row.get("causes", []), row["causes_axes"]) if not c["right"]]
    share = {model: f"{100.0 * value:.0f} %" for model, value in row["closed"].items()}
    return [row["id"], f"{row['truth']['made']['minutes']:g}", ", ".join(effects), ", ".join(false) or "none",
            row.get("verdict", "; ".join(row["problems"])), f"{row['gap']:.1f}", share["analyze"], share["named"],
            share["unnamed"], share["unit"]]


def tables(rows):
    f = figures(rows)
    goal = f">= {100.0 * NAMED_GOAL:.0f} %"
    lines = [
        ["verdicts", ", ".join(f"{n} {verdict}" for verdict, n in sorted(f["verdicts"].items())), ""],
        [f"named, of the effects of {NATS_LEAST:g} nats and more alone", percent(f["named"]), goal],
        [f"named, of those of {NATS_LEAST:g} nats and more beside the others", percent(f["named_beside_others"]), ""],
        ["named, of the weaker ones alone", percent(f["named_weaker"]), ""],
        ["true by name or in a tie of three, of the causes named", percent(f["true"]), "100 %"],
    ]
    words = {"named": "the named causes", "unnamed": "these and what has no name", "analyze": "the fit of `analyze`",
             "unit": "other recordings of the unit itself"}
    for model, what in words.items():
        c = f["closed"][model]
        lines.append([f"closed by {what}: median, least, units of {100.0 * CLOSED_GOAL:.0f} % and more",
                      f"{100.0 * c['median']:.0f} %, {100.0 * c['least']:.0f} %, {c['reached']} of {c['of']}",
                      f">= {100.0 * CLOSED_GOAL:.0f} %" if model in ("named", "unnamed") else ""])
    return [
        ("Units with six to nine effects", [f"of {f['cases']} units", "measured", "goal"], lines),
        ("Each unit: effects with their nats alone and beside the others (those missed are bold), what is named and is "
         "not there, and the share of the gap's square that is closed on the second recording",
         ["unit", "minutes", "effects", "false", "verdict", "gap", "`analyze`", "named", "with unnamed", "the unit"],
         [unit_row(r) for r in rows]),
    ]


def scored(directory, cases):
    rows = []
    for unit_id in cases:
        result = score.load(os.path.join(directory, unit_id, "result.json"))
        if result is not None:
            rows.append(judged(unit_id, score.load(os.path.join(directory, "sealed", unit_id + ".json")), result))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("directory")
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, nargs=2, default=[15.0, 30.0], metavar=("LEAST", "MOST"))
    parser.add_argument("--simulations", type=int, default=60, help="of the diagnosis")
    parser.add_argument("--measured", type=int, default=24, help="simulations of each model that are held against")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", action="append", help="this unit")
    parser.add_argument("--keep", action="store_true", help="keep the recordings")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    about = {k: getattr(arguments, k) for k in ("count", "seed", "minutes", "simulations", "measured")}
    run.keep_to(program, arguments.directory, about)
    cases = panel(arguments.count, arguments.seed, arguments.minutes)
    work = [(program, arguments.directory, unit_id, unit, arguments.simulations, arguments.measured, arguments.keep)
            for unit_id, unit in cases.items() if not arguments.only or unit_id in arguments.only]
    with multiprocessing.Pool(arguments.jobs) as pool:
        for number, unit_id in enumerate(pool.imap_unordered(run_one, work), 1):
            print(f"{number}/{len(work)} {unit_id}", file=sys.stderr, flush=True)
    rows = scored(arguments.directory, cases)
    if not rows:
        sys.exit(f"no results in {arguments.directory}")
    with open(os.path.join(arguments.directory, "table.md"), "w") as file:
        file.write(", ".join(f"{k} {v}" for k, v in about.items()) + ".\n")
        file.write("\n".join(score.as_markdown(*table) for table in tables(rows)) + "\n")
    with open(os.path.join(arguments.directory, "table.json"), "w") as file:
        json.dump({"about": about, "figures": figures(rows), "units": rows}, file, indent=1)
    for table in tables(rows):
        print(score.as_text(*table))
    return 0


if __name__ == "__main__":
    sys.exit(main())
