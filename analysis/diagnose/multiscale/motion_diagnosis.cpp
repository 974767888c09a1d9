#include "analysis/diagnose/multiscale/motion_diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/diagnose/calibration/reference_error.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/multiscale/joined_passes.hpp"
#include "analysis/diagnose/multiscale/means_model.hpp"
#include "analysis/recording/recording_part.hpp"
#include "analysis/simulate/gyro_rest.hpp"
#include "analysis/simulate/orientation_rate.hpp"
#include "analysis/simulate/recorded_orientation.hpp"
#include "analysis/simulate/reference_noise.hpp"

namespace gyrolog::resolution {

// Of a mean against an orientation: what people and vehicles do is slower, and the error of an orientation
// that is differentiated grows with the frequency.
constexpr double row_against_orientation_s = 0.05;

}  // namespace gyrolog::resolution

namespace gyrolog {
namespace {

Recording with_turn_rates(Recording recording) {
    std::array<std::vector<double>, 3> rates;
    for (std::vector<double>& rate : rates) { rate.resize(recording.rows()); }
    for (const Segment& segment : recording.segments) {
        const auto turned = turn_rate(recorded_orientation(recording, segment), recording.rate_hz);
        for (std::size_t i = 0; i < segment.count; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                rates.at(axis)[segment.first + i] = turned[i].at(axis);
            }
        }
    }
    std::erase_if(recording.columns, is_reference);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        recording.columns.push_back(
            {std::string("ref_") + axis_names.at(axis), "rad/s", std::move(rates.at(axis))});
    }
    return recording;
}

// Null where the sensor does not rest for long enough to be judged.
std::shared_ptr<const Recording> longest_rest(const Recording& recording) {
    const TimeSpan still = gyro_rest(recording);
    if (!(still.to_s > still.from_s)) { return nullptr; }
    Recording rest = part_of(recording, still);
    std::erase_if(rest.columns, is_reference);
    if (diagnosis_refusal(rest)) { return nullptr; }
    return std::make_shared<const Recording>(std::move(rest));
}

// The causes in the model that was given: that of the pass holds the reference's error.
void put_causes_in(const SensorModel& model, Diagnosis& pass, std::size_t samples, double rate_hz) {
    for (Cause& cause : pass.causes) {
        cause.finding = finding_of_samples(std::move(cause.finding), samples, rate_hz);
    }
    pass.corrected = corrected_model(model, pass, pass.corrected);
}

std::shared_ptr<const Recording> shared_means(const Recording& recording) {
    return std::make_shared<const Recording>(means_against_orientation(recording));
}

// `model`: of the recording's rows; `rows`: those, or means of them against the angle turned.
std::optional<Diagnosis> diagnose_answer(const Recording& recording,
                                         const std::shared_ptr<const Recording>& rows,
                                         const SensorModel& model, const std::string& model_name,
                                         DiagnosisOptions options) {
    const std::size_t samples = rows->samples_per_row / recording.samples_per_row;
    WithReferenceError error =
        with_reference_error(model_of_means(model, samples, recording.rate_hz), rows, options.seed);
    options.noise_of = Prediction::NoiseOf::reference_too;
    std::optional<Diagnosis> pass = diagnose(rows, error.model, model_name, options);
    if (!pass) { return std::nullopt; }
    put_causes_in(model, *pass, samples, recording.rate_hz);
    pass->reference = error.quality;
    return pass;
}

std::optional<Diagnosis> diagnose_in_two_passes(const std::shared_ptr<const Recording>& recording,
                                                const std::shared_ptr<const Recording>& rows,
                                                const SensorModel& model, const std::string& model_name,
                                                const DiagnosisOptions& options) {
    DiagnosisOptions of_pass = options;
    const std::shared_ptr<const Recording> rest = longest_rest(*recording);
    if (rest) { of_pass.false_alarms_most *= 0.5; }
    std::optional<Diagnosis> moving = diagnose_answer(*recording, rows, model, model_name, of_pass);
    if (!moving || !rest) { return moving; }
    of_pass.holdout = nullptr;
    std::optional<Diagnosis> resting = diagnose(rest, model, model_name, of_pass);
    if (!resting) { return std::nullopt; }
    Diagnosis whole = joined_passes(model, *resting, *moving, moving->reference->samples_per_row);
    whole.passes.front().is_at_rest = true;
    whole.reference = moving->reference;
    return whole;
}

std::optional<Diagnosis> diagnose_against_orientation(const std::shared_ptr<const Recording>& recording,
                                                      const std::shared_ptr<const Recording>& means,
                                                      const SensorModel& model, const std::string& model_name,
                                                      DiagnosisOptions options) {
    if (options.holdout) { options.holdout = shared_means(*options.holdout); }
    auto diagnosis = diagnose_in_two_passes(recording, means, model, model_name, options);
    if (diagnosis) { diagnosis->reference->is_orientation = true; }
    return diagnosis;
}

// Gyros have noise of all the kinds that the judged one has.
std::optional<Diagnosis> diagnose_against_units(const std::shared_ptr<const Recording>& recording,
                                                const SensorModel& model, const std::string& model_name,
                                                const DiagnosisOptions& options) {
    auto diagnosis = diagnose_in_two_passes(recording, recording, model, model_name, options);
    if (diagnosis) { diagnosis->reference->gyros = recording->reference_gyros; }
    return diagnosis;
}

std::optional<Diagnosis> diagnose_against_rates(const std::shared_ptr<const Recording>& recording,
                                                SensorModel model, const ReferenceNoise& noise,
                                                const std::string& model_name,
                                                const DiagnosisOptions& options) {
    model.ref_noise_rad_s = noise.of_all_rad_s();
    auto diagnosis = diagnose(recording, model, model_name, options);
    if (diagnosis) {
        diagnosis->reference = quality_of_rates(model, recording, noise.sd_rad_s, options.seed);
    }
    return diagnosis;
}

}  // namespace

bool moves_against_orientation(const Recording& recording) {
    return has_orientation(recording) && std::ranges::none_of(axis_names, [&](const char* axis) {
               return recording.find(std::string("ref_") + axis) != nullptr;
           });
}

Recording means_against_orientation(const Recording& recording) {
    const double samples =
        std::max(1.0, std::round(resolution::row_against_orientation_s * recording.rate_hz));
    return means_of(with_turn_rates(recording), static_cast<std::size_t>(samples));
}

std::optional<Diagnosis> diagnose_in_motion(const std::shared_ptr<const Recording>& recording,
                                            const SensorModel& model, const std::string& model_name,
                                            const DiagnosisOptions& options) {
    if (moves_against_orientation(*recording)) {
        const auto means = shared_means(*recording);
        return diagnosis_refusal(*means)
                   ? diagnose(recording, model, model_name, options)
                   : diagnose_against_orientation(recording, means, model, model_name, options);
    }
    if (recording->reference_gyros > 0) {
        return diagnose_against_units(recording, model, model_name, options);
    }
    const ReferenceNoise noise =
        model.ref_noise_rad_s > 0.0 ? ReferenceNoise{} : reference_noise_at_rest(*recording);
    if (!(noise.of_all_rad_s() > 0.0)) { return diagnose(recording, model, model_name, options); }
    return noise.is_known_well ? diagnose_against_rates(recording, model, noise, model_name, options)
                               : diagnose_in_two_passes(recording, recording, model, model_name, options);
}

}  // namespace gyrolog
