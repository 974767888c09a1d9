"""Figures of the recordings with three to six effects at once, and their tables."""

import collections

import numpy as np

from answer_form import LIKELY
from proportion import percent, rate
from reliability import brier

NATS_LEAST = 50.0  # of an effect alone, to be asked for
GOALS = {"named": ">= 90 %", "true": ">= 95 %", "brier": "<= 0.08", "shrink_error": "<= 0.05", "covered": "85 to 95 %",
         "one": "68 %", "two": "95 %"}


def shrink_figures(rows):
    """Of rows with a claimed and a true shrink: how far they are apart, how often the interval holds the true one."""
    if not rows:
        return {"of": 0}
    claimed = np.clip([r["claimed"][0] for r in rows], 0.0, 1.0)
    true = np.array([r["shrink"] for r in rows])
    # To the decimals that an interval is read with.
    covered = [{"in": r["claimed"][1] - 0.005 <= r["shrink"] <= r["claimed"][2] + 0.005} for r in rows]
    error = np.abs(claimed - true)
    return {"of": len(rows), "error": float(error.mean()), "worst": float(error.max()),
            "coverage": rate(covered, "in"), "true": float(true.mean()), "claimed": float(claimed.mean())}


def share_figures(causes):
    """causes: {share, true_share, right}. Mean size of the error, of all and of the right ones."""

    def mean(of):
        return float(np.mean([abs(c["share"] - c["true_share"]) for c in of])) if of else None

    right = [c for c in causes if c["right"]]
    return {"of": len(causes), "error": mean(causes), "of_right": len(right), "error_right": mean(right)}


def figures(rows):
    """rows: of recordings with many effects, as score.py judged them."""
    return {
        **named_figures(rows, NATS_LEAST),
        "shrink": shrink_figures([r for r in rows if "claimed" in r]),
        "shares": share_figures([c for r in rows for c in r.get("causes", [])]),
        "modelled": [r["modelled"] for r in rows if "modelled" in r],
    }


def named_figures(rows, least):
    """Of effects of `least` nats alone and more, and of all causes. An answer that is not valid names nothing."""
    effects = [{**e, "named": i in r.get("named_effects", [])} for r in rows
               for i, e in enumerate(r["truth"]["effects"])]
    causes = [c for r in rows for c in r.get("causes", [])]
    strong = [e for e in effects if e["nats"] >= least]
    out = {
        "cases": len(rows),
        "verdicts": dict(collections.Counter(r.get("verdict", "not valid") for r in rows)),
        "named": rate(strong, "named"),
        "named_beside_others": rate([e for e in effects if e["nats_given_others"] >= least], "named"),
        "named_weaker": rate([e for e in effects if e["nats"] < least], "named"),
        "true": rate(causes, "right"),
        "true_of_likely": rate([c for c in causes if c["score"] >= LIKELY], "right"),
        "by_effect": [],
    }
    for name in sorted({e["effect"] for e in effects} | {c["effect"] for c in causes}):
        mine = [e for e in effects if e["effect"] == name]
        out["by_effect"].append({
            "effect": name, "named": rate([e for e in mine if e["nats"] >= least], "named"),
            "named_weaker": rate([e for e in mine if e["nats"] < least], "named"),
            "false": sum(c["effect"] == name and not c["right"] for c in causes)})
    return out


def share_of(r):
    return f"{r['hits']}/{r['of']}"


def number(value):
    return "-" if value is None else f"{value:.3f}"


def tables(f, scores, parameters):
    """[(title, header, rows)]. scores: reliability of these recordings' causes; parameters: {one, two}."""
    if not f["cases"]:
        return []
    shrink, shares = f["shrink"], f["shares"]
    rows = [
        ["verdicts", ", ".join(f"{n} {verdict}" for verdict, n in sorted(f["verdicts"].items())), ""],
        [f"named, of the effects of {NATS_LEAST:g} nats and more alone", percent(f["named"]), GOALS["named"]],
        [f"named, of those of {NATS_LEAST:g} nats and more beside the others", percent(f["named_beside_others"]), ""],
        ["named, of the weaker ones alone", percent(f["named_weaker"]), ""],
        ["true, of the causes named", percent(f["true"]), GOALS["true"]],
        [f"the same, of those of score {LIKELY} and more", percent(f["true_of_likely"]), ""],
        ["Brier score of every cause", brier(scores), GOALS["brier"]],
    ]
    if shrink["of"]:
        rows += [
            ["measured less true shrink, mean size", f"{shrink['error']:.3f} of {shrink['of']}", GOALS["shrink_error"]],
            ["true shrink within its interval", percent(shrink["coverage"]), GOALS["covered"]],
            ["true shrink, measured shrink, means", f"{shrink['true']:.3f}, {shrink['claimed']:.3f}", ""],
            ["measured with what has no name, mean", f"{np.mean(f['modelled']):.3f}", ""],
            ["a cause's share less the true one, mean size", f"{number(shares['error'])} of {shares['of']}", ""],
            ["the same, true causes", f"{number(shares['error_right'])} of {shares['of_right']}", ""],
        ]
    rows += [
        ["parameters within their standard deviation", percent(parameters["one"]), GOALS["one"]],
        ["within two", percent(parameters["two"]), GOALS["two"]],
    ]
    return [
        ("Three to six effects at once", [f"of {f['cases']} recordings", "measured", "goal"], rows),
        ("Each effect among several",
         ["effect", f"named of {NATS_LEAST:g} nats and more", "of weaker", "where it is not"],
         [[e["effect"], share_of(e["named"]), share_of(e["named_weaker"]), str(e["false"])] for e in f["by_effect"]]),
    ]
