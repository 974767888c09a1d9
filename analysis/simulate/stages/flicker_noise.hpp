#pragma once

#include <vector>

#include "analysis/simulate/flicker_noise.hpp"
#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

// stream_of(part) gives the streams that the noise is made from.
struct Flicker {
    FlickerNoise noise;

    template <typename StreamOf>
    Flicker(double B_rad_per_s, StreamOf stream_of) : noise(B_rad_per_s, streams(stream_of)) {}

    void add(std::uint64_t /*first_index*/, std::span<double> rate_rad_s) { noise.add_next(rate_rad_s); }

private:
    template <typename StreamOf>
    static std::vector<RandomStream> streams(StreamOf stream_of) {
        std::vector<RandomStream> streams;
        for (unsigned part = 0; part < FlickerNoise::default_processes; ++part) {
            streams.push_back(stream_of(part));
        }
        return streams;
    }
};

}  // namespace gyrolog
