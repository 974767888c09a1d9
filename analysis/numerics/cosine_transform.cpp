#include "analysis/numerics/cosine_transform.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <opencv2/core/hal/interface.h>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/hal.hpp>

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

template <typename Real>
struct CosineTransform::Plan {
    explicit Plan(std::size_t length) : reordered(length), spectrum(length), turn(length / 2 + 1) {
        for (std::size_t k = 0; k < turn.size(); ++k) {
            const double angle =
                -std::numbers::pi * static_cast<double>(k) / (2.0 * static_cast<double>(length));
            turn[k] = {static_cast<Real>(std::cos(angle)), static_cast<Real>(std::sin(angle))};
        }
    }

    std::size_t length() const { return reordered.size(); }

    void forward(std::span<Real> values) {
        const std::size_t n = length();
        for (std::size_t i = 0; i < n / 2; ++i) {
            reordered[i] = values[2 * i];
            reordered[n - 1 - i] = values[2 * i + 1];
        }
        to_spectrum.apply(reordered, spectrum);
        // turn_k V_k = (C_k - i C_{n-k}) / 1, C_k = sum x cos(...): both halves from one product.
        const Real scale = std::sqrt(Real{2} / static_cast<Real>(n));
        values[0] = spectrum[0] / std::sqrt(static_cast<Real>(n));
        for (std::size_t k = 1; k < n / 2; ++k) {
            const std::complex<Real> c = turn[k] * std::complex<Real>(spectrum[2 * k - 1], spectrum[2 * k]);
            values[n - k] = -scale * c.imag();
            values[k] = scale * c.real();
        }
        values[n / 2] = scale * turn[n / 2].real() * spectrum[n - 1];
    }

    void inverse(std::span<Real> values) {
        const std::size_t n = length();
        const Real scale = std::sqrt(static_cast<Real>(n) / Real{2});
        spectrum[0] = values[0] * std::sqrt(static_cast<Real>(n));
        for (std::size_t k = 1; k < n / 2; ++k) {
            const std::complex<Real> c =
                std::conj(turn[k]) * std::complex<Real>(scale * values[k], -scale * values[n - k]);
            spectrum[2 * k - 1] = c.real();
            spectrum[2 * k] = c.imag();
        }
        spectrum[n - 1] = std::sqrt(Real{2}) * scale * values[n / 2];
        from_spectrum.apply(spectrum, reordered);
        for (std::size_t i = 0; i < n / 2; ++i) {
            values[2 * i] = reordered[i];
            values[2 * i + 1] = reordered[n - 1 - i];
        }
    }

    // cv::dft() makes its tables anew each time.
    class Dft {
    public:
        explicit Dft(int flags) : flags_(flags) {}

        void apply(const std::vector<Real>& from, std::vector<Real>& to) {
            if (!dft_) {
                dft_ = cv::hal::DFT1D::create(static_cast<int>(from.size()), 1, cv::DataType<Real>::depth,
                                              flags_ | CV_HAL_DFT_REAL_OUTPUT);
            }
            dft_->apply(reinterpret_cast<const uchar*>(from.data()), reinterpret_cast<uchar*>(to.data()));
        }

    private:
        int flags_;
        cv::Ptr<cv::hal::DFT1D> dft_;
    };

    std::vector<Real> reordered;
    std::vector<Real> spectrum;            // as OpenCV packs it: Re V_0, Re V_1, Im V_1, ... Re V_{n/2}
    std::vector<std::complex<Real>> turn;  // exp(-i pi k / 2n)
    Dft to_spectrum{0};
    Dft from_spectrum{CV_HAL_DFT_INVERSE | CV_HAL_DFT_SCALE};
};

CosineTransform::CosineTransform(std::size_t length) : plan_(std::make_unique<Plan<double>>(length)) {}
CosineTransform::~CosineTransform() = default;
CosineTransform::CosineTransform(CosineTransform&&) noexcept = default;
CosineTransform& CosineTransform::operator=(CosineTransform&&) noexcept = default;

std::size_t CosineTransform::length() const { return plan_->length(); }

void CosineTransform::forward(std::span<double> values) { plan_->forward(values); }
void CosineTransform::inverse(std::span<double> values) { plan_->inverse(values); }

void CosineTransform::inverse(std::span<float> values) {
    if (!float_plan_) { float_plan_ = std::make_unique<Plan<float>>(length()); }
    float_plan_->inverse(values);
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
