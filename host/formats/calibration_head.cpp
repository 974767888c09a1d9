#include "host/formats/calibration_head.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "host/base/printable.hpp"
#include "host/base/program_name.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

std::string comment_of(std::string_view sign, std::string_view text) {
    std::string plain(text);
    // In C and C++ a backslash at the end of a line goes on with the comment in the next one.
    if (sign == "//") { std::ranges::replace(plain, '\\', '/'); }
    const std::string wrapped = wrapped_text("", plain);
    std::string lines;
    for (std::size_t begin = 0; begin < wrapped.size();) {
        const std::size_t end = wrapped.find('\n', begin);
        lines += std::string(sign) + " " + wrapped.substr(begin, end - begin) + "\n";
        begin = end + 1;
    }
    return lines;
}

// The largest error that is left in any direction, as a share of the quantity: of S M - 1.
double largest_left(const Matrix3& M, const Vector3& scales) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const double left = scales[i] * M[i][j] - (i == j ? 1.0 : 0.0);
            sum += left * left;
        }
    }
    return std::sqrt(sum);  // the Frobenius norm is not below the largest singular value
}

}  // namespace

std::string calibration_head(const Calibration& calibration, std::string_view sign) {
    std::string names;
    for (const std::string& name : calibration.recordings) {
        names += (names.empty() ? "" : ", ") + printable(name);
    }
    std::string head = comment_of(sign, "Calibration of " + names + ", by " + program_name() + ".");
    head += comment_of(sign,
                       "In the axes of the recording: a driver that turns or swaps axes must do so before.");
    for (const Undetermined& one : calibration.undetermined) {
        head += comment_of(sign, "Not determined: " + one.what + ".");
    }
    return head;
}

std::string loss_without_matrix(const Calibration& calibration, std::string_view sign) {
    std::string loss;
    if (const auto& fitted = calibration.accelerometer.calibration; fitted && fitted->has_misalignment) {
        loss +=
            comment_of(sign, fmt::format("Without the accelerometer's misalignment at most {:.3g} % of the "
                                         "force are wrong.",
                                         100.0 * largest_left(fitted->M, axis_scales(fitted->M))));
    }
    const auto& gyro = calibration.gyro.calibration;
    if (gyro && std::ranges::count(gyro->has_scale, true) > 0) {
        loss +=
            comment_of(sign, fmt::format("Without the gyro's scale and misalignment at most {:.3g} % of the "
                                         "rate are wrong.",
                                         100.0 * largest_left(gyro->M, {1.0, 1.0, 1.0})));
    }
    return loss;
}

}  // namespace gyrolog
