#include "analysis/simulate/gyro_rest.hpp"

#include <vector>

#include "analysis/recording/still_part.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog {

TimeSpan gyro_rest(const Recording& recording) {
    std::vector<std::vector<double>> gyros;
    for (const char* name : gyro_columns) {
        if (const Column* column = recording.find(name)) { gyros.push_back(column->values()); }
    }
    return still_part(recording, gyros);
}

}  // namespace gyrolog
