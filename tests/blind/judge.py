"""One answer held against one truth: is it well formed, what did it name, is the place right, the gap how far shrunk.

The true shrink of an answer is 1 - E(truth | claimed) / E(truth | nothing): the evidence that the data hold against
the corrected model, over what they hold against the first one (evidence.py, N, B, K, M, latency and clock free within
what the model states, a difference of the means counted as its square). Right parameters give 1; an effect
that is not there, or that changes something else, gives 0 or less, which counts as 0; a wrong name whose
simulation does what the truth does is given what it earns. The corrected model is the one handed back with
--model-out; without it, the causes' params.
"""

import math

import numpy as np

from effects import CATALOGUE
from evidence import AXES, Description, nats
from foreign import FOREIGN
from generate import context_of

VERDICTS = ("none", "known", "unexplained")
STRUCTURES = ("duplicated_samples", "timestamp_gaps", "timestamp_rate", "timestamp_jitter", "growing_lag",
              "cross_axis", "code_grid", "isolated_samples")
WEAK_NATS = 8.0  # an axis that holds less of the evidence may be missing from the answer


def complaints(answer):
    """What the contract asks for and the answer does not have."""
    out = []

    def number(value, low=-math.inf, high=math.inf):
        right_type = isinstance(value, (int, float)) and not isinstance(value, bool)
        return right_type and math.isfinite(value) and low <= value <= high

    if not isinstance(answer, dict):
        return ["not an object"]
    if answer.get("schema") != "gyrolog-diagnosis/1":
        out.append("schema")
    if answer.get("verdict") not in VERDICTS:
        out.append("verdict")
    if not number(answer.get("p_none"), 0.0, 1.0):
        out.append("p_none")
    causes = answer.get("causes")
    if not isinstance(causes, list):
        out.append("causes")
        causes = []
    for cause in causes:
        if not isinstance(cause, dict) or cause.get("effect") not in CATALOGUE:
            out.append("causes: effect")
        elif not number(cause.get("score"), 0.0, 1.0):
            out.append("causes: score")
        elif not isinstance(cause.get("axes", []), list) or not isinstance(cause.get("params", {}), dict):
            out.append("causes: axes or params")
        elif any(name not in CATALOGUE for name in cause.get("tie_group", [])):
            out.append("causes: tie_group")
        elif cause.get("where", {}).get("structure", STRUCTURES[0]) not in STRUCTURES:
            out.append("causes: structure")
    if answer.get("verdict") == "known" and not causes:
        out.append("known without a cause")
    if answer.get("verdict") != "none":
        for key in ("shrink", "shrink_lo", "shrink_hi"):
            if not number(answer.get(key)):
                out.append(key)
        for key in ("gap_before", "gap_after"):
            if not isinstance(answer.get(key), dict) or not number(answer[key].get("value"), 0.0):
                out.append(key)
    return out


def tie_of(cause):
    return set(cause.get("tie_group") or []) | {cause["effect"]}


def names(cause, effect):
    """First: by its name, or in a declared tie of at most three."""
    return cause["effect"] == effect or (len(tie_of(cause)) <= 3 and effect in tie_of(cause))


def _overlap(a, b):
    return isinstance(b, list) and len(b) == 2 and a[0] <= b[1] and b[0] <= a[1]


def _time_right(effect, truth, claim, duration_s):
    if not (isinstance(claim, list) and len(claim) == 2):
        return False
    near = max(0.02 * duration_s, 30.0)
    if effect == "bias_step":
        return (abs(0.5 * (claim[0] + claim[1]) - truth[0]) <= near and claim[1] - claim[0] <= 0.2 * duration_s)
    shared = min(truth[1], claim[1]) - max(truth[0], claim[0])
    shorter = min(truth[1] - truth[0], claim[1] - claim[0])
    # An instant is right at the beginning of what lasts.
    return shared >= 0.5 * shorter if shorter > 0.0 else truth[0] - near <= claim[0] <= truth[1] + near


def place_keys_right(effect, truth, claim, duration_s):
    """Any of the truth's keys that the claim has is right; a place without any of them is none."""
    if truth.get("any"):
        return True
    for key, value in truth.items():
        if key == "axes" or key not in claim:
            continue
        said = claim[key]
        if key in ("temperature", "acceleration"):
            right = said is True
        elif key == "structure":
            right = said == value
        elif key == "time_s":
            right = _time_right(effect, value, said, duration_s)
        elif key == "freq_hz" and effect == "tone":
            middle = 0.5 * (value[0] + value[1])
            right = _overlap([middle, middle], [said[0] - 0.005, said[1] + 0.005]) and said[1] - said[0] <= 1.0
        else:
            right = _overlap(value, said)
        if right:
            return True
    return False


def place_right(truth_effect, answer, cause, duration_s):
    """(keys and exactly the true axes, keys and the true axes but for weak ones)."""
    claim = {**answer.get("where", {}), **cause.get("where", {})}
    axes = set(cause.get("axes") or claim.get("axes") or [])
    true_axes = set(truth_effect["axes"])
    whole = not truth_effect["nats_of_axis"]
    keys = place_keys_right(truth_effect["effect"], truth_effect["where"], claim, duration_s)
    if whole and not axes:
        axes = true_axes
    strong = {a for a, worth in truth_effect["nats_of_axis"].items() if worth >= WEAK_NATS}
    return keys and axes == true_axes, keys and strong <= axes <= true_axes and bool(axes)


def _acting(context, effect, params, axes):
    cls = CATALOGUE.get(effect) or FOREIGN[effect]
    return cls(context, params, list("xyz") if cls.whole or not axes else list(axes))


def true_description(context, truth):
    out = Description()
    for e in truth["effects"]:
        _acting(context, e["effect"], e["params"], e["axes"]).describe(out)
    return out


def claimed_description(context, answer, corrected):
    """(description, what could not be understood)."""
    out, unread = Description(), []
    if corrected is not None:
        entries = corrected.get("effects", [])
        for axis, name in enumerate(AXES):
            entry = corrected.get("axes", {}).get(name)
            if entry and all(key in entry for key in "NBK"):
                out.stated[axis] = (float(entry["N"]), float(entry["B"]), float(entry["K"]))
    else:
        entries = answer["causes"]
    for entry in entries:
        try:
            params = dict(entry["params"])
            for axis, own in entry.get("params_by_axis", {}).items():
                for name, value in own.items():
                    params[name] = {**(params[name] if isinstance(params.get(name), dict) else {}), axis: value}
            _acting(context, entry["effect"], params, entry.get("axes", [])).describe(out)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            unread.append(f"{entry.get('effect')}: {error}")
    return out, unread


def true_shrink(truth, model, answer, corrected):
    """(shrink, what could not be understood)."""
    context = context_of(truth["made"], model=model)
    free = truth["foreign"] and all(getattr(FOREIGN[e["effect"]], "free", False) for e in truth["effects"])
    made = true_description(context, truth)
    whole = nats(context, made, Description(), free=free, apart=True, perfect=truth["refitted"])
    claimed, unread = claimed_description(context, answer, corrected)
    left = nats(context, made, claimed, free=free, apart=True, perfect=truth["refitted"])
    return float(np.clip(1.0 - left / max(whole, 1e-9), 0.0, 1.0)), unread


def deviations(effect, cause):
    """By parameter, how many of its stated standard deviations the cause's lies beside the truth. Left out: what one
    recording does not tell (from which frequency a line is folded, how a common noise is shared out between its size
    and its gains), and what is a choice."""
    off = {}
    for name, sd in cause.get("sd", {}).items():
        true, said = effect["params"].get(name), cause["params"].get(name)
        numbers = all(isinstance(v, (int, float)) for v in (true, said, sd))
        free = effect["effect"] == "common_mode" or (effect["effect"] == "tone" and name == "f_hz")
        if not numbers or sd <= 0.0 or free:
            continue
        turned = math.remainder(said - true, 2.0 * math.pi) if name == "phase_rad" else said - true
        off[name] = turned / sd
    return off
