#include "host/app/ink.hpp"

#include <cstdlib>
#include <string_view>

#include <unistd.h>

namespace gyrolog {
namespace {

// Where a line belongs to.
class Paragraphs {
public:
    explicit Paragraphs(Emphasis emphasis) : is_verdict_(emphasis == Emphasis::first_paragraph) {}

    Ink ink_of(std::string_view line) {
        if (line.empty()) {
            is_verdict_ = is_list_ = is_warning_ = false;
            return Ink::plain;
        }
        is_list_ = is_list_ || line == "warnings";
        if (!line.starts_with(' ')) { is_warning_ = line.starts_with("warning: "); }
        if (is_list_ || is_warning_) { return Ink::warning; }
        return is_verdict_ ? Ink::verdict : Ink::plain;
    }

private:
    bool is_verdict_;
    bool is_list_ = false;     // "warnings", with one a line below it
    bool is_warning_ = false;  // "warning: ", and what goes on in indented lines
};

}  // namespace

bool takes_colour(int descriptor) {
    const char* refused = std::getenv("NO_COLOR");
    const char* terminal = std::getenv("TERM");
    if (refused != nullptr && *refused != '\0') { return false; }
    if (terminal != nullptr && std::string_view(terminal) == "dumb") { return false; }
    return isatty(descriptor) == 1;
}

const char* code_of(Ink ink) {
    switch (ink) {
        case Ink::verdict:
            return "\x1b[1m";
        case Ink::warning:
            return "\x1b[33m";
        case Ink::error:
            return "\x1b[31m";
        case Ink::plain:
            break;
    }
    return "\x1b[0m";
}

std::ostream& operator<<(std::ostream& to, Ink ink) {
    if (auto* inked = dynamic_cast<InkedStream*>(&to)) { inked->take_ink(ink); }
    return to;
}

void write_inked(std::ostream& to, const std::string& report, Emphasis emphasis) {
    Paragraphs paragraphs(emphasis);
    std::string_view rest = report;
    while (!rest.empty()) {
        const std::size_t end = rest.find('\n');
        const std::string_view line = rest.substr(0, end);
        const Ink ink = paragraphs.ink_of(line);
        if (ink != Ink::plain) { to << ink; }
        to << line;
        if (ink != Ink::plain) { to << Ink::plain; }
        if (end == std::string_view::npos) { return; }
        to << '\n';
        rest.remove_prefix(end + 1);
    }
}

}  // namespace gyrolog
