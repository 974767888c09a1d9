#include "analysis/simulate/reference_noise.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "analysis/recording/neighbour_scatter.hpp"
#include "analysis/recording/recording_part.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/gyro_rest.hpp"

namespace gyrolog::resolution {

// Of the gyro's: noise that adds a ten thousandth to its variance is not seen.
constexpr double least_noise_rel = 0.01;
// Times 1/n: the relative variance of a variance from n differences of that order (neighbour_scatter.hpp),
// and from n samples.
constexpr double by_differences = 4.6;
constexpr double by_samples = 2.0;

}  // namespace gyrolog::resolution

namespace gyrolog {
namespace {

double rows_of(const std::vector<Segment>& segments) {
    double rows = 0.0;
    for (const Segment& segment : segments) { rows += static_cast<double>(segment.count); }
    return rows;
}

}  // namespace

double ReferenceNoise::of_all_rad_s() const {
    double sum = 0.0;
    double axes = 0.0;
    for (const double one : sd_rad_s) {
        sum += one * one;
        axes += one > 0.0 ? 1.0 : 0.0;
    }
    return axes > 0.0 ? std::sqrt(sum / axes) : 0.0;
}

ReferenceNoise reference_noise_at_rest(const Recording& recording) {
    ReferenceNoise noise;
    const std::vector<Segment> rest =
        segments_within(recording.segments, recording.rate_hz, gyro_rest(recording));
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const Column* gyro = recording.find(gyro_columns.at(axis));
        const Column* column = recording.find(std::string("ref_") + axis_names.at(axis));
        if (gyro == nullptr || column == nullptr || column->unit != "rad/s") { continue; }
        const double own = neighbour_scatter(*gyro, rest);
        const double sd = neighbour_scatter(*column, rest, order_beside_motion);
        if (!(sd > resolution::least_noise_rel * own)) { continue; }
        noise.sd_rad_s.at(axis) = sd;
        const double share = sd * sd / (sd * sd + own * own);
        const double by_rest = share * share * resolution::by_differences / rows_of(rest);
        const double by_all = resolution::by_samples / rows_of(recording.segments);
        noise.is_known_well = noise.is_known_well && by_rest < by_all;
    }
    return noise;
}

}  // namespace gyrolog
