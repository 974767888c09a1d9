#include "host/base/file_output.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

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

}  // namespace
}  // namespace gyrolog
