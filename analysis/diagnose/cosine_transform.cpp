#include "analysis/diagnose/cosine_transform.hpp"

#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

std::size_t fast_length(std::size_t most) {
    // Multiples of four: only then does the transform of real numbers take half the work of a complex one.
    std::size_t best = 4;
    for (std::size_t five = 4; five <= most; five *= 5) {
        for (std::size_t three = five; three <= most; three *= 3) {
            std::size_t two = three;
            while (two * 2 <= most) { two *= 2; }
            if (two > best) { best = two; }
        }
    }
    return best;
}

struct CosineTransform::Plan {
    explicit Plan(std::size_t length) : reordered(length), spectrum(length / 2 + 1), turn(length / 2 + 1) {
        fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
        for (std::size_t k = 0; k < turn.size(); ++k) {
            const double angle = -pi * static_cast<double>(k) / (2.0 * static_cast<double>(length));
            turn[k] = {std::cos(angle), std::sin(angle)};
        }
    }

    Eigen::FFT<double> fft;
    std::vector<double> reordered;
    std::vector<std::complex<double>> spectrum;
    std::vector<std::complex<double>> turn;  // exp(-i pi k / 2n)
};

CosineTransform::CosineTransform(std::size_t length) : plan_(std::make_unique<Plan>(length)) {}
CosineTransform::~CosineTransform() = default;
CosineTransform::CosineTransform(CosineTransform&&) noexcept = default;
CosineTransform& CosineTransform::operator=(CosineTransform&&) noexcept = default;

std::size_t CosineTransform::length() const { return plan_->reordered.size(); }

void CosineTransform::forward(std::span<double> values) {
    const std::size_t n = length();
    std::vector<double>& v = plan_->reordered;
    for (std::size_t i = 0; i < n / 2; ++i) {
        v[i] = values[2 * i];
        v[n - 1 - i] = values[2 * i + 1];
    }
    plan_->fft.fwd(plan_->spectrum.data(), v.data(), static_cast<Eigen::Index>(n));
    // turn_k V_k = (C_k - i C_{n-k}) / 1, C_k = sum x cos(...): both halves from one product.
    const double scale = std::sqrt(2.0 / static_cast<double>(n));
    values[0] = plan_->spectrum[0].real() / std::sqrt(static_cast<double>(n));
    for (std::size_t k = 1; k <= n / 2; ++k) {
        const std::complex<double> c = plan_->turn[k] * plan_->spectrum[k];
        values[n - k] = -scale * c.imag();
        values[k] = scale * c.real();
    }
}

void CosineTransform::inverse(std::span<double> values) {
    const std::size_t n = length();
    const double scale = std::sqrt(static_cast<double>(n) / 2.0);
    plan_->spectrum[0] = values[0] * std::sqrt(static_cast<double>(n));
    for (std::size_t k = 1; k <= n / 2; ++k) {
        const std::complex<double> c(scale * values[k], -scale * values[n - k]);
        plan_->spectrum[k] = std::conj(plan_->turn[k]) * c;
    }
    plan_->spectrum[n / 2].imag(0.0);
    std::vector<double>& v = plan_->reordered;
    plan_->fft.inv(v.data(), plan_->spectrum.data(), static_cast<Eigen::Index>(n));
    for (std::size_t i = 0; i < n / 2; ++i) {
        values[2 * i] = v[i];
        values[2 * i + 1] = v[n - 1 - i];
    }
}

TransformPool::Lease TransformPool::lease() {
    std::unique_ptr<CosineTransform> transform;
    {
        const std::lock_guard lock(mutex_);
        if (!idle_.empty()) {
            transform = std::move(idle_.back());
            idle_.pop_back();
        }
    }
    if (!transform) { transform = std::make_unique<CosineTransform>(length_); }
    return {transform.release(), [this](CosineTransform* used) {
                std::unique_ptr<CosineTransform> owned(used);
                const std::lock_guard lock(mutex_);
                idle_.push_back(std::move(owned));
            }};
}

}  // namespace gyrolog
