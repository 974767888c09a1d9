#include "host/formats/filters/filter_format.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "host/formats/filters/filters.hpp"

namespace gyrolog {
namespace {

constexpr std::array<const FilterFormat*, 9> all_filter_formats = {
    &kalibr_format,        &openvins_format,        &vins_fusion_format,
    &orb_slam3_format,     &gtsam_format,           &px4_ekf2_format,
    &ardupilot_ek3_format, &sensor_msgs_imu_format, &robot_localization_format,
};

std::string with_rate(std::string_view pattern, const FilterSource& source) {
    return fmt::format(fmt::runtime(pattern), fmt::arg("rate", real_text(source.rate_hz)));
}

std::string unknown_text(const FilterNumber& number, const FilterSource& source) {
    const FilterTerm& term = source.term(number.sensor, number.term);
    const bool has_counts = number.sensor == SensorKind::accelerometer && source.accelerometer_has_counts;
    const char* unknown = has_counts             ? "the accelerometer has counts, --lsb-g gives their scale"
                          : term.of_axes.empty() ? "not measured"
                          : term.upper           ? "not identified"
                                                 : "the source has none";
    std::string text = fmt::format("{}: {}", number.key, unknown);
    if (term.upper) {
        text += fmt::format(", at most {} (at {:.3g} %)", real_text(number.of(*term.upper, source.rate_hz)),
                            source.confidence * 100.0);
    }
    return text;
}

std::string number_text(const FilterFormat& format, const FilterNumber& number, const FilterSource& source) {
    const FilterTerm& term = source.term(number.sensor, number.term);
    std::string text = fmt::format("\n# {}, of {}; axes: {}\n", number.unit,
                                   number.term == NoiseTerm::N ? "white noise N" : "rate random walk K",
                                   term.of_axes.empty() ? "none" : term.axes);
    if (!term.value) {
        text += "# " + unknown_text(number, source) + '\n';
        if (!format.missing.empty()) {
            text += fmt::format(fmt::runtime(format.missing), fmt::arg("key", number.key)) + '\n';
        }
        return text;
    }
    if (term.is_upper) {
        text +=
            fmt::format("# not identified: this is its upper limit at {:.3g} %\n", source.confidence * 100.0);
    }
    const double value = number.of(*term.value, source.rate_hz);
    if (number.most > 0.0 && value > number.most) {
        text += fmt::format("# more than the filter takes: {:.9g} acts\n", number.most);
    }
    return text +
           fmt::format(fmt::runtime(format.line), fmt::arg("key", number.key),
                       fmt::arg("value", real_text(value))) +
           '\n';
}

// Empty where none is one.
std::string keys_of_upper_limits(const FilterFormat& format, const FilterSource& source) {
    std::string keys;
    for (const FilterNumber& number : format.numbers) {
        if (!source.term(number.sensor, number.term).is_upper) { continue; }
        keys += (keys.empty() ? "" : ", ") + std::string(number.key);
    }
    return keys;
}

std::string head_text(const FilterFormat& format, const FilterSource& source) {
    std::string text = fmt::format(
        "# From {}, by gyrolog, for {}; of a sensor that is read {:.9g} times a "
        "second.\n# {} SI units; of each sensor the axis that has most.\n",
        source.name, format.name, source.rate_hz, with_rate(format.kind, source));
    if (source.has_converter_step) {
        text += "# White noise has the error of the converter's step in it, step^2 / 12 a sample.\n";
    }
    if (source.inflate != 1.0) {
        text += fmt::format(
            "# INFLATED: all deviations and densities are {:.9g} times the sensor's (--inflate).\n",
            source.inflate);
    }
    if (const std::string keys = keys_of_upper_limits(format, source); !keys.empty()) {
        text += fmt::format(
            "# UPPER LIMITS at {:.3g} % stand in the place of what is not identified (--upper-limits): {}.\n",
            source.confidence * 100.0, keys);
    }
    for (const std::string_view fact : format.facts) { text += fmt::format("# {}\n", fact); }
    for (const std::string& advice : source.advice) {
        text += fmt::format("# Not in the numbers: {}\n", advice);
    }
    return text;
}

}  // namespace

std::span<const FilterFormat* const> filter_formats() { return all_filter_formats; }

const FilterFormat* find_filter_format(std::string_view name) {
    const auto* const found = std::ranges::find_if(
        all_filter_formats, [&](const FilterFormat* format) { return format->name == name; });
    return found == all_filter_formats.end() ? nullptr : *found;
}

std::string filter_text(const FilterFormat& format, const ExportSource& source) {
    const FilterSource filter = filter_source(source);
    const std::string head = std::string(format.first) + head_text(format, filter);
    if (format.text != nullptr) { return head + format.text(filter); }
    std::string text = head + with_rate(format.before, filter);
    for (const FilterNumber& number : format.numbers) { text += number_text(format, number, filter); }
    return text + (format.after.empty() ? "" : "\n") + with_rate(format.after, filter);
}

std::vector<std::string> missing_numbers(const FilterFormat& format, const ExportSource& source) {
    const FilterSource filter = filter_source(source);
    std::vector<std::string> missing;
    for (const FilterNumber& number : format.numbers) {
        if (filter.term(number.sensor, number.term).value) { continue; }
        missing.push_back(unknown_text(number, filter));
    }
    return missing;
}

std::string numbers_at_upper_limit(const FilterFormat& format, const ExportSource& source) {
    return keys_of_upper_limits(format, filter_source(source));
}

std::string real_text(double value) {
    std::string text = fmt::format("{:.9g}", value);
    if (text.find('.') == std::string::npos) { text.insert(std::min(text.find('e'), text.size()), ".0"); }
    return text;
}

}  // namespace gyrolog
