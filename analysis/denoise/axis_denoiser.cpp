#include "analysis/denoise/axis_denoiser.hpp"

namespace gyrolog {
namespace {

ArrayDenoiser denoiser_of(const AxisKnowledge& knowledge, const DenoiseDesign& design) {
    std::vector<UnitLimits> limits;
    limits.reserve(knowledge.units.size());
    for (const UnitKnowledge& unit : knowledge.units) { limits.push_back(unit.limits); }
    const std::span<const double> offsets = design.gain == FilterGain::steady
                                                ? std::span<const double>(knowledge.offsets)
                                                : std::span<const double>();
    return {knowledge.noise, limits, design, offsets};
}

}  // namespace

AxisDenoiser::AxisDenoiser(const AxisKnowledge& knowledge, const DenoiseDesign& design)
    : denoiser_(denoiser_of(knowledge, design)), samples_(knowledge.units.size()) {}

double AxisDenoiser::step(std::int64_t index, const ArrayAxis& columns, std::size_t row) {
    if (next_ && index > *next_) { denoiser_.skip(static_cast<std::size_t>(index - *next_)); }
    next_ = index + 1;
    for (std::size_t unit = 0; unit < samples_.size(); ++unit) {
        samples_[unit] = columns.units[unit]->value(row);
    }
    return denoiser_.step(samples_);
}

}  // namespace gyrolog
