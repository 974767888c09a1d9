// Whether a sanitizer watches this build: it takes malloc's place and a multiple of the time.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    #define GYROLOG_IS_INSTRUMENTED 1
#elif defined(__has_feature)
    #if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
        #define GYROLOG_IS_INSTRUMENTED 1
    #endif
#endif
#ifndef GYROLOG_IS_INSTRUMENTED
    #define GYROLOG_IS_INSTRUMENTED 0
#endif
