// The evidence tail is the chance that simulations of a model have as much evidence against it as a
// recording.
#pragma once

#include <vector>

namespace gyrolog {

class EvidenceTail {
public:
    // `simulated_nats`: of at least twenty simulations.
    explicit EvidenceTail(std::vector<double> simulated_nats);

    // The chance is, within the simulations, (1 + number as large) / (1 + number); beyond their largest tenth
    // an exponential tail fitted to it, which falls no faster than exp(-nats), as the tail of log likelihood
    // ratios does (S. S. Wilks, Ann. Math. Statist. 9 (1938) 60).
    double probability(double nats) const;
    // -ln of it, which is finite where the probability is less than the smallest number.
    double surprise_nats(double nats) const;
    // The evidence with probability() = p.
    double threshold_nats(double p) const;

private:
    std::vector<double> sorted_nats_;
    double tail_from_nats_ = 0.0;
    double tail_probability_ = 0.0;
    double tail_scale_nats_ = 1.0;
};

}  // namespace gyrolog
