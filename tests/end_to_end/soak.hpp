// What every long capture must show: nothing lost, accounts that balance, memory that does not grow.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/asked.hpp"
#include "tests/support/program.hpp"
#include "tests/support/watched_program.hpp"

namespace gyrolog {

// Of device time: what GYROLOG_SOAK_HOURS says, or enough for a quarter of a minute.
inline double soak_hours(double otherwise) { return asked("GYROLOG_SOAK_HOURS", otherwise); }

inline void expect_sound(const WatchedRun& run, const std::string& capture, const std::string& err_path,
                         std::uint64_t rate_hz, double hours) {
    constexpr std::size_t most_kB = 32'000;  // the queue and the program's libraries included
    // Pages of the queue that no stall had needed before; a leak of a byte in forty samples would be more.
    constexpr double growth_kB = 2000.0;
    ASSERT_EQ(run.exit_code, 0) << read_whole_file(err_path);
    std::printf(
        "%g h at %llu Hz in %.1f s: peak %zu kB; mean of the second quarter %.0f kB, of the last %.0f kB; "
        "processor %.1f s\n",
        hours, static_cast<unsigned long long>(rate_hz), run.elapsed_s, run.peak_kB, run.mean_kB(0.25, 0.5),
        run.mean_kB(0.75, 1.0), run.processor_s);
    EXPECT_LT(run.peak_kB, most_kB);
    EXPECT_LT(run.mean_kB(0.75, 1.0), run.mean_kB(0.25, 0.5) + growth_kB);

    const ProgramResult checked = run_gyrolog({"check", capture, "--json", "-"});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    const auto answer = nlohmann::json::parse(checked.out);
    EXPECT_EQ(answer["end"], "clean");
    EXPECT_EQ(answer["closed"], true);
    const auto& bytes = answer["bytes"];
    EXPECT_EQ(bytes["total"], bytes["in_frames"].get<std::uint64_t>());
    EXPECT_EQ(bytes["skipped"], 0);
    EXPECT_EQ(bytes["buffered"], 0);
    const auto& file = answer["file_bytes"];
    EXPECT_EQ(file["total"], file["in_blocks"].get<std::uint64_t>());
    EXPECT_EQ(answer["frames"]["missing"], 0);
    EXPECT_EQ(answer["frames"]["corrupted"], 0);
    EXPECT_EQ(answer["frames"]["duplicated"], 0);
    EXPECT_EQ(answer["samples"]["missing"], 0);
    EXPECT_EQ(answer["runs"], 1);
    EXPECT_GE(answer["samples"]["good"].get<double>(),
              hours * 3600.0 * static_cast<double>(rate_hz) * 0.9999);
}

}  // namespace gyrolog
