#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

class Thermometer final : public Stage {
public:
    explicit Thermometer(const StageContext& context)
        : noise_(context.stream({'T', 'n'}, 0)), noise_sd_C_(context.model.temp_noise_C) {}

    void apply(SampleBlock& block) override {
        if (noise_sd_C_ == 0.0) {
            block.temperature_C = block.die_C;
            return;
        }
        noise_.normals(block.first_index, block.temperature_C);
        for (std::size_t i = 0; i < block_samples; ++i) {
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
