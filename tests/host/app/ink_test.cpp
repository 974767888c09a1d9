// Which lines of a report have colour.
#include "host/app/ink.hpp"

#include <sstream>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

class InkedText final : public InkedStream {
public:
    explicit InkedText(bool has_colour) : InkedStream(has_colour) { rdbuf(&text_); }
    std::string str() const { return text_.str(); }

private:
    void write_code(const char* code) override { *this << code; }

    std::stringbuf text_;
};

constexpr const char* report =
    "known: a cause\n\nwarning: one that goes\n         on\nplain\n\nwarnings\n  - another\n\nthe end\n";

std::string inked(bool has_colour, Emphasis emphasis) {
    InkedText text(has_colour);
    write_inked(text, report, emphasis);
    return text.str();
}

TEST(Ink, IsForTheVerdictAndForWarnings) {
    EXPECT_EQ(inked(true, Emphasis::first_paragraph),
              "\x1b[1mknown: a cause\x1b[0m\n\n\x1b[33mwarning: one that goes\x1b[0m\n"
              "\x1b[33m         on\x1b[0m\nplain\n\n\x1b[33mwarnings\x1b[0m\n\x1b[33m  - "
              "another\x1b[0m\n\nthe end\n");
    EXPECT_EQ(inked(true, Emphasis::none).find("\x1b[1m"), std::string::npos);
}

TEST(Ink, ChangesNothingWithoutATerminal) {
    EXPECT_EQ(inked(false, Emphasis::first_paragraph), report);
    std::ostringstream plain;
    write_inked(plain, report, Emphasis::first_paragraph);
    plain << Ink::error << Ink::plain;
    EXPECT_EQ(plain.str(), report);
}

}  // namespace
}  // namespace gyrolog
