#include "host/base/confined_process.hpp"

#include <atomic>
#include <csignal>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace gyrolog {
namespace {

constexpr ProcessConfines roomy{std::size_t{64} << 20U, 20.0, 1000};

void say(int descriptor, const std::string& text) {
    EXPECT_EQ(::write(descriptor, text.data(), text.size()), static_cast<ssize_t>(text.size()));
}

std::string refusal(const ProcessConfines& confines, const std::function<void(int)>& work) {
    const Result<Bytes> result = run_confined(confines, work);
    return result.ok() ? "none" : result.error().message;
}

TEST(ConfinedProcess, HandsBackWhatWasWritten) {
    const Result<Bytes> result = run_confined(roomy, [](int descriptor) {
        say(descriptor, "one ");
        say(descriptor, "two");
    });
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(std::string(result->begin(), result->end()), "one two");
}

TEST(ConfinedProcess, ChangesNothingHere) {
    int here = 1;
    ASSERT_TRUE(run_confined(roomy, [&](int) { here = 2; }).ok());
    EXPECT_EQ(here, 1);
}

TEST(ConfinedProcess, SaysThatTheWorkCrashed) {
    EXPECT_NE(refusal(roomy, [](int) { static_cast<void>(std::raise(SIGSEGV)); }).find("damaged"),
              std::string::npos);
    EXPECT_NE(refusal(roomy, [](int) { throw std::string("lost"); }).find("damaged"), std::string::npos);
}

TEST(ConfinedProcess, EndsWorkThatTakesTooMuch) {
    ProcessConfines confines = roomy;
    confines.processor_s = 1.0;
    EXPECT_NE(refusal(confines,
                      [](int) {
                          for (std::atomic<unsigned> turns = 0;; ++turns) {}
                      })
                  .find("time"),
              std::string::npos);
    EXPECT_NE(refusal(roomy,
                      [](int) {
                          const std::vector<char> much(std::size_t{1} << 40U);
                          say(STDOUT_FILENO, {much.begin(), much.begin() + 1});
                      })
                  .find("memory"),
              std::string::npos);
    EXPECT_NE(refusal(roomy,
                      [](int descriptor) {
                          for (int i = 0; i < 100; ++i) { say(descriptor, std::string(100, 'x')); }
                      })
                  .find("more than its size"),
              std::string::npos);
}

}  // namespace
}  // namespace gyrolog
