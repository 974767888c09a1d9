// The constants that decide what the diagnosis calls, names or admits, of all that lies below the judgement.
// Those of the judgement itself stand with it: DiagnosisOptions, NullJudgementOptions, RemainderOptions,
// SelectionOptions, ShapeOptions, SpectraRefitOptions.
//
// How finely or how far something is searched or computed is no decision: that is a `resolution`, which is
// meant to change no answer when made finer, and stands in a namespace of that name where it is used.
#pragma once

namespace gyrolog {

namespace definition {

// A share: what has more of something is that, rather than not.
inline constexpr double majority = 0.5;

}  // namespace definition

// Each: unit, meaning; source.
struct DecisionOptions {
    // A probability: chance has a gap where there is none, at most so often; convention. What causes leave is
    // called, and one effect more is named, half as often.
    double false_alarms_most = 0.01;

    // Standard deviations: what is seen where one place is looked at, once in 370 by chance; the normal
    // distribution.
    double seen_sigma = 3.0;
    // Standard deviations: what is seen though many places are looked at, once in 16 000 by chance; the
    // normal distribution.
    double certain_sigma = 4.0;
    // Standard deviations: single samples beyond are outliers, 1 in 5e8 by chance; the normal distribution.
    double outlier_sigma = 6.0;
    // The log-likelihood that goes with `seen_sigma` for one free number (Wilks 1938).
    constexpr double seen_nats() const { return 0.5 * seen_sigma * seen_sigma; }
    // Nats: what is certain by the log-likelihood, and wins by far.
    constexpr double certain_nats() const { return 0.5 * certain_sigma * certain_sigma; }
    // Nats: a Bayes factor below 20 is no strong evidence (Kass, Raftery 1995), whatever simulations have,
    // and no reason to prefer what was not first: a rival that is behind by less is a tie.
    double strong_nats = 3.0;
    // A relative standard deviation with which a positive number is just seen.
    constexpr double seen_sd_rel() const { return 1.0 / seen_sigma; }

    // A share: all, but for what spikes or a thermometer's coarse steps spoil.
    double nearly_all = 0.9;
    // Times: a telegraph shows at least so many dwell times, and what is called periodic so many periods. The
    // mean of as many independent ones is just seen.
    constexpr double repetitions_least() const { return seen_sigma * seen_sigma; }

    // A factor by which an estimate may leave the plausible range of the effect's definition.
    double beyond_plausible = 2.0;
    // Relative: a stated uncertainty of N, B or K as large as the coefficient, or larger, says no more than
    // this, and it is what one that was stated as nothing has; 1 would allow a coefficient of the other sign.
    double unknown_sd_rel = 0.9;

    // Hz: a slower swing is drift.
    double slowest_line_hz = 0.05;
    // A band's middle frequency over its width at half the height: of less, it is a hump of the noise.
    double band_quality_least = 2.0;
    // Of the frequency's resolution: what a line leaves nearer to itself than that is no other line.
    double same_line_resolutions = 10.0;
    // Ratio of the axes' gains to a noise that they share; below, it is one axis' own.
    double gain_ratio_least = 0.3;
    // Relative: a step that is coarser than the model's by less is the model's; of two axes, a tenth of it.
    double same_step_rel = 0.02;
    // Relative: a smooth distribution of the samples' changes departs by this from its parabola.
    double smoothness_rel = 0.03;

    // Priors of what a model does not state. A gap in the stamps is worth 20 nats in an hour where none is
    // expected; the jitter of stamps, in s; a clock's error in the course of a recording, relative.
    double unexpected_gaps_per_h = 1e-9;
    double unstated_jitter_s = 1e-5;
    double clock_strays_rel = 2e-4;
    // Relative: beyond, a sensor was set to another rate, and its clock has no fault.
    double clock_error_most = 0.1;
    // Correlation of neighbouring stamps' errors; beyond, they are the host's.
    double burst_correlation = 0.3;
    // Relative: how well the white noise of means is known, hardly, so that none of it is a cause.
    double means_white_sd_rel = 0.2;
    // Of the Allan variance at a second, over the model's: a sensor that has it was turned. No noise is
    // thirty times as strong as its model.
    double square_of_motion = 1000.0;
};

inline constexpr DecisionOptions decisions{};

}  // namespace gyrolog
