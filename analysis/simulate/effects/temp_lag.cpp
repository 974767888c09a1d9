#include <algorithm>
#include <optional>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/reference_temperature.hpp"
#include "analysis/simulate/effects/temperature_bias.hpp"
#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

namespace {

// A first-order lag, exact for a temperature that runs straight between samples, kept as its distance from
// the temperature: slow lags would lose digits otherwise.
class Lag {
public:
    explicit Lag(double tau_samples) {
        if (tau_samples == 0.0) { return; }
        kept_ = portable_exp(-std::min(1.0 / tau_samples, 700.0));
        of_step_ = (1.0 - kept_) * tau_samples;
    }

    double operator()(double now_C) {
        behind_C_ = kept_ * behind_C_ + of_step_ * (now_C - before_C_.value_or(now_C));
        before_C_ = now_C;
        return now_C - behind_C_;
    }

private:
    double kept_ = 0.0;
    double of_step_ = 0.0;
    double behind_C_ = 0.0;
    std::optional<double> before_C_;
};

class Play {
public:
    explicit Play(double width_C) : half_C_(0.5 * width_C) {}

    double operator()(double now_C) {
        follows_C_ = std::clamp(follows_C_.value_or(now_C), now_C - half_C_, now_C + half_C_);
        return *follows_C_;
    }

private:
    double half_C_;
    std::optional<double> follows_C_;
};

struct LateBias {
    Lag lag;
    Play play;
    double slope_rad_s_per_C;
    double reference_C;

    double operator()(double die_C) { return slope_rad_s_per_C * (play(lag(die_C)) - reference_C); }
};

std::unique_ptr<Stage> make_temp_lag(const EffectUse& use) {
    return std::make_unique<TemperatureBias<LateBias>>(
        use, LateBias{Lag(use["tau_s"] * use.context().rate_hz), Play(use["play_C"]),
                      use["c1_dps_per_C"] * rad_per_deg, reference_C(use)});
}

constexpr EffectParam temp_lag_params[] = {
    {.name = "c1_dps_per_C", .meaning = "slope, in the end", .plausible_from = -0.3, .plausible_to = 0.3},
    {.name = "tau_s",
     .meaning = "time constant of the lag",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 120.0,
     .plausible_to = 900.0,
     .otherwise = 0.0},
    {.name = "play_C",
     .meaning = "hysteresis: width of the loop, after the lag",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.0,
     .plausible_to = 5.0,
     .otherwise = 0.0},
    reference_C_param,
};

constexpr std::string_view temp_lag_linear[] = {"c1_dps_per_C"};
constexpr TrialValues temp_lag_tau_values[] = {{.param = "tau_s", .from = 60.0, .to = 1800.0, .count = 10}};
constexpr TrialValues play_values[] = {{.param = "play_C", .from = 0.2, .to = 5.0, .count = 7}};
constexpr std::span<const TrialValues> temp_lag_trials[] = {temp_lag_tau_values, play_values};

constexpr EffectSignature temp_lag_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::temperature,
    .needs_temperature = true,
    .linear = temp_lag_linear,
    .slow = true,
    .trials = temp_lag_trials,
    .words =
        "The output follows the temperature late, {c1_dps_per_C}[, with a lag of {tau_s}][, with a play of "
        "{play_C}]",
    .noun = "a temperature coefficient of {c1_dps_per_C} that acts {tau_s} late",
    .decided_by = "one sweep of the temperature up and down by 5 degC or more",
};

}  // namespace

constinit const EffectDefinition temp_lag_effect = {
    .name = "temp_lag",
    .model =
        "rate + c1_dps_per_C (y - reference_C), y the play of u with tau_s du/dt = T - u, both settled at "
        "first",
    .source = "play operator: M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, Springer 1996",
    .params = temp_lag_params,
    .make = make_temp_lag,
    .signature = &temp_lag_signature,
};

}  // namespace gyrolog
