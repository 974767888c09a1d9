// Prints the rates that a model gives, in deg/s: three axes, one after the other, as binary float64.
// Usage: noise_samples MODEL.json RATE_HZ FIRST_SEED SEEDS SAMPLES
#include <array>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include "analysis/simulate/sensor_simulator.hpp"
#include "host/formats/model_json.hpp"

namespace {

int print_samples(const std::vector<std::string>& arguments) {
    const auto model = gyrolog::read_model(arguments.at(0));
    if (!model.ok()) {
        std::cerr << model.error().message << '\n';
        return 1;
    }
    if (const auto refusal = gyrolog::simulation_refusal(model.value())) {
        std::cerr << *refusal << '\n';
        return 1;
    }
    const double rate_hz = std::stod(arguments.at(1));
    const std::uint64_t first_seed = std::stoull(arguments.at(2));
    const std::uint64_t seeds = std::stoull(arguments.at(3));
    const std::size_t samples = std::stoull(arguments.at(4));
    for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
        gyrolog::SensorSimulator simulator(model.value(), rate_hz, seed);
        std::array<std::vector<double>, 3> axes;
        while (axes[0].size() < samples) {
            const gyrolog::SampleBlock& block = simulator.next_block();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const double rate_rad_s : block.rate_rad_s[axis]) {
                    axes[axis].push_back(rate_rad_s * gyrolog::deg_per_rad);
                }
            }
        }
        for (const auto& axis : axes) {
            std::cout.write(reinterpret_cast<const char*>(axis.data()),
                            static_cast<std::streamsize>(samples * sizeof(double)));
        }
    }
    return std::cout.flush() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 6) {
        std::cerr << "usage: noise_samples MODEL.json RATE_HZ FIRST_SEED SEEDS SAMPLES\n";
        return 2;
    }
    try {
        return print_samples({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
