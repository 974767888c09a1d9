// Lines as --jsonl writes them, made up.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host/fleet/fleet_line.hpp"

namespace gyrolog {

struct MadeUnit {
    std::string file = "a.csv";
    std::string board = "S1";
    double bias = 0.1;
    double bias_sd = 0.001;
    double N = 0.005;
    double N_sd = 1e-5;
};

// Of an analysis in which K is not identified, with the three axes alike.
inline nlohmann::json analysis_of(const MadeUnit& unit) {
    nlohmann::json axis;
    axis["bias"] = {{"value", unit.bias},
                    {"expanded_uncertainty", 2.0 * unit.bias_sd},
                    {"coverage_factor", 2.0},
                    {"unit", "dps"}};
    axis["coefficients"]["N"] = {
        {"state", "identified"}, {"value", unit.N}, {"sd", unit.N_sd}, {"unit", "dps/sqrt(Hz)"}};
    axis["coefficients"]["K"] = {{"state", "not_identifiable"}, {"upper", 1e-4}, {"unit", "dps*sqrt(Hz)"}};
    nlohmann::json line{{"file", unit.file},
                        {"schema", "gyrolog-analysis/1"},
                        {"reported_by", "gyrolog 0.1.0"},
                        {"seconds", 1.5}};
    line["recording"] = {{"name", unit.file},
                         {"board", unit.board},
                         {"started", "2026-11-21T05:04:55Z"},
                         {"rate_hz", 100.0},
                         {"duration_s", 60.0},
                         {"samples", 5990},
                         {"temperature_C", 31.5},
                         {"dropouts", {{"events", 1}, {"samples", 10}}}};
    for (const char* name : {"x", "y", "z"}) { line["axes"][name] = axis; }
    return line;
}

inline nlohmann::json diagnosis_of(const std::string& file) {
    return nlohmann::json::parse(R"({"file": ")" + file + R"(", "schema": "gyrolog-diagnosis/2",
        "verdict": "partly", "axes": ["x", "y", "z"], "rate_hz": 100.5, "seed": 7, "seconds": 10.0,
        "causes": [{"effect": "tone", "axes": ["x"], "share": 0.62}, {"effect": "rtn", "axes": ["x", "z"],
                    "share": 0.1}],
        "gap_before": {"value": 7.9}, "gap_named": {"value": 3.4}, "gap_after": {"value": null}})");
}

inline FleetLine parsed(const nlohmann::json& line) {
    auto read = parse_fleet_line(line.dump());
    if (read.ok()) { return *read; }
    FleetLine refused;
    refused.error = "refused: " + read.error().message;
    return refused;
}

}  // namespace gyrolog
