// A simulated gyro at rest: the model's bias, noise and effects, then its converter.
//
// The same model, rate and seed give the same samples, bit for bit, whatever the machine. The filter that a
// real part applies to its noise (DLPF), and motion through the model's M, orientation and misalignment, are
// not simulated here.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/simulate/sensor_model.hpp"
#include "analysis/simulate/stage.hpp"

namespace gyrolog {

// Why the model cannot be simulated (an effect this build lacks, a parameter out of range); empty when it
// can.
std::optional<std::string> simulation_refusal(const SensorModel& model);

class SensorSimulator {
public:
    // `model` has no simulation_refusal(). `rate_hz` takes the place of the model's.
    SensorSimulator(const SensorModel& model, double rate_hz, std::uint64_t seed);

    // The next block_samples samples; valid until the next call.
    const SampleBlock& next_block();

private:
    void convert();

    double lsb_rad_s_;
    double saturation_rad_s_;
    std::vector<std::unique_ptr<Stage>> stages_;
    std::unique_ptr<SampleBlock> block_;
    std::uint64_t next_index_ = 0;
};

}  // namespace gyrolog
