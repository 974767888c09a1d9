#include "analysis/diagnose/multiscale/joined_passes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/diagnose/diagnosis.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/selection/cause_probability.hpp"

namespace gyrolog {
namespace {

constexpr auto effect_of = [](const Cause& cause) -> const std::string& { return cause.finding.effect; };

bool has_effect(const Diagnosis& pass, const std::string& effect) {
    return std::ranges::count(pass.causes, effect, effect_of) > 0;
}

double gain_nats(const Diagnosis& pass) {
    double sum = 0.0;
    for (const Cause& cause : pass.causes) { sum += cause.finding.gain_nats; }
    return sum;
}

// What is left where nothing was found is all of it.
double p_left(const Diagnosis& pass) {
    if (pass.verdict == Verdict::none) { return 1.0; }
    return pass.causes.empty() && pass.verdict == Verdict::unexplained ? pass.p_none : pass.p_left;
}

class JoinedPasses {
public:
    JoinedPasses(const SensorModel& model, const Diagnosis& beginning, const Diagnosis& means,
                 std::size_t samples_per_row)
        : model_(model),
          beginning_(beginning),
          means_(means),
          samples_per_row_(samples_per_row),
          main_(means_is_main() ? means : beginning),
          whole_(main_) {}

    Diagnosis joined() && {
        describe();
        join_causes();
        correct_model();
        join_gaps();
        join_words();
        return std::move(whole_);
    }

private:
    bool means_is_main() const {
        if (means_.verdict != beginning_.verdict) {
            return static_cast<int>(means_.verdict) > static_cast<int>(beginning_.verdict);
        }
        if (means_.verdict == Verdict::unexplained) {
            return means_.gap_before.value > beginning_.gap_before.value;
        }
        return gain_nats(means_) > gain_nats(beginning_);
    }

    void describe() {
        const auto pass_of = [](const Diagnosis& seen, std::size_t samples_per_row) {
            return Pass{seen.duration_s, seen.samples, samples_per_row, seen.verdict, seen.p_none};
        };
        whole_.passes = {pass_of(beginning_, 1), pass_of(means_, samples_per_row_)};
        whole_.rate_hz = beginning_.rate_hz;
        whole_.duration_s = means_.duration_s;
        whole_.samples = means_.samples * samples_per_row_;
        const double least = std::min(beginning_.p_none, means_.p_none);
        whole_.p_none = -std::expm1(2.0 * std::log1p(-std::min(least, 1.0 - 1e-15)));
        whole_.p_left = std::min(p_left(beginning_), p_left(means_));
        whole_.domains = beginning_.domains;
        for (GapDomain domain : means_.domains) {
            domain.name = "means: " + domain.name;
            whole_.domains.push_back(std::move(domain));
        }
    }

    void join_causes() {
        whole_.causes = beginning_.causes;
        whole_.causes.insert(whole_.causes.end(), means_.causes.begin(), means_.causes.end());
        whole_.unnamed.insert(whole_.unnamed.end(), other().unnamed.begin(), other().unnamed.end());
        if (!whole_.better_shape) { whole_.better_shape = other().better_shape; }
        whole_.left.insert(whole_.left.end(), other().left.begin(), other().left.end());
        std::ranges::stable_sort(whole_.left, std::ranges::greater{}, &Left::size);
        std::ranges::stable_sort(whole_.unnamed, std::ranges::greater{}, &Unnamed::share);
    }

    const Diagnosis& other() const { return &main_ == &means_ ? beginning_ : means_; }

    // White noise as single samples have it; B and K as the means do, where these call for others.
    void correct_model() {
        whole_.noise_refits = beginning_.noise_refits;
        for (NoiseRefit one : means_.noise_refits) {
            if (one.coefficient == 'N') { continue; }
            one.stated = stated(one);
            const auto same = std::ranges::find_if(whole_.noise_refits, [&](const NoiseRefit& before) {
                return before.axis == one.axis && before.coefficient == one.coefficient;
            });
            if (same != whole_.noise_refits.end()) {
                *same = one;
            } else {
                whole_.noise_refits.push_back(one);
            }
        }
        // The mean of what has all the slow causes in its model.
        const bool none_in_means = means_.causes.empty() && !beginning_.causes.empty();
        whole_.corrected =
            corrected_model(model_, whole_, none_in_means ? beginning_.corrected : means_.corrected);
    }

    double stated(const NoiseRefit& noise) const {
        const NoiseCoefficients& of_model = model_.axes[noise.axis].noise;
        return noise.coefficient == 'B' ? of_model.B_rad_per_s : of_model.K_rad_per_s_sqrt_s;
    }

    // Surprisals of passes add up, as those of measures do.
    void join_gaps() {
        if (!beginning_.held_out.empty() || !means_.held_out.empty()) {
            report_second_recording();
        } else {
            add_passes();
        }
        std::ranges::stable_sort(whole_.causes, std::ranges::greater{},
                                 [](const Cause& cause) { return cause.share.value; });
        if (whole_.verdict == Verdict::known) { whole_.where = whole_.causes.front().finding.where; }
    }

    void add_passes() {
        const double sum_nats = beginning_.excess_nats + means_.excess_nats;
        if (!(sum_nats > 0.0)) { return; }
        const auto part = [&](const Diagnosis& pass) { return pass.excess_nats / sum_nats; };
        whole_.excess_nats = sum_nats;
        whole_.floor_nats = beginning_.floor_nats + means_.floor_nats;
        const auto joined_share = [&](double Share::*end) {
            return part(beginning_) * beginning_.shrink.*end + part(means_) * means_.shrink.*end;
        };
        whole_.shrink = {joined_share(&Share::value), joined_share(&Share::lo), joined_share(&Share::hi)};
        whole_.shrink_modelled =
            part(beginning_) * beginning_.shrink_modelled + part(means_) * means_.shrink_modelled;
        for (Cause& cause : whole_.causes) {
            const bool is_of_means =
                &cause - whole_.causes.data() >= static_cast<std::ptrdiff_t>(beginning_.causes.size());
            const double scale = part(is_of_means ? means_ : beginning_);
            cause.share = {scale * cause.share.value, scale * cause.share.lo, scale * cause.share.hi};
        }
        const auto joined = [&](Gap Diagnosis::*gap, double Gap::*end) {
            const auto nats = [&](const Diagnosis& pass) {
                const double value = pass.*gap.*end;
                return pass.floor_nats * value * value;
            };
            return std::sqrt((nats(beginning_) + nats(means_)) / whole_.floor_nats);
        };
        for (const auto gap : {&Diagnosis::gap_before, &Diagnosis::gap_named, &Diagnosis::gap_after}) {
            whole_.*gap = {joined(gap, &Gap::value), 1.0, joined(gap, &Gap::lo), joined(gap, &Gap::hi)};
        }
    }

    void report_second_recording() {
        const bool of_means =
            beginning_.held_out.empty() ||
            (!means_.held_out.empty() && means_.gap_before.value > beginning_.gap_before.value);
        const Diagnosis& pass = of_means ? means_ : beginning_;
        whole_.held_out = pass.held_out;
        whole_.gap_before = pass.gap_before;
        whole_.gap_named = pass.gap_named;
        whole_.gap_after = pass.gap_after;
        whole_.shrink = pass.shrink;
        whole_.shrink_modelled = pass.shrink_modelled;
    }

    void join_words() {
        whole_.not_held_out = beginning_.not_held_out;
        append_new(whole_.not_held_out, means_.not_held_out);
        std::erase_if(whole_.not_held_out,
                      [&](const std::string& effect) { return !has_effect(whole_, effect); });
        // What either pass can test is tested.
        whole_.untestable = beginning_.untestable;
        std::erase_if(whole_.untestable, [&](const Untestable& one) {
            return std::ranges::count(means_.untestable, one.effect, &Untestable::effect) == 0;
        });
        whole_.next_recordings = beginning_.next_recordings;
        append_new(whole_.next_recordings, means_.next_recordings);
        whole_.warnings = beginning_.warnings;
        append_new(whole_.warnings, means_.warnings);
    }

    const SensorModel& model_;
    const Diagnosis& beginning_;
    const Diagnosis& means_;
    std::size_t samples_per_row_;
    const Diagnosis& main_;  // the pass that explains less, or more of what is explained
    Diagnosis whole_;
};

}  // namespace

void remove_causes(Diagnosis& pass, const std::vector<const Cause*>& removed) {
    std::vector<Cause> kept;
    std::vector<std::string> gone;
    for (const Cause& cause : pass.causes) {
        if (std::ranges::count(removed, &cause) == 0) {
            kept.push_back(cause);
        } else {
            gone.push_back(cause.finding.effect);
        }
    }
    pass.causes = std::move(kept);
    std::erase_if(gone, [&](const std::string& effect) { return has_effect(pass, effect); });
    for (const std::string& effect : gone) {
        std::erase_if(pass.next_recordings, [&](const std::string& proposal) {
            return proposal.starts_with(telling_apart(effect));
        });
        if (pass.better_shape && std::ranges::count(pass.better_shape->than, effect) > 0) {
            pass.better_shape.reset();
        }
    }
}

Diagnosis joined_passes(const SensorModel& model, const Diagnosis& beginning, const Diagnosis& means,
                        std::size_t samples_per_row) {
    return JoinedPasses(model, beginning, means, samples_per_row).joined();
}

}  // namespace gyrolog
