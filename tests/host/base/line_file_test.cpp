#include "host/base/line_file.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/file_size_limit.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

TEST(LineFile, TakesThePlaceOfWhatWasThereWithItsFirstLine) {
    const TemporaryFolder folder;
    const std::string path = folder.path("lines");
    std::ofstream(path) << "old";
    LineFile file(path);
    EXPECT_EQ(read_whole_file(path), "old");
    ASSERT_TRUE(file.append("one\n").ok());
    EXPECT_EQ(read_whole_file(path), "one\n") << "before it is closed";
    ASSERT_TRUE(file.append("two\n").ok());
    ASSERT_TRUE(file.close().ok());
    EXPECT_EQ(read_whole_file(path), "one\ntwo\n");
}

TEST(LineFile, AFullDiskCostsTheLineThatDidNotFitAndNoOther) {
    const TemporaryFolder folder;
    const std::string path = folder.path("lines");
    LineFile file(path);
    ASSERT_TRUE(file.append("one\n").ok());
    {
        const FileSizeLimit full(10);
        const Status refused = file.append("a line that does not fit\n");
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.error().message.find("write '" + path + "'"), 0U) << refused.error().message;
        EXPECT_EQ(read_whole_file(path), "one\n");
    }
    ASSERT_TRUE(file.append("two\n").ok());
    EXPECT_EQ(read_whole_file(path), "one\ntwo\n");
}

TEST(LineFile, ThatGetsNoLineLeavesWhatWasThere) {
    const TemporaryFolder folder;
    std::ofstream(folder.path("lines")) << "old";
    LineFile file(folder.path("lines"));
    EXPECT_TRUE(file.close().ok());
    EXPECT_EQ(read_whole_file(folder.path("lines")), "old");
}

}  // namespace
}  // namespace gyrolog
