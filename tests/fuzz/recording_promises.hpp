// What a recording keeps whatever it was read from.
#pragma once

#include <cmath>
#include <cstdint>

#include "analysis/recording/recording.hpp"
#include "tests/fuzz/require.hpp"

namespace gyrolog {

inline void check_grid(const Recording& recording) {
    GYROLOG_REQUIRE(recording.rate_hz > 0.0 && std::isfinite(recording.rate_hz));
    GYROLOG_REQUIRE(recording.rows() > 0);
    std::size_t row = 0;
    std::int64_t index = -1;
    for (const Segment& segment : recording.segments) {
        GYROLOG_REQUIRE(segment.first == row && segment.count > 0 && segment.first_index > index);
        row += segment.count;
        index = segment.first_index + static_cast<std::int64_t>(segment.count) - 1;
    }
    GYROLOG_REQUIRE(row == recording.rows());
    for (const Column& column : recording.columns) { GYROLOG_REQUIRE(column.size() == row); }
}

inline void check_promises(const Recording& recording) {
    check_grid(recording);
    const std::size_t row = recording.rows();
    GYROLOG_REQUIRE(recording.t_s.empty() || recording.t_s.size() == row);
    std::int64_t missing = 0;
    for (const Dropout& dropout : recording.dropouts) { missing += dropout.samples; }
    GYROLOG_REQUIRE(missing == recording.missing_samples());
    for (const Column& column : recording.columns) {
        if (column.name[0] != 'g') { continue; }
        for (std::size_t i = 0; i < row; ++i) { GYROLOG_REQUIRE(!std::isnan(column.value(i))); }
    }
}

}  // namespace gyrolog
