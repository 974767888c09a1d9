#include "host/report/next_recording.hpp"

#include <algorithm>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "analysis/noise/walk_knowledge.hpp"
#include "host/base/counted.hpp"
#include "host/formats/uncertain_number.hpp"

namespace gyrolog {
namespace {

using State = FittedCoefficient::State;

// A term is identified when its square is more than two standard deviations above zero (noise_fit.hpp), that
// is the term itself four.
constexpr double identified_sd = 0.25;
// As the live view has it of K.
constexpr double wanted_sd = 0.2;
// Longer than anybody records: the answer is another one then.
constexpr double year_s = 365.25 * 86400.0;

std::string listed(const std::vector<std::string>& axes) { return fmt::format("{}", fmt::join(axes, ", ")); }

std::string length_text(double length_s) {
    constexpr double day_s = 86400.0;
    return length_s < 2.0 * day_s ? duration_text(length_s) : fmt::format("{:.3g} days", length_s / day_s);
}

// Axes of which one sentence is said, and the longest recording that one of them takes.
struct AxesNamed {
    std::vector<std::string> axes;
    double length_s = 0.0;
    bool is_out_of_reach = false;

    void add(const std::string& axis, const std::optional<double>& needed_s) {
        axes.push_back(axis);
        is_out_of_reach = is_out_of_reach || !needed_s || *needed_s > year_s;
        if (needed_s) { length_s = std::max(length_s, *needed_s); }
    }
};

using LengthNeeded = std::function<std::optional<double>(const NoiseCoefficients&, double relative_sd)>;

double& value_of(NoiseCoefficients& noise, NoiseTerm term) {
    return term == NoiseTerm::B ? noise.B_rad_per_s : noise.K_rad_per_s_sqrt_s;
}

// One sensor of a recording, and what stands before a sentence of it.
struct SensorAxes {
    const std::vector<AxisReport>& axes;
    const AnalysisReport& analysis;
    std::string of;
};

void add_unidentified(std::vector<std::string>& sentences, const SensorAxes& sensor, NoiseTerm term,
                      const LengthNeeded& needed) {
    AxesNamed asked;
    for (const AxisReport& axis : sensor.axes) {
        const FittedCoefficient& fitted = axis.fit[term];
        if (fitted.state == State::identified) { continue; }
        NoiseCoefficients noise = axis.fit.best.coefficients;
        value_of(noise, term) = 0.5 * fitted.upper;
        asked.add(axis.axis, needed(noise, identified_sd));
    }
    if (asked.axes.empty()) { return; }
    std::string sentence = fmt::format("{}{} of {} is not identified in {}", sensor.of, name_of(term),
                                       listed(asked.axes), duration_text(sensor.analysis.duration_s));
    if (asked.is_out_of_reach) {
        sentence +=
            ", and no recording of a year would do, were it half of its upper limit: for a filter "
            "that limit is the answer.";
    } else {
        sentence += fmt::format(": were it half of its upper limit, a recording of {} would identify it.",
                                length_text(asked.length_s));
    }
    sentences.push_back(std::move(sentence));
}

void add_vague(std::vector<std::string>& sentences, const SensorAxes& sensor, NoiseTerm term,
               const LengthNeeded& needed) {
    AxesNamed asked;
    double worst_sd = 0.0;
    for (const AxisReport& axis : sensor.axes) {
        const FittedCoefficient& fitted = axis.fit[term];
        if (fitted.state != State::identified) { continue; }
        if (std::round(100.0 * fitted.sd / fitted.value) <= 100.0 * wanted_sd) { continue; }  // as it is told
        worst_sd = std::max(worst_sd, fitted.sd / fitted.value);
        asked.add(axis.axis, needed(axis.fit.best.coefficients, wanted_sd));
    }
    if (asked.axes.empty() || asked.is_out_of_reach || asked.length_s <= sensor.analysis.duration_s) {
        return;
    }
    sentences.push_back(fmt::format("{}{} of {} is known to ±{:.0f} %; ±{:.0f} % take a recording of {}.",
                                    sensor.of, name_of(term), listed(asked.axes), 100.0 * worst_sd,
                                    100.0 * wanted_sd, length_text(asked.length_s)));
}

bool any_without(const SensorAxes& sensor, NoiseTerm term) {
    return std::ranges::any_of(
        sensor.axes, [&](const AxisReport& axis) { return axis.fit[term].state == State::not_identifiable; });
}

void add_other_terms(std::vector<std::string>& sentences, const SensorAxes& sensor) {
    if (any_without(sensor, NoiseTerm::N)) {
        sentences.push_back(
            sensor.of +
            "N is not identified: record for longer, with the sensor's filter off or wider, so that its "
            "white "
            "noise shows.");
    }
    if (any_without(sensor, NoiseTerm::Q)) {
        sentences.push_back(
            sensor.of +
            "Q is told by the rate, not by the length: where a filter works with short increments, record "
            "once at the highest rate and with the filter off.");
    }
    if (any_without(sensor, NoiseTerm::R)) {
        sentences.push_back(
            sensor.of +
            "No ramp R stands out; that takes a longer recording after a warm-up, at one temperature.");
    }
}

void add_whole(std::vector<std::string>& sentences, const AnalysisReport& analysis, bool has_temperature) {
    if (analysis.samples_missing > 0) {
        sentences.push_back(fmt::format(
            "{} missing: find the cause first (`gyrolog check` of a capture names it), then record again.",
            counted(static_cast<std::uint64_t>(analysis.samples_missing), "sample")));
    }
    if (analysis.stamps != StampKind::sampling) {
        sentences.emplace_back(
            "Record time stamps of the sampling instants: without them a lost sample goes unseen.");
    }
    if (!has_temperature) {
        sentences.emplace_back(
            "Record the temperature (temp_C), and once while it rises and falls by some degrees: the bias "
            "of most MEMS gyros moves with it.");
    }
}

void add_of_sensor(std::vector<std::string>& sentences, const SensorAxes& sensor) {
    const double rate_hz = sensor.analysis.rate_hz;
    const LengthNeeded for_walk = [=](const NoiseCoefficients& noise, double sd) {
        return length_to_know_walk_s(noise, rate_hz, sd);
    };
    const LengthNeeded for_flicker = [=](const NoiseCoefficients& noise, double sd) {
        return length_to_know_flicker_s(noise, rate_hz, sd);
    };
    add_unidentified(sentences, sensor, NoiseTerm::B, for_flicker);
    add_unidentified(sentences, sensor, NoiseTerm::K, for_walk);
    add_vague(sentences, sensor, NoiseTerm::B, for_flicker);
    add_vague(sentences, sensor, NoiseTerm::K, for_walk);
    add_other_terms(sentences, sensor);
}

}  // namespace

std::vector<std::string> next_recordings(const AnalysisReport& analysis, bool has_temperature) {
    std::vector<std::string> sentences;
    add_whole(sentences, analysis, has_temperature);
    add_of_sensor(sentences, {analysis.axes, analysis, analysis.accelerometer ? "Gyro: " : ""});
    if (analysis.accelerometer) {
        add_of_sensor(sentences, {analysis.accelerometer->axes, analysis, "Accelerometer: "});
    }
    return sentences;
}

}  // namespace gyrolog
