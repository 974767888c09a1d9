// The chain that makes a simulated sample: each stage changes a block in place and hands it on.
//
// Invariants that every stage keeps:
//   - Sample k of a stream is a function of the model, the rate, the world, the seed and k. Blocks follow
//     each other without a hole from index 0; how they are asked for, whole or in parts down to one sample,
//     and on which thread, changes nothing.
//   - Memory does not grow with the number of samples.
//   - Only portable arithmetic (portable_math.hpp) decides a sample: the same bits on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "analysis/simulate/counter_random.hpp"
#include "analysis/simulate/sensor_model.hpp"
#include "analysis/simulate/world.hpp"

namespace gyrolog {

inline constexpr std::size_t block_samples = 1024;

using BlockValues = std::array<double, block_samples>;
using BlockVectors = std::array<BlockValues, 3>;

// Slot i is sample first_index + i of the sensor's clock. Times count from the nominal first sample.
struct SampleBlock {
    std::uint64_t first_index = 0;  // a multiple of block_samples
    // The slots that are to be made now: the whole block, or a part that follows on the one before.
    std::size_t begin = 0;
    std::size_t end = block_samples;

    std::uint64_t first() const { return first_index + begin; }
    std::span<double> slots(BlockValues& values) const {
        return std::span(values).subspan(begin, end - begin);
    }

    // Set by the clock.
    BlockValues stamp_s{};                   // what the time stamp says
    BlockValues world_s{};                   // the moment of the world that the sample shows
    std::array<bool, block_samples> lost{};  // never delivered

    // Set by the world, in the sensor's axes. At rest filled once and left alone.
    bool moving = false;
    BlockVectors true_rate_rad_s{};
    BlockVectors specific_force_m_s2{};
    BlockValues die_C{};  // the temperature that acts

    // What the sensor makes of it.
    BlockVectors rate_rad_s{};
    BlockVectors white_rad_s{};   // its white noise, apart from the rest until the sensor's bandwidth
    Vector3 white_sd_rad_s{};     // the standard deviation of that noise in slot `begin`
    BlockValues temperature_C{};  // as the sensor reports it
    std::array<std::array<std::int16_t, block_samples>, 3>
        counts{};  // filled last; zero when the model has no lsb
};

// What a stage is made from. `rate_hz` may differ from the model's: a board can be set to another rate.
struct StageContext {
    const SensorModel& model;
    double rate_hz;
    std::uint64_t seed;
    const World* world = nullptr;  // null: at rest, its temperature wandering slowly

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
