#include "analysis/calibrate/pose_advice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/calibrate/knowledge.hpp"
#include "analysis/calibrate/sensor_matrix.hpp"

namespace gyrolog {
namespace {

struct BoxPose {
    Vector3 up;
    std::string words;
};

std::string words_of(const std::array<int, 3>& signs) {
    std::vector<std::string> axes;
    for (std::size_t axis = 0; axis < signs.size(); ++axis) {
        if (signs[axis] != 0) {
            axes.push_back((signs[axis] < 0 ? "-" : "") + std::string(axis_names[axis]));
        }
    }
    if (axes.size() == 1) { return axes[0] + " up"; }
    if (axes.size() == 2) { return "the edge between " + axes[0] + " and " + axes[1] + " up"; }
    return "the corner of " + axes[0] + ", " + axes[1] + " and " + axes[2] + " up";
}

std::vector<BoxPose> poses_of_a_box() {
    std::vector<BoxPose> poses;
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                const Vector3 up{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
                if (norm(up) == 0.0) { continue; }
                poses.push_back({scaled(up, 1.0 / norm(up)), words_of({x, y, z})});
            }
        }
    }
    // Faces first: of poses that are equally good, the one that stands by itself.
    std::ranges::stable_sort(poses, {}, [](const BoxPose& pose) { return pose.words.size(); });
    return poses;
}

// Of a pose's residual, in its sigma. The covariance is in the units of the prior deviations.
double foreseen_variance(const Matrix& covariance, std::span<const double> prior_sd,
                         std::span<const double> row) {
    double sum = 0.0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        for (std::size_t j = 0; j < row.size(); ++j) {
            sum += row[i] * prior_sd[i] * covariance(i, j) * prior_sd[j] * row[j];
        }
    }
    return sum;
}

}  // namespace

std::vector<PoseAdvice> advise_poses(const Matrix& information, std::span<const double> prior_sd,
                                     double share_most, const PoseDerivatives& derivatives, std::size_t poses,
                                     std::size_t poses_most) {
    const std::size_t size = prior_sd.size();
    Matrix known = information;
    const Matrix before = covariance_left(known, prior_sd);
    std::size_t worst = 0;
    for (std::size_t i = 1; i < size; ++i) {
        if (before(i, i) > before(worst, worst)) { worst = i; }
    }
    const std::vector<BoxPose> candidates = poses_of_a_box();
    std::vector<std::vector<double>> rows;
    rows.reserve(candidates.size());
    for (const BoxPose& pose : candidates) { rows.push_back(derivatives(pose.up)); }
    std::vector<PoseAdvice> advice;
    while (advice.size() < poses_most &&
           (advice.size() < poses || !undetermined(known, prior_sd, share_most).empty())) {
        const Matrix covariance = covariance_left(known, prior_sd);
        std::size_t best = 0;
        double most = -1.0;
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            // Opposite poses may be alike but for rounding: the first of them then.
            const double variance = foreseen_variance(covariance, prior_sd, rows[c]);
            if (variance > most * (1.0 + 1e-9)) {
                most = variance;
                best = c;
            }
        }
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t j = 0; j < size; ++j) { known(i, j) += rows[best][i] * rows[best][j]; }
        }
        const double after = covariance_left(known, prior_sd)(worst, worst);
        PoseAdvice one;
        one.up = candidates[best].up;
        one.words = candidates[best].words;
        one.parameter = worst;
        one.sd_before = std::sqrt(before(worst, worst)) * prior_sd[worst];
        one.sd_after = std::sqrt(after) * prior_sd[worst];
        advice.push_back(std::move(one));
    }
    return advice;
}

}  // namespace gyrolog
