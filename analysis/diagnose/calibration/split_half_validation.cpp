#include "analysis/diagnose/calibration/split_half_validation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

namespace {

// Of a cause in a half: less tells nothing of what the other half's fit leaves.
constexpr double seen_nats = 3.0;
// What a half calls for beyond the other's fit is more than chance.
constexpr double left_nats = 3.0;

// Of what one fit leaves in the other half, beyond what its own error does by chance.
constexpr double sds = 3.0;

// What is slow lies in few coefficients, which may all be in one half.
bool can_be_halved(const std::string& effect, const Prediction& prediction) {
    return !find_effect(effect)->signature->slow && traits_of(effect, prediction).can_be_halved;
}

// One half of one recording.
class HalfView {
public:
    HalfView(std::shared_ptr<const Prediction> prediction, std::shared_ptr<const Recording> recording,
             std::uint64_t seed)
        : prediction_(std::move(prediction)), recording_(std::move(recording)), seed_(seed) {}

    // The best that the effect can do beyond the causes, or all of them but one.
    std::optional<Finding> find(const std::string& effect, const std::vector<std::optional<Finding>>& causes,
                                std::size_t but) const {
        SensorModel model = prediction_->model();
        for (std::size_t i = 0; i < causes.size(); ++i) {
            if (i != but && causes[i]) { model = with_cause(std::move(model), *causes[i]); }
        }
        const std::shared_ptr<const Prediction> with = prediction_->with(model);
        const MadeEstimator made = make_estimator(*find_effect(effect), with);
        return made.estimator ? made.estimator->find(Observation(with, recording_, seed_)) : std::nullopt;
    }

    // `whole`: what was found in the whole recording. Causes that cannot be halved stay as they are there.
    std::vector<std::optional<Finding>> fitted(const std::vector<Finding>& whole) const {
        std::vector<std::optional<Finding>> causes(whole.size());
        for (std::size_t i = 0; i < whole.size(); ++i) {
            if (!halved(whole[i])) { causes[i] = whole[i]; }
        }
        // Once more with all the others in the model.
        for (int pass = 0; pass < (whole.size() > 1 ? 2 : 1); ++pass) {
            for (std::size_t i = 0; i < whole.size(); ++i) {
                if (halved(whole[i])) { causes[i] = find(whole[i].effect, causes, i); }
            }
        }
        return causes;
    }

    bool halved(const Finding& finding) const { return can_be_halved(finding.effect, *prediction_); }

private:
    std::shared_ptr<const Prediction> prediction_;
    std::shared_ptr<const Recording> recording_;
    std::uint64_t seed_;
};

// The gain of a new fit to one half where the other's is in the model: for each parameter half the square of
// a normal deviate, as much wider as the other's uncertainty makes it.
struct ChanceGain {
    double mean_nats = 0.0;
    double variance = 0.0;
};

ChanceGain chance_gain(const Finding& own, const Finding& other) {
    ChanceGain chance;
    for (std::size_t entry = 0; entry < own.entries.size(); ++entry) {
        for (const auto& [name, sd] : own.sd[entry]) {
            double ratio = 1.0;
            for (std::size_t i = 0; i < other.entries.size(); ++i) {
                const bool same_axes =
                    other.entries[i].axes == own.entries[entry].axes || other.entries.size() == 1;
                const auto of_other = other.sd[i].find(name);
                if (same_axes && of_other != other.sd[i].end() && sd > 0.0) { ratio = of_other->second / sd; }
            }
            const double widened = 1.0 + ratio * ratio;
            chance.mean_nats += 0.5 * widened;
            chance.variance += 0.5 * widened * widened;
        }
    }
    return chance;
}

// Of one cause.
struct Left {
    bool judged = false;
    double evidence_nats = -1e300;
    double nats = 0.0;  // in excess of chance
};

std::vector<Left> left_in(const HalfView& half, const std::vector<Finding>& whole,
                          const std::vector<std::optional<Finding>>& fits_of_other) {
    std::vector<Left> left(whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        if (!half.halved(whole[i]) || !fits_of_other[i]) { continue; }
        const double other_nats = fits_of_other[i]->gain_nats;
        const std::optional<Finding> own = half.find(whole[i].effect, fits_of_other, i);
        const double own_nats = own ? own->gain_nats : 0.0;
        const std::optional<Finding> more = half.find(whole[i].effect, fits_of_other, whole.size());
        const double more_nats = more ? more->gain_nats : 0.0;
        left[i].judged = other_nats > seen_nats && std::max(own_nats, more_nats) > seen_nats;
        if (!left[i].judged || !more) { continue; }
        left[i].evidence_nats = more->evidence_nats;
        if (more->evidence_nats < left_nats) { continue; }
        const ChanceGain chance = chance_gain(own ? *own : *more, *fits_of_other[i]);
        if (more->gain_nats < chance.mean_nats + sds * std::sqrt(chance.variance)) { continue; }
        // Of the difference of two fits, the share that the better one is off.
        left[i].nats = (more->gain_nats - chance.mean_nats) / (1.0 + own_nats / other_nats);
    }
    return left;
}

}  // namespace

SplitHalfResult validate_by_halves(const std::shared_ptr<const Prediction>& prediction,
                                   const std::shared_ptr<const Recording>& recording,
                                   const std::vector<Finding>& causes, std::uint64_t seed, unsigned threads) {
    const std::array<HalfView, 2> halves = {HalfView(prediction->of_half(Half::first), recording, seed),
                                            HalfView(prediction->of_half(Half::second), recording, seed)};
    std::array<std::vector<std::optional<Finding>>, 2> fits;
    parallel_for(2, threads, [&](std::size_t half) { fits.at(half) = halves.at(half).fitted(causes); });
    std::array<std::vector<Left>, 2> left;
    parallel_for(2, threads, [&](std::size_t half) {
        left.at(half) = left_in(halves.at(half), causes, fits.at(1 - half));
    });
    SplitHalfResult result;
    double most_nats = -1e300;
    for (std::size_t i = 0; i < causes.size(); ++i) {
        const Left& a = left[0][i];
        const Left& b = left[1][i];
        if (a.judged || b.judged) { result.judged.push_back(causes[i].effect); }
        most_nats = std::max({most_nats, a.evidence_nats, b.evidence_nats});
        result.excess_nats += std::max(a.nats, b.nats);
    }
    result.evidence_left_nats = std::max(most_nats, 0.0);
    return result;
}

}  // namespace gyrolog
