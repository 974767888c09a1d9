#include "analysis/noise/curve_diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "analysis/noise/curve_scatter.hpp"
#include "analysis/numerics/least_squares.hpp"
#include "analysis/numerics/matrix_products.hpp"
#include "analysis/numerics/pseudo_inverse.hpp"

namespace gyrolog {
namespace {

using Kind = CurveTerm::Kind;

constexpr double margin_to_enter = 10.0;
constexpr double margin_to_stay = 2.0;
// A size of which none at all lies within a standard deviation is none that the curve shows.
constexpr double margin_to_be_seen = 1.0;
constexpr std::size_t changes_max = 6;
constexpr double first_smooth_sd_db = 0.3;
constexpr int rounds = 3;        // of fit and scatter
constexpr double coarse = 1e-3;  // tolerance of a fit that is only one of many starts
constexpr std::array all_kinds = {Kind::N,       Kind::B, Kind::K, Kind::Q, Kind::R, Kind::gauss_markov,
                                  Kind::sinusoid};

double total_variance(const std::vector<CurveTerm>& terms, double tau_s) {
    double sum = 0.0;
    for (const CurveTerm& term : terms) { sum += term.allan_variance(tau_s); }
    return sum;
}

struct Target {
    std::vector<double> tau_s;
    std::vector<double> deviation;

    explicit Target(const AllanCurve& curve) {
        for (const AllanPoint& point : curve.points) {
            if (!(point.deviation > 0.0 && point.tau_s > 0.0)) { continue; }
            tau_s.push_back(point.tau_s);
            deviation.push_back(point.deviation);
        }
    }

    std::vector<double> residuals_db(const std::vector<CurveTerm>& terms) const {
        std::vector<double> residuals;
        residuals.reserve(tau_s.size());
        for (std::size_t i = 0; i < tau_s.size(); ++i) {
            const double model = std::max(total_variance(terms, tau_s[i]), 1e-300);
            residuals.push_back(variance_db_per_neper * (2.0 * std::log(deviation[i]) - std::log(model)));
        }
        return residuals;
    }
};

CurveResidual residual_of(const Target& target, const std::vector<CurveTerm>& terms) {
    const std::vector<double> residuals = target.residuals_db(terms);
    CurveResidual residual;
    residual.rms_db = std::sqrt(dot(residuals, residuals) / static_cast<double>(residuals.size()));
    const auto worst = std::ranges::max_element(residuals, {}, [](double db) { return std::abs(db); });
    residual.worst_db = *worst;
    residual.worst_tau_s = target.tau_s[static_cast<std::size_t>(worst - residuals.begin())];
    return residual;
}

// A term of the description, and how free it is.
struct Slot {
    ModelledTerm modelled;
    bool in_model = true;
    bool changed = false;  // free without a prior; true for all that are not in the model
    CurveTerm now{};
    bool unseen = false;  // changed to none of it

    bool is_free() const { return !unseen && (changed || modelled.sd_rel > 0.0); }
    bool frees_shape() const { return !in_model && has_shape(now.kind); }
};

std::vector<CurveTerm> terms_of(const std::vector<Slot>& slots) {
    std::vector<CurveTerm> terms;
    terms.reserve(slots.size());
    for (const Slot& slot : slots) { terms.push_back(slot.now); }
    return terms;
}

std::vector<double> logarithms_of(const std::vector<Slot>& slots) {
    std::vector<double> logs;
    for (const Slot& slot : slots) {
        if (slot.is_free()) { logs.push_back(std::log(slot.now.size)); }
        if (slot.frees_shape()) { logs.push_back(std::log(slot.now.shape)); }
    }
    return logs;
}

void put_logarithms(std::vector<Slot>& slots, std::span<const double> logs) {
    std::size_t at = 0;
    for (Slot& slot : slots) {
        if (slot.is_free()) { slot.now.size = std::exp(std::clamp(logs[at++], -100.0, 100.0)); }
        if (slot.frees_shape()) { slot.now.shape = std::exp(std::clamp(logs[at++], -30.0, 30.0)); }
    }
}

// Departures of sizes from the model's, in stated standard deviations.
std::vector<double> prior_residuals(const std::vector<Slot>& slots) {
    std::vector<double> residuals;
    for (const Slot& slot : slots) {
        if (slot.changed || !(slot.modelled.sd_rel > 0.0)) { continue; }
        residuals.push_back(std::log(slot.now.size / slot.modelled.term.size) / slot.modelled.sd_rel);
    }
    return residuals;
}

// Of unit variance, over the logarithms of what is free.
LeastSquaresProblem problem_of(const Target& target, const CurveScatter& scatter,
                               const std::vector<Slot>& slots, double smooth_sd_db) {
    LeastSquaresProblem problem;
    problem.residuals = target.tau_s.size() + prior_residuals(slots).size();
    problem.evaluate = [&, smooth_sd_db](std::span<const double> logs, std::span<double> residuals) {
        std::vector<Slot> here = slots;
        put_logarithms(here, logs);
        const std::vector<double> of_curve =
            scatter.whitened(target.residuals_db(terms_of(here)), smooth_sd_db);
        const auto rest = std::ranges::copy(of_curve, residuals.begin()).out;
        std::ranges::copy(prior_residuals(here), rest);
    };
    return problem;
}

struct Judged {
    std::vector<Slot> slots;
    double criterion = std::numeric_limits<double>::infinity();
    double smooth_sd_db = first_smooth_sd_db;
};

class ChangeSearch {
public:
    ChangeSearch(const Target& target, const std::vector<ModelledTerm>& model, double reading_sd_db)
        : target_(target), scatter_(target.tau_s, reading_sd_db) {
        std::vector<Slot> slots;
        for (const ModelledTerm& modelled : model) {
            if (modelled.term.size > 0.0) { slots.push_back({modelled, true, false, modelled.term}); }
        }
        now_ = fitted(std::move(slots), first_smooth_sd_db, rounds);
    }

    void run() {
        while (changes() < changes_max && make_best_change()) { take_back_idle_changes(); }
        take_out_unseen();
    }

    const Judged& result() const { return now_; }

    // The result without that slot's change.
    Judged without(std::size_t slot) const {
        std::vector<Slot> slots = now_.slots;
        take_back(slots, slot);
        return fitted(std::move(slots), now_.smooth_sd_db, rounds);
    }

    // The best change of every kind that a description may have made instead.
    std::vector<Judged> alternatives(const Judged& from) const {
        std::vector<Judged> found;
        for (const Kind kind : all_kinds) {
            Judged with = with_change(from, kind);
            if (std::isfinite(with.criterion)) { found.push_back(std::move(with)); }
        }
        return found;
    }

    // Standard deviations of the logarithms, in the order of logarithms_of().
    std::vector<double> log_sd() const {
        const std::vector<double> logs = logarithms_of(now_.slots);
        if (logs.empty()) { return {}; }
        const LeastSquaresProblem problem = problem_of(target_, scatter_, now_.slots, now_.smooth_sd_db);
        const Matrix derivatives = central_differences(problem, logs, 1e-10);
        const Matrix covariance = pseudo_inverse(transposed_product(derivatives, derivatives));
        std::vector<double> sd;
        for (std::size_t i = 0; i < covariance.rows(); ++i) {
            sd.push_back(std::sqrt(std::max(covariance(i, i), 0.0)));
        }
        return sd;
    }

private:
    std::size_t changes() const {
        return static_cast<std::size_t>(std::ranges::count_if(now_.slots, &Slot::changed));
    }

    static void take_back(std::vector<Slot>& slots, std::size_t slot) {
        if (slots[slot].in_model) {
            slots[slot].changed = slots[slot].unseen = false;
            slots[slot].now = slots[slot].modelled.term;
        } else {
            slots.erase(slots.begin() + static_cast<std::ptrdiff_t>(slot));
        }
    }

    // Fit and scatter in turns, which together climb the likelihood of both; a single turn is coarse.
    Judged fitted(std::vector<Slot> slots, double smooth_sd_db, int turns) const {
        Judged judged{std::move(slots), 0.0, smooth_sd_db};
        CurveScatter::Fit scatter;
        for (int turn = 0; turn < turns; ++turn) {
            const std::vector<double> start = logarithms_of(judged.slots);
            if (!start.empty()) {
                LeastSquaresLimits limits;
                limits.evaluations_most = 300;
                if (turns == 1) { limits.tolerance = coarse; }
                const LeastSquaresProblem problem =
                    problem_of(target_, scatter_, judged.slots, judged.smooth_sd_db);
                put_logarithms(judged.slots, least_squares(problem, start, limits));
            }
            scatter = scatter_.fit(target_.residuals_db(terms_of(judged.slots)));
            judged.smooth_sd_db = scatter.smooth_sd_db;
        }
        judged.criterion = scatter.minus_two_log_likelihood + penalty(judged.slots);
        return judged;
    }

    // The prior's part of the likelihood, and Schwarz's price of what was changed.
    double penalty(const std::vector<Slot>& slots) const {
        double parameters = 0.0;
        for (const Slot& slot : slots) {
            if (slot.changed) { parameters += slot.frees_shape() ? 2.0 : 1.0; }
        }
        double sum = parameters * std::log(static_cast<double>(target_.tau_s.size()));
        for (const double residual : prior_residuals(slots)) { sum += residual * residual; }
        return sum;
    }

    // A size at which a new term is a third of what the curve has where it is closest to it.
    double size_below_curve(Kind kind, double shape) const {
        const CurveTerm unit{kind, 1.0, shape};
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < target_.tau_s.size(); ++i) {
            const double variance = unit.allan_variance(target_.tau_s[i]);
            if (variance > 0.0) { least = std::min(least, target_.deviation[i] / std::sqrt(variance)); }
        }
        return std::sqrt(0.3) * least;
    }

    // Shapes of which the curve has the hump.
    std::vector<double> shapes_to_try(Kind kind) const {
        if (!has_shape(kind)) { return {0.0}; }
        const double hump_s = CurveTerm{kind, 1.0, 1.0}.hump_tau_s();
        const double first_s = target_.tau_s.front();
        const double octaves = std::log2(target_.tau_s.back() / first_s);
        const double per_octave = kind == Kind::sinusoid ? 3.0 : 1.0;
        const int steps = std::max(2, static_cast<int>(std::ceil(octaves * per_octave)));
        std::vector<double> shapes;
        for (int i = 0; i < steps; ++i) {
            const double tau_s = first_s * std::exp2(octaves * (i + 0.5) / steps);
            shapes.push_back(kind == Kind::sinusoid ? hump_s / tau_s : tau_s / hump_s);
        }
        return shapes;
    }

    bool within_curve(const CurveTerm& term) const {
        if (!has_shape(term.kind)) { return true; }
        return term.hump_tau_s() >= target_.tau_s.front() && term.hump_tau_s() <= target_.tau_s.back();
    }

    // A term of the model that has this kind and may become free; else a new one.
    Judged with_change(const Judged& from, Kind kind) const {
        for (std::size_t i = 0; i < from.slots.size(); ++i) {
            const Slot& slot = from.slots[i];
            if (slot.now.kind != kind || !slot.modelled.may_change) { continue; }
            if (!slot.changed && slot.in_model) {
                std::vector<Slot> slots = from.slots;
                slots[i].changed = true;
                return fitted(std::move(slots), from.smooth_sd_db, rounds);
            }
            if (!has_shape(kind)) { return {}; }
        }
        return with_new(from, kind);
    }

    Judged with_new(const Judged& from, Kind kind) const {
        Judged best;
        for (const double shape : shapes_to_try(kind)) {
            std::vector<Slot> slots = from.slots;
            slots.push_back({{}, false, true, {kind, size_below_curve(kind, shape), shape}});
            Judged judged = fitted(std::move(slots), from.smooth_sd_db, 1);
            if (within_curve(judged.slots.back().now) && judged.criterion < best.criterion) {
                best = std::move(judged);
            }
        }
        if (!std::isfinite(best.criterion)) { return best; }
        Judged refined = fitted(best.slots, best.smooth_sd_db, rounds);
        return within_curve(refined.slots.back().now) && refined.criterion < best.criterion ? refined : best;
    }

    bool make_best_change() {
        Judged best;
        for (Judged& with : alternatives(now_)) {
            if (with.criterion < best.criterion) { best = std::move(with); }
        }
        if (!(best.criterion < now_.criterion - margin_to_enter)) { return false; }
        now_ = std::move(best);
        return true;
    }

    void take_back_idle_changes() {
        for (std::size_t i = 0; i < now_.slots.size();) {
            Judged without_it = now_.slots[i].changed ? without(i) : Judged{};
            if (without_it.criterion < now_.criterion + margin_to_stay) {
                now_ = std::move(without_it);
                i = 0;
            } else {
                ++i;
            }
        }
    }

    // Terms of the model whose size the fit lets go to nothing.
    void take_out_unseen() {
        for (std::size_t i = 0; i < now_.slots.size(); ++i) {
            if (!now_.slots[i].changed || !now_.slots[i].in_model) { continue; }
            std::vector<Slot> slots = now_.slots;
            slots[i].unseen = true;
            slots[i].now.size = 0.0;
            Judged without_it = fitted(std::move(slots), now_.smooth_sd_db, rounds);
            if (without_it.criterion < now_.criterion + margin_to_be_seen) { now_ = std::move(without_it); }
        }
    }

    const Target& target_;
    CurveScatter scatter_;
    Judged now_;
};

double shrink_of(double before_rms, double after_rms, double floor_rms) {
    const double before = before_rms * before_rms - floor_rms * floor_rms;
    if (!(before > 0.0)) { return 0.0; }
    return std::min(1.0, 1.0 - (after_rms * after_rms - floor_rms * floor_rms) / before);
}

// Where the change makes most of what it makes at all.
void put_place(CurveCause& cause, const Target& target, const std::vector<CurveTerm>& corrected) {
    std::vector<double> change_db;
    change_db.reserve(target.tau_s.size());
    for (const double tau_s : target.tau_s) {
        const double with = total_variance(corrected, tau_s);
        const double without = with - cause.term.allan_variance(tau_s) +
                               (cause.in_model ? cause.in_model->allan_variance(tau_s) : 0.0);
        change_db.push_back(std::abs(variance_db_per_neper * std::log(std::max(without, 1e-300) / with)));
    }
    const auto most = std::ranges::max_element(change_db);
    auto first = most;
    auto last = most;
    while (first != change_db.begin() && *(first - 1) >= 0.5 * *most) { --first; }
    while (last + 1 != change_db.end() && *(last + 1) >= 0.5 * *most) { ++last; }
    cause.from_tau_s = target.tau_s[static_cast<std::size_t>(first - change_db.begin())];
    cause.to_tau_s = target.tau_s[static_cast<std::size_t>(last - change_db.begin())];
}

void put_rivals(CurveCause& cause, const ChangeSearch& search, std::size_t slot) {
    const double criterion = search.result().criterion;
    const Judged without = search.without(slot);
    cause.criterion_gain = without.criterion - criterion;
    double sum = 1.0 + std::exp(-0.5 * cause.criterion_gain);
    for (const Judged& instead : search.alternatives(without)) {
        // The change is the slot that is free here and not there.
        CurveTerm term = instead.slots.back().now;
        for (std::size_t i = 0; i < without.slots.size(); ++i) {
            if (instead.slots[i].changed && !without.slots[i].changed) { term = instead.slots[i].now; }
        }
        if (term.kind == cause.term.kind) { continue; }
        const double behind = instead.criterion - criterion;
        sum += std::exp(-0.5 * behind);
        if (behind < curve_tie_margin) { cause.rivals.push_back({term, behind}); }
    }
    cause.probability = 1.0 / sum;
    std::ranges::sort(cause.rivals, {}, &CurveRival::criterion_behind);
}

// Of the gap's square, what comes back where the cause's term is as in the model again.
double share_of(const CurveCause& cause, const Target& target, const CurveDiagnosis& diagnosis) {
    std::vector<CurveTerm> terms = diagnosis.corrected;
    const auto own = std::ranges::find_if(terms, [&](const CurveTerm& term) {
        return term.kind == cause.term.kind && term.shape == cause.term.shape && term.size == cause.term.size;
    });
    if (own != terms.end()) { terms.erase(own); }
    if (cause.in_model) { terms.push_back(*cause.in_model); }
    const auto shrink = [&](double rms_db) {
        return shrink_of(diagnosis.before.rms_db, rms_db, diagnosis.floor_db);
    };
    return std::clamp(shrink(diagnosis.after.rms_db) - shrink(residual_of(target, terms).rms_db), 0.0, 1.0);
}

void put_causes(CurveDiagnosis& diagnosis, const ChangeSearch& search, const Target& target) {
    const std::vector<Slot>& slots = search.result().slots;
    if (std::ranges::none_of(slots, &Slot::changed)) { return; }
    const std::vector<double> sd = search.log_sd();
    std::size_t at = 0;
    for (std::size_t i = 0; i < slots.size(); ++i) {
        CurveCause cause;
        cause.term = slots[i].now;
        if (slots[i].is_free()) { cause.size_sd_rel = sd[at++]; }
        if (slots[i].frees_shape()) { cause.shape_sd_rel = sd[at++]; }
        if (!slots[i].changed) { continue; }
        if (slots[i].in_model) { cause.in_model = slots[i].modelled.term; }
        put_rivals(cause, search, i);
        put_place(cause, target, diagnosis.corrected);
        cause.share = share_of(cause, target, diagnosis);
        diagnosis.causes.push_back(std::move(cause));
    }
    std::ranges::sort(diagnosis.causes, std::ranges::greater(), &CurveCause::criterion_gain);
}

std::vector<CurveGapStretch> stretches_of(const Target& target, const std::vector<CurveTerm>& model) {
    AllanCurve sensor;
    AllanCurve modelled;
    for (std::size_t i = 0; i < target.tau_s.size(); ++i) {
        AllanPoint point;
        point.tau_s = target.tau_s[i];
        point.deviation = target.deviation[i];
        sensor.points.push_back(point);
        point.deviation = std::sqrt(total_variance(model, point.tau_s));
        modelled.points.push_back(point);
    }
    auto gap = compare_curves(sensor, {}, modelled, {});
    return gap ? std::move(gap->stretches) : std::vector<CurveGapStretch>{};
}

bool is_closed(const CurveDiagnosis& diagnosis) {
    return diagnosis.in_floors(diagnosis.after) <= curve_floors_closed;
}

std::vector<CurveLeft> left_of(const CurveDiagnosis& diagnosis, const Target& target) {
    std::vector<CurveLeft> left;
    if (is_closed(diagnosis)) { return left; }
    const std::vector<double> residuals_db = target.residuals_db(diagnosis.corrected);
    for (const CurveGapStretch& stretch : stretches_of(target, diagnosis.corrected)) {
        double sum = 0.0;
        double points = 0.0;
        for (std::size_t i = 0; i < target.tau_s.size(); ++i) {
            if (target.tau_s[i] < stretch.from_tau_s || target.tau_s[i] > stretch.to_tau_s) { continue; }
            sum += residuals_db[i] * residuals_db[i];
            points += 1.0;
        }
        const double floors = std::sqrt(sum / std::max(points, 1.0)) / diagnosis.floor_db;
        if (floors > curve_floors_closed) { left.push_back({stretch.from_tau_s, stretch.to_tau_s, floors}); }
    }
    std::ranges::stable_sort(left, std::ranges::greater(), &CurveLeft::floors);
    return left;
}

CurveDiagnosis::Verdict verdict_of(const CurveDiagnosis& diagnosis) {
    using Verdict = CurveDiagnosis::Verdict;
    if (diagnosis.causes.empty()) { return is_closed(diagnosis) ? Verdict::none : Verdict::unexplained; }
    if (is_closed(diagnosis) || 1.0 - diagnosis.shrink < curve_share_min) { return Verdict::known; }
    const bool is_named = std::ranges::any_of(diagnosis.causes, [](const CurveCause& cause) {
        return cause.probability >= curve_probability_min && cause.share >= curve_share_min;
    });
    return is_named ? Verdict::partly : Verdict::unexplained;
}

}  // namespace

CurveDiagnosis diagnose_curve(const AllanCurve& curve, const std::vector<ModelledTerm>& model,
                              const CurveFitOptions& options) {
    const Target target(curve);
    std::vector<CurveTerm> as_it_is;
    as_it_is.reserve(model.size());
    for (const ModelledTerm& modelled : model) { as_it_is.push_back(modelled.term); }
    CurveDiagnosis diagnosis;
    diagnosis.points = target.tau_s.size();
    const double reading_sd_db = 2.0 * variance_db_per_neper * options.reading_error;
    diagnosis.floor_db = std::max(reading_sd_db, fit_curve_model(curve, options).residual.rms_db);
    diagnosis.before = residual_of(target, as_it_is);
    diagnosis.stretches = stretches_of(target, as_it_is);

    ChangeSearch search(target, model, reading_sd_db);
    search.run();
    diagnosis.corrected = terms_of(search.result().slots);
    diagnosis.after = residual_of(target, diagnosis.corrected);
    put_causes(diagnosis, search, target);
    diagnosis.shrink = diagnosis.causes.empty()
                           ? 0.0
                           : shrink_of(diagnosis.before.rms_db, diagnosis.after.rms_db, diagnosis.floor_db);
    diagnosis.left = left_of(diagnosis, target);
    diagnosis.verdict = verdict_of(diagnosis);
    return diagnosis;
}

}  // namespace gyrolog
