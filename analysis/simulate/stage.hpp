// The chain that makes a simulated sample: each stage changes a block in place and hands it on.
//
// Invariants that every stage keeps:
//   - Sample k of a stream is a function of the model, the rate, the seed and k. Blocks follow each other
//     without a hole from index 0; how they are asked for, and on which thread, changes nothing.
//   - Memory does not grow with the number of samples.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "analysis/simulate/counter_random.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

inline constexpr std::size_t block_samples = 1024;

struct SampleBlock {
    std::uint64_t first_index = 0;  // a multiple of block_samples
    std::array<std::array<double, block_samples>, 3> rate_rad_s{};
    std::array<double, block_samples> temperature_C{};
    std::array<std::array<std::int16_t, block_samples>, 3>
        counts{};  // filled last; zero when the model has no lsb
};

// What a stage is made from. `rate_hz` may differ from the model's: a board can be set to another rate.
struct StageContext {
    const SensorModel& model;
    double rate_hz;
    std::uint64_t seed;

    // A random stream of the stage's own. `process`: two letters unique to the stage; `part` counts within
    // one (levels, components), below 4096.
    RandomStream stream(std::array<char, 2> process, std::size_t axis, unsigned part = 0) const {
        const auto id = static_cast<std::uint32_t>(static_cast<unsigned char>(process[0])) << 24U |
                        static_cast<std::uint32_t>(static_cast<unsigned char>(process[1])) << 16U |
                        static_cast<std::uint32_t>(axis) << 12U | static_cast<std::uint32_t>(part);
        return {seed, id};
    }
};

class Stage {
public:
    virtual ~Stage() = default;
    virtual void apply(SampleBlock& block) = 0;
};

// A stage for this model, or null when the model has no use for it.
using StageMaker = std::unique_ptr<Stage> (*)(const StageContext&);

}  // namespace gyrolog
