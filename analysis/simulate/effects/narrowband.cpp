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
//
// With wander_s above 0 it is a line of constant height instead,
//
//   sqrt(2) sigma cos(phase),   d phase / dt = 2 pi (f + s n(t)),
//
// n a first-order Gauss-Markov process of variance one and correlation time wander_s. Where 2 pi s wander_s
// is far above one, the line's density is the distribution of its frequency (R. Kubo, in Fluctuation,
// Relaxation and Resonance in Magnetic Systems, 1962, "slow modulation"): Gaussian, with the standard
// deviation s = width / (2 sqrt(2 ln 2)). It has no Lorentzian's skirts.
#include <algorithm>
#include <cmath>
#include <numbers>

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

// Of a Gaussian: its standard deviation in widths at half its height.
const double sd_per_width = 1.0 / std::sqrt(8.0 * std::numbers::ln2);

struct WanderingLine {
    RandomStream frequency;
    double phase_turns;
    double amplitude_rad_s;
    double middle_turns;  // of a sample
    double spread_turns;
    double kept;
    double innovation;
    double offset = 0.0;  // in units of the spread

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) {
        std::array<double, block_samples> draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        const std::size_t count = rate_rad_s.size();
        frequency.normals(first_index, std::span(draws).first(count));
        for (std::size_t i = 0; i < count; ++i) {
            offset = first_index + i == 0 ? draws[i] : kept * offset + innovation * draws[i];
            phase_turns += middle_turns + spread_turns * offset;
            phase_turns -= std::floor(phase_turns);
            rate_rad_s[i] += amplitude_rad_s * portable_sine_of_turns(phase_turns);
        }
    }
};

std::unique_ptr<Stage> make_wandering_line(const EffectUse& use) {
    const double rate_hz = use.context().rate_hz;
    return PerAxis<WanderingLine>::make([&](std::size_t axis) -> std::optional<WanderingLine> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        const double kept = portable_exp(-std::min(1.0 / (use["wander_s"] * rate_hz), 700.0));
        return WanderingLine{use.stream(axis, 0),
                             use.stream(axis, 1).uniform(0),
                             std::numbers::sqrt2 * use["sigma_dps"] * rad_per_deg,
                             use["f_hz"] / rate_hz,
                             sd_per_width * use["width_hz"] / rate_hz,
                             kept,
                             std::sqrt(1.0 - kept * kept)};
    });
}

std::unique_ptr<Stage> make_narrowband(const EffectUse& use) {
    if (use["wander_s"] > 0.0) { return make_wandering_line(use); }
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
    {.name = "wander_s",
     .meaning = "0: noise; else a line of constant height whose frequency wanders with this correlation "
                "time",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 10.0,
     .plausible_to = 90.0,
     .otherwise = 0.0},
};

// Of P from 0 to the angle, over 2 pi: a half at half a turn.
double share_up_to(double angle, double narrowness) {
    const double turns = std::round(angle / (2.0 * pi));
    return turns + std::atan(narrowness * std::tan(0.5 * (angle - 2.0 * pi * turns))) / pi;
}

// Of a normal distribution of frequencies and its images at the nearest multiples of the rate, from the
// middle to this far off it.
double gaussian_share_up_to(double off_hz, double spread_hz, double rate_hz) {
    double share = 0.0;
    for (int image = -3; image <= 3; ++image) {
        share += 0.5 * std::erf((off_hz + image * rate_hz) / (std::numbers::sqrt2 * spread_hz));
    }
    return share;
}

// A line that is narrower than the distance of the frequencies is averaged over it.
void narrowband_spectrum(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                         std::span<SpectralParts> parts) {
    const double sigma_rad_s = effect["sigma_dps"] * rad_per_deg;
    const double narrowness = 1.0 / std::tanh(0.5 * pi * effect["width_hz"] / rate_hz);
    const double folded_hz = std::fabs(std::remainder(effect["f_hz"], rate_hz));
    const double per_hz = 2.0 * pi / rate_hz;
    const bool wanders = effect["wander_s"] > 0.0;
    const double spread_hz = sd_per_width * effect["width_hz"];
    const auto share = [&](double off_hz) {
        return wanders ? gaussian_share_up_to(off_hz, spread_hz, rate_hz)
                       : share_up_to(per_hz * off_hz, narrowness);
    };
    const auto power_below = [&](double edge_hz) {
        return 0.5 * sigma_rad_s * sigma_rad_s * (share(edge_hz - folded_hz) + share(edge_hz + folded_hz));
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

// The density of a line does not tell how fast it wanders: the geometric middle of what is plausible.
constexpr double narrowband_wander_s[] = {0.0, 30.0};
static_assert(narrowband_wander_s[1] * narrowband_wander_s[1] ==
              narrowband_params[3].plausible_from * narrowband_params[3].plausible_to);

constexpr EffectSignature narrowband_signature = {
    .method = EvidenceMethod::narrow_band,
    .folds = true,
    .spectral = narrowband_fitted,
    .common = narrowband_common,
    .form = "wander_s",
    .form_values = narrowband_wander_s,
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
        "each axis; with wander_s a line of constant height with a Gaussian density",
    .source =
        "the real part of a complex Gauss-Markov process, whose real one is IEEE 952-1997, C.1.5; the "
        "line of R. Kubo (1962), slowly modulated",
    .params = narrowband_params,
    .make = make_narrowband,
    .noise_only = true,
    .signature = &narrowband_signature,
};

}  // namespace gyrolog
