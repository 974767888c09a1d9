#include "analysis/spectrum/sinusoid_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <variant>
#include <vector>

#include "analysis/allan/prefix_sum.hpp"

namespace gyrolog {
namespace {

using std::numbers::pi;

using Complex = std::complex<double>;

// Shorter blocks cannot tell the sinusoid from the straight line, nor from its mirror at half the rate.
constexpr double least_periods = 3.0;
constexpr std::size_t least_samples = 16;
constexpr std::size_t blocks_wanted = 32;

// x = Re(z exp(2 pi i f t)) + a + b t over one block, by least squares.
struct Block {
    double t_s = 0.0;  // its middle
    Complex z;         // unit of the column, phase against t = 0
    double samples = 0.0;
};

// Blocks of one length share the cosines, counted from their middle, and the normal equations.
class BlockFit {
public:
    BlockFit(double cycles_per_sample, std::size_t samples) : cosines_(samples), sines_(samples) {
        Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
        for (std::size_t i = 0; i < samples; ++i) {
            const double from_middle = static_cast<double>(i) - middle();
            const double angle = 2.0 * pi * cycles_per_sample * from_middle;
            cosines_[i] = std::cos(angle);
            sines_[i] = std::sin(angle);
            const Eigen::Vector4d row(1.0, from_middle, cosines_[i], -sines_[i]);
            normal += row * row.transpose();
        }
        solver_.compute(normal);
    }

    double middle() const { return (static_cast<double>(cosines_.size()) - 1.0) / 2.0; }
    std::size_t samples() const { return cosines_.size(); }

    template <typename Value>
    Complex solve(const Value* x, double centre) const {
        double sum = 0.0;
        double slope = 0.0;
        double with_cosine = 0.0;
        double with_sine = 0.0;
        for (std::size_t i = 0; i < cosines_.size(); ++i) {
            const double value = static_cast<double>(x[i]) - centre;
            sum += value;
            slope += value * (static_cast<double>(i) - middle());
            with_cosine += value * cosines_[i];
            with_sine -= value * sines_[i];
        }
        const Eigen::Vector4d solution = solver_.solve(Eigen::Vector4d(sum, slope, with_cosine, with_sine));
        return {solution[2], solution[3]};
    }

private:
    std::vector<double> cosines_, sines_;
    Eigen::LDLT<Eigen::Matrix4d> solver_;
};

std::vector<Block> fit_blocks(const Column& column, std::span<const Segment> segments, double rate_hz,
                              double f_hz, std::size_t block_samples) {
    const double centre = raw_mean(column);
    const BlockFit fit(f_hz / rate_hz, block_samples);
    std::vector<Block> blocks;
    std::visit(
        [&](const auto& values) {
            for (const Segment& segment : segments) {
                for (std::size_t i = 0; i + block_samples <= segment.count; i += block_samples) {
                    Block block;
                    block.t_s =
                        (static_cast<double>(segment.first_index) + static_cast<double>(i) + fit.middle()) /
                        rate_hz;
                    block.z = column.scale * fit.solve(values.data() + segment.first + i, centre) *
                              std::polar(1.0, -2.0 * pi * std::fmod(f_hz * block.t_s, 1.0));
                    block.samples = static_cast<double>(block_samples);
                    blocks.push_back(block);
                }
            }
        },
        column.data);
    return blocks;
}

// Mean of the blocks' z turned back by the offset's phase.
Complex mean_at(std::span<const Block> blocks, double offset_hz) {
    Complex sum;
    double weight = 0.0;
    for (const Block& block : blocks) {
        sum += block.samples * block.z * std::polar(1.0, -2.0 * pi * offset_hz * block.t_s);
        weight += block.samples;
    }
    return sum / weight;
}

// The offset with the largest mean: a grid of a quarter of the record's own resolution, then golden section.
// Across a hole of weeks the phase is lost anyway: the grid then stays coarser.
double best_offset(std::span<const Block> blocks, double reach_hz) {
    const double span_s = std::max(blocks.back().t_s - blocks.front().t_s, 1e-300);
    constexpr double most_steps = 20'000.0;
    const double step_hz = std::clamp(0.25 / span_s, reach_hz / most_steps, reach_hz / 4.0);
    const auto steps = static_cast<int>(std::ceil(reach_hz / step_hz));
    std::vector<Complex> turned, turn;
    for (const Block& block : blocks) {
        turned.push_back(block.samples * block.z * std::polar(1.0, 2.0 * pi * step_hz * steps * block.t_s));
        turn.push_back(std::polar(1.0, -2.0 * pi * step_hz * block.t_s));
    }
    int best = 0;
    double largest = -1.0;
    for (int i = -steps; i <= steps; ++i) {
        Complex sum;
        for (std::size_t b = 0; b < turned.size(); ++b) {
            sum += turned[b];
            turned[b] *= turn[b];
        }
        if (std::norm(sum) > largest) {
            largest = std::norm(sum);
            best = i;
        }
    }
    double lo = (best - 1) * step_hz;
    double hi = (best + 1) * step_hz;
    constexpr double golden = 0.6180339887498949;
    for (int i = 0; i < 40; ++i) {
        const double a = hi - golden * (hi - lo);
        const double b = lo + golden * (hi - lo);
        if (std::norm(mean_at(blocks, a)) > std::norm(mean_at(blocks, b))) {
            hi = b;
        } else {
            lo = a;
        }
    }
    return 0.5 * (lo + hi);
}

SinusoidFit fit_of(std::span<const Block> blocks, double f_hz, double rate_hz, double noise_density) {
    const Complex z = mean_at(blocks, 0.0);
    const double variance = noise_density * rate_hz;
    double samples = 0.0;
    double t_sum = 0.0;
    double left = 0.0;
    for (const Block& block : blocks) {
        samples += block.samples;
        t_sum += block.samples * block.t_s;
        // Real and imaginary part of z scatter by 2 variance / samples each.
        left += std::norm(block.z - z) * block.samples / (2.0 * variance);
    }
    double spread = 0.0;
    for (const Block& block : blocks) {
        const double within_s2 = block.samples * block.samples / (12.0 * rate_hz * rate_hz);
        spread += block.samples * (std::pow(block.t_s - t_sum / samples, 2) + within_s2);
    }
    SinusoidFit fit;
    fit.f_hz = f_hz;
    fit.amplitude = std::abs(z);
    fit.amplitude_sd = std::sqrt(2.0 * variance / samples);
    fit.f_sd_hz = std::sqrt(2.0 * variance / spread) / (2.0 * pi * fit.amplitude);
    const double free = 2.0 * static_cast<double>(blocks.size()) - 3.0;
    fit.misfit = free > 0.0 ? left / free : 1.0;
    return fit;
}

}  // namespace

std::optional<SinusoidFit> fit_sinusoid(const Column& column, std::span<const Segment> segments,
                                        double rate_hz, double f_hz, double reach_hz, double noise_density) {
    const double slowest_hz = std::min(f_hz, rate_hz / 2.0 - f_hz);
    if (!(slowest_hz > 0.0)) { return std::nullopt; }
    const auto samples_in = [&](double seconds) {
        return static_cast<std::size_t>(std::ceil(seconds * rate_hz));
    };
    const std::size_t least = std::max(samples_in(least_periods / slowest_hz), least_samples);
    // In a longer block a sinusoid at the end of the reach would turn by more than half a period.
    const std::size_t block_samples =
        std::max(least, std::min(samples_in(0.5 / reach_hz), column.size() / blocks_wanted));
    std::vector<Block> blocks;
    // A block sees a sinusoid beside its frequency smaller than it is: again about the one found.
    for (int round = 0; round < 3; ++round) {
        blocks = fit_blocks(column, segments, rate_hz, f_hz, block_samples);
        if (blocks.empty()) { return std::nullopt; }
        const double offset_hz = best_offset(blocks, reach_hz);
        f_hz += offset_hz;
        for (Block& block : blocks) { block.z *= std::polar(1.0, -2.0 * pi * offset_hz * block.t_s); }
        if (std::abs(offset_hz) * static_cast<double>(block_samples) / rate_hz < 0.02) { break; }
    }
    return fit_of(blocks, f_hz, rate_hz, noise_density);
}

}  // namespace gyrolog
