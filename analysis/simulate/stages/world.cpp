#include "analysis/simulate/world.hpp"

#include <cmath>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/portable_math.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

constexpr double wander_sd_C = 0.5;
constexpr double wander_tau_s = 1800.0;
constexpr double wander_knot_s = 16.0;
// A first-order Gauss-Markov process at knots a fixed time apart, exact at the knots; between them the cubic
// whose slope at each knot is that from the one before to the one after (Catmull and Rom 1974). No sampling
// rate is in it: a slow one reads the same curve as a fast one.
class WanderingTemperature {
public:
    explicit WanderingTemperature(const StageContext& context)
        : wander_(context.stream({'T', 'w'}, 0)),
          reference_C_(context.model.temperature ? context.model.temperature->reference_C
                                                 : TemperatureModel{}.reference_C),
          samples_per_knot_(wander_knot_s * context.rate_hz),
          correlation_(portable_exp(-wander_knot_s / wander_tau_s)),
          innovation_C_(wander_sd_C * std::sqrt(1.0 - correlation_ * correlation_)) {
        knots_C_[3] = wander_sd_C * wander_.normal(draws_++);
        for (int more = 0; more < 3; ++more) { draw_knot(); }
    }

    void fill(std::uint64_t first_index, std::span<double> die_C) {
        std::size_t i = 0;
        while (i < die_C.size()) {
            const double begin = static_cast<double>(knot_) * samples_per_knot_;
            const double end = static_cast<double>(knot_ + 1) * samples_per_knot_;
            const double first = static_cast<double>(first_index + i);
            if (first >= end) {
                ++knot_;
                draw_knot();
                continue;
            }
            const double samples_left = std::ceil(end - first);
            const std::size_t stop = samples_left < static_cast<double>(die_C.size() - i)
                                         ? i + static_cast<std::size_t>(samples_left)
                                         : die_C.size();
            const auto [before_C, here_C, next_C, after_C] = knots_C_;
            const double slope = (next_C - before_C) / 2.0;
            const double next_slope = (after_C - here_C) / 2.0;
            const double rise = next_C - here_C;
            const double bend = 3.0 * rise - 2.0 * slope - next_slope;
            const double twist = slope + next_slope - 2.0 * rise;
            const double start_C = reference_C_ + here_C;
            for (; i < stop; ++i) {
                const double part = (static_cast<double>(first_index + i) - begin) / samples_per_knot_;
                die_C[i] = start_C + part * (slope + part * (bend + part * twist));
            }
        }
    }

private:
    void draw_knot() {
        for (std::size_t k = 0; k < 3; ++k) { knots_C_[k] = knots_C_[k + 1]; }
        knots_C_[3] = correlation_ * knots_C_[2] + innovation_C_ * wander_.normal(draws_++);
    }

    RandomStream wander_;
    double reference_C_;
    double samples_per_knot_;
    double correlation_;
    double innovation_C_;
    std::uint64_t draws_ = 0;
    std::uint64_t knot_ = 0;           // the one at or before the sample
    std::array<double, 4> knots_C_{};  // knot_ - 1 to knot_ + 2, less the reference
};

std::array<std::span<double>, 3> slots_of(const SampleBlock& block, BlockVectors& vectors) {
    return {block.slots(vectors[0]), block.slots(vectors[1]), block.slots(vectors[2])};
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
            world_->temperature(block.slots(block.world_s), block.slots(block.die_C));
        } else {
            temperature_.fill(block.first(), block.slots(block.die_C));
        }
        if (world_ != nullptr && world_->moves()) {
            move(block);
        } else if (block.first() == 0) {
            stand_still(block);
        }
    }

private:
    void stand_still(SampleBlock& block) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            block.true_rate_rad_s[axis].fill(0.0);
            block.specific_force_m_s2[axis].fill(axis == 2 ? standard_gravity_m_s2 : 0.0);
        }
        if (orientation_) {
            for (std::size_t i = 0; i < block_samples; ++i) { turn(block.specific_force_m_s2, i); }
        }
    }

    // The reference's readings hold its noise; what was there is a reading less a draw of that noise.
    void move(SampleBlock& block) {
        block.moving = true;
        world_->motion(block.slots(block.world_s), slots_of(block, block.true_rate_rad_s),
                       slots_of(block, block.specific_force_m_s2));
        for (std::size_t axis = 0; axis < 3 && reference_sd_rad_s_ != 0.0; ++axis) {
            BlockValues draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
            reference_noise_[axis]->normals(block.first(), block.slots(draws));
            for (std::size_t i = block.begin; i < block.end; ++i) {
                block.true_rate_rad_s[axis][i] -= reference_sd_rad_s_ * draws[i];
            }
        }
        if (orientation_) {
            turn(block, block.true_rate_rad_s);
            turn(block, block.specific_force_m_s2);
        }
    }

    void turn(const SampleBlock& block, BlockVectors& vectors) const {
        for (std::size_t i = block.begin; i < block.end; ++i) { turn(vectors, i); }
    }

    void turn(BlockVectors& vectors, std::size_t i) const {
        const Vector3 body = {vectors[0][i], vectors[1][i], vectors[2][i]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Vector3& row = (*orientation_)[axis];
            vectors[axis][i] = row[0] * body[0] + row[1] * body[1] + row[2] * body[2];
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
