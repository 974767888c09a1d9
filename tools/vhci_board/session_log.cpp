#include "tools/vhci_board/session_log.hpp"

#include <nlohmann/json.hpp>

#include "host/base/file_output.hpp"

namespace gyrolog {

// The firmware counts from each start and keeps the counts after a stop. A start that follows a stop between
// two looks (a CONFIGURE restarts the stream) shows by instants that count from 0 again.
void SessionLog::observe(const glp_board& firmware) {
    const std::uint64_t instants = VirtualBoard::sampling_instants_of(firmware);
    const bool restarted = streaming_ && instants < instants_;
    if (firmware.streaming && (!streaming_ || restarted)) { sessions_.emplace_back(); }
    if (!sessions_.empty() && (firmware.streaming || (streaming_ && !restarted))) {
        sessions_.back() = {instants - firmware.lost_samples, firmware.lost_samples, firmware.lost_frames};
    }
    streaming_ = firmware.streaming;
    instants_ = instants;
}

Status write_report(const std::string& path, const std::string& serial,
                    const std::vector<StreamingSession>& sessions) {
    nlohmann::ordered_json report = {{"schema", "gyrolog-board-report/1"}, {"serial", serial}};
    report["sessions"] = nlohmann::ordered_json::array();
    for (const StreamingSession& session : sessions) {
        report["sessions"].push_back({{"samples", session.samples},
                                      {"samples_lost", session.samples_lost},
                                      {"frames_lost", session.frames_lost}});
    }
    return write_file(path, as_bytes(report.dump(2) + "\n"));
}

}  // namespace gyrolog
