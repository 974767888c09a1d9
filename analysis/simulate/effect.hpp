// The effects that a model may list under "effects": one file each in effects/, one line each in the chain
// (chain.cpp), whose order is that of their action.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "analysis/simulate/course.hpp"
#include "analysis/simulate/effect_signature.hpp"
#include "analysis/simulate/stage.hpp"

namespace gyrolog {

struct EffectParam {
    enum class Range {
        any,
        not_negative,
        positive,
        above_two,
        share,  // 0 to 1
        yes_no  // 0 or 1
    };

    std::string_view name;  // its unit at the end
    std::string_view meaning;
    Range range = Range::any;
    bool from_model = false;      // not needed: what takes its place is another part of the model
    double plausible_from = 0.0;  // for an MPU-9250
    double plausible_to = 0.0;
    std::optional<double> otherwise{};  // where the model says nothing; without it the parameter is needed
    // Only whole numbers from 1 to this, unless zero.
    double whole_up_to = 0.0;
    std::optional<double> most{};  // of its size, either sign
};

// A course that an entry gives by some of its points, straight between them, and constant before the first
// and after the last.
struct EffectTable {
    std::string_view at;     // the first column, which increases; its unit at the end
    std::string_view value;  // the second; its unit at the end
    std::string_view meaning;
    bool positive = false;  // the second is above zero
};

class EffectUse;

struct EffectDefinition {
    std::string_view name;
    std::string_view model;   // the formula, in the parameters' names
    std::string_view source;  // of the formula, with equation or section; for what is plain: ""
    std::span<const EffectParam> params;
    std::unique_ptr<Stage> (*make)(const EffectUse&);
    // Why parameters that are each in their range cannot be simulated together.
    std::optional<std::string> (*refusal)(const EffectModel&) = nullptr;
    // The parameter, if any, by which the sensor's true rate exceeds the nominal one, relative.
    std::string_view rate_error{};
    // The parameter, if any, in deg/s, that is the converter's step on its axes; see converter_step_rad_s().
    std::string_view converter_step{};
    // It changes the temperature itself: a recorded one has it already.
    bool warms = false;
    // It has no part in the noise-free answer to the world.
    bool noise_only = false;
    // It moves, by a law, the moments at which the world is sampled, and does nothing else.
    bool timing_only = false;
    // A second stage, which acts before the world is asked: on the moments that the samples show.
    std::unique_ptr<Stage> (*make_timing)(const EffectUse&) = nullptr;
    // By how much that stage makes what samples show older in the mean.
    double (*mean_age_samples)(const EffectModel&) = nullptr;
    // Whether the world tells that stage what to do to each sample. It is then a part of the noise-free
    // answer, whatever `noise_only` says.
    bool (*timing_is_known)(const EffectModel&, const World& world) = nullptr;
    // The course that an entry needs, if it needs one.
    std::optional<EffectTable> table{};
    // Under this name a diagnosis models with it what no effect of the catalogue is; empty for others.
    std::string_view form{};
    // How it shows in a recording; null for what a diagnosis does not look for.
    const EffectSignature* signature = nullptr;
};

// One entry of a model's list, as its stage is made from it.
class EffectUse {
public:
    // `effect` has no effect_refusal() and is the `place`-th in the list of the context's model.
    EffectUse(const StageContext& context, const EffectDefinition& definition, const EffectModel& effect,
              unsigned place)
        : context_(&context), definition_(&definition), effect_(&effect), place_(place) {}

    const StageContext& context() const { return *context_; }
    const EffectModel& entry() const { return *effect_; }
    // The value given, or the parameter's own.
    double operator[](std::string_view param) const;
    // The value given, or `from_model` of a parameter that is marked so.
    double or_else(std::string_view param, double from_model) const;
    Course course() const;  // of an effect with a table
    // An entry without axes acts on all.
    bool acts_on(std::size_t axis) const;
    // A random stream of this entry's own; `part` below 4096.
    RandomStream stream(std::size_t axis, unsigned part = 0) const;

private:
    const StageContext* context_;
    const EffectDefinition* definition_;
    const EffectModel* effect_;
    unsigned place_;
};

// Why the effect cannot be simulated: an unknown name, axis or parameter, one that is missing or out of its
// range. Empty when it can.
std::optional<std::string> effect_refusal(const EffectModel& effect);

}  // namespace gyrolog
