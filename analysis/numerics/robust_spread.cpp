#include "analysis/numerics/robust_spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "analysis/numerics/distributions.hpp"

namespace gyrolog {
namespace {

constexpr double gaussian_efficiency = 0.3675;

double unbiasing_factor(std::size_t count) {
    constexpr std::array few{1.196, 1.495, 1.363, 1.206, 1.200, 1.140, 1.129, 1.107};  // of 2 to 9
    if (count < 2) { return 1.0; }
    if (count - 2 < few.size()) { return few[count - 2]; }
    const auto n = static_cast<double>(count);
    return n / (n - 0.8);
}

double root_of_what_is_left(double square, double taken) { return std::sqrt(std::max(0.0, square - taken)); }

}  // namespace

double median_of(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    if (sorted.size() % 2 == 1) { return *middle; }
    return 0.5 * (*middle + *std::max_element(sorted.begin(), middle));
}

RobustSpread robust_spread(std::span<const double> values, std::span<const double> uncertainties,
                           const RobustSpreadOptions& options) {
    RobustSpread spread;
    spread.count = values.size();
    spread.median = median_of(values);
    std::vector<double> off;
    off.reserve(values.size());
    for (const double value : values) { off.push_back(std::abs(value - spread.median)); }
    spread.observed_sd = unbiasing_factor(values.size()) * per_median_absolute_deviation * median_of(off);

    std::vector<double> own_squares;
    own_squares.reserve(uncertainties.size());
    for (const double uncertainty : uncertainties) { own_squares.push_back(uncertainty * uncertainty); }
    const double own = median_of(own_squares);
    const double square = spread.observed_sd * spread.observed_sd;
    const double degrees = gaussian_efficiency * (static_cast<double>(values.size()) - 1.0);
    const double tail = 0.5 * (1.0 - options.probability);
    spread.sd = root_of_what_is_left(square, own);
    spread.sd_lo = root_of_what_is_left(square * degrees / chi_squared_upper_quantile(degrees, tail), own);
    spread.sd_hi = root_of_what_is_left(square * degrees / chi_squared_quantile(degrees, tail), own);
    return spread;
}

}  // namespace gyrolog
