// The sensor's analogue-to-digital converter.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace gyrolog {

// Rounds to the nearest count, half away from zero, and clips at the ends of its range: `saturation` above,
// and one count more below, as two's complement has it; never beyond 16 bits.
class Converter {
public:
    Converter(double lsb, double saturation)
        : counts_per_unit_(1.0 / lsb), highest_(std::min(32767.0, std::floor(saturation / lsb + 0.5))) {}

    std::int16_t operator()(double value) const {
        const double clipped = std::min(std::max(value * counts_per_unit_, -highest_ - 1.0), highest_);
        return static_cast<std::int16_t>(static_cast<std::int32_t>(clipped + std::copysign(0.5, clipped)));
    }

    void operator()(std::span<const double> values, std::span<std::int16_t> counts) const {
        for (std::size_t i = 0; i < values.size(); ++i) { counts[i] = (*this)(values[i]); }
    }

private:
    double counts_per_unit_;
    double highest_;
};

}  // namespace gyrolog
