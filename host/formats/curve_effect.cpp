#include "host/formats/curve_effect.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gyrolog {
namespace {

using Kind = CurveTerm::Kind;

// The effect that adds a term of that kind.
struct TermEffect {
    Kind kind;
    const char* effect;
    const char* size;
    const char* shape;  // "" for none
    const char* excess;
};

constexpr std::array term_effects = {
    TermEffect{Kind::N, "arw_scale", "factor", "", "arw_scale"},
    TermEffect{Kind::B, "flicker_missing", "B_dps", "", "flicker_excess"},
    TermEffect{Kind::K, "rrw_missing", "K_dps_sqrt_hz", "", "rrw_excess"},
    TermEffect{Kind::Q, "angle_noise", "Q_dps_s", "", "angle_noise_excess"},
    TermEffect{Kind::R, "rate_ramp", "ramp_dps_per_s", "", "rate_ramp_excess"},
    TermEffect{Kind::gauss_markov, "gauss_markov", "sigma_dps", "tau_s", "gauss_markov_excess"},
    TermEffect{Kind::sinusoid, "tone", "amplitude_dps", "f_hz", "tone_excess"},
};

const TermEffect& entry_of(Kind kind) { return *std::ranges::find(term_effects, kind, &TermEffect::kind); }

double& coefficient(NoiseCoefficients& noise, Kind kind) {
    switch (kind) {
        case Kind::Q:
            return noise.Q_rad;
        case Kind::B:
            return noise.B_rad_per_s;
        case Kind::K:
            return noise.K_rad_per_s_sqrt_s;
        case Kind::R:
            return noise.R_rad_per_s2;
        default:
            return noise.N_rad_per_sqrt_s;
    }
}

double uncertainty(const SensorModel& model, std::size_t axis, const std::string& name) {
    for (const auto* stated : {&model.axes[axis].sd_rel, &model.sd_rel}) {
        if (const auto found = stated->find(name); found != stated->end()) { return found->second; }
    }
    return 0.0;
}

bool acts_on(const EffectModel& effect, std::size_t axis) {
    return effect.axes.empty() || std::ranges::count(effect.axes, axis_names.at(axis)) > 0;
}

// By which effects multiply N.
double white_noise_factor(const SensorModel& model, std::size_t axis) {
    const TermEffect& white = entry_of(Kind::N);
    double factor = 1.0;
    for (const EffectModel& effect : model.effects) {
        const auto given = effect.params.find(white.size);
        if (effect.effect == white.effect && acts_on(effect, axis) && given != effect.params.end()) {
            factor *= given->second;
        }
    }
    return factor;
}

bool adds_in_squares(Kind kind) { return kind != Kind::R && kind != Kind::sinusoid; }

}  // namespace

ModelledCurve curve_of_model(const SensorModel& model, std::size_t axis) {
    ModelledCurve curve;
    NoiseCoefficients noise = model.axes.at(axis).noise;
    noise.N_rad_per_sqrt_s *= white_noise_factor(model, axis);
    for (const Kind kind : {Kind::Q, Kind::N, Kind::B, Kind::K, Kind::R}) {
        const double size = coefficient(noise, kind);
        if (size == 0.0) { continue; }
        curve.terms.push_back(
            {{kind, std::abs(size), 0.0}, uncertainty(model, axis, std::string(name_of(kind))), true});
    }
    if (model.lsb_rad_s > 0.0) {
        const RateQuantisation step{model.lsb_rad_s, model.rate_hz};
        curve.terms.push_back({{Kind::N, std::sqrt(step.density()), 0.0}, 0.0, false});
    }
    for (const EffectModel& effect : model.effects) {
        if (!acts_on(effect, axis) || effect.effect == entry_of(Kind::N).effect) { continue; }
        const auto term = std::ranges::find_if(
            term_effects, [&](const TermEffect& entry) { return effect.effect == entry.effect; });
        const auto size = term == term_effects.end() ? effect.params.end() : effect.params.find(term->size);
        if (size == effect.params.end() || (term->shape[0] != '\0' && !effect.params.contains(term->shape))) {
            curve.not_in_curve.push_back(effect.effect);
            continue;
        }
        const double shape = term->shape[0] == '\0' ? 0.0 : effect.params.at(term->shape);
        curve.terms.push_back({{term->kind, std::abs(size->second) * rad_per_deg, shape}, 0.0, false});
    }
    return curve;
}

CurveEffect effect_of(const CurveCause& cause) {
    const TermEffect& entry = entry_of(cause.term.kind);
    const double now = cause.term.size;
    const double before = cause.in_model ? cause.in_model->size : 0.0;
    const double now_sd = now * cause.size_sd_rel;
    if (cause.in_model && (cause.term.kind == Kind::N || now < before)) {
        return {now < before ? entry.excess : entry.effect,
                {{"factor", cause.factor()}},
                {{"factor", now_sd / before}}};
    }
    if (cause.term.kind == Kind::N) {  // no factor makes a term out of none
        return {"arw_missing",
                {{"N_dps_per_sqrt_hz", now * deg_per_rad}},
                {{"N_dps_per_sqrt_hz", now_sd * deg_per_rad}}};
    }
    const bool in_squares = adds_in_squares(cause.term.kind);
    const double added = in_squares ? std::sqrt(now * now - before * before) : now - before;
    const double added_sd = in_squares ? now * now_sd / added : now_sd;
    CurveEffect effect{
        entry.effect, {{entry.size, added * deg_per_rad}}, {{entry.size, added_sd * deg_per_rad}}};
    if (entry.shape[0] != '\0') {
        effect.params[entry.shape] = cause.term.shape;
        effect.sd[entry.shape] = cause.term.shape * cause.shape_sd_rel;
    }
    return effect;
}

std::string effect_name(CurveTerm::Kind kind) { return entry_of(kind).effect; }

void correct(SensorModel& model, std::size_t axis, const CurveCause& cause) {
    const Kind kind = cause.term.kind;
    if (kind == Kind::gauss_markov || kind == Kind::sinusoid) {
        const CurveEffect effect = effect_of(cause);
        model.effects.push_back({effect.effect, {axis_names.at(axis)}, effect.params, ""});
        return;
    }
    const double factor = kind == Kind::N ? white_noise_factor(model, axis) : 1.0;
    coefficient(model.axes.at(axis).noise, kind) = factor > 0.0 ? cause.term.size / factor : cause.term.size;
    model.axes.at(axis).sd_rel[std::string(name_of(kind))] = cause.size_sd_rel;
}

}  // namespace gyrolog
