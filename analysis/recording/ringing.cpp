#include "analysis/recording/ringing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace gyrolog {
namespace {

double dot(std::span<const double> a, std::span<const double> b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) { sum += a[i] * b[i]; }
    return sum;
}

void take_mean_off(std::vector<double>& values) {
    double mean = 0.0;
    for (const double value : values) { mean += value / static_cast<double>(values.size()); }
    for (double& value : values) { value -= mean; }
}

// A cosine and a sine that die out, orthonormal to each other and to a level (Gram and Schmidt).
class Oscillation {
public:
    explicit Oscillation(std::size_t count) : cosine_(count), sine_(count) {}

    // The frequency in cycles, the decay in samples.
    void set(std::size_t onset, double cycles_per_sample, double decay_samples) {
        for (std::size_t i = 0; i < cosine_.size(); ++i) {
            const double since = static_cast<double>(i) - static_cast<double>(onset);
            const double height = i < onset ? 0.0 : std::exp(-since / decay_samples);
            const double phase = 2.0 * std::numbers::pi * cycles_per_sample * since;
            cosine_[i] = height * std::cos(phase);
            sine_[i] = height * std::sin(phase);
        }
        normalise(cosine_);
        take_mean_off(sine_);
        const double shared = dot(sine_, cosine_);
        for (std::size_t i = 0; i < sine_.size(); ++i) { sine_[i] -= shared * cosine_[i]; }
        normalise(sine_);
    }

    double explained(std::span<const double> values) const {
        return std::pow(dot(values, cosine_), 2) + std::pow(dot(values, sine_), 2);
    }

    void take_off(std::vector<double>& values) const {
        for (const std::vector<double>* part : {&cosine_, &sine_}) {
            const double size = dot(values, *part);
            for (std::size_t i = 0; i < values.size(); ++i) { values[i] -= size * (*part)[i]; }
        }
    }

private:
    // About its mean; what is a level alone becomes nothing.
    static void normalise(std::vector<double>& part) {
        take_mean_off(part);
        const double squares = dot(part, part);
        constexpr double rounding = 1e-12;  // of a sum of squares of values up to 1
        const double factor = squares > rounding ? 1.0 / std::sqrt(squares) : 0.0;
        for (double& value : part) { value *= factor; }
    }

    std::vector<double> cosine_;
    std::vector<double> sine_;
};

// By groups of the same size, the last of which may be smaller.
std::vector<double> means_of(std::span<const double> values, std::size_t group) {
    std::vector<double> means;
    for (std::size_t from = 0; from < values.size(); from += group) {
        const auto part = values.subspan(from, std::min(group, values.size() - from));
        double sum = 0.0;
        for (const double value : part) { sum += value; }
        means.push_back(sum / static_cast<double>(part.size()));
    }
    return means;
}

// Of values without their mean, looked for in means of some of them.
Oscillation best_of(std::span<const double> values, const RingingOptions& options) {
    const std::size_t group = (values.size() + options.means_most - 1) / options.means_most;
    std::vector<double> means = means_of(values, group);
    take_mean_off(means);
    const auto length = static_cast<double>(means.size());
    Oscillation tried(means.size());
    double most = 0.0;
    std::array<double, 3> place = {0.0, options.half_periods_least, options.decays.front()};
    const std::size_t step = (means.size() + options.onsets - 1) / options.onsets;
    for (std::size_t onset = 0; onset + options.values_least <= means.size(); onset += step) {
        for (std::size_t swing = 0; swing < options.swings; ++swing) {
            const double half_periods =
                options.half_periods_least + static_cast<double>(swing) * options.half_periods_step;
            for (const double decay : options.decays) {
                tried.set(onset, 0.5 * half_periods / length, decay * length);
                const double explained = tried.explained(means);
                if (explained > most) {
                    most = explained;
                    place = {static_cast<double>(onset), half_periods, decay};
                }
            }
        }
    }
    const auto all = static_cast<double>(values.size());
    Oscillation best(values.size());
    best.set(static_cast<std::size_t>(place[0]) * group, 0.5 * place[1] / all, place[2] * all);
    return best;
}

}  // namespace

std::vector<double> without_ringing(std::span<const double> values, const RingingOptions& options) {
    std::vector<double> left(values.begin(), values.end());
    take_mean_off(left);
    if (values.size() < options.values_least) { return left; }
    best_of(left, options).take_off(left);
    return left;
}

}  // namespace gyrolog
