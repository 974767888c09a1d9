#include "analysis/diagnose/estimators/random_telegraph.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/gain_band.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/estimators/telegraph_filter.hpp"
#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/log_sum_exp.hpp"
#include "analysis/numerics/peak_curvature.hpp"
#include "analysis/numerics/simplex_search.hpp"

namespace gyrolog::resolution {

// Correlation times tried: from half the shortest plausible dwell time on, by factors of 1.6.
constexpr double correlation_ratio = 1.6;
constexpr double correlation_from_s = 0.3;
constexpr double correlation_to_s = 200.0;
// Averages are as short as still shows the levels two standard deviations apart, a sixth to a twentieth of
// the dwell time: then two changes within one are rare. Not more of them than take some milliseconds to
// filter.
constexpr double averages_per_dwell_min = 6.0;
constexpr double averages_per_dwell_max = 20.0;
constexpr double levels_apart = 2.0;
constexpr double averages_max = 40000.0;
constexpr double averages_min = 64.0;
// Two levels so much less likely than Gauss-Markov noise with the same spectrum are not refined.
constexpr double hopeless_nats = 30.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Logarithms of the distance in rad/s and of the dwell times in s.
using Point = std::vector<double>;

Telegraph telegraph_at(const Point& logs) {
    return {std::exp(logs[0]), std::exp(logs[1]), std::exp(logs[2])};
}

std::vector<double> averages_of(const std::vector<float>& samples, std::size_t length) {
    std::vector<double> out(samples.size() / length);
    for (std::size_t i = 0; i < out.size(); ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < length; ++j) { sum += static_cast<double>(samples[i * length + j]); }
        out[i] = sum / static_cast<double>(length);
    }
    return out;
}

struct Averages {
    double step_s = 0.0;
    std::vector<double> values;
};

class RandomTelegraphEstimator final : public Estimator {
public:
    RandomTelegraphEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), prediction_(std::move(prediction)) {
        for (const SpectralBin& bin : prediction_->bins()) { f_hz_.push_back(bin.f_hz); }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        std::vector<AxesFit> single;
        std::vector<std::size_t> moved;
        for (const std::size_t axis : prediction_->axes()) {
            const std::optional<Point> start = start_of(observation, axis);
            if (!start) { continue; }
            single.push_back(fit_axes(observation, {axis}, *start));
            moved.push_back(axis);
        }
        if (single.empty()) { return std::nullopt; }
        std::optional<AxesFit> shared;
        if (moved.size() > 1 && alike(single)) { shared = fit_axes(observation, moved, middle_of(single)); }
        std::optional<Finding> finding = best_of(effect_, single, 0.0, shared);
        if (finding) { place(observation, *finding); }
        return finding;
    }

private:
    std::vector<SpectralParts> changed_parts(std::size_t axis, const EffectModel& entry) const {
        std::vector<SpectralParts> parts = prediction_->parts(axis);
        effect_.signature->spectrum(f_hz_, prediction_->rate_hz(), EffectValues(entry), parts);
        return parts;
    }

    EffectModel entry_of(const Telegraph& telegraph) const {
        return {std::string(effect_.name), {}, params_of(telegraph), ""};
    }

    static std::map<std::string, double> params_of(const Telegraph& telegraph) {
        return {{"amplitude_dps", telegraph.distance * deg_per_rad},
                {"dwell_high_s", telegraph.high_s},
                {"dwell_low_s", telegraph.low_s}};
    }

    NoiseNuisance noise_with(const Observation& observation, std::size_t axis,
                             const Telegraph& telegraph) const {
        const AxisObservation& seen = observation.axis(axis);
        return fit_nuisance(prediction_->bins(), changed_parts(axis, entry_of(telegraph)), seen.power,
                            noise_uncertainty(prediction_->model(), axis), seen.noise);
    }

    double spectral_gain(const Observation& observation, std::size_t axis, const Telegraph& telegraph) const {
        return noise_with(observation, axis, telegraph).log_likelihood_nats -
               observation.axis(axis).noise.log_likelihood_nats;
    }

    // Of the likelihood, by N, B and K in units of their uncertainty.
    std::vector<Eigen::Vector3d> nuisance_slopes(const AxisObservation& seen, std::size_t axis) const {
        const std::array<double, 3> sd_rel = noise_uncertainty(prediction_->model(), axis);
        std::vector<Eigen::Vector3d> slopes(seen.density.size());
        for (std::size_t i = 0; i < slopes.size(); ++i) {
            const SpectralParts& parts = prediction_->parts(axis)[i];
            const std::array<double, 3> part = {parts.white, parts.flicker, parts.walk};
            for (std::size_t j = 0; j < 3; ++j) {
                slopes[i][static_cast<Eigen::Index>(j)] =
                    2.0 * sd_rel[j] * (1.0 + sd_rel[j] * seen.noise.z[j]) * part[j] / seen.density[i];
            }
        }
        return slopes;
    }

    // By the score test: one pass for every correlation time. Then by maximum of the likelihood.
    std::optional<Point> start_of(const Observation& observation, std::size_t axis) const {
        const AxisObservation& seen = observation.axis(axis);
        const std::vector<Eigen::Vector3d> slopes = nuisance_slopes(seen, axis);
        Eigen::Matrix3d nuisance = Eigen::Matrix3d::Identity();
        for (std::size_t i = 0; i < slopes.size(); ++i) {
            nuisance.noalias() += 0.5 * prediction_->bins()[i].count() * slopes[i] * slopes[i].transpose();
        }
        const Eigen::LDLT<Eigen::Matrix3d> solver(nuisance);
        double best_gain = 0.0;
        Point best;
        const double longest_s = std::min(resolution::correlation_to_s,
                                          0.4 * prediction_->duration_s() / decisions.repetitions_least());
        double tau_s = resolution::correlation_from_s / resolution::correlation_ratio;
        while (tau_s * resolution::correlation_ratio < longest_s) {
            tau_s *= resolution::correlation_ratio;
            double score = 0.0;
            double information = 0.0;
            Eigen::Vector3d shared = Eigen::Vector3d::Zero();
            for (std::size_t i = 0; i < slopes.size(); ++i) {
                const double slope = GaussMarkov{1.0, tau_s}.psd(f_hz_[i]) / seen.density[i];
                const double half = 0.5 * prediction_->bins()[i].count();
                score += half * (seen.power[i] / seen.density[i] - 1.0) * slope;
                information += half * slope * slope;
                shared += half * slope * slopes[i];
            }
            information -= shared.dot(solver.solve(shared));
            if (!(score > 0.0) || !(information > 0.0)) { continue; }
            const double gain_nats = 0.5 * score * score / information;
            if (gain_nats < best_gain) { continue; }
            best_gain = gain_nats;
            best = {std::log(2.0) + 0.5 * std::log(score / information), std::log(2.0 * tau_s)};
        }
        if (best_gain < decisions.seen_nats()) { return std::nullopt; }
        return spectral_start(observation, axis, best);
    }

    // Even dwell times; only the variance and their scale are seen.
    std::optional<Point> spectral_start(const Observation& observation, std::size_t axis,
                                        const Point& from) const {
        const auto objective = [&](const std::vector<double>& logs) {
            const Point point = {logs[0], logs[1], logs[1]};
            return plausible(point) ? spectral_gain(observation, axis, telegraph_at(point)) : minus_infinity;
        };
        Point start = from;
        start[0] = std::clamp(start[0], std::log(lowest("amplitude_dps") * rad_per_deg) + 0.1,
                              std::log(highest("amplitude_dps") * rad_per_deg) - 0.1);
        const SimplexMaximum maximum = simplex_maximum(objective, start, 0.5, 0.05);
        if (maximum.value < decisions.seen_nats()) { return std::nullopt; }
        return Point{maximum.at[0], maximum.at[1], maximum.at[1]};
    }

    double lowest(std::string_view name) const {
        return param_of(effect_, name).plausible_from / decisions.beyond_plausible;
    }
    double highest(std::string_view name) const {
        return param_of(effect_, name).plausible_to * decisions.beyond_plausible;
    }
    bool plausible(const Point& logs) const {
        const Telegraph at = telegraph_at(logs);
        const auto inside = [&](std::string_view name, double value) {
            return value > lowest(name) && value < highest(name);
        };
        return inside("amplitude_dps", at.distance * deg_per_rad) && inside("dwell_high_s", at.high_s) &&
               inside("dwell_low_s", at.low_s) && at.correlation_s() * prediction_->rate_hz() > 1.0 &&
               std::max(at.high_s, at.low_s) * decisions.repetitions_least() < prediction_->duration_s();
    }

    Averages averages_for(const Observation& observation, std::size_t axis, const Telegraph& telegraph,
                          double per_dwell_max) const {
        const AxisObservation& seen = observation.axis(axis);
        const double duration_s = prediction_->duration_s();
        const double dwell_s = 2.0 * telegraph.correlation_s();
        const double levels_show_s = resolution::levels_apart * resolution::levels_apart *
                                     seen.density.back() / (telegraph.distance * telegraph.distance);
        const double wanted_s = std::clamp(
            std::clamp(levels_show_s, dwell_s / per_dwell_max, dwell_s / resolution::averages_per_dwell_min),
            duration_s / resolution::averages_max, duration_s / resolution::averages_min);
        const auto length =
            std::max<std::size_t>(1, static_cast<std::size_t>(wanted_s * prediction_->rate_hz()));
        Averages out;
        out.step_s = static_cast<double>(length) / prediction_->rate_hz();
        out.values = averages_of(seen.residual_rad_s, length);
        return out;
    }

    struct Gain {
        double spectral_nats = 0.0;
        double beside_nats = 0.0;  // two levels against Gauss-Markov noise

        double nats() const { return spectral_nats + beside_nats; }
    };

    // Under the noise that goes with the telegraph: what one would explain, the other need not.
    Gain gain(const Observation& observation, std::size_t axis, const Averages& averages,
              const Telegraph& telegraph) const {
        const NoiseNuisance noise = noise_with(observation, axis, telegraph);
        std::vector<double> density(f_hz_.size());
        expected_density(prediction_->parts(axis), noise_uncertainty(prediction_->model(), axis), noise.z,
                         density);
        const DriftStates drift = drift_states(f_hz_, density, averages.step_s, prediction_->duration_s());
        return {noise.log_likelihood_nats - observation.axis(axis).noise.log_likelihood_nats,
                telegraph_log_likelihood(averages.values, averages.step_s, drift, telegraph) -
                    gauss_markov_log_likelihood(averages.values, averages.step_s, drift, telegraph)};
    }

    // Whether one set of parameters can hold for all.
    static bool alike(const std::vector<AxesFit>& fits) {
        for (const auto& [name, value] : fits.front().params) {
            for (const AxesFit& fit : fits) {
                const double sd = std::hypot(fit.sd.at(name), fits.front().sd.at(name));
                if (std::fabs(fit.params.at(name) - value) > decisions.certain_sigma * sd) { return false; }
            }
        }
        return true;
    }

    static Point middle_of(const std::vector<AxesFit>& fits) {
        Point sum(3, 0.0);
        for (const AxesFit& fit : fits) {
            sum[0] += std::log(fit.params.at("amplitude_dps") * rad_per_deg);
            sum[1] += std::log(fit.params.at("dwell_high_s"));
            sum[2] += std::log(fit.params.at("dwell_low_s"));
        }
        for (double& log : sum) { log /= static_cast<double>(fits.size()); }
        return sum;
    }

    // The same variance and correlation time, a share of the time on the upper level.
    static Point with_share(const Point& logs, double share) {
        const Telegraph from = telegraph_at(logs);
        const double correlation_s = from.correlation_s();
        return {0.5 * std::log(from.variance() / (share * (1.0 - share))),
                std::log(correlation_s / (1.0 - share)), std::log(correlation_s / share)};
    }

    // With short averages only where long ones show levels: where they do not, another effect has more to
    // say.
    AxesFit fit_axes(const Observation& observation, const std::vector<std::size_t>& axes,
                     const Point& from) const {
        std::vector<Averages> averages;
        const auto take_averages = [&](const Point& logs, double per_dwell_max) {
            averages.clear();
            for (const std::size_t axis : axes) {
                averages.push_back(averages_for(observation, axis, telegraph_at(logs), per_dwell_max));
            }
        };
        const auto objective = [&](const Point& logs) {
            if (!plausible(logs)) { return minus_infinity; }
            double sum = 0.0;
            for (std::size_t i = 0; i < axes.size(); ++i) {
                sum += gain(observation, axes[i], averages[i], telegraph_at(logs)).nats();
            }
            return sum;
        };
        take_averages(from, resolution::averages_per_dwell_min);
        Point start = from;
        double best = objective(start);
        for (const double share : {0.2, 0.8}) {
            const Point other = with_share(from, share);
            const double value = objective(other);
            if (value > best) {
                best = value;
                start = other;
            }
        }
        const auto spectral = [&](const Point& logs) {
            double sum = 0.0;
            for (const std::size_t axis : axes) {
                sum += spectral_gain(observation, axis, telegraph_at(logs));
            }
            return sum;
        };
        SimplexMaximum maximum{start, best};
        if (best > spectral(start) - resolution::hopeless_nats) {
            maximum = simplex_maximum(objective, start, 0.2, 0.1, 100);
        }
        if (maximum.value > spectral(maximum.at)) {
            take_averages(maximum.at, resolution::averages_per_dwell_max);
            maximum = simplex_maximum(objective, maximum.at, 0.05, 0.05, 60);
        }
        AxesFit fit;
        fit.axes = axes;
        const Telegraph telegraph = telegraph_at(maximum.at);
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const Gain found = gain(observation, axes[i], averages[i], telegraph);
            fit.gain_nats.push_back(found.nats());
            fit.spectral_nats.push_back(found.spectral_nats);
        }
        fit.params = params_of(telegraph);
        add_uncertainty(objective, maximum, fit);
        return fit;
    }

    // From the curvature of the gain in the logarithms.
    void add_uncertainty(const std::function<double(const Point&)>& objective, const SimplexMaximum& maximum,
                         AxesFit& fit) const {
        constexpr std::array<const char*, 3> names = {"amplitude_dps", "dwell_high_s", "dwell_low_s"};
        const PeakCurvature curvature = peak_curvature(objective, maximum.at, maximum.value,
                                                       resolution::step_log, resolution::sd_log_most);
        const Telegraph telegraph = telegraph_at(maximum.at);
        const double dwells = static_cast<double>(fit.axes.size()) * prediction_->duration_s() /
                              (telegraph.high_s + telegraph.low_s);
        Matrix covariance = CholeskyFactor(curvature.information).inverse();
        // Exponential dwell times that were all seen have a mean no better known than this.
        for (std::size_t i = 1; i < names.size(); ++i) {
            covariance(i, i) = std::max(covariance(i, i), 1.0 / dwells);
        }
        std::vector<const EffectParam*> params;
        std::vector<double> values;
        for (std::size_t i = 0; i < names.size(); ++i) {
            params.push_back(&param_of(effect_, names[i]));
            values.push_back(fit.params.at(names[i]));
            fit.sd[names[i]] = values[i] * std::sqrt(covariance(i, i));
        }
        fit.cost_nats += joint_occam_cost_nats(
            params, values, information_of_values(CholeskyFactor(covariance).inverse(), values));
    }

    // The band in which nine tenths of the spectrum's part of the gain arise.
    void place(const Observation& observation, Finding& finding) const {
        std::vector<double> arises(f_hz_.size(), 0.0);
        for (const EffectModel& entry : finding.entries) {
            for (const std::size_t axis : finding.where.axes) {
                if (std::ranges::count(entry.axes, axis_names[axis]) == 0) { continue; }
                const std::vector<SpectralParts> parts = changed_parts(axis, entry);
                for (std::size_t i = 0; i < arises.size(); ++i) {
                    const double before = prediction_->parts(axis)[i].sum();
                    const double after = parts[i].sum();
                    const double power = observation.axis(axis).power[i];
                    arises[i] +=
                        std::max(0.0, 0.5 * prediction_->bins()[i].count() *
                                          (std::log(before / after) + power / before - power / after));
                }
            }
        }
        double sum = 0.0;
        for (const double nats : arises) { sum += nats; }
        Span band{f_hz_.front(), f_hz_.back()};
        double below = 0.0;
        for (std::size_t i = 0; i < arises.size(); ++i) {
            if (below < 0.05 * sum) { band.from = f_hz_[i]; }
            if (below < 0.95 * sum) { band.to = f_hz_[i]; }
            below += arises[i];
        }
        finding.where.freq_hz = band;
        finding.where.tau_s = averaging_times_of(band);
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    std::vector<double> f_hz_;
};

}  // namespace

MadeEstimator make_random_telegraph_estimator(const EffectDefinition& effect,
                                              std::shared_ptr<const Prediction> prediction) {
    if (prediction->moves()) {
        return {nullptr,
                "the sensor moves, and what a model misses of the motion goes to and fro like two levels"};
    }
    return {std::make_unique<RandomTelegraphEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
