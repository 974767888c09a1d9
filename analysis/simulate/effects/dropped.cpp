#include <algorithm>

#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/effects/arrivals.hpp"
#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class Dropped final : public Stage {
public:
    explicit Dropped(const EffectUse& use)
        : bursts_(use.stream(0, 0), use["per_hour"] / (s_per_h * use.context().rate_hz)),
          lengths_(use.stream(0, 1)),
          longest_(use["longest"]),
          period_s_(1.0 / use.context().rate_hz),
          in_stamps_(use["in_stamps"] != 0.0) {}

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            if (in_stamps_) {
                block.lost[i] = block.lost[i] || is_lost(taken_);
            } else {
                while (is_lost(taken_)) { ++taken_; }
                block.world_s[i] += period_s_ * static_cast<double>(taken_ - (block.first_index + i));
            }
            ++taken_;
        }
    }

private:
    // Asked for samples in ascending order.
    bool is_lost(std::uint64_t sample) {
        while (bursts_.sample() <= sample) {
            const auto length =
                1U + static_cast<std::uint64_t>(longest_ * lengths_.uniform(bursts_.number()));
            lost_until_ = std::max(lost_until_, bursts_.sample() + length);
            bursts_.next();
        }
        return sample < lost_until_;
    }

    Arrivals bursts_;
    RandomStream lengths_;
    double longest_;
    double period_s_;
    bool in_stamps_;
    std::uint64_t taken_ = 0;  // samples that the sensor has taken
    std::uint64_t lost_until_ = 0;
};

std::unique_ptr<Stage> make_dropped(const EffectUse& use) {
    return use["per_hour"] == 0.0 ? nullptr : std::make_unique<Dropped>(use);
}

constexpr EffectParam dropped_params[] = {
    {.name = "per_hour",
     .meaning = "mean number of bursts an hour, Poisson",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 1.0,
     .plausible_to = 3600.0,
     .most = 1e6},
    {.name = "longest",
     .meaning = "a burst is 1 to this many samples long, all lengths alike",
     .plausible_from = 1.0,
     .plausible_to = 12.0,
     .otherwise = 12.0,
     .whole_up_to = 1e6},
    {.name = "in_stamps",
     .meaning = "1: the rows are missing and the stamps show it; 0: the stamps close up, and the samples "
                "after a burst come from later moments",
     .range = EffectParam::Range::yes_no,
     .plausible_from = 0.0,
     .plausible_to = 1.0,
     .otherwise = 1.0},
};

constexpr EffectSignature dropped_signature = {
    .method = EvidenceMethod::stamp_gaps,
    .place = PlaceKind::structure,
    .structure = "timestamp_gaps",
    .hides_losses = [](const EffectValues& effect) { return effect["in_stamps"] == 0.0; },
    .words = "Samples are lost {per_hour}, up to {longest} in a row.",
    .noun = "a loss of samples at {per_hour}",
    .decided_by = "a recording with the board's sample counter, or with a reference rate that never rests",
};

}  // namespace

constinit const EffectDefinition dropped_effect = {
    .name = "dropped",
    .model = "bursts of lost samples; the sensor as a whole, whatever its axes",
    .source = "",
    .params = dropped_params,
    .make = make_dropped,
    .noise_only = true,
    .signature = &dropped_signature,
};

}  // namespace gyrolog
