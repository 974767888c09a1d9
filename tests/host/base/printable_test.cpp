#include "host/base/printable.hpp"

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

struct Shown {
    const char* text;
    const char* shown;
};

class Printable : public testing::TestWithParam<Shown> {};

TEST_P(Printable, ShowsWhatATerminalWouldObey) { EXPECT_EQ(printable(GetParam().text), GetParam().shown); }

INSTANTIATE_TEST_SUITE_P(
    Texts, Printable,
    testing::Values(Shown{"plain, 25 \xC2\xB0"
                          "C, \xE2\x88\x9A, \xF0\x9F\x98\x80",
                          "plain, 25 \xC2\xB0"
                          "C, \xE2\x88\x9A, \xF0\x9F\x98\x80"},
                    Shown{"\x1b[2Jgone", "\\u001b[2Jgone"},               // clears the screen
                    Shown{"\x1b]0;title\x07", "\\u001b]0;title\\u0007"},  // renames the window
                    Shown{"\xC2\x9B"
                          "2J",
                          "\\u009b2J"},  // the same as one character
                    Shown{"\x9B"
                          "2J",
                          "\\x9b2J"},  // and as a byte of Latin 1
                    Shown{"a\nb\tc\r", "a\\u000ab\\u0009c\\u000d"},
                    Shown{"a\xE2\x80\xAE"
                          "b",
                          "a\\u202eb"},                                 // turns the direction
                    Shown{"\xC0\xAF", "\\xc0\\xaf"},                    // an overlong slash
                    Shown{"\xED\xA0\x80", "\\xed\\xa0\\x80"},           // a surrogate
                    Shown{"\xF4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // beyond the last character
                    Shown{"cut \xE2\x88", "cut \\xe2\\x88"}, Shown{"", ""}));

TEST(PrintableText, InPiecesIsTheSameAsInOne) {
    const std::string text = "x: \xE2\x88\x9A\n\ttwo \x1b[K \xF0\x9F\x98\x80 \xE2\x88 end\xE2";
    const std::string shown = "x: \xE2\x88\x9A\n\ttwo \\u001b[K \xF0\x9F\x98\x80 \\xe2\\x88 end\\xe2";
    for (std::size_t size = 1; size <= text.size(); ++size) {
        PrintableText pieces;
        std::string all;
        for (std::size_t at = 0; at < text.size(); at += size) { all += pieces.take(text.substr(at, size)); }
        EXPECT_EQ(all + pieces.end(), shown) << size;
    }
}

TEST(ShellWord, IsOneWordThatRunsNothing) {
    EXPECT_EQ(shell_word("night-1.pcapng"), "night-1.pcapng");
    EXPECT_EQ(shell_word("a b;id"), "'a b;id'");
    EXPECT_EQ(shell_word("it's $(id)"), "'it'\\''s $(id)'");
    EXPECT_EQ(shell_word("a\nb"), "'a\\u000ab'");
    EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace gyrolog
