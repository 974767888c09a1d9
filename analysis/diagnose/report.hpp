// What a diagnosis says, as data: a verdict, the causes with their parameters, the gap with its place, what
// was compared, and what stays open. Everything in the diagnosis may include this file; it includes nothing
// of the diagnosis.
//
// Rates are in rad/s (of an accelerometer, what stands for them: accelerometer_as_gyro.hpp), times in s,
// frequencies in Hz, evidence in nats. Parameters of an effect are in the effect's own units, which its names
// end in. Axes are 0, 1, 2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// In the order of what stays open.
enum class Verdict {
    none,        // the recording could have come from the model
    known,       // with the causes in it, the model could have made the recording, or nearly
    partly,      // the causes explain a part of the gap that is worth having
    unexplained  // there is a gap, and no cause explains such a part
};

// Which side has the effect.
enum class Sense {
    recording_has,  // the model lacks it
    model_has       // the recording lacks it
};

struct Span {
    double from = 0.0;
    double to = 0.0;
};

// A share of the gap's square, with its 95 % interval.
struct Share {
    double value = 0.0;
    double lo = 0.0;
    double hi = 0.0;
};

// A place is where a gap lies. What does not apply is empty.
struct Place {
    std::vector<std::size_t> axes;
    std::optional<Span> freq_hz;
    std::optional<Span> tau_s;   // averaging times
    std::optional<Span> time_s;  // from the recording's first sample; equal for an instant
    bool temperature = false;
    bool acceleration = false;
    std::optional<Span> rate_rad_s;       // sizes of the reference rate
    std::optional<Span> force_m_s2;       // of an accelerometer: of the specific force
    std::optional<Span> amplitude_sigma;  // sizes of the whitened samples, in standard deviations
    std::string structure;                // "duplicated_samples", "timestamp_gaps", ...: diagnosis.md
};

// A finding is the best that one effect can do for one observation.
struct Finding {
    std::string effect;
    SensorKind sensor = SensorKind::gyro;  // whose words tell of it
    // These entries are to be added to the model: one entry for all axes that share their parameters.
    std::vector<EffectModel> entries;
    // Standard deviations, by entry, of the parameters that were fitted.
    std::vector<std::map<std::string, double>> sd;
    // The maximum of the log-likelihood with the effect less the maximum without it, the nuisance refitted in
    // both.
    double gain_nats = 0.0;
    // The log Bayes factor against the model as it is: the gain less what the freedom of the parameters earns
    // by chance (Laplace's approximation, with the effect's plausible ranges as prior). Below 0 the effect is
    // not called for.
    double evidence_nats = 0.0;
    int parameters = 0;  // that were fitted
    std::array<double, 3> axis_gain_nats{};
    // Of an effect that is told beside the spectra: the part of it that the spectra's likelihood has as well,
    // with the entries in the model.
    std::array<double, 3> axis_spectral_nats{};
    Place where;

    double spectral_nats() const {
        return axis_spectral_nats[0] + axis_spectral_nats[1] + axis_spectral_nats[2];
    }
    double beside_nats() const { return gain_nats - spectral_nats(); }
};

// A noise refit is a coefficient of the model that the recording has otherwise, once the causes are in the
// model. The values are in SI units of the two-sided convention.
struct NoiseRefit {
    std::size_t axis = 0;
    char coefficient = 'N';  // 'N', 'B', 'K'
    double stated = 0.0;
    double fitted = 0.0;
    double fitted_sd = 0.0;
};

// A rival could stand in a cause's place.
struct Rival {
    std::string effect;
    double evidence_below_best_nats = 0.0;  // by how much its log Bayes factor is less
};

struct Cause {
    Finding finding;
    Sense sense = Sense::recording_has;
    // The probability that the cause is right, against all that could stand in its place: rivals, shapes
    // without a name, nothing. What else is left of the gap has no part in it.
    double score = 0.0;
    // What this recording cannot tell apart from the cause, the cause itself first; empty where there is
    // nothing.
    std::vector<Rival> tie_group;
    Share share;             // what returns when this cause alone is taken out of the model again
    std::string decided_by;  // the recording that would break the tie, with the length it needs; or ""
};

// The unnamed is what was modelled without an effect: a free density, drift, mean or noise level, or
// stretches of time that were masked.
struct Unnamed {
    std::string form;  // "density", "drift", "temperature", "rate", "level", "masked"
    Place where;
    double share = 0.0;                  // of the gap's square
    std::vector<EffectModel> entries{};  // to be added to the model
};

// What nothing describes.
struct Left {
    Place where;
    double size = 0.0;  // rms of the standardised differences there; 1 is the floor
};

// The gap is the distance between the recording and the model's simulations, in units of the distance between
// two simulations (calibration/measured_gap.hpp).
struct Gap {
    double value = 0.0;
    double floor = 1.0;
    double lo = 0.0;  // the 95 % interval
    double hi = 0.0;
};

// An effect that a person describes, to ask whether the data call for it.
struct DescribedEffect {
    std::string name;   // the person's own
    EffectModel entry;  // one of the simulator's effects, with the described parameters or table
};

struct Asked {
    DescribedEffect described;
    // How much of it there is: 1 as described. Nothing of an effect without a size that could vary.
    struct Amount {
        double value = 0.0;
        double sd = 0.0;
    };
    // The log-likelihood with it, of the most likely amount, less the one without it.
    struct Answer {
        std::optional<Amount> amount;
        double gain_nats = 0.0;
        double described_nats = 0.0;  // of what is described
        // That chance gains as much: of an amount by Wilks 1938; of what is taken as described no more than
        // exp(-gain_nats), by Markov's inequality.
        double p = 1.0;
        bool is_called_for = false;
    };
    Answer beside;  // the causes
    Answer alone;   // in the first model
};

struct Untestable {
    std::string effect;
    std::string why;  // "the recording has no temperature"
};

// A gap domain is one panel of the figure and one line of the report's table of places: numbers of the
// recording against those of simulations, before and after the causes were added to the model. The units are
// those of the names.
struct GapDomain {
    std::string name;    // "Allan deviation", "spectrum", "temperature", ...
    std::string x_name;  // with its unit: "averaging time (s)"
    std::string y_name;
    bool log_x = false;
    bool log_y = false;
    bool is_course = true;                // false: the x are 1, 2, ..., of things side by side
    std::vector<std::string> categories;  // their names, where they have any
    std::size_t axis = 0;
    bool of_all_axes = false;
    std::vector<double> x;
    std::vector<double> recording;
    std::vector<double> before_lo, before_hi;  // the band that simulations fill: Diagnosis::band_probability
    std::vector<double> after_lo, after_hi;    // empty where nothing was added
    std::vector<bool> outside_before, outside_after;
    double gap_before = 0.0;  // rms of the standardised differences; 1 is the floor
    double gap_after = 0.0;
    // -ln of the probability that a simulation is as far off here.
    double surprise_before_nats = 0.0;
    double surprise_after_nats = 0.0;
    bool stands_out = false;  // before or after: rarer than chance has it in any domain

    std::string axis_text() const { return of_all_axes ? "all" : axis_names.at(axis); }
};

// What a recording tells of its reference, before the sensor is judged by it
// (calibration/reference_error.hpp).
struct ReferenceQuality {
    bool is_orientation = false;
    std::size_t gyros = 0;            // others of an array, that it is a mean of; 0: none
    bool is_known_at_rest = false;    // otherwise its error is not known without the sensor's noise
    std::size_t samples_per_row = 1;  // that a rate of the reference is a mean of
    // One sigma of such a rate, by axis: in the tenth of the time where it is least, and where it is most. If
    // it is known at rest, both are the same.
    std::array<Span, 3> error_rad_s{};
    // Of the sensor against the reference. Which of the two is late nobody can tell.
    double latency_s = 0.0;
    double latency_sd_s = 0.0;
    // Up to which the reference explains at least half of the power that the sensor shows, on any axis.
    double bandwidth_hz = 0.0;
};

// A better shape is one that no effect of the catalogue has (selection/nonparametric_alternatives.hpp) and
// that tells the recording better than the causes do.
struct BetterShape {
    std::string words;
    std::vector<std::string> than;  // effects among the causes; empty: than the model alone
    double evidence_nats = 0.0;     // by how much its log Bayes factor is more
};

// A long recording is seen in two passes (multiscale/long_diagnosis.hpp), as is one that moves against an
// orientation (multiscale/motion_diagnosis.hpp).
struct Pass {
    double duration_s = 0.0;
    std::size_t rows = 0;
    std::size_t samples_per_row = 1;
    Verdict verdict = Verdict::none;
    double p_none = 1.0;
    bool is_at_rest = false;  // the longest rest; else the beginning, in single samples, or all, in means
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
    SensorUnit unit = SensorUnit::dps();        // of the sensor, for readers
    std::vector<Pass> passes;                   // empty: the recording was seen in one
    std::optional<ReferenceQuality> reference;  // of one whose quality no model states

    Verdict verdict = Verdict::none;
    double p_none = 1.0;
    double p_left = 1.0;  // of what the causes leave
    std::vector<Cause> causes;
    std::optional<BetterShape> better_shape;  // then the causes do not explain the gap
    // Noise of the model that held part of the causes, and what it is with them in the model.
    std::vector<NoiseRefit> noise_refits;
    Place where;  // of the gap; with Verdict::known, of the first cause
    std::vector<Unnamed> unnamed;
    std::vector<Left> left;  // the largest first
    // The gaps of the first model, of the model with the causes, and of that with the unnamed forms as well,
    // measured by simulating, on data that the fit did not use.
    Gap gap_before, gap_named, gap_after;
    Share shrink;                  // the share of the gap that the causes close
    double shrink_modelled = 0.0;  // that the causes and the unnamed forms close
    // A simulation's surprisal, and what the recording has more under the first model. Gaps are made of them.
    double floor_nats = 0.0;
    double excess_nats = 0.0;
    // Effects that were measured on the data that they were fitted to: half a recording does not tell them.
    std::vector<std::string> not_held_out;
    std::string held_out;  // the name of the second recording that the gap was measured on; empty without one
    std::vector<GapDomain> domains;
    std::vector<Untestable> untestable;
    std::vector<Asked> asked;                  // in the order of the questions
    std::vector<std::string> next_recordings;  // what would settle what is open, in sentences
    std::vector<std::string> warnings;
    SensorModel corrected;  // the model with the causes added and its noise refitted
};

}  // namespace gyrolog
