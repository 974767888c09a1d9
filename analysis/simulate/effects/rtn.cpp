#include <algorithm>
#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"
#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

namespace {

// Sampled, the telegraph is a Markov chain of two states whose dwell times are geometric. The number of
// samples to the next change is therefore one draw, exact at any rate, and slow telegraphs cost nothing.
class Telegraph {
public:
    Telegraph(const RandomStream& stream, double half_rad_s, double high_samples, double low_samples)
        : stream_(stream), half_rad_s_(half_rad_s) {
        const double high_share = high_samples / (high_samples + low_samples);
        // The chain forgets its state at the sum of both rates of change.
        const double forgotten = 1.0 - portable_exp(-std::min(1.0 / high_samples + 1.0 / low_samples, 700.0));
        log_stay_high_ = log_stay((1.0 - high_share) * forgotten);
        log_stay_low_ = log_stay(high_share * forgotten);
        high_ = stream_.uniform(0) < high_share;
        draw_next_change();
    }

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) {
        for (std::size_t i = 0; i < rate_rad_s.size(); ++i) {
            if (static_cast<double>(first_index + i) >= next_change_) {
                high_ = !high_;
                draw_next_change();
            }
            rate_rad_s[i] += high_ ? half_rad_s_ : -half_rad_s_;
        }
    }

private:
    static double log_stay(double change_probability) {
        return portable_log(std::max(1.0 - change_probability, 1e-300));
    }

    void draw_next_change() {
        ++draws_;
        const double logarithm = portable_log(stream_.uniform(draws_));
        next_change_ += 1.0 + std::floor(logarithm / (high_ ? log_stay_high_ : log_stay_low_));
    }

    RandomStream stream_;
    double half_rad_s_;
    double log_stay_high_ = 0.0;  // ln P(still high one sample later)
    double log_stay_low_ = 0.0;
    bool high_ = false;
    std::uint64_t draws_ = 0;
    double next_change_ = 0.0;  // first sample in the other state
};

std::unique_ptr<Stage> make_rtn(const EffectUse& use) {
    const double rate_hz = use.context().rate_hz;
    return PerAxis<Telegraph>::make([&](std::size_t axis) -> std::optional<Telegraph> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return Telegraph(use.stream(axis), 0.5 * use["amplitude_dps"] * rad_per_deg,
                         use["dwell_high_s"] * rate_hz, use["dwell_low_s"] * rate_hz);
    });
}

constexpr EffectParam rtn_params[] = {
    {.name = "amplitude_dps",
     .meaning = "distance of the two levels",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.001,
     .plausible_to = 0.1},
    {.name = "dwell_high_s",
     .meaning = "mean time on the higher level",
     .range = EffectParam::Range::positive,
     .plausible_from = 1.0,
     .plausible_to = 200.0},
    {.name = "dwell_low_s",
     .meaning = "mean time on the lower level",
     .range = EffectParam::Range::positive,
     .plausible_from = 1.0,
     .plausible_to = 200.0},
};

// The spectrum of a chain of two states is that of first-order Gauss-Markov noise of the same variance and
// correlation time, sampled.
void rtn_spectrum(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                  std::span<SpectralParts> parts) {
    const double high_s = effect["dwell_high_s"];
    const double low_s = effect["dwell_low_s"];
    const double distance_rad_s = effect["amplitude_dps"] * rad_per_deg;
    const double share = high_s / (high_s + low_s);
    const double variance = distance_rad_s * distance_rad_s * share * (1.0 - share);
    const double changes = (1.0 / high_s + 1.0 / low_s) / rate_hz;
    const double kept = std::exp(-changes);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double sine = std::sin(pi * f_hz[i] / rate_hz);
        // 1 - 2 kept cos(2 pi f / rate) + kept^2, without the difference of near equals.
        const double lost = -std::expm1(-changes);
        const double denominator = lost * lost + 4.0 * kept * sine * sine;
        parts[i].added_signal += variance * -std::expm1(-2.0 * changes) / (rate_hz * denominator);
    }
}

constexpr EffectSignature rtn_signature = {
    .method = EvidenceMethod::random_telegraph,
    .place = PlaceKind::spectrum,
    .spectrum = rtn_spectrum,
    .words =
        "The output jumps to and fro between two levels {amplitude_dps} apart (popcorn noise) and stays "
        "{dwell_high_s} on the upper one and {dwell_low_s} on the lower one, on average.",
    .noun = "telegraph noise of {amplitude_dps}",
    .decided_by =
        "a recording at rest of {length}: two levels then show as two peaks in the "
        "distribution of short averages, Gauss-Markov noise as one",
};

}  // namespace

constinit const EffectDefinition rtn_effect = {
    .name = "rtn",
    .model =
        "+amplitude_dps/2 or -amplitude_dps/2, exponential dwell times, stationary, independent on each axis",
    .source = "S. Machlup, J. Appl. Phys. 25 (1954) 341",
    .params = rtn_params,
    .make = make_rtn,
    .noise_only = true,
    .signature = &rtn_signature,
};

}  // namespace gyrolog
