// The board's own accounts of each time the host let it stream: what a capture is compared with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/base/result.hpp"
#include "host/virtual_board/virtual_board.hpp"

namespace gyrolog {

// From the stream's start to its stop, or to the moment the board was unplugged.
struct StreamingSession {
    std::uint64_t samples = 0;  // sampled and kept
    std::uint64_t samples_lost = 0;
    std::uint64_t frames_lost = 0;
};

class SessionLog {
public:
    // Looks at the board; to be called after anything that may have started or stopped it.
    void observe(const VirtualBoard& board) { observe(board.firmware()); }
    void observe(const glp_board& firmware);

    // In order of time; the last one may still go on.
    const std::vector<StreamingSession>& sessions() const { return sessions_; }

private:
    bool streaming_ = false;
    std::uint64_t instants_ = 0;
    std::vector<StreamingSession> sessions_;
};

// {"schema": "gyrolog-board-report/1", "serial": "S1", "sessions": [{"samples": 30012, "samples_lost": 0,
// ...}]}
Status write_report(const std::string& path, const std::string& serial,
                    const std::vector<StreamingSession>& sessions);

}  // namespace gyrolog
