#include "analysis/diagnose/calibration/measured_gap.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/diagnose/calibration/replicates.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/measures/gap_curves.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/square.hpp"

namespace gyrolog {

namespace {

using Curves = std::vector<GapCurve>;

std::vector<GapCurve> seen_under(const std::shared_ptr<const Prediction>& prediction,
                                 const std::shared_ptr<const Recording>& recording, std::uint64_t seed,
                                 Observation::ReferenceNoise noise) {
    std::vector<GapCurve> curves = gap_curves(Observation(prediction, recording, seed, noise));
    if (prediction->half() != Half::both) {
        std::erase_if(curves, [](const GapCurve& curve) { return !curve.measure->in_halves; });
    }
    return curves;
}

// `curves` in the order of `like`; of a curve that is not there, nothing differs.
Curves matched(const Curves& curves, const Curves& like) {
    Curves result = like;
    for (GapCurve& one : result) {
        const auto same =
            std::ranges::find_if(curves, [&](const GapCurve& other) { return are_alike(one, other); });
        if (same != curves.end()) { one.value = same->value; }
    }
    return result;
}

// By curve and point, the mean over pairs of what `a` has more than `b`.
using Difference = std::vector<std::vector<double>>;

Difference mean_difference(const std::vector<Curves>& a, const std::vector<Curves>& b) {
    Difference mean;
    for (std::size_t c = 0; c < a.front().size(); ++c) {
        std::vector<double> of_curve(a.front()[c].value.size(), 0.0);
        for (std::size_t i = 0; i < a.size(); ++i) {
            for (std::size_t p = 0; p < of_curve.size(); ++p) {
                of_curve[p] += (a[i][c].value[p] - b[i][c].value[p]) / static_cast<double>(a.size());
            }
        }
        mean.push_back(std::move(of_curve));
    }
    return mean;
}

void shift(GapReference& reference, const Difference& by) {
    for (std::size_t c = 0; c < by.size(); ++c) {
        for (std::size_t p = 0; p < by[c].size(); ++p) { reference.mean[c][p] += by[c][p]; }
    }
}

// What the surprisal of one part of the data is made of.
struct Surprisal {
    double nats = 0.0;
    double largest_nats = 0.0;  // of one measure

    void add(double of_measure_nats) {
        nats += of_measure_nats;
        largest_nats = std::max(largest_nats, of_measure_nats);
    }
};

// One model, with which simulations of the corrected model are paired.
struct PairedModel {
    SensorModel model;
    std::vector<std::shared_ptr<const Prediction>> views;  // by fold
    std::vector<std::vector<Curves>> own;                  // by fold, by pair: its simulations under itself
    std::vector<std::vector<Curves>> of_corrected;         // the corrected model's under it
};

class GapMeter {
public:
    GapMeter(const GapTrial& trial, const MeasuredGapOptions& options) : trial_(trial), options_(options) {
        corrected_ = trial.without_causes;
        for (const Finding& cause : trial.causes) { corrected_ = with_cause(std::move(corrected_), cause); }
        add_paired(trial.folds.front().given->model());
        for (std::size_t i = 0; i < trial.causes.size(); ++i) { add_paired(without(whole_fit(), i)); }
        for (const Fold& fold : trial.folds) {
            views_.push_back(fold.given->with(corrected_));
            add_paired(without(fold.causes, trial.causes.size()));
        }
        for (const Fold& fold : trial.folds) {
            if (trial.unnamed > 0) { add_paired(without(named_of(fold), trial.causes.size())); }
        }
    }

    std::optional<MeasuredGap> run() {
        if (!simulate()) { return std::nullopt; }
        for (std::size_t f = 0; f < folds(); ++f) { calibrate(f); }
        MeasuredGap gap;
        gap.floor_nats = floor_nats_;
        const Surprisal before = of_recording(
            [&](std::size_t f) { return std::pair(paired_[given_].views[f], shift_of(given_, f)); });
        const auto with_models = [&](auto model_of_fold) {
            return of_recording([&](std::size_t f) {
                const std::size_t model = model_of_fold(f);
                return std::pair(paired_[model].views[f], shift_of(model, f));
            });
        };
        const Surprisal after = with_models([&](std::size_t f) { return fold_model(f); });
        const Surprisal named =
            trial_.unnamed == 0 ? after : with_models([&](std::size_t f) { return named_model(f); });
        const double before_nats = before.nats + trial_.stamps_before_nats;
        const double judged_nats =
            no_cause_holds() ? before_nats : std::max(before_nats, floor_nats_ + floor_sd_nats_);
        const double named_nats = named.nats + trial_.stamps_named_nats;
        const double after_nats = after.nats + trial_.stamps_named_nats;
        gap.before = gap_of_nats(before_nats, before);
        gap.judged = gap_of_nats(judged_nats, before);
        gap.named = gap_of_nats(named_nats, named);
        gap.after = gap_of_nats(after_nats, after);
        gap.excess_nats = std::max(judged_nats - floor_nats_, floor_sd_nats_);
        gap.shrink = shrink(named_nats, named, gap.excess_nats);
        gap.shrink_modelled = shrink(after_nats, after, gap.excess_nats);
        for (std::size_t i = 0; i < trial_.causes.size(); ++i) {
            const Surprisal left_out = of_recording([&](std::size_t f) { return view_without(i, f); });
            const double stamps_nats = stamps_without_nats(i);
            const double returning_nats = left_out.nats - after.nats + stamps_nats;
            gap.returning_nats.push_back(returning_nats);
            gap.shares.push_back(share(returning_nats, left_out, gap.excess_nats));
        }
        return gap;
    }

private:
    static constexpr std::size_t given_ = 0;
    std::size_t folds() const { return trial_.folds.size(); }
    static std::size_t model_without(std::size_t cause) { return 1 + cause; }
    std::size_t fold_model(std::size_t fold) const { return 1 + trial_.causes.size() + fold; }
    std::size_t named_model(std::size_t fold) const { return fold_model(folds() + fold); }

    // For the data that judge: every cause is an event of other data.
    bool no_cause_holds() const {
        return !trial_.causes.empty() && std::ranges::none_of(trial_.folds, [](const Fold& fold) {
            return std::ranges::any_of(fold.causes, [](const auto& cause) { return cause.has_value(); });
        });
    }

    std::vector<std::optional<Finding>> named_of(const Fold& fold) const {
        return {fold.causes.begin(), fold.causes.end() - static_cast<std::ptrdiff_t>(trial_.unnamed)};
    }

    std::vector<std::optional<Finding>> whole_fit() const {
        return {trial_.causes.begin(), trial_.causes.end()};
    }

    SensorModel without(const std::vector<std::optional<Finding>>& causes, std::size_t left_out) const {
        SensorModel model = trial_.without_causes;
        for (std::size_t i = 0; i < causes.size(); ++i) {
            if (i != left_out && causes[i]) { model = with_cause(std::move(model), *causes[i]); }
        }
        return model;
    }

    void add_paired(SensorModel model) {
        PairedModel paired;
        for (const Fold& fold : trial_.folds) { paired.views.push_back(fold.given->with(model)); }
        paired.model = std::move(model);
        paired.own.assign(folds(), std::vector<Curves>(options_.paired_simulations));
        paired.of_corrected = paired.own;
        paired_.push_back(std::move(paired));
    }

    std::shared_ptr<const Recording> replicate(const SensorModel& model, std::uint64_t seed) const {
        return std::make_shared<const Recording>(replicate_recording(*views_.front(), model, seed));
    }

    bool simulate() {
        simulated_.assign(folds(), std::vector<Curves>(options_.simulations));
        const std::size_t pairs = options_.paired_simulations;
        const ReplicateOptions draws{options_.simulations + paired_.size() * pairs, options_.seed,
                                     RandomPurpose::measured_gap_simulations, options_.threads,
                                     options_.on_progress};
        const bool done = for_each_replicate(draws, [&](std::size_t task, std::uint64_t) {
            const bool of_corrected = task < options_.simulations;
            const std::size_t i = of_corrected ? task : (task - options_.simulations) % pairs;
            const std::uint64_t seed =
                derived_seed(options_.seed, RandomPurpose::measured_gap_simulations, i);
            if (of_corrected) {
                simulate_corrected(i, seed);
            } else {
                simulate_paired(paired_[(task - options_.simulations) / pairs], i, seed);
            }
        });
        if (done) { match_all(); }
        return done;
    }

    void simulate_corrected(std::size_t i, std::uint64_t seed) {
        const auto recording = replicate(corrected_, seed);
        const auto seen = [&](const std::shared_ptr<const Prediction>& view) {
            return seen_under(view, recording, seed, Observation::ReferenceNoise::drawn);
        };
        for (std::size_t f = 0; f < folds(); ++f) {
            simulated_[f][i] = seen(views_[f]);
            if (i >= options_.paired_simulations) { continue; }
            for (PairedModel& paired : paired_) { paired.of_corrected[f][i] = seen(paired.views[f]); }
        }
    }

    void simulate_paired(PairedModel& paired, std::size_t i, std::uint64_t seed) const {
        const auto own = replicate(paired.model, seed);
        for (std::size_t f = 0; f < folds(); ++f) {
            paired.own[f][i] = seen_under(paired.views[f], own, seed, Observation::ReferenceNoise::drawn);
        }
    }

    void match_all() {
        for (std::size_t f = 0; f < folds(); ++f) {
            const Curves& like = simulated_[f].front();
            for (Curves& curves : simulated_[f]) { curves = matched(curves, like); }
            for (PairedModel& paired : paired_) {
                for (Curves& curves : paired.own[f]) { curves = matched(curves, like); }
                for (Curves& curves : paired.of_corrected[f]) { curves = matched(curves, like); }
            }
        }
    }

    // How a model's simulations under itself differ from the corrected model's under itself.
    Difference shift_of(std::size_t model, std::size_t fold) const {
        const std::vector<Curves> corrected(
            simulated_[fold].begin(),
            simulated_[fold].begin() + static_cast<std::ptrdiff_t>(options_.paired_simulations));
        return mean_difference(paired_[model].own[fold], corrected);
    }

    // The causes' directions, and what simulations of the corrected model have along them and in all.
    void calibrate(std::size_t fold) {
        references_.push_back(gap_reference(simulated_[fold]));
        std::vector<Difference> directions;
        for (std::size_t model = 0; model <= trial_.causes.size(); ++model) {
            Difference along = mean_difference(paired_[model].of_corrected[fold], paired_[model].own[fold]);
            for (std::size_t c = 0; c < along.size(); ++c) {
                const bool is_normal = simulated_[fold].front()[c].measure->is_normal_far_out;
                for (std::size_t p = 0; p < along[c].size(); ++p) {
                    along[c][p] *= is_normal ? 1.0 / references_[fold].sd[c][p] : 0.0;
                }
            }
            directions.push_back(std::move(along));
        }
        directions_.push_back(std::move(directions));
        std::vector<double> direction_sd;
        for (std::size_t d = 0; d < directions_[fold].size(); ++d) {
            direction_sd.push_back(sd_along(fold, d));
        }
        direction_sd_.push_back(std::move(direction_sd));
        add_floor(fold);
    }

    double sd_along(std::size_t fold, std::size_t direction) const {
        double variance = 0.0;
        for (const Curves& curves : simulated_[fold]) {
            variance += square(along(curves, references_[fold], fold, direction)) /
                        (static_cast<double>(options_.simulations) - 1.0);
        }
        const Difference& weights = directions_[fold][direction];
        for (std::size_t c = 0; c < weights.size(); ++c) {
            for (std::size_t p = 0; p < weights[c].size(); ++p) {
                variance += square(weights[c][p]) * references_[fold].missing[c][p];
            }
        }
        return std::sqrt(variance);
    }

    void add_floor(std::size_t fold) {
        const auto count = static_cast<double>(options_.simulations);
        double sum = 0.0;
        double squares = 0.0;
        for (std::size_t i = 0; i < options_.simulations; ++i) {
            const Surprisal one = surprisal(simulated_[fold][i], gap_reference(simulated_[fold], i), fold);
            sum += one.nats;
            squares += square(one.nats);
        }
        floor_nats_ += sum / count;
        const double variance = std::max(squares / count - square(sum / count), 0.0);
        floor_sd_nats_ = std::hypot(floor_sd_nats_, std::sqrt(variance));
    }

    double along(const Curves& curves, const GapReference& reference, std::size_t fold,
                 std::size_t direction) const {
        double sum = 0.0;
        const Difference& weights = directions_[fold][direction];
        for (std::size_t c = 0; c < curves.size(); ++c) {
            for (std::size_t p = 0; p < curves[c].value.size(); ++p) {
                sum += weights[c][p] * (curves[c].value[p] - reference.mean[c][p]) / reference.sd[c][p];
            }
        }
        return sum;
    }

    Surprisal surprisal(const Curves& curves, const GapReference& reference, std::size_t fold) const {
        Surprisal sum;
        for (const double nats : measure_surprises_nats(curves, reference)) { sum.add(nats); }
        double farthest = 0.0;
        for (std::size_t d = 0; d < directions_[fold].size(); ++d) {
            const double sd = direction_sd_[fold][d];
            if (sd > 0.0) {
                farthest = std::max(farthest, std::fabs(along(curves, reference, fold, d)) / sd);
            }
        }
        const double tries = std::log(static_cast<double>(directions_[fold].size()));
        sum.add(std::max(0.5 * square(farthest) - tries, 0.0));
        return sum;
    }

    // `of(fold)`: the view, and how its simulations differ from the corrected model's.
    template <typename Of>
    Surprisal of_recording(Of of) const {
        Surprisal sum;
        for (std::size_t f = 0; f < folds(); ++f) {
            const auto [view, by] = of(f);
            GapReference reference = references_[f];
            shift(reference, by);
            const Curves curves = matched(
                seen_under(view, trial_.recording, options_.seed, Observation::ReferenceNoise::recorded),
                simulated_[f].front());
            const Surprisal one = surprisal(curves, reference, f);
            sum.nats += one.nats;
            sum.largest_nats += one.largest_nats;
        }
        return sum;
    }

    std::pair<std::shared_ptr<const Prediction>, Difference> view_without(std::size_t cause,
                                                                          std::size_t fold) const {
        Difference by = shift_of(fold_model(fold), fold);
        const Difference more = shift_of(model_without(cause), fold);
        for (std::size_t c = 0; c < by.size(); ++c) {
            for (std::size_t p = 0; p < by[c].size(); ++p) { by[c][p] += more[c][p]; }
        }
        const Fold& of = trial_.folds[fold];
        return {of.given->with(without(of.causes, cause)), std::move(by)};
    }

    double stamps_without_nats(std::size_t cause) const {
        const Finding& finding = trial_.causes[cause];
        return traits_of(finding.effect).is_in_stamps ? std::max(finding.evidence_nats, 0.0) : 0.0;
    }

    // The root of the sum: what exceeds the floor is the square of a distance, which chance moves by 1, seen
    // by so many measures at once; `other_sd_nats` is chance's part beside it.
    static double half_interval_nats(double excess_nats, const Surprisal& of, double other_sd_nats) {
        const double measures = of.largest_nats > 0.0 ? std::max(of.nats / of.largest_nats, 1.0) : 1.0;
        return normal_quantile(0.975) *
               std::sqrt(square(other_sd_nats) + 2.0 * measures * std::max(excess_nats, 0.0));
    }

    Gap gap_of_nats(double nats, const Surprisal& of) const {
        const double half = half_interval_nats(nats - floor_nats_, of, floor_sd_nats_);
        const auto distance = [&](double at) { return std::sqrt(std::max(at, 0.0) / floor_nats_); };
        return {distance(nats), 1.0, distance(nats - half), distance(nats + half)};
    }

    Share shrink(double named_nats, const Surprisal& named, double excess_nats) const {
        const double left_nats = named_nats - floor_nats_;
        const double half = half_interval_nats(left_nats, named, floor_sd_nats_);
        const auto closed = [&](double left) { return std::min(1.0 - left / excess_nats, 1.0); };
        return {closed(left_nats), closed(left_nats + half), closed(left_nats - half)};
    }

    // The difference of two surprisals of the same data: of chance's part only the distance's 1 is left.
    static Share share(double returning_nats, const Surprisal& of, double excess_nats) {
        const double half = half_interval_nats(returning_nats, of, 1.0);
        // Causes that hide each other return more than the gap was.
        const auto part = [&](double nats) { return std::min(nats / excess_nats, 1.0); };
        return {part(returning_nats), part(returning_nats - half), part(returning_nats + half)};
    }

    const GapTrial& trial_;
    const MeasuredGapOptions& options_;
    SensorModel corrected_;
    std::vector<std::shared_ptr<const Prediction>> views_;  // of the corrected model, by fold
    std::vector<PairedModel> paired_;             // the given one, those without one cause, the folds' own
    std::vector<std::vector<Curves>> simulated_;  // by fold, by simulation: of the corrected model
    std::vector<GapReference> references_;        // by fold
    std::vector<std::vector<Difference>> directions_;  // by fold: all causes', then each one's
    std::vector<std::vector<double>> direction_sd_;
    double floor_nats_ = 0.0;
    double floor_sd_nats_ = 0.0;
};

}  // namespace

std::optional<MeasuredGap> measure_gap(const GapTrial& trial, const MeasuredGapOptions& options) {
    return GapMeter(trial, options).run();
}

}  // namespace gyrolog
