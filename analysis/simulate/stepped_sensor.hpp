// A simulated gyro in another simulator's loop: that one says at each of its steps what the body does, and
// gets the samples that the sensor has taken since.
//
// The samples are those of SensorSimulator in the same world, bit for bit: of a sensor at rest, those that
// `gyrolog simulate` writes. The sensor keeps its own clock; the other simulator's steps may be shorter or
// longer than its period, and need not be equal.
#pragma once

#include <cstdint>
#include <memory>

#include "analysis/simulate/sensor_simulator.hpp"
#include "analysis/simulate/stepped_world.hpp"

namespace gyrolog {

struct SteppedSample {
    std::uint64_t index = 0;  // of the sensor's clock; what was lost is missing
    double stamp_s = 0.0;     // what the time stamp says, on the other simulator's time
    Vector3 rate_rad_s{};
    std::array<std::int16_t, 3> counts{};  // zero when the model has no lsb
    double temperature_C = 0.0;            // as the sensor reports it
};

class SteppedSensor {
public:
    // As many of the other simulator's steps are remembered; the sensor's delay may not reach beyond.
    static constexpr std::size_t steps_kept = 8192;

    // `model` has no simulation_refusal(). `rate_hz` takes the place of the model's.
    SteppedSensor(const SensorModel& model, double rate_hz, std::uint64_t seed);

    enum class Step {
        taken,
        not_later,            // than the step before: nothing was done
        not_finite,           // a number: nothing was done
        temperature_changed,  // from told to not told, or back: nothing was done
    };
    // The first step is the sensor's first sampling instant; `t_s` is the other simulator's. A temperature is
    // that around the sensor, whose own heat comes on top; where none is told it wanders by itself.
    Step step(const WorldInstant& now);

    enum class Take {
        sample,
        none,       // that is due: the next step brings more
        forgotten,  // the sample shows a moment before the steps that are remembered
    };
    // The next sample that is due: its instant is reached, and so is the moment of the world that it shows. A
    // thousandth of the sensor's period before counts as reached, so that time summed up by the other
    // simulator need not be exact.
    Take take(SteppedSample& sample);

    double rate_hz() const { return rate_hz_; }

private:
    double rate_hz_;  // nominal
    double true_rate_hz_;
    std::shared_ptr<SteppedWorld> world_;
    SensorSimulator simulator_;
    double start_s_ = 0.0;
};

}  // namespace gyrolog
