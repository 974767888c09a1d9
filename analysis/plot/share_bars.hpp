// Bars of the shares of a gap's square: of every cause, of what was modelled without a name, of what is left,
// and of the floor, which chance makes. Shares of causes may overlap, so the bars stand below each other and
// add up to nothing.
#pragma once

#include <optional>

#include "analysis/diagnose/report.hpp"
#include "analysis/plot/figure.hpp"

namespace gyrolog {

// Without a gap there are no shares. The panel spans its row; its height_share is the height in pixels that
// it needs at scale 1.
std::optional<Panel> share_bars(const Diagnosis& diagnosis);

}  // namespace gyrolog
