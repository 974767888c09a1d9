// How a sensor's bias follows the temperature, beside noise that wanders by itself.
//
// The means y_i of up to 128 equal blocks of the record are taken as
//   y_i = a + s T_i + noise,   S(f) = N^2 (1 + b / |f| + (k / f)^2)
// with the block's mean temperature T_i, in degC. b and k are the corners at which flicker and random walk
// reach the white noise, in Hz; N^2 is its level. A regression that took the noise as white would state far
// too small a deviation of the slope s: temperature and random walk are both slow, and what one wanders the
// other explains by chance.
//
// Differences of neighbouring blocks leave a out: restricted likelihood (H. D. Patterson, R. Thompson,
// Biometrika 58 (1971) 545-554). With u and t the m differences of y and T and C their covariance for N = 1,
//   S_tt = t' C^-1 t,  S_tu = t' C^-1 u,  S_uu = u' C^-1 u,  R = S_uu - S_tu^2 / S_tt,  nu = m - 1
// s is Student's t with nu degrees of freedom about S_tu / S_tt, of scale sqrt(R / (nu S_tt)), and the
// corners have the likelihood
//   L(b, k) = |C|^-1/2 S_tt^-1/2 R^(-nu/2)
// (D. A. Harville, JASA 72 (1977) 320-338; the level is integrated out with the density 1 / N^2). No record
// tells the corners well: a walk that the temperature happens to follow hides in the slope. So no one pair of
// them is taken. The slope has the mixture of those distributions, each with the weight L times what the pair
// is worth beforehand (J. O. Berger, B. Liseo, R. L. Wolpert, Statistical Science 14 (1999) 1-28).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct TemperatureDriftOptions {
    // Blocks: of the record. What is slower than two of them is seen; the exact covariance of 128 is cheap.
    std::size_t blocks_most = 128;
    // Blocks: with fewer the corners are anyone's guess; the likelihood of the noise asks for as many.
    std::size_t blocks_least = 32;
    // Of a block's samples, for its mean to stand for it; as for the likelihood of the noise.
    double complete_share = 0.5;
    // The variance of the blocks' temperatures over that of the thermometer's own noise in them. A slope is
    // drawn towards 0 by one part in as many (W. A. Fuller, Measurement Error Models, 1987, sec. 1.1).
    double temperature_over_noise_least = 25.0;
    // Different readings: a thermometer that showed fewer is too coarse for a slope.
    std::size_t readings_least = 8;
    // Corners: of each of flicker and walk from so many cycles a record, where the lowest of the record's
    // frequencies hardly show it, doubling, to so many cycles a block, where nothing else is seen.
    double corner_least_cycles_per_record = 2.0;
    double corner_most_cycles_per_block = 2.0;
    // Chances beforehand that there is no flicker, and no walk; the corners share what is left. They are set
    // so that slopes lie within one deviation in 68 % of records whatever their noise (the section "Drift
    // with temperature" of METHODS has the table).
    double chance_without_flicker = 0.5;
    double chance_without_walk = 0.25;
    // Chance by which a slope of 0 looks as large, for a slope to count as there.
    double false_alarm = 0.001;
    // s, and samples at least: the temperature is smooth over as much when it is taken off sample by sample,
    // so that the thermometer's noise is not added to the sensor's.
    double smooth_s = 1.0;
    std::size_t smooth_samples_least = 16;
};

struct TemperatureDrift {
    double slope_per_C = 0.0;  // unit of the column per degC
    // Half of the interval that has the slope with 68.27 %: of a normal distribution the standard deviation.
    double sd_per_C = 0.0;
    double chance = 1.0;       // that a slope of 0 gives one as far from 0, on either side
    bool is_there = false;     // chance <= false_alarm
    double false_alarm = 0.0;  // the options'
    double from_C = 0.0;       // of the blocks
    double to_C = 0.0;
    double mean_C = 0.0;        // over the samples: the temperature at which the bias is the mean
    double walk_left_in = 0.0;  // K of these blocks with the drift in, unit of the column times sqrt(Hz)
    double walk_without = 0.0;  // and beside the slope
    bool is_taken_off = false;  // of what was analysed
};

// Of each column, in their order. Nothing where the recording has no temperature in degC, where that does not
// vary beyond its own noise, or where the record is too short. The columns have a value in every row.
std::vector<std::optional<TemperatureDrift>> temperature_drifts(const Recording& recording,
                                                                std::span<const Column* const> columns,
                                                                const TemperatureDriftOptions& options = {});

// The column less slope_per_C (T - mean_C), T between known temperatures on a straight line. Its mean stays.
Column without_drift(const Recording& recording, const Column& column, const TemperatureDrift& drift,
                     const TemperatureDriftOptions& options = {});

}  // namespace gyrolog
