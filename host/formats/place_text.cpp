#include "host/formats/place_text.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/standard_gravity.hpp"
#include "host/formats/effect_words.hpp"
#include "host/formats/uncertain_number.hpp"

namespace gyrolog {
namespace {

// Four digits: lines are narrow.
std::string frequency_of_place(double f_hz) {
    if (f_hz < 0.1) { return fmt::format("{:.4g} mHz", f_hz * 1e3); }
    return f_hz < 1000.0 ? fmt::format("{:.4g} Hz", f_hz) : fmt::format("{:.4g} kHz", f_hz / 1e3);
}

// "60 s to 15 min" behind `range`; where both ends read alike, one of them behind `point`.
template <typename Text>
std::string span_text(const Span& span, Text text, const char* range, const char* point) {
    const std::string from = text(span.from);
    const std::string to = text(span.to);
    return from == to ? point + from : fmt::format("{}{} to {}", range, from, to);
}

}  // namespace

std::string place_text(const Place& place) {
    std::vector<std::string> parts;
    if (!place.axes.empty()) {
        parts.push_back(axes_text(place.axes) + (place.axes.size() == 1 ? " axis" : " axes"));
    }
    if (place.tau_s) {
        parts.push_back(span_text(*place.tau_s, duration_text, "averaging times ", "averaging time "));
    }
    if (place.freq_hz) { parts.push_back(span_text(*place.freq_hz, frequency_of_place, "", "at ")); }
    if (place.time_s) {
        parts.push_back(span_text(*place.time_s, duration_text, "from ", "at ") + " after the first sample");
    }
    if (place.temperature) { parts.emplace_back("with the temperature"); }
    if (place.acceleration) { parts.emplace_back("with the specific force"); }
    if (place.rate_rad_s) {
        parts.push_back(fmt::format("rates of {:.3g} to {:.3g} deg/s", place.rate_rad_s->from * deg_per_rad,
                                    place.rate_rad_s->to * deg_per_rad));
    }
    if (place.force_m_s2) {
        parts.push_back(fmt::format("forces of {:.3g} to {:.3g} g",
                                    place.force_m_s2->from / standard_gravity_m_s2,
                                    place.force_m_s2->to / standard_gravity_m_s2));
    }
    if (place.amplitude_sigma) {
        parts.push_back(fmt::format("samples {:.2g} to {:.2g} standard deviations off",
                                    place.amplitude_sigma->from, place.amplitude_sigma->to));
    }
    if (!place.structure.empty()) {
        std::string structure = place.structure;
        std::ranges::replace(structure, '_', ' ');
        parts.push_back(structure);
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace gyrolog
