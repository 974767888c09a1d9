#include "analysis/diagnose/likelihood/level_changes.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/numerics/square.hpp"

namespace gyrolog {

namespace {

struct Window {
    std::size_t first = 0;
    std::size_t end = 0;
    double gain_nats = 0.0;
};

class LevelSearch {
public:
    explicit LevelSearch(std::span<const float> cosines) : sums_(1, 0.0) {
        sums_.reserve(cosines.size() + 1);
        for (const float cosine : cosines) {
            sums_.push_back(sums_.back() + square(static_cast<double>(cosine)));
        }
        // Windows of each width overlap by half: all in all two for each coefficient.
        windows_nats_ = std::log(2.0 * static_cast<double>(cosines.size()));
    }

    void cut(std::size_t first, std::size_t end) {
        const Window window = most_telling(first, end);
        if (!(window.gain_nats > windows_nats_ + std::log(static_cast<double>(end - first)))) { return; }
        const std::size_t edges[] = {first, window.first, window.end, end};
        for (std::size_t part = 0; part + 1 < std::size(edges); ++part) {
            if (edges[part] == edges[part + 1]) { continue; }
            if (edges[part] != first) { changes_.push_back(edges[part]); }
            cut(edges[part], edges[part + 1]);
        }
    }

    std::vector<std::size_t> changes() && {
        std::ranges::sort(changes_);
        return std::move(changes_);
    }

private:
    Window most_telling(std::size_t first, std::size_t end) const {
        Window best;
        const auto take = [&](std::size_t from, std::size_t to) {
            const double gain_nats = this->gain_nats(first, from, to, end);
            if (gain_nats > best.gain_nats) { best = {from, to, gain_nats}; }
        };
        for (std::size_t width = 1; width < end - first; width *= 2) {
            const std::size_t step = std::max<std::size_t>(1, width / 2);
            for (std::size_t from = first; from + width <= end; from += step) { take(from, from + width); }
        }
        for (std::size_t step = (best.end - best.first) / 2; step > 0; step /= 2) {
            const Window coarse = best;
            for (const std::size_t from :
                 {coarse.first - std::min(step, coarse.first - first), coarse.first, coarse.first + step}) {
                for (const std::size_t to :
                     {coarse.end - step, coarse.end, std::min(coarse.end + step, end)}) {
                    if (from < to) { take(from, to); }
                }
            }
        }
        return best;
    }

    // What two levels tell more than one. Between a constant's coefficients, which are none, it is nothing.
    double gain_nats(std::size_t first, std::size_t from, std::size_t to, std::size_t end) const {
        const double inside = sum(from, to);
        const double outside = sum(first, from) + sum(to, end);
        if (!(inside > 0.0 && outside > 0.0)) { return 0.0; }
        return level_nats(inside, to - from) + level_nats(outside, end - first - (to - from)) -
               level_nats(inside + outside, end - first);
    }

    double sum(std::size_t first, std::size_t end) const { return sums_[end] - sums_[first]; }

    // The log-likelihood of normal coefficients at their own level, but for what every division has.
    static double level_nats(double sum, std::size_t count) {
        const auto n = static_cast<double>(count);
        return -0.5 * n * std::log(sum / n);
    }

    std::vector<double> sums_;  // of the squares, before each coefficient
    double windows_nats_ = 0.0;
    std::vector<std::size_t> changes_;
};

}  // namespace

std::vector<std::size_t> level_changes(std::span<const float> cosines, const SpectralBins& bins) {
    LevelSearch search(cosines);
    for (const SpectralBin& bin : bins) { search.cut(bin.first, bin.end); }
    return std::move(search).changes();
}

}  // namespace gyrolog
