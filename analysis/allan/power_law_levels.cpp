#include "analysis/allan/power_law_levels.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "analysis/allan/degrees_of_freedom.hpp"
#include "analysis/allan/difference_covariance.hpp"

namespace gyrolog {
namespace {

constexpr double deviance_of_a_law = 4.0;
constexpr double relative_distrust = 0.05;

using Levels = Eigen::VectorXd;
constexpr auto laws_at_most = static_cast<int>(power_laws);
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, laws_at_most, 1>;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, laws_at_most, laws_at_most>;

struct Curve {
    Eigen::MatrixXd expected;  // point, law: relative to the law's largest
    Eigen::VectorXd measured;  // relative to the largest
    std::vector<DegreesOfFreedom> degrees;
    Eigen::VectorXd edf;
};

struct Fit {
    Levels levels;  // of all laws
    double criterion = std::numeric_limits<double>::infinity();
};

// -2 log likelihood, but for a constant, of chi-square variances.
double deviance(const Curve& curve, const Eigen::VectorXd& model) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < model.size(); ++i) {
        const double ratio = curve.measured[i] / model[i];
        sum += curve.edf[i] * (ratio - 1.0 - std::log(std::max(ratio, 1e-12)));
    }
    return sum;
}

// Scoring: least squares with weights edf / (2 sigma^4) of the model before. Nothing where a level comes out
// negative.
std::optional<Fit> fit_laws(const Curve& curve, const std::vector<Eigen::Index>& laws) {
    const Eigen::MatrixXd design = curve.expected(Eigen::all, laws);
    Eigen::VectorXd model = curve.measured.cwiseMax(1e-9);
    SmallVector levels;
    constexpr int rounds = 6;
    for (int round = 0; round < rounds; ++round) {
        const Eigen::VectorXd weight = curve.edf.cwiseQuotient(model.cwiseAbs2());
        const SmallMatrix normal = design.transpose() * weight.asDiagonal() * design;
        levels = normal.ldlt().solve(design.transpose() * weight.cwiseProduct(curve.measured));
        model = (design * levels).cwiseMax(1e-3 * curve.measured).cwiseMax(1e-12);
    }
    if (!(levels.minCoeff() > 0.0)) { return std::nullopt; }
    Fit fit{Levels::Zero(power_laws),
            deviance(curve, model) + deviance_of_a_law * static_cast<double>(laws.size())};
    fit.levels(laws) = levels;
    return fit;
}

Fit best_fit(const Curve& curve) {
    // In the order in which one is preferred where the curve cannot tell.
    constexpr std::array preference = {PowerLaw::white_rate, PowerLaw::flicker_rate, PowerLaw::rate_walk,
                                       PowerLaw::white_angle, PowerLaw::flicker_angle};
    Fit best;
    for (unsigned set = 1; set < 1U << power_laws; ++set) {
        std::vector<Eigen::Index> laws;
        for (std::size_t i = 0; i < power_laws; ++i) {
            if ((set >> i & 1U) != 0) { laws.push_back(static_cast<Eigen::Index>(index_of(preference[i]))); }
        }
        if (static_cast<Eigen::Index>(laws.size()) > curve.measured.size()) { continue; }
        const std::optional<Fit> fit = fit_laws(curve, laws);
        if (fit && fit->criterion < best.criterion - 1e-9) { best = *fit; }
    }
    return best;
}

VarianceShares shares_at(const Curve& curve, Eigen::Index point, const Levels& levels) {
    VarianceShares shares{};
    for (std::size_t law = 0; law < power_laws; ++law) {
        const auto column = static_cast<Eigen::Index>(law);
        shares[law] = levels[column] * curve.expected(point, column);
    }
    return shares;
}

void set_degrees(Curve& curve, const Levels& levels) {
    for (Eigen::Index i = 0; i < curve.edf.size(); ++i) {
        const double edf = curve.degrees[static_cast<std::size_t>(i)].of(shares_at(curve, i, levels));
        curve.edf[i] = 2.0 / (2.0 / edf + relative_distrust * relative_distrust);
    }
}

}  // namespace

VarianceShares PowerLawLevels::shares(const DeviationRule& rule, std::int64_t m) const {
    VarianceShares shares{};
    for (const PowerLaw law : all_power_laws) {
        const double of_law = level[index_of(law)];
        if (of_law > 0.0) {
            shares[index_of(law)] = of_law * DifferenceCovariance(law, rule, m).expected_variance();
        }
    }
    return shares;
}

PowerLawLevels fit_power_laws(std::span<const AllanPoint> octaves, std::span<const Segment> segments,
                              PhaseConvention convention) {
    const DeviationRule& rule = rule_of(DeviationKind::overlapping);
    PowerLawLevels found;
    found.level[index_of(PowerLaw::white_rate)] = 1.0;
    std::vector<AllanPoint> points(octaves.begin(), octaves.end());
    std::erase_if(points, [](const AllanPoint& p) { return !(p.deviation > 0.0); });
    if (points.empty()) { return found; }

    const auto count = static_cast<Eigen::Index>(points.size());
    Curve curve{Eigen::MatrixXd(count, static_cast<Eigen::Index>(power_laws)),
                Eigen::VectorXd(count),
                {},
                Eigen::VectorXd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
        const AllanPoint& point = points[static_cast<std::size_t>(i)];
        curve.measured[i] = point.deviation * point.deviation;
        for (const PowerLaw law : all_power_laws) {
            curve.expected(i, static_cast<Eigen::Index>(index_of(law))) =
                DifferenceCovariance(law, rule, point.m).expected_variance();
        }
        curve.degrees.emplace_back(all_power_laws, rule, point.m,
                                   terms_of_runs(rule, segments, convention, point.m));
    }
    const Eigen::RowVectorXd unit = curve.expected.colwise().maxCoeff();
    const double measured_unit = curve.measured.maxCoeff();
    curve.expected *= unit.cwiseInverse().asDiagonal();
    curve.measured /= measured_unit;

    Levels levels = Levels::Zero(power_laws);
    levels[static_cast<Eigen::Index>(index_of(PowerLaw::white_rate))] = 1.0;
    constexpr int rounds = 2;  // the degrees of freedom follow from the laws, on which they have little say
    for (int round = 0; round < rounds; ++round) {
        set_degrees(curve, levels);
        levels = best_fit(curve).levels;
    }
    for (std::size_t law = 0; law < power_laws; ++law) {
        const auto column = static_cast<Eigen::Index>(law);
        found.level[law] = levels[column] / unit[column] * measured_unit;
    }
    return found;
}

}  // namespace gyrolog
