#include "analysis/diagnose/selection/asked_effect.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/numerics/golden_section.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog::resolution {

constexpr double amount_most = 3.0;
constexpr double amount_tolerance_rel = 1e-3;
// Of the amount, for the curvature.
constexpr double amount_step = 0.02;
constexpr int amount_doublings = 8;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

EffectModel times(EffectModel entry, double amount) {
    const EffectTable& table = *find_effect(entry.effect)->table;
    for (double& value : entry.table.at(std::string(table.value))) {
        value = table.positive ? std::pow(value, amount) : value * amount;
    }
    return entry;
}

// Of one recording under one model.
class Question {
public:
    Question(const Observation& without, const EffectModel& entry)
        : without_(without), entry_(entry), without_nats_(log_likelihood_nats(without)) {}

    double gain_nats(const EffectModel& entry) const {
        SensorModel model = without_.prediction().model();
        model.effects.push_back(entry);
        return log_likelihood_nats(without_.under(model)) - without_nats_;
    }
    double gain_nats(double amount) const { return gain_nats(times(entry_, amount)); }

    double likeliest_amount() const {
        return place_of_top([this](double amount) { return gain_nats(amount); }, -resolution::amount_most,
                            resolution::amount_most, resolution::amount_tolerance_rel);
    }

    // A step that changes the likelihood by half a nat or more, so that rounding does not mislead.
    double sd_of(double amount) const {
        const double top = gain_nats(amount);
        for (int doubling = 0; doubling < resolution::amount_doublings; ++doubling) {
            const double step = std::ldexp(resolution::amount_step, doubling);
            const double fall = 2.0 * top - gain_nats(amount - step) - gain_nats(amount + step);
            if (fall >= 1.0) { return step / std::sqrt(fall); }
        }
        return resolution::amount_most;
    }

private:
    const Observation& without_;
    const EffectModel& entry_;
    double without_nats_;
};

Asked::Answer answer_of(const Observation& without, const EffectModel& entry) {
    const Question question(without, entry);
    Asked::Answer answer;
    answer.gain_nats = answer.described_nats = question.gain_nats(entry);
    if (!find_effect(entry.effect)->table) {
        answer.p = std::exp(-std::max(answer.gain_nats, 0.0));
        answer.is_called_for = answer.gain_nats >= decisions.strong_nats;
        return answer;
    }
    const double amount = question.likeliest_amount();
    answer.amount = {amount, question.sd_of(amount)};
    answer.gain_nats = question.gain_nats(amount);
    answer.p = std::erfc(std::sqrt(std::max(answer.gain_nats, 0.0)));
    answer.is_called_for = answer.gain_nats >= decisions.seen_nats();
    return answer;
}

}  // namespace

Asked asked(const DescribedEffect& described, const Observation& beside, const Observation& alone) {
    return {described, answer_of(beside, described.entry), answer_of(alone, described.entry)};
}

}  // namespace gyrolog
