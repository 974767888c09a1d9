// A day at 1 kHz, of which no computer holds the numbers that a diagnosis works with.

#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;

constexpr double memory_most_bytes = 1e9;

json sensor() {
    const json noise = {{"N", 0.01}, {"B", 0.0}, {"K", 0.0}, {"bias", 0.1}};
    return {{"schema", "gyrolog-model/1"},
            {"rate_hz", 1000.0},
            {"full_scale_dps", 500.0},
            {"lsb_dps", 1.0 / 65.5},
            {"saturation_dps", 500.0},
            {"axes", {{"x", noise}, {"y", noise}, {"z", noise}}},
            {"M", {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}},
            {"latency_s", 0.0},
            {"timestamp_jitter_s", 0.0},
            {"sd_rel", {{"N", 0.01}}},
            {"sd_abs", {{"rate_rel", 1e-4}}},
            {"ref_noise_dps", 0.0},
            {"acc_noise_g", 0.0},
            {"temp_noise_C", 0.005},
            {"effects", json::array()}};
}

// Of what ran until now.
double most_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

TEST(DayDiagnosis, FindsFastAndSlowWithinAGigabyte) {
    const TemporaryFolder folder;
    std::ofstream(folder.path("model.json")) << sensor();
    json real = sensor();
    real["effects"] = {
        {{"effect", "tone"}, {"axes", {"y"}}, {"params", {{"f_hz", 137.3}, {"amplitude_dps", 0.01}}}},
        {{"effect", "rrw_missing"}, {"axes", {"z"}}, {"params", {{"K_dps_sqrt_hz", 1e-4}}}}};
    std::ofstream(folder.path("real.json")) << real;
    const std::string day = folder.path("day.pcapng");
    const ProgramResult simulated =
        run_gyrolog({"simulate", folder.path("real.json"), "-o", day, "--duration", "24h", "--seed", "1"});
    ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
    const ProgramResult diagnosed = run_gyrolog(
        {"diagnose", day, "--model", folder.path("model.json"), "--simulations", "20", "--json", "-"});
    ASSERT_EQ(diagnosed.exit_code, 0) << diagnosed.err;
    const json answer = json::parse(diagnosed.out);
    EXPECT_EQ(answer["verdict"], "known") << diagnosed.out;
    EXPECT_EQ(answer["samples"], 86'400'000);
    std::set<std::string> effects;
    for (const json& cause : answer["causes"]) { effects.insert(cause["effect"].get<std::string>()); }
    EXPECT_EQ(effects, (std::set<std::string>{"rrw_missing", "tone"}));
    EXPECT_LT(most_memory_bytes(), memory_most_bytes);
}

}  // namespace
}  // namespace gyrolog
