#include "analysis/diagnose/multiscale/joined_passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/diagnose/calibration/cause_shares.hpp"
#include "analysis/diagnose/diagnosis.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"

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

double excess(const Gap& gap) { return std::max(gap.value * gap.value - 1.0, 0.0); }

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
        if (means_.verdict == Verdict::known) { return gain_nats(means_) > gain_nats(beginning_); }
        return means_.verdict == Verdict::unexplained &&
               means_.gap_before.value > beginning_.gap_before.value;
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
        std::ranges::stable_sort(whole_.causes, std::ranges::greater{},
                                 [](const Cause& cause) { return cause.finding.gain_nats; });
        if (whole_.verdict == Verdict::known) { whole_.where = whole_.causes.front().finding.where; }
        if (whole_.verdict != Verdict::unexplained) { return; }
        if (!whole_.better_shape) { whole_.better_shape = other().better_shape; }
        whole_.left = whole_.better_shape ? Place{} : main_.causes.empty() ? main_.where : main_.left;
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

    void join_gaps() {
        if (!beginning_.held_out.empty() || !means_.held_out.empty()) {
            report_second_recording();
            return;
        }
        const bool known = whole_.verdict == Verdict::known;
        const auto weight = [&](const Diagnosis& pass) {
            if (pass.verdict == Verdict::none) { return 0.0; }
            return known ? gain_nats(pass) : excess(pass.gap_before);
        };
        const std::array<double, 2> weights{weight(beginning_), weight(means_)};
        const double sum = weights[0] + weights[1];
        if (!(sum > 0.0)) { return; }
        const auto joined = [&](double Diagnosis::*share) {
            return (weights[0] * beginning_.*share + weights[1] * means_.*share) / sum;
        };
        whole_.shrink = joined(&Diagnosis::shrink);
        whole_.shrink_lo = joined(&Diagnosis::shrink_lo);
        whole_.shrink_hi = joined(&Diagnosis::shrink_hi);
        share_among_causes(whole_);
        const bool of_beginning = !(weights[1] > 0.0) ||
                                  (weights[0] > 0.0 && beginning_.gap_before.value > means_.gap_before.value);
        whole_.gap_before = of_beginning ? beginning_.gap_before : means_.gap_before;
        const auto after = [&](double shrink) {
            return std::sqrt(1.0 + (1.0 - shrink) * excess(whole_.gap_before));
        };
        whole_.gap_after = {after(whole_.shrink), 1.0, after(whole_.shrink_hi), after(whole_.shrink_lo)};
    }

    void report_second_recording() {
        const bool of_means =
            beginning_.held_out.empty() ||
            (!means_.held_out.empty() && means_.gap_before.value > beginning_.gap_before.value);
        const Diagnosis& pass = of_means ? means_ : beginning_;
        whole_.held_out = pass.held_out;
        whole_.gap_before = pass.gap_before;
        whole_.gap_after = pass.gap_after;
        whole_.shrink = pass.shrink;
        whole_.shrink_lo = pass.shrink_lo;
        whole_.shrink_hi = pass.shrink_hi;
        share_among_causes(whole_);
    }

    void join_words() {
        whole_.split_half = beginning_.split_half;
        append_new(whole_.split_half.judged, means_.split_half.judged);
        std::erase_if(whole_.split_half.judged,
                      [&](const std::string& effect) { return !has_effect(whole_, effect); });
        whole_.split_half.evidence_left_nats =
            std::max(beginning_.split_half.evidence_left_nats, means_.split_half.evidence_left_nats);
        whole_.split_half.excess_nats += means_.split_half.excess_nats;
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
