#include "analysis/diagnose/estimators/line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/axis_subsets.hpp"
#include "analysis/diagnose/estimators/steady_line.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "analysis/simulate/sensor_simulator.hpp"

namespace gyrolog::resolution {

constexpr std::size_t place_min = 40;
// Of a line between two coefficients eight tenths lie in six.
constexpr std::size_t window_coefficients = 6;
// Noise alone makes a window a candidate so often.
constexpr double candidate_chance = 5e-4;
constexpr std::size_t block_coefficients = 256;
constexpr std::size_t group_coefficients = 16;
constexpr std::size_t candidates_most = 32;
constexpr std::size_t refined_most = 3;
constexpr std::size_t coarse_reach = 12;
constexpr std::size_t line_reach = 64;
constexpr std::size_t removed_reach = 4096;
constexpr std::size_t blocks_to_settle = 4;
constexpr std::size_t response_blocks = 8;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace definition {

// Amplitude, phase and frequency.
constexpr double line_parameters = 3.0;

}  // namespace definition

namespace {

struct Candidate {
    std::size_t k = 0;  // first of the window
    float excess = 0.0F;
};

struct AxisLine {
    std::size_t axis = 0;
    LineFit fit;         // gain against the expected density
    double floor = 1.0;  // what is around it, in expected densities
    double gain_nats() const { return fit.gain_nats / floor; }
};

// Of a window's sum over the axes, in what is expected of one coefficient.
float window_limit(std::size_t axes) {
    const auto degrees = static_cast<double>(axes * resolution::window_coefficients);
    return static_cast<float>(chi_squared_upper_quantile(degrees, resolution::candidate_chance));
}

double wilson_hilferty_limit(double degrees, double deviates) {
    const double part = 2.0 / (9.0 * degrees);
    const double root = 1.0 - part + deviates * std::sqrt(part);
    return degrees * root * root * root;
}

class LineEstimator final : public Estimator {
public:
    LineEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), prediction_(std::move(prediction)) {
        const double places = 2.0 * static_cast<double>(length()) / prediction_->rate_hz();
        first_ = std::max(resolution::place_min,
                          static_cast<std::size_t>(std::ceil(decisions.slowest_line_hz * places)));
    }

    std::optional<Finding> find(const Observation& observation) const override {
        std::vector<Candidate> candidates = scan(observation);
        if (candidates.empty()) { return std::nullopt; }
        std::vector<std::pair<double, double>> tried;  // gain, place
        tried.reserve(candidates.size());
        for (const Candidate& candidate : candidates) {
            tried.push_back(best_place(observation, static_cast<double>(candidate.k), 0.5,
                                       2 * static_cast<int>(resolution::window_coefficients) - 1,
                                       resolution::coarse_reach));
        }
        std::ranges::sort(tried, std::greater<>());
        tried.resize(std::min(tried.size(), resolution::refined_most));
        std::optional<Finding> best;
        for (const auto& [rough, place] : tried) {
            std::optional<Finding> finding = fit_at(observation, refined_place(observation, place));
            if (finding && (!best || finding->evidence_nats > best->evidence_nats)) {
                best = std::move(finding);
            }
        }
        if (best) { refer_to_model(*best); }
        return best;
    }

private:
    std::size_t length() const { return prediction_->length(); }
    double duration_s() const { return prediction_->duration_s(); }
    double f_hz_of(double place) const { return place / (2.0 * duration_s()); }

    // 1 / mean square by coefficient, from its bin.
    std::vector<double> weights(const AxisObservation& seen, std::size_t first, std::size_t end) const {
        std::vector<double> out(end - first);
        std::size_t bin = bin_of(first);
        for (std::size_t k = first; k < end; ++k) {
            while (bin + 1 < prediction_->bins().size() && prediction_->bins()[bin].end <= k) { ++bin; }
            if (!has_coefficient(prediction_->half(), k)) { continue; }
            out[k - first] = 1.0 / (seen.density[bin] * prediction_->rate_hz());
        }
        return out;
    }

    std::size_t bin_of(std::size_t k) const {
        const auto after = std::ranges::upper_bound(prediction_->bins(), k, {}, &SpectralBin::first);
        return after == prediction_->bins().begin()
                   ? 0
                   : static_cast<std::size_t>(after - prediction_->bins().begin()) - 1;
    }

    // Squares of coefficients first ... end - 1 in units of what is around: the expected density or, where
    // that is more, the median of groups. Robust: a few lines in a block do not change it.
    void fill_squares(const AxisObservation& seen, std::size_t first, std::size_t end,
                      std::vector<float>& squares) const {
        squares.assign(end - first, 0.0F);
        std::size_t k = first;
        for (std::size_t bin = bin_of(first); k < end && bin < prediction_->bins().size(); ++bin) {
            const auto weight = static_cast<float>(1.0 / (seen.density[bin] * prediction_->rate_hz()));
            for (; k < std::min(end, prediction_->bins()[bin].end); ++k) {
                if (!prediction_->bins()[bin].has(k)) { continue; }
                squares[k - first] = weight * seen.cosines[k] * seen.cosines[k];
            }
        }
        std::vector<float> means;
        for (std::size_t at = 0; at + resolution::group_coefficients <= squares.size();
             at += resolution::group_coefficients) {
            float sum = 0.0F;
            for (std::size_t i = 0; i < resolution::group_coefficients; ++i) { sum += squares[at + i]; }
            means.push_back(sum / static_cast<float>(resolution::group_coefficients));
        }
        if (means.empty()) { return; }
        const auto middle = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
        std::ranges::nth_element(means, middle);
        // Of chi-square over its degrees of freedom (Wilson and Hilferty 1931).
        constexpr auto degrees = static_cast<double>(resolution::group_coefficients);
        const double median_of_group = wilson_hilferty_limit(degrees, 0.0) / degrees;
        const float level = *middle / static_cast<float>(median_of_group);
        if (!(level > 1.0F)) { return; }
        for (float& square : squares) { square /= level; }
    }

    // Windows that stand out, the best first, none that overlaps a better one.
    std::vector<Candidate> scan(const Observation& observation) const {
        std::vector<Candidate> found;
        std::array<std::vector<float>, 3> squares;
        const float of_one = window_limit(1);
        const float limit = window_limit(prediction_->axes().size());
        for (std::size_t first = first_; first + resolution::window_coefficients < length();
             first += resolution::block_coefficients - resolution::window_coefficients + 1) {
            const std::size_t end = std::min(length(), first + resolution::block_coefficients);
            if (end - first < resolution::group_coefficients) { break; }
            const std::size_t places = end - first - resolution::window_coefficients + 1;
            std::vector<float> all(places, 0.0F);
            std::vector<float> most(places, 0.0F);
            for (const std::size_t axis : prediction_->axes()) {
                fill_squares(observation.axis(axis), first, end, squares[axis]);
                for (std::size_t i = 0; i < places; ++i) {
                    float sum = 0.0F;
                    for (std::size_t j = 0; j < resolution::window_coefficients; ++j) {
                        sum += squares[axis][i + j];
                    }
                    all[i] += sum;
                    most[i] = std::max(most[i], sum);
                }
            }
            for (std::size_t i = 0; i < places; ++i) {
                const float excess = std::max(most[i] - of_one, all[i] - limit);
                if (!(excess > 0.0F)) { continue; }
                if (!found.empty() && first + i < found.back().k + resolution::window_coefficients) {
                    if (excess > found.back().excess) { found.back() = {first + i, excess}; }
                    continue;
                }
                found.push_back({first + i, excess});
            }
        }
        std::ranges::sort(found, std::greater<>(), &Candidate::excess);
        found.resize(std::min(found.size(), resolution::candidates_most));
        return found;
    }

    std::pair<std::size_t, std::size_t> around(double place, std::size_t most) const {
        const auto middle = static_cast<std::size_t>(std::lround(place));
        const std::size_t first = middle > most ? middle - most : 1;
        return {first, std::min(length(), middle + most + 1)};
    }

    LineFit fit_axis(const AxisObservation& seen, double place, std::size_t most) const {
        const auto [first, end] = around(place, most);
        return fit_line(length(), place, first, std::span(seen.cosines).subspan(first, end - first),
                        weights(seen, first, end));
    }

    double gain_at(const Observation& observation, double place, std::size_t most) const {
        double sum = 0.0;
        for (const std::size_t axis : prediction_->axes()) {
            sum += fit_axis(observation.axis(axis), place, most).gain_nats;
        }
        return sum;
    }

    // Gain and place; of `count` places from `from` on.
    std::pair<double, double> best_place(const Observation& observation, double from, double step, int count,
                                         std::size_t most) const {
        std::pair<double, double> best{-1.0, from};
        const double last = static_cast<double>(length()) - 1.0;
        for (int i = 0; i < count; ++i) {
            const double place = std::min(from + i * step, last);
            best = std::max(best, {gain_at(observation, place, most), place});
        }
        return best;
    }

    double refined_place(const Observation& observation, double place) const {
        double step = 0.25;
        while (step > 1e-5) {
            place = best_place(observation, place - 2.0 * step, step, 5, resolution::line_reach).second;
            step *= 0.25;
        }
        return place;
    }

    // Mean square of what the line leaves around it, against the expected density, where that is more than
    // chance makes of it.
    double floor_around(const AxisObservation& seen, const SteadyLine& line) const {
        const LineShape shape(length(), line.place);
        double floor = 1.0;
        for (const std::size_t most : {std::size_t{8}, std::size_t{32}, std::size_t{128}}) {
            const auto [first, end] = around(line.place, most);
            const std::vector<double> weight = weights(seen, first, end);
            double sum = 0.0;
            double count = 0.0;
            for (std::size_t k = first; k < end; ++k) {
                count += weight[k - first] > 0.0 ? 1.0 : 0.0;
                const auto [cosine, sine] = shape.at(k);
                const double left =
                    static_cast<double>(seen.cosines[k]) - line.cosine * cosine - line.sine * sine;
                sum += weight[k - first] * left * left;
            }
            const double degrees = std::max(1.0, count - definition::line_parameters);
            if (sum > wilson_hilferty_limit(degrees, decisions.certain_sigma)) {
                floor = std::max(floor, sum / degrees);
            }
        }
        return floor;
    }

    // By how much the log-likelihood of the bins grows when the line is taken off and N, B and K are fitted
    // again.
    double refitted_gain(const AxisObservation& seen, std::size_t axis, const SteadyLine& line) const {
        std::vector<double> power = seen.power;
        const LineShape shape(length(), line.place);
        const auto [first, end] = around(line.place, resolution::removed_reach);
        std::size_t bin = bin_of(first);
        for (std::size_t k = first; k < end; ++k) {
            while (bin + 1 < prediction_->bins().size() && prediction_->bins()[bin].end <= k) { ++bin; }
            if (!has_coefficient(prediction_->half(), k)) { continue; }
            const auto [cosine, sine] = shape.at(k);
            const double part = line.cosine * cosine + line.sine * sine;
            const double change = part * (part - 2.0 * static_cast<double>(seen.cosines[k]));
            power[bin] += change / (prediction_->bins()[bin].count() * prediction_->rate_hz());
        }
        for (double& density : power) { density = std::max(density, 0.0); }
        return fit_nuisance(prediction_->bins(), prediction_->parts(axis), power,
                            noise_uncertainty(prediction_->model(), axis), seen.noise)
                   .log_likelihood_nats -
               seen.noise.log_likelihood_nats;
    }

    std::optional<Finding> fit_at(const Observation& observation, double place) const {
        std::vector<AxisLine> lines;
        std::vector<AxesFit> fits;
        for (const std::size_t axis : prediction_->axes()) {
            const AxisObservation& seen = observation.axis(axis);
            AxisLine line{axis, fit_axis(seen, place, resolution::line_reach), 1.0};
            if (!(line.fit.gain_nats > 0.0)) { continue; }
            line.floor = floor_around(seen, line.fit.line);
            line.fit.gain_nats = std::max(refitted_gain(seen, axis, line.fit.line), 0.0);
            if (!(line.gain_nats() > 0.0)) { continue; }
            lines.push_back(line);
            fits.push_back(fit_of(line, observation));
        }
        std::optional<Finding> finding = best_of(effect_, fits, 0.0, std::nullopt);
        if (!finding) { return std::nullopt; }
        double gain_nats = 0.0;
        for (const AxisLine& line : lines) {
            if (std::ranges::count(finding->where.axes, line.axis) != 0) { gain_nats += line.gain_nats(); }
        }
        const double f_hz = f_hz_of(place);
        const double f_sd_hz = std::sqrt(6.0 / gain_nats) / (2.0 * pi * duration_s());
        finding->evidence_nats -= parameter_cost_nats(0.5 * prediction_->rate_hz(), f_sd_hz);
        finding->parameters += 1;
        for (std::size_t i = 0; i < finding->entries.size(); ++i) {
            finding->entries[i].params["f_hz"] = f_hz;
            finding->sd[i]["f_hz"] = f_sd_hz;
        }
        // The sample clock, to which a frequency refers, is known to some 1e-4; and what of one bin shows.
        const double half_hz = 4.0 * f_sd_hz + 1.0 / duration_s() + 2e-4 * f_hz;
        finding->where.freq_hz = Span{std::max(0.0, f_hz - half_hz), f_hz + half_hz};
        return finding;
    }

    AxesFit fit_of(const AxisLine& line, const Observation& observation) const {
        const SteadyLine& at = line.fit.line;
        // In a hole there is none of it.
        const double present = static_cast<double>(std::ranges::count(observation.present(), true)) /
                               static_cast<double>(length());
        const double amplitude_dps = std::hypot(at.cosine, at.sine) / present * deg_per_rad;
        const double sd_of_log = 1.0 / std::sqrt(2.0 * line.gain_nats());
        // About the first sample instead of half a sample before it; there the frequency's error counts too.
        const double phase_rad =
            std::atan2(at.cosine, at.sine) + 0.5 * pi * at.place / static_cast<double>(length());
        AxesFit fit;
        fit.axes = {line.axis};
        fit.gain_nats = {line.gain_nats()};
        fit.params = {{"amplitude_dps", amplitude_dps}, {"phase_rad", phase_rad}};
        fit.sd = {{"amplitude_dps", amplitude_dps * sd_of_log}, {"phase_rad", 2.0 * sd_of_log}};
        fit.cost_nats =
            occam_cost_nats(param_of(effect_, "amplitude_dps"), amplitude_dps, amplitude_dps * sd_of_log) +
            occam_cost_nats(param_of(effect_, "phase_rad"), phase_rad, sd_of_log) +
            axis_membership_nats(prediction_->axes().size());
        return fit;
    }

    // What else the model has, a delay or a scale, acts on what is added: entries are such that the line
    // comes out as it was seen.
    void refer_to_model(Finding& finding) const {
        SensorModel model = without_noise(
            without_what_is_recorded(prediction_->model(), prediction_->world()), prediction_->world());
        model.full_scale_rad_s = model.saturation_rad_s = 1e6;
        for (EffectModel& entry : finding.entries) {
            const std::size_t axis = axis_of(entry);
            const double f_hz = entry.params.at("f_hz");
            // A hidden clock reads the world faster or slower than its samples follow each other.
            entry.params["f_hz"] = f_hz / world_time_per_time(model);
            EffectModel unit = entry;
            unit.params = {{"f_hz", entry.params.at("f_hz")}, {"amplitude_dps", 1.0}, {"phase_rad", 0.0}};
            SensorModel with = model;
            with.effects.push_back(unit);
            const auto [gain, phase_rad] = response(model, with, axis, f_hz);
            if (gain > 1e-6) { entry.params["amplitude_dps"] /= gain; }
            double& phase = entry.params["phase_rad"];
            phase = std::remainder(phase - phase_rad, 2.0 * pi);
        }
    }

    std::size_t axis_of(const EffectModel& entry) const {
        for (const std::size_t axis : prediction_->axes()) {
            if (std::ranges::count(entry.axes, axis_names[axis]) != 0) { return axis; }
        }
        return 0;
    }

    double world_time_per_time(SensorModel model) const {
        // What is held again and again keeps the world's pace.
        std::erase_if(model.effects,
                      [](const EffectModel& entry) { return find_effect(entry.effect)->noise_only; });
        SensorSimulator simulator(model, prediction_->rate_hz(), 1);
        const SampleBlock& first = simulator.next_block();
        return (first.world_s.back() - first.world_s.front()) * prediction_->rate_hz() /
               static_cast<double>(block_samples - 1);
    }

    // Amplitude in deg/s and phase by which the models' answers differ at rest.
    std::pair<double, double> response(const SensorModel& without, const SensorModel& with, std::size_t axis,
                                       double f_hz) const {
        SensorSimulator plain(without, prediction_->rate_hz(), 1);
        SensorSimulator changed(with, prediction_->rate_hz(), 1);
        double cc = 0.0, cs = 0.0, ss = 0.0, cy = 0.0, sy = 0.0;
        double last = 0.0;
        for (std::size_t b = 0; b < resolution::response_blocks; ++b) {
            const SampleBlock& before = plain.next_block();
            const SampleBlock& after = changed.next_block();
            if (b < resolution::blocks_to_settle) { continue; }
            for (std::size_t i = 0; i < block_samples; ++i) {
                const double angle =
                    2.0 * pi * f_hz * static_cast<double>(b * block_samples + i) / prediction_->rate_hz();
                const double c = std::cos(angle);
                const double s = std::sin(angle);
                const double y = (after.rate_rad_s[axis][i] - before.rate_rad_s[axis][i]) * deg_per_rad;
                // Repeats are not judged; and a beat has them where the line is oldest.
                if (std::exchange(last, y) == y) { continue; }
                cc += c * c;
                cs += c * s;
                ss += s * s;
                cy += c * y;
                sy += s * y;
            }
        }
        const double determinant = cc * ss - cs * cs;
        if (!(determinant > 1e-9 * cc * ss)) { return {1.0, 0.0}; }
        const double cosine = (ss * cy - cs * sy) / determinant;
        const double sine = (cc * sy - cs * cy) / determinant;
        return {std::hypot(cosine, sine), std::atan2(cosine, sine)};
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    std::size_t first_ = 1;
};

}  // namespace

MadeEstimator make_line_estimator(const EffectDefinition& effect,
                                  std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<LineEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
