// A course is a function of one number that some of its points tell.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace gyrolog {

// It is straight between its points, and constant before the first and after the last. It has one point at
// least; `at` increases.
class Course {
public:
    Course(std::vector<double> at, std::vector<double> value)
        : at_(std::move(at)), value_(std::move(value)) {}

    double operator()(double x) const {
        const auto after = static_cast<std::size_t>(std::ranges::upper_bound(at_, x) - at_.begin());
        if (after == 0) { return value_.front(); }
        if (after == at_.size()) { return value_.back(); }
        const double share = (x - at_[after - 1]) / (at_[after] - at_[after - 1]);
        return value_[after - 1] + share * (value_[after] - value_[after - 1]);
    }

private:
    std::vector<double> at_;
    std::vector<double> value_;
};

}  // namespace gyrolog
