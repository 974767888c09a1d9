// The program killed at random times, and files that rot: what is left opens, is nearly all, and is true. The
// truth is the virtual board's: the same seed gives the same samples.

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "host/capture/capture_reader.hpp"
#include "host/capture/recover.hpp"
#include "host/decode/stream_decoder.hpp"
#include "host/session/writer_thread.hpp"
#include "tests/support/asked.hpp"
#include "tests/support/processor_wait.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;

constexpr const char* device = "sim:rate=1000,seed=7";
constexpr double frame_s = 0.08;  // the longest that the board gathers samples for
constexpr std::uint32_t seed = 20'261'122;

struct Stored {
    bool opened = false;
    std::string error;
    FileEnd end = FileEnd::clean;
    bool balanced = false;
    std::int64_t first_data_ns = 0;  // monotonic arrivals of the first and last bytes of the stream
    std::int64_t last_data_ns = 0;
    std::vector<std::int64_t> index;
    std::array<std::vector<std::int16_t>, 3> counts;
};

class SampleKeeper final : public MessageHandler {
public:
    explicit SampleKeeper(Stored& stored) : stored_(stored) {}
    void on_samples(const ReceivedFrame& /*frame*/, const glp_samples& samples) override {
        for (std::size_t i = 0; i < samples.count; ++i) {
            stored_.index.push_back(static_cast<std::int64_t>(samples.first_index + i));
            for (std::size_t axis = 0; axis < stored_.counts.size(); ++axis) {
                stored_.counts[axis].push_back(glp_sample_field(&samples, i, axis));
            }
        }
    }

private:
    Stored& stored_;
};

Stored stored_in(const std::string& path) {
    Stored stored;
    auto reader = CaptureReader::open(path);
    if (!reader.ok()) {
        stored.error = reader.error().message;
        return stored;
    }
    SampleKeeper keeper(stored);
    StreamDecoder decoder({.keep_samples = false, .observer = &keeper});
    while (true) {
        const auto captured = reader->next();
        if (!captured.ok()) {
            stored.error = captured.error().message;
            return stored;
        }
        if (!*captured) { break; }
        const Transfer& transfer = (*captured)->transfer;
        static_cast<void>(decoder.take(transfer));
        if (transfer.carries_stream() && !transfer.data.empty()) {
            stored.last_data_ns = transfer.time.monotonic_ns;
            if (stored.first_data_ns == 0) { stored.first_data_ns = stored.last_data_ns; }
        }
    }
    const BlockAccounts blocks = reader->accounts().blocks;
    stored.opened = true;
    stored.end = blocks.end;
    stored.balanced = blocks.balanced() && decoder.report().bytes.balanced();
    return stored;
}

// What the board sends in its first seconds, each sample at its index.
class PowerLoss : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_EQ(
            run_gyrolog({"capture", "--device", device, "--duration", "5s", "-o", truth_path}).exit_code, 0);
        truth = stored_in(truth_path);
        ASSERT_EQ(truth.index.size(), 5000U);
        ASSERT_EQ(truth.index.back(), 4999);
    }

    // Samples that are not the board's.
    std::size_t invented(const Stored& stored) const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < stored.index.size(); ++i) {
            const auto at = static_cast<std::size_t>(stored.index[i]);
            const bool same = at < truth.index.size() && stored.counts[0][i] == truth.counts[0][at] &&
                              stored.counts[1][i] == truth.counts[1][at] &&
                              stored.counts[2][i] == truth.counts[2][at];
            count += same ? 0 : 1;
        }
        return count;
    }

    TemporaryFolder folder;
    std::string truth_path = folder.path("truth.pcapng");
    Stored truth;
};

std::size_t kills() { return static_cast<std::size_t>(asked("GYROLOG_KILLS", 20.0)); }

struct Kill {
    std::chrono::milliseconds after{};
    std::string path;
    ProgramResult result;
};

// What a kill may cost where writes take no time, for each file is in memory: what came in the flush
// interval, and what came while one of the threads on the way was waiting for a processor. From the last byte
// of a file to the next one that might have come is up to a frame.
double promised_s(const ProcessorWait& wait) {
    constexpr double threads_on_the_way = 3.0;  // the board's, the writer's, and the one that kills
    constexpr double interval_s = std::chrono::duration<double>(WriterThread::flush_interval).count();
    return interval_s + frame_s + threads_on_the_way * wait.longest_s();
}

TEST_F(PowerLoss, KilledProgramLosesWhatIsPromisedAndInventsNothing) {
    const ProcessorWait wait;
    std::mt19937 random(seed);
    std::vector<Kill> all(kills());
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].after = std::chrono::milliseconds(random() % 2000);
        all[i].path = folder.path("killed" + std::to_string(i) + ".pcapng");
    }
    std::atomic<std::size_t> next = 0;
    std::vector<std::thread> threads;
    // More at once, instrumented, would be a processor's starvation: nothing arrives then, and nothing is
    // lost.
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&] {
            for (std::size_t i = next++; i < all.size(); i = next++) {
                Kill& kill = all[i];
                kill.result =
                    run_gyrolog_and_signal({"capture", "--device", std::string(device) + ",realtime=1",
                                            "--duration", "60s", "-o", kill.path},
                                           kill.after, SIGKILL, kill.path);
            }
        });
    }
    for (std::thread& thread : threads) { thread.join(); }

    std::size_t with_samples = 0;
    std::size_t torn = 0;
    double worst_s = 0.0;
    for (const Kill& kill : all) {
        ASSERT_EQ(kill.result.exit_code, 128 + SIGKILL);
        const Stored stored = stored_in(kill.path);
        const auto what = "killed " + std::to_string(kill.after.count()) + " ms after the file was made: ";
        ASSERT_TRUE(stored.opened) << what << stored.error;
        EXPECT_TRUE(stored.balanced) << what;
        EXPECT_NE(stored.end, FileEnd::damaged) << what;
        torn += stored.end == FileEnd::torn_tail ? 1 : 0;
        EXPECT_EQ(invented(stored), 0U) << what;
        for (std::size_t i = 0; i < stored.index.size(); ++i) {
            ASSERT_EQ(stored.index[i], static_cast<std::int64_t>(i)) << what << "a hole";
        }
        if (stored.last_data_ns == 0) {
            EXPECT_LT(kill.after.count(), 1000) << what << "by then there was something to keep";
            continue;
        }
        const double missing_s = static_cast<double>(kill.result.signalled_ns - stored.last_data_ns) * 1e-9;
        EXPECT_LE(missing_s, promised_s(wait)) << what;
        worst_s = std::max(worst_s, missing_s);
        ++with_samples;
    }
    EXPECT_GE(10 * with_samples, 8 * all.size()) << "the others were killed before anything came";
    std::printf("%zu kills, seed %u: %zu with samples, %zu torn tails, at most %.0f ms missing of %.0f ms\n",
                all.size(), seed, with_samples, torn, 1e3 * worst_s, 1e3 * promised_s(wait));
}

// A sensor without its low-pass, three times on one computer: 96 000 samples a second.
constexpr const char* three_boards = "sim:rate=32000,dlpf=off,seed=7,boards=3";

std::array<std::string, 3> files_of_three(const TemporaryFolder& folder, const std::string& name) {
    return {folder.path(name + "-SIM0001.pcapng"), folder.path(name + "-SIM0002.pcapng"),
            folder.path(name + "-SIM0003.pcapng")};
}

TEST(ThreeBoards, AtFullRateAreCapturedAtOnceToTheLastSample) {
    const TemporaryFolder folder;
    const ProgramResult result =
        run_gyrolog({"capture", "--device", std::string(three_boards) + ",realtime=1", "--duration", "2s",
                     "-o", folder.path("night.pcapng")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    std::int64_t first_end_ns = std::numeric_limits<std::int64_t>::max();
    std::int64_t last_begin_ns = 0;
    for (const std::string& file : files_of_three(folder, "night")) {
        const Stored stored = stored_in(file);
        ASSERT_TRUE(stored.opened) << stored.error;
        EXPECT_EQ(stored.end, FileEnd::clean);
        EXPECT_TRUE(stored.balanced);
        ASSERT_EQ(stored.index.size(), 64'000U) << file;
        for (std::size_t i = 0; i < stored.index.size(); ++i) {
            ASSERT_EQ(stored.index[i], static_cast<std::int64_t>(i)) << file << ": a hole";
        }
        first_end_ns = std::min(first_end_ns, stored.last_data_ns);
        last_begin_ns = std::max(last_begin_ns, stored.first_data_ns);
    }
    EXPECT_GT(first_end_ns - last_begin_ns, 1'500'000'000) << "at once, not one after the other";
}

TEST(ThreeBoards, KilledTogetherLoseWhatIsPromisedOfEach) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_gyrolog({"capture", "--device", three_boards, "--duration", "3s", "-o",
                           folder.path("truth.pcapng")})
                  .exit_code,
              0);
    const auto truths = files_of_three(folder, "truth");
    std::mt19937 random(seed);
    const ProcessorWait wait;
    double worst_s = 0.0;
    for (int kill = 0; kill < 3; ++kill) {
        const std::chrono::milliseconds after(600 + random() % 600);
        const std::string name = "killed" + std::to_string(kill);
        const auto files = files_of_three(folder, name);
        const ProgramResult result =
            run_gyrolog_and_signal({"capture", "--device", std::string(three_boards) + ",realtime=1",
                                    "--duration", "60s", "-o", folder.path(name + ".pcapng")},
                                   after, SIGKILL, files[2]);
        ASSERT_EQ(result.exit_code, 128 + SIGKILL) << result.err;
        for (std::size_t board = 0; board < files.size(); ++board) {
            const Stored stored = stored_in(files[board]);
            const Stored truth = stored_in(truths[board]);
            ASSERT_TRUE(stored.opened) << stored.error;
            EXPECT_TRUE(stored.balanced);
            EXPECT_NE(stored.end, FileEnd::damaged);
            ASSERT_GT(stored.index.size(), 1000U);
            ASSERT_LE(stored.index.size(), truth.index.size());
            for (std::size_t i = 0; i < stored.index.size(); ++i) {
                ASSERT_EQ(stored.index[i], static_cast<std::int64_t>(i)) << files[board] << ": a hole";
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    ASSERT_EQ(stored.counts[axis][i], truth.counts[axis][i]) << "no sample of this board";
                }
            }
            const double missing_s = static_cast<double>(result.signalled_ns - stored.last_data_ns) * 1e-9;
            EXPECT_LE(missing_s, promised_s(wait)) << files[board];
            worst_s = std::max(worst_s, missing_s);
        }
    }
    std::printf("three boards killed together, seed %u: at most %.0f ms missing of %.0f ms\n", seed,
                1e3 * worst_s, 1e3 * promised_s(wait));
}

// One flipped bit costs at most the transfer it hits; check says that it is damage, no torn tail; recover
// keeps what reading finds.
TEST_F(PowerLoss, FlippedBitCostsItsBlockAndIsToldFromATornTail) {
    std::mt19937_64 random(seed);
    std::string whole = read_whole_file(truth_path);
    constexpr int flips = 60;
    std::size_t most_lost = 0;
    std::size_t noticed = 0;
    for (int i = 0; i < flips; ++i) {
        const std::size_t bit =
            1000 * 8 + random() % ((whole.size() - 2000) * 8);  // head and last block apart
        std::string flipped = whole;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
        const std::string path = folder.path("flipped.pcapng");
        std::ofstream(path, std::ios::binary) << flipped;
        const Stored stored = stored_in(path);
        ASSERT_TRUE(stored.opened) << "bit " << bit << ": " << stored.error;
        EXPECT_TRUE(stored.balanced) << "bit " << bit;
        EXPECT_EQ(invented(stored), 0U) << "bit " << bit;
        const std::size_t lost = truth.index.size() - stored.index.size();
        most_lost = std::max(most_lost, lost);
        if (lost > 0) { EXPECT_EQ(stored.end, FileEnd::damaged) << "bit " << bit; }
        if (stored.end == FileEnd::clean) { continue; }
        ++noticed;
        const std::string kept = folder.path("kept.pcapng");
        fs::remove(kept);
        ASSERT_TRUE(recover_capture(path, kept).ok());
        const Stored recovered = stored_in(kept);
        EXPECT_EQ(recovered.end, FileEnd::clean) << "bit " << bit;
        EXPECT_EQ(recovered.index, stored.index) << "bit " << bit;
        EXPECT_EQ(recovered.counts, stored.counts) << "bit " << bit;
    }
    std::printf("%d flipped bits, seed %u: %zu noticed, at most %zu samples lost\n", flips, seed, noticed,
                most_lost);
    EXPECT_GT(noticed, flips / 2U);
}

}  // namespace
}  // namespace gyrolog
