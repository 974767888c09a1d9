#include "host/formats/stops_text.hpp"

#include <fmt/format.h>

#include "host/formats/uncertain_number.hpp"

namespace gyrolog {

std::string stops_text(std::uint64_t stops, double stopped_s) {
    const std::string time = duration_text(stopped_s);
    return stops == 1 ? fmt::format("stopped by the user for {}", time)
                      : fmt::format("stopped by the user {} times, for {} in all", stops, time);
}

}  // namespace gyrolog
