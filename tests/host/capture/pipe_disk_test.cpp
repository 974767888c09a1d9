#include "host/capture/pipe_disk.hpp"

#include <csignal>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

const Bytes some{1, 2, 3};

// The read end, opened without waiting for a writer.
int reader_of(const std::string& path) { return ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC); }

TEST(PipeDisk, HoldsOneFileWhoseBytesComeAtOnce) {
    const TemporaryFolder folder;
    const std::string path = folder.path("pipe");
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    const int reader = reader_of(path);
    auto disk = PipeDisk::open(path);
    ASSERT_TRUE(disk.ok()) << disk.error().message;
    auto file = (*disk)->create(path, IfExists::refuse);
    ASSERT_TRUE(file.ok());
    EXPECT_EQ((*disk)->create(path, IfExists::replace).error().code, ErrorCode::storage_failed);
    EXPECT_EQ((*file)->write(some).value(), some.size());
    Bytes came(8);
    ASSERT_EQ(::read(reader, came.data(), came.size()), 3);
    EXPECT_EQ(Bytes(came.begin(), came.begin() + 3), some);
    EXPECT_TRUE((*file)->sync().ok());
    EXPECT_TRUE((*file)->close().ok());
    EXPECT_EQ(::read(reader, came.data(), came.size()), 0) << "the reader sees the end";
    ::close(reader);
}

TEST(PipeDisk, TellsWhenItsReaderHasLeft) {
    static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
    const TemporaryFolder folder;
    const std::string path = folder.path("pipe");
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    const int reader = reader_of(path);
    auto disk = PipeDisk::open(path);
    ASSERT_TRUE(disk.ok());
    auto file = (*disk)->create(path, IfExists::refuse);
    ASSERT_TRUE(file.ok());
    EXPECT_FALSE((*disk)->is_left());
    ::close(reader);
    EXPECT_EQ((*file)->write(some).error().code, ErrorCode::storage_failed);
    EXPECT_TRUE((*disk)->is_left());
}

TEST(PipeDisk, IsNoFileAndNothing) {
    const TemporaryFolder folder;
    EXPECT_EQ(PipeDisk::open(folder.path("none")).error().code, ErrorCode::not_found);
    std::ofstream(folder.path("file")) << "text";
    const Error refused = PipeDisk::open(folder.path("file")).error();
    EXPECT_EQ(refused.code, ErrorCode::unsupported);
    EXPECT_NE(refused.message.find("mkfifo"), std::string::npos);
    EXPECT_EQ(read_whole_file(folder.path("file")), "text");
}

}  // namespace
}  // namespace gyrolog
