#include "host/app/simulation_run.hpp"

#include <chrono>

#include <fmt/format.h>

#include "host/app/quantity.hpp"
#include "host/app/stop_signal.hpp"
#include "host/base/counted.hpp"
#include "host/formats/recording_csv.hpp"

namespace gyrolog {
namespace {

using Clock = std::chrono::steady_clock;

// One line, redrawn ten times a second where the console has progress.
class ProgressLine {
public:
    explicit ProgressLine(Console& console) : console_(console) {}
    ~ProgressLine() {
        if (drawn_) { console_.err << '\n' << std::flush; }
    }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const RecordingSimulator& simulator) {
        if (!console_.progress) { return; }
        const bool last = simulator.samples_done() == simulator.samples();
        const auto now = Clock::now();
        if (!last && now - shown_ < std::chrono::milliseconds(100)) { return; }
        shown_ = now;
        const auto done = static_cast<double>(simulator.samples_done());
        const auto all = static_cast<double>(simulator.samples());
        console_.drawing() << fmt::format("\r\x1b[K  {} of {}  {} samples  {:.0f} %",
                                          format_elapsed(done / simulator.rate_hz()),
                                          format_elapsed(all / simulator.rate_hz()),
                                          format_count(simulator.samples_done()), 100.0 * done / all)
                           << std::flush;
        drawn_ = true;
    }

private:
    Console& console_;
    Clock::time_point shown_{};
    bool drawn_ = false;
};

class HoleCount {
public:
    void see(const Recording& piece) {
        for (const Segment& segment : piece.segments) {
            if (next_ && segment.first_index > *next_) { ++holes_; }
            next_ = segment.first_index + static_cast<std::int64_t>(segment.count);
        }
    }
    std::uint64_t holes() const { return holes_; }

private:
    std::optional<std::int64_t> next_;
    std::uint64_t holes_ = 0;
};

}  // namespace

Result<SimulationOutcome> simulate_to_text(Console& console, const SensorModel& model,
                                           const SimulationRequest& request, const std::string& path) {
    RecordingSimulator simulator(model, request);
    CsvWriteOptions options;
    options.resolved = simulator.simulated_columns();
    GYROLOG_TRY(RecordingCsvWriter file, RecordingCsvWriter::create(path, options));
    SimulationOutcome outcome;
    outcome.rate_hz = simulator.rate_hz();
    HoleCount holes;
    Recording piece;
    {
        ProgressLine progress(console);
        const TidyEnd tidy;
        while (!outcome.interrupted && simulator.next(piece)) {
            GYROLOG_CHECK(file.append(piece));
            holes.see(piece);
            outcome.samples += piece.rows();
            progress.show(simulator);
            outcome.interrupted = console.stop_wanted() && simulator.samples_done() < simulator.samples();
        }
    }
    GYROLOG_CHECK(file.close());
    outcome.instants = simulator.samples_done();
    outcome.dropouts = holes.holes();
    return outcome;
}

}  // namespace gyrolog
