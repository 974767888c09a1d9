// Stationary Gaussian noise about a frequency, with the covariance
//
//   sigma^2 exp(-pi width |t|) cos(2 pi f t),
//
// the real part of a first-order complex Gauss-Markov process: the displacement of a lightly damped resonator
// in white noise, or a line whose phase and height wander. The width is that at half the height of its
// Lorentzian density. Its samples, T apart, are those of
//
//   a_k = rho exp(i 2 pi f T) a_{k-1} + sqrt(1 - rho^2) e_k,   rho = exp(-pi width T),
//
// exactly, whatever f is: above half the rate it folds. Its density, aliases included, is
//
//   sigma^2 T / 2 (P(u - v) + P(u + v)),   P(x) = (1 - rho^2) / (1 - 2 rho cos x + rho^2),
//
// u and v the angles of the frequency and of f in a sample, and the integral of P from 0 to x
// 2 atan(tan(x/2) / tanh(pi width T / 2)).
#include <algorithm>
#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"
#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

namespace {

struct NarrowbandNoise {
    RandomStream in_phase;
    RandomStream in_quadrature;
    double sigma_rad_s;
    double kept_cosine;  // rho exp(i 2 pi f T)
    double kept_sine;
    double innovation;
    double real = 0.0;  // in units of sigma
    double imaginary = 0.0;

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) {
        std::array<double, block_samples> real_draws;       // NOLINT(cppcoreguidelines-pro-type-member-init)
        std::array<double, block_samples> imaginary_draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        const std::size_t count = rate_rad_s.size();
        in_phase.normals(first_index, std::span(real_draws).first(count));
        in_quadrature.normals(first_index, std::span(imaginary_draws).first(count));
        for (std::size_t i = 0; i < count; ++i) {
            if (first_index + i == 0) {
                real = real_draws[i];
                imaginary = imaginary_draws[i];
            } else {
                const double before = real;
                real = kept_cosine * before - kept_sine * imaginary + innovation * real_draws[i];
                imaginary = kept_sine * before + kept_cosine * imaginary + innovation * imaginary_draws[i];
            }
            rate_rad_s[i] += sigma_rad_s * real;
        }
    }
};

std::unique_ptr<Stage> make_narrowband(const EffectUse& use) {
    return PerAxis<NarrowbandNoise>::make([&](std::size_t axis) -> std::optional<NarrowbandNoise> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        const double turns = use["f_hz"] / use.context().rate_hz;
        const double kept = portable_exp(-std::min(pi * use["width_hz"] / use.context().rate_hz, 700.0));
        return NarrowbandNoise{use.stream(axis, 0),
                               use.stream(axis, 1),
                               use["sigma_dps"] * rad_per_deg,
                               kept * portable_sine_of_turns(turns + 0.25),
                               kept * portable_sine_of_turns(turns),
                               std::sqrt(1.0 - kept * kept)};
    });
}

constexpr EffectParam narrowband_params[] = {
    {.name = "f_hz",
     .meaning = "middle frequency; above half the rate the noise appears folded",
     .range = EffectParam::Range::positive,
     .plausible_from = 3.0,
     .plausible_to = 200.0},
    {.name = "width_hz",
     .meaning = "width of the density at half its height",
     .range = EffectParam::Range::positive,
     .plausible_from = 0.02,
     .plausible_to = 20.0},
    {.name = "sigma_dps",
     .meaning = "standard deviation, as the samples show it",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.001,
     .plausible_to = 0.5},
};

// Of P from 0 to the angle, over 2 pi: a half at half a turn.
double share_up_to(double angle, double narrowness) {
    const double turns = std::round(angle / (2.0 * pi));
    return turns + std::atan(narrowness * std::tan(0.5 * (angle - 2.0 * pi * turns))) / pi;
}

// A line that is narrower than the distance of the frequencies is averaged over it.
void narrowband_spectrum(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                         std::span<SpectralParts> parts) {
    const double sigma_rad_s = effect["sigma_dps"] * rad_per_deg;
    const double narrowness = 1.0 / std::tanh(0.5 * pi * effect["width_hz"] / rate_hz);
    const double folded_hz = std::fabs(std::remainder(effect["f_hz"], rate_hz));
    const double per_hz = 2.0 * pi / rate_hz;
    const auto power_below = [&](double edge_hz) {
        return 0.5 * sigma_rad_s * sigma_rad_s *
               (share_up_to(per_hz * (edge_hz - folded_hz), narrowness) +
                share_up_to(per_hz * (edge_hz + folded_hz), narrowness));
    };
    const auto middle_hz = [&](std::size_t i) {
        if (i == 0) { return f_hz[0] * std::sqrt(f_hz[0] / f_hz[1]); }
        if (i == f_hz.size()) { return f_hz[i - 1] * std::sqrt(f_hz[i - 1] / f_hz[i - 2]); }
        return std::sqrt(f_hz[i - 1] * f_hz[i]);
    };
    if (f_hz.size() < 2) { return; }
    double from_hz = middle_hz(0);
    double below = power_below(from_hz);
    for (std::size_t i = 0; i < f_hz.size(); ++i) {
        const double to_hz = middle_hz(i + 1);
        const double up_to = power_below(to_hz);
        parts[i].other += (up_to - below) / (to_hz - from_hz);
        from_hz = to_hz;
        below = up_to;
    }
}

constexpr std::string_view narrowband_fitted[] = {"f_hz", "width_hz", "sigma_dps"};
constexpr std::span<const std::string_view> narrowband_common = std::span(narrowband_fitted).first(2);

constexpr EffectSignature narrowband_signature = {
    .method = EvidenceMethod::narrow_band,
    .folds = true,
    .spectral = narrowband_fitted,
    .common = narrowband_common,
    .spectrum = narrowband_spectrum,
    .words =
        "Noise of {sigma_dps} stands about {f_hz}, {width_hz} wide (a resonance, or a line that wanders); "
        "one above half the sampling rate that folds to there would look the same.",
    .noun = "narrowband noise at {f_hz}",
    .decided_by =
        "a recording at another sampling rate, which shows whether the noise is folded and from where",
};

}  // namespace

constinit const EffectDefinition narrowband_effect = {
    .name = "narrowband",
    .model =
        "stationary Gaussian, covariance sigma_dps^2 exp(-pi width_hz |t|) cos(2 pi f_hz t), independent on "
        "each axis",
    .source = "the real part of a complex Gauss-Markov process, whose real one is IEEE 952-1997, C.1.5",
    .params = narrowband_params,
    .make = make_narrowband,
    .noise_only = true,
    .signature = &narrowband_signature,
};

}  // namespace gyrolog
