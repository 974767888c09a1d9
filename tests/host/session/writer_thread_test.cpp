// The writer's thread by itself, with transfers that come and publications that happen when the test wants.

#include "host/session/writer_thread.hpp"

#include <chrono>

#include <gtest/gtest.h>

#include "host/capture/append_file.hpp"
#include "host/capture/segment_writer.hpp"
#include "host/session/load_capture.hpp"
#include "tests/host/decode/made_stream.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

class AWriterThread : public testing::Test {
protected:
    // One transfer of a source that waits.
    void comes(const Bytes& wire) {
        Transfer transfer;
        transfer.endpoint = 0x81;
        transfer.time = board_.now();
        transfer.data = wire;
        ASSERT_TRUE(sink_.on_transfer(transfer));
    }
    void samples_come(int frames) {
        for (int i = 0; i < frames; ++i) { comes(board_.samples_frame(0, frame_samples)); }
    }

    static constexpr std::uint8_t frame_samples = 20;
    TemporaryFolder folder_;
    CaptureRequest request_;
    MadeBoard board_;
    TransferQueue queue_{std::size_t{1} << 20U};
    QueueingSink sink_{queue_, true};
};

// The board's clock is ahead: what is enough by the nominal rate, the only one that is known while the first
// transfers are taken, is too little by the one that is published behind them.
TEST_F(AWriterThread, LeavesAllThatComesBehindTheEndOfAReplay) {
    board_.rate_hz = 1003.0;
    request_.duration_s = 1.0;
    request_.path = folder_.path("second.pcapng");
    SegmentPlan plan;
    plan.path = request_.path;
    auto file = SegmentWriter::create(plan, SourceIdentity{}, computers_disk());
    ASSERT_TRUE(file.ok());
    comes(board_.hello_frame());
    comes(board_.config_frame());
    comes(board_.samples_frame(glp_flag_first_after_start, frame_samples));
    samples_come(60);  // more than the 50 frames of a second, all before the thread begins
    WriterThread writer(queue_, sink_, *file, request_);
    ASSERT_TRUE(writer.wait(std::chrono::seconds(20),
                            [](const WriterThread::State& state) { return state.has_config; }));
    EXPECT_GT(*writer.progress().rate_hz, 1002.0);
    EXPECT_TRUE(writer.state().enough) << "once enough, always enough";
    samples_come(20);
    queue_.close();
    writer.join();
    ASSERT_TRUE(file->close().ok());
    EXPECT_EQ(writer.link().samples.good, 1000U);
    EXPECT_EQ(writer.link().samples.missing, 0U);
    const auto stored = load_capture(request_.path, false);
    ASSERT_TRUE(stored.ok());
    EXPECT_EQ(stored->decoder->report().samples.good, 1000U);
    EXPECT_TRUE(stored->decoder->report().dropouts.empty());
}

}  // namespace
}  // namespace gyrolog
