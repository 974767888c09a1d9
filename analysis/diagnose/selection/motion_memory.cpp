#include "analysis/diagnose/selection/motion_memory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/likelihood/effect_response.hpp"
#include "analysis/diagnose/likelihood/mean_regression.hpp"
#include "analysis/diagnose/selection/alternative_noise.hpp"

namespace gyrolog::resolution {

constexpr std::array<double, 5> time_constants_s = {1.0, 3.0, 10.0, 30.0, 100.0};

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

struct Drive {
    const char* words;
    double (*of)(double rate_rad_s);
};
constexpr std::array<Drive, 3> drives = {{{"rate", [](double rate) { return rate; }},
                                          {"size of the rate", [](double rate) { return std::fabs(rate); }},
                                          {"square of the rate", [](double rate) { return rate * rate; }}}};

std::vector<float> faded(const Prediction& prediction, std::size_t from, const Drive& drive,
                         double fades_in_s) {
    const std::vector<float>& rate = prediction.true_rate_rad_s(from);
    const double kept = std::exp(-1.0 / (fades_in_s * prediction.rate_hz()));
    std::vector<double> values(prediction.length());
    double state = 0.0;
    for (std::size_t slot = 0; slot < values.size(); ++slot) {
        state = kept * state + (1.0 - kept) * drive.of(static_cast<double>(rate[slot]));
        values[slot] = state;
    }
    prediction.transform()->forward(values);
    values[0] = 0.0;
    const auto end =
        values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), resolution::slow_coefficients));
    return {values.begin(), end};
}

double gain_nats(const Observation& seen, std::size_t axis, const std::vector<float>& cosines,
                 const std::vector<double>& density) {
    const MeanResponses response(seen.prediction(), axis, {cosines});
    const NormalEquations equations = MeanRegression(seen, axis, response).equations(density);
    const double weight = equations.A(0, 0);
    return weight > 0.0 ? 0.5 * equations.b[0] * equations.b[0] / weight : 0.0;
}

}  // namespace

std::optional<NonparametricFit> find_motion_memory(const Observation& without, const Observation& with) {
    const Prediction& prediction = without.prediction();
    if (!prediction.moves()) { return std::nullopt; }
    std::array<AlternativeNoise, 3> noise;
    double lost_nats = 0.0;
    for (const std::size_t axis : prediction.axes()) {
        noise[axis] = alternative_noise(without, with, axis);
        lost_nats += noise[axis].lost_nats;
    }
    const auto tries =
        static_cast<double>(resolution::time_constants_s.size() * drives.size() * prediction.axes().size());
    std::array<double, 3> best_nats{};
    double most_nats = 0.0;
    std::array<char, 128> words{};
    for (const std::size_t from : prediction.axes()) {
        for (const Drive& drive : drives) {
            for (const double fades_in_s : resolution::time_constants_s) {
                const std::vector<float> cosines = faded(prediction, from, drive, fades_in_s);
                for (const std::size_t axis : prediction.axes()) {
                    const double gain = gain_nats(without, axis, cosines, noise[axis].density);
                    const double nats =
                        gain - 0.5 * std::log1p(2.0 * gain) - decisions.strong_nats - std::log(tries);
                    best_nats[axis] = std::max(best_nats[axis], nats);
                    if (nats <= most_nats) { continue; }
                    most_nats = nats;
                    (void)std::snprintf(words.data(), words.size(),
                                        "A bias that follows the %s about %s and fades in some %g s",
                                        drive.words, axis_names.at(from), fades_in_s);
                }
            }
        }
    }
    if (!(most_nats > 0.0)) { return std::nullopt; }
    return NonparametricFit{words.data(), best_nats[0] + best_nats[1] + best_nats[2] - lost_nats};
}

}  // namespace gyrolog
