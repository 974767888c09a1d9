// Wavelet threshold in real time, after Peng and Chen (kalman_array.hpp), section 2: the last samples, up to
// 2^8 of them, are transformed (db4, four levels), details below
//   T = sigma_n sqrt(2 ln N)          VisuShrink, D. L. Donoho and I. M. Johnstone, "Ideal spatial adaptation
//                                     by wavelet shrinkage", Biometrika 81 (1994) 425-455
// are set to zero, the others stay as they are (hard threshold), and the last sample of what is restored is
// the output. sigma_n is the median of the finest details' sizes over 0.6745.
//
// Noise that is not white has another size at each level, and so has the threshold then (I. M. Johnstone and
// B. W. Silverman, "Wavelet threshold estimators for data with correlated noise", J. R. Stat. Soc. B 59
// (1997) 319-351): NoiseLevel::each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gyrolog {

enum class NoiseLevel {
    finest,  // one sigma, of the finest details: white noise
    each,    // one of each level
};

struct WaveletOptions {
    std::size_t window = 256;
    int levels = 4;
    NoiseLevel noise = NoiseLevel::finest;
};

// No allocation after construction.
class WaveletDenoiser {
public:
    // A window of 14 samples at least. While it grows, there are fewer levels (wavelet_transform.hpp); the
    // first 13 samples pass as they are.
    explicit WaveletDenoiser(const WaveletOptions& options = {});

    // `slope`: change of the signal per sample. It is taken out of the window about its last sample, where
    // the mirror image would otherwise bend it: that bend is the method's lag.
    double step(double sample, double slope = 0.0);
    // The next sample is the first of a new window.
    void reset() { samples_ = 0; }

    // The output for a signal whose details are all below the threshold: the weights of the last sample, the
    // one before, ... of a full window. Their squares' sum is the share of white noise that is left; their
    // mean, by age, the lag in samples.
    static std::vector<double> smoothing_weights(const WaveletOptions& options = {});

private:
    double denoised(std::span<const double> window);
    void shrink_needed(int levels, std::size_t samples);
    double noise_of(int level);

    struct Level {
        std::vector<double> approximation;
        std::vector<double> detail;
        std::size_t size = 0;  // of the coefficients in use
    };

    WaveletOptions options_;
    std::vector<double> past_;  // the window is the last of these; moved to the front when full
    std::size_t end_ = 0;
    std::size_t samples_ = 0;  // in the window
    std::vector<double> level_;
    std::vector<Level> levels_;  // [0]: the finest
    std::vector<double> sizes_;
    std::vector<double> restored_;
};

}  // namespace gyrolog
