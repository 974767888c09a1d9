#include "host/formats/calibration_json.hpp"

#include "analysis/calibrate/sensor_matrix.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {
namespace {

constexpr double per_g = 1.0 / standard_gravity_m_s2;

Json list_json(const Vector3& vector, double factor) {
    Json list = Json::array();
    for (const double value : vector) { list.push_back(value * factor); }
    return list;
}

Json matrix_json(const Matrix3& matrix, double factor = 1.0) {
    Json rows = Json::array();
    for (const Vector3& row : matrix) { rows.push_back(list_json(row, factor)); }
    return rows;
}

Json matrix_json(const Matrix& matrix) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < matrix.rows(); ++i) {
        Json row = Json::array();
        for (std::size_t j = 0; j < matrix.columns(); ++j) { row.push_back(matrix(i, j)); }
        rows.push_back(std::move(row));
    }
    return rows;
}

Json rests_json(const Calibration& calibration) {
    Json rests = Json::array();
    std::size_t with_force = 0;
    for (const Rest& rest : calibration.phases.rests) {
        Json json{{"recording", rest.recording}, {"at_s", rest.from_s}, {"duration_s", rest.duration_s}};
        if (calibration.has_gyro) { json["rate_dps"] = list_json(rest.rate_rad_s, deg_per_rad); }
        if (rest.temperature_C) { json["temperature_C"] = *rest.temperature_C; }
        if (norm(rest.force_m_s2) > 0.0) {
            json["force_g"] = list_json(rest.force_m_s2, per_g);
            if (calibration.accelerometer.calibration) {
                json["residual_g"] =
                    calibration.accelerometer.calibration->residual_m_s2.at(with_force) * per_g;
            }
            ++with_force;
        }
        rests.push_back(std::move(json));
    }
    return rests;
}

Json accelerometer_json(const AccelerometerCalibration& fitted) {
    return {{"M", matrix_json(fitted.M)},
            {"M_sd", matrix_json(fitted.M_sd)},
            {"bias_g", list_json(fitted.bias_m_s2, per_g)},
            {"bias_sd_g", list_json(fitted.bias_sd_m_s2, per_g)},
            {"has_misalignment", fitted.has_misalignment},
            {"names", fitted.names},
            {"covariance", matrix_json(fitted.covariance)},
            {"rms_g", fitted.rms_m_s2 * per_g},
            {"chi_squared", fitted.chi_squared},
            {"degrees", fitted.degrees},
            {"sd_factor", fitted.sd_factor}};
}

Json gyro_json(const GyroCalibration& fitted) {
    Json json{{"M", matrix_json(fitted.M)},
              {"M_sd", matrix_json(fitted.M_sd)},
              {"has_scale", fitted.has_scale},
              {"bias_dps", list_json(fitted.bias_rad_s, deg_per_rad)},
              {"bias_sd_dps", list_json(fitted.bias_sd_rad_s, deg_per_rad)}};
    if (fitted.has_g_sensitivity) {
        json["g_sensitivity_dps_per_g"] = matrix_json(fitted.K_s_per_m, dps_per_g_in_s_per_m);
        json["g_sensitivity_sd_dps_per_g"] = matrix_json(fitted.K_sd_s_per_m, dps_per_g_in_s_per_m);
    }
    json["names"] = fitted.names;
    json["covariance"] = matrix_json(fitted.covariance);
    json["fits"] = Json::array();
    for (const ObservationFit& fit : fitted.fits) {
        const bool is_direction = fit.kind == ObservationKind::gravity;
        json["fits"].push_back({{"kind", words_of(fit.kind)},
                                {"count", fit.count},
                                {"rms", fit.rms * deg_per_rad},
                                {"unit", is_direction ? "deg" : "dps"},
                                {"sd_factor", fit.sd_factor},
                                {"redundancy", fit.redundancy}});
    }
    return json;
}

Json temperature_json(const TemperatureCalibration& fitted, const char* unit, double factor) {
    Json json{{"reference_C", fitted.reference_C},
              {"from_C", fitted.from_C},
              {"to_C", fitted.to_C},
              {"blocks", fitted.blocks},
              {"unit", unit}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const TemperaturePolynomial& polynomial = fitted.axes[axis];
        Matrix covariance = polynomial.covariance;
        for (double& value : covariance.values()) { value *= factor * factor; }
        json["axes"][axis_names[axis]] = {{"order", polynomial.order},
                                          {"c", list_json(polynomial.c, factor)},
                                          {"c_sd", list_json(polynomial.c_sd, factor)},
                                          {"covariance", matrix_json(covariance)},
                                          {"residual_sd", polynomial.residual_sd * factor},
                                          {"correlation", polynomial.correlation},
                                          {"F", list_json(polynomial.F, 1.0)},
                                          {"F_needed", list_json(polynomial.F_needed, 1.0)}};
    }
    return json;
}

}  // namespace

Json calibration_json(const Calibration& calibration) {
    Json json;
    json["schema"] = "gyrolog-calibration/1";
    json["recordings"] = calibration.recordings;
    json["gravity_m_s2"] = calibration.gravity_m_s2;
    if (calibration.temperature_C) { json["temperature_C"] = *calibration.temperature_C; }
    json["rests"] = rests_json(calibration);
    json["turns"] = calibration.turns;
    json["moves"] = calibration.moves;
    if (calibration.accelerometer.calibration) {
        json["accelerometer"] = accelerometer_json(*calibration.accelerometer.calibration);
    }
    if (calibration.gyro.calibration) { json["gyro"] = gyro_json(*calibration.gyro.calibration); }
    if (calibration.gyro_temperature.calibration) {
        json["temperature"]["gyro"] =
            temperature_json(*calibration.gyro_temperature.calibration, "dps", deg_per_rad);
    }
    if (calibration.accelerometer_temperature.calibration) {
        json["temperature"]["accelerometer"] =
            temperature_json(*calibration.accelerometer_temperature.calibration, "g", per_g);
    }
    json["next_poses"] = Json::array();
    for (const PoseAdvice& pose : calibration.accelerometer.advice) {
        json["next_poses"].push_back({{"up", list_json(pose.up, 1.0)},
                                      {"words", pose.words},
                                      {"parameter", pose.symbol},
                                      {"sd_before", pose.sd_before},
                                      {"sd_after", pose.sd_after}});
    }
    json["undetermined"] = Json::array();
    for (const Undetermined& one : calibration.undetermined) {
        json["undetermined"].push_back({{"what", one.what}, {"add", one.add}});
    }
    json["warnings"] = calibration.warnings;
    return json;
}

}  // namespace gyrolog
