#include "analysis/diagnose/selection/spectra_refit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/estimators/narrow_band.hpp"
#include "analysis/diagnose/estimators/spectral_range.hpp"
#include "analysis/diagnose/likelihood/noise_nuisance.hpp"
#include "analysis/numerics/cholesky.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

constexpr int spectra_steps_most = 40;
constexpr int spectra_shortenings_most = 8;
// What a further step would gain.
constexpr double spectra_settled_nats = 0.02;
// Of a parameter's logarithm, over which a density is taken for straight.
constexpr double log_step = 1e-4;
// In one step a parameter changes by a factor of e at most.
constexpr double log_step_most = 1.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

struct SpectralParameter {
    std::size_t finding = 0;
    std::vector<std::size_t> model_entries;  // several have it in common
    std::string name;
    SpectralRange range;
    double step_most = resolution::log_step_most;  // of the logarithm
};

// The effects' parameter of which only some values are tried.
struct SpectralForm {
    std::vector<std::size_t> model_entries;
    std::string name;
    std::span<const double> values;
};

// A point of the search, and what the recording says there.
struct SpectraPoint {
    SensorModel model;
    std::vector<double> logs;  // of the parameters
    std::array<NoiseNuisance, 3> noise;
    double nats = 0.0;
};

class SpectraFit {
public:
    SpectraFit(const Observation& seen, std::size_t first_entry, std::vector<Finding> findings,
               const SpectraRefitOptions& options)
        : seen_(seen),
          prediction_(seen.prediction()),
          options_(options),
          first_entry_(first_entry),
          findings_(std::move(findings)) {
        std::size_t model_entry = first_entry;
        for (std::size_t f = 0; f < findings_.size(); ++f) {
            const std::size_t before = places_.size();
            for (std::size_t e = 0; e < findings_[f].entries.size(); ++e) {
                add_parameters(f, e, model_entry + e);
            }
            if (places_.size() > before) { add_forms(findings_[f], model_entry); }
            model_entry += findings_[f].entries.size();
        }
    }

    std::vector<Finding> run() {
        if (places_.size() < 2) { return std::move(findings_); }
        SpectraPoint best = climbed(start());
        while (std::optional<SpectraPoint> better = of_another_form(best)) { best = *std::move(better); }
        std::size_t model_entry = first_entry_;
        for (Finding& finding : findings_) {
            for (EffectModel& entry : finding.entries) {
                entry.params = best.model.effects[model_entry++].params;
            }
        }
        return std::move(findings_);
    }

private:
    struct Step {
        std::vector<double> by;
        double promised_nats = 0.0;
    };

    SpectraPoint start() const {
        SpectraPoint point{prediction_.model(), {}, {}, 0.0};
        for (const SpectralParameter& place : places_) {
            point.logs.push_back(
                std::log(point.model.effects[place.model_entries.front()].params.at(place.name)));
        }
        for (const std::size_t axis : prediction_.axes()) { point.noise[axis] = seen_.axis(axis).noise; }
        return point;
    }

    // Where scoring from this point ends.
    SpectraPoint climbed(SpectraPoint from) const {
        SpectraPoint best = fitted(std::move(from));
        for (int step = 0; step < resolution::spectra_steps_most; ++step) {
            const auto [by, promised_nats] = step_from(best);
            if (!(promised_nats > resolution::spectra_settled_nats)) { break; }
            bool better = false;
            for (int i = 0; i < resolution::spectra_shortenings_most && !better; ++i) {
                SpectraPoint there = best;
                there.logs = moved(best.logs, by, std::ldexp(1.0, -i));
                there.model = model_at(best.model, there.logs);
                if (!has_bands(there.model)) { continue; }
                there = fitted(std::move(there));
                better = there.nats > best.nats;
                if (better) { best = std::move(there); }
            }
            if (!better) { break; }
        }
        return best;
    }

    // The best that one effect's other form leads to, if it is better.
    std::optional<SpectraPoint> of_another_form(const SpectraPoint& than) const {
        std::optional<SpectraPoint> best;
        for (const SpectralForm& form : forms_) {
            for (const double value : form.values) {
                if (EffectValues(than.model.effects[form.model_entries.front()])[form.name] == value) {
                    continue;
                }
                SpectraPoint from = than;
                for (const std::size_t entry : form.model_entries) {
                    set_form(from.model.effects[entry], form.name, value);
                }
                SpectraPoint there = climbed(std::move(from));
                const double least_nats = best ? best->nats : than.nats + resolution::spectra_settled_nats;
                if (there.nats > least_nats) { best = std::move(there); }
            }
        }
        return best;
    }

    static void set_form(EffectModel& entry, const std::string& name, double value) {
        if (value == 0.0) {
            entry.params.erase(name);
        } else {
            entry.params[name] = value;
        }
    }

    // One for all entries where the effect has parameters in common, else one for each.
    void add_forms(const Finding& finding, std::size_t first_entry) {
        const EffectSignature& signature = *find_effect(finding.effect)->signature;
        if (signature.form_values.empty()) { return; }
        for (std::size_t e = 0; e < finding.entries.size(); ++e) {
            if (e == 0 || signature.common.empty()) {
                forms_.push_back({{}, std::string(signature.form), signature.form_values});
            }
            forms_.back().model_entries.push_back(first_entry + e);
        }
    }

    void add_parameters(std::size_t f, std::size_t e, std::size_t model_entry) {
        const Finding& finding = findings_[f];
        const EffectSignature& signature = *find_effect(finding.effect)->signature;
        const EvidenceMethod method = traits_of(finding.effect, prediction_).method;
        const bool is_of_band = method == EvidenceMethod::narrow_band;
        if (is_of_band ? !is_resolved(finding.entries[e]) : method != EvidenceMethod::spectrum) { return; }
        if (e >= finding.sd.size()) { return; }  // nothing in it was fitted
        for (const auto& [name, sd] : finding.sd[e]) {
            if (std::ranges::count(signature.spectral, name) == 0) { continue; }
            const auto of_others =
                std::ranges::find_if(places_, [&, &name = name](const SpectralParameter& place) {
                    return place.finding == f && place.name == name;
                });
            if (std::ranges::count(signature.common, name) != 0 && of_others != places_.end()) {
                of_others->model_entries.push_back(model_entry);
                continue;
            }
            const SpectralRange range = spectral_range(
                signature, param_of(*find_effect(finding.effect), name), prediction_.rate_hz());
            places_.push_back({f, {model_entry}, name, range});
            // Farther than its width from the middle a Lorentzian is another shape.
            if (is_of_band && name == "f_hz") {
                places_.back().step_most =
                    finding.entries[e].params.at("width_hz") / finding.entries[e].params.at("f_hz");
            }
        }
    }

    bool is_resolved(const EffectModel& band) const {
        return bins_within(band.params.at("f_hz"), band.params.at("width_hz"), prediction_) >=
               options_.band_bins_least;
    }

    // Whether what is a band is one in this model, and the bins resolve it.
    bool has_bands(const SensorModel& model) const {
        return std::ranges::all_of(places_, [&](const SpectralParameter& place) {
            const EffectModel& entry = model.effects[place.model_entries.front()];
            return traits_of(entry.effect, prediction_).method != EvidenceMethod::narrow_band ||
                   (is_band(entry.params.at("f_hz"), entry.params.at("width_hz"), prediction_) &&
                    is_resolved(entry));
        });
    }

    SensorModel model_at(SensorModel model, const std::vector<double>& logs) const {
        for (std::size_t i = 0; i < places_.size(); ++i) {
            for (const std::size_t entry : places_[i].model_entries) {
                model.effects[entry].params.at(places_[i].name) = std::exp(logs[i]);
            }
        }
        return model;
    }

    std::vector<double> moved(std::vector<double> logs, const std::vector<double>& by, double share) const {
        for (std::size_t i = 0; i < logs.size(); ++i) {
            const double step = share * std::clamp(by[i], -places_[i].step_most, places_[i].step_most);
            logs[i] =
                std::clamp(logs[i] + step, std::log(places_[i].range.least), std::log(places_[i].range.most));
        }
        return logs;
    }

    // The point with N, B and K at their most likely.
    SpectraPoint fitted(SpectraPoint point) const {
        point.nats = 0.0;
        for (const std::size_t axis : prediction_.axes()) {
            point.noise[axis] =
                fit_nuisance(prediction_.bins(), prediction_.parts_of(point.model, axis),
                             seen_.axis(axis).power, noise_uncertainty(point.model, axis), point.noise[axis]);
            point.nats += point.noise[axis].log_likelihood_nats;
        }
        return point;
    }

    Step step_from(const SpectraPoint& point) const {
        const std::size_t count = places_.size();
        Matrix information(count, count);
        std::vector<double> gradient(count, 0.0);
        for (const std::size_t axis : prediction_.axes()) { add_axis(point, axis, information, gradient); }
        Step step;
        step.by = solve_symmetric(information, gradient);
        for (std::size_t i = 0; i < count; ++i) { step.promised_nats += 0.5 * gradient[i] * step.by[i]; }
        return step;
    }

    // Of one axis, about the parameters with the nuisance free: Schur's complement of the information about
    // both. At the nuisance's most likely the gradient along it is nothing.
    void add_axis(const SpectraPoint& point, std::size_t axis, Matrix& information,
                  std::vector<double>& gradient) const {
        const SensorModel& model = point.model;
        const std::array<double, 3> sd_rel = noise_uncertainty(model, axis);
        const NoiseNuisance& noise = point.noise[axis];
        const std::vector<SpectralParts> parts = prediction_.parts_of(model, axis);
        std::vector<double> density(parts.size());
        expected_density(parts, sd_rel, noise.z, density);
        std::vector<std::vector<double>> slopes;  // of the density's logarithm, by bin
        std::vector<std::size_t> own;             // the parameter of each
        std::vector<double> there(parts.size());
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const bool acts = std::ranges::any_of(places_[i].model_entries, [&](std::size_t entry) {
                return acts_on(model.effects[entry], axis);
            });
            if (!acts) { continue; }
            std::vector<double> more = point.logs;
            more[i] += resolution::log_step;
            expected_density(prediction_.parts_of(model_at(model, more), axis), sd_rel, noise.z, there);
            own.push_back(i);
            slopes.push_back(log_slope(density, there, resolution::log_step));
        }
        if (own.empty()) { return; }
        for (std::size_t j = 0; j < 3; ++j) {
            if (!(sd_rel[j] > 0.0)) { continue; }
            std::array<double, 3> z = noise.z;
            z[j] += resolution::log_step;
            expected_density(parts, sd_rel, z, there);
            slopes.push_back(log_slope(density, there, resolution::log_step));
        }
        add_information(axis, density, own, slopes, information, gradient);
    }

    void add_information(std::size_t axis, const std::vector<double>& density,
                         const std::vector<std::size_t>& own, const std::vector<std::vector<double>>& slopes,
                         Matrix& information, std::vector<double>& gradient) const {
        const SpectralBins& bins = prediction_.bins();
        const std::vector<double>& power = seen_.axis(axis).power;
        const std::size_t free = slopes.size() - own.size();
        Matrix all(slopes.size(), slopes.size());
        for (std::size_t bin = 0; bin < bins.size(); ++bin) {
            const double half = 0.5 * bins[bin].count();
            const double excess = half * (power[bin] / density[bin] - 1.0);
            for (std::size_t a = 0; a < slopes.size(); ++a) {
                if (a < own.size()) { gradient[own[a]] += excess * slopes[a][bin]; }
                for (std::size_t b = 0; b <= a; ++b) { all(a, b) += half * slopes[a][bin] * slopes[b][bin]; }
            }
        }
        Matrix nuisance(free, free);
        Matrix mixed(free, own.size());
        for (std::size_t a = 0; a < free; ++a) {
            for (std::size_t b = 0; b < free; ++b) {
                nuisance(a, b) = all(own.size() + std::max(a, b), own.size() + std::min(a, b));
            }
            nuisance(a, a) += 1.0;  // the prior
            for (std::size_t b = 0; b < own.size(); ++b) { mixed(a, b) = all(own.size() + a, b); }
        }
        const Matrix taken = free == 0 ? Matrix() : solve_symmetric(nuisance, mixed);
        for (std::size_t a = 0; a < own.size(); ++a) {
            for (std::size_t b = 0; b < own.size(); ++b) {
                double value = all(std::max(a, b), std::min(a, b));
                for (std::size_t k = 0; k < free; ++k) { value -= mixed(k, a) * taken(k, b); }
                information(own[a], own[b]) += value;
            }
        }
    }

    static std::vector<double> log_slope(const std::vector<double>& density, const std::vector<double>& there,
                                         double step) {
        std::vector<double> slope(density.size());
        for (std::size_t i = 0; i < slope.size(); ++i) { slope[i] = std::log(there[i] / density[i]) / step; }
        return slope;
    }

    const Observation& seen_;
    const Prediction& prediction_;
    SpectraRefitOptions options_;
    std::size_t first_entry_;
    std::vector<Finding> findings_;
    std::vector<SpectralParameter> places_;
    std::vector<SpectralForm> forms_;
};

}  // namespace

std::vector<Finding> refit_spectra(const Observation& seen, std::size_t first_entry,
                                   std::vector<Finding> findings, const SpectraRefitOptions& options) {
    return SpectraFit(seen, first_entry, std::move(findings), options).run();
}

}  // namespace gyrolog
