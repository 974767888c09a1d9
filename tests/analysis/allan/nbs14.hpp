// The NBS14 test suite: NIST SP 1065 (Riley 2008), pages 107-108, tables 31 and 32.
#pragma once

#include <cstdint>
#include <vector>

namespace gyrolog::test {

inline std::vector<double> nbs14_10_point_frequency() {
    return {892.0, 809.0, 823.0, 798.0, 671.0, 644.0, 883.0, 903.0, 677.0};
}

// n_{i+1} = 16807 n_i mod (2^31 - 1) from 1234567890, over 2^31 - 1.
inline std::vector<double> nbs14_1000_point_frequency() {
    std::vector<double> y;
    std::uint64_t n = 1234567890;
    for (int i = 0; i < 1000; ++i) {
        y.push_back(static_cast<double>(n) / 2147483647.0);
        n = 16807 * n % 2147483647;
    }
    return y;
}

}  // namespace gyrolog::test
