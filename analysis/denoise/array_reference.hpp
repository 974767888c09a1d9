// One gyro of an array, and what the others say of the motion.
#pragma once

#include <string>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct UnitOfArray {
    Recording recording;  // gx, gy and gz are the unit's; the other gyros are not in it
    std::string failure;  // why there is none, and what is missing; empty where there is one
};

// `unit`: the number in its columns, 2 of gx2; 0 of gx. Rows in which one of its axes is not known are
// missing.
UnitOfArray unit_of_array(const Recording& recording, unsigned long unit);

// The same with ref_x, ref_y and ref_z in rad/s, of the other units that have its axes. Rows in which one of
// them is not known, or at the end of its range, are missing, and a warning counts them: a line that joins
// what is known would be another motion. Each unit j answers to the motion with a matrix A_j, by least
// squares about the mean m over all units, weighted by 1/sd_j^2 of their noise within a quiet second
// (still_blocks.hpp):
//
//   u_j - b_j = A_j m + noise,   reference = sum over j != unit of w_j C A_j^-1 (u_j - b_j)
//
// With these weights the noise of u_j - m has no covariance with that of m, so that noise does not look like
// a response. A_j - 1 is 0 with one sigma of `response_sd`, which decides nothing but of an axis that does
// not move. C is the median of the A_j, element by element, so that a unit with a wrong response spoils the
// reference of no other. Two units have no median: the one is the other's reference as it is. b_j is the mean
// where the unit rests (gyro_rest.hpp); 0 where it does not.
struct ArrayReferenceOptions {
    double response_sd = 0.1;
    // Of a gain on the unit's: less is an axis that points elsewhere.
    double gain_least = 0.5;
};
UnitOfArray unit_against_others(const Recording& recording, unsigned long unit,
                                const ArrayReferenceOptions& options = {});

}  // namespace gyrolog
