#include "analysis/diagnose/likelihood/hole_filling.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "analysis/numerics/cosine_transform.hpp"

namespace gyrolog::resolution {

// How many samples on either side say what the level in a hole is: so many that what they have in common with
// the stand-ins is slower than the white noise reaches.
constexpr std::size_t level_samples = 256;
constexpr std::size_t level_reach = 2 * level_samples;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// The mean of the values that are present in a window, which moves on only.
class MovingLevel {
public:
    MovingLevel(const std::vector<float>& values, const std::vector<bool>& present)
        : values_(values), present_(present) {}

    // On the nearest samples before `end`.
    double mean_before(std::size_t end) {
        while (end_ < end) { add(end_++); }
        while (first_ + resolution::level_reach < end || count_ > resolution::level_samples) {
            remove(first_++);
        }
        return mean();
    }

    // On the nearest samples from `first` on.
    double mean_from(std::size_t first) {
        while (end_ < first) { add(end_++); }
        while (first_ < first) { remove(first_++); }
        const std::size_t reach = std::min(values_.size(), first + resolution::level_reach);
        while (count_ < resolution::level_samples && end_ < reach) { add(end_++); }
        return mean();
    }

private:
    void add(std::size_t slot) { take(slot, 1.0); }
    void remove(std::size_t slot) { take(slot, -1.0); }
    void take(std::size_t slot, double sign) {
        if (!present_[slot]) { return; }
        sum_ += sign * static_cast<double>(values_[slot]);
        count_ = sign > 0.0 ? count_ + 1 : count_ - 1;
    }
    double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : std::nan(""); }

    const std::vector<float>& values_;
    const std::vector<bool>& present_;
    std::size_t first_ = 0;
    std::size_t end_ = 0;
    double sum_ = 0.0;
    std::size_t count_ = 0;
};

std::vector<float> response_coefficients(const std::vector<float>& values, CosineTransform& transform) {
    std::vector<double> work(values.begin(), values.end());
    transform.forward(work);
    work[0] = 0.0;
    return {work.begin(), work.end()};
}

}  // namespace

void join_holes(std::vector<float>& values, const std::vector<bool>& present,
                const std::function<double(std::size_t slot)>& beside) {
    const std::size_t length = values.size();
    MovingLevel level_before(values, present);
    MovingLevel level_after(values, present);
    for (std::size_t begin = 0; begin < length;) {
        if (present[begin]) {
            ++begin;
            continue;
        }
        std::size_t end = begin;
        while (end < length && !present[end]) { ++end; }
        double before = level_before.mean_before(begin);
        double after = level_after.mean_from(end);
        if (std::isnan(before)) { before = std::isnan(after) ? 0.0 : after; }
        if (std::isnan(after)) { after = before; }
        // Next to a short hole both levels are those of one place.
        const bool is_short = end - begin <= resolution::level_samples;
        for (std::size_t slot = begin; slot < end; ++slot) {
            const double share =
                is_short ? 0.5 : static_cast<double>(slot - begin + 1) / static_cast<double>(end - begin + 1);
            values[slot] = static_cast<float>(before + share * (after - before) + beside(slot));
        }
        begin = end;
    }
}

double take_mean_off(std::vector<float>& values, const std::vector<bool>& present) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t slot = 0; slot < values.size(); ++slot) {
        if (!present[slot]) { continue; }
        sum += static_cast<double>(values[slot]);
        ++count;
    }
    const auto mean = static_cast<float>(count > 0 ? sum / static_cast<double>(count) : 0.0);
    for (std::size_t slot = 0; slot < values.size(); ++slot) {
        if (present[slot]) { values[slot] -= mean; }
    }
    return static_cast<double>(mean);
}

int filling_rounds(const Prediction& prediction, std::size_t axis) {
    return prediction.uncertain(axis).empty() ? 1 : resolution::rounds_beside_uncertain;
}

std::vector<double> density_of_model(const Prediction& prediction, std::size_t axis) {
    std::vector<double> density;
    for (const SpectralParts& parts : prediction.parts(axis)) { density.push_back(parts.sum()); }
    return density;
}

std::vector<double> weighted_values(const Prediction& prediction, const std::vector<double>& density,
                                    std::span<const float> cosines, CosineTransform& transform) {
    std::vector<double> weighted(cosines.begin(), cosines.end());
    divide_by_bin(prediction, density, weighted, [](double variance) { return variance; });
    transform.inverse(weighted);
    return weighted;
}

InverseCovariance inverse_covariance_of(const Prediction& prediction, const std::vector<double>& density) {
    return inverse_covariance(prediction.bins(), density, prediction.rate_hz(), prediction.length(),
                              resolution::stand_in_lags);
}

std::vector<float> response_cosines(const Prediction& prediction, std::size_t axis,
                                    std::vector<double> values, CosineTransform& transform) {
    return response_cosines(prediction, axis, std::move(values), transform, filling_rounds(prediction, axis));
}

std::vector<float> response_cosines(const Prediction& prediction, std::size_t axis,
                                    std::vector<double> values, CosineTransform& transform, int rounds) {
    const std::shared_ptr<const ExpectedStandIns>& holes = prediction.holes(axis);
    if (!holes) {
        transform.forward(values);
        values[0] = 0.0;
        return {values.begin(), values.end()};
    }
    std::vector<bool> present(values.size(), true);
    for (const std::size_t slot : holes->slots()) { present[slot] = false; }
    std::vector<float> filled(values.begin(), values.end());
    take_mean_off(filled, present);
    join_holes(filled, present, [](std::size_t) { return 0.0; });
    const std::vector<double> density = density_of_model(prediction, axis);
    for (int round = 0; round < rounds; ++round) {
        const std::vector<float> cosines = response_coefficients(filled, transform);
        holes->expect(filled, weighted_values(prediction, density, cosines, transform));
    }
    return response_coefficients(filled, transform);
}

}  // namespace gyrolog
