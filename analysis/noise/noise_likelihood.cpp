#include "analysis/noise/noise_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/log_sum_exp.hpp"
#include "analysis/numerics/matrix_products.hpp"
#include "analysis/numerics/symmetric_eigen.hpp"

namespace gyrolog {
namespace {

using Vector = std::vector<double>;

void add_scaled(Matrix& sum, double factor, const Matrix& matrix) {
    const std::span<double> values = sum.values();
    for (std::size_t i = 0; i < values.size(); ++i) { values[i] += factor * matrix.values()[i]; }
}

}  // namespace

// C^-1 with the ramp's direction taken out.
struct NoiseLikelihood::Inverse {
    CholeskyFactor factor;
    Vector ramp;               // C^-1 x
    double ramp_weight = 0.0;  // x' C^-1 x; 0 without a ramp

    Inverse(const Matrix& covariance, std::span<const double> x) : factor(covariance) {
        if (!factor.is_positive_definite() || x.empty()) { return; }
        ramp = factor.solve(x);
        ramp_weight = dot(x, ramp);
    }
    Vector of(std::span<const double> right) const {
        Vector solved = factor.solve(right);
        if (!(ramp_weight > 0.0)) { return solved; }
        const double slope = slope_of(right);
        for (std::size_t i = 0; i < solved.size(); ++i) { solved[i] -= ramp[i] * slope; }
        return solved;
    }
    Matrix matrix() const {
        Matrix inverse = factor.inverse();
        if (!(ramp_weight > 0.0)) { return inverse; }
        for (std::size_t j = 0; j < ramp.size(); ++j) {
            for (std::size_t i = 0; i < ramp.size(); ++i) {
                inverse(i, j) -= ramp[j] * ramp[i] / ramp_weight;
            }
        }
        return inverse;
    }
    double log_determinant() const {
        const double sum = factor.log_determinant();
        return ramp_weight > 0.0 ? sum + std::log(ramp_weight) : sum;
    }
    // Of the ramp in what was measured; needs a ramp.
    double slope_of(std::span<const double> measured) const { return dot(ramp, measured) / ramp_weight; }
};

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
    if (pyramid.top.size() < 3) { return; }
    Vector values;
    Vector times_s;
    for (const TopAverage& average : pyramid.top) {
        values.push_back(average.value);
        times_s.push_back(static_cast<double>(average.index) * static_cast<double>(pyramid.top_span) /
                          rate_hz);
    }
    projection_.emplace(Vector(pyramid.top.size(), 1.0));
    top_ = projection_->of(values);
    if (free_ramp) { ramp_ = projection_->of(times_s); }
}

Vector NoiseLikelihood::level_expectation(const AverageCovariance& noise) const {
    Vector squares;
    squares.reserve(contrasts_.size());
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
            squares.push_back(std::max(sum, 0.0));
        }
    }
    return squares;
}

Matrix NoiseLikelihood::top_covariance(const AverageCovariance& noise) const {
    const std::size_t size = pyramid_.top.size();
    const double span_s = static_cast<double>(pyramid_.top_span) / pyramid_.rate_hz;
    const auto& top = pyramid_.top;
    std::vector<double> by_lag;
    for (std::int64_t lag = 0; lag <= top.back().index - top.front().index; ++lag) {
        by_lag.push_back(noise.of_unit_square(lag, span_s));
    }
    Matrix covariance(size, size);
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) {
            const std::int64_t lag = top[i].index - top[j].index;
            covariance(i, j) = by_lag[static_cast<std::size_t>(std::abs(lag))];
        }
        if (noise.per_sample) {
            covariance(i, i) *= static_cast<double>(pyramid_.top_span) / static_cast<double>(top[i].samples);
        }
    }
    return covariance;
}

void NoiseLikelihood::add(const AverageCovariance& noise) {
    expectations_.push_back(level_expectation(noise));
    matrices_.push_back(projection_ ? projection_->of_covariance(top_covariance(noise)) : Matrix());
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

Vector NoiseLikelihood::expected(std::span<const double> squares) const {
    Vector sum(contrasts_.size(), 0.0);
    for (std::size_t j = 0; j < squares.size(); ++j) {
        for (std::size_t c = 0; c < sum.size(); ++c) { sum[c] += squares[j] * expectations_[j][c]; }
    }
    return sum;
}

Matrix NoiseLikelihood::covariance(std::span<const double> squares) const {
    Matrix sum(top_.size(), top_.size());
    for (std::size_t j = 0; j < squares.size(); ++j) { add_scaled(sum, squares[j], matrices_[j]); }
    return sum;
}

Vector NoiseLikelihood::relative_expectations(std::size_t contrast, double square) const {
    Vector relative;
    relative.reserve(expectations_.size());
    for (const Vector& expectation : expectations_) { relative.push_back(expectation[contrast] / square); }
    return relative;
}

// What the value and its derivatives are worked out from.
struct NoiseLikelihood::Point {
    double value = minus_infinity;
    std::optional<Inverse> inverse;  // of the top
    Vector weighted;                 // C^-1 z
    Vector level_squares;            // by contrast, with the ramp's
};

NoiseLikelihood::Point NoiseLikelihood::point_at(std::span<const double> squares) const {
    Point point;
    double sum = 0.0;
    double ramp_square = 0.0;
    if (!top_.empty()) {
        const Inverse& inverse = point.inverse.emplace(covariance(squares), ramp_);
        if (!inverse.factor.is_positive_definite()) { return point; }
        point.weighted = inverse.of(top_);
        sum -= 0.5 * (inverse.log_determinant() + dot(top_, point.weighted));
        if (!ramp_.empty()) { ramp_square = std::pow(inverse.slope_of(top_), 2); }
    }
    point.level_squares = expected(squares);
    for (std::size_t c = 0; c < contrasts_.size(); ++c) {
        double& square = point.level_squares[c];
        square += ramp_square * contrasts_[c].ramp_square;
        const double weight = weight_of(contrasts_[c]);
        if (weight == 0.0) { continue; }
        if (!(square > 0.0)) { return point; }
        sum -= weight * (std::log(square) + contrasts_[c].power / square);
    }
    if (std::isfinite(sum)) { point.value = sum; }
    return point;
}

double NoiseLikelihood::value(std::span<const double> squares) const { return point_at(squares).value; }

NoiseLikelihood::Evaluation NoiseLikelihood::evaluate(std::span<const double> squares) const {
    const std::size_t count = components();
    const Point point = point_at(squares);
    Evaluation at{point.value, Vector(count, 0.0), Matrix(count, count)};
    if (!std::isfinite(at.value)) { return at; }
    if (point.inverse) {
        const Matrix full = point.inverse->matrix();
        Matrix pulled(top_.size(), count);
        for (std::size_t j = 0; j < count; ++j) {
            const Vector column = product(matrices_[j], point.weighted);
            std::ranges::copy(column, pulled.column(j).begin());
            at.gradient[j] = 0.5 * (dot(point.weighted, column) - dot(full.values(), matrices_[j].values()));
        }
        // The average of observed and expected information of a linear covariance model.
        add_scaled(at.information, 0.5, product(transposed_product(pulled, full), pulled));
    }
    for (std::size_t c = 0; c < contrasts_.size(); ++c) {
        const double weight = weight_of(contrasts_[c]);
        if (weight == 0.0) { continue; }
        const Vector relative = relative_expectations(c, point.level_squares[c]);
        const double excess = weight * (contrasts_[c].power / point.level_squares[c] - 1.0);
        for (std::size_t j = 0; j < count; ++j) { at.gradient[j] += excess * relative[j]; }
        add_square(at.information, weight, relative);
    }
    return at;
}

Matrix NoiseLikelihood::expected_information(std::span<const double> squares) const {
    const std::size_t count = components();
    Matrix information(count, count);
    if (!top_.empty()) {
        const Matrix full = Inverse(covariance(squares), ramp_).matrix();
        std::vector<Matrix> products;
        products.reserve(matrices_.size());
        for (const Matrix& matrix : matrices_) { products.push_back(product(full, matrix)); }
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                information(i, j) = information(j, i) = 0.5 * trace_of_product(products[i], products[j]);
            }
        }
    }
    const Vector e = expected(squares);
    for (std::size_t c = 0; c < contrasts_.size(); ++c) {
        const double weight = weight_of(contrasts_[c]);
        if (weight == 0.0) { continue; }
        add_square(information, weight, relative_expectations(c, e[c]));
    }
    return information;
}

std::vector<ContrastMisfit> NoiseLikelihood::misfits(std::span<const double> squares) const {
    std::vector<ContrastMisfit> all;
    const RampEstimate slope = !ramp_.empty() ? ramp(squares) : RampEstimate{};
    if (!top_.empty()) {
        Vector rest = top_;
        for (std::size_t i = 0; i < ramp_.size(); ++i) { rest[i] -= slope.slope_per_s * ramp_[i]; }
        const SymmetricEigen axes = symmetric_eigen(covariance(squares));
        const std::size_t size = top_.size();
        const double length_s =
            static_cast<double>(pyramid_.top.back().index - pyramid_.top.front().index + 1) *
            static_cast<double>(pyramid_.top_span) / pyramid_.rate_hz;
        const Vector along = transposed_product(axes.vectors, rest);
        // Largest variance first: of a red noise that is the lowest frequency first.
        for (std::size_t first = 0; first < size; first = 2 * first + 1) {
            const std::size_t end = std::min(2 * first + 1, size);
            double sum = 0.0;
            for (std::size_t k = first; k < end; ++k) {
                sum += along[size - 1 - k] * along[size - 1 - k] / axes.values[size - 1 - k];
            }
            const auto dof = static_cast<double>(end - first);
            all.push_back({0.5 * static_cast<double>(first + 1 + end) / 2.0 / length_s, dof, sum / dof});
        }
    }
    const Vector e = expected(squares);
    for (std::size_t c = 0; c < contrasts_.size(); ++c) {
        const Contrast& contrast = contrasts_[c];
        if (!(contrast.dof > 0.0)) { continue; }
        const double square = e[c] + slope.slope_per_s * slope.slope_per_s * contrast.ramp_square;
        all.push_back({contrast.f_hz, contrast.dof, contrast.power / square});
    }
    std::ranges::sort(all, {}, &ContrastMisfit::f_hz);
    return all;
}

RampEstimate NoiseLikelihood::ramp(std::span<const double> squares) const {
    const Inverse inverse(covariance(squares), ramp_);
    return {inverse.slope_of(top_), 1.0 / std::sqrt(inverse.ramp_weight)};
}

}  // namespace gyrolog
