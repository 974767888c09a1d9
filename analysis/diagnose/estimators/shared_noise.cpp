#include "analysis/diagnose/estimators/shared_noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/axis_subsets.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/diagnose/likelihood/white_share.hpp"
#include "analysis/numerics/log_sum_exp.hpp"
#include "analysis/numerics/peak_curvature.hpp"
#include "analysis/numerics/simplex_search.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

// Coefficients with more than this times the expected power are a line's.
constexpr double line_power = 25.0;
// Of the logarithm of the density and of ratios of gains: the least step over which a curvature is taken, and
// the sd of what is not known.
constexpr double curvature_step = 0.01;
constexpr double ratio_sd_most = 1.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Of the scaled coefficients of all axes.
struct Statistics {
    double count = 0.0;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();  // between axes, by the model
    Eigen::Vector3d white = Eigen::Vector3d::Ones();     // share of the own white noise
    Eigen::Vector3d per_rad = Eigen::Vector3d::Zero();   // h of a density of 1 (rad/s)^2/Hz
    Span band_hz;
};

// What an axis shares with others is more than the white noise that it has, or part of that.
enum class Shared { added, part_of_white };

class SharedNoiseEstimator final : public Estimator {
public:
    SharedNoiseEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), prediction_(std::move(prediction)) {
        const SensorModel of_one = with_effect_of_one();
        for (const std::size_t axis : prediction_->axes()) {
            const std::vector<SpectralParts> parts = prediction_->parts_of(of_one, axis);
            for (std::size_t i = 0; i < parts.size(); ++i) {
                const double more = parts[i].added_white - prediction_->parts(axis)[i].added_white;
                passed_[axis].push_back(std::sqrt(std::max(more, 0.0)) / rad_per_deg);
            }
        }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        const std::optional<Statistics> statistics = statistics_of(observation);
        if (!statistics || correlation_nats(*statistics) < resolution::worth_refining_nats) {
            return std::nullopt;
        }
        std::optional<AxesFit> best;
        for (const std::vector<std::size_t>& axes : axis_subsets(prediction_->axes())) {
            if (axes.size() < 2) { continue; }
            for (const Shared kind : {Shared::added, Shared::part_of_white}) {
                for (const bool alike : {true, false}) {
                    std::optional<AxesFit> fit = fit_axes(observation, *statistics, axes, kind, alike);
                    if (fit && (!best || fit->evidence_nats() > best->evidence_nats())) {
                        best = std::move(fit);
                    }
                }
            }
        }
        std::optional<Finding> finding = best_of(effect_, {}, 0.0, best);
        if (finding) {
            finding->evidence_nats -= choice_cost_nats();
            finding->where.structure = effect_.signature->structure;
            finding->where.freq_hz = statistics->band_hz;
        }
        return finding;
    }

private:
    // Of the freedom to choose axes, gains alike or not, and whether it is added.
    double choice_cost_nats() const { return std::log(prediction_->axes().size() > 2 ? 16.0 : 4.0); }

    SensorModel with_effect_of_one() const {
        SensorModel model = prediction_->model();
        EffectModel entry{std::string(effect_.name), {}, {}, ""};
        for (const EffectParam& param : effect_.params) {
            const bool is_choice = param.range == EffectParam::Range::yes_no;
            entry.params[std::string(param.name)] = is_choice ? 0.0 : 1.0;
        }
        model.effects.push_back(std::move(entry));
        return model;
    }

    std::optional<Statistics> statistics_of(const Observation& observation) const {
        Statistics sum;
        sum.covariance.setZero();
        sum.white.setZero();
        for (std::size_t i = 0; i < prediction_->bins().size(); ++i) {
            if (is_white(observation, i)) { add_bin(observation, i, sum); }
        }
        if (sum.count < 64.0) { return std::nullopt; }
        sum.covariance /= sum.count;
        sum.expected /= sum.count;
        sum.white /= sum.count;
        sum.per_rad /= sum.count;
        for (const std::size_t axis : prediction_->axes()) {
            const auto a = static_cast<Eigen::Index>(axis);
            // A dead axis.
            if (!(sum.covariance(a, a) > 1e-6)) { return std::nullopt; }
        }
        add_known(sum);
        return sum;
    }

    double white_at(const Observation& observation, std::size_t axis, std::size_t bin) const {
        const AxisObservation& seen = observation.axis(axis);
        const double factor = 1.0 + noise_uncertainty(prediction_->model(), axis)[0] * seen.noise.z[0];
        return factor * factor * prediction_->parts(axis)[bin].white / seen.density[bin];
    }

    bool is_white(const Observation& observation, std::size_t bin) const {
        return std::ranges::all_of(prediction_->axes(), [&](std::size_t axis) {
            return white_at(observation, axis, bin) > definition::majority;
        });
    }

    void add_bin(const Observation& observation, std::size_t bin, Statistics& sum) const {
        const std::size_t first = prediction_->bins()[bin].first;
        const std::size_t end = prediction_->bins()[bin].end;
        std::array<double, 3> scale{};
        for (const std::size_t axis : prediction_->axes()) {
            scale[axis] = 1.0 / std::sqrt(observation.axis(axis).density[bin] * prediction_->rate_hz());
        }
        double count = 0.0;
        for (std::size_t k = first; k < end; ++k) {
            if (!prediction_->bins()[bin].has(k)) { continue; }
            Eigen::Vector3d x = Eigen::Vector3d::Zero();
            for (const std::size_t axis : prediction_->axes()) {
                x[static_cast<Eigen::Index>(axis)] =
                    scale[axis] * static_cast<double>(observation.axis(axis).cosines[k]);
            }
            if (x.cwiseAbs2().maxCoeff() > resolution::line_power) { continue; }
            sum.covariance.noalias() += x * x.transpose();
            count += 1.0;
        }
        if (count == 0.0) { return; }
        const double f_hz = prediction_->bins()[bin].f_hz;
        if (sum.count == 0.0) { sum.band_hz.from = f_hz; }
        sum.band_hz.to = f_hz;
        sum.count += count;
        for (const std::size_t axis : prediction_->axes()) {
            const auto a = static_cast<Eigen::Index>(axis);
            sum.white[a] += count * white_at(observation, axis, bin);
            sum.per_rad[a] += count * scale[axis] * passed_[axis][bin] * std::sqrt(prediction_->rate_hz());
        }
    }

    // What entries of the model share already.
    void add_known(Statistics& sum) const {
        for (const EffectModel& entry : prediction_->model().effects) {
            if (entry.effect != effect_.name) { continue; }
            const Eigen::Vector3d h = shared_of(sum, entry);
            sum.expected += h * h.transpose();
        }
        sum.expected.diagonal().setZero();
    }

    Eigen::Vector3d shared_of(const Statistics& sum, const EffectModel& entry) const {
        Eigen::Vector3d h = Eigen::Vector3d::Zero();
        for (const std::size_t axis : prediction_->axes()) {
            if (!acts_on(entry, axis)) { continue; }
            const auto a = static_cast<Eigen::Index>(axis);
            const EffectValues values(entry, axis);
            h[a] = values[effect_.params[0].name] * values[effect_.params[1 + axis].name] * rad_per_deg *
                   sum.per_rad[a];
        }
        return h;
    }

    // Half the squared correlations' sum: what they gain at most, nearly.
    double correlation_nats(const Statistics& sum) const {
        double nats = 0.0;
        for (const std::size_t a : prediction_->axes()) {
            for (const std::size_t b : prediction_->axes()) {
                if (b <= a) { continue; }
                const double off = between(sum, a, b);
                nats += 0.5 * sum.count * off * off;
            }
        }
        return nats;
    }

    static double between(const Statistics& sum, std::size_t a, std::size_t b) {
        const auto i = static_cast<Eigen::Index>(a);
        const auto j = static_cast<Eigen::Index>(b);
        return sum.covariance(i, j) - sum.expected(i, j);
    }

    // Log-likelihood of the covariance between the axes; the axes' own variances are as seen.
    double correlation_likelihood(const Statistics& sum, const Eigen::Vector3d& h) const {
        Eigen::Matrix3d model = sum.expected + h * h.transpose();
        Eigen::Matrix3d seen = sum.covariance;
        for (Eigen::Index a = 0; a < 3; ++a) {
            const bool there = std::ranges::count(prediction_->axes(), static_cast<std::size_t>(a)) != 0;
            if (!there) { seen(a, a) = 1.0; }
            model(a, a) = seen(a, a);
        }
        const Eigen::LLT<Eigen::Matrix3d> cholesky(model);
        if (cholesky.info() != Eigen::Success) { return minus_infinity; }
        const double log_det = 2.0 * cholesky.matrixLLT().diagonal().array().log().sum();
        return -0.5 * sum.count * (log_det + cholesky.solve(seen).trace());
    }

    // What it costs the model that the axis' own white noise is what the shared part leaves.
    static double own_level_cost(const Observation& observation, const Statistics& sum, std::size_t axis,
                                 double h) {
        const auto a = static_cast<Eigen::Index>(axis);
        const double own = (sum.covariance(a, a) - h * h - (1.0 - sum.white[a])) / sum.white[a];
        if (!(own > 0.0)) { return std::numeric_limits<double>::infinity(); }
        return level_cost_nats(observation, axis, std::sqrt(own));
    }

    // What a shared part gains by the axis' level.
    static double level_gain_nats(const Observation& observation, const Statistics& sum, std::size_t axis,
                                  Shared kind, double h) {
        if (kind == Shared::added) {
            return own_level_cost(observation, sum, axis, 0.0) - own_level_cost(observation, sum, axis, h);
        }
        return h * h < sum.white[static_cast<Eigen::Index>(axis)] ? 0.0 : minus_infinity;
    }

    double gain(const Observation& observation, const Statistics& sum, Shared kind,
                const Eigen::Vector3d& h) const {
        double nats = correlation_likelihood(sum, h) - correlation_likelihood(sum, Eigen::Vector3d::Zero());
        for (const std::size_t axis : prediction_->axes()) {
            nats += level_gain_nats(observation, sum, axis, kind, h[static_cast<Eigen::Index>(axis)]);
        }
        return std::isnan(nats) ? minus_infinity : nats;
    }

    // Density of the shared noise in (rad/s)/sqrt(Hz), then the gains of all axes but the first.
    static Eigen::Vector3d shared(const Statistics& sum, const std::vector<std::size_t>& axes,
                                  const std::vector<double>& at) {
        Eigen::Vector3d h = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const auto a = static_cast<Eigen::Index>(axes[i]);
            const double ratio = i == 0 || at.size() == 1 ? 1.0 : at[i];
            h[a] = std::exp(at[0]) * ratio * sum.per_rad[a];
        }
        return h;
    }

    // Alike: all axes have gain 1.
    std::optional<AxesFit> fit_axes(const Observation& observation, const Statistics& sum,
                                    const std::vector<std::size_t>& axes, Shared kind, bool alike) const {
        std::vector<double> start = {0.0};
        double square = 0.0;
        for (std::size_t i = 1; i < axes.size(); ++i) {
            const auto a = static_cast<Eigen::Index>(axes[0]);
            const auto b = static_cast<Eigen::Index>(axes[i]);
            const double off = between(sum, axes[0], axes[i]);
            square += std::fabs(off) / (sum.per_rad[a] * sum.per_rad[b]);
            if (!alike) { start.push_back(off < 0.0 ? -1.0 : 1.0); }
        }
        start[0] = 0.5 * std::log(square / static_cast<double>(axes.size() - 1));
        const auto objective = [&](const std::vector<double>& at) {
            double smallest = 1.0;
            double largest = 1.0;
            for (std::size_t i = 1; i < at.size(); ++i) {
                smallest = std::min(smallest, std::fabs(at[i]));
                largest = std::max(largest, std::fabs(at[i]));
            }
            if (smallest < decisions.gain_ratio_least * largest) { return minus_infinity; }
            return gain(observation, sum, kind, shared(sum, axes, at));
        };
        if (!std::isfinite(start[0]) || !std::isfinite(objective(start))) { return std::nullopt; }
        SimplexMaximum maximum = simplex_maximum(objective, start, -0.2, 1e-3);
        maximum = simplex_maximum(objective, maximum.at, 0.02, 1e-4);
        if (!(maximum.value > 0.0)) { return std::nullopt; }
        return axes_fit(observation, sum, axes, kind, maximum, objective);
    }

    template <typename Objective>
    AxesFit axes_fit(const Observation& observation, const Statistics& sum,
                     const std::vector<std::size_t>& axes, Shared kind, const SimplexMaximum& maximum,
                     const Objective& objective) const {
        const PeakCurvature curvature = peak_curvature(objective, maximum.at, maximum.value,
                                                       resolution::curvature_step, resolution::ratio_sd_most);
        const Eigen::Vector3d h = shared(sum, axes, maximum.at);
        AxesFit fit;
        fit.axes = axes;
        // The correlation's part belongs to all of them alike.
        double levels = 0.0;
        for (const std::size_t axis : axes) {
            fit.gain_nats.push_back(
                level_gain_nats(observation, sum, axis, kind, h[static_cast<Eigen::Index>(axis)]));
            levels += fit.gain_nats.back();
        }
        fit.spectral_nats = fit.gain_nats;
        for (double& nats : fit.gain_nats) {
            nats += (maximum.value - levels) / static_cast<double>(axes.size());
        }
        double largest = 1.0;
        for (std::size_t i = 1; i < maximum.at.size(); ++i) {
            largest = std::max(largest, std::fabs(maximum.at[i]));
        }
        const EffectParam& density = effect_.params[0];
        const std::string name(density.name);
        fit.params[name] = std::exp(maximum.at[0]) * largest * deg_per_rad;
        fit.sd[name] = fit.params[name] * curvature.sd[0];
        if (kind == Shared::part_of_white) { fit.params["part_of_white"] = 1.0; }
        const PlausibleRange of_density(density, fit.params[name]);
        std::vector<double> ranges = {of_density.width / fit.params[name]};
        for (std::size_t i = 0; maximum.at.size() > 1 && i < axes.size(); ++i) {
            const EffectParam& param = effect_.params[1 + axes[i]];
            fit.params[std::string(param.name)] = (i == 0 ? 1.0 : maximum.at[i]) / largest;
            if (i == 0) { continue; }
            fit.sd[std::string(param.name)] = curvature.sd[i] / largest;
            // Of either sign.
            ranges.push_back(2.0 * (param.plausible_to - param.plausible_from) * largest);
        }
        fit.cost_nats = joint_parameter_cost_nats(curvature.information, ranges) + of_density.beyond_nats;
        return fit;
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    // By axis and bin: what the filters let through of the noise's amplitude.
    std::array<std::vector<double>, 3> passed_;
};

}  // namespace

MadeEstimator make_shared_noise_estimator(const EffectDefinition& effect,
                                          std::shared_ptr<const Prediction> prediction) {
    if (prediction->axes().size() < 2) { return {nullptr, "the recording has one axis only"}; }
    return {std::make_unique<SharedNoiseEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
