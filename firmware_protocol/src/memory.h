/// The four memory calls that GCC expects even of a freestanding program. A hosted build takes the C
/// library's; a firmware without one adds memory.c.
#ifndef GYROLOG_PROTOCOL_SRC_MEMORY_H
#define GYROLOG_PROTOCOL_SRC_MEMORY_H

#include <stddef.h>

#if __STDC_HOSTED__
    #include <string.h>
#else
void* memcpy(void* restrict to, const void* restrict from, size_t size);
void* memmove(void* to, const void* from, size_t size);
void* memset(void* to, int value, size_t size);
int memcmp(const void* a, const void* b, size_t size);
#endif

#endif
