#pragma once

#include "analysis/simulate/stage.hpp"

namespace gyrolog {

// A scale factor that follows the temperature in proportion, for all that the sensor shows, bias and noise
// included: so MathWorks' imuSensor has it, whose generated code multiplies the sum of all terms by
// 1 + TemperatureScaleFactor / 100 (T - 25).
class TemperatureScale final : public Stage {
public:
    TemperatureScale(const Vector3& per_C, double reference_C) : per_C_(per_C), reference_C_(reference_C) {}

    void apply(SampleBlock& block) override {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (per_C_[axis] == 0.0) { continue; }
            for (std::size_t i = block.begin; i < block.end; ++i) {
                block.rate_rad_s[axis][i] *= 1.0 + per_C_[axis] * (block.die_C[i] - reference_C_);
            }
        }
    }

private:
    Vector3 per_C_;
    double reference_C_;
};

}  // namespace gyrolog
