#include "host/app/progress_line.hpp"

#include <chrono>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gyrolog {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

ProgressLine::Clock::time_point present{};

ProgressLine::Clock::time_point now() { return present; }

void pass(double s) {
    present += std::chrono::duration_cast<ProgressLine::Clock::duration>(std::chrono::duration<double>(s));
}

struct Terminal {
    std::ostringstream out;
    std::ostringstream err;
    Console console{out, err, true};

    std::string drawn() {
        std::string text = err.str();
        err.str("");
        return text;
    }
};

TEST(ProgressLine, BeginsAfterASecondAndTellsTheTimeLeft) {
    Terminal terminal;
    {
        ProgressLine line(terminal.console, now);
        pass(0.9);
        line.show("simulating", 0.09);
        EXPECT_EQ(terminal.drawn(), "") << "what is brief has no line";
        pass(9.1);
        line.show("simulating", 0.25);
        EXPECT_THAT(terminal.drawn(), EndsWith("simulating  25 %  0:00:30 left"));
        pass(0.05);
        line.show("simulating", 0.3);
        EXPECT_EQ(terminal.drawn(), "") << "ten times a second at most";
    }
    EXPECT_EQ(terminal.drawn(), "\r\x1b[K") << "nothing is left of it";
}

TEST(ProgressLine, TellsTheTimeOfWhatIsBeingDoneAlone) {
    Terminal terminal;
    ProgressLine line(terminal.console, now);
    line.show("reading", 0.5);
    pass(100.0);
    line.show("reading", 1.0);
    EXPECT_THAT(terminal.drawn(), Not(HasSubstr("left")));
    pass(4.0);
    line.show("measuring", 0.5);
    EXPECT_THAT(terminal.drawn(), EndsWith("measuring  50 %  0:00:04 left"));
}

TEST(ProgressLine, SaysWhatIsDoneWhereNobodyKnowsHowLongItTakes) {
    Terminal terminal;
    ProgressLine line(terminal.console, now);
    pass(2.0);
    line.show("fitting the noise");
    EXPECT_THAT(terminal.drawn(), EndsWith("\r\x1b[K  fitting the noise  0:00:02"));
}

// What was told within the first second, and says nothing further.
TEST(ProgressLine, GoesOnWhereNothingMoreIsTold) {
    Terminal terminal;
    ProgressLine line(terminal.console, now);
    pass(0.1);
    line.show("Allan deviation");
    line.look();
    EXPECT_EQ(terminal.drawn(), "");
    pass(1.9);
    line.look();
    EXPECT_THAT(terminal.drawn(), EndsWith("Allan deviation  0:00:02"));
    pass(1.0);
    line.look();
    EXPECT_THAT(terminal.drawn(), EndsWith("Allan deviation  0:00:03"));
    line.show("reading", 0.25);
    EXPECT_THAT(terminal.drawn(), HasSubstr("reading  25 %"));
    pass(5.0);
    line.look();
    EXPECT_EQ(terminal.drawn(), "") << "a share is not known better by waiting";
}

TEST(ProgressLine, LooksByItself) {
    Terminal terminal;
    ProgressLine line(terminal.console);
    line.show("writing");
    std::this_thread::sleep_for(2.5 * progress_options.quiet_for);
    line.show("another thing");
    EXPECT_THAT(terminal.drawn(), HasSubstr("writing  0:00:0"));
}

TEST(ProgressLine, IsForTerminalsOnly) {
    Terminal terminal;
    terminal.console.progress = false;
    {
        ProgressLine line(terminal.console, now);
        pass(5.0);
        line.show("simulating", 0.5);
    }
    EXPECT_EQ(terminal.drawn(), "");
}

TEST(Console, HasNoNoticesWhereItIsQuiet) {
    Terminal terminal;
    terminal.console.notices() << "written: a";
    EXPECT_EQ(terminal.drawn(), "written: a");
    terminal.console.is_quiet = true;
    terminal.console.notices() << "written: b";
    EXPECT_EQ(terminal.drawn(), "");
    terminal.console.err << "no such file";
    EXPECT_EQ(terminal.drawn(), "no such file");
}

}  // namespace
}  // namespace gyrolog
