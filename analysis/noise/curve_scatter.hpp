// What a model leaves over of a curve that is only known from print: reading errors, and a smooth part
// (curve_model.hpp), as a Gaussian likelihood of the residuals in dB.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

class CurveScatter {
public:
    // `reading_sd_db`: independent from point to point.
    CurveScatter(std::span<const double> tau_s, double reading_sd_db);

    struct Fit {
        double minus_two_log_likelihood = std::numeric_limits<double>::infinity();  // without its constant
        double smooth_sd_db = 0.0;
    };

    // The most likely size of the smooth part.
    Fit fit(std::span<const double> residuals_db) const;

    Matrix covariance(double smooth_sd_db) const;
    // Independent and of variance one, where residuals have that covariance.
    std::vector<double> whitened(std::span<const double> residuals_db, double smooth_sd_db) const;

private:
    std::vector<double> variances(double smooth_sd_db) const;
    double minus_two_log_likelihood(std::span<const double> powers, double smooth_sd_db) const;

    double reading_variance_;
    Matrix vectors_;  // of the smooth part's correlation
    std::vector<double> values_;
};

}  // namespace gyrolog
