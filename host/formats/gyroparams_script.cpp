#include "host/formats/gyroparams_script.hpp"

#include <fmt/format.h>

#include "host/base/printable.hpp"

namespace gyrolog {
namespace {

// "[0.01 0.01 0]", in the order x, y, z.
std::string row_of(const ExportSource& source, ExportedTerm ExportedAxis::*term) {
    std::string row;
    for (const char* name : axis_names) {
        const ExportedAxis* axis = source.gyro_axis(name);
        row += fmt::format("{}{:.9g}", row.empty() ? "" : " ", axis == nullptr ? 0.0 : (axis->*term).value);
    }
    return "[" + row + "]";
}

std::string bias_row(const ExportSource& source) {
    std::string row;
    for (const char* name : axis_names) {
        const ExportedAxis* axis = source.gyro_axis(name);
        row += fmt::format("{}{:.9g}", row.empty() ? "" : " ", axis == nullptr ? 0.0 : axis->bias);
    }
    return "[" + row + "]";
}

std::string zeros_explained(const ExportSource& source, ExportedTerm ExportedAxis::*term) {
    std::string text;
    for (const char* name : axis_names) {
        const ExportedAxis* axis = source.gyro_axis(name);
        if (axis != nullptr && (axis->*term).identified) { continue; }
        text += text.empty() ? "; 0 of " : ", ";
        if (axis == nullptr) {
            text += fmt::format("{}: not measured", name);
        } else if ((axis->*term).upper) {
            text += fmt::format("{}: not identified, at most {:.2g} (at {:.3g} %)", name,
                                *(axis->*term).upper, source.confidence * 100.0);
        } else {
            text += fmt::format("{}: none", name);
        }
    }
    return text;
}

std::string noise_line(const ExportSource& source, const char* property, ExportedTerm ExportedAxis::*term,
                       const char* meaning) {
    return fmt::format("params.{} = {};  % {}{}\n", property, row_of(source, term), meaning,
                       zeros_explained(source, term));
}

std::string temperature_lines(const TemperatureModel& temperature) {
    const Vector3& bias = temperature.bias_rad_s_per_C;
    const Vector3& scale = temperature.scale_per_C;
    return fmt::format(
        "params.TemperatureBias = [{:.9g} {:.9g} {:.9g}];  % (rad/s)/degC, about 25 degC\n"
        "params.TemperatureScaleFactor = [{:.9g} {:.9g} {:.9g}];  % %/degC\n",
        bias[0], bias[1], bias[2], scale[0] * 100.0, scale[1] * 100.0, scale[2] * 100.0);
}

}  // namespace

std::string gyroparams_script(const ExportSource& source) {
    std::string script = fmt::format(
        "% From {}, by gyrolog. For imuSensor('SampleRate', {:.9g}, 'Gyroscope', params).\n"
        "params = gyroparams;\n",
        source.name, source.rate_hz);
    for (const std::string& warning : warnings_of(source)) {
        script += "% Warning: " + printable(warning) + "\n";
    }
    if (source.full_scale_rad_s) {
        script += fmt::format("params.MeasurementRange = {:.9g};  % rad/s\n", *source.full_scale_rad_s);
    }
    if (source.lsb_rad_s) {
        script += fmt::format("params.Resolution = {:.9g};  % (rad/s)/LSB\n", *source.lsb_rad_s);
    }
    script += fmt::format("params.ConstantBias = {};  % rad/s\n", bias_row(source));
    script += noise_line(source, "NoiseDensity", &ExportedAxis::N, "N, (rad/s)/sqrt(Hz)");
    script += noise_line(source, "BiasInstability", &ExportedAxis::B,
                         "B, rad/s; the flat of the Allan deviation is 0.664 B");
    script += noise_line(source, "RandomWalk", &ExportedAxis::K, "K, rate random walk, (rad/s)*sqrt(Hz)");
    if (source.temperature) { script += temperature_lines(*source.temperature); }
    script +=
        "if isprop(params, 'NoiseType')\n"
        "    params.NoiseType = 'single-sided';  % white noise of NoiseDensity*sqrt(SampleRate) a sample\n"
        "else  % this release takes sqrt(SampleRate/2)\n"
        "    params.NoiseDensity = params.NoiseDensity*sqrt(2);\n"
        "    params.RandomWalk = params.RandomWalk/sqrt(2);\n"
        "end\n"
        "% Not measured: AxesMisalignment, AccelerationBias";
    script += source.temperature ? ".\n" : ", TemperatureBias, TemperatureScaleFactor.\n";
    return script;
}

}  // namespace gyrolog
