#include <cmath>

#include "analysis/simulate/portable_math.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

constexpr double wander_sd_C = 0.5;
constexpr double wander_tau_s = 1800.0;

// A first-order Gauss-Markov process sampled at the block boundaries, exact at any rate, with straight lines
// between.
class Temperature final : public Stage {
public:
    explicit Temperature(const StageContext& context)
        : wander_(context.stream({'T', 'w'}, 0)),
          noise_(context.stream({'T', 'n'}, 0)),
          reference_C_(context.model.temperature ? context.model.temperature->reference_C
                                                 : TemperatureModel{}.reference_C),
          noise_sd_C_(context.model.temp_noise_C),
          correlation_(portable_exp(-static_cast<double>(block_samples) / (context.rate_hz * wander_tau_s))),
          next_C_(wander_sd_C * wander_.normal(0)) {}

    void apply(SampleBlock& block) override {
        const double now_C = next_C_;
        const double innovation_C = wander_sd_C * std::sqrt(1.0 - correlation_ * correlation_);
        next_C_ = correlation_ * now_C + innovation_C * wander_.normal(block.first_index / block_samples + 1);
        const double step_C = (next_C_ - now_C) / static_cast<double>(block_samples);
        noise_.normals(block.first_index, block.temperature_C);
        double place = 0.0;
        for (double& temperature_C : block.temperature_C) {
            temperature_C = reference_C_ + now_C + step_C * place + noise_sd_C_ * temperature_C;
            place += 1.0;
        }
    }

private:
    RandomStream wander_;
    RandomStream noise_;
    double reference_C_;
    double noise_sd_C_;
    double correlation_;
    double next_C_;
};

}  // namespace

std::unique_ptr<Stage> make_temperature(const StageContext& context) {
    return std::make_unique<Temperature>(context);
}

}  // namespace gyrolog
