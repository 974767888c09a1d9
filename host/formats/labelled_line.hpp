// A line that people read: what it is about, and what is said of it.
#pragma once

#include <string>

namespace gyrolog {

struct LabelledLine {
    std::string label;  // empty: goes on with the line above
    std::string text;
};

}  // namespace gyrolog
