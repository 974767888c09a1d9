// A simulated gyro: the signal chain (chain.hpp), block by block or sample by sample, then its converter.
//
// The same model, rate, world and seed give the same samples, bit for bit, whatever the machine.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/sensor_model.hpp"
#include "analysis/simulate/stage.hpp"

namespace gyrolog {

// Why the model cannot be simulated (an effect this build lacks, a parameter out of range); empty when it
// can.
std::optional<std::string> simulation_refusal(const SensorModel& model);

class SensorSimulator {
public:
    // `model` has no simulation_refusal(). `rate_hz` takes the place of the model's.
    // `world`: null for a sensor at rest.
    SensorSimulator(const SensorModel& model, double rate_hz, std::uint64_t seed,
                    std::shared_ptr<const World> world = nullptr);

    // What is left of the block: block_samples samples, unless single ones were taken. Valid until the next
    // call.
    const SampleBlock& next_block();

    // Sample by sample, for a world that is known only up to now. Neither allocates.
    //
    // When the next sample's stamp, world moment and loss are known: slot `begin` of the block. The world is
    // not asked. A second call in a row changes nothing.
    const SampleBlock& announce_sample();
    // That sample; the world must know its moment.
    const SampleBlock& next_sample();

private:
    void open(std::size_t samples);
    void run_clock();
    void run_rest();
    void convert();

    std::array<double, 3> lsb_rad_s_;
    double saturation_rad_s_;
    std::shared_ptr<const World> world_;
    Chain chain_;
    std::unique_ptr<SampleBlock> block_;
    std::uint64_t next_index_ = 0;
    bool announced_ = false;
};

}  // namespace gyrolog
