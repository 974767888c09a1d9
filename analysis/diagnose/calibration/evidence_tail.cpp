#include "analysis/diagnose/calibration/evidence_tail.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {

EvidenceTail::EvidenceTail(std::vector<double> simulated_nats) : sorted_nats_(std::move(simulated_nats)) {
    std::ranges::sort(sorted_nats_);
    const std::size_t count = sorted_nats_.size();
    const std::size_t in_tail = std::max<std::size_t>(count / 10, 2);
    tail_from_nats_ = sorted_nats_[count - in_tail - 1];
    double excess = 0.0;
    for (std::size_t i = count - in_tail; i < count; ++i) { excess += sorted_nats_[i] - tail_from_nats_; }
    tail_scale_nats_ = std::max(1.0, excess / static_cast<double>(in_tail));
    tail_probability_ = static_cast<double>(in_tail) / static_cast<double>(count);
}

double EvidenceTail::probability(double nats) const {
    if (nats > tail_from_nats_) {
        return tail_probability_ * std::exp(-(nats - tail_from_nats_) / tail_scale_nats_);
    }
    const auto as_large = sorted_nats_.end() - std::ranges::lower_bound(sorted_nats_, nats);
    return std::min(1.0,
                    (1.0 + static_cast<double>(as_large)) / (1.0 + static_cast<double>(sorted_nats_.size())));
}

double EvidenceTail::threshold_nats(double p) const {
    if (p < tail_probability_) {
        return tail_from_nats_ + tail_scale_nats_ * std::log(tail_probability_ / p);
    }
    const auto rank = static_cast<std::size_t>((1.0 - p) * static_cast<double>(sorted_nats_.size()));
    return sorted_nats_[std::min(rank, sorted_nats_.size() - 1)];
}

}  // namespace gyrolog
