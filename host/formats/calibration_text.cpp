#include "host/formats/calibration_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "host/base/counted.hpp"
#include "host/formats/text_table.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t width_most = 80;
constexpr double mg = 1e-3 * standard_gravity_m_s2;

std::string line(const std::string& first, const std::string& text) {
    return wrapped_text(first, text, width_most);
}

// A parameter that was not fitted has no uncertainty.
std::string cell(double value, double sd, double factor = 1.0) {
    return sd > 0.0 ? with_uncertainty(value * factor, sd * factor) : fmt::format("{:.6g}", value * factor);
}

std::string matrix_table(const std::string& name, const std::string& unit, const Matrix3& matrix,
                         const Matrix3& sd, double factor = 1.0) {
    const std::array<std::string, 3> heads{"from x", "from y", "from z"};
    std::vector<TextRow> rows;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        TextRow row{name + " " + axis_names[axis], unit, {}};
        for (std::size_t from = 0; from < 3; ++from) {
            row.cells.push_back(cell(matrix[axis][from], sd[axis][from], factor));
        }
        rows.push_back(std::move(row));
    }
    return text_table(heads, rows, width_most);
}

std::string vector_table(const std::string& name, const std::string& unit, const Vector3& values,
                         const Vector3& sd, double factor) {
    const std::array<std::string, 3> heads{"x", "y", "z"};
    TextRow row{name, unit, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        row.cells.push_back(cell(values[axis], sd[axis], factor));
    }
    return text_table(heads, std::span(&row, 1), width_most);
}

std::string heading_text(const Calibration& calibration) {
    std::string names;
    for (const std::string& name : calibration.recordings) { names += (names.empty() ? "" : ", ") + name; }
    std::string text = line("calibration of ", names);
    std::string found = counted(calibration.phases.rests.size(), "rest");
    found += ", " + counted(calibration.turns, "turn") + " by a known angle, ";
    found += counted(calibration.moves, "move") + " of gravity";
    if (calibration.temperature_C) { found += fmt::format("; {:.1f} degC", *calibration.temperature_C); }
    return text + line("", found) +
           line("", "± is one sigma; gravity is taken as " +
                        fmt::format("{:.6g} m/s^2", calibration.gravity_m_s2));
}

std::string largest_residual(const Calibration& calibration, const AccelerometerCalibration& fitted) {
    std::size_t largest = 0;
    for (std::size_t i = 1; i < fitted.residual_m_s2.size(); ++i) {
        if (std::abs(fitted.residual_m_s2[i]) > std::abs(fitted.residual_m_s2[largest])) { largest = i; }
    }
    std::size_t with_force = 0;
    for (const Rest& rest : calibration.phases.rests) {
        if (norm(rest.force_m_s2) == 0.0 || with_force++ != largest) { continue; }
        return fmt::format("the largest {:.3g} mg in the rest at {:.4g} s of {}",
                           fitted.residual_m_s2[largest] / mg, rest.from_s,
                           calibration.recordings[rest.recording]);
    }
    return {};
}

std::string accelerometer_text(const Calibration& calibration) {
    const AccelerometerCalibration& fitted = *calibration.accelerometer.calibration;
    std::string text = "\naccelerometer: y = M a + bias, a in orthogonal axes with the sensor's own x\n";
    text += matrix_table("M", "", fitted.M, fitted.M_sd);
    text += vector_table("bias", "mg", fitted.bias_m_s2, fitted.bias_sd_m_s2, 1.0 / mg);
    std::string residuals = fmt::format("residual size of gravity: rms {:.3g} mg", fitted.rms_m_s2 / mg);
    if (fitted.degrees > 0.0) {
        residuals +=
            fmt::format("; chi-squared {:.3g} with {:.0f} to spare; ", fitted.chi_squared, fitted.degrees) +
            largest_residual(calibration, fitted);
    } else {
        residuals += "; there is no rest to spare, so that nothing checks it";
    }
    text += line("  ", residuals);
    if (fitted.sd_factor > 1.0) {
        text +=
            line("  ", fmt::format("the rests agree {:.2g} times worse than their noise; the uncertainties "
                                   "are raised by that",
                                   fitted.sd_factor));
    }
    return text;
}

bool has_one(const Matrix3& sd) {
    return std::ranges::any_of(sd, [](const Vector3& row) { return norm(row) > 0.0; });
}

std::string gyro_text(const Calibration& calibration) {
    const GyroCalibration& fitted = *calibration.gyro.calibration;
    std::string text = "\ngyro: y = M w + bias";
    text += fitted.has_g_sensitivity ? " + K f, f the specific force\n" : "\n";
    if (has_one(fitted.M_sd)) { text += matrix_table("M", "", fitted.M, fitted.M_sd); }
    text += vector_table("bias", "dps", fitted.bias_rad_s, fitted.bias_sd_rad_s, deg_per_rad);
    if (fitted.has_g_sensitivity) {
        text += matrix_table("K", "dps/g", fitted.K_s_per_m, fitted.K_sd_s_per_m, dps_per_g_in_s_per_m);
    }
    for (const ObservationFit& fit : fitted.fits) {
        std::string words =
            fmt::format("residual of {}: rms {:.3g} {}", words_of(fit.kind), fit.rms * deg_per_rad,
                        fit.kind == ObservationKind::gravity ? "deg" : "dps");
        if (fit.sd_factor > 1.0) {
            words += fmt::format("; {:.2g} times what was stated of them, and weighted so", fit.sd_factor);
        }
        text += line("  ", words);
    }
    return text;
}

std::string temperature_text(const char* sensor, const TemperatureCalibration& fitted, const char* unit,
                             double factor) {
    std::string text = fmt::format("\n{}: bias over temperature, {:.1f} to {:.1f} degC, from {:g} degC\n",
                                   sensor, fitted.from_C, fitted.to_C, fitted.reference_C);
    const std::array<std::string, 3> heads{"x", "y", "z"};
    std::vector<TextRow> rows;
    const char* const powers[] = {"/degC", "/degC^2", "/degC^3"};
    for (std::size_t k = 0; k < temperature_orders; ++k) {
        TextRow row{fmt::format("c{}", k + 1), std::string(unit) + powers[k], {}};
        bool is_used = false;
        for (const TemperaturePolynomial& axis : fitted.axes) {
            is_used = is_used || k < axis.order;
            row.cells.push_back(k < axis.order ? cell(axis.c[k], axis.c_sd[k], factor) : "-");
        }
        if (is_used) { rows.push_back(std::move(row)); }
    }
    TextRow residual{"residual", unit, {}};
    for (const TemperaturePolynomial& axis : fitted.axes) {
        residual.cells.push_back(fmt::format("{:.3g}", axis.residual_sd * factor));
    }
    rows.push_back(std::move(residual));
    return text + text_table(heads, rows, width_most);
}

std::string next_text(const Calibration& calibration) {
    std::string text;
    const auto& advice = calibration.accelerometer.advice;
    if (!calibration.accelerometer.calibration || calibration.accelerometer.advice.empty() ||
        !calibration.accelerometer.calibration->has_misalignment) {
        return text;
    }
    std::string poses;
    for (const PoseAdvice& pose : advice) { poses += (poses.empty() ? "" : "; ") + pose.words; }
    const bool is_bias = advice.front().symbol.starts_with("bias");
    const double factor = is_bias ? 1.0 / mg : 1.0;
    text +=
        line("", fmt::format("next rests that help most, the best first: {}. With them the accelerometer's "
                             "{}, which is known worst, goes from ± {:.2g} to ± {:.2g}{}.",
                             poses, advice.front().symbol, advice.front().sd_before * factor,
                             advice.back().sd_after * factor, is_bias ? " mg" : ""));
    return text;
}

}  // namespace

std::string undetermined_text(const Calibration& calibration) {
    std::string text;
    const std::vector<Undetermined>& all = calibration.undetermined;
    for (std::size_t i = 0; i < all.size(); ++i) {
        text += line("not determined: ", all[i].what);
        // Once for all that it is for.
        const bool is_last_of_it = i + 1 == all.size() || all[i + 1].add != all[i].add;
        if (is_last_of_it) { text += line("  add: ", all[i].add); }
    }
    return text;
}

std::string calibration_text(const Calibration& calibration) {
    std::string text = heading_text(calibration);
    for (const std::string& warning : calibration.warnings) { text += line("warning: ", warning); }
    if (calibration.accelerometer.calibration) { text += accelerometer_text(calibration); }
    if (calibration.gyro.calibration) { text += gyro_text(calibration); }
    if (calibration.accelerometer_temperature.calibration) {
        text += temperature_text("accelerometer", *calibration.accelerometer_temperature.calibration, "mg",
                                 1.0 / mg);
    }
    if (calibration.gyro_temperature.calibration) {
        text += temperature_text("gyro", *calibration.gyro_temperature.calibration, "dps", deg_per_rad);
    }
    const std::string next = undetermined_text(calibration) + next_text(calibration);
    return next.empty() ? text : text + "\n" + next;
}

}  // namespace gyrolog
