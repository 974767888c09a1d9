"""Shares of cases that are so, each with Wilson's interval of 95 %."""

import math


def interval(hits, total):
    """Wilson's, 95 %."""
    if total == 0:
        return 0.0, 1.0
    z, p = 1.96, hits / total
    middle = (p + z * z / (2 * total)) / (1 + z * z / total)
    half = z * math.sqrt(p * (1 - p) / total + z * z / (4 * total**2)) / (1 + z * z / total)
    return max(0.0, middle - half), min(1.0, middle + half)


def rate(rows, key):
    """{hits, of, share, lo, hi}; a row without the key is a miss."""
    hits, total = sum(bool(r.get(key)) for r in rows), len(rows)
    low, high = interval(hits, total)
    return {"hits": hits, "of": total, "share": hits / total if total else None, "lo": low, "hi": high}


def percent(r):
    if r["of"] == 0:
        return "-"
    return f"{100 * r['share']:.0f} % of {r['of']} [{100 * r['lo']:.0f}, {100 * r['hi']:.0f}]"
