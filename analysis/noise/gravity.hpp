// Gravity in the means of a still accelerometer's three axes: its size, and how the sensor is tilted.
//
// The uncertainties are those of the means, that is of the record's own noise. One position tells nothing of
// the axes' biases and scale factors: they are in the size and in the tilt in full (20 mg in an axis tilt by
// up to 1.1 degrees).
#pragma once

#include <array>
#include <cstddef>

#include "analysis/noise/static_bias.hpp"

namespace gyrolog {

// Coverage 95.45 %, as of StaticBias.
struct ExpandedNumber {
    double value = 0.0;
    double expanded_uncertainty = 0.0;
    double coverage_factor = 2.0;
};

struct Gravity {
    ExpandedNumber size;                // unit of the columns
    ExpandedNumber tilt_rad;            // between the vertical and the axis nearest to it
    std::array<double, 3> direction{};  // upward, of length 1
    std::size_t up_axis = 2;            // the axis nearest to the vertical: 0 is x
    bool up_is_negative = false;        // its negative end is up

    // "+z"
    const char* up_name() const;
};

// The mean of an axis, and with how many degrees of freedom its uncertainty is known; 0: well known.
struct AxisMean {
    StaticBias mean;
    double dof = 0.0;
};

// With f the vector of means, u_i their standard uncertainties and independent axes (JCGM 100:2008, 5.1.2):
//   u^2(|f|) = sum_i (f_i / |f|)^2 u_i^2
//   u^2(tilt) = sum_i (e_i / |f|)^2 u_i^2,  e: the direction across f in which the tilt grows
// where a tilt is known to half a turn at worst. For a tilt of 0, which has no such direction, e is the axis
// across f with the largest u_i. Coverage factors are by the effective degrees of freedom
// (Welch-Satterthwaite, JCGM 100:2008, G.4.1).
Gravity gravity_of(const std::array<AxisMean, 3>& axes);

}  // namespace gyrolog
