// Colour for people at a terminal. Text itself has none: a stream that leads to a terminal takes it beside
// the text, after all that comes from outside was made harmless, and every other stream leaves it away.
#pragma once

#include <ostream>
#include <string>

namespace gyrolog {

enum class Ink { plain, verdict, warning, error };  // bold; yellow; red

// Whether this descriptor is a terminal that may be coloured: not with NO_COLOR (no-color.org), nor on one
// that says it knows nothing (TERM=dumb).
bool takes_colour(int descriptor);

// What a terminal is told: "\x1b[1m".
const char* code_of(Ink ink);

// A stream that knows it leads to a terminal.
class InkedStream : public std::ostream {
public:
    explicit InkedStream(bool has_colour) : std::ostream(nullptr), has_colour_(has_colour) {}
    InkedStream(const InkedStream&) = delete;
    InkedStream& operator=(const InkedStream&) = delete;
    ~InkedStream() override = default;

    void take_ink(Ink ink) {
        if (has_colour_) { write_code(code_of(ink)); }
    }

private:
    // Behind what was written before.
    virtual void write_code(const char* code) = 0;

    bool has_colour_;
};

std::ostream& operator<<(std::ostream& to, Ink ink);

enum class Emphasis { none, first_paragraph };

// A report with its warnings in yellow, and with its verdict, the first paragraph, in bold.
void write_inked(std::ostream& to, const std::string& report, Emphasis emphasis);

}  // namespace gyrolog
