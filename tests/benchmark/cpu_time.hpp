// CPU time of this process, all threads together.
#pragma once

#include <ctime>

namespace gyrolog {

inline double cpu_seconds() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <typename Work>
double cpu_seconds_of(const Work& work) {
    const double begin = cpu_seconds();
    work();
    return cpu_seconds() - begin;
}

}  // namespace gyrolog
