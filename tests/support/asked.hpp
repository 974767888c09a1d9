// How much a test is to do, where its environment says so: the same program does a little always, and much in
// the long tier.
#pragma once

#include <cstdlib>

namespace gyrolog {

// The environment variable's number, or `otherwise` where it is not set.
inline double asked(const char* variable, double otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : std::atof(text);
}

inline bool is_asked(const char* variable) { return std::getenv(variable) != nullptr; }

}  // namespace gyrolog
