// Noise of an instrument that a gyro is judged by.
#pragma once

#include <array>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct ReferenceNoise {
    // One sigma of white noise of a row of ref_x, ref_y and ref_z in rad/s. 0 for an axis that has no
    // reference in rad/s, or one whose noise is not seen beside the gyro's.
    std::array<double, 3> sd_rad_s{};
    // On every axis the rest tells the reference's variance more precisely than all rows tell the sum of the
    // gyro's and the reference's. If not, the error of the first would look like a change of the gyro's
    // noise.
    bool is_known_well = true;

    // The root of the mean square over the axes that have noise.
    double of_all_rad_s() const;
};

// The noise of the samples (third differences, neighbour_scatter.hpp) where the gyro rests (gyro_rest.hpp).
// None where there is no rest.
ReferenceNoise reference_noise_at_rest(const Recording& recording);

}  // namespace gyrolog
