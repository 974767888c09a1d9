// Records of noise of a known spectrum, made the plain way.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog::test {

enum class Colour { white, flicker, walk };

inline std::string_view name_of(Colour colour) {
    constexpr std::array<std::string_view, 3> names{"White", "Flicker", "Walk"};
    return names.at(static_cast<std::size_t>(colour));
}

// white: variance 1. flicker: first-order processes an octave apart. walk: the sum of white.
inline std::vector<double> coloured_noise(Colour colour, std::size_t samples, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    std::array<double, 20> states{};
    for (double& state : states) { state = normal(random); }
    double walk = 0.0;
    std::vector<double> x(samples);
    for (double& value : x) {
        if (colour == Colour::white) { value = normal(random); }
        if (colour == Colour::walk) { value = walk += normal(random); }
        if (colour != Colour::flicker) { continue; }
        value = 0.0;
        double corner = 2.0;
        for (double& state : states) {
            const double kept = std::exp(-corner);
            state = kept * state + std::sqrt(1.0 - kept * kept) * normal(random);
            value += state;
            corner /= 2.0;
        }
    }
    return x;
}

inline std::vector<double> white_noise(std::size_t samples, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    return coloured_noise(Colour::white, samples, random);
}

inline void add_sine(std::vector<double>& x, double amplitude, double cycles_per_sample, double phase = 0.3) {
    for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] +=
            amplitude * std::sin(2.0 * std::numbers::pi * cycles_per_sample * static_cast<double>(i) + phase);
    }
}

inline Column column_of(std::vector<double> values) { return {"gx", "rad/s", std::move(values), 1.0}; }

inline std::vector<Segment> whole(std::size_t samples) { return {{0, samples, 0}}; }

// The record without `lost` samples after every `kept`.
struct Holed {
    Column column;
    std::vector<Segment> segments;
};

inline Holed with_holes(const std::vector<double>& x, std::size_t kept, std::size_t lost) {
    std::vector<double> left;
    std::vector<Segment> segments;
    for (std::size_t i = 0; i < x.size(); i += kept + lost) {
        const std::size_t count = std::min(kept, x.size() - i);
        segments.push_back({left.size(), count, static_cast<std::int64_t>(i)});
        left.insert(left.end(), x.begin() + static_cast<std::ptrdiff_t>(i),
                    x.begin() + static_cast<std::ptrdiff_t>(i + count));
    }
    return {column_of(std::move(left)), std::move(segments)};
}

}  // namespace gyrolog::test
