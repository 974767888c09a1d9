"""One answer held against one truth: what did it name, is the place right, how far is the gap shrunk.

The true shrink of an answer is 1 - E(truth | claimed) / E(truth | nothing): the evidence that the data hold against
the corrected model, over what they hold against the first one (evidence.py, N, B, K, M, latency and clock free within
what the model states, a difference of the means counted as its square). Right parameters give 1; an effect
that is not there, or that changes something else, gives 0 or less, which counts as 0; a wrong name whose
simulation does what the truth does is given what it earns. The corrected model is the one handed back with
--model-out; without it, the causes' params.

The true share of a cause is E(truth | truth without that effect, on the cause's axes) / E(truth | nothing): what
returns if it alone is taken out again. A cause that is not in the truth has the share 0.
"""

import numpy as np

from effects import CATALOGUE
from evidence import AXES, Description, nats
from foreign import FOREIGN
from generate import context_of

WEAK_NATS = 8.0  # an axis that holds less of the evidence may be missing from the answer
TIE_MOST = 3  # a tie of more effects names none but the first


def tie_of(cause):
    return set(cause.get("tie_group") or []) | {cause["effect"]}


def names(cause, effect):
    """By its name, or in a declared tie of at most three."""
    return cause["effect"] == effect or (len(tie_of(cause)) <= TIE_MOST and effect in tie_of(cause))


def right_names(effect):
    """Of an effect of the truth: its own, and what the contract has for one that the catalogue does not make."""
    other = getattr(FOREIGN.get(effect), "described_as", None)
    return [effect] + ([other] if other else [])


def is_right(cause, effect):
    """The cause names the effect of the truth, on at least one of its axes."""
    claimed = set(cause["axes"])
    meets = not claimed or not effect["nats_of_axis"] or bool(claimed & set(effect["axes"]))
    return (meets and cause["sense"] == "recording_has"
            and any(names(cause, name) for name in right_names(effect["effect"])))


def named_effects(causes, effects):
    """Indices of the effects that a cause each names: as many as can be, each cause for one."""
    cause_of = {}

    def give(e, tried):
        for c in sorted(range(len(causes)), key=lambda c: causes[c]["effect"] != effects[e]["effect"]):
            if c in tried or not is_right(causes[c], effects[e]):
                continue
            tried.add(c)
            holder = next((other for other, mine in cause_of.items() if mine == c), None)
            if holder is None or give(holder, tried):
                cause_of[e] = c
                return True
        return False

    for e in range(len(effects)):
        give(e, set())
    return sorted(cause_of)


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


class Case:
    """What the recording of a truth holds against descriptions of it, and against the model that was given."""

    def __init__(self, truth, model):
        self.effects = truth["effects"]
        self.context = context_of(truth["made"], model=model)
        self.free = truth["foreign"] and all(getattr(FOREIGN[e["effect"]], "free", False) for e in self.effects)
        self.perfect = truth["refitted"]
        self.made = true_description(self.context, truth)
        self.whole = max(self.against(Description()), 1e-9)

    def against(self, other):
        return nats(self.context, self.made, other, free=self.free, apart=True, perfect=self.perfect)

    def shrink(self, answer, corrected):
        """(shrink, what could not be understood)."""
        claimed, unread = claimed_description(self.context, answer, corrected)
        return float(np.clip(1.0 - self.against(claimed) / self.whole, 0.0, 1.0)), unread

    def share(self, cause):
        effect = next((e for e in self.effects if is_right(cause, e)), None)
        if effect is None:
            return 0.0
        effect = next((e for e in self.effects if is_right(cause, e) and e["effect"] == cause["effect"]), effect)
        without = Description()
        for e in self.effects:
            acting = _acting(self.context, e["effect"], e["params"], e["axes"])
            if e is not effect:
                acting.describe(without)
            elif cause["axes"] and not (acting.whole or acting.shared):
                kept = [a for a in acting.axes if a not in cause["axes"]]
                if kept:
                    acting.only_on(kept).describe(without)
        return float(self.against(without) / self.whole)


# By effect, parameters that one recording does not tell: from which frequency a line is folded, and with it the phase;
# how a common noise is shared out between its size and its gains.
NOT_TOLD = {"tone": ("f_hz", "phase_rad"),
            "narrowband": ("f_hz",),
            "common_mode": ("N_dps_per_sqrt_hz", "gain_x", "gain_y", "gain_z")}


def deviations(effect, cause):
    """By parameter and axis, how many of its stated standard deviations the cause's lies beside the truth. What is
    said once for several axes counts once, and only if the truth is one for them as well."""
    told = cause.get("params_by_axis") or {None: cause["params"]}
    sds = cause.get("sd_by_axis") or {None: cause["sd"]}
    off = {}
    for axis, params in told.items():
        for name, sd in sds.get(axis, {}).items():
            true = effect["params"].get(name)
            if isinstance(true, list):
                of = axis or (cause["axes"][0] if len(cause["axes"]) == 1 else None)
                true = true[effect["axes"].index(of)] if of in effect["axes"] else None
                key = (name, of)
            else:
                key = (name, params.get(name))
            numbers = all(isinstance(v, (int, float)) for v in (true, params.get(name), sd))
            if numbers and sd > 0.0 and name not in NOT_TOLD.get(effect["effect"], ()):
                off[key] = (params[name] - true) / sd
    return [(name, sds_off) for (name, _), sds_off in off.items()]
