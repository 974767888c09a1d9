// The textbook's way to noise coefficients: read the Allan curve where it has the slope of each noise.
//
//   N: slope -1/2, its line read at tau = 1 s       (IEEE Std 952-1997, C.1.1)
//   B: slope 0, its level over sqrt(2 ln 2 / pi)    (C.1.3)
//   K: slope +1/2, its line read at tau = 3 s       (C.1.4)
#pragma once

#include <optional>

#include "analysis/allan/allan_curve.hpp"

namespace gyrolog {

// What is read off a curve needs so many degrees of freedom behind it, which leave a deviation uncertain by
// 1 / sqrt(2 edf), 22 %. With fewer, as at the last few averaging times of every record, a slope or a lowest
// point is chance.
inline constexpr double edf_to_read = 10.0;

struct SlopeReading {
    struct Value {
        double coefficient = 0.0;  // N, B or K in the curve's unit (times sqrt(s), 1, 1/sqrt(s))
        double tau_s = 0.0;        // where the curve has that slope
    };
    std::optional<Value> N, B, K;  // absent where that slope never occurs
};

SlopeReading read_slopes(const AllanCurve& curve);

// The curve's lowest point among those with edf_to_read behind them; null where there is none.
const AllanPoint* lowest_point(const AllanCurve& curve);

}  // namespace gyrolog
