// Recordings at rest whose temperature takes a course, with columns of noise that knows nothing of it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog::test {

enum class Course { ramp, warm_up, walk };

// Of some degC: a straight line, an exponential with a seventh of the record as its time constant, or a
// random walk of this seed.
inline std::vector<double> temperature_course(Course course, std::size_t samples, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> temperature_C(samples);
    double walk_C = 25.0;
    for (std::size_t i = 0; i < samples; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(samples);
        walk_C += 3.0 / std::sqrt(static_cast<double>(samples)) * normal(random);
        temperature_C[i] = course == Course::ramp      ? 22.0 + 8.0 * part
                           : course == Course::warm_up ? 30.0 - 8.0 * std::exp(-7.0 * part)
                                                       : walk_C;
    }
    return temperature_C;
}

// Columns gx, gy, ... in rad/s, and temp.
inline Recording with_temperature(std::vector<std::vector<double>> columns, double rate_hz,
                                  std::vector<double> temperature_C) {
    Recording recording;
    recording.name = "test";
    recording.rate_hz = rate_hz;
    recording.segments = {{0, temperature_C.size(), 0}};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::string axis(1, "xyz"[i % 3]);
        const std::string unit = i < 3 ? "" : std::to_string(i / 3 + 1);
        recording.columns.push_back({"g" + axis + unit, "rad/s", std::move(columns[i]), 1.0, 0.0, "rad_s"});
    }
    recording.columns.push_back({"temp", "degC", std::move(temperature_C), 1.0, 0.0, "C"});
    return recording;
}

}  // namespace gyrolog::test
