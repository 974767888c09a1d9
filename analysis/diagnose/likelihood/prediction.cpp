#include "analysis/diagnose/likelihood/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analysis/diagnose/likelihood/denoised_reference.hpp"
#include "analysis/diagnose/likelihood/hole_filling.hpp"
#include "analysis/diagnose/likelihood/level_changes.hpp"
#include "analysis/numerics/cosine_transform.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog::resolution {

// Over which the motion's change is taken.
constexpr double time_step_s = 1e-3;
constexpr double gain_step = 0.01;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

std::vector<std::size_t> axes_of(const Recording& recording) {
    std::vector<std::size_t> axes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Column* column = recording.find(gyro_columns[axis]);
        if (column != nullptr && column->unit == "rad/s") { axes.push_back(axis); }
    }
    return axes;
}

std::size_t slots_of(const Recording& recording) {
    const Segment& last = recording.segments.back();
    return static_cast<std::size_t>(last.first_index - recording.segments.front().first_index) + last.count;
}

double reference_noise(const SensorModel& model, std::size_t axis) {
    const Vector3& gains = model.M[axis];
    return std::hypot(gains[0], gains[1], gains[2]) * model.ref_noise_rad_s;
}

SpectralParts own_parts(const SensorModel& model, std::size_t axis, double reference_noise_rad_s, double f_hz,
                        double rate_hz) {
    const NoiseCoefficients& noise = model.axes[axis].noise;
    const double omega = 2.0 * pi * f_hz;
    // Of the sampled process, both the random walk and the angle's rounding error have their aliases in
    // closed form.
    const double sampled_omega = 2.0 * rate_hz * std::sin(pi * f_hz / rate_hz);
    SpectralParts parts;
    parts.white = noise.N_rad_per_sqrt_s * noise.N_rad_per_sqrt_s;
    parts.flicker = noise.B_rad_per_s * noise.B_rad_per_s / omega;
    parts.walk = noise.K_rad_per_s_sqrt_s * noise.K_rad_per_s_sqrt_s / (sampled_omega * sampled_omega);
    // A step in the model's place has its own effect's part.
    const bool own_step = converter_step_rad_s(model, axis) == model.lsb_rad_s;
    const double step_rad_s = own_step ? model.lsb_rad_s : 0.0;
    parts.other = step_rad_s * step_rad_s / (12.0 * rate_hz);
    parts.added_signal = sampled_omega * sampled_omega * noise.Q_rad * noise.Q_rad / rate_hz;
    // What the reference does not know of the motion is taken for the sensor's.
    parts.other += reference_noise_rad_s * reference_noise_rad_s / rate_hz;
    return parts;
}

double stated(const std::map<std::string, double>& uncertainties, const char* name, double otherwise) {
    const auto found = uncertainties.find(name);
    return found == uncertainties.end() ? otherwise : found->second;
}

SensorModel plain(const SensorModel& model) {
    SensorModel sensor;
    sensor.rate_hz = model.rate_hz;
    sensor.full_scale_rad_s = sensor.saturation_rad_s = 1e6;
    sensor.orientation = model.orientation;
    return sensor;
}

// A sensor without any fault: what it shows is the motion itself, as late as the model says.
SensorModel faultless(const SensorModel& model) {
    SensorModel sensor = plain(model);
    sensor.latency_s = model.latency_s;
    std::ranges::copy_if(model.effects, std::back_inserter(sensor.effects), [](const EffectModel& entry) {
        const EffectDefinition& effect = *find_effect(entry.effect);
        return effect.timing_only || effect.make_timing != nullptr;
    });
    return sensor;
}

// Gains and nothing else.
SensorModel linear(const SensorModel& model) {
    SensorModel sensor = plain(model);
    sensor.M = model.M;
    return sensor;
}

// Then what gains add is not the rate itself.
bool shapes_the_motion(const SensorModel& model) {
    return std::ranges::any_of(model.effects, [](const EffectModel& entry) {
        const EffectDefinition& effect = *find_effect(entry.effect);
        return !effect.noise_only && !effect.timing_only && effect.signature != nullptr &&
               !effect.signature->slow;
    });
}

// What changes the model's answer to a world, and nothing else.
SensorModel noiseless_and_certain(const SensorModel& model, const RecordedWorld& world) {
    SensorModel noiseless = without_noise(model, world);
    for (AxisModel& axis : noiseless.axes) { axis.sd_rel.clear(); }
    noiseless.sd_rel.clear();
    noiseless.sd_abs.clear();
    noiseless.accelerometer.reset();
    noiseless.carried_json.clear();
    return noiseless;
}

// Calls take(slot, rate) for every sample of an axis within `length` slots from the index `origin` on.
template <typename Take>
void for_each_sample(const Recording& recording, std::size_t axis, std::int64_t origin, std::size_t length,
                     Take take) {
    const Column& column = *recording.find(gyro_columns[axis]);
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const auto slot = static_cast<std::size_t>(segment.first_index - origin) + i;
            if (slot >= length) { return; }
            take(slot, column.value(segment.first + i));
        }
    }
}

std::array<std::vector<float>, 3> simulated_answer(const Prediction& prediction,
                                                   std::shared_ptr<const RecordedWorld> world,
                                                   const SensorModel& noiseless) {
    SimulationRequest request;
    request.like = std::move(world);
    RecordingSimulator simulator(noiseless, request);
    std::array<std::vector<float>, 3> response;
    for (const std::size_t axis : prediction.axes()) { response[axis].assign(prediction.length(), 0.0F); }
    const std::int64_t origin = prediction.world().recording().segments.front().first_index;
    Recording piece;
    while (simulator.next(piece)) {
        for (const std::size_t axis : prediction.axes()) {
            for_each_sample(piece, axis, origin, prediction.length(),
                            [&](std::size_t slot, double rate_rad_s) {
                                response[axis][slot] = static_cast<float>(rate_rad_s);
                            });
        }
    }
    return response;
}

std::vector<float> cosines_of(const std::vector<float>& values, CosineTransform& transform) {
    std::vector<double> work(values.begin(), values.end());
    transform.forward(work);
    work[0] = 0.0;
    return {work.begin(), work.end()};
}

}  // namespace

std::optional<std::string> diagnosis_refusal(const Recording& recording) {
    if (axes_of(recording).empty()) {
        return "has no angular rate of an axis x, y or z in a known scale: columns gx_dps, gy_dps, gz_dps "
               "(raw counts need a model with their lsb, --gyro takes one of an array, and angles cannot be "
               "diagnosed)";
    }
    if (recording.rows() < resolution::diagnosable_samples_min) {
        return "has " + std::to_string(recording.rows()) + " samples; a diagnosis needs at least " +
               std::to_string(resolution::diagnosable_samples_min);
    }
    if (slots_of(recording) > 2 * recording.rows()) {
        return "has more missing samples than samples: the longest unbroken part has to be cut out first";
    }
    return std::nullopt;
}

SensorModel without_noise(const SensorModel& model, const RecordedWorld& world) {
    SensorModel noiseless = model;
    for (AxisModel& axis : noiseless.axes) {
        const double ramp = axis.noise.R_rad_per_s2;
        axis.noise = {};
        axis.noise.R_rad_per_s2 = ramp;
    }
    noiseless.lsb_rad_s = 0.0;
    noiseless.timestamp_jitter_s = 0.0;
    noiseless.temp_noise_C = 0.0;
    noiseless.ref_noise_rad_s = 0.0;
    noiseless.acc_noise_m_s2 = 0.0;
    std::erase_if(noiseless.effects, [&](const EffectModel& entry) {
        const EffectDefinition& effect = *find_effect(entry.effect);
        if (!effect.noise_only) { return false; }
        if (effect.make_timing == nullptr) { return true; }
        if (effect.timing_is_known(entry, world)) { return false; }
        noiseless.latency_s += effect.mean_age_samples(entry) / world.recording().rate_hz;
        return true;
    });
    return noiseless;
}

Prediction::Prediction(std::shared_ptr<const RecordedWorld> world, const SensorModel& model, NoiseOf noise)
    : Prediction(std::move(world), model, noise, nullptr, Half::both) {}

Prediction::Prediction(std::shared_ptr<const RecordedWorld> world, const SensorModel& model, NoiseOf noise,
                       std::shared_ptr<Shared> shared, Half half)
    : world_(std::move(world)), model_(model), shared_(std::move(shared)), half_(half) {
    const Recording& recording = world_->recording();
    rate_hz_ = recording.rate_hz;
    length_ = fast_length(slots_of(recording));
    if (!shared_) { shared_ = std::make_shared<Shared>(length_, noise); }
    axes_ = axes_of(recording);
    read_temperature();
    read_responses();
    if (!shared_->level_changes) { shared_->level_changes = level_changes_of_recording(); }
    bins_ = spectral_bins(length_, rate_hz_, half_, *shared_->level_changes);
    if (moves()) { read_motion(); }
    expect_spectrum();
    if (!moves()) { return; }
    read_holes();
    read_uncertain_responses();
}

void Prediction::read_temperature() {
    if (!world_->has_temperature()) { return; }
    std::vector<double> at_s(length_);
    for (std::size_t slot = 0; slot < length_; ++slot) { at_s[slot] = static_cast<double>(slot) / rate_hz_; }
    std::vector<double> temperature_C(length_);
    world_->temperature(at_s, temperature_C);
    temperature_C_.assign(temperature_C.begin(), temperature_C.end());
}

void Prediction::read_responses() {
    std::shared_ptr<const RecordedWorld>& denoised = shared_->denoised_world;
    if (!denoised) { denoised = moves() ? without_reference_noise(*world_, model_.ref_noise_rad_s) : world_; }
    denoised_response_rad_s_ = noise_free_response(*this, denoised, model_);
    response_rad_s_ = denoised_response_rad_s_;
    if (moves()) { add_reference_noise(); }
}

// Of what the model does not expect, on any axis.
std::vector<std::size_t> Prediction::level_changes_of_recording() const {
    const Recording& recording = world_->recording();
    const SpectralBins whole = spectral_bins(length_, rate_hz_);
    const TransformPool::Lease transform = this->transform();
    std::vector<std::size_t> changes;
    for (const std::size_t axis : axes_) {
        const std::int64_t origin = recording.segments.front().first_index;
        std::vector<float> residual_rad_s(length_, 0.0F);
        std::vector<std::size_t> present;
        double sum_rad_s = 0.0;
        for_each_sample(recording, axis, origin, length_, [&](std::size_t slot, double rate_rad_s) {
            residual_rad_s[slot] = static_cast<float>(rate_rad_s) - response_rad_s_[axis][slot];
            sum_rad_s += static_cast<double>(residual_rad_s[slot]);
            present.push_back(slot);
        });
        const auto mean_rad_s = static_cast<float>(sum_rad_s / static_cast<double>(present.size()));
        for (const std::size_t slot : present) { residual_rad_s[slot] -= mean_rad_s; }
        const std::vector<std::size_t> of_axis = level_changes(cosines_of(residual_rad_s, *transform), whole);
        changes.insert(changes.end(), of_axis.begin(), of_axis.end());
    }
    std::ranges::sort(changes);
    changes.erase(std::unique(changes.begin(), changes.end()), changes.end());
    return changes;
}

void Prediction::read_motion() {
    const std::shared_ptr<const RecordedWorld> denoised = denoised_world();
    true_rate_rad_s_ = noise_free_response(*this, denoised, faultless(model_));
    SensorModel sooner = model_;
    SensorModel later = model_;
    sooner.latency_s -= 0.5 * resolution::time_step_s;
    later.latency_s += 0.5 * resolution::time_step_s;
    response_change_rad_s2_ = noise_free_response(*this, denoised, sooner);
    const std::array<std::vector<float>, 3> delayed = noise_free_response(*this, denoised, later);

    for (const std::size_t axis : axes_) {
        std::vector<float>& change = response_change_rad_s2_[axis];
        for (std::size_t slot = 0; slot < length_; ++slot) {
            change[slot] = (change[slot] - delayed[axis][slot]) / static_cast<float>(resolution::time_step_s);
        }
    }
}

void Prediction::read_holes() {
    const std::vector<Segment>& segments = world_->recording().segments;
    if (segments.size() == 1) { return; }
    std::vector<std::size_t> missing;
    std::size_t slot = 0;
    for (const Segment& segment : segments) {
        const auto begin = static_cast<std::size_t>(segment.first_index - segments.front().first_index);
        for (; slot < std::min(begin, length_); ++slot) { missing.push_back(slot); }
        slot = begin + segment.count;
    }
    for (; slot < length_; ++slot) { missing.push_back(slot); }
    for (const std::size_t axis : axes_) {
        holes_[axis] = std::make_shared<const ExpectedStandIns>(
            missing, inverse_covariance_of(*this, density_of_model(*this, axis)));
    }
}

void Prediction::read_uncertain_responses() {
    const TransformPool::Lease transform = this->transform();
    const double gain_sd = stated(model_.sd_abs, "M", 0.0);
    // One latency and one clock for all axes, each of which is fitted by itself: so much wider, all of them
    // off alike pay together what one parameter pays.
    const double alike = std::sqrt(static_cast<double>(axes_.size()));
    const double latency_sd_s = alike * stated(model_.sd_abs, "latency_s", 0.0);
    const double clock_sd = alike * clock_rate_sd_rel(model_);
    const bool is_shaped = gain_sd > 0.0 && shapes_the_motion(model_);
    std::array<std::array<std::vector<float>, 3>, 3> per_gain;  // by the rate's axis, then the answer's
    for (const std::size_t from : axes_) {
        if (is_shaped) { per_gain[from] = response_per_gain(from); }
    }
    for (const std::size_t axis : axes_) {
        const std::vector<float>& change = response_change_rad_s2_[axis];
        std::vector<UncertainResponse> uncertain;
        const auto take = [&](const std::vector<float>& values, double sd) {
            if (!(sd > 0.0)) { return; }
            uncertain.push_back({response_cosines(*this, axis, {values.begin(), values.end()}, *transform,
                                                  resolution::rounds_beside_uncertain),
                                 sd});
        };
        for (const std::size_t from : axes_) {
            take(is_shaped ? per_gain[from][axis] : true_rate_rad_s_[from], gain_sd);
        }
        take(change, latency_sd_s);
        std::vector<float> growing(length_);
        for (std::size_t slot = 0; slot < length_; ++slot) {
            growing[slot] = static_cast<float>(static_cast<double>(slot) / rate_hz_) * change[slot];
        }
        take(growing, clock_sd);
        uncertain_[axis] = UncertainMean(std::move(uncertain), bins_);
    }
}

// What one unit of the gains from one axis' rate would add to each axis.
std::array<std::vector<float>, 3> Prediction::response_per_gain(std::size_t from) const {
    SensorModel more = model_;
    for (Vector3& row : more.M) { row[from] += resolution::gain_step; }
    std::array<std::vector<float>, 3> per_gain = noise_free_response(*this, denoised_world(), more);
    for (const std::size_t axis : axes_) {
        for (std::size_t slot = 0; slot < length_; ++slot) {
            float& value = per_gain[axis][slot];
            value =
                (value - denoised_response_rad_s_[axis][slot]) / static_cast<float>(resolution::gain_step);
        }
    }
    return per_gain;
}

// Of the reference's noise every reading has its own: nothing in the sensor filters or delays it.
void Prediction::add_reference_noise() {
    const SensorModel gains = linear(model_);
    const auto with_noise = noise_free_response(*this, gains);
    const auto without = noise_free_response(*this, denoised_world(), gains);
    for (const std::size_t axis : axes_) {
        for (std::size_t slot = 0; slot < length_; ++slot) {
            response_rad_s_[axis][slot] += with_noise[axis][slot] - without[axis][slot];
        }
    }
}

double Prediction::read_white_course(std::size_t axis) {
    std::vector<WhiteGain> gains;
    double instant_variance_s2 = 0.0;
    const StageContext context{model_, rate_hz_, 0, nullptr};
    for (const EffectModel& entry : model_.effects) {
        const EffectDefinition* effect = find_effect(entry.effect);
        if (effect->signature != nullptr && effect->signature->white_gain != nullptr &&
            acts_on(entry, axis)) {
            gains.push_back(effect->signature->white_gain(EffectUse(context, *effect, entry, 0)));
        }
        if (effect->signature != nullptr && effect->signature->instant_sd_s != nullptr && moves()) {
            const double sd_s = effect->signature->instant_sd_s(EffectValues(entry));
            instant_variance_s2 += sd_s * sd_s;
        }
    }
    if (gains.empty() && instant_variance_s2 == 0.0) { return 1.0; }
    const double N = model_.axes[axis].noise.N_rad_per_sqrt_s;
    const double per_change_square = N > 0.0 ? instant_variance_s2 / (N * N * rate_hz_) : 0.0;
    const double reference_C =
        model_.temperature ? model_.temperature->reference_C : TemperatureModel{}.reference_C;
    std::vector<double> variance(length_, 1.0);
    double sum = 0.0;
    for (std::size_t slot = 0; slot < length_; ++slot) {
        const double time_s = static_cast<double>(slot) / rate_hz_;
        const double temperature_C =
            temperature_C_.empty() ? reference_C : static_cast<double>(temperature_C_[slot]);
        for (const WhiteGain& gain : gains) {
            const double factor = gain(time_s, temperature_C);
            variance[slot] *= factor * factor;
        }
        if (per_change_square > 0.0) {
            // A sample that is taken too early or too late is off by the rate's change meanwhile.
            const auto change = static_cast<double>(response_change_rad_s2_[axis][slot]);
            variance[slot] += per_change_square * change * change;
        }
        sum += variance[slot];
    }
    const double mean = sum / static_cast<double>(length_);
    // A factor of zero throughout leaves nothing to be scaled.
    if (!(mean > 0.0)) { return 0.0; }
    for (double& each : variance) { each /= mean; }
    white_course_[axis].assign(variance.begin(), variance.end());
    return mean;
}

void Prediction::expect_spectrum() {
    for (const SpectralBin& bin : bins_) { f_hz_.push_back(bin.f_hz); }
    for (const std::size_t axis : axes_) {
        white_course_mean_[axis] = read_white_course(axis);
        parts_[axis] = parts_of(model_, axis);
    }
}

std::vector<SpectralParts> Prediction::parts_of(const SensorModel& model, std::size_t axis) const {
    std::vector<SpectralParts> parts;
    const double reference_rad_s = stated_noise_rad_s(model, axis);
    for (const double f_hz : f_hz_) {
        parts.push_back(own_parts(model, axis, reference_rad_s, f_hz, rate_hz_));
    }
    for (const ChainLink& link : signal_chain()) {
        const EffectSignature* signature = link.effect == nullptr ? nullptr : link.effect->signature;
        if (signature == nullptr || signature->spectrum == nullptr) { continue; }
        for (const EffectModel& entry : model.effects) {
            if (entry.effect != link.effect->name || !acts_on(entry, axis)) { continue; }
            signature->spectrum(f_hz_, rate_hz_, EffectValues(entry, axis), parts);
        }
    }
    for (SpectralParts& part : parts) { part.white *= white_course_mean_[axis]; }
    return parts;
}

double Prediction::reference_noise_rad_s(std::size_t axis) const { return stated_noise_rad_s(model_, axis); }

double Prediction::stated_noise_rad_s(const SensorModel& model, std::size_t axis) const {
    return moves() && noise_is_sensors() ? reference_noise(model, axis) : 0.0;
}

double Prediction::rate_sd_rad_s(std::size_t axis) const {
    if (noise_is_sensors()) { return reference_noise_rad_s(axis); }
    std::vector<double> density;
    for (const SpectralParts& parts : parts_[axis]) { density.push_back(parts.sum()); }
    return std::sqrt(mean_density(bins_, density) * rate_hz_);
}

std::shared_ptr<const Prediction> Prediction::with(const SensorModel& model) const {
    return std::shared_ptr<const Prediction>(new Prediction(world_, model, shared_->noise, shared_, half_));
}

std::shared_ptr<const Prediction> Prediction::of_half(Half half) const {
    return std::shared_ptr<const Prediction>(new Prediction(world_, model_, shared_->noise, shared_, half));
}

std::array<std::vector<float>, 3> noise_free_response(const Prediction& prediction,
                                                      const SensorModel& model) {
    return noise_free_response(prediction, prediction.shared_world(), model);
}

std::array<std::vector<float>, 3> noise_free_response(const Prediction& prediction,
                                                      std::shared_ptr<const RecordedWorld> world,
                                                      const SensorModel& model) {
    const SensorModel answering = noiseless_and_certain(model, *world);
    return prediction.recent_responses().recall(
        world, answering, [&] { return simulated_answer(prediction, world, answering); });
}

}  // namespace gyrolog
