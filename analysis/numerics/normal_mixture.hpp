// Mixtures of normal distributions about zero: how the white noise of a sensor may be distributed.
#pragma once

#include <vector>

namespace gyrolog {

class NormalMixture {
public:
    // A sum of independent parts, of variance 1 in all. `share` of the variance has Student's t distribution
    // with nu degrees of freedom (above 2; infinity: normal), a converter with the step `lattice` adds its
    // error, the rest is normal. Student's t is a normal of which the precision is gamma distributed with
    // shape and rate nu / 2 (Johnson, Kotz, Balakrishnan, Continuous Univariate Distributions vol. 2, 28.1).
    NormalMixture(double nu, double share, double lattice);

    double log_density(double x) const;
    double probability_below(double x) const;

private:
    struct Part {
        double weight;
        double log_weight_over_sd;
        double sd;
        double shift;
    };
    void add(double log_weight, double sd, double shift);

    std::vector<Part> parts_;
};

// The logarithm of a mixture's density between -1e4 and 1e4, fast: cubic between points even in asinh(2 x).
class LogDensityTable {
public:
    explicit LogDensityTable(const NormalMixture& mixture);
    double operator()(double x) const;

private:
    std::vector<double> values_;
};

}  // namespace gyrolog
