#include "analysis/noise/outliers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gyrolog {
namespace {

constexpr std::size_t reach = 5;
constexpr std::size_t window = 2 * reach + 1;
constexpr double sd_per_median_deviation = 1.4826;
constexpr std::size_t enough_for_scale = 1'000'000;

// Median of the window around i, cut off at the segment's ends.
template <typename T>
double local_median(std::span<const T> data, std::size_t i) {
    const std::size_t begin = i < reach ? 0 : i - reach;
    const std::size_t end = std::min(i + reach + 1, data.size());
    std::array<T, window> near{};
    std::copy(data.begin() + static_cast<std::ptrdiff_t>(begin),
              data.begin() + static_cast<std::ptrdiff_t>(end), near.begin());
    const auto middle = near.begin() + static_cast<std::ptrdiff_t>((end - begin) / 2);
    std::nth_element(near.begin(), middle, near.begin() + static_cast<std::ptrdiff_t>(end - begin));
    return static_cast<double>(*middle);
}

template <typename T>
double robust_sd(std::span<const T> data, std::span<const Segment> segments) {
    const std::size_t every = std::max<std::size_t>(1, data.size() / enough_for_scale);
    std::vector<double> distances;
    for (const Segment& segment : segments) {
        const auto part = data.subspan(segment.first, segment.count);
        for (std::size_t i = 0; i < part.size(); i += every) {
            distances.push_back(std::abs(static_cast<double>(part[i]) - local_median(part, i)));
        }
    }
    if (distances.empty()) { return 0.0; }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    return sd_per_median_deviation * *middle;
}

template <typename T>
OutlierCount replace(std::vector<T>& data, std::span<const Segment> segments, double sigmas) {
    OutlierCount count;
    count.threshold = sigmas * robust_sd(std::span<const T>(data), segments);
    if (!(count.threshold > 0.0)) { return count; }
    std::vector<std::pair<std::size_t, T>> found;  // the medians are those of the samples as they were
    for (const Segment& segment : segments) {
        const auto part = std::span<const T>(data).subspan(segment.first, segment.count);
        for (std::size_t i = 0; i < part.size(); ++i) {
            const double median = local_median(part, i);
            if (std::abs(static_cast<double>(part[i]) - median) > count.threshold) {
                found.emplace_back(segment.first + i, static_cast<T>(median));
            }
        }
    }
    for (const auto& [at, value] : found) { data[at] = value; }
    count.samples = found.size();
    return count;
}

}  // namespace

OutlierCount replace_outliers(Column& column, std::span<const Segment> segments, double sigmas) {
    OutlierCount count = std::visit([&](auto& data) { return replace(data, segments, sigmas); }, column.data);
    count.threshold *= std::abs(column.scale);
    return count;
}

}  // namespace gyrolog
