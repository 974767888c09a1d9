"""Whether an answer has the form of `gyrolog-diagnosis/2`, and keeps what that form promises of its numbers. It knows
nothing of any truth."""

import math

from effects import CATALOGUE

SCHEMA = "gyrolog-diagnosis/2"
VERDICTS = ("none", "known", "partly", "unexplained")
SENSES = ("recording_has", "model_has")
UNNAMED_FORMS = ("density", "drift", "temperature", "rate", "level", "masked")
STRUCTURES = ("duplicated_samples", "timestamp_gaps", "timestamp_rate", "timestamp_jitter", "growing_lag",
              "cross_axis", "code_grid", "isolated_samples")
SPANS = ("freq_hz", "tau_s", "time_s", "rate_dps", "amplitude_sigma")
FLAGS = ("temperature", "acceleration")
# Effects of the contract that the catalogue here does not make. What is absent the model has and the recording lacks.
ABSENT = ("line_absent", "flicker_excess", "rrw_excess", "effect_absent")
EFFECTS = {*CATALOGUE, *ABSENT, "disturbance"}
TENTH = 0.1  # of the gap's square: what is worth a verdict
LIKELY = 0.5  # the score of a cause that a verdict may rest on
ROUNDED = 1e-6  # by how much printed numbers may miss what they are worked out from, in units of the gap's square


def number(value, low=-math.inf, high=math.inf):
    right_type = isinstance(value, (int, float)) and not isinstance(value, bool)
    return right_type and math.isfinite(value) and low <= value <= high


def an_effect(name):
    return isinstance(name, str) and name in EFFECTS


def ordered(*values):
    return all(number(v) for v in values) and all(a <= b for a, b in zip(values, values[1:]))


def _of_axes(value):
    return (isinstance(value, list) and all(a in ("x", "y", "z") for a in value)
            and len(value) == len({*value}))


def _place(where, path):
    if not isinstance(where, dict):
        return [path]
    out = []
    for key, value in where.items():
        right = ((key == "axes" and _of_axes(value))
                 or (key in SPANS and isinstance(value, list) and len(value) == 2 and ordered(*value))
                 or (key in FLAGS and value is True)
                 or (key == "structure" and value in STRUCTURES))
        if not right:
            out.append(f"{path}: {key}")
    return out


def _numbers(params, low=-math.inf):
    return isinstance(params, dict) and all(number(v, low) for v in params.values())


def _interval(of, key):
    return ordered(of.get(key + "_lo"), of.get(key), of.get(key + "_hi"))


def _cause(cause, path):
    if not isinstance(cause, dict):
        return [path]
    out = []

    def ask(right, key):
        if not right:
            out.append(f"{path}: {key}")

    effect, tie = cause.get("effect"), cause.get("tie_group")
    ask(an_effect(effect), "effect")
    ask(cause.get("sense") in SENSES and (effect not in ABSENT or cause["sense"] == "model_has"), "sense")
    ask(number(cause.get("score"), 0.0, 1.0), "score")
    ask(isinstance(tie, list) and all(map(an_effect, tie)), "tie_group")
    ask(_of_axes(cause.get("axes")), "axes")
    ask(_numbers(cause.get("params")), "params")
    ask(_numbers(cause.get("sd"), 0.0) and {*cause["sd"]} <= {*(cause.get("params") or {})}, "sd")
    ask(_interval(cause, "share"), "share")
    return out + _place(cause.get("where"), f"{path}: where")


def _unnamed(one, path):
    if not isinstance(one, dict):
        return [path]
    out = [] if one.get("form") in UNNAMED_FORMS else [f"{path}: form"]
    out += [] if _of_axes(one.get("axes")) else [f"{path}: axes"]
    out += [] if number(one.get("share")) else [f"{path}: share"]
    return out + _place(one.get("where"), f"{path}: where")


def _left(one, path):
    if not isinstance(one, dict):
        return [path]
    return ([] if number(one.get("size"), 0.0) else [f"{path}: size"]) + _place(one.get("where"), f"{path}: where")


def _gap(gap):
    return (isinstance(gap, dict) and number(gap.get("floor"), 1e-12) and number(gap.get("lo"), 0.0)
            and ordered(gap["lo"], gap.get("value"), gap.get("hi")))


def _shrinks(answer):
    """The share that is closed is the one that the three gaps say, where there is a gap at all."""
    out = []

    def square(key):
        return answer[key]["value"] ** 2 - answer[key]["floor"] ** 2

    whole = square("gap_before")
    for shrink, gap in (("shrink", "gap_named"), ("shrink_modelled", "gap_after")):
        said = 1.0 - square(gap) / whole if whole > ROUNDED else None
        # What cannot be closed more than wholly, or less than not at all, may be said so.
        near = said is not None and abs(min(max(said, 0.0), 1.0) - min(max(answer[shrink], 0.0), 1.0))
        if said is not None and near > ROUNDED * (1.0 + answer["gap_before"]["value"] ** 2 / whole):
            out.append(f"{shrink} is not what {gap} says")
    return out


def _verdict_keeps(answer):
    """What a verdict says of its causes and of the share that they close."""
    likely = [c for c in answer["causes"] if c["score"] >= LIKELY]
    verdict = answer["verdict"]
    if verdict == "known" and not answer["causes"]:
        return ["known without a cause"]
    if verdict == "partly" and not likely:
        return [f"partly without a cause of score {LIKELY}"]
    if verdict == "partly" and answer["shrink"] > 1.0 - TENTH:
        return ["partly, and less than a tenth is left"]
    if verdict == "unexplained" and likely and answer["shrink"] >= TENTH and any(c["share"] >= TENTH for c in likely):
        return ["unexplained, and a cause closes a tenth"]
    return []


def complaints(answer):
    """What the contract asks for and the answer does not have."""
    if not isinstance(answer, dict):
        return ["not an object"]
    out = []
    if answer.get("schema") != SCHEMA:
        out.append("schema")
    if answer.get("verdict") not in VERDICTS:
        out.append("verdict")
    if not number(answer.get("p_none"), 0.0, 1.0):
        out.append("p_none")
    for key, check in (("causes", _cause), ("unnamed", _unnamed), ("left", _left)):
        if isinstance(answer.get(key), list):
            for i, one in enumerate(answer[key]):
                out += check(one, f"{key}[{i}]")
        else:
            out.append(key)
    out += _place(answer.get("where"), "where")
    out += [key for key in ("gap_before", "gap_named", "gap_after") if not _gap(answer.get(key))]
    if answer.get("verdict") != "none":
        out += [] if _interval(answer, "shrink") else ["shrink"]
        out += [] if number(answer.get("shrink_modelled")) else ["shrink_modelled"]
    if out or answer["verdict"] == "none":
        return out
    shares = [c["share"] for c in answer["causes"]]
    if shares != sorted(shares, reverse=True):
        out.append("causes are not ranked by share")
    return out + _shrinks(answer) + _verdict_keeps(answer)
