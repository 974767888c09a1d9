#include "analysis/diagnose/estimators/tails.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/axis_subsets.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/diagnose/likelihood/white_distribution.hpp"
#include "analysis/diagnose/likelihood/white_share.hpp"
#include "analysis/diagnose/likelihood/whitened_blocks.hpp"
#include "analysis/numerics/log_sum_exp.hpp"

namespace gyrolog::resolution {

constexpr std::size_t node_count = 33;
// A kurtosis within so many of its standard deviations is no trace of tails.
constexpr double kurtosis_sigma = 1.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Distributions of what is white on an axis, by the degrees of freedom of Student's t.
class AxisTables {
public:
    AxisTables(const WhiteShare& share, double nu, std::vector<double> log_nu)
        : share_(share), nu_(nu), own_(at(std::log(nu))), log_nu_(std::move(log_nu)) {}

    const WhiteShare& share() const { return share_; }
    double nu() const { return nu_; }                    // the prediction's
    const LogDensityTable& own() const { return own_; }  // likewise

    // One a node. Few axes have tails at all: made when the first asks.
    const std::vector<LogDensityTable>& of_nodes() const {
        std::call_once(made_, [&] {
            for (const double node : log_nu_) { of_nodes_.push_back(at(node)); }
        });
        return of_nodes_;
    }

    LogDensityTable at(double log_nu) const {
        return LogDensityTable(NormalMixture(std::exp(log_nu), share_.own_variance, share_.lattice));
    }

private:
    WhiteShare share_;
    double nu_ = 0.0;
    LogDensityTable own_;
    std::vector<double> log_nu_;  // by node
    mutable std::once_flag made_;
    mutable std::vector<LogDensityTable> of_nodes_;
};

// What one axis says: gain and scale by node.
struct Profile {
    std::size_t axis = 0;
    WhitenedHistogram histogram;
    ScaledFit plain;
    std::vector<double> gain_nats;
};

class TailEstimator final : public Estimator {
public:
    TailEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), prediction_(std::move(prediction)) {
        const EffectParam& nu = effect_.params.front();
        log_from_ = std::log(nu.plausible_from);
        log_step_ =
            std::log(nu.plausible_to / nu.plausible_from) / static_cast<double>(resolution::node_count - 1);
        for (const std::size_t axis : prediction_->axes()) { make_tables(axis); }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        std::vector<Profile> profiles;
        std::vector<std::size_t> members;
        for (const std::size_t axis : prediction_->axes()) {
            if (std::optional<Profile> profile = profile_of(observation, axis)) {
                members.push_back(profiles.size());
                profiles.push_back(std::move(*profile));
            }
        }
        std::vector<AxesFit> single;
        std::optional<AxesFit> shared;
        for (const std::vector<std::size_t>& subset : axis_subsets(members)) {
            std::optional<AxesFit> fit = fit_of(profiles, subset);
            if (!fit) { continue; }
            if (subset.size() == 1) {
                single.push_back(std::move(*fit));
            } else if (!shared || fit->evidence_nats() > shared->evidence_nats()) {
                shared = std::move(fit);
            }
        }
        std::optional<Finding> finding = best_of(effect_, single, 0.0, shared);
        if (!finding) { return std::nullopt; }
        finding->evidence_nats -= axis_choice_nats(prediction_->axes().size());
        locate(profiles, *finding);
        return finding;
    }

private:
    double log_nu(double node) const { return log_from_ + log_step_ * node; }

    void make_tables(std::size_t axis) {
        const WhiteShare share = white_share(*prediction_, axis);
        const double nu = white_degrees_of_freedom(*prediction_, axis);
        for (const std::size_t other : prediction_->axes()) {
            if (other == axis) { break; }
            const AxisTables& made = *tables_[other];
            if (made.nu() == nu &&
                std::fabs(made.share().own_variance - share.own_variance) < resolution::negligible_share &&
                std::fabs(made.share().lattice - share.lattice) < resolution::negligible_share) {
                tables_[axis] = tables_[other];
                return;
            }
        }
        std::vector<double> nodes;
        for (std::size_t node = 0; node < resolution::node_count; ++node) {
            nodes.push_back(log_nu(static_cast<double>(node)));
        }
        tables_[axis] = std::make_shared<const AxisTables>(share, nu, std::move(nodes));
    }

    std::optional<Profile> profile_of(const Observation& observation, std::size_t axis) const {
        const WhitenedBlocks blocks = whitened_blocks(observation, axis);
        if (!blocks.has_noise()) { return std::nullopt; }
        const AxisTables& tables = *tables_[axis];
        Profile profile;
        profile.axis = axis;
        profile.histogram = whitened_histogram(blocks, observation, axis);
        const double chance = std::sqrt(24.0 / profile.histogram.samples);
        if (std::isinf(tables.nu()) &&
            profile.histogram.excess_kurtosis() < resolution::kurtosis_sigma * chance) {
            return std::nullopt;
        }
        profile.plain = fit_scale(profile.histogram, tables.own(), std::sqrt(profile.histogram.moment(2)));
        ScaledFit fit = profile.plain;
        const std::vector<LogDensityTable>& of_nodes = tables.of_nodes();
        for (std::size_t node = resolution::node_count; node-- > 0;) {
            fit = fit_scale(profile.histogram, of_nodes[node], fit.scale);
            profile.gain_nats.push_back(fit.log_likelihood_nats - profile.plain.log_likelihood_nats);
        }
        std::ranges::reverse(profile.gain_nats);
        return profile;
    }

    double gain_at(const Profile& profile, double log_nu) const {
        const ScaledFit fit =
            fit_scale(profile.histogram, tables_[profile.axis]->at(log_nu), profile.plain.scale);
        return fit.log_likelihood_nats - profile.plain.log_likelihood_nats;
    }

    // One number of degrees of freedom for some axes.
    std::optional<AxesFit> fit_of(const std::vector<Profile>& profiles,
                                  const std::vector<std::size_t>& subset) const {
        std::vector<double> sum(resolution::node_count, 0.0);
        for (const std::size_t member : subset) {
            for (std::size_t node = 0; node < resolution::node_count; ++node) {
                sum[node] += profiles[member].gain_nats[node];
            }
        }
        const auto best = static_cast<std::size_t>(std::ranges::max_element(sum) - sum.begin());
        if (!(sum[best] > 0.0)) { return std::nullopt; }
        const auto total = [&](double log_nu) {
            double gain = 0.0;
            for (const std::size_t member : subset) { gain += gain_at(profiles[member], log_nu); }
            return gain;
        };
        double middle = log_nu(static_cast<double>(best));
        double sd = parabola_top(sum, best, middle);
        // Between the nodes the top is found again, nearer to it.
        double highest = total(middle);
        for (int round = 0; round < 2; ++round) {
            const double reach = std::min(sd, 2.0 * log_step_);
            const double below = total(middle - reach);
            const double above = total(middle + reach);
            const double curvature = 2.0 * highest - below - above;
            if (!(curvature > 0.0)) { break; }
            sd = reach / std::sqrt(curvature);
            const double moved =
                middle + std::clamp(0.5 * reach * (above - below) / curvature, -reach, reach);
            const double there = total(moved);
            if (!(there > highest)) { break; }
            highest = there;
            middle = moved;
        }
        sd = std::min(sd, log_step_ * static_cast<double>(resolution::node_count));
        const double nu = std::exp(middle);
        AxesFit fit;
        for (const std::size_t member : subset) {
            fit.axes.push_back(profiles[member].axis);
            fit.gain_nats.push_back(gain_at(profiles[member], middle));
        }
        const std::string name(effect_.params.front().name);
        fit.params[name] = nu;
        fit.sd[name] = nu * sd;
        fit.cost_nats = cost_nats(sum, highest, sd);
        return fit;
    }

    // Of a parabola through the best node and its neighbours: moves `top` there and returns its width.
    double parabola_top(const std::vector<double>& gain, std::size_t best, double& top) const {
        if (best == 0 || best + 1 == resolution::node_count) { return log_step_; }
        const double curvature = 2.0 * gain[best] - gain[best - 1] - gain[best + 1];
        if (!(curvature > 0.0)) { return log_step_; }
        top += log_step_ * 0.5 * (gain[best + 1] - gain[best - 1]) / curvature;
        return log_step_ / std::sqrt(curvature);
    }

    // Of the freedom to choose nu, with ln nu as likely anywhere in its range: what the average likelihood is
    // below the highest. Where the peak is too narrow for the nodes, Laplace's approximation.
    double cost_nats(const std::vector<double>& gain, double highest, double sd) const {
        const double range = log_step_ * static_cast<double>(resolution::node_count - 1);
        if (sd < log_step_) { return parameter_cost_nats(range, sd); }
        return std::max(0.5,
                        highest + std::log(static_cast<double>(resolution::node_count)) - log_sum_exp(gain));
    }

    void locate(const std::vector<Profile>& profiles, Finding& finding) const {
        double furthest = decisions.seen_sigma;
        for (const Profile& profile : profiles) {
            if (std::ranges::count(finding.where.axes, profile.axis) == 0) { continue; }
            for (std::size_t i = 0; i < profile.histogram.at.size(); ++i) {
                if (profile.histogram.count[i] > 0.0) {
                    furthest = std::max(furthest, profile.histogram.at[i]);
                }
            }
        }
        finding.where.amplitude_sigma = {decisions.seen_sigma, furthest};
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    double log_from_ = 0.0;
    double log_step_ = 0.0;
    std::array<std::shared_ptr<const AxisTables>, 3> tables_;
};

}  // namespace

MadeEstimator make_tail_estimator(const EffectDefinition& effect,
                                  std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<TailEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
