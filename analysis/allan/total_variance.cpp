#include "analysis/allan/total_variance.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {
namespace {

// T / tau: a stretch of so many terms has one sample more.
double averages_in(std::int64_t terms, std::int64_t m) {
    return static_cast<double>(terms + 1) / static_cast<double>(m);
}

// Sum over the terms of their variances, for angles of variance 1: 1 + 4 + 1, and 1 + 4 + 1 + 4 with an end
// point that comes twice.
double white_angle_sum(std::int64_t terms, std::int64_t m) {
    return 6.0 * static_cast<double>(terms) + 4.0 * static_cast<double>(2 * (m - 1));
}

}  // namespace

double total_edf(PowerLaw law, std::int64_t terms, std::int64_t m, double overlapping_edf) {
    const double averages = averages_in(terms, m);
    double edf = overlapping_edf;
    switch (law) {
        case PowerLaw::white_angle:
        case PowerLaw::flicker_angle: {
            const double mean = white_angle_sum(terms, m);
            const double of_ends = 2.0 * 2.0 * std::pow(4.0 * static_cast<double>(m - 1), 2);
            edf = 2.0 * mean * mean / (of_ends + 2.0 * mean * mean / overlapping_edf);
            break;
        }
        case PowerLaw::white_rate:
            edf = 1.500 * averages;
            break;
        case PowerLaw::flicker_rate:
            edf = 1.168 * averages - 0.222;
            break;
        case PowerLaw::rate_walk:
            edf = 0.927 * averages - 0.358;
            break;
    }
    return std::max(1.0, edf);
}

double total_bias(PowerLaw law, std::int64_t terms, std::int64_t m) {
    switch (law) {
        case PowerLaw::white_angle:
        case PowerLaw::flicker_angle:
            return white_angle_sum(terms, m) / (6.0 * static_cast<double>(terms));
        case PowerLaw::white_rate:
            return 1.0;
        case PowerLaw::flicker_rate:
            return 1.0 - 0.481 / averages_in(terms, m);
        case PowerLaw::rate_walk:
            return 1.0 - 0.750 / averages_in(terms, m);
    }
    return 1.0;
}

}  // namespace gyrolog
