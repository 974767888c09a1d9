#include "analysis/diagnose/calibration/evidence_tail.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/numerics/exponential_tail.hpp"

namespace gyrolog {

EvidenceTail::EvidenceTail(std::vector<double> simulated_nats) : sorted_nats_(std::move(simulated_nats)) {
    std::ranges::sort(sorted_nats_);
    const auto tail = ExponentialTail::of(
        sorted_nats_, {.share = 0.1, .least = 2, .censored_share = 0.0, .mean_least = 1.0});
    tail_from_nats_ = tail->threshold();
    tail_scale_nats_ = tail->mean_excess();
    tail_probability_ = tail->count() / static_cast<double>(sorted_nats_.size());
}

double EvidenceTail::surprise_nats(double nats) const {
    if (nats > tail_from_nats_) {
        return (nats - tail_from_nats_) / tail_scale_nats_ - std::log(tail_probability_);
    }
    const auto as_large = sorted_nats_.end() - std::ranges::lower_bound(sorted_nats_, nats);
    return std::log((1.0 + static_cast<double>(sorted_nats_.size())) / (1.0 + static_cast<double>(as_large)));
}

double EvidenceTail::probability(double nats) const { return std::exp(-surprise_nats(nats)); }

double EvidenceTail::threshold_nats(double p) const {
    if (p < tail_probability_) {
        return tail_from_nats_ + tail_scale_nats_ * std::log(tail_probability_ / p);
    }
    const auto rank = static_cast<std::size_t>((1.0 - p) * static_cast<double>(sorted_nats_.size()));
    return sorted_nats_[std::min(rank, sorted_nats_.size() - 1)];
}

}  // namespace gyrolog
