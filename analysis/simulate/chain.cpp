#include "analysis/simulate/chain.hpp"

#include <cmath>

#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

constexpr ChainLink own(StageMaker make) { return {.own = make}; }
constexpr ChainLink effect(const EffectDefinition& definition) { return {.effect = &definition}; }
constexpr ChainLink timing_of(const EffectDefinition& definition) { return {.timing_of = &definition}; }

constexpr ChainLink links[] = {
    // when a sample is taken, and what its stamp says
    own(make_sample_clock),
    effect(dropped_effect),
    effect(clock_rate_effect),
    effect(latency_effect),
    timing_of(stale_effect),
    effect(clock_jitter_effect),
    // what is there to be measured
    own(make_world),
    effect(self_heating_effect),
    // the answer to it
    own(make_rate_response),
    effect(scale_factor_effect),
    effect(misalignment_effect),
    effect(nonlinearity_effect),
    effect(asymmetry_effect),
    effect(dead_zone_effect),
    effect(rate_table_effect),
    effect(g_sensitivity_effect),
    effect(vibration_rectification_effect),
    // the bias
    own(make_bias),
    effect(rate_ramp_effect),
    effect(bias_step_effect),
    effect(warmup_effect),
    effect(temp_linear_effect),
    effect(temp_quadratic_effect),
    effect(temp_cubic_effect),
    effect(temp_lag_effect),
    effect(temperature_table_effect),
    effect(time_table_effect),
    own(make_rate_ramp),
    // noise
    own(make_flicker_noise),
    own(make_rate_random_walk),
    own(make_angle_quantisation),
    effect(flicker_missing_effect),
    effect(rrw_missing_effect),
    effect(angle_noise_effect),
    effect(gauss_markov_effect),
    effect(rtn_effect),
    own(make_white_noise),
    // what acts on the white noise alone
    effect(heavy_tail_effect),
    effect(arw_scale_effect),
    effect(variance_change_effect),
    effect(temp_noise_effect),
    effect(noise_colour_effect),
    effect(density_table_effect),
    effect(level_table_effect),
    // white noise from outside, such as the supply's
    effect(common_mode_effect),
    // the sensor's bandwidth
    effect(lowpass_effect),
    effect(biquad_effect),
    own(make_noise_sum),
    // a line as high as it shows: the filter passed it at its true frequency, not at the one it folds to
    effect(tone_effect),
    effect(narrowband_effect),
    effect(disturbance_effect),
    own(make_temperature_scale),
    effect(temp_scale_effect),
    effect(saturation_effect),
    effect(quantization_effect),
    effect(spikes_effect),
    // reading out
    own(make_thermometer),
    effect(stale_effect),
};

}  // namespace

std::span<const ChainLink> signal_chain() { return links; }

const EffectDefinition* find_effect(std::string_view name) {
    for (const ChainLink& link : links) {
        if (link.effect != nullptr && link.effect->name == name) { return link.effect; }
    }
    return nullptr;
}

double true_rate_hz(const SensorModel& model, double nominal_hz) {
    double rate_hz = nominal_hz;
    for (const EffectModel& entry : model.effects) {
        const EffectDefinition* definition = find_effect(entry.effect);
        if (definition->rate_error.empty()) { continue; }
        rate_hz *= 1.0 + entry.params.at(std::string(definition->rate_error));
    }
    return rate_hz;
}

double converter_step_rad_s(const SensorModel& model, std::size_t axis) {
    constexpr double whole = 1e-4;
    double step_rad_s = model.lsb_rad_s;
    if (step_rad_s == 0.0) { return 0.0; }
    for (const EffectModel& entry : model.effects) {
        const std::string_view param = find_effect(entry.effect)->converter_step;
        if (param.empty() || !acts_on(entry, axis)) { continue; }
        const double coarser_rad_s = entry.params.at(std::string(param)) * rad_per_deg;
        const double codes = coarser_rad_s / model.lsb_rad_s;
        if (codes > 1.0 && std::fabs(codes - std::round(codes)) > whole * codes) {
            step_rad_s = coarser_rad_s;
        }
    }
    return step_rad_s;
}

std::array<double, 3> converter_steps_rad_s(const SensorModel& model) {
    return {converter_step_rad_s(model, 0), converter_step_rad_s(model, 1), converter_step_rad_s(model, 2)};
}

Chain make_chain(const StageContext& nominal) {
    const StageContext context{nominal.model, true_rate_hz(nominal.model, nominal.rate_hz), nominal.seed,
                               nominal.world};
    Chain chain;
    const auto take = [&](std::unique_ptr<Stage> stage) {
        if (stage) { chain.stages.push_back(std::move(stage)); }
    };
    for (const ChainLink& link : links) {
        if (link.own != nullptr) {
            if (link.own == make_world) { chain.clock_stages = chain.stages.size(); }
            take(link.own(context));
            continue;
        }
        const EffectDefinition& definition = link.effect != nullptr ? *link.effect : *link.timing_of;
        const auto make = link.effect != nullptr ? definition.make : definition.make_timing;
        unsigned place = 0;
        for (const EffectModel& entry : context.model.effects) {
            if (entry.effect == definition.name) { take(make(EffectUse(context, definition, entry, place))); }
            ++place;
        }
    }
    return chain;
}

}  // namespace gyrolog
