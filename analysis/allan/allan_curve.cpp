#include "analysis/allan/allan_curve.hpp"

namespace gyrolog {

std::string_view name_of(DeviationKind kind) {
    return kind == DeviationKind::overlapping ? "overlapping" : "standard";
}

std::string_view name_of(PhaseConvention convention) {
    return convention == PhaseConvention::sp1065 ? "sp1065" : "matlab";
}

}  // namespace gyrolog
