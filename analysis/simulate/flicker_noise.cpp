#include "analysis/simulate/flicker_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

namespace {

constexpr double filter_side = 0.093882;  // weights: side, 1 - 2 side, side
constexpr std::size_t ratio = 4;          // of the grids
constexpr std::size_t chunk = 1024;
constexpr std::uint64_t offset_draw = std::uint64_t{1} << 62U;  // of a stream; no sample reaches it

}  // namespace

FlickerNoise::FlickerNoise(double B_rad_per_s, std::span<const RandomStream> streams)
    : B_rad_per_s_(B_rad_per_s), fastest_{fastest, streams[0]} {
    for (const RandomStream& stream : streams.subspan(1)) {
        levels_.push_back({.process = {levels_.empty() ? fast : slower, stream}});
    }
    // The slowest first: each level's line needs its first two knots from the level above.
    for (std::size_t level = levels_.size() - 1; level-- > 0;) {
        const RandomStream& slower_stream = levels_[level + 1].process.stream;
        levels_[level].offset =
            static_cast<std::uint64_t>(slower_stream.uniform(offset_draw) * static_cast<double>(ratio));
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

void FlickerNoise::Process::produce(std::uint64_t first, std::span<double> out) {
    const double a = kind.correlation;
    const double innovation = std::sqrt(kind.variance * (1.0 - a * a));
    stream.normals(first, out);
    std::size_t i = 0;
    if (first == 0 && !out.empty()) {
        state = std::sqrt(kind.variance) * out[0];
        out[i++] = state;
    }
    double x = state;
    for (; i < out.size(); ++i) {
        x = a * x + innovation * out[i];
        out[i] = x;
    }
    state = x;
}

// At most `chunk` values.
void FlickerNoise::produce(std::size_t level, std::span<double> out) {
    Level& self = levels_[level];
    const std::uint64_t first = self.position;
    self.position += out.size();
    self.process.produce(first, out);
    if (level == 0) {
        std::array<double, chunk> more;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        fastest_.produce(first, std::span(more).first(out.size()));
        for (std::size_t i = 0; i < out.size(); ++i) { out[i] += more[i]; }
    }
    if (level + 1 < levels_.size()) { add_slower(level, first + self.offset, out); }
}

void FlickerNoise::add_slower(std::size_t level, std::uint64_t first, std::span<double> out) {
    Level& self = levels_[level];
    const std::uint64_t end = first + out.size();
    // `first` counts from a knot. One is passed at every multiple of the ratio but 0, where the constructor
    // has set both.
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

double FlickerNoise::slowest_frequency(unsigned processes) {
    // The slowest process is flat below about a fifth of the rate of its grid, which is ratio^(processes - 2)
    // samples.
    return 0.2 * std::pow(static_cast<double>(ratio), 2.0 - static_cast<double>(processes));
}

double FlickerNoise::psd_of(const GaussMarkov& process, double phase) {
    const double a = process.correlation;
    return process.variance * (1.0 - a * a) / (1.0 - 2.0 * a * std::cos(phase) + a * a);
}

double FlickerNoise::expected_psd(double nu, unsigned processes) {
    const double phase = 2.0 * pi * nu;
    double sum = psd_of(fastest, phase) + psd_of(fast, phase);
    double step = 1.0;  // samples between the points of the process's grid
    for (unsigned process = 2; process < processes; ++process) {
        step *= static_cast<double>(ratio);
        // Straight lines between points `step` apart: the grid's spectrum, repeated, times the triangle's
        // transform.
        const double kernel = std::sin(0.5 * phase * step) / std::sin(0.5 * phase);
        sum += psd_of(slower, phase * step) * std::pow(kernel, 4) / (step * step * step);
    }
    const double filter = 1.0 - 4.0 * filter_side * std::pow(std::sin(0.5 * phase), 2);
    return sum * filter * filter;
}

}  // namespace gyrolog
