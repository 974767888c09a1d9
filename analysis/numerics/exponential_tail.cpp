#include "analysis/numerics/exponential_tail.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

namespace gyrolog {

std::optional<ExponentialTail> ExponentialTail::of(std::span<const double> values,
                                                   const ExponentialTailOptions& options) {
    const double wanted = std::floor(options.share * static_cast<double>(values.size()));
    const std::size_t count = std::max(options.least, static_cast<std::size_t>(wanted));
    if (values.size() < 2 * count) { return std::nullopt; }
    std::vector<double> sorted(values.begin(), values.end());
    const auto tail_begin = sorted.end() - static_cast<std::ptrdiff_t>(count);
    std::ranges::nth_element(sorted, std::prev(tail_begin));
    std::sort(tail_begin, sorted.end());
    const auto seen =
        static_cast<std::size_t>(std::floor(static_cast<double>(count) * (1.0 - options.censored_share)));
    const std::size_t first = sorted.size() - count;
    ExponentialTail tail;
    tail.threshold_ = sorted[first - 1];
    tail.count_ = static_cast<double>(count);
    tail.seen_ = static_cast<double>(seen);
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        sum += sorted[first + std::min(i, seen - 1)] - tail.threshold_;
    }
    tail.mean_ = std::max(sum / tail.seen_, options.mean_least);
    return tail;
}

// The estimated mean is a gamma variable of shape `seen`, and the ratio of an excess to it has Lomax' tail,
// (1 + x / seen)^-seen.
double ExponentialTail::exceeded_in(double chance) const {
    return threshold_ + mean_ * seen_ * (std::pow(count_ / chance, 1.0 / seen_) - 1.0);
}

double ExponentialTail::end(std::vector<double> values, double chance, std::size_t others) const {
    std::erase_if(values, [&](double value) { return !(value > threshold_); });
    std::ranges::sort(values, std::greater{});
    double end = exceeded_in(chance);
    for (std::size_t beyond = 1; beyond <= values.size(); ++beyond) {
        const double of_so_many = exceeded_in(std::min(1.0, chance * static_cast<double>(beyond + others)));
        if (values[beyond - 1] > of_so_many) { end = of_so_many; }
    }
    return end;
}

std::vector<double> ExponentialTail::surprisals_nats(std::span<const double> values) const {
    struct Placed {
        double value = 0.0;
        std::size_t place = 0;
    };
    std::vector<Placed> sorted(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) { sorted[i] = {values[i], i}; }
    std::ranges::sort(sorted, {}, &Placed::value);
    const auto all = static_cast<double>(values.size());
    std::vector<double> nats(values.size());
    double of_equal_nats = 0.0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const double value = sorted[i].value;
        if (value > threshold_) {
            nats[sorted[i].place] = std::log(all / count_) + (value - threshold_) / mean_;
            continue;
        }
        const bool is_equal = i > 0 && value == sorted[i - 1].value;
        if (!is_equal) { of_equal_nats = -std::log((all - static_cast<double>(i)) / all); }
        nats[sorted[i].place] = of_equal_nats;
    }
    return nats;
}

}  // namespace gyrolog
