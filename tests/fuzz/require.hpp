// What must hold for every input. Unlike assert it stays in release builds; abort is what a fuzzer catches.
#pragma once

#include <cstdio>
#include <cstdlib>

#define GYROLOG_REQUIRE(condition)                                                                   \
    do {                                                                                             \
        if (!(condition)) {                                                                          \
            static_cast<void>(                                                                       \
                std::fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition)); \
            std::abort();                                                                            \
        }                                                                                            \
    } while (false)
