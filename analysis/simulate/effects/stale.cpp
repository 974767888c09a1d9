#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/update_beat.hpp"

namespace gyrolog {

namespace {

constexpr double alike_sigma = 3.0;

bool is_whole_beat(const EffectModel& entry) {
    const bool on_all = acts_on(entry, 0) && acts_on(entry, 1) && acts_on(entry, 2);
    return on_all && EffectValues(entry)["run_length"] == 0.0;
}

// Of the samples that repeat none.
double mean_age_samples(const EffectModel& entry) {
    return is_whole_beat(entry) && EffectValues(entry)["eps"] > 0.0 ? 0.5 : 0.0;
}

// Null unless the world's beat is the entry's: both repeat as often, as far as chance would tell two numbers
// of repeats apart.
const UpdateBeat* recorded_beat_of(const EffectModel& entry, const World* world) {
    const UpdateBeat* recorded = world != nullptr ? world->recorded_beat() : nullptr;
    if (recorded == nullptr || !is_whole_beat(entry)) { return nullptr; }
    const double eps = EffectValues(entry)["eps"];
    const double sd_rel = 1.0 / std::sqrt(static_cast<double>(recorded->repeats()));
    return std::fabs(recorded->eps() - eps) <= alike_sigma * sd_rel * eps ? recorded : nullptr;
}

UpdateBeat beat_of(const EffectUse& use) {
    if (const UpdateBeat* recorded = recorded_beat_of(use.entry(), use.context().world)) { return *recorded; }
    return {use["eps"], use.stream(0).uniform(0)};
}

// Polled faster than the sensor updates.
class Beat {
public:
    explicit Beat(const EffectUse& use) : beat_(beat_of(use)) {}

    bool repeats(std::uint64_t sample) {
        const double before = update_;
        update_ = beat_.at(sample).number;
        return update_ == before;
    }

private:
    UpdateBeat beat_;
    double update_ = std::numeric_limits<double>::quiet_NaN();  // none before the first sample
};

// A Markov chain: a run ends after each of its samples with chance 1 / run_length, and the share of repeats
// is eps.
class Runs {
public:
    explicit Runs(const EffectUse& use)
        : draws_(use.stream(0)), ends_(1.0 / std::max(use["run_length"], 1.0)) {
        const double eps = use["eps"];
        begins_ = std::min(1.0, ends_ * eps / std::max(1.0 - eps, ends_ * 1e-9));
    }

    bool repeats(std::uint64_t sample) {
        in_run_ = draws_.uniform(sample + 1) < (in_run_ ? 1.0 - ends_ : begins_) && sample > 0;
        return in_run_;
    }

private:
    RandomStream draws_;
    double ends_;
    double begins_ = 0.0;
    bool in_run_ = false;
};

// The axes of one sensor update together: of some alone, the repeats are not the sensor's.
class UpdateInstants final : public Stage {
public:
    explicit UpdateInstants(const EffectUse& use)
        : beat_(beat_of(use)), period_s_(1.0 / use.context().rate_hz) {}

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            block.world_s[i] -= period_s_ * beat_.at(block.first_index + i).age_samples;
        }
    }

private:
    UpdateBeat beat_;
    double period_s_;
};

std::unique_ptr<Stage> make_update_instants(const EffectUse& use) {
    return mean_age_samples(use.entry()) > 0.0 ? std::make_unique<UpdateInstants>(use) : nullptr;
}

bool knows_updates(const EffectModel& entry, const World& world) {
    return recorded_beat_of(entry, &world) != nullptr;
}

template <typename Pattern>
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

    Pattern pattern_;
    Reading shown_;
    std::array<bool, 3> acts_{};
};

std::unique_ptr<Stage> make_stale(const EffectUse& use) {
    if (use["run_length"] > 0.0) { return std::make_unique<Stale<Runs>>(use); }
    return std::make_unique<Stale<Beat>>(use);
}

constexpr EffectParam stale_params[] = {
    {.name = "eps",
     .meaning = "share of the samples that repeat: 1 less the sensor's update rate over the polling rate",
     .range = EffectParam::Range::share,
     .plausible_from = 1e-4,
     .plausible_to = 0.45,
     .most = 0.999},
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
        "sample k repeats the one before, in rate and temperature, where x = k (1 - eps) + phase passes no "
        "whole number, phase from the seed or that of the recording followed; on all axes, it shows the "
        "world as of the moment when x passed "
        "one; with a run_length by a Markov chain whose share of repeats is eps",
    .source = "",
    .params = stale_params,
    .make = make_stale,
    .noise_only = true,
    .make_timing = make_update_instants,
    .mean_age_samples = mean_age_samples,
    .timing_is_known = knows_updates,
    .signature = &stale_signature,
};

}  // namespace gyrolog
