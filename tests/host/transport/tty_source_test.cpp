// A pseudo-terminal stands for the serial port: it has no DTR, and its other end is the board.
#include "host/transport/tty_source.hpp"

#include <chrono>
#include <cstdlib>
#include <memory>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <gyrolog_protocol/usb_identity.h>
#include <poll.h>
#include <pty.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "tests/support/collecting_sink.hpp"

namespace gyrolog {
namespace {

using test::CollectingSink;

class TtySourceTest : public ::testing::Test {
protected:
    void SetUp() override {
        board_ = posix_openpt(O_RDWR | O_NOCTTY);
        ASSERT_GE(board_, 0);
        ASSERT_EQ(grantpt(board_), 0);
        ASSERT_EQ(unlockpt(board_), 0);
        path_ = ptsname(board_);
        auto source = TtySource::open(path_);
        ASSERT_TRUE(source.ok()) << source.error().message;
        source_ = std::move(source).value();
    }
    void TearDown() override {
        source_.reset();
        hang_up();
    }

    void send(ByteView bytes) const {
        while (!bytes.empty()) {
            const ssize_t sent = ::write(board_, bytes.data(), bytes.size());
            ASSERT_GT(sent, 0);
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
        }
    }
    // What the board gets within 5 s, up to so many bytes.
    Bytes receive(std::size_t size) const {
        Bytes received(size);
        std::size_t got = 0;
        pollfd readable{board_, POLLIN, 0};
        while (got < size && poll(&readable, 1, 5000) > 0) {
            const ssize_t count = ::read(board_, received.data() + got, size - got);
            if (count <= 0) { break; }
            got += static_cast<std::size_t>(count);
        }
        received.resize(got);
        return received;
    }
    void hang_up() {
        if (board_ >= 0) { close(board_); }
        board_ = -1;
    }

    int board_ = -1;
    std::string path_;
    CollectingSink sink_;
    std::unique_ptr<TtySource> source_;
};

Bytes every_byte_many_times(std::size_t size) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i) { bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 256); }
    return bytes;
}

TEST_F(TtySourceTest, EveryByteValueArrivesUntouched) {
    ASSERT_TRUE(source_->start(sink_).ok());
    const Bytes sent = every_byte_many_times(100'000);
    send(sent);
    EXPECT_TRUE(sink_.wait_for_bytes(sent.size()));
    source_->stop();
    EXPECT_EQ(sink_.stream(), sent);
    EXPECT_EQ(sink_.end(), SourceEnd::stopped);
}

TEST_F(TtySourceTest, WhatWasWaitingBeforeTheStartIsTold) {
    send(as_bytes("stale"));
    ASSERT_TRUE(source_->start(sink_).ok());
    EXPECT_TRUE(sink_.wait_for_bytes(5));
    EXPECT_EQ(as_text(sink_.stream()), "stale");
}

// SPEC.md, 9.5.
TEST_F(TtySourceTest, StartWaitsUntilTheLineIsSilent) {
    using std::chrono::milliseconds;
    const auto begin = std::chrono::steady_clock::now();
    std::thread earlier([this] {
        for (int i = 0; i < 20; ++i) {
            send(as_bytes("stale"));
            std::this_thread::sleep_for(milliseconds(10));
        }
    });
    ASSERT_TRUE(source_->start(sink_).ok());
    const auto waited = std::chrono::steady_clock::now() - begin;
    const std::size_t told = sink_.stream().size();
    earlier.join();
    EXPECT_GE(waited, milliseconds(240));
    EXPECT_LT(waited, milliseconds(1500));
    EXPECT_EQ(told, 100U);
}

TEST_F(TtySourceTest, EachReadIsToldAsABulkTransfer) {
    ASSERT_TRUE(source_->start(sink_).ok());
    send(as_bytes("frame"));
    EXPECT_TRUE(sink_.wait_for_bytes(5));
    source_->stop();
    const auto told = sink_.told();
    ASSERT_GE(told.size(), 4U);
    EXPECT_EQ(told[0].transfer.event, Transfer::Event::submission);
    EXPECT_EQ(told[0].transfer.endpoint, line_endpoint_in);
    EXPECT_EQ(told[1].transfer.event, Transfer::Event::completion);
    EXPECT_EQ(told[1].transfer.id, told[0].transfer.id);
    EXPECT_EQ(told[1].transfer.status, 0);
    EXPECT_EQ(told.back().transfer.event, Transfer::Event::completion);
    EXPECT_EQ(told.back().transfer.status, -ENOENT) << "the read that was waiting is cancelled";
}

TEST_F(TtySourceTest, APortWithoutDtrSaysSo) {
    ASSERT_TRUE(source_->start(sink_).ok());
    EXPECT_EQ(source_->set_line_state(true).error().code, ErrorCode::unsupported);
}

TEST_F(TtySourceTest, CommandsReachTheBoardUntouched) {
    ASSERT_TRUE(source_->start(sink_).ok());
    const Bytes command = every_byte_many_times(1000);
    ASSERT_TRUE(source_->write(command).ok());
    EXPECT_EQ(receive(command.size()), command);
    source_->stop();
    std::size_t told_bytes = 0;
    for (const auto& one : sink_.told()) {
        const bool out = one.transfer.endpoint == line_endpoint_out;
        if (out && one.transfer.event == Transfer::Event::submission) { told_bytes += one.data.size(); }
    }
    EXPECT_EQ(told_bytes, command.size());
}

TEST_F(TtySourceTest, ACommandThatTheBoardDoesNotTakeTimesOutWhileTheStreamGoesOn) {
    ASSERT_TRUE(source_->start(sink_).ok());
    const Bytes too_much(1 << 20, 0x55);
    std::thread board([this] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        send(as_bytes("meanwhile"));
    });
    const Status written = source_->write(too_much);
    board.join();
    ASSERT_FALSE(written.ok());
    EXPECT_EQ(written.error().code, ErrorCode::timeout);
    EXPECT_EQ(as_text(sink_.stream()), "meanwhile");
}

TEST_F(TtySourceTest, AHangUpEndsTheStreamAsDeviceLost) {
    ASSERT_TRUE(source_->start(sink_).ok());
    send(as_bytes("last words"));
    EXPECT_TRUE(sink_.wait_for_bytes(10));
    hang_up();
    EXPECT_EQ(sink_.wait_for_end(), SourceEnd::device_lost);
    EXPECT_THAT(sink_.error_message(), ::testing::HasSubstr("hung up"));
    EXPECT_EQ(source_->write(as_bytes("x")).error().code, ErrorCode::device_lost);
    EXPECT_EQ(source_->set_line_state(true).error().code, ErrorCode::device_lost);
    source_->stop();
    source_->stop();
}

TEST_F(TtySourceTest, ASourceCanBeStartedAgain) {
    for (int round = 0; round < 3; ++round) {
        CollectingSink sink;
        ASSERT_TRUE(source_->start(sink).ok());
        send(as_bytes("again"));
        EXPECT_TRUE(sink.wait_for_bytes(5));
        source_->stop();
        EXPECT_EQ(sink.end(), SourceEnd::stopped);
    }
}

// A line with settings of its own: echo, whole lines, 9600 baud.
class TtySettings : public ::testing::Test {
protected:
    TtySettings() {
        EXPECT_EQ(openpty(&board_, &line_, nullptr, nullptr, nullptr), 0);
        path_ = ptsname(board_);
        found_ = now();
        found_.c_lflag |= static_cast<tcflag_t>(ECHO | ICANON | ISIG);
        found_.c_oflag |= static_cast<tcflag_t>(OPOST);
        cfsetispeed(&found_, B9600);
        cfsetospeed(&found_, B9600);
        EXPECT_EQ(tcsetattr(line_, TCSANOW, &found_), 0);
        found_ = now();
    }
    ~TtySettings() override {
        close(line_);
        close(board_);
    }
    termios now() const {
        termios settings{};
        EXPECT_EQ(tcgetattr(line_, &settings), 0);
        return settings;
    }
    bool is_raw() const {
        return (now().c_lflag & static_cast<tcflag_t>(ECHO | ICANON | ISIG)) == 0 &&
               (now().c_oflag & static_cast<tcflag_t>(OPOST)) == 0;
    }
    void expect_as_found() const {
        const termios settings = now();
        EXPECT_EQ(settings.c_iflag, found_.c_iflag);
        EXPECT_EQ(settings.c_oflag, found_.c_oflag);
        EXPECT_EQ(settings.c_cflag, found_.c_cflag);
        EXPECT_EQ(settings.c_lflag, found_.c_lflag);
        EXPECT_EQ(cfgetispeed(&settings), cfgetispeed(&found_));
        EXPECT_EQ(cfgetospeed(&settings), cfgetospeed(&found_));
    }

    int board_ = -1;
    int line_ = -1;
    std::string path_;
    termios found_{};
};

TEST_F(TtySettings, AreThoseOfARawLineAtTheSpeedThatWasAskedForAndPutBackAtTheEnd) {
    for (const auto& [speed, expected] :
         {std::pair{TtySpeed(921'600), speed_t{B921600}}, {TtySpeed(), speed_t{B9600}}}) {
        auto source = TtySource::open(path_, speed);
        ASSERT_TRUE(source.ok()) << source.error().message;
        EXPECT_EQ((*source)->identity().uri, "tty:" + path_ + (speed ? ",speed=921600" : ""));
        EXPECT_TRUE(is_raw());
        const termios settings = now();
        EXPECT_EQ(cfgetospeed(&settings), expected);
        EXPECT_EQ(cfgetispeed(&settings), expected);
        CollectingSink sink;
        ASSERT_TRUE((*source)->start(sink).ok());
        EXPECT_TRUE(is_raw());
        source->reset();
        expect_as_found();
    }
}

TEST_F(TtySettings, AreUntouchedByASpeedThatNoPortHas) {
    const auto source = TtySource::open(path_, 12'345U);
    ASSERT_FALSE(source.ok());
    EXPECT_EQ(source.error().code, ErrorCode::invalid_argument);
    EXPECT_THAT(source.error().message, ::testing::HasSubstr("12345 baud"));
    expect_as_found();
}

TEST_F(TtySettings, ArePutBackWhenTheBoardIsGivenUpAndTakenUpAgain) {
    auto source = TtySource::open(path_, 115'200U);
    ASSERT_TRUE(source.ok()) << source.error().message;
    ASSERT_TRUE((*source)->reconnect().ok());
    EXPECT_TRUE(is_raw());
    EXPECT_EQ((*source)->identity().uri, "tty:" + path_ + ",speed=115200");
    source->reset();
    expect_as_found();
}

TEST_F(TtySettings, ArePutBackForASignalThatEndsTheProgram) {
    auto source = TtySource::open(path_, 115'200U);
    ASSERT_TRUE(source.ok()) << source.error().message;
    EXPECT_TRUE(is_raw());
    restore_ports();
    expect_as_found();
    source->reset();
    restore_ports();  // of nothing
    expect_as_found();
}

TEST_F(TtySourceTest, ASecondReaderIsKeptOut) {
    ASSERT_EQ(chmod(path_.c_str(), 0666), 0);
    const bool is_root = geteuid() == 0;  // whom the kernel lets in all the same
    if (is_root) { ASSERT_EQ(seteuid(65534), 0); }
    const auto second = TtySource::open(path_);
    if (is_root) { ASSERT_EQ(seteuid(0), 0); }
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().code, ErrorCode::busy);
}

TEST(TtySource, AMissingPortAndAPlainFileAreToldApart) {
    EXPECT_EQ(TtySource::open("/dev/tty-that-is-not-there").error().code, ErrorCode::not_found);
    EXPECT_EQ(TtySource::open("/dev/null").error().code, ErrorCode::invalid_argument);
}

TEST_F(TtySourceTest, APortThatHungUpIsOpenedAgainOnceItIsThere) {
    // A name that outlives the port, as /dev/serial/by-id has it.
    const std::string name = testing::TempDir() + "gyrolog_port_" + std::to_string(getpid());
    ASSERT_EQ(symlink(path_.c_str(), name.c_str()), 0);
    source_.reset();
    auto opened = TtySource::open(name);
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    source_ = std::move(opened).value();
    ASSERT_TRUE(source_->start(sink_).ok());
    hang_up();
    EXPECT_EQ(sink_.wait_for_end(), SourceEnd::device_lost);
    source_->stop();
    unlink(name.c_str());
    EXPECT_EQ(source_->reconnect().error().code, ErrorCode::not_found);
    CollectingSink early;
    EXPECT_FALSE(source_->start(early).ok());

    board_ = posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_EQ(grantpt(board_), 0);
    ASSERT_EQ(unlockpt(board_), 0);
    ASSERT_EQ(symlink(ptsname(board_), name.c_str()), 0);
    const Status back = source_->reconnect();
    ASSERT_TRUE(back.ok()) << back.error().message;
    CollectingSink sink;
    ASSERT_TRUE(source_->start(sink).ok());
    const Bytes sent = every_byte_many_times(1000);
    send(sent);
    EXPECT_TRUE(sink.wait_for_bytes(sent.size()));
    EXPECT_EQ(sink.stream(), sent);
    source_->stop();
    unlink(name.c_str());
}

}  // namespace
}  // namespace gyrolog
