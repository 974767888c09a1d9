"""Whether stated probabilities are what comes true: of causes, and of chance where there is no gap."""

import math

import numpy as np

SCORE_EDGES = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 1.0)
P_LEVELS = (0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9)


def of_scores(outcomes):
    """outcomes: (score, whether it was right). Brier's score, and by bins of the score how often it was right."""
    out = {"of": len(outcomes), "value": None, "bins": []}
    if not outcomes:
        return out
    said, right = np.array(outcomes, float).T
    out["value"] = float(np.mean((said - right) ** 2))
    bin_of = np.clip(np.searchsorted(SCORE_EDGES, said, side="right") - 1, 0, len(SCORE_EDGES) - 2)
    for i, (low, high) in enumerate(zip(SCORE_EDGES, SCORE_EDGES[1:])):
        mine = bin_of == i
        if mine.any():
            mean = float(said[mine].mean())
            out["bins"].append({"from": low, "to": high, "of": int(mine.sum()), "said": mean,
                                "right": float(right[mine].mean()),
                                "sd": math.sqrt(mean * (1.0 - mean) / int(mine.sum()))})
    return out


def of_p(values):
    """values: p_none of recordings without a gap. The share below each level, and how far chance carries it."""
    out = []
    for level in P_LEVELS:
        if values:
            below = sum(p <= level for p in values) / len(values)
            sd = math.sqrt(level * (1.0 - level) / len(values))
            out.append({"level": level, "of": len(values), "share": below, "sd": sd, "sds_off": (below - level) / sd})
    return out


def brier(figures):
    return "-" if figures["value"] is None else f"{figures['value']:.3f} of {figures['of']}"


def score_rows(figures):
    return [[f"{b['from']:g} to {b['to']:g}", str(b["of"]), f"{b['said']:.2f}", f"{b['right']:.2f}", f"{b['sd']:.2f}"]
            for b in figures["bins"]]


def p_rows(figures):
    return [[f"{r['level']:g}", f"{100 * r['share']:.1f} % of {r['of']}",
             f"{100 * r['level']:g} +- {100 * r['sd']:.1f} %", f"{r['sds_off']:+.1f}"] for r in figures]
