#include "analysis/denoise/kalman_array.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/denoise/riccati.hpp"
#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/eigen_view.hpp"
#include "analysis/numerics/matrix_products.hpp"
#include "analysis/numerics/orthogonal_complement.hpp"

namespace gyrolog {
namespace {

constexpr int rows_max = static_cast<int>(units_max);
constexpr int states_max = rows_max + 1;

// On the stack, whatever their size; products are spelt lazily so that none asks for a workspace.
template <int rows, int columns>
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, rows, columns>;
using StateMatrix = Small<states_max, states_max>;
using UnitMatrix = Small<rows_max, rows_max>;
using Measured = Small<rows_max, states_max>;
using Gain = Small<states_max, rows_max>;
using StateVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, states_max, 1>;
using UnitVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, rows_max, 1>;

// Beside what one sample says: a standard deviation of 1000 samples' noise is no knowledge.
constexpr double unknown_variances = 1e6;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

Matrix covariance_of(const ArrayNoise& noise, double UnitNoise::*variance,
                     const std::vector<double>& correlation) {
    const std::size_t units = noise.units.size();
    Matrix matrix(units, units);
    for (std::size_t i = 0; i < units; ++i) {
        for (std::size_t j = 0; j < units; ++j) {
            const double together = i == j ? 1.0 : correlation.empty() ? 0.0 : correlation[i * units + j];
            matrix(i, j) = together * std::sqrt(noise.units[i].*variance * noise.units[j].*variance);
        }
    }
    return matrix;
}

double sum_of(std::span<const double> values) { return view_of(values).sum(); }

void make_symmetric(StateMatrix& P) {
    for (Eigen::Index i = 0; i < P.rows(); ++i) {
        for (Eigen::Index j = 0; j < i; ++j) { P(i, j) = P(j, i) = 0.5 * (P(i, j) + P(j, i)); }
    }
}

}  // namespace

struct KalmanArray::State {
    RateModel model = RateModel::free;
    Eigen::Index rate_states = 0;  // before the offsets among the states: 0, 1 or 2
    StateMatrix F, Q;
    Measured H;  // of all units
    UnitMatrix R;
    std::vector<double> drift_weights;

    StateVector x;  // before the measurement; after it between calls
    StateMatrix P;  // before the coming measurement
    StateMatrix P_settled;
    Gain K;        // of all units
    UnitMatrix M;  // innovations' inverse covariance, of a free rate without their common part
    UnitVector a;  // weights of a free rate
    bool settled = false;
    bool first = true;
    double rate = 0.0;
    double rate_variance = 0.0;
    std::array<double, units_max> innovation{};

    Eigen::Index units() const { return R.rows(); }
    bool is_free() const { return model == RateModel::free; }

    void find_settled();
    void set_gain(const Measured& h, const UnitMatrix& r, const StateMatrix& prior);
    void predict();
    double update(const UnitVector& z, const Measured& h);
    double step_settled(std::span<const double> rates);
    double step_varying(std::span<const double> rates, std::span<const std::uint8_t> used);
    void note_innovations(std::span<const double> rates, std::span<const std::uint8_t> used);
    bool has_settled() const;
    double posterior_variance(Eigen::Index i) const;
};

void KalmanArray::State::find_settled() {
    P_settled = Q;
    if (Q.rows() == 0) { return; }
    Matrix seen = matrix_of(H);
    Matrix noise = matrix_of(R);
    if (is_free()) {
        // What differs between the units measures the offsets alone.
        const Matrix across = OrthogonalComplement(std::vector(noise.rows(), 1.0)).basis();
        seen = transposed_product(across, seen);
        noise = product(transposed_product(across, noise), across);
    }
    P_settled = view_of(steady_covariance(matrix_of(F), seen, matrix_of(Q), noise).covariance);
}

// The gain of the units that `h` and `r` tell of.
void KalmanArray::State::set_gain(const Measured& h, const UnitMatrix& r, const StateMatrix& prior) {
    const Gain ph = prior.lazyProduct(h.transpose());
    UnitMatrix s = h.lazyProduct(ph);
    s += r;
    const Eigen::LLT<UnitMatrix> factor(s);
    M.setIdentity(s.rows(), s.cols());
    factor.solveInPlace(M);
    if (is_free()) {
        a = M.rowwise().sum();
        const double sum = a.sum();
        a /= sum;
        rate_variance = 1.0 / sum;
        M -= a.lazyProduct(a.transpose()) * sum;
    }
    K = ph.lazyProduct(M);
}

void KalmanArray::State::predict() {
    if (model == RateModel::trend) { x[0] += x[1]; }
}

double KalmanArray::State::update(const UnitVector& z, const Measured& h) {
    UnitVector e = z;
    e.noalias() -= h.lazyProduct(x);
    if (is_free()) { rate = a.dot(e); }
    x.noalias() += K.lazyProduct(e);
    if (!is_free()) { rate = x[0]; }
    return rate;
}

double KalmanArray::State::step_settled(std::span<const double> rates) {
    UnitVector z(units());
    for (Eigen::Index i = 0; i < units(); ++i) { z[i] = rates[static_cast<std::size_t>(i)]; }
    return update(z, H);
}

double KalmanArray::State::step_varying(std::span<const double> rates, std::span<const std::uint8_t> used) {
    Eigen::Index count = 0;
    std::array<Eigen::Index, units_max> which{};
    for (std::size_t i = 0; i < rates.size(); ++i) {
        if (used[i] != 0) { which.at(static_cast<std::size_t>(count++)) = index(i); }
    }
    if (count == 0) {
        P = F.lazyProduct(P.lazyProduct(F.transpose()).eval()) + Q;
        settled = false;
        if (!is_free()) { rate = x[0]; }
        return rate;
    }
    Measured h(count, H.cols());
    UnitMatrix r(count, count);
    UnitVector z(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Index unit = which.at(static_cast<std::size_t>(i));
        h.row(i) = H.row(unit);
        z[i] = rates[static_cast<std::size_t>(unit)];
        for (Eigen::Index j = 0; j < count; ++j) { r(i, j) = R(unit, which.at(static_cast<std::size_t>(j))); }
    }
    set_gain(h, r, P);
    update(z, h);
    const StateMatrix seen = K.lazyProduct(h.lazyProduct(P).eval());
    P -= seen;
    if (!is_free()) { rate_variance = P(0, 0); }
    make_symmetric(P);
    P = F.lazyProduct(P.lazyProduct(F.transpose()).eval()) + Q;
    settled = count == units() && has_settled();
    if (settled) {
        P = P_settled;
        set_gain(H, R, P_settled);
    }
    return rate;
}

bool KalmanArray::State::has_settled() const {
    constexpr double near = 1e-6;
    for (Eigen::Index i = 0; i < P.rows(); ++i) {
        for (Eigen::Index j = 0; j <= i; ++j) {
            const double size = std::sqrt(P_settled(i, i) * P_settled(j, j));
            if (std::abs(P(i, j) - P_settled(i, j)) > near * size) { return false; }
        }
    }
    return true;
}

void KalmanArray::State::note_innovations(std::span<const double> rates, std::span<const std::uint8_t> used) {
    for (std::size_t i = 0; i < rates.size(); ++i) {
        innovation.at(i) = used[i] == 0 ? 0.0 : rates[i] - H.row(index(i)).dot(x);
    }
}

// After a measurement of all units under the settled gain.
double KalmanArray::State::posterior_variance(Eigen::Index i) const {
    return P_settled(i, i) - K.row(i).dot(H.lazyProduct(P_settled.col(i)));
}

KalmanArray::KalmanArray(const ArrayNoise& noise, const RateDesign& design, FilterGain gain,
                         std::span<const double> offsets)
    : state_(std::make_unique<State>()) {
    State& s = *state_;
    const std::size_t units = noise.units.size();
    const Matrix R = covariance_of(noise, &UnitNoise::white_variance, noise.white_correlation);
    const Matrix walk = covariance_of(noise, &UnitNoise::walk_variance, noise.walk_correlation);
    const std::vector<double> ones(units, 1.0);
    const std::vector<double> shares = CholeskyFactor(walk).solve(ones);
    const double shares_sum = sum_of(shares);
    for (const double share : shares) { s.drift_weights.push_back(share / shares_sum); }
    const Matrix basis = OrthogonalComplement(s.drift_weights).basis();
    const auto U = view_of(basis);
    Matrix less_mean = Matrix::identity(units);
    for (std::size_t j = 0; j < units; ++j) {
        for (double& value : less_mean.column(j)) { value -= s.drift_weights[j]; }
    }
    const Matrix across = transposed_product(basis, less_mean);
    s.model = design.model == RateModel::adaptive ? RateModel::free : design.model;
    s.rate_states = s.is_free() ? 0 : s.model == RateModel::walk ? 1 : 2;
    const Eigen::Index states = s.rate_states + U.cols();
    s.R = view_of(R);
    s.F = StateMatrix::Identity(states, states);
    s.Q = StateMatrix::Zero(states, states);
    s.H = Measured::Zero(index(units), states);
    s.H.rightCols(U.cols()) = U;
    const Matrix offsets_walk = transposed(product_with_transposed(across, product(across, walk)));
    s.Q.bottomRightCorner(U.cols(), U.cols()) = view_of(offsets_walk);
    const double white = 1.0 / sum_of(CholeskyFactor(R).solve(ones));
    const double w = intensity_of(design, noise.rate_hz) * white;
    if (s.rate_states > 0) {
        s.H.col(0).setOnes();
        s.Q(0, 0) = 1.0 / shares_sum;
        s.Q(0, 0) += s.model == RateModel::walk ? w : 0.25 * w;
    }
    if (s.model == RateModel::trend) {
        s.F(0, 1) = 1.0;
        s.Q(0, 1) = s.Q(1, 0) = 0.5 * w;
        s.Q(1, 1) = w;
    }
    s.find_settled();
    s.x = StateVector::Zero(states);
    if (!offsets.empty()) {
        const double mean = dot(s.drift_weights, offsets);
        std::vector<double> about_mean(offsets.begin(), offsets.end());
        for (double& offset : about_mean) { offset -= mean; }
        const std::vector<double> at = transposed_product(basis, about_mean);
        s.x.tail(U.cols()) = view_of(std::span<const double>(at));
    }
    if (gain == FilterGain::steady) {
        s.P = s.P_settled;
        s.settled = true;
        s.set_gain(s.H, s.R, s.P_settled);
        if (!s.is_free()) { s.rate_variance = s.posterior_variance(0); }
    } else {
        s.P = StateMatrix::Identity(states, states) * (unknown_variances * s.R.diagonal().maxCoeff());
    }
}

KalmanArray::~KalmanArray() = default;
KalmanArray::KalmanArray(KalmanArray&&) noexcept = default;
KalmanArray& KalmanArray::operator=(KalmanArray&&) noexcept = default;

std::size_t KalmanArray::units() const { return static_cast<std::size_t>(state_->units()); }

double KalmanArray::step(std::span<const double> rates, std::span<const std::uint8_t> used) {
    State& s = *state_;
    s.predict();
    const bool all = std::ranges::count(used, std::uint8_t{0}) == 0;
    if (s.first && all && s.settled && s.rate_states > 0) {
        // Rather than to come up from 0 by the filter's own time constant.
        double sum = 0.0;
        for (std::size_t i = 0; i < rates.size(); ++i) {
            sum +=
                rates[i] -
                s.H.row(index(i)).tail(s.H.cols() - s.rate_states).dot(s.x.tail(s.H.cols() - s.rate_states));
        }
        s.x[0] = sum / static_cast<double>(rates.size());
    }
    s.first = false;
    s.note_innovations(rates, used);
    return s.settled && all ? s.step_settled(rates) : s.step_varying(rates, used);
}

double KalmanArray::step(std::span<const double> rates) {
    std::array<std::uint8_t, units_max> all{};
    all.fill(1);
    return step(rates, std::span(all).first(rates.size()));
}

void KalmanArray::skip(std::size_t samples) {
    State& s = *state_;
    const Eigen::Index offsets = s.H.cols() - s.rate_states;
    s.P.bottomRightCorner(offsets, offsets) +=
        s.Q.bottomRightCorner(offsets, offsets) * static_cast<double>(samples);
    s.P.topRows(s.rate_states).setZero();
    s.P.leftCols(s.rate_states).setZero();
    for (Eigen::Index i = 0; i < s.rate_states; ++i) {
        s.P(i, i) = unknown_variances * s.R.diagonal().maxCoeff();
    }
    s.x.head(s.rate_states).setZero();
    s.settled = false;
}

double KalmanArray::slope() const { return state_->model == RateModel::trend ? state_->x[1] : 0.0; }

double KalmanArray::slope_sd() const {
    if (state_->model != RateModel::trend) { return 0.0; }
    return std::sqrt(std::max(0.0, state_->settled ? state_->posterior_variance(1) : state_->P(1, 1)));
}

double KalmanArray::offset(std::size_t unit) const {
    const State& s = *state_;
    const Eigen::Index offsets = s.H.cols() - s.rate_states;
    return s.H.row(index(unit)).tail(offsets).dot(s.x.tail(offsets));
}

double KalmanArray::offset_sd(std::size_t unit) const {
    const State& s = *state_;
    const Eigen::Index offsets = s.H.cols() - s.rate_states;
    double variance = 0.0;
    for (Eigen::Index i = s.rate_states; i < s.H.cols(); ++i) {
        for (Eigen::Index j = s.rate_states; j < s.H.cols(); ++j) {
            variance += s.H(index(unit), i) * s.P(i, j) * s.H(index(unit), j);
        }
    }
    return offsets == 0 ? 0.0 : std::sqrt(variance);
}

double KalmanArray::rate_sd() const { return std::sqrt(state_->rate_variance); }

double KalmanArray::settled_rate_sd() const {
    State settled = *state_;
    settled.set_gain(settled.H, settled.R, settled.P_settled);
    return std::sqrt(settled.is_free() ? settled.rate_variance : settled.posterior_variance(0));
}

std::vector<double> KalmanArray::sample_weights() const {
    State settled = *state_;
    settled.set_gain(settled.H, settled.R, settled.P_settled);
    const UnitVector weights = settled.is_free() ? settled.a : UnitVector(settled.K.row(0));
    const double sum = weights.sum();
    std::vector<double> shares(units());
    for (std::size_t i = 0; i < shares.size(); ++i) { shares[i] = weights[index(i)] / sum; }
    return shares;
}

std::vector<double> KalmanArray::drift_weights() const { return state_->drift_weights; }

std::span<const double> KalmanArray::innovations() const {
    return std::span(state_->innovation).first(units());
}

double KalmanArray::innovation_power() const {
    const State& s = *state_;
    if (s.M.rows() != s.units()) { return 0.0; }
    double power = 0.0;
    for (Eigen::Index i = 0; i < s.units(); ++i) {
        for (Eigen::Index j = 0; j < s.units(); ++j) {
            power += s.innovation.at(static_cast<std::size_t>(i)) * s.M(i, j) *
                     s.innovation.at(static_cast<std::size_t>(j));
        }
    }
    return power;
}

bool KalmanArray::is_settled() const { return state_->settled; }

std::vector<double> KalmanArray::covariance() const {
    const StateMatrix& P = state_->P;
    return {P.data(), P.data() + P.size()};
}

std::vector<double> KalmanArray::settled_covariance() const {
    const StateMatrix& P = state_->P_settled;
    return {P.data(), P.data() + P.size()};
}

}  // namespace gyrolog
