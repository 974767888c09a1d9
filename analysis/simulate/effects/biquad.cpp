// A section of a digital filter at the sampling rate,
//
//   y_k = b0 x_k + b1 x_(k-1) + b2 x_(k-2) - a1 y_(k-1) - a2 y_(k-2),
//
// on all that comes before it: H(z) = (b0 + b1 / z + b2 / z^2) / (1 + a1 / z + a2 / z^2). Its poles lie
// inside the unit circle where |a2| < 1 and |a1| < 1 + a2 (A. V. Oppenheim, R. W. Schafer, Discrete-Time
// Signal Processing, 3rd ed., 6.3). The signal starts in the steady state of its first value, the white noise
// after as many draws as the slower pole needs to forget.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>

#include "analysis/simulate/effects/axis_filters.hpp"
#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

// A filter that remembers longer starts with noise that has not settled.
constexpr std::uint64_t settling_draws_most = 100'000;
// Of the noise's amplitude: what is left of its start.
constexpr double settled_rel = 1e-6;

struct Coefficients {
    double b0, b1, b2, a1, a2;

    template <typename Values>
    static Coefficients of(const Values& values) {
        return {values["b0"], values["b1"], values["b2"], values["a1"], values["a2"]};
    }
    double gain_of_constant() const { return (b0 + b1 + b2) / (1.0 + a1 + a2); }
    double largest_pole() const {
        const std::complex<double> root = std::sqrt(std::complex<double>(a1 * a1 - 4.0 * a2));
        return std::max(std::abs(-a1 + root), std::abs(-a1 - root)) / 2.0;
    }
};

class Section {
public:
    explicit Section(const Coefficients& coefficients) : c_(coefficients) {}

    void start(double input) {
        x_1_ = x_2_ = input;
        y_1_ = y_2_ = c_.gain_of_constant() * input;
    }

    double operator()(double x) {
        const double y = c_.b0 * x + c_.b1 * x_1_ + c_.b2 * x_2_ - c_.a1 * y_1_ - c_.a2 * y_2_;
        x_2_ = x_1_;
        x_1_ = x;
        y_2_ = y_1_;
        y_1_ = y;
        return y;
    }

private:
    Coefficients c_;
    double x_1_ = 0.0;
    double x_2_ = 0.0;
    double y_1_ = 0.0;
    double y_2_ = 0.0;
};

struct BiquadAxis {
    Section signal;
    Section noise;
    RandomStream draws;
    std::uint64_t settling_draws = 0;

    void start(double first_rad_s, double white_sd_rad_s) {
        signal.start(first_rad_s);
        for (std::uint64_t i = 0; i < settling_draws; ++i) { noise(white_sd_rad_s * draws.normal(i)); }
    }
};

std::uint64_t settling_draws_of(const Coefficients& coefficients) {
    const double pole = coefficients.largest_pole();
    const double needed = pole > 0.0 ? std::log(settled_rel) / std::log(pole) : 0.0;
    return needed < static_cast<double>(settling_draws_most) ? static_cast<std::uint64_t>(needed) + 2
                                                             : settling_draws_most;
}

std::unique_ptr<Stage> make_biquad(const EffectUse& use) {
    const Coefficients coefficients = Coefficients::of(use);
    const std::uint64_t settling_draws = settling_draws_of(coefficients);
    return std::make_unique<AxisFilters<BiquadAxis>>(use, [&](std::size_t axis) {
        return BiquadAxis{Section(coefficients), Section(coefficients), use.stream(axis), settling_draws};
    });
}

std::optional<std::string> biquad_refusal(const EffectModel& effect) {
    const Coefficients c = Coefficients::of(EffectValues(effect));
    if (std::fabs(c.a2) < 1.0 && std::fabs(c.a1) < 1.0 + c.a2) { return std::nullopt; }
    return "has a pole on or outside the unit circle: |a2| < 1 and |a1| < 1 + a2 are needed";
}

constexpr EffectParam biquad_params[] = {
    {.name = "b0", .meaning = "of the numerator, for the sample itself"},
    {.name = "b1", .meaning = "for the one before", .otherwise = 0.0},
    {.name = "b2", .meaning = "for the one before that", .otherwise = 0.0},
    {.name = "a1", .meaning = "of the denominator 1 + a1 / z + a2 / z^2", .otherwise = 0.0},
    {.name = "a2", .meaning = "likewise", .otherwise = 0.0},
};

void biquad_spectrum(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                     std::span<SpectralParts> parts) {
    const Coefficients c = Coefficients::of(effect);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::complex<double> back = std::polar(1.0, -2.0 * pi * f_hz[i] / rate_hz);
        const double gain =
            std::norm(c.b0 + back * (c.b1 + back * c.b2)) / std::norm(1.0 + back * (c.a1 + back * c.a2));
        parts[i].white *= gain;
        parts[i].flicker *= gain;
        parts[i].walk *= gain;
        parts[i].added_white *= gain;
        parts[i].added_signal *= gain;
    }
}

constexpr EffectSignature biquad_signature = {
    .method = EvidenceMethod::described,
    .spectrum = biquad_spectrum,
    .words = "A digital filter is missing in the model",
    .noun = "a digital filter",
};

}  // namespace

constinit const EffectDefinition biquad_effect = {
    .name = "biquad",
    .model = "y = b0 x + b1 x(k-1) + b2 x(k-2) - a1 y(k-1) - a2 y(k-2)",
    .source = "definition; stability: Oppenheim, Schafer, Discrete-Time Signal Processing, 6.3",
    .params = biquad_params,
    .make = make_biquad,
    .refusal = biquad_refusal,
    .signature = &biquad_signature,
};

}  // namespace gyrolog
