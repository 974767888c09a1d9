#include <cmath>
#include <optional>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

namespace {

class StudentNoise final : public Stage {
public:
    explicit StudentNoise(const EffectUse& use) : nu_(use["nu"]) {
        const double unit_variance = std::sqrt((nu_ - 2.0) / nu_);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!use.acts_on(axis)) { continue; }
            const double N = use.context().model.axes[axis].noise.N_rad_per_sqrt_s;
            scale_rad_s_[axis] = N * std::sqrt(use.context().rate_hz) * unit_variance;
            streams_[axis] = use.stream(axis);
        }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!streams_[axis]) { continue; }
            for (std::size_t i = block.begin; i < block.end; ++i) {
                block.white_rad_s[axis][i] =
                    scale_rad_s_[axis] * student(*streams_[axis], block.first_index + i);
            }
        }
    }

private:
    double student(const RandomStream& stream, std::uint64_t index) const {
        const double u = stream.uniform(2 * index);
        const double square = nu_ * (portable_exp(-2.0 / nu_ * portable_log(u)) - 1.0);
        return std::sqrt(square) * portable_sine_of_turns(stream.uniform(2 * index + 1));
    }

    double nu_;
    Vector3 scale_rad_s_{};
    std::array<std::optional<RandomStream>, 3> streams_;
};

std::unique_ptr<Stage> make_heavy_tail(const EffectUse& use) { return std::make_unique<StudentNoise>(use); }

constexpr EffectParam heavy_tail_params[] = {
    {.name = "nu",
     .meaning = "degrees of freedom",
     .range = EffectParam::Range::above_two,
     .plausible_from = 3.5,
     .plausible_to = 150.0},
};

double degrees_of_freedom(const EffectValues& effect) { return effect["nu"]; }

constexpr EffectSignature heavy_tail_signature = {
    .method = EvidenceMethod::tails,
    .place = PlaceKind::amplitude,
    .degrees_of_freedom = degrees_of_freedom,
    .words = "Single samples stray further than normal noise does: Student's t with {nu} degrees of freedom.",
    .noun = "tails of Student's t with {nu} degrees of freedom",
    .decided_by = "a recording at rest of {length}, of raw samples",
};

}  // namespace

constinit const EffectDefinition heavy_tail_effect = {
    .name = "heavy_tail",
    .model =
        "Student's t with nu degrees of freedom in place of the model's white noise, of the same variance",
    .source = "R. W. Bailey, Math. Comp. 62 (1994) 779",
    .params = heavy_tail_params,
    .make = make_heavy_tail,
    .signature = &heavy_tail_signature,
};

}  // namespace gyrolog
