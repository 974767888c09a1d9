#include "analysis/diagnose/estimators/stamp_scatter.hpp"

#include <array>
#include <cmath>

#include "analysis/noise/noise_model.hpp"
#include "analysis/numerics/square.hpp"

namespace gyrolog::resolution {

constexpr std::size_t stamps_min = 16;
constexpr std::array resolutions_s = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace definition {

// Second differences of independent errors, and absolute values in place of squares: the variance of the
// estimated sigma is larger by 1 + 2 (4/6)^2 + 2 (1/6)^2 and by pi - 2 over 1.
constexpr double differences_in_one = (1.0 + 2.0 * square(4.0 / 6.0) + 2.0 * square(1.0 / 6.0)) * (pi - 2.0);

}  // namespace definition

namespace {

double resolution_of(const std::vector<double>& t_s) {
    for (const double resolution_s : resolution::resolutions_s) {
        // Of a double that holds seconds since 1970.
        const double tolerance_s = std::max(1e-3 * resolution_s, 4e-16 * std::fabs(t_s.back()));
        if (tolerance_s > 0.1 * resolution_s) { return 0.0; }
        bool multiples = true;
        for (std::size_t i = 1; i < t_s.size() && multiples; ++i) {
            const double off_s = t_s[i] - t_s.front();
            multiples = std::fabs(off_s - std::round(off_s / resolution_s) * resolution_s) < tolerance_s;
        }
        if (multiples) { return resolution_s; }
    }
    return 0.0;
}

// Distances of the stamps from a straight line over their slots.
std::vector<double> distances_s(const Recording& recording) {
    std::vector<double> at_s;
    std::vector<double> off_s;
    at_s.reserve(recording.t_s.size());
    off_s.reserve(recording.t_s.size());
    double mean_at_s = 0.0;
    double mean_off_s = 0.0;
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const auto slot = static_cast<double>(segment.first_index + static_cast<std::int64_t>(i) -
                                                  recording.segments.front().first_index);
            at_s.push_back(slot / recording.rate_hz);
            off_s.push_back(recording.t_s[segment.first + i] - recording.t_s.front() - at_s.back());
            mean_at_s += at_s.back();
            mean_off_s += off_s.back();
        }
    }
    const auto n = static_cast<double>(off_s.size());
    mean_at_s /= n;
    mean_off_s /= n;
    double spread = 0.0;
    double product = 0.0;
    for (std::size_t i = 0; i < off_s.size(); ++i) {
        spread += (at_s[i] - mean_at_s) * (at_s[i] - mean_at_s);
        product += (at_s[i] - mean_at_s) * (off_s[i] - mean_off_s);
    }
    for (std::size_t i = 0; i < off_s.size(); ++i) {
        off_s[i] -= mean_off_s + product / spread * (at_s[i] - mean_at_s);
    }
    return off_s;
}

double neighbour_correlation(const Recording& recording) {
    const std::vector<double> off_s = distances_s(recording);
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 1; i < off_s.size(); ++i) {
        squares += off_s[i] * off_s[i];
        products += off_s[i] * off_s[i - 1];
    }
    return squares > 0.0 ? products / squares : 0.0;
}

}  // namespace

std::optional<StampScatter> stamp_scatter(const Recording& recording) {
    const std::vector<double>& t_s = recording.t_s;
    if (t_s.size() < resolution::stamps_min || t_s.size() != recording.rows()) { return std::nullopt; }
    double sum_s = 0.0;
    double count = 0.0;
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = segment.first + 2; i < segment.first + segment.count; ++i) {
            sum_s += std::fabs(t_s[i] - 2.0 * t_s[i - 1] + t_s[i - 2]);
            count += 1.0;
        }
    }
    if (count < static_cast<double>(resolution::stamps_min)) { return std::nullopt; }
    StampScatter scatter;
    scatter.sd_s = std::sqrt(pi / 2.0) * sum_s / (count * std::sqrt(6.0));
    scatter.independent = count / definition::differences_in_one;
    scatter.resolution_s = resolution_of(t_s);
    scatter.neighbour_correlation = neighbour_correlation(recording);
    return scatter;
}

}  // namespace gyrolog
