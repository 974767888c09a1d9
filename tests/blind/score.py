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
from effects import CATALOGUE

CLASSES = ("marginal", "moderate", "clear")
TARGETS = {  # share, at least (or at most, where marked)
    "named": {"clear": 0.95, "moderate": 0.88, "marginal": 0.60},
    "detected": {"clear": 0.99, "moderate": 0.99, "marginal": 0.85},
    "foreign_unexplained": {"clear": 0.85, "moderate": 0.70},
    "foreign_misnamed_most": 0.10, "pairs": 0.75, "place": 0.95, "false_alarms_most": 0.02,
    "shrink_error_most": 0.05, "coverage": (0.85, 0.95), "brier_most": 0.08, "refitted_loss_most": 0.10,
}


def interval(hits, total):
    """Wilson's, 95 %."""
    if total == 0:
        return 0.0, 1.0
    z, p = 1.96, hits / total
    middle = (p + z * z / (2 * total)) / (1 + z * z / total)
    half = z * np.sqrt(p * (1 - p) / total + z * z / (4 * total**2)) / (1 + z * z / total)
    return max(0.0, middle - half), min(1.0, middle + half)


def load(path):
    try:
        with open(path) as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def judged(directory, case_id, truth, outcome):
    """One row: everything that the tables count."""
    answers = os.path.join(directory, "answers", case_id)
    row = {"id": case_id, "truth": truth, "problems": []}
    answer = load(answers + ".json")
    code = (outcome or {}).get("code")
    if code not in (0, None):
        row["problems"].append(f"exit {code}")
    if answer is None:
        row["problems"].append("no JSON")
    else:
        row["problems"] += judge.complaints(answer)
    row["seconds"] = (outcome or {}).get("seconds")
    row["valid"] = not row["problems"]
    if not row["valid"]:
        return row
    causes = answer["causes"]
    row.update(verdict=answer["verdict"], p_none=answer["p_none"], detected=answer["verdict"] != "none",
               said=[c["effect"] for c in causes], score=causes[0]["score"] if causes else None)
    known = answer["verdict"] == "known"
    effects = truth["effects"]
    if truth["verdict"] == "known" and not truth["pair"]:
        effect = effects[0]
        row["first"] = known and causes[0]["effect"] == effect["effect"]
        row["named"] = known and judge.names(causes[0], effect["effect"])
        row["listed"] = any(c["effect"] == effect["effect"] for c in causes)
        row["tied"] = known and len(judge.tie_of(causes[0])) > 1
        if row["named"]:
            duration_s = truth["made"]["minutes"] * 60.0
            row["place"], row["place_fair"] = judge.place_right(effect, answer, causes[0], duration_s)
    row["off"] = [{"effect": e["effect"], "param": name, "sds": sds} for e in effects if known and not truth["refitted"]
                  for c in causes if c["effect"] == e["effect"] for name, sds in judge.deviations(e, c).items()]
    if truth["pair"]:
        left = [e["effect"] for e in effects]
        for cause in causes[:3]:
            hit = [name for name in left if judge.names(cause, name)]
            exact = [name for name in hit if name == cause["effect"]]
            if hit and known:
                left.remove((exact or hit)[0])
        row["found"] = 2 - len(left)
    if truth["verdict"] != "none" and row["detected"]:
        corrected = load(answers + ".model.json")
        model = load(os.path.join(directory, "cases", case_id, "model.json"))
        row["shrink"], row["unread"] = judge.true_shrink(truth, model, answer, corrected)
        row["claimed"] = [answer["shrink"], answer["shrink_lo"], answer["shrink_hi"]]
    return row


def rate(rows, key):
    """{hits, of, share, lo, hi}; an answer that is not valid is a miss."""
    hits, total = sum(bool(r.get(key)) for r in rows), len(rows)
    low, high = interval(hits, total)
    return {"hits": hits, "of": total, "share": hits / total if total else None, "lo": low, "hi": high}


def summary(rows):
    singles = [r for r in rows if r["truth"]["verdict"] == "known" and not r["truth"]["pair"]]
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
        out["by_class"][c] = {key: rate(mine, key) for key in ("detected", "first", "named", "listed", "tied")}
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
        said = "invalid" if not r["valid"] else r["said"][0] if r["verdict"] == "known" else r["verdict"]
        confusion[(r["truth"]["effects"][0]["effect"], said)] += 1
    out["confusion"] = [{"truth": t, "said": s, "count": n} for (t, s), n in sorted(confusion.items())
                        if t != s and not (s == "unexplained" and t not in CATALOGUE)]

    for r in none:
        r["alarm"] = not r["valid"] or r["detected"]
    out["false_alarms"] = rate(none, "alarm")
    out["p_none"] = []
    for level in (0.01, 0.05, 0.1, 0.25, 0.5, 0.75):
        for r in none:
            r["below"] = r["valid"] and r["p_none"] <= level
        out["p_none"].append({"level": level, **rate(none, "below")})

    for r in foreign:
        r["unexplained"] = r["valid"] and r["verdict"] == "unexplained"
        r["misnamed"] = not r["valid"] or r["verdict"] == "known"
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
    for r in pairs:
        r["both"], r["one"] = r.get("found") == 2, r.get("found", 0) >= 1
        r["more"] = len(r.get("said", [])) > 2
    out["pairs"] = {key: rate(pairs, key) for key in ("detected", "one", "both", "more")}

    refitted = [r for r in singles if r["truth"]["refitted"]]
    alike = {(r["truth"]["effects"][0]["effect"], kind(r)) for r in refitted}
    fresh = [r for r in plain if (r["truth"]["effects"][0]["effect"], kind(r)) in alike]
    out["refitted"] = {"named": rate(refitted, "named"), "detected": rate(refitted, "detected"),
                       "named_with_first_model": rate(fresh, "named")}

    said = [r for r in rows if r["valid"] and r["verdict"] == "known"]
    outcomes = [(r["score"], bool(r.get("first")) or (r["truth"]["pair"] and r["said"][0] in
                                                      [e["effect"] for e in r["truth"]["effects"]])) for r in said]
    out["brier"] = {"value": float(np.mean([(p - y) ** 2 for p, y in outcomes])) if outcomes else None,
                    "of": len(outcomes), "reliability": []}
    for low, high in ((0.0, 0.3), (0.3, 0.5), (0.5, 0.7), (0.7, 0.9), (0.9, 0.97), (0.97, 1.0001)):
        mine = [(p, y) for p, y in outcomes if low <= p < high]
        if mine:
            out["brier"]["reliability"].append({
                "from": low, "to": min(high, 1.0), "of": len(mine), "said": float(np.mean([p for p, _ in mine])),
                "right": float(np.mean([y for _, y in mine]))})

    claims = [r for r in rows if "claimed" in r and r["verdict"] == "known" and not r["truth"]["foreign"]]
    out["shrink"] = {"of": len(claims), "unread": sorted({u for r in claims for u in r["unread"]})}
    if claims:
        errors = np.array([abs(min(max(r["claimed"][0], 0.0), 1.0) - r["shrink"]) for r in claims])
        # By the strict reading a wrong first cause shrinks nothing.
        strict = np.array([abs(min(max(r["claimed"][0], 0.0), 1.0) - (
            r["shrink"] if r.get("named") or r.get("found") else 0.0)) for r in claims])
        covered = [{"in": r["claimed"][1] - 0.005 <= r["shrink"] <= r["claimed"][2] + 0.005} for r in claims]
        out["shrink"].update(error=float(errors.mean()), error_strict=float(strict.mean()),
                             worst=float(errors.max()), coverage=rate(covered, "in"),
                             true=float(np.mean([r["shrink"] for r in claims])),
                             claimed=float(np.mean([r["claimed"][0] for r in claims])))
    off = [p for r in rows for p in r.get("off", [])]
    for p in off:
        p["one"], p["two"] = abs(p["sds"]) <= 1.0, abs(p["sds"]) <= 2.0
    out["parameters"] = {"one": rate(off, "one"), "two": rate(off, "two")}
    seconds = [r["seconds"] for r in rows if r["seconds"] is not None]
    out["seconds"] = {"mean": float(np.mean(seconds)), "most": float(max(seconds))} if seconds else None
    return out


def percent(r):
    if r["of"] == 0:
        return "-"
    return f"{100 * r['share']:.0f} % of {r['of']} [{100 * r['lo']:.0f}, {100 * r['hi']:.0f}]"


def tables(s):
    """[(title, header, rows)]."""
    out = []
    goal = TARGETS
    rows = []
    for c in CLASSES:
        b = s["by_class"][c]
        rows.append([c, percent(b["detected"]), f"{100 * goal['detected'][c]:.0f} %", percent(b["first"]),
                     percent(b["named"]), f"{100 * goal['named'][c]:.0f} %", percent(b["place"]),
                     percent(b["place_fair"])])
    out.append(("One effect of the catalogue, by strength of evidence",
                ["evidence", "detected", "goal", "right first", "or in a tie of 3", "goal", "place right",
                 "but for weak axes"], rows))
    p = s["pairs"]
    shrink = s["shrink"]
    rows = [
        ["false alarms without a gap", percent(s["false_alarms"]), "<= 2 %"],
        ["foreign unexplained, clear", percent(s["foreign"]["clear"]["unexplained"]), ">= 85 %"],
        ["foreign unexplained, moderate", percent(s["foreign"]["moderate"]["unexplained"]), ">= 70 %"],
        ["foreign misnamed", percent(s["foreign_misnamed"]), "<= 10 %"],
        ["both of two found", percent(p["both"]), ">= 75 %"],
        ["one of two found", percent(p["one"]), ""],
        ["more than two named of two", percent(p["more"]), ""],
        ["place right, cause right", percent(s["place"]), ">= 95 %"],
        ["refitted model: named", percent(s["refitted"]["named"]), ""],
        ["the same effects, first model", percent(s["refitted"]["named_with_first_model"]), "<= 10 points more"],
        ["Brier score of the first cause", "-" if s["brier"]["value"] is None else
         f"{s['brier']['value']:.3f} of {s['brier']['of']}", "<= 0.08"],
    ]
    if shrink["of"]:
        rows += [
            ["claimed less true shrink, mean size", f"{shrink['error']:.3f} of {shrink['of']}", "<= 0.05"],
            ["the same, a wrong cause shrinks nothing", f"{shrink['error_strict']:.3f}", ""],
            ["true shrink within its interval", percent(shrink["coverage"]), "85 to 95 %"],
        ]
    rows += [
        ["parameters within their standard deviation", percent(s["parameters"]["one"]), "68 %"],
        ["within two", percent(s["parameters"]["two"]), "95 %"],
    ]
    out.append(("Figures", ["", "measured", "goal"], rows))
    out.append(("p_none on recordings without a gap", ["p_none <=", "share"],
                [[f"{r['level']:g}", percent(r)] for r in s["p_none"]]))
    out.append(("First cause's score", ["score", "number", "mean score", "right"],
                [[f"{r['from']:g} to {r['to']:g}", str(r["of"]), f"{r['said']:.2f}", f"{r['right']:.2f}"]
                 for r in s["brier"]["reliability"]]))
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
    return out


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
    for what in figures["shrink"]["unread"]:
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
