// The answer: where a recording and its model part, which effect it is, and how far the gap closes with it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/calibration/split_half_result.hpp"
#include "analysis/diagnose/finding.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

enum class Verdict { none, known, unexplained };

struct Rival {
    std::string effect;
    double evidence_below_best_nats = 0.0;  // by how much its log Bayes factor is less
};

struct Cause {
    Finding finding;
    double score = 0.0;            // probability that it is right
    std::vector<Rival> tie_group;  // what this recording cannot tell apart from it, itself first; empty: none
    double shrink_alone = 0.0;
    std::string decided_by;  // the recording that would break the tie, with the length it needs; or ""
};

// In units of the distance between two simulations.
struct Gap {
    double value = 0.0;
    double floor = 1.0;
    double lo = 0.0;  // 95 %
    double hi = 0.0;
};

struct Untestable {
    std::string effect;
    std::string why;  // "the recording has no temperature"
};

// One panel of the figure and one line of the report's table of places: numbers of the recording against what
// simulations give, before and after the causes were added to the model.
struct GapDomain {
    std::string name;    // "Allan deviation", "spectrum", "temperature", ...
    std::string x_name;  // with unit: "averaging time (s)"
    std::string y_name;
    bool log_x = false;
    bool log_y = false;
    std::size_t axis = 0;
    bool of_all_axes = false;
    std::vector<double> x;
    std::vector<double> recording;
    std::vector<double> before_lo, before_hi;  // band of simulations, see band_probability
    std::vector<double> after_lo, after_hi;    // empty where nothing was added
    std::vector<bool> outside_before, outside_after;
    double gap_before = 0.0;  // rms of the standardised differences; 1 is the floor
    double gap_after = 0.0;
    // -ln of the probability that a simulation is as far off here. With as many domains as there are, one or
    // another reaches some 7 by chance.
    double surprise_before_nats = 0.0;
    double surprise_after_nats = 0.0;

    std::string axis_text() const { return of_all_axes ? "all" : axis_names.at(axis); }
};

// One that no effect of the catalogue has (nonparametric_alternatives.hpp) and that tells the recording
// better.
struct BetterShape {
    std::string words;
    std::vector<std::string> than;  // effects among the causes; empty: than the model alone
    double evidence_nats = 0.0;     // by how much its log Bayes factor is more
};

// One of two passes over a long recording (long_diagnosis.hpp).
struct Pass {
    double duration_s = 0.0;
    std::size_t rows = 0;
    std::size_t samples_per_row = 1;
    Verdict verdict = Verdict::none;
    double p_none = 1.0;
};

struct Diagnosis {
    std::string recording_name;
    std::string model_name;
    double duration_s = 0.0;
    double rate_hz = 0.0;
    std::size_t samples = 0;
    std::size_t simulations = 0;
    double band_probability = 0.95;
    std::uint64_t seed = 1;
    std::vector<std::size_t> axes;
    std::vector<Pass> passes;  // empty: it was seen as a whole, at once

    Verdict verdict = Verdict::none;
    double p_none = 1.0;
    double p_left = 1.0;  // of what the causes leave
    std::vector<Cause> causes;
    std::optional<BetterShape> better_shape;  // then the causes do not explain the gap
    // Noise of the model that held part of the causes, and what it is with them in the model.
    std::vector<NoiseRefit> noise_refits;
    Place where;  // the gap; of a known one, its first cause
    Place left;   // with Verdict::unexplained and causes: what they leave
    Gap gap_before, gap_after;
    double shrink = 0.0, shrink_lo = 0.0, shrink_hi = 0.0;
    SplitHalfResult split_half;  // with Verdict::known
    std::string held_out;  // the name of the second recording that the gap was measured on; empty without one
    std::vector<GapDomain> domains;
    std::vector<Untestable> untestable;
    std::vector<std::string> next_recordings;  // what would settle what is open, in sentences
    std::vector<std::string> warnings;
    SensorModel corrected;  // the model with the causes added and its noise refitted
};

// How a next recording begins that would settle a tie of the effect.
std::string telling_apart(const std::string& effect);

// `model` with what the diagnosis found: its noise refits, its causes, and on its axes the bias of
// `centred`.
SensorModel corrected_model(SensorModel model, const Diagnosis& diagnosis, const SensorModel& centred);

// Sentences that are not there yet.
void append_new(std::vector<std::string>& to, const std::vector<std::string>& from);

struct DiagnosisOptions {
    std::uint64_t seed = 1;
    std::size_t simulations = 200;
    // A gap is called where chance would have it no more often; what causes leave, half as often.
    double false_alarms_most = 0.01;
    // 0: all processors, fewer where their simulations would take more than `simulations_bytes_most` at a
    // time. The result is the same for any number.
    unsigned threads = 0;
    double simulations_bytes_most = 4e9;
    std::shared_ptr<const Recording> holdout{};
    // With what is being done and its share from 0 to 1; false ends the work.
    std::function<bool(const char*, double)> on_progress{};
};

// `recording` has no diagnosis_refusal(), `model` no simulation_refusal(). No value when ended early.
std::optional<Diagnosis> diagnose(std::shared_ptr<const Recording> recording, const SensorModel& model,
                                  const std::string& model_name, const DiagnosisOptions& options = {});

}  // namespace gyrolog
