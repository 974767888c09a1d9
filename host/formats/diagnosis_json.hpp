// A diagnosis for programs: schema gyrolog-diagnosis/2.
//
//   sensor                   "accelerometer" where it was that: its parameters and its noise are in g where a
//                            gyro's are in deg/s ("sigma_g" for "sigma_dps")
//   verdict                  "none", "known", "partly", "unexplained"
//   p_none, p_left           p-value of "no gap", before and after the causes were added
//   causes                   by share: {effect, sense, score, tie_group, axes, where, params, sd, share,
//                            share_lo, share_hi, sentence, gain_nats, evidence_nats}. sense: "recording_has"
//                            what the model lacks, or "model_has" what the recording lacks. tie_group begins
//                            with the effect itself. Parameters have the effect's own names and units. Where
//                            axes differ in them, `params` and `sd` are those of the axis with the largest
//                            gain, and params_by_axis, sd_by_axis (by "x", "y", "z") hold all. share: of the
//                            gap's square, what returns without this cause; shares may overlap. Where others
//                            tie: tie {effect: by how many nats of evidence it is behind}, decided_by (the
//                            recording that would decide)
//   noise_refitted           where the model's noise held part of the causes: [{axis, coefficient "N", "B" or
//                            "K", stated, fitted, sd}] in the model file's units
//   asked                    only where something was asked (--ask): [{name, effect, axes, beside_causes,
//   alone}],
//                            both {called_for, gain_nats, as_described_nats, p, amount, amount_sd}
//   unnamed                  what was modelled without an effect: [{form, axes, where, share}]; form:
//                            "density", "drift", "temperature", "rate", "level", "masked"
//   left                     what nothing describes, the largest first: [{where, size}], size in floors
//   where                    axes, freq_hz, tau_s, time_s, temperature, acceleration, rate_dps (of an
//                            accelerometer force_g), amplitude_sigma, structure: those that apply. Beside a
//                            key `axes` without axes
//   gap_before, gap_named, gap_after        {value, floor, lo, hi} of the model, with the causes, and with
//   the
//                            unnamed forms as well: in units of the distance between two simulations
//   shrink, shrink_lo, shrink_hi            1 - (named^2 - floor^2) / (before^2 - floor^2)
//   shrink_modelled          the same with `after`
//   held_out                 the second recording that the gap was measured on, or ""
//   not_held_out             the effects that were measured on the data that they were fitted to
//   recording, model, rate_hz, duration_s, samples, axes, simulations, band_probability, seed
//   domains                  [{name, axis, points, outside_before, outside_after, gap_before, gap_after}]
//   untestable               [{effect, why}]
//   next_recordings, warnings               sentences
//   accelerometer, shared    where both sensors were diagnosed: the same object, and the effects that both
//   have
//                            at the same place
//
// A number that is not finite is null.
#pragma once

#include <string>
#include <string_view>

#include "analysis/diagnose/report.hpp"
#include "host/formats/json_fwd.hpp"

namespace gyrolog {

std::string_view name_of(Verdict verdict);
std::string_view name_of(Sense sense);

std::string diagnosis_json(const Diagnosis& diagnosis);
// Of two sensors of one recording, and the effects that both have at the same place.
std::string diagnosis_json(const Diagnosis& gyro, const Diagnosis& accelerometer,
                           const std::vector<std::string>& shared);
Json diagnosis_object(const Diagnosis& diagnosis);

}  // namespace gyrolog
