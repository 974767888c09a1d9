#include "analysis/diagnose/measures/courses.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"
#include "analysis/numerics/square.hpp"

namespace gyrolog::resolution {

constexpr std::size_t course_blocks = 32;

}  // namespace gyrolog::resolution

namespace gyrolog {

const Measure measures::course{.name = "noise over time",
                               .x_name = "time (s)",
                               .y_name = "over the model (dB)",
                               .shown_x = as_it_is,
                               .shown_y = variance_dB,
                               .locate = locate_times,
                               .is_of_noise = true};
const Measure measures::drift{.name = "bias over time",
                              .x_name = "time (s)",
                              .y_name = "mean (its sd)",
                              .shown_x = as_it_is,
                              .shown_y = as_it_is,
                              .locate = locate_times};

void add_course_curves(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    const std::vector<float>& white = observation.axis(axis).whitened;
    GapCurve course{&measures::course, axis, axis, {}, {}};
    GapCurve drift{&measures::drift, axis, axis, {}, {}};
    for (std::size_t block = 0; block < resolution::course_blocks; ++block) {
        const std::size_t first = block * white.size() / resolution::course_blocks;
        const std::size_t end = (block + 1) * white.size() / resolution::course_blocks;
        double sum = 0.0;
        double squares = 0.0;
        double count = 0.0;
        for (std::size_t slot = first; slot < end; ++slot) {
            if (!observation.present()[slot]) { continue; }
            sum += static_cast<double>(white[slot]);
            squares += square(static_cast<double>(white[slot]));
            count += 1.0;
        }
        const double at_s = 0.5 * static_cast<double>(first + end) / observation.prediction().rate_hz();
        course.x.push_back(at_s);
        drift.x.push_back(at_s);
        course.value.push_back(count > 0.0 ? std::log(std::max(squares / count, 1e-12)) : 0.0);
        drift.value.push_back(count > 0.0 ? sum / std::sqrt(count) : 0.0);
    }
    curves.push_back(std::move(course));
    curves.push_back(std::move(drift));
}

}  // namespace gyrolog
