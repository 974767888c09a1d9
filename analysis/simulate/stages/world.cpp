#include "analysis/simulate/world.hpp"

#include <cmath>

#include "analysis/simulate/portable_math.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

constexpr double wander_sd_C = 0.5;
constexpr double wander_tau_s = 1800.0;
constexpr double standard_gravity_m_s2 = 9.80665;

// A first-order Gauss-Markov process sampled at the block boundaries, exact at any rate, with straight lines
// between.
class WanderingTemperature {
public:
    explicit WanderingTemperature(const StageContext& context)
        : wander_(context.stream({'T', 'w'}, 0)),
          reference_C_(context.model.temperature ? context.model.temperature->reference_C
                                                 : TemperatureModel{}.reference_C),
          correlation_(portable_exp(-static_cast<double>(block_samples) / (context.rate_hz * wander_tau_s))),
          next_C_(wander_sd_C * wander_.normal(0)) {}

    void fill(std::uint64_t first_index, BlockValues& die_C) {
        const double now_C = next_C_;
        const double innovation_C = wander_sd_C * std::sqrt(1.0 - correlation_ * correlation_);
        next_C_ = correlation_ * now_C + innovation_C * wander_.normal(first_index / block_samples + 1);
        const double step_C = (next_C_ - now_C) / static_cast<double>(block_samples);
        double place = 0.0;
        for (double& temperature_C : die_C) {
            temperature_C = reference_C_ + now_C + step_C * place;
            place += 1.0;
        }
    }

private:
    RandomStream wander_;
    double reference_C_;
    double correlation_;
    double next_C_;
};

std::array<std::span<double>, 3> spans_of(BlockVectors& vectors) {
    return {vectors[0], vectors[1], vectors[2]};
}

class WorldAtTheSensor final : public Stage {
public:
    explicit WorldAtTheSensor(const StageContext& context)
        : world_(context.world),
          temperature_(context),
          orientation_(context.model.orientation),
          reference_sd_rad_s_(context.world != nullptr && context.world->is_measured()
                                  ? context.model.ref_noise_rad_s
                                  : 0.0) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            reference_noise_[axis] = context.stream({'W', 'r'}, axis);
        }
    }

    void apply(SampleBlock& block) override {
        if (world_ != nullptr && world_->has_temperature()) {
            world_->temperature(block.world_s, block.die_C);
        } else {
            temperature_.fill(block.first_index, block.die_C);
        }
        if (world_ != nullptr && world_->moves()) {
            move(block);
        } else if (block.first_index == 0) {
            stand_still(block);
        }
    }

private:
    void stand_still(SampleBlock& block) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            block.true_rate_rad_s[axis].fill(0.0);
            block.specific_force_m_s2[axis].fill(axis == 2 ? standard_gravity_m_s2 : 0.0);
        }
        if (orientation_) { turn(block.specific_force_m_s2); }
    }

    // The reference's readings hold its noise; what was there is a reading less a draw of that noise.
    void move(SampleBlock& block) {
        block.moving = true;
        world_->motion(block.world_s, spans_of(block.true_rate_rad_s), spans_of(block.specific_force_m_s2));
        for (std::size_t axis = 0; axis < 3 && reference_sd_rad_s_ != 0.0; ++axis) {
            BlockValues draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
            reference_noise_[axis]->normals(block.first_index, draws);
            for (std::size_t i = 0; i < block_samples; ++i) {
                block.true_rate_rad_s[axis][i] -= reference_sd_rad_s_ * draws[i];
            }
        }
        if (orientation_) {
            turn(block.true_rate_rad_s);
            turn(block.specific_force_m_s2);
        }
    }

    void turn(BlockVectors& vectors) const {
        for (std::size_t i = 0; i < block_samples; ++i) {
            const Vector3 body = {vectors[0][i], vectors[1][i], vectors[2][i]};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Vector3& row = (*orientation_)[axis];
                vectors[axis][i] = row[0] * body[0] + row[1] * body[1] + row[2] * body[2];
            }
        }
    }

    const World* world_;
    WanderingTemperature temperature_;
    std::optional<Matrix3> orientation_;
    double reference_sd_rad_s_;
    std::array<std::optional<RandomStream>, 3> reference_noise_;
};

}  // namespace

std::unique_ptr<Stage> make_world(const StageContext& context) {
    return std::make_unique<WorldAtTheSensor>(context);
}

}  // namespace gyrolog
