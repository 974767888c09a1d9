#include <algorithm>

#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

class Thermometer final : public Stage {
public:
    explicit Thermometer(const StageContext& context)
        : noise_(context.stream({'T', 'n'}, 0)), noise_sd_C_(context.model.temp_noise_C) {}

    void apply(SampleBlock& block) override {
        if (noise_sd_C_ == 0.0) {
            std::ranges::copy(block.slots(block.die_C), block.slots(block.temperature_C).begin());
            return;
        }
        noise_.normals(block.first(), block.slots(block.temperature_C));
        for (std::size_t i = block.begin; i < block.end; ++i) {
            block.temperature_C[i] = block.die_C[i] + noise_sd_C_ * block.temperature_C[i];
        }
    }

private:
    RandomStream noise_;
    double noise_sd_C_;
};

}  // namespace

std::unique_ptr<Stage> make_thermometer(const StageContext& context) {
    return std::make_unique<Thermometer>(context);
}

}  // namespace gyrolog
