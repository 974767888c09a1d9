// How often intervals hold the true deviation.
#pragma once

#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "tests/analysis/allan/gaussian_noise.hpp"

namespace gyrolog::test {

// The weights of the samples in one term of a deviation, and what its mean square is divided by. That of
// total deviation is the Allan variance, which it estimates.
inline double true_variance(DeviationKind kind, std::int64_t factor, const NoiseRecords& noise) {
    const auto m = static_cast<Eigen::Index>(factor);
    const double share = 1.0 / static_cast<double>(m);
    const bool hadamard = kind == DeviationKind::hadamard || kind == DeviationKind::overlapping_hadamard;
    const Eigen::Index windows = kind == DeviationKind::modified ? m : 1;
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(hadamard ? 3 * m : 2 * m + windows - 1);
    if (hadamard) {
        weights.head(m).setConstant(share);
        weights.segment(m, m).setConstant(-2.0 * share);
        weights.tail(m).setConstant(share);
    } else {
        for (Eigen::Index j = 0; j < windows; ++j) {
            weights.segment(j, m).array() -= share / static_cast<double>(windows);
            weights.segment(j + m, m).array() += share / static_cast<double>(windows);
        }
    }
    return noise.expected_square(weights) / (hadamard ? 6.0 : 2.0);
}

struct Coverage {
    double confidence = 0.0;
    std::vector<double> percent;  // at m = 1, 2, 4, ... as far as there is an estimate
};

inline std::vector<std::int64_t> octaves(Eigen::Index samples) {
    std::vector<std::int64_t> m;
    for (std::int64_t i = 1; 2 * i <= samples; i *= 2) { m.push_back(i); }
    return m;
}

// A record's samples that lie in `segments` of the grid; `first` of a segment counts those only.
inline std::vector<double> samples_in(const std::vector<Segment>& segments, const NoiseRecords& noise,
                                      Eigen::Index record) {
    std::vector<double> y;
    for (const Segment& segment : segments) {
        const auto part = noise.records.col(record).segment(static_cast<Eigen::Index>(segment.first_index),
                                                            static_cast<Eigen::Index>(segment.count));
        y.insert(y.end(), part.begin(), part.end());
    }
    return y;
}

inline Coverage coverage(const NoiseRecords& noise, DeviationKind kind, double confidence,
                         std::vector<Segment> segments) {
    const Eigen::Index samples = noise.records.rows();
    AllanOptions options;
    options.kind = kind;
    options.confidence = confidence;
    options.m = octaves(samples);
    if (segments.empty()) { segments = {{0, static_cast<std::size_t>(samples), 0}}; }
    Coverage result{confidence, {}};
    std::vector<double> truth;
    for (Eigen::Index record = 0; record < noise.records.cols(); ++record) {
        const Column y{"gx", "rad/s", samples_in(segments, noise, record), 1.0, 0.0, "rad_s"};
        const AllanCurve curve = allan_deviation(y, segments, 1.0, options);
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const AllanPoint& point = curve.points[i];
            if (truth.size() == i) {
                truth.push_back(std::sqrt(true_variance(kind, point.m, noise)));
                result.percent.push_back(0.0);
            }
            result.percent[i] += point.lo <= truth[i] && truth[i] <= point.hi ? 1.0 : 0.0;
        }
    }
    for (double& percent : result.percent) { percent *= 100.0 / static_cast<double>(noise.records.cols()); }
    return result;
}

// Prints a row of a table and expects every octave within so many points. Without segments: no holes.
inline void expect_coverage(const std::string& name, const NoiseRecords& noise, DeviationKind kind,
                            double tolerance_points, const std::vector<Segment>& segments = {}) {
    for (const double confidence : {0.683, 0.95}) {
        const Coverage result = coverage(noise, kind, confidence, segments);
        std::cout << std::fixed << std::setprecision(1) << "| " << name << " | " << 100.0 * confidence
                  << " %";
        for (const double percent : result.percent) {
            std::cout << " | " << percent;
            EXPECT_NEAR(percent, 100.0 * confidence, tolerance_points) << name;
        }
        std::cout << " |" << std::endl;
    }
}

}  // namespace gyrolog::test
