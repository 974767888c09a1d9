// The orthonormal DCT-II of a whole record:
//   Y_k = sqrt((2 - [k = 0]) / n) sum_i x_i cos(pi k (i + 1/2) / n),   k = 0 ... n - 1
// Coefficient k belongs to the frequency k rate / (2 n); of noise with the two-sided density S its mean
// square is S rate. Coefficients are uncorrelated both for white noise and for a random walk (whose inverse
// covariance is the Laplacian of a path; Strang, "The discrete cosine transform", SIAM Review 41 (1999)), and
// nearly so for all that lies between; a constant is in Y_0 alone. By a complex transform of half the length
// (Makhoul, IEEE Trans. ASSP 28 (1980) 27-34).
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace gyrolog {

// The largest length up to `most` whose transform is fast: 2^a 3^b 5^c, even.
std::size_t fast_length(std::size_t most);

// Not to be shared by threads.
class CosineTransform {
public:
    explicit CosineTransform(std::size_t length);  // even
    ~CosineTransform();
    CosineTransform(CosineTransform&&) noexcept;
    CosineTransform& operator=(CosineTransform&&) noexcept;

    std::size_t length() const;
    // In place, to 1e-10 of the largest.
    void forward(std::span<double> values);
    void inverse(std::span<double> values);
    // Faster, and as exact as such numbers are: 1e-6 of the largest.
    void inverse(std::span<float> values);

private:
    template <typename Real>
    struct Plan;
    std::unique_ptr<Plan<double>> plan_;
    std::unique_ptr<Plan<float>> float_plan_;  // once it is used
};

// Transforms of one length: their tables take as long to make as a transform does.
class TransformPool {
public:
    using Lease = std::unique_ptr<CosineTransform, std::function<void(CosineTransform*)>>;

    explicit TransformPool(std::size_t length) : length_(length) {}

    // For one thread, back in the pool when the lease ends; the pool outlives it.
    Lease lease();

private:
    std::size_t length_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<CosineTransform>> idle_;
};

}  // namespace gyrolog
