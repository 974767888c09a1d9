// A curve of the Allan family: deviations over averaging times, each with its confidence interval.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace gyrolog {

// Defined in allan_deviation.hpp.
enum class DeviationKind {
    overlapping,           // OADEV
    standard,              // ADEV
    standard_halving,      // ADEV as textbooks take it: m = 1, 2, 4, ..., with their error
    modified,              // MDEV
    hadamard,              // HDEV
    overlapping_hadamard,  // OHDEV
    total,                 // TOTDEV
};
inline constexpr std::array all_deviation_kinds = {
    DeviationKind::overlapping, DeviationKind::standard, DeviationKind::standard_halving,
    DeviationKind::modified,    DeviationKind::hadamard, DeviationKind::overlapping_hadamard,
    DeviationKind::total};

// Which phase points a record of N rate samples has.
//   sp1065: theta_0 = 0 counts, N + 1 points, N + 1 - 2m overlapping terms (NIST SP 1065, Stable32)
//   matlab: theta_0 is left out, N points, N - 2m terms (MathWorks' published example)
// For every kind: its own formula on those points; `matlab` is what `sp1065` gives without the first sample
// of each unbroken stretch.
enum class PhaseConvention { sp1065, matlab };

struct AllanPoint {
    std::int64_t m = 0;      // samples averaged
    double tau_s = 0.0;      // m / rate
    double deviation = 0.0;  // unit of the samples
    double lo = 0.0;         // confidence interval
    double hi = 0.0;
    double edf = 0.0;        // equivalent degrees of freedom
    std::int64_t terms = 0;  // squares averaged
};

struct AllanCurve {
    DeviationKind kind = DeviationKind::overlapping;
    PhaseConvention convention = PhaseConvention::sp1065;
    double confidence = 0.683;
    std::vector<AllanPoint> points;  // by rising m
};

std::string_view name_of(DeviationKind kind);
std::string_view name_of(PhaseConvention convention);

std::optional<DeviationKind> deviation_kind(std::string_view name);

}  // namespace gyrolog
