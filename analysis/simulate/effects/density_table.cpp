#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/simulate/autoregression.hpp"
#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

namespace {

// So many samples back the filter reaches: what it tells apart is the sampling rate over this.
constexpr std::size_t filter_order = 64;
// Steps over which the factor's autocovariances are integrated, from zero to half the rate.
constexpr std::size_t integration_steps = 1024;

// Autocovariances of a density with this factor, over the variance of white noise without it.
std::vector<double> covariances(const Course& factor, double rate_hz) {
    std::vector<double> sums(filter_order + 1, 0.0);
    for (std::size_t i = 0; i <= integration_steps; ++i) {
        const double turns = 0.5 * static_cast<double>(i) / integration_steps;
        const bool is_end = i == 0 || i == integration_steps;
        const double density = (is_end ? 0.5 : 1.0) * factor(turns * rate_hz) / integration_steps;
        // cos(m x) by the recurrence of Chebyshev's polynomials.
        const double cosine = portable_sine_of_turns(turns + 0.25);
        double before = cosine;
        double now = 1.0;
        for (double& sum : sums) {
            sum += density * now;
            before = std::exchange(now, 2.0 * cosine * now - before);
        }
    }
    return sums;
}

std::shared_ptr<const Autoregression> process_of(const Course& factor, double rate_hz) {
    return std::make_shared<const Autoregression>(covariances(factor, rate_hz));
}

class ShapedWhiteNoise final : public Stage {
public:
    explicit ShapedWhiteNoise(const EffectUse& use) {
        const auto process = process_of(use.course(), use.context().rate_hz);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (use.acts_on(axis)) { filters_[axis].emplace(process); }
        }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!filters_[axis]) { continue; }
            block.white_sd_rad_s[axis] *= std::sqrt(filters_[axis]->variance());
            filters_[axis]->apply(block.slots(block.white_rad_s[axis]));
        }
    }

private:
    std::array<std::optional<AutoregressiveFilter>, 3> filters_;
};

std::unique_ptr<Stage> make_density_table(const EffectUse& use) {
    return std::make_unique<ShapedWhiteNoise>(use);
}

void density_table_spectrum(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                            std::span<SpectralParts> parts) {
    const auto process = process_of(effect.course(), rate_hz);
    for (std::size_t i = 0; i < parts.size(); ++i) { parts[i].white *= process->density(f_hz[i] / rate_hz); }
}

constexpr EffectSignature density_table_signature = {
    .method = EvidenceMethod::density_table,
    .spectrum = density_table_spectrum,
    .words = "The density of the white noise has a shape of its own.",
    .noun = "a shape of the white noise's density",
};

}  // namespace

constinit const EffectDefinition density_table_effect = {
    .name = "density_table",
    .model =
        "white noise whose density is that of the model times factor(f), by an autoregression of order 64",
    .source = "Brockwell, Davis, Time Series: Theory and Methods, 2nd ed., proposition 5.2.1",
    .params = {},
    .make = make_density_table,
    .table = EffectTable{.at = "f_hz",
                         .value = "factor",
                         .meaning = "of the density, by frequency; beyond the table as at its ends",
                         .positive = true},
    .form = "density",
    .signature = &density_table_signature,
};

}  // namespace gyrolog
