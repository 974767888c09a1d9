#include "host/base/file_output.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/base/replacing_file.hpp"
#include "host/base/unfinished_files.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;

class FileOutput : public testing::Test {
protected:
    FileOutput() : folder_(fs::temp_directory_path() / ("gyrolog_file_output_" + std::to_string(getpid()))) {
        fs::create_directories(folder_);
    }
    ~FileOutput() override { fs::remove_all(folder_); }

    std::string path(const char* name) const { return (folder_ / name).string(); }
    static std::string contents(const std::string& path) {
        std::ostringstream text;
        text << std::ifstream(path).rdbuf();
        return text.str();
    }

    fs::path folder_;
};

TEST_F(FileOutput, ReplacesWhatWasThere) {
    ASSERT_TRUE(write_file(path("a"), as_bytes("first, and longer")).ok());
    ASSERT_TRUE(write_file(path("a"), as_bytes("second")).ok());
    EXPECT_EQ(contents(path("a")), "second");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1)
        << "a part file stayed";
}

// Its link in /dev is the system's, and what was written before stays.
TEST_F(FileOutput, GoesOnInADescriptorThatAPathStandsFor) {
    EXPECT_EQ(own_descriptor("/dev/stdout"), STDOUT_FILENO);
    EXPECT_EQ(own_descriptor("/dev/fd/2"), STDERR_FILENO);
    EXPECT_EQ(own_descriptor(path("a")), std::nullopt);
    const int open_file = ::open(path("a").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    ASSERT_GE(open_file, 0);
    ASSERT_EQ(::write(open_file, "one ", 4), 4);
    const std::string name = "/dev/fd/" + std::to_string(open_file);
    fs::create_symlink(name, path("link"));
    ASSERT_TRUE(write_file(name, as_bytes("two ")).ok());
    ASSERT_TRUE(write_file(path("link"), as_bytes("three")).ok());
    ::close(open_file);
    EXPECT_EQ(contents(path("a")), "one two three");
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_EQ(own_descriptor(path("link")), open_file) << "a descriptor that is closed is still no file";
    EXPECT_FALSE(write_file(path("link"), as_bytes("x")).ok());
}

TEST_F(FileOutput, NamesAMissingFolder) {
    const Status status = write_file(path("no/such/folder/a"), as_bytes("x"));
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::not_found);
    EXPECT_NE(status.error().message.find("no/such/folder/a"), std::string::npos);
}

TEST_F(FileOutput, AFullDiskLeavesTheOldContents) {
    if (!has_full_disk()) { GTEST_SKIP() << needs_full_disk; }
    const Status status = write_file("/dev/full", as_bytes("x"));
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::disk_full);
    EXPECT_TRUE(fs::exists("/dev/full"));
}

TEST_F(FileOutput, KeepsTheModeOfWhatWasThere) {
    std::ofstream(path("a")) << "first";
    ASSERT_EQ(chmod(path("a").c_str(), 0640), 0);
    ASSERT_TRUE(write_file(path("a"), as_bytes("second")).ok());
    struct stat there {};
    ASSERT_EQ(stat(path("a").c_str(), &there), 0);
    EXPECT_EQ(there.st_mode & 0777U, 0640U);
}

TEST_F(FileOutput, OfANewFileHasTheModeThatTheUserWants) {
    const mode_t before = umask(027);
    const Status written = write_file(path("a"), as_bytes("x"));
    umask(before);
    ASSERT_TRUE(written.ok());
    struct stat there {};
    ASSERT_EQ(stat(path("a").c_str(), &there), 0);
    EXPECT_EQ(there.st_mode & 0777U, 0640U);
}

TEST_F(FileOutput, KeepsTheOwnerOfWhatWasThere) {
    if (geteuid() != 0) { GTEST_SKIP() << "needs root, who can give files away"; }
    std::ofstream(path("a")) << "first";
    ASSERT_EQ(chown(path("a").c_str(), 65534, 65534), 0);
    ASSERT_TRUE(write_file(path("a"), as_bytes("second")).ok());
    struct stat there {};
    ASSERT_EQ(stat(path("a").c_str(), &there), 0);
    EXPECT_EQ(there.st_uid, 65534U);
    EXPECT_EQ(there.st_gid, 65534U);
}

// Of a file that only its owner may read, by somebody else in a folder that both may write.
TEST_F(FileOutput, IsNoMoreReadableThanWhatWasThere) {
    if (geteuid() != 0) { GTEST_SKIP() << "needs root, who can become somebody else"; }
    for (const auto& [before, after] :
         {std::pair{0600U, 0600U}, std::pair{0640U, 0600U}, std::pair{0664U, 0644U}}) {
        std::ofstream(path("a")) << "first";
        ASSERT_EQ(chown(path("a").c_str(), 65534, 0), 0);
        ASSERT_EQ(chmod(path("a").c_str(), before), 0);
        ASSERT_EQ(chmod(fs::path(path("a")).parent_path().c_str(), 0777), 0);
        const pid_t child = fork();
        if (child == 0) {
            const bool other = setgroups(0, nullptr) == 0 && setgid(65534) == 0 && setuid(65534) == 0;
            _exit(other && write_file(path("a"), as_bytes("second")).ok() ? 0 : 1);
        }
        int status = 1;
        waitpid(child, &status, 0);
        ASSERT_EQ(status, 0);
        struct stat there {};
        ASSERT_EQ(stat(path("a").c_str(), &there), 0);
        EXPECT_EQ(there.st_mode & 0777U, after) << std::oct << before;
        fs::remove(path("a"));
    }
}

TEST_F(FileOutput, ReplacesALinkAndLeavesWhatItShowedTo) {
    std::ofstream(path("target")) << "precious";
    fs::create_symlink(path("target"), path("a"));
    ASSERT_TRUE(write_file(path("a"), as_bytes("x")).ok());
    EXPECT_FALSE(fs::is_symlink(path("a")));
    EXPECT_EQ(contents(path("target")), "precious");
}

TEST_F(FileOutput, OfALongNameIsWrittenToo) {
    const std::string name(250, 'n');
    ASSERT_TRUE(write_file(path(name.c_str()), as_bytes("x")).ok());
    EXPECT_EQ(contents(path(name.c_str())), "x");
}

// The process ends at each step of writing, as a crash or a full power cut ends it: the old contents or the
// new, never less. What a signal that is caught leaves is nothing but that.
TEST_F(FileOutput, KilledAtAnyStepLeavesTheOldOrTheNew) {
    const std::string old_contents(100'000, 'o');
    const std::string new_contents(200'000, 'n');
    for (int step = 0; step < 4; ++step) {
        for (const bool caught : {false, true}) {
            ASSERT_TRUE(write_file(path("a"), as_bytes(old_contents)).ok());
            const pid_t child = fork();
            ASSERT_GE(child, 0);
            if (child == 0) {
                auto file = ReplacingFile::create(path("a"));
                const auto end = [&](int here) {
                    if (step != here) { return; }
                    if (caught) { remove_unfinished_files(); }
                    static_cast<void>(raise(SIGKILL));
                };
                if (!file.ok()) { _exit(1); }
                end(0);
                if (!file->write(as_bytes(new_contents).first(100'000)).ok()) { _exit(1); }
                end(1);
                if (!file->write(as_bytes(new_contents).subspan(100'000)).ok()) { _exit(1); }
                end(2);
                if (!file->commit().ok()) { _exit(1); }
                end(3);
                _exit(1);
            }
            int status = 0;
            ASSERT_EQ(waitpid(child, &status, 0), child);
            ASSERT_TRUE(WIFSIGNALED(status)) << "step " << step;
            EXPECT_EQ(contents(path("a")), step < 3 ? old_contents : new_contents) << "step " << step;
            const auto files = std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
            EXPECT_EQ(files, caught || step == 3 ? 1 : 2) << "step " << step;
            for (const auto& entry : fs::directory_iterator(folder_)) {
                if (entry.path() != path("a")) { fs::remove(entry.path()); }
            }
        }
    }
}

}  // namespace
}  // namespace gyrolog
