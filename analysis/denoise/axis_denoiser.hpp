// One axis of a recording, or of a stream that becomes one, sample by sample: an ArrayDenoiser that knows its
// units, and where holes are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/denoise/array_columns.hpp"
#include "analysis/denoise/array_denoiser.hpp"
#include "analysis/denoise/denoise.hpp"

namespace gyrolog {

class AxisDenoiser {
public:
    // `knowledge` as learn_units() gives it, or of models alone (know_units()).
    AxisDenoiser(const AxisKnowledge& knowledge, const DenoiseDesign& design);

    // The rate at sampling instant `index` of the grid, which rises from call to call: instants between are
    // a hole. The samples are those of `row`.
    double step(std::int64_t index, const ArrayAxis& columns, std::size_t row);

    // At the last step.
    std::span<const UnitState> states() const { return denoiser_.states(); }

private:
    ArrayDenoiser denoiser_;
    std::vector<double> samples_;
    std::optional<std::int64_t> next_;
};

}  // namespace gyrolog
