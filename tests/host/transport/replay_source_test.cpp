// A stored capture plays like a device, bit for bit.
#include "host/transport/replay_source.hpp"

#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "tests/host/capture/made_capture.hpp"

namespace gyrolog {
namespace {

// Has room for every `patience`-th offer only.
class FussySink final : public TransferSink {
public:
    explicit FussySink(int patience) : patience_(patience) {}

    bool on_transfer(const Transfer& transfer) override {
        ++offers_;
        if (offers_ % patience_ != 0) { return false; }
        taken_.emplace_back(transfer);
        return true;
    }
    void on_end(SourceEnd end, const std::optional<Error>& /*error*/) override {
        const std::lock_guard lock(mutex_);
        ++ends_;
        end_ = end;
        ended_.notify_all();
    }
    SourceEnd wait() {
        std::unique_lock lock(mutex_);
        ended_.wait(lock, [&] { return end_.has_value(); });
        return *end_;
    }
    // After wait().
    const std::vector<KeptTransfer>& taken() const { return taken_; }
    int ends() const { return ends_; }

private:
    const int patience_;
    int offers_ = 0;
    std::vector<KeptTransfer> taken_;
    std::mutex mutex_;
    std::condition_variable ended_;
    std::optional<SourceEnd> end_;
    int ends_ = 0;
};

class ReplaySourceTest : public testing::Test {
protected:
    ReplaySourceTest() {
        std::string name = (std::filesystem::temp_directory_path() / "gyrolog-replay-XXXXXX").string();
        folder_ = mkdtemp(name.data());
        path_ = folder_ / "made.pcapng";
        std::ofstream(path_, std::ios::binary) << as_text(made_.bytes);
    }
    ~ReplaySourceTest() override { std::filesystem::remove_all(folder_); }

    const MadeCapture made_ = make_capture(200, 600);
    std::filesystem::path folder_;
    std::string path_;
};

TEST_F(ReplaySourceTest, PlaysEveryTransferBitForBitToASinkThatIsOftenFull) {
    for (const int patience : {1, 3}) {
        auto source = ReplaySource::open(path_);
        ASSERT_TRUE(source.ok());
        EXPECT_TRUE((*source)->can_wait());
        FussySink sink(patience);
        ASSERT_TRUE((*source)->start(sink).ok());
        EXPECT_EQ(sink.wait(), SourceEnd::exhausted);
        (*source)->stop();
        EXPECT_EQ(sink.ends(), 1);
        EXPECT_EQ(sink.taken(), made_.transfers);
    }
}

TEST_F(ReplaySourceTest, AReplayOfAReplayIsTheSameFile) {
    auto source = ReplaySource::open(path_);
    ASSERT_TRUE(source.ok());
    FussySink sink(1);
    ASSERT_TRUE((*source)->start(sink).ok());
    sink.wait();
    FakeDisk disk;
    auto writer = CaptureWriter::create(disk.open(), (*source)->identity(), made_start);
    ASSERT_TRUE(writer.ok());
    for (const KeptTransfer& kept : sink.taken()) { ASSERT_TRUE(writer->append(kept.view()).ok()); }
    ASSERT_TRUE(writer->sync().ok());
    const auto again = read_capture(disk.contents);
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(again->transfers, made_.transfers);
}

TEST_F(ReplaySourceTest, StopsInTheMiddleWhenTold) {
    auto source = ReplaySource::open(path_);
    ASSERT_TRUE(source.ok());
    FussySink sink(1'000'000'000);
    ASSERT_TRUE((*source)->start(sink).ok());
    (*source)->stop();
    EXPECT_EQ(sink.wait(), SourceEnd::stopped);
    EXPECT_EQ(sink.ends(), 1);
    EXPECT_FALSE((*source)->start(sink).ok());
}

TEST_F(ReplaySourceTest, StandsForTheCapturedBoardAndObeysNoOne) {
    auto source = ReplaySource::open(path_);
    ASSERT_TRUE(source.ok());
    EXPECT_EQ((*source)->identity().uri, "replay:" + path_);
    EXPECT_EQ((*source)->identity().serial, "S1");
    EXPECT_EQ((*source)->write({}).error().code, ErrorCode::unsupported);
    EXPECT_EQ((*source)->set_line_state(true).error().code, ErrorCode::unsupported);
    EXPECT_EQ(ReplaySource::open(path_ + "x").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace gyrolog
