// A day at 8 kHz through the file path, faster than real time; the default is a part of it.

#include "tests/end_to_end/soak.hpp"

namespace gyrolog {
namespace {

TEST(SoakFile, DayAt8kHzLosesNothingInFlatMemory) {
    const double hours = soak_hours(1.0);
    const TemporaryFolder folder;
    const std::string capture = folder.path("soak.pcapng");
    const WatchedRun run = run_watched({gyrolog_path(), "capture", "--device", "sim:rate=8000,seed=5",
                                        "--duration", std::to_string(hours) + "h", "-o", capture},
                                       folder.path("err"));
    expect_sound(run, capture, folder.path("err"), 8000, hours);
}

}  // namespace
}  // namespace gyrolog
