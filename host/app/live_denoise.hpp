// A capture denoised while it runs: what `gyrolog denoise` would write of it, as it comes.
//
// The samples are handed over on the capture's writer thread, which is not kept waiting, and are denoised and
// written on a thread of its own. The first of them are kept until the gyros' noise is known, and then go
// the same way: the text begins with the capture's first sample.
//
// The rate, and with it the time column, is what the stamps of that first part say. The pause before a board
// that was reset or plugged in again is what the clocks say at its first frame; `denoise` knows it by later
// ones, too.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "analysis/denoise/axis_denoiser.hpp"
#include "host/app/denoise_choice.hpp"
#include "host/base/result.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/session/capture_session.hpp"

namespace gyrolog {

struct LiveDenoiseOptions {
    DenoiseChoice choice{.method = "", .rate_model = {}, .bandwidth_hz = {}};  // no method: not wanted
    std::string output;                                                        // empty: after the capture
    std::string model;                                                         // empty: learned at rest

    bool wanted() const { return !choice.method.empty(); }
    void declare(CLI::App& app);
    // Options that mean nothing without --denoise, or contradict each other. `rate_hz` as asked of the board.
    Status check(std::optional<double> rate_hz) const;
    std::string output_of(const std::string& capture_path) const;
};

// The standard deviation of the last five seconds.
class RecentSpread {
public:
    explicit RecentSpread(double rate_hz);
    void take(double value);
    double sd() const;

private:
    struct Sums {
        double count = 0.0;
        double sum = 0.0;  // of the distances from the first value
        double squares = 0.0;
    };
    std::array<Sums, 5> seconds_{};
    std::size_t present_ = 0;
    double second_samples_;
    std::optional<double> origin_;
};

class LiveDenoise final : public SampleObserver {
public:
    struct Setup {
        LiveDenoiseOptions options;
        std::string output;
        std::string capture;  // its path, for what is said
        bool overwrite = false;
        // Whether the source loses nothing when it is kept waiting. From one that would, samples beyond so
        // many rows that wait to be denoised are left out of the text, and told.
        bool source_waits = false;
        std::size_t rows_waiting_most = 10'000'000;
    };
    // Errors: the file is there already or cannot be made, the model cannot be read.
    static Result<std::unique_ptr<LiveDenoise>> create(Setup setup);
    explicit LiveDenoise(Setup setup);
    ~LiveDenoise() override;
    LiveDenoise(const LiveDenoise&) = delete;
    LiveDenoise& operator=(const LiveDenoise&) = delete;

    // On the capture's writer thread.
    void on_decoder(const StreamDecoder& decoder) override { decoder_ = &decoder; }
    void on_start() override;
    void on_samples(const glp_frame& frame, const glp_samples& samples, const glp_config& config) override;

    // From any thread: what is to be said since the last call; and how it goes, in one line.
    std::vector<std::string> take_notices();
    std::string line() const;
    // What is asked of whoever holds the board, before the capture.
    std::string announcement() const;

    // After the capture: all that came is denoised and the file closed. The sentence that sums up, or why
    // there is nothing, or not all of it.
    Result<std::string> finish();

private:
    // Samples on their way: rows with their places on the grid of sampling instants.
    struct Batch {
        Recording rows;
        std::optional<double> rate_hz;  // once it is known
        bool begins_anew = false;
        bool last = false;
    };
    struct Spread {
        std::string axis;
        double before = 0.0;  // rad/s
        double after = 0.0;
    };

    void begin(const glp_samples& samples, const glp_config& config);
    void stop(std::string why);
    std::int64_t place(const glp_samples& samples) const;
    void append(const glp_samples& samples, std::int64_t index);
    bool wait_for_room(std::unique_lock<std::mutex>& lock, std::size_t samples);

    void run();
    Batch next_batch();
    Status take(Batch batch);
    Status try_to_start(bool last);
    Result<std::optional<TimeSpan>> find_rest(bool last);
    Status start(std::vector<AxisKnowledge> knowledge, const std::string& learned_from);
    Status denoise_rows(const Recording& rows);
    Status flush_now_and_then();
    void fail(const Error& error);
    void say(std::string text);

    const Setup setup_;
    const StreamDecoder* decoder_ = nullptr;

    mutable std::mutex mutex_;
    std::condition_variable more_;
    std::condition_variable room_;
    // Guarded by the mutex; the writer thread's side of the hand-over.
    Batch pending_;
    std::optional<glp_config> config_;
    std::uint8_t layout_ = 0;
    std::optional<double> rate_hz_;
    std::uint64_t samples_seen_ = 0;
    std::uint64_t samples_dropped_ = 0;
    std::uint32_t run_ = 0;
    std::uint64_t run_first_ = 0;  // index in the run at grid index run_grid_
    std::int64_t run_grid_ = 0;
    std::int64_t grid_end_ = 0;
    bool ended_ = false;
    std::optional<Error> failed_;   // nothing is denoised any further
    std::optional<Error> stopped_;  // what came before is denoised still
    std::vector<std::string> notices_;
    std::string design_text_;  // empty until it denoises
    double lag_s_ = 0.0;
    std::vector<Spread> spreads_;

    // The denoising thread's own.
    std::unique_ptr<RecordingCsvWriter> writer_;
    Recording gathered_;
    std::size_t next_look_ = 0;  // in rows
    bool said_moving_ = false;
    std::vector<AxisDenoiser> denoisers_;
    std::vector<RecentSpread> before_;
    std::vector<RecentSpread> after_;
    std::string again_;  // options by which `denoise` gives the same afterwards
    std::uint64_t rows_written_ = 0;
    std::int64_t last_flush_ns_ = 0;

    std::thread thread_;  // last: starts when everything else is there
};

}  // namespace gyrolog
