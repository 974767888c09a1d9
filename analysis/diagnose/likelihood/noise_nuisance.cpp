#include "analysis/diagnose/likelihood/noise_nuisance.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog::resolution {

// Of what is stated, a coefficient keeps its sign,
constexpr double least_factor = 1e-3;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

double uncertainty(const SensorModel& model, std::size_t axis, const char* name) {
    const std::map<std::string, double>& own = model.axes[axis].sd_rel;
    const std::map<std::string, double>& all = model.sd_rel;
    const auto in_own = own.find(name);
    const auto in_all = all.find(name);
    const double sd = in_own != own.end() ? in_own->second : in_all != all.end() ? in_all->second : 0.0;
    return std::min(sd, decisions.unknown_sd_rel);
}

// A coefficient that is not seen by its stated uncertainty grows to so many times its size. N, however well
// known, falls to that part of it: without white noise Gauss-Markov noise would be a low-pass.
double noise_factor_most() {
    static const double plausible = [] {
        const std::span<const EffectParam> params = find_effect("arw_scale")->params;
        return std::ranges::find(params, "factor", &EffectParam::name)->plausible_to;
    }();
    return plausible * decisions.beyond_plausible;
}

struct Terms {
    double log_likelihood_nats = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
};

Terms terms(const SpectralBins& bins, std::span<const SpectralParts> parts, std::span<const double> power,
            const std::array<double, 3>& sd_rel, const Eigen::Vector3d& z) {
    Terms sum;
    const Eigen::Array3d sd(sd_rel[0], sd_rel[1], sd_rel[2]);
    const Eigen::Array3d factor = 1.0 + sd * z.array();
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const Eigen::Array3d part(parts[i].white, parts[i].flicker, parts[i].walk);
        const double density = (part * factor.square()).sum() + parts[i].beside_coefficients();
        const double half = 0.5 * bins[i].count();
        const double ratio = power[i] / density;
        sum.log_likelihood_nats -= half * (std::log(density) + ratio);
        const Eigen::Vector3d slope = (2.0 * sd * factor * part / density).matrix();
        sum.gradient += half * (ratio - 1.0) * slope;
        sum.information.noalias() += half * slope * slope.transpose();
    }
    sum.log_likelihood_nats -= 0.5 * z.squaredNorm();
    sum.gradient -= z;
    return sum;
}

}  // namespace

std::array<double, 3> noise_uncertainty(const SensorModel& model, std::size_t axis) {
    return {uncertainty(model, axis, "N"), uncertainty(model, axis, "B"), uncertainty(model, axis, "K")};
}

void expected_density(std::span<const SpectralParts> parts, const std::array<double, 3>& sd_rel,
                      const std::array<double, 3>& z, std::span<double> density) {
    std::array<double, 3> factor{};
    for (std::size_t j = 0; j < 3; ++j) {
        factor[j] = 1.0 + sd_rel[j] * z[j];
        factor[j] *= factor[j];
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        density[i] = factor[0] * parts[i].white + factor[1] * parts[i].flicker + factor[2] * parts[i].walk +
                     parts[i].beside_coefficients();
    }
}

NoiseNuisance fit_nuisance(const SpectralBins& bins, std::span<const SpectralParts> parts,
                           std::span<const double> power, const std::array<double, 3>& sd_rel,
                           const NoiseNuisance& start) {
    Eigen::Vector3d z(start.z.data());
    const double factor_most = noise_factor_most();
    const auto clamped = [&](Eigen::Vector3d at) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (!(sd_rel[j] > 0.0)) { continue; }
            double& each = at[static_cast<Eigen::Index>(j)];
            const double least = j == 0 ? 1.0 / factor_most : resolution::least_factor;
            each = std::max(each, (least - 1.0) / sd_rel[j]);
            if (sd_rel[j] >= decisions.seen_sd_rel()) {
                each = std::min(each, (factor_most - 1.0) / sd_rel[j]);
            }
        }
        return at;
    };
    Terms now = terms(bins, parts, power, sd_rel, z);
    for (int iteration = 0; iteration < 30; ++iteration) {
        Eigen::Vector3d step = now.information.ldlt().solve(now.gradient);
        Terms next;
        bool better = false;
        for (int halving = 0; halving < 12 && !better; ++halving) {
            next = terms(bins, parts, power, sd_rel, clamped(z + step));
            better = next.log_likelihood_nats > now.log_likelihood_nats;
            if (!better) { step *= 0.5; }
        }
        if (!better) { break; }
        z = clamped(z + step);
        const double gained = next.log_likelihood_nats - now.log_likelihood_nats;
        now = next;
        if (gained < 1e-4) { break; }
    }
    const Eigen::Vector3d sd = now.information.inverse().diagonal().cwiseSqrt();
    return {{z[0], z[1], z[2]}, {sd[0], sd[1], sd[2]}, now.log_likelihood_nats};
}

}  // namespace gyrolog
