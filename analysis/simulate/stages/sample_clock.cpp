#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

class SampleClock final : public Stage {
public:
    explicit SampleClock(const StageContext& context)
        : jitter_(context.stream({'C', 'j'}, 0)),
          period_s_(1.0 / context.rate_hz),
          latency_s_(context.model.latency_s),
          jitter_sd_s_(context.model.timestamp_jitter_s) {}

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const double instant_s = static_cast<double>(block.first_index + i) * period_s_;
            block.lost[i] = false;
            block.stamp_s[i] = instant_s;
            block.world_s[i] = instant_s - latency_s_;
        }
        if (jitter_sd_s_ == 0.0) { return; }
        BlockValues draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        jitter_.normals(block.first(), block.slots(draws));
        for (std::size_t i = block.begin; i < block.end; ++i) { block.stamp_s[i] += jitter_sd_s_ * draws[i]; }
    }

private:
    RandomStream jitter_;
    double period_s_;
    double latency_s_;
    double jitter_sd_s_;
};

}  // namespace

std::unique_ptr<Stage> make_sample_clock(const StageContext& context) {
    return std::make_unique<SampleClock>(context);
}

}  // namespace gyrolog
