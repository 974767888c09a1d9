#include "host/formats/kalibr_yaml.hpp"

#include <cmath>

#include <fmt/format.h>

namespace gyrolog {
namespace {

std::string axes_text(const std::vector<ExportedAxis>& axes, ExportedTerm ExportedAxis::*term) {
    std::string text;
    for (const ExportedAxis& axis : axes) {
        const ExportedTerm& one = axis.*term;
        text += fmt::format("{}{} ", text.empty() ? "" : ", ", axis.name);
        if (one.identified) {
            text += fmt::format("{:.4g}", one.value);
        } else if (one.upper) {
            text += fmt::format("< {:.2g}", *one.upper);
        } else {
            text += "none";
        }
    }
    return text;
}

// `to_discrete`: what the density is multiplied by at the update rate.
void add(std::string& yaml, const char* key, const char* unit, const std::vector<ExportedAxis>& axes,
         ExportedTerm ExportedAxis::*term, double to_discrete, const char* discrete_unit, double confidence) {
    const ExportedTerm most = largest(axes, term);
    yaml += fmt::format("\n# {}; axes: {}\n", unit, axes_text(axes, term));
    if (most.identified) {
        yaml += fmt::format("# discrete, one sigma a sample at update_rate: {:.6g} {}\n{}: {:.9g}\n",
                            most.value * to_discrete, discrete_unit, key, most.value);
        return;
    }
    yaml += fmt::format("# {}: not identified", key);
    if (most.upper) {
        yaml += fmt::format(", at most {:.2g} (at {:.3g} %)", *most.upper, confidence * 100.0);
    }
    yaml += "; Kalibr needs a value: take a longer record\n";
}

}  // namespace

std::string kalibr_yaml(const ExportSource& source) {
    const double root_rate = std::sqrt(source.rate_hz);
    std::string yaml = fmt::format(
        "# From {}, by gyrolog. Continuous-time densities as Kalibr wants them: white noise N, rate random "
        "walk K.\n"
        "# Each is the largest of the axes. Bias instability B is no random walk and is not in here.\n"
        "rostopic: /imu0\n"
        "update_rate: {:.9g}  # Hz\n",
        source.name, source.rate_hz);
    add(yaml, "gyroscope_noise_density", "rad/s/sqrt(Hz)", source.gyro, &ExportedAxis::N, root_rate, "rad/s",
        source.confidence);
    add(yaml, "gyroscope_random_walk", "rad/s^2/sqrt(Hz)", source.gyro, &ExportedAxis::K, 1.0 / root_rate,
        "rad/s", source.confidence);
    if (source.accelerometer.empty()) {
        yaml += "\n# accelerometer_noise_density, accelerometer_random_walk: not measured\n";
        return yaml;
    }
    add(yaml, "accelerometer_noise_density", "m/s^2/sqrt(Hz)", source.accelerometer, &ExportedAxis::N,
        root_rate, "m/s^2", source.confidence);
    add(yaml, "accelerometer_random_walk", "m/s^3/sqrt(Hz)", source.accelerometer, &ExportedAxis::K,
        1.0 / root_rate, "m/s^2", source.confidence);
    return yaml;
}

}  // namespace gyrolog
