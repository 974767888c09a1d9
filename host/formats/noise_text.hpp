// Noise models for people: rows of a table with a column for each fit, and terms in a line.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/noise/analyze.hpp"
#include "analysis/noise/curve_model.hpp"
#include "analysis/noise/slope_reading.hpp"
#include "host/formats/text_table.hpp"

namespace gyrolog {

struct FitOfColumn {
    const NoiseFit* fit;
    const SlopeReading* slopes;
};

// A value with its uncertainty: with_uncertainty or in_short_form.
using UncertaintyForm = std::string (*)(double value, double uncertainty);

// "0.013144(21)"; of a term that is not identifiable "< 1.2e-05", its upper limit.
std::string coefficient_text(const FittedCoefficient& fitted, double scale, UncertaintyForm form);

// N, B, K, Q, R in the unit given, N also per root hour and a gyro's B per hour; the least uncertainty
// possible where it is known; Gauss-Markov noise and sinusoids where a fit has some; the readings of slopes.
std::vector<TextRow> noise_rows(std::span<const FitOfColumn> columns, const SensorUnit& unit);

// Of these the rows of Gauss-Markov noise and sinusoids, and those of the slopes.
std::vector<TextRow> shaped_rows(std::span<const FitOfColumn> columns, const SensorUnit& unit,
                                 UncertaintyForm form);
std::vector<TextRow> slope_rows(std::span<const FitOfColumn> columns, const SensorUnit& unit);

// N, B and K in SI, the units of simulators and filters; no row for counts, and for rad/s, which is SI.
std::vector<TextRow> si_rows(std::span<const FitOfColumn> columns, const SensorUnit& unit);

// "N 0.0178 dps/sqrt(Hz)", "Gauss-Markov 0.0026 dps, T 7.1 s", "sinusoid 0.0065 dps, period 5.7 h"
std::string term_text(const CurveTerm& term, const SensorUnit& unit);

}  // namespace gyrolog
