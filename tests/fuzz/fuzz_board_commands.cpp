// Any bytes from the host, between samples and DTR edges: the board's accounts hold, and all it sends are
// whole frames.

#include <algorithm>
#include <cstdint>

#include "require.hpp"
#include "tests/firmware_protocol/bench_board.hpp"

namespace {

using gyrolog::BenchBoard;
using gyrolog::ReceivedFrame;

struct Accounts {
    std::uint64_t delivered = 0;

    void take(const std::vector<ReceivedFrame>& frames) {
        for (const ReceivedFrame& frame : frames) {
            if (frame.type != glp_frame_samples) { continue; }
            const glp_samples samples = frame.samples();
            GYROLOG_REQUIRE(samples.count > 0);
            if ((frame.flags & glp_flag_first_after_start) != 0) { delivered = 0; }
            GYROLOG_REQUIRE(delivered + samples.lost_samples == samples.first_index);
            delivered += samples.count;
        }
    }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    Accounts accounts;
    for (std::size_t at = 0; at < size;) {
        const std::size_t piece = std::min<std::size_t>(size - at, 1U + data[at] % 64U);
        glp_board_on_receive(&bench.board, data + at, piece);
        at += piece;
        bench.run(data[at - 1] % 8U);
        if (data[at - 1] == 0xA5) { bench.sensor.fifo_reads_to_fail = 1; }
        if (data[at - 1] == 0x5A) { glp_board_on_line_state(&bench.board, !bench.board.dtr); }
        GYROLOG_REQUIRE(bench.board.frame_samples < bench.board.config.samples_per_frame);
        accounts.take(bench.take_frames());
    }
    GYROLOG_REQUIRE(bench.stream().bytes_skipped == 0);
    return 0;
}
