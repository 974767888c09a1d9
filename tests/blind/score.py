#!/usr/bin/env python3
"""Opens the sealed truths of a panel that was run and says how good the answers were.

Usage: score.py DIR [--json FILE] [--markdown FILE] [--cases]
"""

import argparse
import collections
import json
import os
import sys

import numbers_or_skip  # noqa: F401
import numpy as np

import judge
import many
import reliability
from answer_form import complaints
from effects import CATALOGUE
from proportion import percent, rate

CLASSES = ("marginal", "moderate", "clear")
TARGETS = {  # share, at least (or at most, where marked)
    "named": {"clear": 0.95, "moderate": 0.88, "marginal": 0.60},
    "detected": {"clear": 0.99, "moderate": 0.99, "marginal": 0.85},
    "foreign_unexplained": {"clear": 0.85, "moderate": 0.70},
    "foreign_misnamed_most": 0.10, "pairs": 0.75, "place": 0.95, "false_alarms_most": 0.02,
    "shrink_error_most": 0.05, "coverage": (0.85, 0.95), "brier_most": 0.08, "refitted_loss_most": 0.10,
}


def load(path):
    try:
        with open(path) as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def names_judged(case_id, truth, answer, code=None):
    """(row, causes that are judged): what the answer names, and whether it is so. answer: None where there is none."""
    row = {"id": case_id, "truth": truth, "problems": []}
    if code not in (0, None):
        row["problems"].append(f"exit {code}")
    if answer is None:
        row["problems"].append("no JSON")
    else:
        row["problems"] += complaints(answer)
    row["valid"] = not row["problems"]
    if not row["valid"]:
        return row, []
    row.update(verdict=answer["verdict"], p_none=answer["p_none"], detected=answer["verdict"] != "none")
    # Where the recording could have come from the model, nothing is named.
    causes = answer["causes"] if row["detected"] else []
    row.update(said=[c["effect"] for c in causes])
    if truth["refitted"]:
        # The truth does not say what of the model the fit has made too large.
        causes = [c for c in causes if c["sense"] == "recording_has"]
    effects, explains = truth["effects"], answer["verdict"] in ("known", "partly")
    row["causes"] = [{"effect": c["effect"], "score": c["score"], "share": c["share"],
                      "right": any(judge.is_right(c, e) for e in effects)} for c in causes]
    if truth["verdict"] == "known" and len(effects) == 1:
        judge_single(row, truth, answer, causes)
    if truth["pair"]:
        row["found"] = len(judge.named_effects(causes[:3], effects)) if explains else 0
    if is_many(row):
        row["named_effects"] = judge.named_effects(causes, effects)
    row["off"] = [{"effect": e["effect"], "param": name, "sds": sds} for e in effects
                  if explains and not truth["refitted"] for c in causes
                  if c["effect"] == e["effect"] and judge.is_right(c, e) for name, sds in judge.deviations(e, c)]
    return row, causes


def judged(directory, case_id, truth, outcome):
    """One row: everything that the tables count."""
    answers = os.path.join(directory, "answers", case_id)
    answer = load(answers + ".json")
    row, causes = names_judged(case_id, truth, answer, (outcome or {}).get("code"))
    row["seconds"] = (outcome or {}).get("seconds")
    if not row["valid"]:
        return row
    if truth["verdict"] != "none" and row["detected"]:
        corrected = load(answers + ".model.json")
        case = judge.Case(truth, load(os.path.join(directory, "cases", case_id, "model.json")))
        row["shrink"], row["unread"] = case.shrink(answer, corrected)
        row["claimed"] = [answer["shrink"], answer["shrink_lo"], answer["shrink_hi"]]
        row["modelled"] = answer["shrink_modelled"]
        for said, cause in zip(row["causes"], causes):
            said["true_share"] = case.share(cause)
    return row


def is_many(row):
    return row["truth"].get("many", False)


def judge_single(row, truth, answer, causes):
    """A verdict `partly` with the right cause first is half right, and counted by itself."""
    effect = truth["effects"][0]
    right = bool(causes) and judge.is_right({**causes[0], "axes": []}, effect)
    known = answer["verdict"] == "known"
    row["first"] = known and right and causes[0]["effect"] == effect["effect"]
    row["named"] = known and right
    row["half"] = answer["verdict"] == "partly" and right
    row["listed"] = any(c["effect"] == effect["effect"] for c in causes)
    row["tied"] = known and bool(causes) and len(judge.tie_of(causes[0])) > 1
    if row["named"]:
        duration_s = truth["made"]["minutes"] * 60.0
        row["place"], row["place_fair"] = judge.place_right(effect, answer, causes[0], duration_s)


def summary(rows):
    several = [r for r in rows if is_many(r)]
    few = [r for r in rows if not is_many(r)]
    singles = [r for r in few if r["truth"]["verdict"] == "known" and not r["truth"]["pair"]]
    plain = [r for r in singles if not r["truth"]["refitted"]]
    foreign = [r for r in rows if r["truth"]["foreign"]]
    pairs = [r for r in rows if r["truth"]["pair"]]
    none = [r for r in rows if r["truth"]["verdict"] == "none"]
    out = {"cases": len(rows), "invalid": [{"id": r["id"], "problems": r["problems"]} for r in rows if not r["valid"]]}

    def kind(row):
        return row["truth"]["effects"][0]["class"]

    out["by_class"] = {}
    for c in CLASSES:
        mine = [r for r in plain if kind(r) == c]
        named = [r for r in mine if r.get("named")]
        out["by_class"][c] = {key: rate(mine, key) for key in ("detected", "first", "named", "half", "listed", "tied")}
        out["by_class"][c]["place"] = rate(named, "place")
        out["by_class"][c]["place_fair"] = rate(named, "place_fair")
    named = [r for r in plain if r.get("named")]
    out["place"], out["place_fair"] = rate(named, "place"), rate(named, "place_fair")
    table = collections.defaultdict(list)
    for r in plain:
        table[(r["truth"]["effects"][0]["effect"], kind(r))].append(r)
    out["by_effect"] = [
        {"effect": effect, "class": c, **{key: rate(mine, key) for key in ("detected", "first", "named")},
         "place": rate([r for r in mine if r.get("named")], "place")}
        for (effect, c), mine in sorted(table.items(), key=lambda item: (item[0][0], CLASSES.index(item[0][1])))]
    confusion = collections.Counter()
    for r in singles + foreign:
        said = r["verdict"] if r["valid"] else "invalid"
        if said in ("known", "partly") and r["said"]:
            said = r["said"][0] if said == "known" else "partly " + r["said"][0]
        confusion[(r["truth"]["effects"][0]["effect"], said)] += 1
    out["confusion"] = [{"truth": t, "said": s, "count": n} for (t, s), n in sorted(confusion.items())
                        if t != s and not (s == "unexplained" and t not in CATALOGUE)]

    for r in none:
        r["alarm"] = not r["valid"] or r["detected"]
    out["false_alarms"] = rate(none, "alarm")
    out["p_none"] = reliability.of_p([r["p_none"] for r in none if r["valid"]])

    for r in foreign:
        # The contract may have an effect that describes it: that name is as right as none.
        described = r["valid"] and bool(r["causes"]) and r["causes"][0]["right"]
        r["unexplained"] = r["valid"] and (r["verdict"] == "unexplained" or (r["verdict"] == "known" and described))
        r["misnamed"] = not r["valid"] or (r["verdict"] == "known" and not described)
        r["half_misnamed"] = r["valid"] and r["verdict"] == "partly" and not described
    out["foreign"] = {c: {"unexplained": rate([r for r in foreign if kind(r) == c], "unexplained"),
                          "misnamed": rate([r for r in foreign if kind(r) == c], "misnamed"),
                          "detected": rate([r for r in foreign if kind(r) == c], "detected")}
                      for c in CLASSES[1:]}
    out["foreign_by_effect"] = []
    for effect in sorted({r["truth"]["effects"][0]["effect"] for r in foreign}):
        mine = [r for r in foreign if r["truth"]["effects"][0]["effect"] == effect]
        out["foreign_by_effect"].append({"effect": effect, **{k: rate(mine, k) for k in
                                                              ("detected", "unexplained", "misnamed")}})
    out["foreign_misnamed"] = rate(foreign, "misnamed")
    out["foreign_half_misnamed"] = rate(foreign, "half_misnamed")
    for r in pairs:
        known = r.get("verdict") == "known"
        r["both"], r["one"] = known and r["found"] == 2, known and r["found"] >= 1
        r["half"] = r.get("verdict") == "partly" and r["found"] >= 1
        r["more"] = len(r.get("said", [])) > 2
    out["pairs"] = {key: rate(pairs, key) for key in ("detected", "one", "both", "half", "more")}

    refitted = [r for r in singles if r["truth"]["refitted"]]
    alike = {(r["truth"]["effects"][0]["effect"], kind(r)) for r in refitted}
    fresh = [r for r in plain if (r["truth"]["effects"][0]["effect"], kind(r)) in alike]
    out["refitted"] = {"named": rate(refitted, "named"), "detected": rate(refitted, "detected"),
                       "named_with_first_model": rate(fresh, "named")}

    out["reliability"] = {}
    out["parameters"] = {}
    for group, mine in (("few", few), ("many", several)):
        out["reliability"][group] = reliability.of_scores(
            [(c["score"], c["right"]) for r in mine for c in r.get("causes", [])])
        off = [p for r in mine for p in r.get("off", [])]
        for p in off:
            p["one"], p["two"] = abs(p["sds"]) <= 1.0, abs(p["sds"]) <= 2.0
        out["parameters"][group] = {"one": rate(off, "one"), "two": rate(off, "two")}
    firsts = [r["causes"][0] for r in few if r["valid"] and r["verdict"] in ("known", "partly") and r["causes"]]
    out["first_cause"] = reliability.of_scores([(c["score"], c["right"]) for c in firsts])

    claims = [r for r in few if "claimed" in r and r["verdict"] in ("known", "partly") and not r["truth"]["foreign"]]
    out["shrink"] = many.shrink_figures(claims)
    out["shares"] = many.share_figures([c for r in claims for c in r["causes"]])
    out["unread"] = sorted({u for r in rows for u in r.get("unread", [])})
    out["many"] = many.figures(several)
    seconds = [r["seconds"] for r in rows if r["seconds"] is not None]
    out["seconds"] = {"mean": float(np.mean(seconds)), "most": float(max(seconds))} if seconds else None
    return out


def tables(s):
    """[(title, header, rows)], of what the panel has."""
    out = []
    if any(s["by_class"][c]["named"]["of"] for c in CLASSES):
        out.append(class_table(s))
    if s["cases"] > s["many"]["cases"]:
        out.append(("Figures", ["", "measured", "goal"], figure_rows(s)))
    out += many.tables(s["many"], s["reliability"]["many"], s["parameters"]["many"])
    out.append(("p_none on recordings without a gap",
                ["p_none <=", "share", "wanted, with chance's deviation", "off by"], reliability.p_rows(s["p_none"])))
    for group, words in (("few", "one effect, two or none"), ("many", "three to six")):
        out.append((f"Scores of all causes, recordings with {words}",
                    ["score", "number", "mean score", "right", "chance's deviation"],
                    reliability.score_rows(s["reliability"][group])))
    cells = {(r["effect"], r["class"]): effect_cell(r) for r in s["by_effect"]}
    out.append(("Each effect: right first or in a tie of 3, and what went wrong", ["effect", *CLASSES],
                [[effect] + [cells.get((effect, c), "") for c in CLASSES]
                 for effect in sorted({r["effect"] for r in s["by_effect"]})]))
    out.append(("Each foreign effect", ["effect", "detected", "unexplained", "misnamed"],
                [[r["effect"]] + [f"{r[k]['hits']}/{r[k]['of']}" for k in ("detected", "unexplained", "misnamed")]
                 for r in s["foreign_by_effect"]]))
    wrong = collections.defaultdict(list)
    for r in s["confusion"]:
        wrong[r["truth"]].append(f"{r['said']} {r['count']}")
    out.append(("Taken for something else", ["truth", "said"],
                [[t, ", ".join(said)] for t, said in sorted(wrong.items())]))
    return [table for table in out if table[2]]


def class_table(s):
    rows = []
    for c in CLASSES:
        b = s["by_class"][c]
        rows.append([c, percent(b["detected"]), f"{100 * TARGETS['detected'][c]:.0f} %", percent(b["first"]),
                     percent(b["named"]), f"{100 * TARGETS['named'][c]:.0f} %", percent(b["half"]), percent(b["place"]),
                     percent(b["place_fair"])])
    return ("One effect of the catalogue, by strength of evidence",
            ["evidence", "detected", "goal", "right first", "or in a tie of 3", "goal", "right, partly", "place right",
             "but for weak axes"], rows)


def figure_rows(s):
    p, shrink, parameters = s["pairs"], s["shrink"], s["parameters"]["few"]
    rows = [
        ["false alarms without a gap", percent(s["false_alarms"]), "<= 2 %"],
        ["foreign unexplained, clear", percent(s["foreign"]["clear"]["unexplained"]), ">= 85 %"],
        ["foreign unexplained, moderate", percent(s["foreign"]["moderate"]["unexplained"]), ">= 70 %"],
        ["foreign misnamed", percent(s["foreign_misnamed"]), "<= 10 %"],
        ["foreign misnamed, partly", percent(s["foreign_half_misnamed"]), ""],
        ["both of two found", percent(p["both"]), ">= 75 %"],
        ["one of two found", percent(p["one"]), ""],
        ["one of two found, partly", percent(p["half"]), ""],
        ["more than two named of two", percent(p["more"]), ""],
        ["place right, cause right", percent(s["place"]), ">= 95 %"],
        ["refitted model: named", percent(s["refitted"]["named"]), ""],
        ["the same effects, first model", percent(s["refitted"]["named_with_first_model"]), "<= 10 points more"],
        ["Brier score of the first cause", reliability.brier(s["first_cause"]), "<= 0.08"],
        ["Brier score of every cause", reliability.brier(s["reliability"]["few"]), "<= 0.08"],
    ]
    if shrink["of"]:
        rows += [
            ["claimed less true shrink, mean size", f"{shrink['error']:.3f} of {shrink['of']}", "<= 0.05"],
            ["true shrink within its interval", percent(shrink["coverage"]), "85 to 95 %"],
            ["a cause's share less the true one, mean size",
             f"{many.number(s['shares']['error'])} of {s['shares']['of']}", ""],
        ]
    return rows + [
        ["parameters within their standard deviation", percent(parameters["one"]), "68 %"],
        ["within two", percent(parameters["two"]), "95 %"],
    ]


def effect_cell(row):
    """1/2 (1 not seen), say."""
    unseen = row["detected"]["of"] - row["detected"]["hits"]
    misplaced = row["place"]["of"] - row["place"]["hits"]
    wrong = [f"{n} {what}" for n, what in ((unseen, "not seen"), (misplaced, "misplaced")) if n]
    return f"{row['named']['hits']}/{row['named']['of']}" + (f" ({', '.join(wrong)})" if wrong else "")


def as_text(title, header, rows):
    widths = [max(len(line[i]) for line in [header] + rows) for i in range(len(header))]
    lines = ["", title] + ["  " + "  ".join(cell.ljust(w) for cell, w in zip(line, widths)).rstrip()
                           for line in [header] + rows]
    return "\n".join(lines)


def as_markdown(title, header, rows):
    return "\n".join(["", title + ".", "", "| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
                     + ["| " + " | ".join(line) + " |" for line in rows])


def score(directory):
    """(rows, summary)."""
    sealed = os.path.join(directory, "sealed")
    outcomes = (load(os.path.join(directory, "run.json")) or {}).get("outcomes", {})
    rows = []
    for name in sorted(os.listdir(sealed)):
        case_id = name[: -len(".json")]
        if os.path.exists(os.path.join(directory, "answers", case_id + ".log")) or case_id in outcomes:
            rows.append(judged(directory, case_id, load(os.path.join(sealed, name)), outcomes.get(case_id)))
    return rows, summary(rows)


def describe_case(row):
    truth = " + ".join(f"{e['effect']} {e['class']} {''.join(e['axes'])}" for e in row["truth"]["effects"]) or "none"
    if row["truth"]["refitted"]:
        truth += " (refitted)"
    said = "; ".join(row["problems"]) if not row["valid"] else f"{row['verdict']} {' '.join(row['said'])}"
    shrink = f"{row['claimed'][0]:.2f} for {row['shrink']:.2f}" if "claimed" in row else ""
    return [row["id"], truth, said, "" if row.get("place", True) else "place", shrink]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("directory")
    parser.add_argument("--json", help="all figures, and every case")
    parser.add_argument("--markdown", help="the tables, for a document")
    parser.add_argument("--cases", action="store_true", help="list every case")
    arguments = parser.parse_args()
    rows, figures = score(arguments.directory)
    if not rows:
        print("no answers in", arguments.directory)
        return 1
    about = load(os.path.join(arguments.directory, "run.json")) or {}
    about = {k: v for k, v in about.items() if k != "outcomes" and v is not None}
    print(", ".join(f"{k} {v}" for k, v in about.items()))
    if arguments.cases:
        print(as_text("Cases", ["id", "truth", "answer", "", "shrink"], [describe_case(r) for r in rows]))
    for table in tables(figures):
        print(as_text(*table))
    for r in figures["invalid"]:
        print("not valid:", r["id"], "; ".join(r["problems"]))
    for what in figures["unread"]:
        print("params not understood:", what)
    if arguments.markdown:
        with open(arguments.markdown, "w") as file:
            file.write(", ".join(f"{k} {v}" for k, v in about.items()) + ".\n")
            file.write("\n".join(as_markdown(*table) for table in tables(figures)) + "\n")
    if arguments.json:
        with open(arguments.json, "w") as file:
            json.dump({"about": about, "figures": figures, "cases": rows}, file, indent=1)
    return 0


if __name__ == "__main__":
    sys.exit(main())
