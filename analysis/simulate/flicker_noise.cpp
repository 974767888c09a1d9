#include "analysis/simulate/flicker_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

namespace {

constexpr double filter_side = 0.093882;  // weights: side, 1 - 2 side, side
constexpr std::size_t ratio = 4;          // of the grids
constexpr std::size_t chunk = 1024;
constexpr std::size_t knots_max = (chunk + ratio - 1) / ratio + 2;  // two known, the rest passed in a chunk
constexpr std::uint64_t offset_draw = std::uint64_t{1} << 62U;      // of a stream; no sample reaches it

}  // namespace

FlickerNoise::FlickerNoise(double B_rad_per_s, std::span<const RandomStream> streams)
    : B_rad_per_s_(B_rad_per_s), fastest_{streams[0], Recursion(fastest)} {
    for (const RandomStream& stream : streams.subspan(1)) {
        levels_.push_back({.process = {stream, Recursion(levels_.empty() ? fast : slower)}});
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

FlickerNoise::Recursion::Recursion(const GaussMarkov& kind)
    : correlation(kind.correlation),
      sd(std::sqrt(kind.variance)),
      innovation(std::sqrt(kind.variance * (1.0 - kind.correlation * kind.correlation))) {}

void FlickerNoise::Process::produce(std::uint64_t first, std::span<double> out) {
    stream.normals(first, out);
    std::size_t i = 0;
    if (first == 0 && !out.empty()) { out[i++] = recursion.start(out[0]); }
    Recursion local = recursion;  // stays in a register: `out` cannot alias it
    for (; i < out.size(); ++i) { out[i] = local.next(out[i]); }
    recursion = local;
}

// The two processes at the sample rate, side by side: a recursion waits for its own last value, and two wait
// no longer than one.
void FlickerNoise::produce_fastest(std::uint64_t first, std::span<double> out) {
    std::array<double, chunk> more;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    Process& other = levels_[0].process;
    fastest_.stream.normals(first, std::span(more).first(out.size()));
    other.stream.normals(first, out);
    std::size_t i = 0;
    if (first == 0 && !out.empty()) {
        out[i++] = other.recursion.start(out[0]) + fastest_.recursion.start(more[0]);
    }
    Recursion a = fastest_.recursion;
    Recursion b = other.recursion;
    for (; i < out.size(); ++i) { out[i] = b.next(out[i]) + a.next(more[i]); }
    fastest_.recursion = a;
    other.recursion = b;
}

// At most `chunk` values.
void FlickerNoise::produce(std::size_t level, std::span<double> out) {
    Level& self = levels_[level];
    const std::uint64_t first = std::exchange(self.position, self.position + out.size());
    if (level == 0) {
        produce_fastest(first, out);
    } else {
        self.process.produce(first, out);
    }
    if (level + 1 < levels_.size()) { add_slower(level, first + self.offset, out); }
}

void FlickerNoise::add_slower(std::size_t level, std::uint64_t first, std::span<double> out) {
    Level& self = levels_[level];
    auto phase = static_cast<std::size_t>(first % ratio);
    const std::size_t passed = (phase + out.size()) / ratio;  // knots up to the end of `out`
    std::array<double, knots_max> knots;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    knots[0] = self.knot_before;
    knots[1] = self.knot_after;
    produce(level + 1, std::span(knots).subspan(2, passed));

    const auto on_line = [&](std::size_t line, std::size_t place) {
        const double step = (knots[line + 1] - knots[line]) * (1.0 / static_cast<double>(ratio));
        return knots[line] + step * static_cast<double>(place);
    };
    std::size_t i = 0;
    std::size_t line = 0;
    for (; phase != 0 && i < out.size(); ++i) {
        out[i] += on_line(line, phase);
        phase = (phase + 1) % ratio;
        if (phase == 0) { ++line; }
    }
    for (; i + ratio <= out.size(); i += ratio, ++line) {
        for (std::size_t place = 0; place < ratio; ++place) { out[i + place] += on_line(line, place); }
    }
    for (; i < out.size(); ++i, ++phase) { out[i] += on_line(line, phase); }
    self.knot_before = knots[passed];
    self.knot_after = knots[passed + 1];
}

void FlickerNoise::add_next(std::span<double> out) {
    std::array<double, chunk + 2> x;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    const double side = filter_side * B_rad_per_s_;
    const double centre = (1.0 - 2.0 * filter_side) * B_rad_per_s_;
    while (!out.empty()) {
        const std::size_t n = std::min(out.size(), chunk);
        x[0] = before_last_;
        x[1] = last_;
        produce(0, std::span(x).subspan(2, n));
        for (std::size_t i = 0; i < n; ++i) { out[i] += side * (x[i] + x[i + 2]) + centre * x[i + 1]; }
        before_last_ = x[n];
        last_ = x[n + 1];
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
