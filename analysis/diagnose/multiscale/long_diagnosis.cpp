#include "analysis/diagnose/multiscale/long_diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#ifdef __GLIBC__
    #include <malloc.h>
#endif

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/noise_refit.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/multiscale/joined_passes.hpp"
#include "analysis/diagnose/multiscale/means_model.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

// Of the highest frequency: what is above is nearly white.
constexpr double white_from = 0.25;
// One simulation at a time: two do not fit into a gigabyte beside what is held.
constexpr double beginning_bytes_most = 0.25e9;

}  // namespace gyrolog::resolution

namespace gyrolog {
namespace {

bool is_line(const std::string& effect) { return traits_of(effect).is_line; }
bool is_single_samples(const std::string& effect) {
    return traits_of(effect).far_off == FarOff::single_samples;
}
bool is_far_off(const std::string& effect) { return traits_of(effect).far_off != FarOff::none; }

double folded_hz(double f_hz, double rate_hz) {
    const double turns = f_hz / rate_hz;
    return std::abs(turns - std::round(turns)) * rate_hz;
}

// Standard deviation of the worst known parameter, relative to it.
double worst_sd_rel(const Finding& finding) {
    double worst = 0.0;
    for (std::size_t i = 0; i < finding.entries.size(); ++i) {
        for (const auto& [name, sd] : finding.sd[i]) {
            worst = std::max(worst, sd / std::abs(finding.entries[i].params.at(name)));
        }
    }
    return worst;
}

// For judging noise: every sample that is far off, on any axis, is left out.
SensorModel with_any_single_samples(SensorModel model) {
    for (const ChainLink& link : signal_chain()) {
        const EffectDefinition* effect = link.effect;
        if (effect == nullptr || traits_of(effect->name).far_off != FarOff::single_samples) { continue; }
        EffectModel entry{std::string(effect->name), {}, {}, ""};
        for (const EffectParam& param : effect->params) { entry.params[std::string(param.name)] = 0.0; }
        model.effects.push_back(std::move(entry));
    }
    return model;
}

bool share_an_axis(const EffectModel& entry, const Cause& cause) {
    return std::ranges::any_of(cause.finding.where.axes,
                               [&](std::size_t axis) { return acts_on(entry, axis); });
}

bool share_an_axis(const Cause& a, const Cause& b) {
    return std::ranges::any_of(a.finding.where.axes, [&](std::size_t axis) {
        return std::ranges::count(b.finding.where.axes, axis) > 0;
    });
}

// The middle of what the highest bins have more than the model's other noise: single lines do not move it.
double seen_white_density(const Observation& observation, std::size_t axis) {
    const Prediction& prediction = observation.prediction();
    const std::vector<double>& power = observation.axis(axis).power;
    const double from_hz = resolution::white_from * prediction.bin_frequencies_hz().back();
    std::vector<double> white;
    for (std::size_t i = 0; i < power.size(); ++i) {
        if (prediction.bin_frequencies_hz()[i] < from_hz) { continue; }
        const SpectralParts& parts = prediction.parts(axis)[i];
        const double others = std::min(parts.sum() - parts.white, 0.9 * power[i]);
        white.push_back(power[i] - others);
    }
    const auto middle = white.begin() + static_cast<std::ptrdiff_t>(white.size() / 2);
    std::ranges::nth_element(white, middle);
    return *middle;
}

// What one look leaves of its arrays in the heap is no use to the next.
void give_back_memory() {
#ifdef __GLIBC__
    static_cast<void>(malloc_trim(0));
#endif
}

class LongDiagnoser {
public:
    LongDiagnoser(const LongRecording& recording, const SensorModel& model, const std::string& model_name,
                  DiagnosisOptions options, std::shared_ptr<const Recording> holdout_means)
        : recording_(recording),
          samples_(recording.means->samples_per_row),
          rate_hz_(recording.beginning->rate_hz),
          model_(model),
          model_name_(model_name),
          options_(std::move(options)),
          holdout_means_(std::move(holdout_means)) {
        options_.false_alarms_most *= 0.5;
        options_.simulations_bytes_most = resolution::beginning_bytes_most;
    }

    std::optional<Diagnosis> run() {
        if (!look_at_beginning(model_) || !look_at_means()) { return std::nullopt; }
        if (beginning_.verdict >= Verdict::partly && means_.verdict == Verdict::known) {
            SensorModel with_slow = with_noise(model_, only(means_.noise_refits, false));
            for (const Cause& cause : means_.causes) {
                with_slow = with_cause(std::move(with_slow), cause.finding);
            }
            if (!look_at_beginning(with_slow)) { return std::nullopt; }
            leave_out_images();
        }
        leave_slow_to_means();
        Diagnosis whole = joined_passes(model_, beginning_, means_, samples_);
        warn_of_images(whole);
        return whole;
    }

private:
    bool look_at_beginning(const SensorModel& model) {
        give_back_memory();
        std::optional<Diagnosis> seen = diagnose(recording_.beginning, model, model_name_, options_);
        if (!seen) { return false; }
        beginning_ = *std::move(seen);
        beginning_model_ = model;
        fast_.clear();
        slow_.clear();
        for (const Cause& cause : beginning_.causes) { (is_fast(cause) ? fast_ : slow_).push_back(&cause); }
        return true;
    }

    bool look_at_means() {
        DiagnosisOptions options = options_;
        options.holdout = holdout_means_;
        give_back_memory();
        std::optional<Diagnosis> seen = diagnose(recording_.means, means_model(), model_name_, options);
        if (!seen) { return false; }
        means_ = *std::move(seen);
        leave_out_images();
        for (Cause& cause : means_.causes) {
            cause.finding = finding_of_samples(std::move(cause.finding), samples_, rate_hz_);
        }
        return true;
    }

    static std::vector<NoiseRefit> only(std::vector<NoiseRefit> noise_refits, bool white) {
        std::erase_if(noise_refits, [&](const NoiseRefit& one) { return (one.coefficient == 'N') != white; });
        return noise_refits;
    }

    bool is_fast(const Cause& cause) const {
        const std::string& effect = cause.finding.effect;
        if (!shows_in_means(*find_effect(effect)->signature) || is_far_off(effect)) { return true; }
        if (is_line(effect)) {
            const double f_hz = cause.finding.entries.front().params.at("f_hz");
            return std::norm(line_in_means(f_hz, rate_hz_, samples_)) < definition::majority;
        }
        const double in_samples = spectral_gain_nats(recording_.beginning, cause, 1);
        if (in_samples < decisions.seen_nats()) { return false; }
        const auto means = std::make_shared<const Recording>(means_of(*recording_.beginning, samples_));
        return spectral_gain_nats(means, cause, samples_) < definition::majority * in_samples;
    }

    // Of one of the beginning's causes beside the others.
    double spectral_gain_nats(const std::shared_ptr<const Recording>& recording, const Cause& cause,
                              std::size_t samples) const {
        SensorModel others = with_noise(beginning_model_, beginning_.noise_refits);
        for (const Cause& other : beginning_.causes) {
            if (&other != &cause) { others = with_cause(std::move(others), other.finding); }
        }
        const auto of_rows = [&](const SensorModel& model) {
            return model_of_means(model, samples, rate_hz_);
        };
        const auto world = std::make_shared<const RecordedWorld>(recording);
        const auto prediction = std::make_shared<const Prediction>(world, of_rows(others));
        const auto likelihood = [&](const SensorModel& model) {
            return log_likelihood_nats({prediction->with(of_rows(model)), recording, options_.seed});
        };
        return likelihood(with_cause(others, cause.finding)) - likelihood(others);
    }

    // Lines turn on in a way that the beginning tells too little of to take them off the rest, and it may
    // have too few single samples that are off: what they leave in means is found, and is_image().
    SensorModel means_model() const {
        SensorModel model = fast_.empty() ? model_ : with_noise(model_, beginning_.noise_refits);
        for (const Cause* cause : fast_) {
            const Finding& finding = cause->finding;
            if (is_line(finding.effect)) { continue; }
            if (is_single_samples(finding.effect) && worst_sd_rel(finding) > decisions.seen_sd_rel()) {
                continue;
            }
            model = with_cause(std::move(model), finding);
        }
        model = model_of_means(std::move(model), samples_, rate_hz_);
        const auto world = std::make_shared<const RecordedWorld>(recording_.means);
        const auto prediction = std::make_shared<const Prediction>(world, with_any_single_samples(model));
        const Observation seen(prediction, recording_.means, options_.seed);
        for (const std::size_t axis : prediction->axes()) {
            model.axes[axis].noise.N_rad_per_sqrt_s = std::sqrt(seen_white_density(seen, axis));
            model.axes[axis].sd_rel["N"] = decisions.means_white_sd_rel;
        }
        return model;
    }

    // A fast line, of the beginning or of the model, folded; what samples far off leave; or more of what is
    // held against the means as the beginning has it.
    bool is_image(const Cause& in_means) const {
        const Finding& found = in_means.finding;
        const auto is_image_of = [&](const EffectModel& line) {
            const double f_hz = line.params.at("f_hz");
            const double width_hz = 2.0 / beginning_.duration_s + decisions.clock_strays_rel * f_hz;
            const double image_hz = folded_hz(f_hz, recording_.means->rate_hz);
            return std::abs(image_hz - found.entries.front().params.at("f_hz")) < width_hz;
        };
        for (const EffectModel& entry : model_.effects) {
            if (is_line(found.effect) && is_line(entry.effect) && is_image_of(entry)) { return true; }
            if (is_far_off(found.effect) && traits_of(entry.effect).far_off == FarOff::in_distribution &&
                share_an_axis(entry, in_means)) {
                return true;
            }
        }
        return std::ranges::any_of(fast_, [&](const Cause* fast) {
            const std::string& effect = fast->finding.effect;
            if (is_line(effect)) {
                return is_line(found.effect) && is_image_of(fast->finding.entries.front());
            }
            const bool alike = effect == found.effect || (is_far_off(effect) && is_far_off(found.effect));
            return alike && share_an_axis(*fast, in_means);
        });
    }

    // Rare ones that the beginning has hardly any of.
    void leave_single_samples_to_means() {
        const auto tells_less = [&](const Cause* fast) {
            return is_single_samples(fast->finding.effect) &&
                   std::ranges::any_of(means_.causes, [&](const Cause& in_means) {
                       return in_means.finding.effect == fast->finding.effect &&
                              worst_sd_rel(in_means.finding) < worst_sd_rel(fast->finding);
                   });
        };
        std::ranges::copy_if(fast_, std::back_inserter(slow_), tells_less);
        std::erase_if(fast_, tells_less);
    }

    void leave_out_images() {
        leave_single_samples_to_means();
        std::vector<const Cause*> images;
        for (const Cause& cause : means_.causes) {
            if (is_image(cause)) { images.push_back(&cause); }
        }
        if (images.empty()) { return; }
        remove_causes(means_, images);
        if (!means_.causes.empty()) { return; }
        means_.noise_refits.clear();
        means_.p_none = means_.p_left;
        if (means_.verdict == Verdict::known) { means_.verdict = Verdict::none; }
    }

    void leave_slow_to_means() {
        if (means_.causes.empty()) { return; }
        if (fast_.empty()) { beginning_.noise_refits = only(std::move(beginning_.noise_refits), true); }
        remove_causes(beginning_, slow_);
    }

    void warn_of_images(Diagnosis& whole) const {
        const bool any = std::ranges::any_of(
            means_.causes, [](const Cause& cause) { return is_line(cause.finding.effect); });
        if (!any) { return; }
        whole.warnings.emplace_back(
            "a line that was found in means only may be the image of a faster one: a recording at another "
            "rate would tell");
    }

    const LongRecording& recording_;
    std::size_t samples_;
    double rate_hz_;  // of samples
    const SensorModel& model_;
    const std::string& model_name_;
    DiagnosisOptions options_;
    std::shared_ptr<const Recording> holdout_means_;
    Diagnosis beginning_;
    SensorModel beginning_model_;            // that it was last held against
    std::vector<const Cause*> fast_, slow_;  // of the beginning's
    Diagnosis means_;
};

}  // namespace

std::optional<Diagnosis> diagnose_long(const LongRecording& recording, const SensorModel& model,
                                       const std::string& model_name, const DiagnosisOptions& options,
                                       std::shared_ptr<const Recording> holdout_means) {
    return LongDiagnoser(recording, model, model_name, options, std::move(holdout_means)).run();
}

}  // namespace gyrolog
