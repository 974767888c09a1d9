// What one half of a recording says to what was fitted to the other.
#pragma once

#include <string>
#include <vector>

namespace gyrolog {

struct SplitHalfResult {
    // Effects that were fitted to one half and judged by the other.
    std::vector<std::string> judged;
    // Of the effect that is left most: log Bayes factor for more of it. By chance below 0.
    double evidence_left_nats = 0.0;
    // By how much more the likelihood falls short of its maximum than the parameters' own error makes it.
    double excess_nats = 0.0;
};

}  // namespace gyrolog
