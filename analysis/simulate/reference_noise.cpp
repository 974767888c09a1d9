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
// A motion that fades out is smooth over four samples.
constexpr std::size_t difference_order = 3;

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
        const double sd = neighbour_scatter(*column, rest, resolution::difference_order);
        if (!(sd > resolution::least_noise_rel * own)) { continue; }
        noise.sd_rad_s.at(axis) = sd;
        const double share = sd * sd / (sd * sd + own * own);
        // Relative variances of a variance: 2/n of n samples, and of third differences more
        // (neighbour_scatter.hpp).
        noise.is_known_well =
            noise.is_known_well && share * share * 4.6 / rows_of(rest) < 2.0 / rows_of(recording.segments);
    }
    return noise;
}

}  // namespace gyrolog
