// A measure is one way to hold a recording against simulations. It gives a curve for each axis, or for all
// axes together: numbers on a scale on which chance is nearly normal, along some x. Where they lie outside
// the simulations is where the gap is, whatever its cause.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

struct GapCurve;

struct Measure {
    const char* name;  // "Allan deviation"
    // What is shown, with its unit: "averaging time (s)".
    const char* x_name;
    const char* y_name;
    // From a curve's own x, in SI units, and its own values to what is shown.
    double (*shown_x)(double x);
    double (*shown_y)(double value);
    // The function adds to `where` what the curve says of the gap's place. `z`: the curve's distances from
    // the simulations' mean, in their standard deviations.
    void (*locate)(const GapCurve& curve, const std::vector<double>& z, Place& where);

    bool log_x = false;
    bool log_y = false;
    bool over_mean = false;    // the simulations' mean is taken off what is shown
    bool names_other = false;  // the name ends in the curve's other axis
    // Names of x = 1, 2, ..., where these are things side by side. A curve that has none is a course along x.
    std::span<const char* const> categories{};
    bool is_course = true;  // false: no point has anything to do with the next
    const char* shared_name =
        "";  // what precedes the name of a curve of all axes, where each axis has one, too
    // The simulations' standard deviation at a point counts as no less. Where no simulation differs from
    // another, rounding is no scale. Of numbers in their own standard deviation, which are 0 where there is
    // nothing to tell, it is 1.
    double least_sd = 1e-6;
    bool in_halves = true;  // false: of the whole recording only
    // False: a count that takes samples for independent. Far out it says less than a normal deviate: in a sum
    // with other measures Student's tail bounds it.
    bool is_normal_far_out = true;
    // True: it tells how much noise there is. What it tells of the mean answer to the motion others tell
    // better.
    bool is_of_noise = false;
};

struct GapCurve {
    const Measure* measure = nullptr;
    std::size_t axis = 0;
    std::size_t other = 0;  // the second axis of a curve of two; else `axis`
    std::vector<double> x;
    std::vector<double> value;
    bool of_all_axes = false;
};

}  // namespace gyrolog
