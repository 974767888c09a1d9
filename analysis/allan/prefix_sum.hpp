// The integrated signal theta, from which every Allan-type difference is taken.
//
//   theta_0 = 0,  theta_k = (x_1 - c) + ... + (x_k - c)
//
// c is the column's mean: Allan differences cancel any constant, and without it theta of a biased gyro would
// grow by the bias times the length and lose as many digits. Sensor counts are summed exactly, in whole
// numbers, with c the nearest whole number; real numbers with a compensated sum (Neumaier 1974).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

// Mean of a column's raw numbers; 0 of none.
double raw_mean(const Column& column);

class PrefixSum {
public:
    // theta over rows first ... first + count - 1 of the column: count + 1 points, in the column's raw
    // numbers.
    PrefixSum(const Column& column, double centre, std::size_t first, std::size_t count);

    std::size_t points() const;
    double operator[](std::size_t k) const;
    // Of counts, max theta - min theta: no second difference is larger than twice that. 0 of reals.
    std::int64_t spread() const { return spread_; }

    // 32-bit whole numbers where no second difference of theta can leave 32 bits, else 64-bit ones; reals as
    // they are.
    const auto& values() const { return theta_; }

private:
    std::variant<std::vector<std::int32_t>, std::vector<std::int64_t>, std::vector<double>> theta_;
    std::int64_t spread_ = 0;
};

}  // namespace gyrolog
