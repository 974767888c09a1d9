// An Allan curve: deviations over averaging times, each with its confidence interval.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace gyrolog {

enum class DeviationKind { overlapping, standard };

// Which phase points a record of N rate samples has.
//   sp1065: theta_0 = 0 counts, N + 1 points, N + 1 - 2m overlapping terms (NIST SP 1065, Stable32)
//   matlab: theta_0 is left out, N points, N - 2m terms (MathWorks' published example)
enum class PhaseConvention { sp1065, matlab };

struct AllanPoint {
    std::int64_t m = 0;      // samples averaged
    double tau_s = 0.0;      // m / rate
    double deviation = 0.0;  // unit of the samples
    double lo = 0.0;         // confidence interval by chi-square
    double hi = 0.0;
    double edf = 0.0;        // equivalent degrees of freedom
    std::int64_t terms = 0;  // differences summed
};

struct AllanCurve {
    DeviationKind kind = DeviationKind::overlapping;
    PhaseConvention convention = PhaseConvention::sp1065;
    double confidence = 0.683;
    std::vector<AllanPoint> points;  // by rising m
};

std::string_view name_of(DeviationKind kind);
std::string_view name_of(PhaseConvention convention);

}  // namespace gyrolog
