#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class Stale final : public Stage {
public:
    explicit Stale(const EffectUse& use)
        : updates_per_sample_(1.0 - use["eps"]), phase_(use.stream(0).uniform(0)) {
        for (std::size_t axis = 0; axis < 3; ++axis) { acts_[axis] = use.acts_on(axis); }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const double update =
                std::floor(static_cast<double>(block.first_index + i) * updates_per_sample_ + phase_);
            if (update != update_) { shown_ = reading(block, i); }
            update_ = update;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (acts_[axis]) { block.rate_rad_s[axis][i] = shown_.rate_rad_s[axis]; }
            }
            block.temperature_C[i] = shown_.temperature_C;
        }
    }

private:
    struct Reading {
        Vector3 rate_rad_s{};
        double temperature_C = 0.0;
    };

    static Reading reading(const SampleBlock& block, std::size_t i) {
        return {{block.rate_rad_s[0][i], block.rate_rad_s[1][i], block.rate_rad_s[2][i]},
                block.temperature_C[i]};
    }

    double updates_per_sample_;
    double phase_;
    double update_ = -1.0;
    Reading shown_;
    std::array<bool, 3> acts_{};
};

std::unique_ptr<Stage> make_stale(const EffectUse& use) { return std::make_unique<Stale>(use); }

constexpr EffectParam stale_params[] = {
    {.name = "eps",
     .meaning = "share of the samples that repeat: 1 less the sensor's update rate over the polling rate",
     .range = EffectParam::Range::share,
     .plausible_from = 1e-4,
     .plausible_to = 0.45},
};

// The samples that repeat tell nothing that the ones before did not.
void leave_out_repeats(const Recording& recording, const EffectModel& entry, std::vector<bool>& judged) {
    std::vector<const Column*> columns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Column* column = recording.find(gyro_columns[axis]);
        if (acts_on(entry, axis) && column != nullptr) { columns.push_back(column); }
    }
    if (columns.empty()) { return; }
    for (const Segment& segment : recording.segments) {
        for (std::size_t row = segment.first + 1; row < segment.first + segment.count; ++row) {
            const bool repeats = std::ranges::all_of(columns, [row](const Column* column) {
                return std::visit([row](const auto& data) { return data[row] == data[row - 1]; },
                                  column->data);
            });
            if (repeats) { judged[row] = false; }
        }
    }
}

constexpr EffectSignature stale_signature = {
    .method = EvidenceMethod::repeats,
    .place = PlaceKind::structure,
    .structure = "duplicated_samples",
    .unjudged = leave_out_repeats,
    .words = "Of the samples {eps} repeat the one before.",
    .noun = "a share of repeated samples of {eps}",
    .decided_by = "raw counts of all axes and the temperature, read at the sensor's data-ready signal",
};

}  // namespace

constinit const EffectDefinition stale_effect = {
    .name = "stale",
    .model =
        "sample k repeats the one before, in rate and temperature, where floor(k (1 - eps) + phase) does "
        "not advance; phase from the seed",
    .source = "",
    .params = stale_params,
    .make = make_stale,
    .noise_only = true,
    .signature = &stale_signature,
};

}  // namespace gyrolog
