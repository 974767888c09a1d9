// Every eighth sample of a signal freed of what would fold onto it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gyrolog {

// A linear-phase low-pass (Kaiser window; Kaiser 1974) and one output for every `factor` inputs. Up to
// usable * (output rate) nothing folds in above -90 dB, and response() takes out the filter's own gain.
class Decimator {
public:
    static constexpr std::size_t factor = 8;
    static constexpr std::size_t taps = 128;
    static constexpr double usable = 0.3;

    // Power gain |H|^2 at a frequency in cycles per output sample.
    static double power_gain(double cycles_per_output);

    // How many outputs an unbroken stretch of that many inputs gives.
    static constexpr std::size_t outputs(std::size_t inputs) {
        return inputs < taps ? 0 : (inputs - taps) / factor + 1;
    }

    // Replaces `out`. Inputs must be one stretch until restart().
    void push(std::span<const double> in, std::vector<double>& out);
    void restart() { pending_.clear(); }

private:
    std::vector<double> pending_;
};

}  // namespace gyrolog
