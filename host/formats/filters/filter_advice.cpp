#include "host/formats/filters/filter_advice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "host/base/printable.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t lines_of_an_axis = 3;
constexpr double notable_departure = 0.2;  // of a spectrum from the model, as a share of it

struct Sensor {
    const char* name;
    const char* unit;
};
constexpr Sensor gyro = {"gyro", "rad/s"};
constexpr Sensor accelerometer = {"accelerometer", "m/s^2"};

void add_bias_instability(std::vector<std::string>& advice, const Sensor& sensor,
                          const std::vector<ExportedAxis>& axes) {
    const ExportedTerm B = largest(axes, &ExportedAxis::B);
    if (!B.identified) { return; }
    advice.push_back(fmt::format(
        "1/f noise of the {}: B {:.3g} {}, which is neither N nor K. Averaging does not bring its "
        "bias below {:.3g} {}, which a filter that has only N and K believes it can.",
        sensor.name, B.value, sensor.unit, B.value * std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi),
        sensor.unit));
}

void add_lines(std::vector<std::string>& advice, const Sensor& sensor, const AxisReport& axis) {
    for (std::size_t i = 0; i < std::min(lines_of_an_axis, axis.lines.size()); ++i) {
        const SpectralLine& line = axis.lines[i];
        advice.push_back(fmt::format(
            "Vibration or hum in the {}, axis {}: {:.4g} Hz, {:.3g} {} high. It is not white; remove it by a "
            "notch or at its source.",
            sensor.name, axis.axis, line.f_hz, line.amplitude, sensor.unit));
    }
}

void add_spectrum(std::vector<std::string>& advice, const Sensor& sensor, const AxisReport& axis) {
    const NoiseFit& fit = axis.fit;
    if (fit.bandwidth_hz > 0.0) {
        advice.push_back(fmt::format(
            "The low-pass filter of the {}, axis {}, of {:.4g} Hz acts on the samples: N is that of the "
            "frequencies below {:.4g} Hz.",
            sensor.name, axis.axis, fit.bandwidth_hz, fit.upper_frequency_hz));
    } else if (fit.upper_frequency_hz > 0.0) {
        advice.push_back(fmt::format(
            "The spectrum of the {}, axis {}, is not white above {:.4g} Hz (a filter of the sensor, or "
            "noise): N is that of the frequencies below.",
            sensor.name, axis.axis, fit.upper_frequency_hz));
    }
    if (fit.model_error > notable_departure) {
        advice.push_back(fmt::format(
            "The spectrum of the {}, axis {}, departs from N, B and K by {:.0f} % typically; most at {:.4g} "
            "Hz, where it is {:.3g} times as dense.",
            sensor.name, axis.axis, fit.model_error * 100.0, fit.worst_frequency_hz, fit.worst_ratio));
    }
    for (const FittedGaussMarkov& process : fit.gauss_markov) {
        advice.push_back(fmt::format(
            "The {}, axis {}, has a bias that comes back after {:.3g} s (Gauss-Markov, {:.3g} "
            "{}): a random walk does not.",
            sensor.name, axis.axis, process.value.correlation_s, process.value.sigma_rad_per_s, sensor.unit));
    }
}

void add_of_axes(std::vector<std::string>& advice, const Sensor& sensor,
                 const std::vector<AxisReport>& axes) {
    for (const AxisReport& axis : axes) {
        add_lines(advice, sensor, axis);
        add_spectrum(advice, sensor, axis);
    }
}

void add_of_temperature(std::vector<std::string>& advice, const TemperatureModel& temperature) {
    double steepest = 0.0;
    for (const double slope : temperature.bias_rad_s_per_C) {
        steepest = std::max(steepest, std::abs(slope));
    }
    if (steepest == 0.0) { return; }
    advice.push_back(
        fmt::format("The gyro's bias moves with the temperature, up to {:.3g} rad/s per degC: correct it, or "
                    "K is too small while the sensor warms up.",
                    steepest));
}

}  // namespace

std::vector<std::string> filter_advice(const ExportSource& source) {
    std::vector<std::string> advice;
    if (source.accelerometer_has_counts) {
        advice.emplace_back(
            "The accelerometer has counts: --lsb-g gives their scale, and then its numbers are here.");
    } else if (source.accelerometer.empty()) {
        advice.emplace_back(
            "There is no accelerometer in the source: its numbers are missing here, and nobody else's will "
            "do.");
    }
    add_bias_instability(advice, gyro, source.gyro);
    add_bias_instability(advice, accelerometer, source.accelerometer);
    if (source.report != nullptr) {
        add_of_axes(advice, gyro, source.report->axes);
        if (source.report->accelerometer && !source.accelerometer.empty()) {  // counts have no unit
            add_of_axes(advice, accelerometer, source.report->accelerometer->axes);
        }
        for (const std::string& warning : source.report->warnings) { advice.push_back(printable(warning)); }
    }
    if (source.temperature) { add_of_temperature(advice, *source.temperature); }
    for (const std::string& effect : source.effects) {
        advice.push_back("The model has the effect " + printable(effect) + ", the filter has not.");
    }
    return advice;
}

}  // namespace gyrolog
