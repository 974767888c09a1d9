#include "analysis/calibrate/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "analysis/calibrate/sensor_matrix.hpp"

namespace gyrolog {
namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) { text += (text.empty() ? "" : ", ") + word; }
    return text;
}

void warn_of_nonsense(Calibration& calibration, const CalibrationOptions& options) {
    const std::string question = ": are the sampling rate and the axes right?";
    if (!calibration.gyro.calibration) { return; }
    const GyroCalibration& gyro = *calibration.gyro.calibration;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double off = gyro.M[axis][axis] - 1.0;
        if (!gyro.has_scale[axis] || std::abs(off) < options.scale_off_least) { continue; }
        const std::string percent = std::to_string(std::lround(100.0 * off));
        calibration.warnings.push_back(std::string("the gyro's scale about ")
                                           .append(axis_names[axis])
                                           .append(" is off by ")
                                           .append(percent)
                                           .append(" %")
                                           .append(question));
    }
    for (const ObservationFit& fit : gyro.fits) {
        if (fit.kind != ObservationKind::gravity || fit.rms < options.miss_least_rad) { continue; }
        const std::string deg = std::to_string(std::lround(fit.rms * deg_per_rad));
        calibration.warnings.push_back(std::string("gravity does not go where the gyro says (rms ")
                                           .append(deg)
                                           .append(" deg)")
                                           .append(question));
    }
}

// What is left is at the reference temperature.
void take_out(const std::optional<TemperatureCalibration>& temperature, const std::vector<double>& at_C,
              VectorTrack& track) {
    if (!temperature || !temperature->follows() || at_C.empty() || track[0].empty()) { return; }
    for (std::size_t row = 0; row < at_C.size(); ++row) {
        const Vector3 offset = temperature->offset(at_C[row]);
        for (std::size_t axis = 0; axis < 3; ++axis) { track[axis][row] -= offset[axis]; }
    }
}

// Rests of recordings with an accelerometer.
std::vector<Rest> rests_with_force(const Phases& phases, const std::vector<InertialSignals>& recordings) {
    std::vector<Rest> rests;
    std::ranges::copy_if(phases.rests, std::back_inserter(rests), [&](const Rest& rest) {
        // Nothing but zeros is a sensor that is off.
        return recordings[rest.recording].has_force() && norm(rest.force_m_s2) > 0.0;
    });
    return rests;
}

std::optional<double> mean_temperature_C(const std::vector<Rest>& rests) {
    double sum = 0.0;
    double weight = 0.0;
    for (const Rest& rest : rests) {
        if (!rest.temperature_C) { continue; }
        sum += *rest.temperature_C * rest.duration_s;
        weight += rest.duration_s;
    }
    return weight > 0.0 ? std::optional(sum / weight) : std::nullopt;
}

void add_accelerometer_gaps(Calibration& calibration) {
    if (!calibration.has_accelerometer) {
        calibration.undetermined.push_back(
            {"accelerometer: the recording has none with three axes and a scale",
             "columns ax ay az in g or m/s^2, or counts with --lsb-g"});
        return;
    }
    if (calibration.accelerometer.undetermined.empty()) { return; }
    std::vector<std::string> poses;
    for (const PoseAdvice& advice : calibration.accelerometer.advice) { poses.push_back(advice.words); }
    calibration.undetermined.push_back(
        {"accelerometer: " + joined(calibration.accelerometer.undetermined),
         poses.empty() ? "rests of two seconds or more in at least six poses, one with each face up"
                       : "rests of two seconds or more with " + joined(poses)});
}

void add_gyro_gaps(Calibration& calibration) {
    if (!calibration.has_gyro) {
        calibration.undetermined.push_back({"gyro: the recording has none with three axes and a scale",
                                            "columns gx gy gz in dps or rad/s, or counts with --lsb-dps"});
        return;
    }
    if (!calibration.gyro.calibration) {
        calibration.undetermined.push_back(
            {"gyro: there is no rest, and no reference rate", "two seconds or more in which nothing moves"});
        return;
    }
    for (const std::string& what : calibration.gyro.undetermined) {
        const bool is_K = what == "g-sensitivity";
        const char* const turn =
            calibration.has_accelerometer
                ? "turns about these axes: by hand with the axis level, from one rest to another, or by a "
                  "known angle with the axis upright and --turn DEG, or with a reference rate (ref_x_dps "
                  "...)"
                : "a reference rate (ref_x_dps ref_y_dps ref_z_dps) and turns about these axes; turns by a "
                  "known angle need an accelerometer, which tells their axis";
        calibration.undetermined.push_back(
            {"gyro: " + what, is_K ? "rests with each face up, with an accelerometer" : turn});
    }
}

void add_temperature_gaps(Calibration& calibration, const CalibrationOptions& options) {
    if (!calibration.has_temperature) {
        calibration.undetermined.push_back({"temperature: there is no temperature", "a column temp_C"});
        return;
    }
    const double range_C =
        std::max(calibration.gyro_temperature.range_C, calibration.accelerometer_temperature.range_C);
    if (calibration.gyro_temperature.calibration || calibration.accelerometer_temperature.calibration) {
        return;
    }
    const std::string wanted = std::to_string(std::lround(options.temperature.range_C[0]));
    const std::string seen = std::to_string(std::lround(range_C));
    calibration.undetermined.push_back({"temperature: bias over temperature",
                                        std::string("a rest in one pose while the temperature changes by ")
                                            .append(wanted)
                                            .append(" degC or more (seen: ")
                                            .append(seen)
                                            .append(" degC)")});
}

}  // namespace

bool Calibration::determines_anything() const {
    const bool gyro_turns = gyro.calibration && (gyro.calibration->has_g_sensitivity ||
                                                 std::ranges::count(gyro.calibration->has_scale, true) > 0);
    return gyro_turns || accelerometer.calibration || gyro_temperature.calibration ||
           accelerometer_temperature.calibration;
}

Calibration calibrate(std::vector<Recording> recordings, const CalibrationOptions& options) {
    Calibration calibration;
    calibration.gravity_m_s2 = options.accelerometer.gravity_m_s2;
    std::vector<InertialSignals> signals;
    for (Recording& recording : recordings) {
        calibration.recordings.push_back(recording.name);
        signals.push_back(inertial_signals(std::move(recording)));
        const InertialSignals& one = signals.back();
        calibration.warnings.insert(calibration.warnings.end(), one.recording.warnings.begin(),
                                    one.recording.warnings.end());
        calibration.has_gyro = calibration.has_gyro || one.has_rate();
        calibration.has_accelerometer = calibration.has_accelerometer || one.has_force();
        calibration.has_reference = calibration.has_reference || (one.has_reference() && one.has_rate());
        calibration.has_temperature = calibration.has_temperature || one.has_temperature();
    }
    const std::vector<Rest> warmed = find_phases(signals, options.rests).rests;
    calibration.gyro_temperature =
        fit_temperature(signals, warmed, CalibratedSensor::gyro, options.temperature);
    calibration.accelerometer_temperature =
        fit_temperature(signals, warmed, CalibratedSensor::accelerometer, options.temperature);
    for (InertialSignals& one : signals) {
        take_out(calibration.gyro_temperature.calibration, one.temperature_C, one.rate_rad_s);
        take_out(calibration.accelerometer_temperature.calibration, one.temperature_C, one.force_m_s2);
    }
    calibration.phases = find_phases(signals, options.rests);
    const Phases& phases = calibration.phases;
    calibration.temperature_C = mean_temperature_C(phases.rests);
    calibration.accelerometer =
        fit_accelerometer(rests_with_force(phases, signals), phases.scatter, options.accelerometer);
    const GyroObservations observations =
        gyro_observations(signals, phases, calibration.accelerometer.calibration,
                          options.accelerometer.gravity_m_s2, options.observations);
    calibration.turns = observations.turns;
    calibration.moves = observations.moves.size();
    calibration.warnings.insert(calibration.warnings.end(), observations.notes.begin(),
                                observations.notes.end());
    calibration.gyro = fit_gyro(observations, options.gyro);
    warn_of_nonsense(calibration, options);
    add_accelerometer_gaps(calibration);
    add_gyro_gaps(calibration);
    add_temperature_gaps(calibration, options);
    return calibration;
}

}  // namespace gyrolog
