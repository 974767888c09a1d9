// The numbers of three axes in a row.
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

inline std::string three_numbers(const Vector3& values, std::string_view between = ", ") {
    return fmt::format("{:.9g}{}{:.9g}{}{:.9g}", values[0], between, values[1], between, values[2]);
}

}  // namespace gyrolog
