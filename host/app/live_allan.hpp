// The Allan deviation of a capture that is still running, and how much longer it must run. Memory does not
// grow with the capture.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "analysis/allan/running_allan.hpp"
#include "host/session/capture_session.hpp"

namespace gyrolog {

inline constexpr double walk_wanted_sd = 0.2;  // of K, one standard deviation over K

// Of one axis, in dps and seconds.
struct LiveAxis {
    AllanCurve curve;
    double length_s = 0.0;  // of the samples in it
    bool walk_seen = false;
    double K = 0.0;                        // dps*sqrt(Hz); where it is not seen, most likely less
    std::optional<double> K_relative_sd;   // as `analyze` will have it now, where it is seen
    std::optional<double> still_needed_s;  // until K is known to walk_wanted_sd, where it is seen
};

class LiveAllan final : public SampleObserver {
public:
    // On the writer's thread. The first start begins anew, and so does a configuration that changes the
    // samples' meaning; a later start, of a board that comes back, leaves a hole.
    void on_start() override;
    void on_samples(const glp_frame& frame, const glp_samples& samples, const glp_config& config) override;

    // By the nominal rate. A stretch of work: some ten milliseconds an axis. Empty curves without samples.
    std::array<LiveAxis, 3> axes() const;
    std::uint64_t samples() const;

private:
    void begin(const glp_config& config);

    mutable std::mutex mutex_;
    std::array<RunningAllan, 3> running_;
    std::optional<glp_config> config_;
    bool started_ = false;
};

// In words: "K 0.0012 dps*sqrt(Hz) ±35 %, about 2.1 h more until ±20 %"; K from the curve,
// its uncertainty and the time still needed as walk_knowledge.hpp has them.
std::string walk_text(const LiveAxis& axis);

}  // namespace gyrolog
