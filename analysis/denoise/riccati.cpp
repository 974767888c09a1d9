#include "analysis/denoise/riccati.hpp"

#include <Eigen/Dense>

namespace gyrolog {

SteadyCovariance steady_covariance(const Eigen::MatrixXd& F, const Eigen::MatrixXd& H,
                                   const Eigen::MatrixXd& Q, const Eigen::MatrixXd& R) {
    constexpr int doublings_most = 60;
    constexpr double tolerance = 1e-13;
    SteadyCovariance steady;
    const Eigen::Index states = F.rows();
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(states, states);
    Eigen::MatrixXd A = F.transpose();
    Eigen::MatrixXd G = H.transpose() * R.llt().solve(H);
    steady.covariance = Q;
    Eigen::MatrixXd& X = steady.covariance;
    for (; steady.doublings < doublings_most && !steady.settled; ++steady.doublings) {
        const Eigen::PartialPivLU<Eigen::MatrixXd> W(identity + G * X);
        const Eigen::MatrixXd WA = W.solve(A);
        const Eigen::MatrixXd growth = A.transpose() * X * WA;
        G += A * W.solve(G) * A.transpose();
        A = A * WA;
        X += growth;
        X = (0.5 * (X + X.transpose())).eval();
        G = (0.5 * (G + G.transpose())).eval();
        if (!X.allFinite()) { return steady; }
        steady.settled = growth.norm() <= tolerance * X.norm();
    }
    return steady;
}

}  // namespace gyrolog
