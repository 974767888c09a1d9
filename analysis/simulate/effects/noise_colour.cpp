// White noise w behind one zero and one pole, as averages and differences of successive samples have them:
//
//   y_k = pole y_{k-1} + g (w_k - zero w_{k-1}),   g = (1 - pole) / (1 - zero),   both within -1 and 1
//
// so that slow noise passes as it is and N, the angle random walk, stays the model's: an average on the chip
// is then this effect alone, with no arw_scale beside it, and arw_scale is what changes the slow noise too.
// With z = (1 + zero) / (1 - zero), p = (1 + pole) / (1 - pole) and x = tan(pi f / rate) the density is
//
//   N^2 (1 + z^2 x^2) / (1 + p^2 x^2)
//
// (G. E. P. Box, G. M. Jenkins, G. C. Reinsel, Time Series Analysis, 3.4, with 1 - 2 a cos v + a^2 =
// (1 - a)^2 cos^2(v/2) + (1 + a)^2 sin^2(v/2)). Its parameters are, as of a step in the logarithms of both,
// its height and its middle:
//
//   gain = z / p, the amplitude at half the rate;    middle: where it is sqrt(gain), x = 1 / sqrt(z p),
//
// whence z = sqrt(gain) / x and p = 1 / (sqrt(gain) x) with the middle's x. Both are positive, which zero and
// pole are not, and hardly correlated where the colour is faint. An average of two samples, zero = -1, is the
// end of the range, gain = 0.
#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

namespace {

struct Ratios {
    double zero;
    double pole;
};

// `x` = tan(pi middle).
Ratios ratios(double gain, double x) {
    const double root = std::sqrt(gain);
    return {root / x, 1.0 / (root * x)};
}

double portable_tan_of_half_turns(double half_turns) {
    return portable_sine_of_turns(0.5 * half_turns) / portable_sine_of_turns(0.5 * half_turns + 0.25);
}

// y = g (w + (pole - zero) s), where s_k = pole s_{k-1} + w_{k-1} is the autoregression of the samples
// before.
class ColouredNoise final : public Stage {
public:
    explicit ColouredNoise(const EffectUse& use) {
        const Ratios at = ratios(use["gain"], portable_tan_of_half_turns(use["middle_of_rate"]));
        const double zero = (at.zero - 1.0) / (at.zero + 1.0);
        pole_ = (at.pole - 1.0) / (at.pole + 1.0);
        gain_ = (1.0 - pole_) / (1.0 - zero);
        of_before_ = pole_ - zero;
        before_sd_ = 1.0 / std::sqrt(1.0 - pole_ * pole_);
        sd_ = gain_ * std::sqrt(1.0 + of_before_ * before_sd_ * of_before_ * before_sd_);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (use.acts_on(axis)) { axes_[axis] = Axis{use.stream(axis), 0.0}; }
        }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!axes_[axis]) { continue; }
            double& before = axes_[axis]->before_rad_s;
            if (block.first() == 0) {
                before = block.white_sd_rad_s[axis] * before_sd_ * axes_[axis]->start.normal(0);
            }
            for (double& value : block.slots(block.white_rad_s[axis])) {
                const double white_rad_s = value;
                value = gain_ * (white_rad_s + of_before_ * before);
                before = pole_ * before + white_rad_s;
            }
            block.white_sd_rad_s[axis] *= sd_;
        }
    }

private:
    struct Axis {
        RandomStream start;
        double before_rad_s;
    };

    double pole_ = 0.0;
    double gain_ = 1.0;
    double of_before_ = 0.0;
    double before_sd_ = 1.0;  // for white noise of standard deviation one
    double sd_ = 1.0;
    std::array<std::optional<Axis>, 3> axes_;
};

std::unique_ptr<Stage> make_noise_colour(const EffectUse& use) {
    return std::make_unique<ColouredNoise>(use);
}

constexpr EffectParam noise_colour_params[] = {
    {.name = "gain",
     .meaning = "amplitude at half the rate, in that of slow noise",
     .range = EffectParam::Range::positive,
     .plausible_from = 0.1,
     .plausible_to = 10.0},
    // Slower steps are those of slow noise beside the white.
    {.name = "middle_of_rate",
     .meaning = "frequency over the rate at which the amplitude is sqrt(gain)",
     .range = EffectParam::Range::positive,
     .plausible_from = 0.05,
     .plausible_to = 0.45,
     .most = 0.49},
};

void noise_colour_spectrum(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                           std::span<SpectralParts> parts) {
    const Ratios at = ratios(effect["gain"], std::tan(pi * effect["middle_of_rate"]));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double sine = std::sin(pi * f_hz[i] / rate_hz);
        const double cosine = std::cos(pi * f_hz[i] / rate_hz);
        parts[i].white *= (cosine * cosine + at.zero * at.zero * sine * sine) /
                          (cosine * cosine + at.pole * at.pole * sine * sine);
    }
}

constexpr std::string_view noise_colour_fitted[] = {"gain", "middle_of_rate"};
constexpr TrialValues noise_colour_values[] = {
    {.param = "gain", .from = 0.3, .to = 3.0, .count = 6},
    {.param = "middle_of_rate", .from = 0.06, .to = 0.4, .count = 4}};
constexpr std::span<const TrialValues> noise_colour_trials[] = {noise_colour_values};

constexpr EffectSignature noise_colour_signature = {
    .folds = true,
    .trials = noise_colour_trials,
    .spectral = noise_colour_fitted,
    .spectrum = noise_colour_spectrum,
    .words =
        "The white noise has a colour: at half the sampling rate its amplitude is {gain} times that of slow "
        "noise, half of the way at {middle_of_rate} of the rate",
    .noun = "white noise with a colour",
    .decided_by = "any still recording of some minutes at another sample rate",
};

}  // namespace

constinit const EffectDefinition noise_colour_effect = {
    .name = "noise_colour",
    .model =
        "white noise through y_k = pole y_(k-1) + g (w_k - zero w_(k-1)), g = (1 - pole) / (1 - zero), whose "
        "amplitude rises or falls from that of the white noise to gain times it at half the rate and is "
        "sqrt(gain) times it at middle_of_rate",
    .source = "Box, Jenkins, Reinsel, Time Series Analysis, 3.4 (ARMA(1, 1))",
    .params = noise_colour_params,
    .make = make_noise_colour,
    .noise_only = true,
    .signature = &noise_colour_signature,
};

}  // namespace gyrolog
