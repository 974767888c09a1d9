#include "analysis/diagnose/estimators/bias_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/axis_subsets.hpp"
#include "analysis/diagnose/estimators/step_scan.hpp"
#include "analysis/numerics/uniform.hpp"

namespace gyrolog::resolution {

// Of the least that a jump could show in all coefficients, no more than this is left out of the scan.
constexpr double left_out = 0.03;
constexpr std::size_t used_min = 512;
constexpr std::size_t used_max = 16384;
// A jump's power is taken off up to this multiple of the coefficients that the scan uses.
constexpr std::size_t removed_beyond = 16;
constexpr double worth_rescanning_nats = 10.0;
// Closer to an end a jump is a few odd samples.
constexpr std::size_t edge_samples = 16;
// A moment known to fewer places of a scan than this is looked for by a finer one, in the end among the
// samples.
constexpr double places_min = 6.0;
constexpr std::size_t finer_by = 8;
constexpr std::size_t finest_used = 131072;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

class BiasStepEstimator final : public Estimator {
public:
    BiasStepEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), height_(param_of(effect, "step_dps")), prediction_(std::move(prediction)) {
        used_ = resolution::used_min;
        for (const std::size_t axis : prediction_->axes()) {
            used_ = std::max(used_, coefficients_needed(axis));
        }
        while (used_ >= prediction_->length()) { used_ /= 2; }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        StepScan scan(prediction_->length(), used_);
        Seen seen(observation);
        for (const std::size_t axis : prediction_->axes()) {
            seen.density[axis] = observation.axis(axis).density;
            seen.fits[axis] = fit(scan, seen, axis);
        }
        if (!locate(scan, seen) || gain_at(seen, seen.place) < decisions.seen_nats()) { return std::nullopt; }
        // What the jump raised the random walk by is given back; then it may show better elsewhere.
        refit_noise(scan, seen);
        for (int round = 0; round < 2 && total_gain(seen) > resolution::worth_rescanning_nats; ++round) {
            for (const std::size_t axis : prediction_->axes()) { seen.fits[axis] = fit(scan, seen, axis); }
            locate(scan, seen);
            refit_noise(scan, seen);
        }
        return finding_of(scan, seen);
    }

private:
    struct Seen {
        explicit Seen(const Observation& what) : observation(&what) {}

        const Observation* observation;
        std::array<std::vector<double>, 3> density;  // by bin, the jump taken off
        std::array<StepScan::Fit, 3> fits;
        std::array<double, 3> gain_nats{};  // with the noise refitted
        std::size_t place = 0;
    };

    std::size_t coefficients_needed(std::size_t axis) const {
        const std::vector<SpectralParts>& parts = prediction_->parts(axis);
        std::vector<double> beyond(parts.size() + 1, 0.0);  // from this bin on
        for (std::size_t i = parts.size(); i-- > 0;) {
            const SpectralBin& bin = prediction_->bins()[i];
            beyond[i] = beyond[i + 1] + bin.count() / (bin.f_hz * bin.f_hz * parts[i].sum());
        }
        std::size_t used = resolution::used_min;
        for (std::size_t i = 0; i < parts.size() && used < resolution::used_max; ++i) {
            if (beyond[i] < resolution::left_out * beyond.front()) { break; }
            while (used < prediction_->bins()[i].end) { used *= 2; }
        }
        return used;
    }

    StepScan::Fit fit(StepScan& scan, const Seen& seen, std::size_t axis) const {
        std::vector<double> weights(scan.used());
        const std::vector<double>& density = seen.density[axis];
        for (std::size_t i = 0; i < density.size(); ++i) {
            const SpectralBin& bin = prediction_->bins()[i];
            const double weight = 1.0 / (density[i] * prediction_->rate_hz());
            for (std::size_t k = bin.first; k < bin.end && k <= scan.used(); ++k) {
                if (bin.has(k)) { weights[k - 1] = weight; }
            }
        }
        return scan.fit(seen.observation->axis(axis).cosines, weights);
    }

    double height_cost(const Seen& seen, std::size_t axis, std::size_t place) const {
        const double sd_dps = deg_per_rad / std::sqrt(seen.fits[axis].information[place]);
        return occam_cost_nats(height_, 0.0, sd_dps);
    }

    double gain_at(const Seen& seen, std::size_t place) const {
        double sum = 0.0;
        for (const std::size_t axis : prediction_->axes()) { sum += seen.fits[axis].gain_nats(place); }
        return sum;
    }

    // Of a jump there, on the axes that it pays for, at least one.
    double evidence_at(const Seen& seen, std::size_t place) const {
        double sum = 0.0;
        double best = -1e300;
        for (const std::size_t axis : prediction_->axes()) {
            const double evidence = seen.fits[axis].gain_nats(place) - height_cost(seen, axis, place);
            sum += std::max(evidence, 0.0);
            best = std::max(best, evidence);
        }
        return best > 0.0 ? sum : best;
    }

    bool inside(const StepScan& scan, std::size_t place) const {
        const double at = scan.sample_at(place);
        const double edge = std::max(static_cast<double>(resolution::edge_samples), 2.0 * scan.spacing());
        return at > edge && at < static_cast<double>(prediction_->length()) - edge;
    }

    bool locate(const StepScan& scan, Seen& seen) const {
        double best = -1e300;
        for (std::size_t place = 0; place < scan.places(); ++place) {
            if (!inside(scan, place)) { continue; }
            const double evidence = evidence_at(seen, place);
            if (!(evidence > best)) { continue; }
            best = evidence;
            seen.place = place;
        }
        return best > -1e300;
    }

    double total_gain(const Seen& seen) const {
        double sum = 0.0;
        for (const std::size_t axis : prediction_->axes()) { sum += seen.gain_nats[axis]; }
        return sum;
    }

    void refit_noise(const StepScan& scan, Seen& seen) const {
        for (const std::size_t axis : prediction_->axes()) { refit_noise(scan, axis, seen); }
    }

    void refit_noise(const StepScan& scan, std::size_t axis, Seen& seen) const {
        const AxisObservation& observed = seen.observation->axis(axis);
        const double height = seen.fits[axis].height(seen.place);
        const double at = scan.sample_at(seen.place);
        const std::size_t end = std::min(prediction_->length(), resolution::removed_beyond * used_);
        std::vector<double> power = observed.power;
        for (std::size_t i = 0; i < power.size() && prediction_->bins()[i].first < end; ++i) {
            const SpectralBin& bin = prediction_->bins()[i];
            double change = 0.0;
            for (std::size_t k = bin.first; k < std::min(bin.end, end); ++k) {
                if (!bin.has(k)) { continue; }
                const double part = height * step_coefficient(prediction_->length(), at, k);
                change += part * (part - 2.0 * static_cast<double>(observed.cosines[k]));
            }
            power[i] = std::max(0.0, power[i] + change / (bin.count() * prediction_->rate_hz()));
        }
        const std::array<double, 3> sd_rel = noise_uncertainty(prediction_->model(), axis);
        const NoiseNuisance noise =
            fit_nuisance(prediction_->bins(), prediction_->parts(axis), power, sd_rel, observed.noise);
        expected_density(prediction_->parts(axis), sd_rel, noise.z, seen.density[axis]);
        seen.gain_nats[axis] = std::max(0.0, noise.log_likelihood_nats - observed.noise.log_likelihood_nats);
    }

    struct Moment {
        double at = 0.0;     // before this sample
        double sd = 0.0;     // samples
        double width = 0.0;  // samples: integral of the likelihood over its maximum
    };

    // `log_likelihood` at moments `spacing` apart, the first at `first`.
    static Moment moment_of(const std::vector<double>& log_likelihood, double first, double spacing) {
        const auto best = std::ranges::max_element(log_likelihood);
        double weight = 0.0;
        double square = 0.0;
        for (std::size_t i = 0; i < log_likelihood.size(); ++i) {
            const double share = std::exp(log_likelihood[i] - *best);
            const double away = static_cast<double>(i) - static_cast<double>(best - log_likelihood.begin());
            weight += share;
            // Far off it is another jump.
            if (share < 1e-4) { continue; }
            square += share * away * away;
        }
        Moment moment;
        moment.at = first + spacing * static_cast<double>(best - log_likelihood.begin());
        moment.width = weight * spacing;
        moment.sd = spacing * std::sqrt(square / weight + variance_of_uniform(1.0));
        return moment;
    }

    Moment moment(const StepScan& scan, const Seen& seen, const std::vector<std::size_t>& axes) const {
        Moment now = moment_of_scan(scan, seen.fits, axes);
        std::size_t used = scan.used();
        double spacing = scan.spacing();
        while (now.width < resolution::places_min * spacing) {
            const std::size_t most = std::min(resolution::finest_used, prediction_->length() - 1);
            if (used * resolution::finer_by > most) {
                // Single samples belong to both halves' frequencies.
                if (prediction_->half() != Half::both) { return now; }
                return moment_among_samples(seen, axes, now.at, spacing);
            }
            used *= resolution::finer_by;
            StepScan finer_scan(prediction_->length(), used);
            std::array<StepScan::Fit, 3> fits;
            for (const std::size_t axis : axes) { fits[axis] = fit(finer_scan, seen, axis); }
            now = moment_of_scan(finer_scan, fits, axes);
            spacing = finer_scan.spacing();
        }
        return now;
    }

    Moment moment_of_scan(const StepScan& scan, const std::array<StepScan::Fit, 3>& fits,
                          const std::vector<std::size_t>& axes) const {
        std::vector<double> gain(scan.places(), -1e300);
        for (std::size_t place = 0; place < scan.places(); ++place) {
            if (!inside(scan, place)) { continue; }
            gain[place] = 0.0;
            for (const std::size_t axis : axes) { gain[place] += fits[axis].gain_nats(place); }
        }
        return moment_of(gain, scan.sample_at(0), scan.spacing());
    }

    // White noise about the two levels, which are those of the samples around.
    Moment moment_among_samples(const Seen& seen, const std::vector<std::size_t>& axes, double about,
                                double spacing) const {
        const auto half = static_cast<std::size_t>(std::ceil(2.0 * spacing)) + 8;
        const std::size_t length = prediction_->length();
        const auto middle = static_cast<std::size_t>(std::lround(about));
        const std::size_t first = middle > half ? middle - half : 0;
        const std::size_t end = std::min(length, middle + half + 1);
        std::vector<double> likelihood(end - first, 0.0);
        for (const std::size_t axis : axes) {
            const std::vector<float>& samples = seen.observation->axis(axis).residual_rad_s;
            const auto mean = [&](std::size_t from, std::size_t to) {
                double sum = 0.0;
                for (std::size_t i = from; i < to; ++i) { sum += static_cast<double>(samples[i]); }
                return to > from ? sum / static_cast<double>(to - from) : 0.0;
            };
            const double before = mean(first > 8 * half ? first - 8 * half : 0, first);
            const double after = mean(end, std::min(length, end + 8 * half));
            const double height = after - before;
            const double variance = seen.density[axis].back() * prediction_->rate_hz();
            double sum = 0.0;
            for (std::size_t i = end; i-- > first;) {
                sum += height * (static_cast<double>(samples[i]) - 0.5 * (before + after)) / variance;
                likelihood[i - first] += sum;
            }
        }
        return moment_of(likelihood, static_cast<double>(first), 1.0);
    }

    // Of axes that jump by heights of their own, or all by the same.
    AxesFit own_fit(const Seen& seen, std::size_t axis) const {
        const double sd_dps = deg_per_rad / std::sqrt(seen.fits[axis].information[seen.place]);
        AxesFit fit;
        fit.axes = {axis};
        fit.gain_nats = {seen.gain_nats[axis]};
        fit.params = {{"step_dps", seen.fits[axis].height(seen.place) * deg_per_rad}};
        fit.sd = {{"step_dps", sd_dps}};
        fit.cost_nats =
            occam_cost_nats(height_, 0.0, sd_dps) + axis_membership_nats(prediction_->axes().size());
        return fit;
    }

    AxesFit shared_fit(const Seen& seen) const {
        double pull = 0.0;
        double information = 0.0;
        for (const std::size_t axis : prediction_->axes()) {
            pull += seen.fits[axis].pull[seen.place];
            information += seen.fits[axis].information[seen.place];
        }
        const double height = pull / information;
        const double sd_dps = deg_per_rad / std::sqrt(information);
        AxesFit fit;
        fit.axes = prediction_->axes();
        for (const std::size_t axis : fit.axes) {
            const double off = seen.fits[axis].height(seen.place) - height;
            fit.gain_nats.push_back(seen.gain_nats[axis] -
                                    0.5 * off * off * seen.fits[axis].information[seen.place]);
        }
        fit.params = {{"step_dps", height * deg_per_rad}};
        fit.sd = {{"step_dps", sd_dps}};
        fit.cost_nats =
            occam_cost_nats(height_, 0.0, sd_dps) + axis_membership_nats(prediction_->axes().size());
        return fit;
    }

    std::optional<Finding> finding_of(const StepScan& scan, const Seen& seen) const {
        std::vector<AxesFit> own;
        for (const std::size_t axis : prediction_->axes()) { own.push_back(own_fit(seen, axis)); }
        std::optional<AxesFit> shared;
        if (own.size() > 1) { shared = shared_fit(seen); }
        std::optional<Finding> finding = best_of(effect_, own, 0.0, shared);
        if (!finding) { return std::nullopt; }
        const Moment when = moment(scan, seen, finding->where.axes);
        // A sample at the moment itself has jumped already.
        const double at_s = (when.at - 0.5) / prediction_->rate_hz();
        finding->evidence_nats -=
            std::max(0.5, std::log(static_cast<double>(prediction_->length()) / when.width));
        finding->parameters += 1;
        for (std::size_t i = 0; i < finding->entries.size(); ++i) {
            finding->entries[i].params["at_s"] = at_s;
            finding->sd[i]["at_s"] = when.sd / prediction_->rate_hz();
        }
        finding->where.time_s = Span{at_s, at_s};
        return finding;
    }

    const EffectDefinition& effect_;
    const EffectParam& height_;
    std::shared_ptr<const Prediction> prediction_;
    std::size_t used_ = resolution::used_min;
};

}  // namespace

MadeEstimator make_bias_step_estimator(const EffectDefinition& effect,
                                       std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<BiasStepEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
