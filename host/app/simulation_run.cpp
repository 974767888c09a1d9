#include "host/app/simulation_run.hpp"

#include "host/app/progress_line.hpp"
#include "host/app/stop_signal.hpp"
#include "host/base/counted.hpp"
#include "host/formats/recording_csv.hpp"

namespace gyrolog {
namespace {

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

CsvWriteOptions format_of(const RecordingSimulator& simulator) {
    CsvWriteOptions options;
    options.resolved = simulator.simulated_columns();
    return options;
}

}  // namespace

double text_bytes_of(const SensorModel& model, const SimulationRequest& request) {
    RecordingSimulator simulator(model, request);
    Recording piece;
    bool more = simulator.next(piece);
    while (more && piece.rows() == 0) { more = simulator.next(piece); }
    if (!more) { return 0.0; }
    const double bytes = csv_row_bytes(piece, format_of(simulator)) * static_cast<double>(piece.rows());
    return bytes * static_cast<double>(simulator.samples()) / static_cast<double>(simulator.samples_done());
}

Result<SimulationOutcome> simulate_to_text(Console& console, const SensorModel& model,
                                           const SimulationRequest& request, const std::string& path) {
    RecordingSimulator simulator(model, request);
    GYROLOG_TRY(RecordingCsvWriter file, RecordingCsvWriter::create(path, format_of(simulator)));
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
            progress.show("simulating", static_cast<double>(simulator.samples_done()) /
                                            static_cast<double>(simulator.samples()));
            outcome.interrupted = console.stop_wanted() && simulator.samples_done() < simulator.samples();
        }
    }
    GYROLOG_CHECK(file.close());
    outcome.instants = simulator.samples_done();
    outcome.dropouts = holes.holes();
    return outcome;
}

}  // namespace gyrolog
