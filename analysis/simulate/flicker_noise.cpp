#include "analysis/simulate/flicker_noise.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

namespace {

// Per step of the process's own grid: correlation from one value to the next, and variance for B = 1.
struct GaussMarkov {
    double correlation;
    double variance;
};

constexpr GaussMarkov full_rate = {0.159133, 0.966187};
constexpr GaussMarkov slower = {0.264998, 0.579462};
constexpr double filter_side = 0.077061;  // weights: side, 1 - 2 side, side
constexpr std::size_t ratio = 4;
constexpr std::size_t chunk = 1024;

double gauss_markov_psd(const GaussMarkov& process, double phase) {
    const double a = process.correlation;
    return process.variance * (1.0 - a * a) / (1.0 - 2.0 * a * std::cos(phase) + a * a);
}

}  // namespace

FlickerNoise::FlickerNoise(double B_rad_per_s, std::vector<RandomStream> streams)
    : B_rad_per_s_(B_rad_per_s) {
    assert(streams.size() >= 2);
    for (RandomStream& stream : streams) { levels_.push_back({.stream = stream}); }
    // The slowest first: each level's line needs its first two knots from the level above.
    for (std::size_t level = levels_.size() - 1; level-- > 0;) {
        std::array<double, 2> knots{};
        produce(level + 1, knots);
        levels_[level].knot_before = knots[0];
        levels_[level].knot_after = knots[1];
    }
    std::array<double, 2> first{};
    produce(0, first);
    before_last_ = first[0];
    last_ = first[1];
}

void FlickerNoise::produce(std::size_t level, std::span<double> out) {
    Level& self = levels_[level];
    const GaussMarkov& process = level == 0 ? full_rate : slower;
    const double a = process.correlation;
    const double innovation = std::sqrt(process.variance * (1.0 - a * a));
    const std::uint64_t first = self.position;
    self.position += out.size();

    self.stream.normals(first, out);
    double state = self.state;
    std::size_t i = 0;
    if (first == 0 && !out.empty()) {
        state = std::sqrt(process.variance) * out[0];
        out[i++] = state;
    }
    for (; i < out.size(); ++i) {
        state = a * state + innovation * out[i];
        out[i] = state;
    }
    self.state = state;
    if (level + 1 < levels_.size()) { add_slower(level, first, out); }
}

void FlickerNoise::add_slower(std::size_t level, std::uint64_t first, std::span<double> out) {
    Level& self = levels_[level];
    const std::uint64_t end = first + out.size();
    // A knot is passed at every multiple of the ratio but 0, where the constructor has set both.
    const std::uint64_t passed = end == 0 ? 0 : (end - 1) / ratio;
    const std::uint64_t passed_before = first == 0 ? 0 : (first - 1) / ratio;
    std::array<double, chunk / ratio + 2> knots{};
    const std::span<double> fresh = std::span(knots).first(static_cast<std::size_t>(passed - passed_before));
    produce(level + 1, fresh);

    std::size_t next = 0;
    std::size_t i = 0;
    auto phase = static_cast<std::size_t>(first % ratio);
    while (i < out.size()) {
        if (phase == 0 && first + i != 0) {
            self.knot_before = self.knot_after;
            self.knot_after = fresh[next++];
        }
        const double step = (self.knot_after - self.knot_before) * (1.0 / static_cast<double>(ratio));
        for (; phase < ratio && i < out.size(); ++phase, ++i) {
            out[i] += self.knot_before + step * static_cast<double>(phase);
        }
        phase = 0;
    }
}

void FlickerNoise::add_next(std::span<double> out) {
    std::array<double, chunk> fresh{};
    const double side = filter_side * B_rad_per_s_;
    const double centre = (1.0 - 2.0 * filter_side) * B_rad_per_s_;
    while (!out.empty()) {
        const std::size_t n = std::min(out.size(), chunk);
        produce(0, std::span(fresh).first(n));
        for (std::size_t i = 0; i < n; ++i) {
            out[i] += side * (before_last_ + fresh[i]) + centre * last_;
            before_last_ = last_;
            last_ = fresh[i];
        }
        out = out.subspan(n);
    }
}

double FlickerNoise::slowest_frequency(unsigned levels) {
    // The slowest process is flat below about a tenth of its own grid's rate.
    return 0.1 * std::pow(static_cast<double>(ratio), 1.0 - static_cast<double>(levels - 1));
}

double FlickerNoise::expected_psd(double nu, unsigned levels) {
    const double phase = 2.0 * pi * nu;
    double sum = gauss_markov_psd(full_rate, phase);
    double step = 1.0;  // samples between the grid points of the level
    for (unsigned level = 1; level < levels; ++level) {
        step *= static_cast<double>(ratio);
        // Straight lines between points `step` apart: the grid's spectrum, repeated, times the triangle's
        // transform.
        const double kernel = std::sin(0.5 * phase * step) / std::sin(0.5 * phase);
        sum += gauss_markov_psd(slower, phase * step) * std::pow(kernel, 4) / (step * step * step);
    }
    const double filter = 1.0 - 4.0 * filter_side * std::pow(std::sin(0.5 * phase), 2);
    return sum * filter * filter;
}

}  // namespace gyrolog
