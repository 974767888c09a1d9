// A stage made of one process an axis, where each axis may lack it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "analysis/simulate/stage.hpp"

namespace gyrolog {

// Process: `void add(std::uint64_t first_index, std::span<double> rate_rad_s)` adds its samples to those of
// one axis.
template <typename Process>
class PerAxis final : public Stage {
public:
    // make(axis) gives std::optional<Process>. Null when no axis has the process.
    template <typename Make>
    static std::unique_ptr<Stage> make(Make make_axis) {
        auto stage = std::make_unique<PerAxis>();
        bool any = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            stage->processes_[axis] = make_axis(axis);
            any = any || stage->processes_[axis].has_value();
        }
        return any ? std::unique_ptr<Stage>(std::move(stage)) : nullptr;
    }

    void apply(SampleBlock& block) override {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (processes_[axis]) {
                processes_[axis]->add(block.first(), block.slots(block.rate_rad_s[axis]));
            }
        }
    }

private:
    std::array<std::optional<Process>, 3> processes_;
};

}  // namespace gyrolog
