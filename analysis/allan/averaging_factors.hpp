// The averaging factors m (samples in one average) at which an Allan curve is worked out.
#pragma once

#include <cstdint>
#include <vector>

namespace gyrolog {

// m_i = ceil(M^(i / 99)), i = 0 ... 99, without repetitions, where M = 2^floor(log2(samples / 2)): about 93
// values, evenly spaced on a logarithmic axis. Worked out in whole numbers: a logarithm of the C library may
// round M up to M + 1. Empty for fewer than two samples.
std::vector<std::int64_t> averaging_factors(std::int64_t samples);

}  // namespace gyrolog
