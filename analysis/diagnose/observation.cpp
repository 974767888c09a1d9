#include "analysis/diagnose/observation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "analysis/diagnose/cosine_transform.hpp"
#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {

namespace {

constexpr std::array<const char*, 3> gyro_columns = {"gx", "gy", "gz"};
constexpr std::uint32_t stand_in_stream = 0x03000000;

// Calls take(slot, row) for every row on the grid.
template <typename Take>
void for_each_slot(const Recording& recording, std::int64_t origin, std::size_t length, Take take) {
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const auto slot = static_cast<std::size_t>(segment.first_index - origin) + i;
            if (slot >= length) { return; }
            take(slot, segment.first + i);
        }
    }
}

// A straight line across every hole, with white noise on it.
void fill_holes(std::vector<float>& values, const std::vector<bool>& present, double sd,
                const RandomStream& noise) {
    const std::size_t length = values.size();
    for (std::size_t begin = 0; begin < length;) {
        if (present[begin]) {
            ++begin;
            continue;
        }
        std::size_t end = begin;
        while (end < length && !present[end]) { ++end; }
        const float before = begin > 0 ? values[begin - 1] : end < length ? values[end] : 0.0F;
        const float after = end < length ? values[end] : before;
        for (std::size_t slot = begin; slot < end; ++slot) {
            const auto share = static_cast<float>(slot - begin + 1) / static_cast<float>(end - begin + 1);
            values[slot] = before + share * (after - before) + static_cast<float>(sd * noise.normal(slot));
        }
        begin = end;
    }
}

void take_mean_off(std::vector<float>& values, const std::vector<bool>& present) {
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
}

// Takes the most likely of the model's uncertain responses off the coefficients; returns their parameters.
std::vector<double> take_uncertain_off(const std::vector<UncertainResponse>& uncertain,
                                       const SpectralBins& bins, const std::vector<double>& density,
                                       double rate_hz, std::vector<float>& cosines) {
    const auto count = static_cast<Eigen::Index>(uncertain.size());
    const auto column = [&](Eigen::Index a, std::size_t k) {
        return static_cast<double>(uncertain[static_cast<std::size_t>(a)].cosines[k]);
    };
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(count);
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const double weight = 1.0 / (density[i] * rate_hz);
        for (std::size_t k = bins[i].first; k < bins[i].end; ++k) {
            for (Eigen::Index a = 0; a < count; ++a) {
                const double weighted = weight * column(a, k);
                pull[a] += weighted * static_cast<double>(cosines[k]);
                for (Eigen::Index b = 0; b <= a; ++b) { information(a, b) += weighted * column(b, k); }
            }
        }
    }
    for (Eigen::Index a = 0; a < count; ++a) {
        const double sd = uncertain[static_cast<std::size_t>(a)].sd;
        information(a, a) += 1.0 / (sd * sd);
    }
    const Eigen::MatrixXd full = information.selfadjointView<Eigen::Lower>();
    const Eigen::VectorXd best = full.ldlt().solve(pull);
    for (Eigen::Index a = 0; a < count; ++a) {
        for (std::size_t k = 1; k < cosines.size(); ++k) {
            cosines[k] -= static_cast<float>(best[a] * column(a, k));
        }
    }
    return {best.data(), best.data() + best.size()};
}

void measure_power(const SpectralBins& bins, double rate_hz, const std::vector<float>& cosines,
                   std::vector<double>& power) {
    power.resize(bins.size());
    for (std::size_t i = 0; i < bins.size(); ++i) {
        double sum = 0.0;
        for (std::size_t k = bins[i].first; k < bins[i].end; ++k) {
            const auto coefficient = static_cast<double>(cosines[k]);
            sum += coefficient * coefficient;
        }
        power[i] = sum / (bins[i].count() * rate_hz);
    }
}

}  // namespace

Observation::Observation(std::shared_ptr<const Baseline> baseline, std::shared_ptr<const Recording> recording,
                         std::uint64_t seed)
    : baseline_(std::move(baseline)), recording_(std::move(recording)) {
    const std::size_t length = baseline_->length();
    const std::int64_t origin = baseline_->world().recording().segments.front().first_index;
    present_.assign(length, false);
    for_each_slot(*recording_, origin, length, [&](std::size_t slot, std::size_t) { present_[slot] = true; });
    CosineTransform transform(length);
    for (const std::size_t axis : baseline_->axes()) { observe(axis, seed, transform); }
}

void Observation::observe(std::size_t axis, std::uint64_t seed, CosineTransform& transform) {
    const Baseline& baseline = *baseline_;
    const std::size_t length = baseline.length();
    const double rate_hz = baseline.rate_hz();
    AxisObservation& seen = axes_[axis];
    const Column& column = *recording_->find(gyro_columns[axis]);
    const std::vector<float>& response = baseline.response_rad_s(axis);
    const std::int64_t origin = baseline.world().recording().segments.front().first_index;

    std::vector<float>& residual = seen.residual_rad_s;
    residual.assign(length, 0.0F);
    for_each_slot(*recording_, origin, length, [&](std::size_t slot, std::size_t row) {
        residual[slot] = static_cast<float>(column.value(row) - static_cast<double>(response[slot]));
    });
    take_mean_off(residual, present_);
    const double white = baseline.parts(axis).back().sum();
    fill_holes(residual, present_, std::sqrt(white * rate_hz),
               RandomStream(seed, stand_in_stream + static_cast<std::uint32_t>(axis)));

    std::vector<double> work(residual.begin(), residual.end());
    transform.forward(work);
    work[0] = 0.0;
    seen.cosines.assign(work.begin(), work.end());
    const std::array<double, 3> sd_rel = noise_uncertainty(baseline.model(), axis);
    seen.density.resize(baseline.bins().size());
    const auto fit_noise = [&] {
        measure_power(baseline.bins(), rate_hz, seen.cosines, seen.power);
        seen.noise = fit_nuisance(baseline.bins(), baseline.parts(axis), seen.power, sd_rel, seen.noise);
        expected_density(baseline.parts(axis), sd_rel, seen.noise.z, seen.density);
    };
    fit_noise();
    if (!baseline.uncertain(axis).empty()) {
        seen.uncertain_fit = take_uncertain_off(baseline.uncertain(axis), baseline.bins(), seen.density,
                                                rate_hz, seen.cosines);
        fit_noise();
        std::copy(seen.cosines.begin(), seen.cosines.end(), work.begin());
        transform.inverse(work);
        residual.assign(work.begin(), work.end());
    }
    std::copy(seen.cosines.begin(), seen.cosines.end(), work.begin());
    for (std::size_t i = 0; i < baseline.bins().size(); ++i) {
        const double scale = 1.0 / std::sqrt(seen.density[i] * rate_hz);
        for (std::size_t k = baseline.bins()[i].first; k < baseline.bins()[i].end; ++k) { work[k] *= scale; }
    }
    transform.inverse(work);
    seen.whitened.assign(work.begin(), work.end());
}

}  // namespace gyrolog
