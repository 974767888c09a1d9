#include "analysis/diagnose/estimators/mean_response.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/gain_band.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/estimators/trial_grid.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/effect_response.hpp"
#include "analysis/diagnose/likelihood/mean_regression.hpp"
#include "analysis/numerics/log_sum_exp.hpp"
#include "analysis/numerics/simplex_search.hpp"

namespace gyrolog::resolution {

// In steps of the trial values.
constexpr double simplex_width = 0.05;
// Where the evidence falls by more than this over the simplex' width, its answer is not good enough.
constexpr double fall_polished_nats = 0.25;
constexpr std::size_t polishing_passes = 2;
constexpr int simplex_simulations_most = 18;
// Of noise and response in turns: what one more would gain.
constexpr double turn_settled_nats = 0.02;
constexpr int turns_most = 30;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

struct Trial {
    TrialPoint point;
    std::array<MeanResponses, 3> responses;  // by axis: one for each linear parameter
};

// One axis, one trial, the noise as the observation has it.
struct Quick {
    NormalEquations equations;
    double gain_nats = 0.0;
    double cost_nats = 0.0;  // of the linear parameters
};

// One axis, whose noise and response are fitted in turns, each as the other is.
class AxisInTurns {
public:
    AxisInTurns(const Observation& observation, std::size_t axis, const MeanResponses& responses,
                std::vector<SpectralParts> parts)
        : bins_(&observation.prediction().bins()),
          seen_(&observation.axis(axis)),
          regression_(observation, axis, responses),
          sd_rel_(noise_uncertainty(observation.prediction().model(), axis)),
          parts_(std::move(parts)) {
        start_from(seen_->noise);
    }

    // Whether its slow noise may be anything, and so may have taken up the response.
    bool has_open_noise() const { return std::max(sd_rel_[1], sd_rel_[2]) >= decisions.seen_sd_rel(); }

    // Open noise at the least that it can be.
    void start_without_slow_noise() {
        NoiseNuisance noise = seen_->noise;
        for (const std::size_t index : {std::size_t{1}, std::size_t{2}}) {
            if (sd_rel_[index] >= decisions.seen_sd_rel()) { noise.z[index] = -1.0 / sd_rel_[index]; }
        }
        start_from(noise);
    }

    const NormalEquations& equations() const { return equations_; }

    void take(std::span<const double> c) {
        const MeanRegression::Rest rest = regression_.rest(equations_, c);
        noise_ = fit_nuisance(*bins_, parts_, rest.power, sd_rel_, noise_);
        gain_nats_ = noise_.log_likelihood_nats - seen_->noise.log_likelihood_nats - rest.charge_nats;
        weigh();
    }

    double gain_nats() const { return gain_nats_; }

private:
    void start_from(const NoiseNuisance& noise) {
        noise_ = noise;
        weigh();
    }

    void weigh() {
        std::vector<double> density(parts_.size());
        expected_density(parts_, sd_rel_, noise_.z, density);
        equations_ = regression_.equations(density);
    }

    const SpectralBins* bins_;
    const AxisObservation* seen_;
    MeanRegression regression_;
    std::array<double, 3> sd_rel_;
    std::vector<SpectralParts> parts_;
    NoiseNuisance noise_;
    NormalEquations equations_;
    double gain_nats_ = 0.0;
};

// One response of some axes, with N, B and K of each fitted with it.
class CommonFit {
public:
    // Without linear parameters the response is what it is.
    explicit CommonFit(bool is_linear) : is_linear_(is_linear) {}

    void add(AxisInTurns axis) { axes_.push_back(std::move(axis)); }

    bool has_open_noise() const { return std::ranges::any_of(axes_, &AxisInTurns::has_open_noise); }

    void start_without_slow_noise() {
        for (AxisInTurns& axis : axes_) { axis.start_without_slow_noise(); }
    }

    void settle() {
        for (int turn = 0; turn < resolution::turns_most; ++turn) {
            pool();
            c_ = is_linear_ ? equations_.solution() : std::vector{1.0};
            double gain_nats = 0.0;
            for (AxisInTurns& axis : axes_) {
                axis.take(c_);
                gain_nats += axis.gain_nats();
            }
            const double more_nats = gain_nats - gain_nats_;
            gain_nats_ = gain_nats;
            if (!(more_nats > resolution::turn_settled_nats)) { break; }
        }
    }

    double gain_nats() const { return gain_nats_; }
    const std::vector<double>& c() const { return c_; }
    // Of all axes together.
    const NormalEquations& equations() const { return equations_; }

    std::vector<double> gains_nats() const {
        std::vector<double> gains;
        for (const AxisInTurns& axis : axes_) { gains.push_back(axis.gain_nats()); }
        return gains;
    }

private:
    void pool() {
        equations_ = axes_.front().equations();
        for (std::size_t i = 1; i < axes_.size(); ++i) { equations_.add(axes_[i].equations()); }
    }

    bool is_linear_;
    std::vector<AxisInTurns> axes_;
    std::vector<double> c_;
    NormalEquations equations_;
    double gain_nats_ = minus_infinity;
};

class MeanResponseEstimator final : public Estimator {
public:
    MeanResponseEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), signature_(*effect.signature), prediction_(std::move(prediction)) {
        for (const TrialPoint& point : trial_points(signature_, peaks_dps())) {
            trials_.push_back(simulated(point));
        }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        std::vector<std::vector<Quick>> quick(trials_.size());
        std::map<std::size_t, std::size_t> best_of_group;
        for (std::size_t t = 0; t < trials_.size(); ++t) {
            quick[t] = quick_fits(observation, trials_[t]);
            const auto [best, first] = best_of_group.try_emplace(trials_[t].point.group, t);
            if (!first && quick_evidence(quick[t]) > quick_evidence(quick[best->second])) {
                best->second = t;
            }
        }
        // Between the trial values of one group its likelihood may rise above the best trial of another.
        std::optional<Finding> finding;
        for (const auto& [group, trial] : best_of_group) {
            std::optional<Finding> of_group = best_near(observation, quick, trial);
            if (of_group && is_within_noise(*of_group)) { continue; }
            if (of_group && (!finding || of_group->evidence_nats > finding->evidence_nats)) {
                finding = std::move(of_group);
            }
        }
        if (finding) { locate(observation, *finding); }
        return finding;
    }

private:
    // Of what each axis showed.
    std::vector<double> peaks_dps() const {
        std::vector<double> peaks;
        for (const std::size_t axis : prediction_->axes()) {
            double peak_rad_s = 0.0;
            for (const float rate : prediction_->denoised_response_rad_s(axis)) {
                peak_rad_s = std::max(peak_rad_s, static_cast<double>(std::fabs(rate)));
            }
            peaks.push_back(peak_rad_s * deg_per_rad);
        }
        return peaks;
    }

    std::optional<Finding> best_near(const Observation& observation,
                                     const std::vector<std::vector<Quick>>& quick, std::size_t trial) const {
        const ParamValues sd = trial_sd(quick, trial);
        std::optional<Finding> finding = fitted(observation, trials_[trial], sd);
        if (!finding || finding->evidence_nats <= resolution::worth_refining_nats || sd.empty()) {
            return finding;
        }
        const Trial better = refined(observation, trials_[trial]);
        std::optional<Finding> refitted_finding =
            fitted(observation, better, trial_sd_at(observation, better));
        if (refitted_finding && refitted_finding->gain_nats > finding->gain_nats) { return refitted_finding; }
        return finding;
    }

    EffectModel entry_of(ParamValues params) const {
        return {std::string(effect_.name), {}, std::move(params), ""};
    }

    Trial simulated(const TrialPoint& point) const {
        std::array<std::vector<std::vector<float>>, 3> responses;
        const auto add = [&](const ParamValues& params, double unit) {
            std::array<std::vector<float>, 3> response =
                effect_response(*prediction_, entry_of(params), signature_.slow);
            for (const std::size_t axis : prediction_->axes()) {
                for (float& coefficient : response[axis]) {
                    coefficient = static_cast<float>(static_cast<double>(coefficient) / unit);
                }
                responses[axis].push_back(std::move(response[axis]));
            }
        };
        if (signature_.linear.empty()) { add(point.params, 1.0); }
        for (const std::string_view name : signature_.linear) {
            ParamValues params = point.params;
            // A size at which the answer is well above rounding and the sensor still far from its limits.
            const double unit = param_of(effect_, name).plausible_to;
            for (const std::string_view other : signature_.linear) { params[std::string(other)] = 0.0; }
            params[std::string(name)] = unit;
            add(params, unit);
        }
        Trial trial{point, {}};
        for (const std::size_t axis : prediction_->axes()) {
            trial.responses[axis] = MeanResponses(*prediction_, axis, std::move(responses[axis]));
        }
        return trial;
    }

    std::vector<Quick> quick_fits(const Observation& observation, const Trial& trial) const {
        std::vector<Quick> fits;
        for (const std::size_t axis : prediction_->axes()) {
            const MeanRegression regression(observation, axis, trial.responses[axis]);
            fits.push_back(quick_fit(regression.equations(observation.axis(axis).density)));
        }
        return fits;
    }

    // Whether the linear parameters are known well enough to be worth their freedom.
    Quick quick_fit(NormalEquations equations) const {
        Quick quick{std::move(equations), 0.0, 0.0};
        const std::vector<double> c = solved(quick.equations);
        quick.gain_nats = quick.equations.gain_nats(c);
        quick.cost_nats = linear_cost(quick.equations, c);
        return quick;
    }

    std::vector<double> solved(const NormalEquations& equations) const {
        if (signature_.linear.empty()) { return {1.0}; }
        return equations.solution();
    }

    double linear_cost(const NormalEquations& equations, const std::vector<double>& c) const {
        if (signature_.linear.empty()) { return 0.0; }
        std::vector<const EffectParam*> params;
        for (const std::string_view name : signature_.linear) { params.push_back(&param_of(effect_, name)); }
        return joint_occam_cost_nats(params, c, equations.A);
    }

    static double quick_evidence(const std::vector<Quick>& axes) {
        double evidence = 0.0;
        double best = minus_infinity;
        for (const Quick& axis : axes) {
            const double own = axis.gain_nats - axis.cost_nats;
            evidence += std::max(own, 0.0);
            best = std::max(best, own);
        }
        return best > 0.0 ? evidence : best;
    }

    // Neighbours of a trial along one parameter of its group: the trials' places, if they are there.
    std::array<std::optional<std::size_t>, 2> neighbours(std::size_t trial, std::size_t dimension) const {
        const TrialPoint& centre = trials_[trial].point;
        std::array<std::optional<std::size_t>, 2> found;
        for (std::size_t t = 0; t < trials_.size(); ++t) {
            const TrialPoint& point = trials_[t].point;
            if (point.group != centre.group) { continue; }
            bool same_otherwise = true;
            for (std::size_t i = 0; i < point.index.size(); ++i) {
                same_otherwise = same_otherwise && (i == dimension || point.index[i] == centre.index[i]);
            }
            if (!same_otherwise) { continue; }
            if (point.index[dimension] + 1 == centre.index[dimension]) { found[0] = t; }
            if (point.index[dimension] == centre.index[dimension] + 1) { found[1] = t; }
        }
        return found;
    }

    struct Peak {
        double place;  // in steps from the trial
        double sd;     // in steps
    };

    std::optional<Peak> peak(const std::vector<std::vector<Quick>>& quick, std::size_t trial,
                             std::size_t dimension) const {
        const auto [less, more] = neighbours(trial, dimension);
        const double here = quick_evidence(quick[trial]);
        if (!less || !more) { return std::nullopt; }
        const double fall_less = here - quick_evidence(quick[*less]);
        const double fall_more = here - quick_evidence(quick[*more]);
        const double curvature = fall_less + fall_more;
        if (!(curvature > 0.0)) { return std::nullopt; }
        return Peak{std::clamp(0.5 * (fall_less - fall_more) / curvature, -0.5, 0.5),
                    1.0 / std::sqrt(curvature)};
    }

    ParamValues trial_sd(const std::vector<std::vector<Quick>>& quick, std::size_t trial) const {
        ParamValues sd;
        const TrialPoint& point = trials_[trial].point;
        const std::span<const TrialValues> values = point.values;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i].count < 2 || is_choice(values[i])) { continue; }
            const std::string name(values[i].param);
            const std::optional<Peak> top = peak(quick, trial, i);
            sd[name] =
                step_at(values[i], point.peak, point.params.at(name)) * (top ? std::min(top->sd, 3.0) : 1.0);
        }
        return sd;
    }

    // Parameters on their trial's scale, where a step of 1 is one of the trial values'.
    TrialPoint moved(const TrialPoint& from, const std::vector<double>& steps) const {
        TrialPoint point = from;
        const std::span<const TrialValues> values = from.values;
        std::size_t free = 0;
        for (const TrialValues& trial : values) {
            if (trial.count < 2 || is_choice(trial)) { continue; }
            double& value = point.params[std::string(trial.param)];
            value = moved_value(trial, from.peak, value, steps[free++]);
        }
        return point;
    }

    // A time constant longer than the recording acts as every longer one does. The trials' own are allowed.
    bool is_told(const TrialPoint& point) const {
        return std::ranges::all_of(point.values, [&](const TrialValues& trial) {
            return !trial.param.ends_with("_s") ||
                   point.params.at(std::string(trial.param)) <= std::max(prediction_->duration_s(), trial.to);
        });
    }

    // A parameter of whole numbers, or yes or no: nothing lies between its trial values.
    bool is_choice(const TrialValues& values) const {
        const EffectParam& param = param_of(effect_, values.param);
        return param.whole_up_to != 0.0 || param.range == EffectParam::Range::yes_no || values.count == 2;
    }

    std::size_t free_parameters(const TrialPoint& point) const {
        std::size_t count = 0;
        for (const TrialValues& values : point.values) { count += values.count > 1 && !is_choice(values); }
        return count;
    }

    double evidence_at(const Observation& observation, const Trial& trial) const {
        return quick_evidence(quick_fits(observation, trial));
    }

    double evidence_at(const Observation& observation, const TrialPoint& from,
                       const std::vector<double>& steps) const {
        const TrialPoint point = moved(from, steps);
        if (!is_told(point)) { return minus_infinity; }
        if (effect_refusal(entry_of(with_linear(point.params)))) { return minus_infinity; }
        return evidence_at(observation, simulated(point));
    }

    ParamValues with_linear(ParamValues params) const {
        for (const std::string_view name : signature_.linear) { params[std::string(name)] = 0.0; }
        return params;
    }

    Trial refined(const Observation& observation, const Trial& start) const {
        const std::size_t count = free_parameters(start.point);
        if (count == 0) { return start; }
        const SimplexMaximum maximum = simplex_maximum(
            [&](const std::vector<double>& steps) { return evidence_at(observation, start.point, steps); },
            std::vector<double>(count, 0.0), 0.4, resolution::simplex_width,
            resolution::simplex_simulations_most);
        return polished(observation, simulated(moved(start.point, maximum.at)));
    }

    // Parameters that are known far better than the simplex is fine: by parabolas about as wide as they are
    // known.
    Trial polished(const Observation& observation, Trial trial) const {
        const std::size_t count = free_parameters(trial.point);
        double here = evidence_at(observation, trial);
        for (std::size_t pass = 0; pass < resolution::polishing_passes; ++pass) {
            for (std::size_t i = 0; i < count; ++i) {
                std::optional<double> vertex =
                    parabola_vertex(observation, trial, here, i, resolution::simplex_width);
                if (!vertex) { continue; }
                std::vector<double> steps(count, 0.0);
                steps[i] = *vertex;
                const TrialPoint there_at = moved(trial.point, steps);
                if (!is_told(there_at)) { continue; }
                Trial better = simulated(there_at);
                const double there = evidence_at(observation, better);
                if (!(there > here)) { continue; }
                trial = std::move(better);
                here = there;
            }
        }
        return trial;
    }

    // Of the evidence along one free parameter; none where the simplex is fine enough.
    std::optional<double> parabola_vertex(const Observation& observation, const Trial& trial, double here,
                                          std::size_t free, double width) const {
        for (int narrowing = 0; narrowing < 4; ++narrowing) {
            std::vector<double> less(free_parameters(trial.point), 0.0);
            less[free] = -width;
            std::vector<double> more = less;
            more[free] = width;
            const double below = evidence_at(observation, trial.point, less);
            const double above = evidence_at(observation, trial.point, more);
            const double fall = 2.0 * here - below - above;
            if (!(fall > 2.0 * resolution::fall_polished_nats) || !(fall < 1e300)) { return std::nullopt; }
            const double vertex = 0.5 * width * (above - below) / fall;
            if (std::fabs(vertex) < 0.5 * width || fall < 32.0 * resolution::fall_polished_nats) {
                return vertex;
            }
            width *= 2.0;
        }
        return std::nullopt;
    }

    // From the curvature of the evidence about a point between the trials.
    ParamValues trial_sd_at(const Observation& observation, const Trial& trial) const {
        ParamValues sd;
        const double here = evidence_at(observation, trial);
        std::size_t free = 0;
        for (const TrialValues& values : trial.point.values) {
            if (values.count < 2 || is_choice(values)) { continue; }
            const std::string name(values.param);
            double curvature = 0.0;
            for (const double step : {0.02, 0.06, 0.18, 0.54, 1.6}) {
                std::vector<double> less(free_parameters(trial.point), 0.0);
                less[free] = -step;
                std::vector<double> more = less;
                more[free] = step;
                const double fall = 2.0 * here - evidence_at(observation, trial.point, less) -
                                    evidence_at(observation, trial.point, more);
                if (!(fall < 1e300)) { break; }
                curvature = fall / (step * step);
                if (fall > 0.5) { break; }
            }
            const double sd_steps = curvature > 0.0 ? std::min(1.0 / std::sqrt(curvature), 3.0) : 1.0;
            sd[name] = sd_steps * step_at(values, trial.point.peak, trial.point.params.at(name));
            ++free;
        }
        return sd;
    }

    // What filters the motion filters the noise as well.
    std::vector<SpectralParts> expected_parts(std::size_t axis, const Trial& trial) const {
        std::vector<SpectralParts> parts = prediction_->parts(axis);
        if (signature_.spectrum != nullptr) {
            const EffectModel entry = entry_of(with_linear(trial.point.params));
            signature_.spectrum(prediction_->bin_frequencies_hz(), prediction_->rate_hz(),
                                EffectValues(entry), parts);
        }
        return parts;
    }

    CommonFit beginning(const Observation& observation, const Trial& trial,
                        const std::vector<std::size_t>& axes) const {
        CommonFit fit(!signature_.linear.empty());
        for (const std::size_t axis : axes) {
            fit.add(AxisInTurns(observation, axis, trial.responses[axis], expected_parts(axis, trial)));
        }
        return fit;
    }

    // Slow noise and a slow response take up each other, and turns that begin with one end with it: the best
    // of what both beginnings come to.
    CommonFit common_fit(const Observation& observation, const Trial& trial,
                         const std::vector<std::size_t>& axes) const {
        CommonFit fit = beginning(observation, trial, axes);
        fit.settle();
        if (!fit.has_open_noise()) { return fit; }
        CommonFit without = beginning(observation, trial, axes);
        without.start_without_slow_noise();
        without.settle();
        return without.gain_nats() > fit.gain_nats() ? without : fit;
    }

    AxesFit described(const std::vector<std::size_t>& axes, const Trial& trial, const ParamValues& trial_sd,
                      const CommonFit& fit) const {
        AxesFit described;
        described.axes = axes;
        described.params = trial.point.params;
        described.gain_nats = fit.gains_nats();
        described.cost_nats = linear_cost(fit.equations(), fit.c());
        const std::vector<double> sd = fit.equations().sd();
        for (std::size_t j = 0; j < signature_.linear.size(); ++j) {
            const std::string name(signature_.linear[j]);
            described.params[name] = fit.c()[j];
            described.sd[name] = sd[j];
        }
        described.sd.insert(trial_sd.begin(), trial_sd.end());
        return described;
    }

    std::optional<Finding> fitted(const Observation& observation, const Trial& trial,
                                  const ParamValues& trial_sd) const {
        double common_cost = 0.0;
        for (const auto& [name, sd] : trial_sd) {
            common_cost += occam_cost_nats(param_of(effect_, name), trial.point.params.at(name), sd);
        }
        const std::vector<std::size_t>& axes = prediction_->axes();
        const auto fit_to = [&](const std::vector<std::size_t>& some) {
            return described(some, trial, trial_sd, common_fit(observation, trial, some));
        };
        std::vector<AxesFit> single;
        if (!signature_.whole_sensor || axes.size() == 1) {
            for (const std::size_t axis : axes) { single.push_back(fit_to({axis})); }
        }
        std::optional<AxesFit> shared;
        if (axes.size() > 1) {
            shared = fit_to(axes);
            shared->cost_nats += common_cost;
        }
        return best_of(effect_, single, common_cost, shared);
    }

    void locate(const Observation& observation, Finding& finding) const {
        switch (signature_.place) {
            case PlaceKind::temperature:
                finding.where.temperature = true;
                break;
            case PlaceKind::acceleration:
                finding.where.acceleration = true;
                break;
            case PlaceKind::structure:
                finding.where.structure = signature_.structure;
                break;
            case PlaceKind::time:
                finding.where.time_s = {0.0, prediction_->duration_s()};
                break;
            case PlaceKind::rate:
                locate_rates(finding);
                break;
            default:
                break;
        }
        if (signature_.slow) { locate_times(observation, finding); }
    }

    // Where the response of the first axis has nine tenths of its weight.
    void locate_times(const Observation& observation, Finding& finding) const {
        const std::size_t axis = finding.where.axes.front();
        const std::vector<float>& response = trials_.front().responses[axis].cosines(0);
        const SpectralBins& bins = prediction_->bins();
        std::vector<double> weights;
        double sum = 0.0;
        for (std::size_t i = 0; i < bins.size() && bins[i].end <= response.size(); ++i) {
            double weight = 0.0;
            for (std::size_t k = bins[i].first; k < bins[i].end; ++k) {
                weight += static_cast<double>(response[k]) * static_cast<double>(response[k]);
            }
            weights.push_back(weight / observation.axis(axis).density[i]);
            sum += weights.back();
        }
        double below = 0.0;
        Span band{bins.front().f_hz, bins.front().f_hz};
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (below < 0.05 * sum) { band.from = bins[i].f_hz; }
            if (below < 0.95 * sum) { band.to = bins[i].f_hz; }
            below += weights[i];
        }
        finding.where.tau_s = averaging_times_of(band, 0.5 * prediction_->duration_s());
    }

    double most_rate_rad_s(const Finding& finding) const {
        double most_dps = 0.0;
        for (const EffectModel& entry : finding.entries) {
            most_dps = std::max(most_dps, entry.params.at(std::string(signature_.rates_up_to)));
        }
        return most_dps * rad_per_deg;
    }

    // What is left of the reference's noise where the sensor rests is no rate: without an answer to it the
    // sensor would seem to fit better. Whether half of what the effect changes is at such rates.
    bool is_within_noise(const Finding& finding) const {
        if (signature_.rates_up_to.empty()) { return false; }
        const auto changed = noise_free_response(*prediction_, prediction_->denoised_world(),
                                                 with_cause(prediction_->model(), finding));
        double within = 0.0;
        double beyond = 0.0;
        for (const std::size_t axis : finding.where.axes) {
            const double noise_rad_s = prediction_->rate_sd_rad_s(axis);
            const std::vector<float>& rate_rad_s = prediction_->true_rate_rad_s(axis);
            const std::vector<float>& without = prediction_->denoised_response_rad_s(axis);
            for (std::size_t slot = 0; slot < rate_rad_s.size(); ++slot) {
                const double change_rad_s = static_cast<double>(changed[axis][slot] - without[slot]);
                const bool is_noise = std::fabs(static_cast<double>(rate_rad_s[slot])) < noise_rad_s;
                (is_noise ? within : beyond) += change_rad_s * change_rad_s;
            }
        }
        return within > beyond;
    }

    // Up to the rate that the effect says, or the upper half of all by size.
    void locate_rates(Finding& finding) const {
        if (!signature_.rates_up_to.empty()) {
            finding.where.rate_rad_s = {0.0, most_rate_rad_s(finding)};
            return;
        }
        std::vector<float> sizes;
        for (const std::size_t axis : finding.where.axes) {
            for (const float rate : prediction_->true_rate_rad_s(axis)) { sizes.push_back(std::fabs(rate)); }
        }
        if (sizes.empty()) { return; }
        const auto at = [&](double share) {
            const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(sizes.size() - 1));
            std::ranges::nth_element(sizes, sizes.begin() + place);
            return static_cast<double>(sizes[static_cast<std::size_t>(place)]);
        };
        finding.where.rate_rad_s = {at(0.5), at(1.0)};
    }

    const EffectDefinition& effect_;
    const EffectSignature& signature_;
    std::shared_ptr<const Prediction> prediction_;
    std::vector<Trial> trials_;
};

}  // namespace

MadeEstimator make_mean_response_estimator(const EffectDefinition& effect,
                                           std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<MeanResponseEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
