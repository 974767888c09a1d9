// A prediction is what the likelihood of a recording under one model needs apart from its noise: the grid of
// samples, what the world did, the model's noise-free answer to it and its expected spectrum. Simulations of
// the recording share it.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/likelihood/recent_responses.hpp"
#include "analysis/diagnose/likelihood/response_memory.hpp"
#include "analysis/diagnose/likelihood/spectral_bins.hpp"
#include "analysis/diagnose/likelihood/stand_ins.hpp"
#include "analysis/diagnose/likelihood/uncertain_mean.hpp"
#include "analysis/numerics/cosine_transform.hpp"
#include "analysis/simulate/effect_signature.hpp"
#include "analysis/simulate/recorded_world.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

namespace resolution {

inline constexpr std::size_t diagnosable_samples_min = 2048;
// 24 h at 100 Hz; several copies of each axis are held at once. Longer ones: multiscale/long_diagnosis.hpp.
inline constexpr std::size_t diagnosable_samples_max = 9'000'000;

}  // namespace resolution

// The function says why a recording cannot be diagnosed: no axis x, y or z, counts without a scale, too
// short, more holes than samples. It returns nothing where the recording can.
std::optional<std::string> diagnosis_refusal(const Recording& recording);

class Prediction {
public:
    // Whose noise it is that the samples have about the model's answer. The error of a reference that nobody
    // states is in it, so that it says nothing of the sensor's.
    enum class NoiseOf { sensor, reference_too };

    // `world`'s recording has no diagnosis_refusal(), `model` no simulation_refusal().
    Prediction(std::shared_ptr<const RecordedWorld> world, const SensorModel& model,
               NoiseOf noise = NoiseOf::sensor);

    const RecordedWorld& world() const { return *world_; }
    std::shared_ptr<const RecordedWorld> shared_world() const { return world_; }
    const SensorModel& model() const { return model_; }
    double rate_hz() const { return rate_hz_; }
    // The number of slots of the grid, from the first sample on, that are judged: fast_length() of all.
    std::size_t length() const { return length_; }
    double duration_s() const { return static_cast<double>(length_) / rate_hz_; }
    // The half of the recording that bins and observations keep to.
    Half half() const { return half_; }
    const std::vector<std::size_t>& axes() const { return axes_; }  // that the recording has
    bool moves() const { return world_->has_reference(); }
    // What judges noise judges the sensor's.
    bool noise_is_sensors() const { return shared_->noise == NoiseOf::sensor; }
    // Of another world, with nothing in common but whose the noise is.
    std::shared_ptr<const Prediction> in_world(std::shared_ptr<const RecordedWorld> world,
                                               const SensorModel& model) const {
        return std::make_shared<const Prediction>(std::move(world), model, shared_->noise);
    }

    // The temperature by slot; empty without a thermometer.
    const std::vector<float>& temperature_C() const { return temperature_C_; }
    // The model's answer to the denoised world without noise and quantisation, by slot, and what the
    // reference's noise as it was recorded makes of it; empty for an axis that the recording lacks.
    const std::vector<float>& response_rad_s(std::size_t axis) const { return response_rad_s_[axis]; }

    // In a moving world, by slot: the denoised world's rate as the model times it, about the sensor's axes,
    // and how the model's answer changes in time.
    const std::vector<float>& true_rate_rad_s(std::size_t axis) const { return true_rate_rad_s_[axis]; }
    const std::vector<float>& response_change_rad_s2(std::size_t axis) const {
        return response_change_rad_s2_[axis];
    }
    // The same world with the reference's noise filtered out as far as its spectrum allows
    // (denoised_reference.hpp): what a model misses of the motion is a function of the true rate, not of the
    // noise. It is the world itself where nothing moves.
    std::shared_ptr<const RecordedWorld> denoised_world() const { return shared_->denoised_world; }
    // The model's answer to the denoised world, by slot.
    const std::vector<float>& denoised_response_rad_s(std::size_t axis) const {
        return denoised_response_rad_s_[axis];
    }
    // What the noise that the model states of the reference is worth on the axis, one sigma of a sample; 0
    // where the model's own noise has it.
    double reference_noise_rad_s(std::size_t axis) const;
    // Within what nobody knows the rate at a sample, one sigma: the reference's noise, or all noise that may
    // be the reference's.
    double rate_sd_rad_s(std::size_t axis) const;
    const UncertainMean& uncertain(std::size_t axis) const { return uncertain_[axis]; }
    // In a moving world, what is expected in the recording's holes under the model's noise; null where there
    // are none.
    const std::shared_ptr<const ExpectedStandIns>& holes(std::size_t axis) const { return holes_[axis]; }

    const SpectralBins& bins() const { return bins_; }
    const std::vector<double>& bin_frequencies_hz() const { return f_hz_; }
    // The two-sided densities at the bins' middles under the model, in (rad/s)^2/Hz.
    const std::vector<SpectralParts>& parts(std::size_t axis) const { return parts_[axis]; }
    // The same of a model that differs from this one only in parameters of noise spectra.
    std::vector<SpectralParts> parts_of(const SensorModel& model, std::size_t axis) const;

    // The variance of the white noise by slot, as a multiple of its mean over the record; empty where the
    // model has it constant.
    const std::vector<float>& white_course(std::size_t axis) const { return white_course_[axis]; }

    // The prediction of another model for the same world.
    std::shared_ptr<const Prediction> with(const SensorModel& model) const;
    // The prediction of one half for the same world and model.
    std::shared_ptr<const Prediction> of_half(Half half) const;
    // The memory is shared by all predictions that come from one.
    ResponseMemory& memory() const { return shared_->responses; }
    RecentResponses& recent_responses() const { return shared_->recent; }
    // A transform of length() values.
    TransformPool::Lease transform() const { return shared_->transforms.lease(); }

private:
    // What predictions of other models have in common with the first.
    struct Shared {
        Shared(std::size_t length, NoiseOf whose) : noise(whose), transforms(length) {}
        NoiseOf noise;
        ResponseMemory responses;
        RecentResponses recent;
        TransformPool transforms;
        std::shared_ptr<const RecordedWorld> denoised_world;
        std::optional<std::vector<std::size_t>> level_changes;
    };

    Prediction(std::shared_ptr<const RecordedWorld> world, const SensorModel& model, NoiseOf noise,
               std::shared_ptr<Shared> shared, Half half);

    double stated_noise_rad_s(const SensorModel& model, std::size_t axis) const;
    void read_temperature();
    void read_responses();
    std::vector<std::size_t> level_changes_of_recording() const;
    void read_motion();
    void read_holes();
    void read_uncertain_responses();
    std::array<std::vector<float>, 3> response_per_gain(std::size_t from) const;
    void add_reference_noise();
    // Mean square of the factors on the axis' white noise.
    double read_white_course(std::size_t axis);
    void expect_spectrum();

    std::shared_ptr<const RecordedWorld> world_;
    SensorModel model_;
    std::shared_ptr<Shared> shared_;
    Half half_;
    double rate_hz_ = 0.0;
    std::size_t length_ = 0;
    std::vector<std::size_t> axes_;
    std::vector<float> temperature_C_;
    std::array<std::vector<float>, 3> response_rad_s_;
    std::array<std::vector<float>, 3> denoised_response_rad_s_;
    std::array<std::vector<float>, 3> true_rate_rad_s_;
    std::array<std::vector<float>, 3> response_change_rad_s2_;
    std::array<std::shared_ptr<const ExpectedStandIns>, 3> holes_;
    std::array<UncertainMean, 3> uncertain_;
    std::array<std::vector<float>, 3> white_course_;
    std::array<double, 3> white_course_mean_{};  // what parts() have of it
    SpectralBins bins_;
    std::vector<double> f_hz_;
    std::array<std::vector<SpectralParts>, 3> parts_;
};

// The model's answer to the world without noise, quantisation and whatever is drawn by chance, by slot; times
// are those of the prediction's grid.
std::array<std::vector<float>, 3> noise_free_response(const Prediction& prediction, const SensorModel& model);
// The same of another world with the same grid.
std::array<std::vector<float>, 3> noise_free_response(const Prediction& prediction,
                                                      std::shared_ptr<const RecordedWorld> world,
                                                      const SensorModel& model);

// The model with nothing random left in it but what the world tells. Of the moments that samples show their
// mean stays.
SensorModel without_noise(const SensorModel& model, const RecordedWorld& world);

}  // namespace gyrolog
