#include "host/formats/noise_json.hpp"

#include "host/base/program_name.hpp"
#include "host/formats/json.hpp"
#include "host/formats/noise_unit.hpp"

namespace gyrolog {
namespace {

Json coefficient_json(const FittedCoefficient& fitted, NoiseTerm term, const SensorUnit& unit) {
    const double scale = unit.per_column_unit;
    if (fitted.state == FittedCoefficient::State::not_identifiable) {
        return {{"state", "not_identifiable"},
                {"upper", fitted.upper * scale},
                {"estimate", fitted.estimate * scale},
                {"sd", fitted.estimate_sd * scale},
                {"unit", noise_unit(term, unit)}};
    }
    Json json = {{"state", "identified"},   {"value", fitted.value * scale},
                 {"sd", fitted.sd * scale}, {"lo", fitted.lo * scale},
                 {"hi", fitted.hi * scale}, {"unit", noise_unit(term, unit)}};
    if (fitted.bound > 0.0) { json["bound"] = fitted.bound * scale; }
    return json;
}

// {"N": {"B": -0.3}, ...}: each pair of identified terms once, and only where it is known.
Json correlation_json(const NoiseFit& fit) {
    Json json = Json::object();
    const auto identified = [&](NoiseTerm term) {
        return fit[term].state == FittedCoefficient::State::identified;
    };
    for (const NoiseTerm a : all_noise_terms) {
        for (const NoiseTerm b : all_noise_terms) {
            const double r = fit.correlation[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
            if (a < b && identified(a) && identified(b) && r != 0.0) {
                json[std::string(name_of(a))][std::string(name_of(b))] = r;
            }
        }
    }
    return json;
}

Json gauss_markov_json(const NoiseFit& fit, const SensorUnit& unit) {
    Json list = Json::array();
    for (const FittedGaussMarkov& noise : fit.gauss_markov) {
        list.push_back({{"sigma", noise.value.sigma_rad_per_s * unit.per_column_unit},
                        {"sigma_sd", noise.sigma_sd * unit.per_column_unit},
                        {"correlation_s", noise.value.correlation_s},
                        {"correlation_sd_s", noise.correlation_sd_s},
                        {"unit", unit.name}});
    }
    return list;
}

Json sinusoids_json(const NoiseFit& fit, const SensorUnit& unit) {
    Json list = Json::array();
    for (const FittedSinusoid& line : fit.sinusoids) {
        list.push_back({{"amplitude", line.value.amplitude_rad_per_s * unit.per_column_unit},
                        {"amplitude_sd", line.amplitude_sd * unit.per_column_unit},
                        {"frequency_hz", line.value.frequency_hz},
                        {"frequency_sd_hz", line.frequency_sd_hz},
                        {"unit", unit.name}});
    }
    return list;
}

}  // namespace

void put_noise_fit(Json& json, const NoiseFit& fit, const SensorUnit& unit) {
    json["method"] = name_of(fit.method);
    for (const NoiseTerm term : all_noise_terms) {
        json["coefficients"][std::string(name_of(term))] = coefficient_json(fit[term], term, unit);
    }
    if (Json correlation = correlation_json(fit); !correlation.empty()) {
        json["correlation"] = std::move(correlation);
    }
    json["gauss_markov"] = gauss_markov_json(fit, unit);
    json["sinusoids"] = sinusoids_json(fit, unit);
}

Json slopes_json(const SlopeReading& slopes, const SensorUnit& unit) {
    Json json = Json::object();
    if (slopes.N) { json["N"] = slopes.N->coefficient * unit.per_column_unit; }
    if (slopes.B) { json["B"] = slopes.B->coefficient * unit.per_column_unit; }
    if (slopes.K) { json["K"] = slopes.K->coefficient * unit.per_column_unit; }
    return json;
}

std::string json_text(Json report) {
    report["reported_by"] = program_name();
    return written_out(report, 1);
}

}  // namespace gyrolog
