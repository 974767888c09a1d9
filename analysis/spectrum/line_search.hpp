// Places in averaged periodograms where more power is than noise puts there.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/spectrum/averaged_periodogram.hpp"

namespace gyrolog {

struct LineCandidate {
    const AveragedPeriodogram* periodogram = nullptr;
    std::size_t first = 0;  // bins first ... end - 1 hold the line
    std::size_t end = 0;
    double floor = 0.0;            // density of the noise beside it
    double reference_shape = 0.0;  // of the floor's estimate: its relative variance is 1 / shape
    double log_false_alarm = 0.0;  // natural logarithm, for the whole search

    double lo_hz() const { return (static_cast<double>(first) - 0.5) * periodogram->width_hz(); }
    double hi_hz() const { return (static_cast<double>(end) - 0.5) * periodogram->width_hz(); }
};

// Most significant first, one for each line: power next to a line already found, by no more than the line's
// own width, belongs to it.
std::vector<LineCandidate> search_lines(std::span<const AveragedPeriodogram> periodograms, double false_alarm,
                                        std::size_t most);

}  // namespace gyrolog
