/// memcpy, memmove, memset and memcmp for a firmware that links no C library. Left out of every other build.
#include "memory.h"

#include <stdint.h>

#if !__STDC_HOSTED__

    // Without this GCC would turn the loops below into calls of the functions they define.
    #if defined(__GNUC__) && !defined(__clang__)
        #pragma GCC optimize("no-tree-loop-distribute-patterns")
    #endif

void* memcpy(void* restrict to, const void* restrict from, size_t size) {
    uint8_t* out = to;
    const uint8_t* in = from;
    for (size_t i = 0; i < size; ++i) { out[i] = in[i]; }
    return to;
}

void* memmove(void* to, const void* from, size_t size) {
    uint8_t* out = to;
    const uint8_t* in = from;
    if ((uintptr_t)out < (uintptr_t)in) {
        for (size_t i = 0; i < size; ++i) { out[i] = in[i]; }
    } else {
        for (size_t i = size; i > 0; --i) { out[i - 1] = in[i - 1]; }
    }
    return to;
}

void* memset(void* to, int value, size_t size) {
    uint8_t* out = to;
    for (size_t i = 0; i < size; ++i) { out[i] = (uint8_t)value; }
    return to;
}

int memcmp(const void* a, const void* b, size_t size) {
    const uint8_t* left = a;
    const uint8_t* right = b;
    for (size_t i = 0; i < size; ++i) {
        if (left[i] != right[i]) { return (left[i] < right[i]) ? -1 : 1; }
    }
    return 0;
}

#else

typedef int glp_memory_comes_from_the_c_library;

#endif
