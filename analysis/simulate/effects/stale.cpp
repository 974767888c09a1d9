#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

// Whether a sample repeats the one before, asked for one after the other.
class RepeatPattern {
public:
    explicit RepeatPattern(const EffectUse& use)
        : draws_(use.stream(0)),
          fresh_share_(1.0 - use["eps"]),
          run_length_(use["run_length"]),
          phase_(draws_.uniform(0)) {}

    bool repeats(std::uint64_t sample) {
        const bool repeats = run_length_ > 0.0 ? is_in_run(sample) : is_in_beat(sample);
        repeated_ = repeats && sample > 0;
        return repeated_;
    }

private:
    // Polled faster than the sensor updates.
    bool is_in_beat(std::uint64_t sample) {
        const double before = update_;
        update_ = std::floor(static_cast<double>(sample) * fresh_share_ + phase_);
        return update_ == before;
    }

    // A Markov chain: a run ends after each of its samples with chance 1 / run_length, and the share of
    // repeats is eps.
    bool is_in_run(std::uint64_t sample) {
        const double ends = 1.0 / std::max(run_length_, 1.0);
        const double begins =
            std::min(1.0, ends * (1.0 - fresh_share_) / std::max(fresh_share_, ends * 1e-9));
        return draws_.uniform(sample + 1) < (repeated_ ? 1.0 - ends : begins);
    }

    RandomStream draws_;
    double fresh_share_;
    double run_length_;
    double phase_;
    double update_ = -1.0;
    bool repeated_ = false;
};

class Stale final : public Stage {
public:
    explicit Stale(const EffectUse& use) : pattern_(use) {
        for (std::size_t axis = 0; axis < 3; ++axis) { acts_[axis] = use.acts_on(axis); }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            if (!pattern_.repeats(block.first_index + i)) { shown_ = reading(block, i); }
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

    RepeatPattern pattern_;
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
    {.name = "run_length",
     .meaning =
         "0: repeats come in a beat; else at random, in runs of this mean number, geometric, at least 1",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 1.0,
     .plausible_to = 20.0,
     .otherwise = 0.0},
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
    .words =
        "Of the samples {eps} repeat the one before[, at random times, in runs of {run_length} on average].",
    .noun = "a share of repeated samples of {eps}",
    .decided_by = "raw counts of all axes and the temperature, read at the sensor's data-ready signal",
};

}  // namespace

constinit const EffectDefinition stale_effect = {
    .name = "stale",
    .model =
        "sample k repeats the one before, in rate and temperature, where floor(k (1 - eps) + phase) does "
        "not advance, phase from the seed; with a run_length by a Markov chain whose share of repeats is eps",
    .source = "",
    .params = stale_params,
    .make = make_stale,
    .noise_only = true,
    .signature = &stale_signature,
};

}  // namespace gyrolog
