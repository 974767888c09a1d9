#include "analysis/noise/noise_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gyrolog {
namespace {

constexpr double minus_infinity = -std::numeric_limits<double>::infinity();

// The orthogonal complement of the constant: Householder's reflection, applied to vectors and from both sides
// to matrices.
Eigen::VectorXd projected(const Eigen::HouseholderQR<Eigen::MatrixXd>& reflection, Eigen::VectorXd x) {
    x.applyOnTheLeft(reflection.householderQ().adjoint());
    return x.tail(x.size() - 1);
}

Eigen::MatrixXd projected(const Eigen::HouseholderQR<Eigen::MatrixXd>& reflection, Eigen::MatrixXd x) {
    x.applyOnTheLeft(reflection.householderQ().adjoint());
    x.applyOnTheRight(reflection.householderQ());
    return x.bottomRightCorner(x.rows() - 1, x.cols() - 1);
}

// C^-1 with the ramp's direction taken out.
struct Inverse {
    Eigen::LLT<Eigen::MatrixXd> factor;
    Eigen::VectorXd ramp;      // C^-1 x
    double ramp_weight = 0.0;  // x' C^-1 x; 0 without a ramp

    Eigen::VectorXd of(const Eigen::VectorXd& right) const {
        Eigen::VectorXd solved = factor.solve(right);
        if (ramp_weight > 0.0) { solved -= ramp * (ramp.dot(right) / ramp_weight); }
        return solved;
    }
    Eigen::MatrixXd matrix(Eigen::Index size) const {
        Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(size, size));
        if (ramp_weight > 0.0) { inverse -= ramp * ramp.transpose() / ramp_weight; }
        return inverse;
    }
    double log_determinant() const {
        double sum = 0.0;
        for (Eigen::Index i = 0; i < factor.rows(); ++i) { sum += 2.0 * std::log(factor.matrixLLT()(i, i)); }
        return ramp_weight > 0.0 ? sum + std::log(ramp_weight) : sum;
    }
};

Inverse inverse_of(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& ramp) {
    Inverse inverse{Eigen::LLT<Eigen::MatrixXd>(covariance), {}, 0.0};
    if (inverse.factor.info() == Eigen::Success && ramp.size() > 0) {
        inverse.ramp = inverse.factor.solve(ramp);
        inverse.ramp_weight = ramp.dot(inverse.ramp);
    }
    return inverse;
}

}  // namespace

NoiseLikelihood::NoiseLikelihood(const ContrastPyramid& pyramid, bool free_ramp) : pyramid_(pyramid) {
    const double rate_hz = pyramid.rate_hz;
    for (const ContrastLevel& level : pyramid.levels) {
        const double span_s = static_cast<double>(level.span) / rate_hz;
        const auto rows = cosine_contrasts(level.length);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            double ramp = 0.0;
            for (std::size_t i = 0; i < rows[k].size(); ++i) { ramp += rows[k][i] * static_cast<double>(i); }
            contrasts_.push_back({static_cast<double>(k + 1) / (2.0 * level.length * span_s),
                                  static_cast<double>(level.blocks), level.power[k],
                                  ramp * span_s * ramp * span_s, level.blocks > 0});
        }
    }
    const auto size = static_cast<Eigen::Index>(pyramid.top.size());
    if (size < 3) { return; }
    Eigen::VectorXd values(size);
    Eigen::VectorXd times_s(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        const TopAverage& average = pyramid.top[static_cast<std::size_t>(i)];
        values[i] = average.value;
        times_s[i] = static_cast<double>(average.index) * static_cast<double>(pyramid.top_span) / rate_hz;
    }
    projection_.compute(Eigen::MatrixXd::Ones(size, 1));
    top_ = projected(projection_, std::move(values));
    if (free_ramp) { ramp_ = projected(projection_, std::move(times_s)); }
}

Eigen::VectorXd NoiseLikelihood::level_expectation(const AverageCovariance& noise) const {
    Eigen::VectorXd squares(static_cast<Eigen::Index>(contrasts_.size()));
    Eigen::Index at = 0;
    for (const ContrastLevel& level : pyramid_.levels) {
        const double span_s = static_cast<double>(level.span) / pyramid_.rate_hz;
        std::vector<double> by_lag;
        by_lag.reserve(static_cast<std::size_t>(level.length));
        for (int lag = 0; lag < level.length; ++lag) { by_lag.push_back(noise.of_unit_square(lag, span_s)); }
        for (const auto& row : cosine_contrasts(level.length)) {
            double sum = 0.0;
            for (std::size_t a = 0; a < row.size(); ++a) {
                for (std::size_t b = 0; b < row.size(); ++b) {
                    sum += row[a] * row[b] * by_lag[a > b ? a - b : b - a];
                }
            }
            squares[at++] = std::max(sum, 0.0);
        }
    }
    return squares;
}

Eigen::MatrixXd NoiseLikelihood::top_covariance(const AverageCovariance& noise) const {
    const auto size = static_cast<Eigen::Index>(pyramid_.top.size());
    const double span_s = static_cast<double>(pyramid_.top_span) / pyramid_.rate_hz;
    const auto& top = pyramid_.top;
    std::vector<double> by_lag;
    for (std::int64_t lag = 0; lag <= top.back().index - top.front().index; ++lag) {
        by_lag.push_back(noise.of_unit_square(lag, span_s));
    }
    Eigen::MatrixXd covariance(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        for (Eigen::Index j = 0; j < size; ++j) {
            const std::int64_t lag =
                top[static_cast<std::size_t>(i)].index - top[static_cast<std::size_t>(j)].index;
            covariance(i, j) = by_lag[static_cast<std::size_t>(std::abs(lag))];
        }
        if (noise.per_sample) {
            covariance(i, i) *= static_cast<double>(pyramid_.top_span) /
                                static_cast<double>(top[static_cast<std::size_t>(i)].samples);
        }
    }
    return covariance;
}

void NoiseLikelihood::add(const AverageCovariance& noise) {
    expectations_.push_back(level_expectation(noise));
    matrices_.push_back(top_.size() > 0 ? projected(projection_, top_covariance(noise)) : Eigen::MatrixXd());
}

void NoiseLikelihood::remove_last() {
    expectations_.pop_back();
    matrices_.pop_back();
}

void NoiseLikelihood::limit_frequency(double f_hz) {
    for (Contrast& contrast : contrasts_) { contrast.counts = contrast.dof > 0.0 && contrast.f_hz <= f_hz; }
}

void NoiseLikelihood::tolerate(double relative_error) { relative_error_ = relative_error; }

double NoiseLikelihood::weight_of(const Contrast& contrast) const {
    if (!contrast.counts) { return 0.0; }
    // The variance of P / e is 2 / dof from chance, and the tolerated error's.
    return contrast.dof / (2.0 + contrast.dof * relative_error_ * relative_error_);
}

Eigen::VectorXd NoiseLikelihood::expected(const Eigen::VectorXd& squares) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(contrasts_.size()));
    for (Eigen::Index j = 0; j < squares.size(); ++j) {
        sum += squares[j] * expectations_[static_cast<std::size_t>(j)];
    }
    return sum;
}

Eigen::MatrixXd NoiseLikelihood::covariance(const Eigen::VectorXd& squares) const {
    Eigen::MatrixXd sum = squares[0] * matrices_[0];
    for (Eigen::Index j = 1; j < squares.size(); ++j) {
        sum += squares[j] * matrices_[static_cast<std::size_t>(j)];
    }
    return sum;
}

double NoiseLikelihood::value(const Eigen::VectorXd& squares) const {
    double sum = 0.0;
    Inverse inverse;
    double ramp_square = 0.0;
    if (top_.size() > 0) {
        inverse = inverse_of(covariance(squares), ramp_);
        if (inverse.factor.info() != Eigen::Success) { return minus_infinity; }
        sum -= 0.5 * (inverse.log_determinant() + top_.dot(inverse.of(top_)));
        if (ramp_.size() > 0) { ramp_square = std::pow(inverse.ramp.dot(top_) / inverse.ramp_weight, 2); }
    }
    const Eigen::VectorXd e = expected(squares);
    for (std::size_t c = 0; c < contrasts_.size(); ++c) {
        const double weight = weight_of(contrasts_[c]);
        if (weight == 0.0) { continue; }
        const double square = e[static_cast<Eigen::Index>(c)] + ramp_square * contrasts_[c].ramp_square;
        if (!(square > 0.0)) { return minus_infinity; }
        sum -= weight * (std::log(square) + contrasts_[c].power / square);
    }
    return std::isfinite(sum) ? sum : minus_infinity;
}

NoiseLikelihood::Evaluation NoiseLikelihood::evaluate(const Eigen::VectorXd& squares) const {
    const Eigen::Index count = components();
    Evaluation at{value(squares), Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
    if (!std::isfinite(at.value)) { return at; }
    double ramp_square = 0.0;
    if (top_.size() > 0) {
        const Inverse inverse = inverse_of(covariance(squares), ramp_);
        const Eigen::VectorXd weighted = inverse.of(top_);
        const Eigen::MatrixXd full = inverse.matrix(top_.size());
        if (ramp_.size() > 0) { ramp_square = std::pow(inverse.ramp.dot(top_) / inverse.ramp_weight, 2); }
        Eigen::MatrixXd pulled(top_.size(), count);
        for (Eigen::Index j = 0; j < count; ++j) {
            const Eigen::MatrixXd& matrix = matrices_[static_cast<std::size_t>(j)];
            pulled.col(j) = matrix * weighted;
            at.gradient[j] = 0.5 * (weighted.dot(pulled.col(j)) - full.cwiseProduct(matrix).sum());
        }
        // The average of observed and expected information of a linear covariance model.
        at.information = 0.5 * pulled.transpose() * full * pulled;
    }
    const Eigen::VectorXd e = expected(squares);
    for (std::size_t c = 0; c < contrasts_.size(); ++c) {
        const double weight = weight_of(contrasts_[c]);
        if (weight == 0.0) { continue; }
        const auto row = static_cast<Eigen::Index>(c);
        const double square = e[row] + ramp_square * contrasts_[c].ramp_square;
        Eigen::VectorXd relative(count);
        for (Eigen::Index j = 0; j < count; ++j) {
            relative[j] = expectations_[static_cast<std::size_t>(j)][row] / square;
        }
        at.gradient += weight * (contrasts_[c].power / square - 1.0) * relative;
        at.information += weight * relative * relative.transpose();
    }
    return at;
}

Eigen::MatrixXd NoiseLikelihood::expected_information(const Eigen::VectorXd& squares) const {
    const Eigen::Index count = components();
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
    if (top_.size() > 0) {
        const Eigen::MatrixXd full = inverse_of(covariance(squares), ramp_).matrix(top_.size());
        std::vector<Eigen::MatrixXd> products;
        for (const Eigen::MatrixXd& matrix : matrices_) { products.emplace_back(full * matrix); }
        for (Eigen::Index i = 0; i < count; ++i) {
            for (Eigen::Index j = 0; j <= i; ++j) {
                const double trace = products[static_cast<std::size_t>(i)]
                                         .cwiseProduct(products[static_cast<std::size_t>(j)].transpose())
                                         .sum();
                information(i, j) = information(j, i) = 0.5 * trace;
            }
        }
    }
    const Eigen::VectorXd e = expected(squares);
    for (std::size_t c = 0; c < contrasts_.size(); ++c) {
        const auto row = static_cast<Eigen::Index>(c);
        const double weight = weight_of(contrasts_[c]);
        if (weight == 0.0) { continue; }
        Eigen::VectorXd relative(count);
        for (Eigen::Index j = 0; j < count; ++j) {
            relative[j] = expectations_[static_cast<std::size_t>(j)][row] / e[row];
        }
        information += weight * relative * relative.transpose();
    }
    return information;
}

std::vector<ContrastMisfit> NoiseLikelihood::misfits(const Eigen::VectorXd& squares) const {
    std::vector<ContrastMisfit> all;
    const RampEstimate slope = ramp_.size() > 0 ? ramp(squares) : RampEstimate{};
    if (top_.size() > 0) {
        const Eigen::VectorXd rest =
            ramp_.size() > 0 ? Eigen::VectorXd(top_ - slope.slope_per_s * ramp_) : top_;
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance(squares));
        const Eigen::Index size = top_.size();
        const double length_s =
            static_cast<double>(pyramid_.top.back().index - pyramid_.top.front().index + 1) *
            static_cast<double>(pyramid_.top_span) / pyramid_.rate_hz;
        const Eigen::VectorXd along = axes.eigenvectors().transpose() * rest;
        // Largest variance first: of a red noise that is the lowest frequency first.
        for (Eigen::Index first = 0; first < size; first = 2 * first + 1) {
            const Eigen::Index end = std::min(2 * first + 1, size);
            double sum = 0.0;
            for (Eigen::Index k = first; k < end; ++k) {
                sum += along[size - 1 - k] * along[size - 1 - k] / axes.eigenvalues()[size - 1 - k];
            }
            const auto dof = static_cast<double>(end - first);
            all.push_back({0.5 * static_cast<double>(first + 1 + end) / 2.0 / length_s, dof, sum / dof});
        }
    }
    const Eigen::VectorXd e = expected(squares);
    for (std::size_t c = 0; c < contrasts_.size(); ++c) {
        const Contrast& contrast = contrasts_[c];
        if (!(contrast.dof > 0.0)) { continue; }
        const double square =
            e[static_cast<Eigen::Index>(c)] + slope.slope_per_s * slope.slope_per_s * contrast.ramp_square;
        all.push_back({contrast.f_hz, contrast.dof, contrast.power / square});
    }
    std::ranges::sort(all, {}, &ContrastMisfit::f_hz);
    return all;
}

RampEstimate NoiseLikelihood::ramp(const Eigen::VectorXd& squares) const {
    const Inverse inverse = inverse_of(covariance(squares), ramp_);
    return {inverse.ramp.dot(top_) / inverse.ramp_weight, 1.0 / std::sqrt(inverse.ramp_weight)};
}

}  // namespace gyrolog
