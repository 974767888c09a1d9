// An autoregression makes noise of a given density out of white noise:
//   y_k = sum_j a_j y_(k-j) + s w_k.
// Its coefficients follow from the autocovariances by the Durbin-Levinson recursion (P. J. Brockwell,
// R. A. Davis, Time Series: Theory and Methods, 2nd ed. 1991, proposition 5.2.1).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace gyrolog {

class Autoregression {
public:
    // `covariances` r_0 ... r_p are those of a density above zero, over the variance of the white noise. The
    // order is p, or less where nothing is left to predict. The arithmetic is portable.
    explicit Autoregression(std::span<const double> covariances);

    std::size_t order() const { return predictors_.size() - 1; }
    double variance() const { return variance_; }
    // The coefficients a_1 ... a_n of the best prediction from the last n samples, and the standard deviation
    // of its error; n up to the order. With fewer samples than the order the process begins, stationary.
    std::span<const double> predictor(std::size_t n) const { return predictors_[n]; }
    double error_sd(std::size_t n) const { return error_sd_[n]; }
    // The density at a frequency below half the rate, in turns a sample, over that of the white noise.
    double density(double turns) const;

private:
    double variance_;
    std::vector<std::vector<double>> predictors_;
    std::vector<double> error_sd_;
};

// The filter turns white noise into the autoregression's, sample after sample from the first one on.
class AutoregressiveFilter {
public:
    explicit AutoregressiveFilter(std::shared_ptr<const Autoregression> process);

    double variance() const { return process_->variance(); }
    // In place: white noise of any variance.
    void apply(std::span<double> white);

private:
    double prediction(std::size_t n) const;

    std::shared_ptr<const Autoregression> process_;
    std::vector<double> past_;  // twice over, so that the last samples stand in one piece, the latest first
    std::size_t first_ = 0;
    std::size_t seen_ = 0;
};

}  // namespace gyrolog
