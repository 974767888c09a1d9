// What an effect leaves in a recording, as far as its estimator needs it: declared beside the effect's
// simulator. Data and plain formulas only; the estimators are elsewhere (analysis/diagnose/).
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/simulate/course.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct Recording;
class EffectUse;

// Two-sided density of the samples at one frequency below half the rate, aliases included, in (rad/s)^2/Hz.
struct SpectralParts {
    double white = 0.0;
    double flicker = 0.0;
    double walk = 0.0;
    // Before the sensor's filter, and not scaled by N, B and K: white noise, and what is filtered as a
    // signal.
    double added_white = 0.0;
    double added_signal = 0.0;
    double other = 0.0;  // after it: quantisation, the reference's noise, bands

    // What the coefficients N, B and K do not scale.
    double beside_coefficients() const { return added_white + added_signal + other; }
    double sum() const { return white + flicker + walk + beside_coefficients(); }
};

// The parameters of one entry, with the effect's own values for those that it leaves out.
class EffectValues {
public:
    explicit EffectValues(const EffectModel& effect, std::size_t axis = 0) : effect_(&effect), axis_(axis) {}
    double operator[](std::string_view param) const;
    Course course() const;                      // of an effect with a table
    std::size_t axis() const { return axis_; }  // on which it is looked at

private:
    const EffectModel* effect_;
    std::size_t axis_;
};

// Of a time from the first sample and a temperature.
using WhiteGain = std::function<double(double time_s, double temperature_C)>;

// Values of one parameter to start from.
struct TrialValues {
    std::string_view param;
    double from = 0.0;
    double to = 0.0;
    int count = 1;  // spaced by a constant factor
    // `from` and `to` say how far below the largest rate of an axis, as shares of it; for each axis in turn.
    bool below_peak = false;
};

enum class EvidenceMethod {
    response,               // the mean answer to the world
    spectrum,               // of the noise
    line,                   // a steady line in the spectrum
    narrow_band,            // noise about a frequency
    step,                   // a jump at an unknown moment
    random_telegraph,       // a hidden Markov chain
    tails,                  // distribution of the whitened samples
    outliers,               // single samples
    variance_change_point,  // their variance over time
    variance_with_temperature,
    density_table,      // of the noise, without a formula
    temperature_table,  // of the mean over the temperature, likewise
    rate_table,         // over the rate
    shared_noise,       // between axes
    disturbances,       // from outside, at rest
    repeats,            // samples that are the ones before again
    quantisation_step,  // the converter's
    saturation,         // a largest rate
    stamp_gaps,
    stamp_rate,
    stamp_jitter,
    described,  // by a person: nothing looks for it unasked
};

enum class PlaceKind { spectrum, time, instant, temperature, acceleration, rate, amplitude, structure };

struct EffectSignature {
    EvidenceMethod method = EvidenceMethod::spectrum;
    PlaceKind place = PlaceKind::spectrum;
    std::string_view structure{};    // with PlaceKind::structure
    std::string_view rates_up_to{};  // with PlaceKind::rate: the parameter, in deg/s, that ends the place

    bool needs_temperature = false;
    bool needs_reference = false;
    bool needs_change = false;  // of the reference: what shows nothing where that is constant
    bool needs_specific_force = false;
    bool whole_sensor = false;  // acts on all axes alike, whatever the entry says

    // Parameters to which the mean response is proportional, each by itself; without them the response is
    // what the simulator makes of the trial values.
    std::span<const std::string_view> linear{};
    bool changes_mean = false;  // beside the spectrum
    bool folds = false;         // what it leaves of fast noise depends on how it is sampled
    bool event = false;         // at one time of a recording: another recording has it not, or elsewhere
    bool slow = false;          // the mean response is: nothing in it is faster than some ten seconds
    // Every group is a way to vary other parameters, as a product; one group is enough for most.
    std::span<const std::span<const TrialValues>> trials{};
    // Positive parameters of the spectrum that are fitted, from the trial values on where they have some.
    std::span<const std::string_view> spectral{};
    // Those of them that all axes have in common.
    std::span<const std::string_view> common{};
    // A further parameter of the spectrum, of which only these values are tried: its forms. 0: an entry does
    // without it.
    std::string_view form{};
    std::span<const double> form_values{};
    // The coefficient of the model's slow noise, B or K, that the effect adds to; 0: none.
    char slow_coefficient = 0;
    // Changes the expected parts, one for each frequency, in place. The frequencies rise; what is narrower
    // than their distance is averaged over it.
    void (*spectrum)(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                     std::span<SpectralParts> parts) = nullptr;

    // Sets to false, by row, what an entry of the model has spoilt for judging anything else.
    void (*unjudged)(const Recording& recording, const EffectModel& entry,
                     std::vector<bool>& judged) = nullptr;

    // Degrees of freedom of Student's t, where that is the distribution of the white noise.
    double (*degrees_of_freedom)(const EffectValues& effect) = nullptr;
    // By what factor an entry changes the standard deviation of the white noise.
    WhiteGain (*white_gain)(const EffectUse& use) = nullptr;

    // Standard deviation of the sampling instants of an entry whose stamps do not show it; else 0.
    double (*instant_sd_s)(const EffectValues& effect) = nullptr;
    // An entry loses samples that the stamps do not tell of: where the others belong is read from the motion.
    bool (*hides_losses)(const EffectValues& effect) = nullptr;

    // For the report: a sentence with {parameter} where a fitted value belongs; what "the model has ... that
    // the recording lacks", likewise; and the recording that would tell the effect from its rivals, with
    // {length} where that depends on how far the rivals are behind. They say what is seen, not what made it.
    std::string_view words{};
    std::string_view noun{};
    std::string_view decided_by{};
    // The same of an accelerometer, where those speak of rates.
    std::string_view force_words{};
    std::string_view force_noun{};
    std::string_view force_decided_by{};
};

}  // namespace gyrolog
