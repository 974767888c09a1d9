#include "analysis/diagnose/estimators/noise_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/gain_band.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/estimators/spectral_range.hpp"
#include "analysis/diagnose/estimators/trial_grid.hpp"
#include "analysis/diagnose/likelihood/whittle.hpp"
#include "analysis/numerics/log_sum_exp.hpp"
#include "analysis/numerics/peak_curvature.hpp"
#include "analysis/numerics/simplex_search.hpp"

namespace gyrolog::resolution {

constexpr int amplitudes_tried = 9;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

class NoiseSpectrumEstimator final : public Estimator {
public:
    NoiseSpectrumEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), signature_(*effect.signature), prediction_(std::move(prediction)) {
        for (TrialPoint& point : trial_points(signature_)) { add_starts(point); }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        if (starts_.empty()) { return std::nullopt; }
        std::vector<AxesFit> single;
        std::vector<std::size_t> all;
        for (const std::size_t axis : prediction_->axes()) {
            all.push_back(axis);
            if (signature_.whole_sensor && prediction_->axes().size() > 1) { continue; }
            if (std::optional<AxesFit> fit = fit_axes(observation, {axis})) {
                single.push_back(std::move(*fit));
            }
        }
        std::optional<AxesFit> shared;
        if (all.size() > 1) { shared = fit_axes(observation, all); }
        std::optional<Finding> finding = best_of(effect_, single, 0.0, shared);
        if (finding) { locate(observation, *finding); }
        return finding;
    }

private:
    void add_starts(const TrialPoint& point) {
        std::vector<ParamValues> starts = {point.params};
        for (const std::string_view name : signature_.spectral) {
            if (point.params.contains(std::string(name))) { continue; }
            const EffectParam& param = param_of(effect_, name);
            std::vector<ParamValues> more;
            for (const ParamValues& start : starts) {
                for (int i = 0; i < resolution::amplitudes_tried; ++i) {
                    more.push_back(start);
                    const double share = static_cast<double>(i) / (resolution::amplitudes_tried - 1);
                    more.back()[std::string(name)] =
                        param.plausible_from * std::pow(param.plausible_to / param.plausible_from, share);
                }
            }
            starts = std::move(more);
        }
        for (ParamValues& start : starts) {
            const bool is_in_range = std::ranges::all_of(signature_.spectral, [&](std::string_view name) {
                return start.at(std::string(name)) <= range_of(name).most;
            });
            if (is_in_range) { starts_.push_back(std::move(start)); }
        }
    }

    SpectralRange range_of(std::string_view name) const {
        return spectral_range(signature_, param_of(effect_, name), prediction_->rate_hz());
    }

    EffectModel entry_of(const ParamValues& params) const {
        return {std::string(effect_.name), {}, params, ""};
    }

    std::vector<SpectralParts> changed_parts(std::size_t axis, const ParamValues& params) const {
        std::vector<SpectralParts> parts = prediction_->parts(axis);
        const EffectModel entry = entry_of(params);
        signature_.spectrum(prediction_->bin_frequencies_hz(), prediction_->rate_hz(),
                            EffectValues(entry, axis), parts);
        return parts;
    }

    // Without refitting the nuisance: less than the gain, for choosing where to start.
    double rough_gain(const Observation& observation, std::size_t axis, const ParamValues& start) const {
        const AxisObservation& seen = observation.axis(axis);
        const std::vector<SpectralParts> parts = changed_parts(axis, start);
        const std::array<double, 3> sd_rel = noise_uncertainty(prediction_->model(), axis);
        std::vector<double> density(parts.size());
        expected_density(parts, sd_rel, seen.noise.z, density);
        double prior = 0.0;
        for (const double z : seen.noise.z) { prior += 0.5 * z * z; }
        const double kept = whittle_log_likelihood_nats(prediction_->bins(), seen.power, density) - prior;
        expected_density(parts, sd_rel, {}, density);
        const double plain = whittle_log_likelihood_nats(prediction_->bins(), seen.power, density);
        return std::max(kept, plain) - seen.noise.log_likelihood_nats;
    }

    double gain(const Observation& observation, std::size_t axis, const ParamValues& start) const {
        const AxisObservation& seen = observation.axis(axis);
        const NoiseNuisance noise = fit_nuisance(prediction_->bins(), changed_parts(axis, start), seen.power,
                                                 noise_uncertainty(prediction_->model(), axis));
        return noise.log_likelihood_nats - seen.noise.log_likelihood_nats;
    }

    double gain(const Observation& observation, const std::vector<std::size_t>& axes,
                const ParamValues& start) const {
        double sum = 0.0;
        for (const std::size_t axis : axes) { sum += gain(observation, axis, start); }
        return sum;
    }

    std::optional<AxesFit> fit_axes(const Observation& observation,
                                    const std::vector<std::size_t>& axes) const {
        const ParamValues* from = &starts_.front();
        double best = minus_infinity;
        for (const ParamValues& start : starts_) {
            double rough = 0.0;
            for (const std::size_t axis : axes) { rough += rough_gain(observation, axis, start); }
            if (rough > best) {
                best = rough;
                from = &start;
            }
        }
        // A level that the nuisance holds back is too narrow a peak for the trial values.
        const bool only_start = signature_.trials.empty() && signature_.spectral.size() == 1;
        if (best < resolution::worth_refining_nats && !only_start) { return std::nullopt; }
        return refined(observation, axes, *from);
    }

    AxesFit refined(const Observation& observation, const std::vector<std::size_t>& axes,
                    const ParamValues& from) const {
        const auto at = [&](const std::vector<double>& logs) {
            ParamValues start = from;
            for (std::size_t i = 0; i < logs.size(); ++i) {
                start[std::string(signature_.spectral[i])] = std::exp(logs[i]);
            }
            return start;
        };
        const auto objective = [&](const std::vector<double>& logs) {
            for (std::size_t i = 0; i < logs.size(); ++i) {
                const SpectralRange range = range_of(signature_.spectral[i]);
                const double value = std::exp(logs[i]);
                if (value < range.least || value > range.most) { return minus_infinity; }
            }
            return gain(observation, axes, at(logs));
        };
        std::vector<double> logs;
        for (const std::string_view name : signature_.spectral) {
            logs.push_back(std::log(from.at(std::string(name))));
        }
        AxesFit fit;
        fit.axes = axes;
        SimplexMaximum maximum{logs, objective(logs)};
        if (!logs.empty()) {
            maximum = simplex_maximum(objective, logs, 0.2, 0.01);
            maximum = simplex_maximum(objective, maximum.at, 0.03, 0.002);
        }
        const ParamValues best = at(maximum.at);
        fit.params = best;
        for (const std::size_t axis : axes) { fit.gain_nats.push_back(gain(observation, axis, best)); }
        add_uncertainty(objective, maximum, fit);
        return fit;
    }

    // From the curvature of the gain about its maximum.
    void add_uncertainty(const std::function<double(const std::vector<double>&)>& objective,
                         const SimplexMaximum& maximum, AxesFit& fit) const {
        const PeakCurvature curvature = peak_curvature(objective, maximum.at, maximum.value,
                                                       resolution::step_log, resolution::sd_log_most);
        std::vector<const EffectParam*> params;
        std::vector<double> values;
        for (std::size_t i = 0; i < maximum.at.size(); ++i) {
            params.push_back(&param_of(effect_, signature_.spectral[i]));
            values.push_back(std::exp(maximum.at[i]));
            fit.sd[std::string(signature_.spectral[i])] = values[i] * curvature.sd[i];
        }
        fit.cost_nats +=
            joint_occam_cost_nats(params, values, information_of_values(curvature.information, values));
    }

    // The band in which nine tenths of the gain arise.
    void locate(const Observation& observation, Finding& finding) const {
        const SpectralBins& bins = prediction_->bins();
        std::vector<double> arises(bins.size(), 0.0);
        for (const EffectModel& entry : finding.entries) {
            for (const std::size_t axis : finding.where.axes) {
                if (std::ranges::count(entry.axes, axis_names[axis]) == 0) { continue; }
                const AxisObservation& seen = observation.axis(axis);
                const std::vector<SpectralParts> parts = changed_parts(axis, entry.params);
                for (std::size_t i = 0; i < bins.size(); ++i) {
                    arises[i] += bin_gain_nats(bins[i], seen.power[i], prediction_->parts(axis)[i].sum(),
                                               parts[i].sum());
                }
            }
        }
        put_gain_band(bins, std::move(arises), finding.where);
    }

    const EffectDefinition& effect_;
    const EffectSignature& signature_;
    std::shared_ptr<const Prediction> prediction_;
    std::vector<ParamValues> starts_;
};

}  // namespace

MadeEstimator make_noise_spectrum_estimator(const EffectDefinition& effect,
                                            std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<NoiseSpectrumEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
