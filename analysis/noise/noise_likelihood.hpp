// Likelihood of a record under a sum of Gaussian noises, each with a known shape and an unknown square.
//
// The contrasts of the pyramid's levels (contrast_pyramid.hpp) are taken as independent, with exactly
// expected squares; the top's averages are taken with their exact covariance matrix, but for their mean (and,
// on request, a linear ramp), which is projected out: restricted likelihood (Patterson and Thompson,
// Biometrika 58 (1971) 545-554). With theta_j the squares of the coefficients,
//   levels: -n/2 sum (ln e + P / e),  e = sum theta_j E_j
//   top:    -1/2 (ln det C + z' C^-1 z),  C = sum theta_j C_j
// in which everything is linear in theta, so that gradient and information are closed forms.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "analysis/noise/average_covariance.hpp"
#include "analysis/noise/contrast_pyramid.hpp"
#include "analysis/numerics/matrix.hpp"
#include "analysis/numerics/orthogonal_complement.hpp"

namespace gyrolog {

// How well the model describes the contrasts of one kind.
struct ContrastMisfit {
    double f_hz = 0.0;   // middle of their pass band
    double dof = 0.0;    // contrasts averaged
    double ratio = 0.0;  // measured over expected square
};

struct RampEstimate {
    double slope_per_s = 0.0;  // unit of the column per second
    double sd_per_s = 0.0;
};

class NoiseLikelihood {
public:
    // With `free_ramp` a ramp's slope is estimated beside the noise.
    NoiseLikelihood(const ContrastPyramid& pyramid, bool free_ramp);

    void add(const AverageCovariance& noise);
    void remove_last();
    std::size_t components() const { return matrices_.size(); }

    // Contrasts above this frequency do not count.
    void limit_frequency(double f_hz);
    // A departure of this relative size (one standard deviation) of any expected square from the model's is
    // no surprise. Without it a real sensor's smallest imperfection at high frequencies, where contrasts are
    // many, would be paid for by the slow noises.
    void tolerate(double relative_error);

    struct Evaluation {
        double value = 0.0;  // -inf where no such noise can be
        std::vector<double> gradient;
        Matrix information;  // top: average of observed and expected
    };
    double value(std::span<const double> squares) const;
    Evaluation evaluate(std::span<const double> squares) const;
    Matrix expected_information(std::span<const double> squares) const;

    // Misfit of the levels' contrasts that count, by rising frequency, and of the top's whitened averages in
    // bands.
    std::vector<ContrastMisfit> misfits(std::span<const double> squares) const;
    RampEstimate ramp(std::span<const double> squares) const;  // needs free_ramp

private:
    struct Contrast {
        double f_hz;
        double dof;
        double power;
        double ramp_square;  // its square for a ramp of slope 1
        bool counts = true;
    };
    struct Inverse;
    struct Point;
    Point point_at(std::span<const double> squares) const;
    double weight_of(const Contrast& contrast) const;
    std::vector<double> expected(std::span<const double> squares) const;
    Matrix covariance(std::span<const double> squares) const;
    // Of each component, of one contrast.
    std::vector<double> relative_expectations(std::size_t contrast, double square) const;
    std::vector<double> level_expectation(const AverageCovariance& noise) const;
    Matrix top_covariance(const AverageCovariance& noise) const;

    const ContrastPyramid& pyramid_;
    double relative_error_ = 0.0;
    std::vector<Contrast> contrasts_;
    std::vector<std::vector<double>> expectations_;  // of each component, by contrast
    std::vector<double> top_;                        // projected averages
    std::vector<double> ramp_;                       // projected ramp of slope 1, with free_ramp
    std::optional<OrthogonalComplement> projection_;
    std::vector<Matrix> matrices_;  // projected covariance of each component
};

}  // namespace gyrolog
