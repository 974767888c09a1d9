// Bumps and shocks come from outside: every one moves all axes, about an axis of its own, and rings out. What
// a recording at rest shows of them says nothing about the sensor, so that an entry also leaves those
// stretches out of what is judged (analysis/recording/disturbances.hpp).
#include "analysis/simulate/effects/disturbance.hpp"

#include <cmath>
#include <utility>

#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/effects/arrivals.hpp"
#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

namespace {

// Of a bump, in decay times: then e^-12 of it is left.
constexpr double rings_for = 12.0;
// More of them than this need memory while the sensor runs.
constexpr std::size_t at_once = 64;

class Bumps final : public Stage {
public:
    Bumps(const EffectUse& use, double per_sample)
        : arrivals_(use.stream(0, 0), per_sample),
          sizes_(use.stream(0, 1)),
          sample_s_(1.0 / use.context().rate_hz),
          size_rad_s_(use["size_dps"] * rad_per_deg),
          f_hz_(use["f_hz"]),
          decay_s_(use["decay_s"]) {
        ringing_.reserve(at_once);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            directions_[axis] = use.stream(axis, 2);
            acts_on_[axis] = use.acts_on(axis);
        }
    }

    void apply(SampleBlock& block) override {
        const std::uint64_t end = block.first_index + block.end;
        for (; arrivals_.sample() < end; arrivals_.next()) { ringing_.push_back(next_bump()); }
        for (const Bump& bump : ringing_) { add(bump, block); }
        std::erase_if(ringing_, [&](const Bump& bump) {
            return static_cast<double>(end - bump.sample) * sample_s_ > rings_for * decay_s_;
        });
    }

private:
    struct Bump {
        std::uint64_t sample = 0;
        Vector3 size_rad_s{};
    };

    // From half the size to one and a half, about an axis of any direction.
    Bump next_bump() {
        const std::uint64_t number = arrivals_.number();
        const double size_rad_s = size_rad_s_ * (0.5 + sizes_.uniform(number));
        Vector3 direction{};
        double square = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            direction[axis] = directions_[axis]->normal(number);
            square += direction[axis] * direction[axis];
        }
        Bump bump{arrivals_.sample(), {}};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (acts_on_[axis]) { bump.size_rad_s[axis] = size_rad_s * direction[axis] / std::sqrt(square); }
        }
        return bump;
    }

    void add(const Bump& bump, SampleBlock& block) const {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const std::uint64_t sample = block.first_index + i;
            if (sample < bump.sample) { continue; }
            const double since_s = static_cast<double>(sample - bump.sample) * sample_s_;
            const double course = portable_exp(-since_s / decay_s_) * portable_sine_of_turns(f_hz_ * since_s);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.rate_rad_s[axis][i] += bump.size_rad_s[axis] * course;
            }
        }
    }

    Arrivals arrivals_;
    RandomStream sizes_;
    std::array<std::optional<RandomStream>, 3> directions_;
    std::array<bool, 3> acts_on_{};
    double sample_s_;
    double size_rad_s_;
    double f_hz_;
    double decay_s_;
    std::vector<Bump> ringing_;
};

std::unique_ptr<Stage> make_disturbance(const EffectUse& use) {
    const double per_sample = use["per_hour"] / (s_per_h * use.context().rate_hz);
    if (per_sample == 0.0 || use["simulated"] == 0.0) { return nullptr; }
    return std::make_unique<Bumps>(use, per_sample);
}

constexpr EffectParam disturbance_params[] = {
    {.name = "per_hour",
     .meaning = "mean number an hour, Poisson",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.1,
     .plausible_to = 360.0,
     .most = 1e5},
    {.name = "size_dps",
     .meaning = "middle size, before it decays",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.1,
     .plausible_to = 100.0},
    {.name = "decay_s",
     .meaning = "time in which it falls to 1/e",
     .range = EffectParam::Range::positive,
     .plausible_from = 0.02,
     .plausible_to = 2.0},
    {.name = "f_hz",
     .meaning = "frequency at which it rings",
     .range = EffectParam::Range::positive,
     .plausible_from = 2.0,
     .plausible_to = 50.0,
     .otherwise = 8.0},
    {.name = "simulated",
     .meaning = "1: bumps are simulated; 0: what a recording has of them is only left out",
     .range = EffectParam::Range::yes_no,
     .otherwise = 1.0},
};

void unjudged(const Recording& recording, const EffectModel& /*entry*/, std::vector<bool>& judged) {
    for (const Disturbance& one : gyro_disturbances(recording)) {
        std::fill_n(judged.begin() + static_cast<std::ptrdiff_t>(one.first), one.rows, false);
    }
}

constexpr EffectSignature disturbance_signature = {
    .method = EvidenceMethod::disturbances,
    .place = PlaceKind::time,
    .whole_sensor = true,
    .unjudged = unjudged,
    .words =
        "The sensor is loud in short stretches, {per_hour}, by up to {size_dps}, as from bumps: those are "
        "left "
        "out.",
    .noun = "bumps of {size_dps}, {per_hour}",
    .decided_by = "a recording at rest where nothing touches the bench",
};

}  // namespace

std::vector<Disturbance> gyro_disturbances(const Recording& recording) {
    if (recording.samples_per_row > 1) { return {}; }
    std::vector<std::vector<double>> rates;
    for (const char* name : gyro_columns) {
        const Column* column = recording.find(name);
        if (column != nullptr) { rates.push_back(column->values()); }
    }
    return disturbances(recording, rates);
}

constinit const EffectDefinition disturbance_effect = {
    .name = "disturbance",
    .model =
        "rate plus bumps at random instants, on all axes at once: u(0.5, 1.5) size_dps along a direction of "
        "its own, exp(-t / decay_s) sin(2 pi f_hz t)",
    .source = "",
    .params = disturbance_params,
    .make = make_disturbance,
    .noise_only = true,
    .signature = &disturbance_signature,
};

}  // namespace gyrolog
