// What a capture promises: served in place of the board to the same program, it gives the same stream.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "host/capture/capture_writer.hpp"
#include "host/transport/usb_source.hpp"
#include "tests/host/transport/replayed_session.hpp"
#include "tests/support/collecting_sink.hpp"
#include "tests/support/needs.hpp"
#include "tests/support/umockdev_virtual_board.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;
using test::CollectingSink;

class UsbReplayTest : public ::testing::Test {
protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "gyrolog-replay-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        directory_ = pattern;
    }
    void TearDown() override { fs::remove_all(directory_); }

    fs::path directory_;
};

Bytes read_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_capture(const fs::path& path, const SourceIdentity& identity, const CollectingSink& sink) {
    auto file = create_append_file(path.string(), IfExists::refuse);
    ASSERT_TRUE(file.ok()) << file.error().message;
    auto writer = CaptureWriter::create(std::move(file).value(), identity, host_now());
    ASSERT_TRUE(writer.ok()) << writer.error().message;
    for (const CollectingSink::Told& one : sink.told()) {
        Transfer transfer = one.transfer;
        transfer.data = one.data;
        ASSERT_TRUE(writer->append(transfer).ok());
    }
    ASSERT_TRUE(writer->close().ok());
}

// Streams from the virtual board for a while, as a capture session would.
void capture_a_while(UsbSource& source, CollectingSink& sink) {
    ASSERT_TRUE(source.start(sink).ok());
    ASSERT_TRUE(source.write(test::command_before_the_stream).ok());
    ASSERT_TRUE(source.set_line_state(true).ok());
    std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    ASSERT_TRUE(source.set_line_state(false).ok());
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    source.stop();
    ASSERT_EQ(sink.end(), SourceEnd::stopped);
}

// The stream's bytes that came before DTR was lowered for the last time.
std::size_t bytes_before_last_control(const CollectingSink& sink) {
    std::size_t bytes = 0;
    std::size_t before = 0;
    for (const CollectingSink::Told& one : sink.told()) {
        if (one.transfer.carries_stream()) { bytes += one.data.size(); }
        if (one.transfer.kind == TransferKind::control && one.transfer.event == Transfer::Event::submission) {
            before = bytes;
        }
    }
    return before;
}

TEST_F(UsbReplayTest, ACaptureServedInPlaceOfTheBoardGivesTheSameStream) {
    const fs::path capture = directory_ / "capture.pcapng";
    const test::MockUsbIdentity identity = test::VirtualBoardOnMock::identity("SIM0001");
    CollectingSink sink;
    {
        test::UmockdevBus bus;
        if (!bus.in_force()) { GTEST_SKIP() << needs_umockdev_wrapper; }
        VirtualBoardOptions options;
        options.rate_hz = 1000.0;
        auto board = VirtualBoard::create(options);
        ASSERT_TRUE(board.ok()) << board.error().message;
        test::VirtualBoardOnMock function(**board);
        const test::UmockdevBoard plugged_in(bus, identity, function);
        auto usb = UsbContext::create();
        ASSERT_TRUE(usb.ok()) << usb.error().message;
        auto source = UsbSource::open(std::move(usb).value(), "SIM0001", test::recording_plan);
        ASSERT_TRUE(source.ok()) << source.error().message;
        ASSERT_NO_FATAL_FAILURE(capture_a_while(**source, sink));
        ASSERT_NO_FATAL_FAILURE(write_capture(capture, (*source)->identity(), sink));
    }
    const Bytes recorded = sink.stream();
    ASSERT_GT(recorded.size(), 10'000U);

    const fs::path description = directory_ / "board.umockdev";
    std::ofstream(description) << identity.description();
    const fs::path replayed = directory_ / "stream";
    const fs::path log = directory_ / "log";
    // The replay has a testbed of its own.
    const std::string command =
        "env -u LD_PRELOAD -u UMOCKDEV_DIR timeout 60 " UMOCKDEV_RUN " --device=" + description.string() +
        " --pcap=/sys" + identity.sysfs_path() + "=" + capture.string() + " -- " USB_STREAM_READER " " +
        replayed.string() + " " + std::to_string(bytes_before_last_control(sink)) + " " +
        std::to_string(recorded.size()) + " > " + log.string() + " 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << command << "\n" << as_text(read_file(log)).substr(0, 2000);
    EXPECT_EQ(read_file(replayed), recorded);
}

}  // namespace
}  // namespace gyrolog
