#include "analysis/diagnose/estimators/narrow_band.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/axis_subsets.hpp"
#include "analysis/diagnose/estimators/gain_band.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/likelihood/noise_nuisance.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/numerics/log_sum_exp.hpp"
#include "analysis/numerics/peak_curvature.hpp"
#include "analysis/numerics/simplex_search.hpp"

namespace gyrolog::resolution {

// In cosine coefficients, at half the height. A steady line has six tenths of itself in two, and of the rest
// hardly anything beyond six.
constexpr std::size_t narrowest = 8;
constexpr double bins_per_width = 8.0;
// To either side of the middle, in widths: beyond, a Lorentzian has a fiftieth of itself.
constexpr double finely_within_widths = 16.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

struct Band {
    double f_hz = 0.0;
    double width_hz = 0.0;
    double sigma_rad_s = 0.0;
    double wander_s = 0.0;  // 0: noise with a Lorentzian density; else a line with a Gaussian one

    std::map<std::string, double> shape() const {
        std::map<std::string, double> params{{"f_hz", f_hz}, {"width_hz", width_hz}};
        if (wander_s > 0.0) { params["wander_s"] = wander_s; }
        return params;
    }
};

double coefficients_per_hz(const Prediction& prediction) {
    return 2.0 * static_cast<double>(prediction.length()) / prediction.rate_hz();
}

double narrowest_band_hz(const Prediction& prediction) {
    return static_cast<double>(resolution::narrowest) / coefficients_per_hz(prediction);
}

// One axis' bins, small about a band, and what the model expects in them.
class LocalSpectrum {
public:
    LocalSpectrum(const Observation& observation, std::size_t axis, const Band& about)
        : axis_(axis), rate_hz_(observation.prediction().rate_hz()) {
        const Prediction& prediction = observation.prediction();
        const AxisObservation& seen = observation.axis(axis);
        const double per_hz = 2.0 * static_cast<double>(prediction.length()) / rate_hz_;
        const double reach = resolution::finely_within_widths * about.width_hz * per_hz;
        const double middle = about.f_hz * per_hz;
        const auto small = static_cast<std::size_t>(
            std::max(1.0, std::floor(about.width_hz * per_hz / resolution::bins_per_width)));
        for (std::size_t i = 0; i < prediction.bins().size(); ++i) {
            const SpectralBin& bin = prediction.bins()[i];
            const bool is_near = static_cast<double>(bin.end) > middle - reach &&
                                 static_cast<double>(bin.first) < middle + reach;
            if (!is_near || bin.end - bin.first <= small) {
                add(bin, seen.power[i], prediction.parts(axis)[i]);
                continue;
            }
            for (std::size_t first = bin.first; first < bin.end; first += small) {
                cut(bin, first, std::min(bin.end, first + small), seen.cosines, prediction.parts(axis)[i]);
            }
        }
        sd_rel_ = noise_uncertainty(prediction.model(), axis);
        start_ = seen.noise;
        without_nats_ = fit_nuisance(bins_, parts_, power_, sd_rel_, start_).log_likelihood_nats;
    }

    std::size_t axis() const { return axis_; }

    double gain_nats(const EffectDefinition& effect, const Band& band) const {
        std::vector<SpectralParts> parts = parts_;
        EffectModel entry{std::string(effect.name), {}, band.shape(), ""};
        entry.params["sigma_dps"] = band.sigma_rad_s * deg_per_rad;
        effect.signature->spectrum(f_hz_, rate_hz_, EffectValues(entry, axis_), parts);
        return fit_nuisance(bins_, parts, power_, sd_rel_, start_).log_likelihood_nats - without_nats_;
    }

private:
    void add(const SpectralBin& bin, double power, const SpectralParts& parts) {
        bins_.push_back(bin);
        f_hz_.push_back(bin.f_hz);
        power_.push_back(power);
        parts_.push_back(parts);
    }

    void cut(const SpectralBin& of, std::size_t first, std::size_t end, const std::vector<float>& cosines,
             const SpectralParts& parts) {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t k = first; k < end; ++k) {
            if (!of.has(k)) { continue; }
            sum += static_cast<double>(cosines[k]) * static_cast<double>(cosines[k]);
            count += 1.0;
        }
        if (count == 0.0) { return; }
        const double step_hz = rate_hz_ / (2.0 * static_cast<double>(cosines.size()));
        const double f_hz = step_hz * std::sqrt(static_cast<double>(first) * static_cast<double>(end - 1));
        add({first, end, f_hz, of.half, count}, sum / (count * rate_hz_), parts);
    }

    std::size_t axis_;
    double rate_hz_;
    SpectralBins bins_;
    std::vector<double> f_hz_;
    std::vector<double> power_;
    std::vector<SpectralParts> parts_;
    std::array<double, 3> sd_rel_{};
    NoiseNuisance start_;
    double without_nats_ = 0.0;
};

// One band on some axes: middle and width in common.
struct BandFit {
    std::vector<std::size_t> axes;
    std::vector<Band> bands;        // by axis
    std::vector<double> gain_nats;  // by axis
    double f_sd_hz = 0.0;
    double log_width_sd = 0.0;
    std::vector<double> log_sigma_sd;  // by axis
    double total_nats() const {
        double sum = 0.0;
        for (const double nats : gain_nats) { sum += nats; }
        return sum;
    }
};

using Objective = std::function<double(const std::vector<double>&)>;

std::vector<double> deviations(const Objective& objective, const SimplexMaximum& maximum) {
    return peak_curvature(objective, maximum.at, maximum.value, resolution::step_log, resolution::sd_log_most)
        .sd;
}

class NarrowBandEstimator final : public Estimator {
public:
    NarrowBandEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), prediction_(std::move(prediction)) {}

    std::optional<Finding> find(const Observation& observation) const override {
        std::optional<BandFit> best;
        for (const std::size_t axis : prediction_->axes()) {
            const std::optional<Band> start = scan(observation.axis(axis));
            if (!start) { continue; }
            for (const double wander_s : effect_.signature->form_values) {
                Band from = *start;
                from.wander_s = wander_s;
                BandFit fit = fitted(observation, {axis}, {from});
                // Once more, with bins that suit the width.
                fit = fitted(observation, {axis}, fit.bands);
                if (!best || fit.total_nats() > best->total_nats()) { best = std::move(fit); }
            }
        }
        if (!best || best->total_nats() < resolution::worth_refining_nats) { return std::nullopt; }
        return finding_of(with_other_axes(observation, *std::move(best)));
    }

private:
    std::size_t length() const { return prediction_->length(); }
    double per_hz() const { return coefficients_per_hz(*prediction_); }
    double narrowest_hz() const { return narrowest_band_hz(*prediction_); }

    // Sums of the coefficients' squares in units of what is expected, and how many they are, up to each.
    struct Sums {
        std::vector<double> square;
        std::vector<double> count;

        double mean(std::size_t from, std::size_t to) const {
            const double of = count[to] - count[from];
            return of > 0.0 ? (square[to] - square[from]) / of : 0.0;
        }
    };

    Sums sums_of(const AxisObservation& seen) const {
        Sums sums{std::vector<double>(length() + 1), std::vector<double>(length() + 1)};
        std::size_t bin = 0;
        for (std::size_t k = 1; k < length(); ++k) {
            while (bin + 1 < prediction_->bins().size() && prediction_->bins()[bin].end <= k) { ++bin; }
            const bool has = has_coefficient(prediction_->half(), k);
            const auto value = static_cast<double>(seen.cosines[k]);
            const double weight = 1.0 / (seen.density[bin] * prediction_->rate_hz());
            sums.square[k + 1] = sums.square[k] + (has ? weight * value * value : 0.0);
            sums.count[k + 1] = sums.count[k] + (has ? 1.0 : 0.0);
        }
        return sums;
    }

    // The window that stands out most against both neighbours, of all widths, if any does by more than the
    // number of windows makes likely.
    std::optional<Band> scan(const AxisObservation& seen) const {
        const Sums sums = sums_of(seen);
        const auto slowest = static_cast<std::size_t>(std::ceil(decisions.slowest_line_hz * per_hz()));
        std::optional<Band> found;
        double most_nats = decisions.seen_nats();
        for (std::size_t width = resolution::narrowest; 8 * width < length(); width *= 2) {
            const std::size_t windows = 2 * length() / width;
            const double windows_nats = std::log(static_cast<double>(windows));
            const std::size_t begin = std::max({slowest, 2 * width, std::size_t{1}});
            for (std::size_t first = begin; first + width < length(); first += width / 2) {
                const std::size_t end = first + width;
                const double ratio = sums.mean(first, end);
                if (!(ratio > 1.0)) { continue; }
                const double below = sums.mean(first - std::min(first - 1, 2 * width), first - width / 2);
                const double above =
                    sums.mean(std::min(length() - 1, end + width / 2), std::min(length(), end + 2 * width));
                const double level = std::max({1.0, below, above});
                if (!(ratio > level)) { continue; }
                const double count = sums.count[end] - sums.count[first];
                const double nats =
                    0.5 * count * (ratio / level - 1.0 - std::log(ratio / level)) - windows_nats;
                if (!(nats > most_nats)) { continue; }
                most_nats = nats;
                found = band_at(seen, first, end, ratio - level);
            }
        }
        return found;
    }

    Band band_at(const AxisObservation& seen, std::size_t first, std::size_t end, double excess) const {
        const double middle = 0.5 * static_cast<double>(first + end - 1);
        const auto after = std::ranges::upper_bound(prediction_->bins(), first, {}, &SpectralBin::first);
        const auto bin = static_cast<std::size_t>(after - prediction_->bins().begin()) - 1;
        const double width = static_cast<double>(end - first);
        // Half of it lies within its width.
        const double variance =
            2.0 * excess * seen.density[bin] * prediction_->rate_hz() * width / static_cast<double>(length());
        return {middle / per_hz(), std::min(width, middle) / per_hz(), std::sqrt(variance), 0.0};
    }

    bool is_allowed(const Band& band) const {
        return is_band(band.f_hz, band.width_hz, *prediction_) &&
               band.sigma_rad_s * deg_per_rad <
                   param_of(effect_, "sigma_dps").plausible_to * decisions.beyond_plausible;
    }

    // Variables: the middle, in first widths from the first middle, and the logarithms of the width and of
    // each axis' height.
    BandFit fitted(const Observation& observation, const std::vector<std::size_t>& axes,
                   const std::vector<Band>& start) const {
        std::vector<LocalSpectrum> spectra;
        Band from = start.front();
        from.width_hz = std::max(from.width_hz, 1.01 * narrowest_hz());
        from.width_hz = std::min(from.width_hz, 0.99 * from.f_hz / decisions.band_quality_least);
        std::vector<double> variables = {0.0, std::log(from.width_hz)};
        for (std::size_t i = 0; i < axes.size(); ++i) {
            spectra.emplace_back(observation, axes[i], from);
            variables.push_back(std::log(start[i].sigma_rad_s));
        }
        const auto band = [&](const std::vector<double>& at, std::size_t i) {
            return Band{from.f_hz + at[0] * from.width_hz, std::exp(at[1]), std::exp(at[2 + i]),
                        from.wander_s};
        };
        const Objective objective = [&](const std::vector<double>& at) {
            double sum = 0.0;
            for (std::size_t i = 0; i < spectra.size(); ++i) {
                const Band here = band(at, i);
                if (!is_allowed(here)) { return minus_infinity; }
                sum += spectra[i].gain_nats(effect_, here);
            }
            return sum;
        };
        SimplexMaximum maximum = simplex_maximum(objective, variables, 0.3, 0.01);
        maximum = simplex_maximum(objective, maximum.at, 0.05, 0.002);
        const std::vector<double> sd = deviations(objective, maximum);
        BandFit fit;
        fit.axes = axes;
        fit.f_sd_hz = sd[0] * from.width_hz;
        fit.log_width_sd = sd[1];
        for (std::size_t i = 0; i < spectra.size(); ++i) {
            fit.bands.push_back(band(maximum.at, i));
            fit.gain_nats.push_back(spectra[i].gain_nats(effect_, fit.bands.back()));
            fit.log_sigma_sd.push_back(sd[2 + i]);
        }
        return fit;
    }

    // Those on which the same band, at its best height, pays for the height.
    BandFit with_other_axes(const Observation& observation, BandFit fit) const {
        const std::size_t first = fit.axes.front();
        std::vector<std::size_t> axes = fit.axes;
        std::vector<Band> bands = fit.bands;
        for (const std::size_t axis : prediction_->axes()) {
            if (axis == first) { continue; }
            Band band = fit.bands.front();
            const LocalSpectrum spectrum(observation, axis, band);
            const Objective objective = [&](const std::vector<double>& at) {
                band.sigma_rad_s = std::exp(at[0]);
                return is_allowed(band) ? spectrum.gain_nats(effect_, band) : minus_infinity;
            };
            const SimplexMaximum maximum =
                simplex_maximum(objective, {std::log(0.5 * band.sigma_rad_s)}, 0.5, 0.01);
            band.sigma_rad_s = std::exp(maximum.at[0]);
            if (maximum.value - height_cost_nats(band.sigma_rad_s, deviations(objective, maximum)[0]) > 0.0) {
                axes.push_back(axis);
                bands.push_back(band);
            }
        }
        return axes.size() > 1 ? fitted(observation, axes, bands) : std::move(fit);
    }

    double height_cost_nats(double sigma_rad_s, double log_sd) const {
        const double sigma_dps = sigma_rad_s * deg_per_rad;
        return occam_cost_nats(param_of(effect_, "sigma_dps"), sigma_dps, sigma_dps * log_sd) +
               axis_membership_nats(prediction_->axes().size());
    }

    std::optional<Finding> finding_of(const BandFit& fit) const {
        const double f_hz = fit.bands.front().f_hz;
        const double width_hz = fit.bands.front().width_hz;
        std::vector<AxesFit> fits;
        for (std::size_t i = 0; i < fit.axes.size(); ++i) {
            const double sigma_dps = fit.bands[i].sigma_rad_s * deg_per_rad;
            AxesFit one;
            one.axes = {fit.axes[i]};
            one.gain_nats = {fit.gain_nats[i]};
            one.params = {{"sigma_dps", sigma_dps}};
            one.sd = {{"sigma_dps", sigma_dps * fit.log_sigma_sd[i]}};
            one.cost_nats = height_cost_nats(fit.bands[i].sigma_rad_s, fit.log_sigma_sd[i]);
            fits.push_back(std::move(one));
        }
        const double common_nats =
            std::log(static_cast<double>(effect_.signature->form_values.size())) +
            parameter_cost_nats(0.5 * prediction_->rate_hz(), fit.f_sd_hz) +
            occam_cost_nats(param_of(effect_, "width_hz"), width_hz, width_hz * fit.log_width_sd);
        std::optional<Finding> finding = best_of(effect_, fits, common_nats, std::nullopt);
        if (!finding) { return std::nullopt; }
        finding->parameters += 2;
        for (std::size_t i = 0; i < finding->entries.size(); ++i) {
            finding->entries[i].params.merge(fit.bands.front().shape());
            finding->sd[i]["f_hz"] = fit.f_sd_hz;
            finding->sd[i]["width_hz"] = width_hz * fit.log_width_sd;
        }
        // Of a Lorentzian nine tenths lie within three widths, of its likelihood within two.
        const Span band{std::max(f_hz - 2.0 * width_hz, 1.0 / per_hz()),
                        std::min(f_hz + 2.0 * width_hz, 0.5 * prediction_->rate_hz())};
        finding->where.freq_hz = band;
        finding->where.tau_s = averaging_times_of(band);
        return finding;
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
};

}  // namespace

bool is_band(double f_hz, double width_hz, const Prediction& prediction) {
    return f_hz > decisions.slowest_line_hz && f_hz < 0.5 * prediction.rate_hz() &&
           width_hz > narrowest_band_hz(prediction) && width_hz * decisions.band_quality_least < f_hz;
}

double bins_within(double f_hz, double width_hz, const Prediction& prediction) {
    const double per_hz = coefficients_per_hz(prediction);
    const auto at = static_cast<std::size_t>(std::max(1.0, f_hz * per_hz));
    const auto after = std::ranges::upper_bound(prediction.bins(), at, {}, &SpectralBin::first);
    if (after == prediction.bins().begin()) { return 0.0; }
    const SpectralBin& bin = *std::prev(after);
    return width_hz * per_hz / static_cast<double>(bin.end - bin.first);
}

MadeEstimator make_narrow_band_estimator(const EffectDefinition& effect,
                                         std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<NarrowBandEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
