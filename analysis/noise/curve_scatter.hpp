// What a model leaves over of a curve that is only known from print: reading errors, and a smooth part
// (curve_model.hpp), as a Gaussian likelihood of the residuals in dB.
#pragma once

#include <Eigen/Dense>
#include <limits>
#include <span>

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
    Fit fit(const Eigen::VectorXd& residuals_db) const;

    Eigen::MatrixXd covariance(double smooth_sd_db) const;
    // Independent and of variance one, where residuals have that covariance.
    Eigen::VectorXd whitened(const Eigen::VectorXd& residuals_db, double smooth_sd_db) const;

private:
    Eigen::VectorXd variances(double smooth_sd_db) const;
    double minus_two_log_likelihood(const Eigen::VectorXd& powers, double smooth_sd_db) const;

    double reading_variance_;
    Eigen::MatrixXd vectors_;  // of the smooth part's correlation
    Eigen::VectorXd values_;
};

}  // namespace gyrolog
