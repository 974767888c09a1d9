// No allocation per sample, by counting every call of malloc.

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "analysis/denoise/array_denoiser.hpp"
#include "tests/analysis/denoise/array_samples.hpp"
#include "tests/support/instrumented.hpp"

#if !GYROLOG_IS_INSTRUMENTED
namespace {
std::atomic<std::size_t> calls_of_malloc = 0;
}

// glibc's own names for the functions that these stand in front of.
extern "C" {
void* __libc_malloc(std::size_t size);                     // NOLINT
void* __libc_calloc(std::size_t count, std::size_t size);  // NOLINT
void* __libc_realloc(void* memory, std::size_t size);      // NOLINT
void* malloc(std::size_t size) {
    ++calls_of_malloc;
    return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
    ++calls_of_malloc;
    return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
    ++calls_of_malloc;
    return __libc_realloc(memory, size);
}
}
#endif

namespace gyrolog {
namespace {

TEST(DenoiseMemory, NothingIsAllocatedPerSample) {
#if GYROLOG_IS_INSTRUMENTED
    GTEST_SKIP() << "needs malloc, which is the sanitizer's";
#else
    const std::size_t before_all = calls_of_malloc;
    const std::vector<double> proof(1000);
    ASSERT_GT(calls_of_malloc, before_all) << "the count does not count";
    for (const std::size_t units : {1U, 8U, 16U}) {
        const ArrayNoise noise = equal_units(units, 0.1, 1e-4);
        const ArraySamples samples = array_samples(noise, Signal(2000, 0.0), 61);
        for (const DenoiseMethod method : all_denoise_methods) {
            for (const RateModel model :
                 {RateModel::free, RateModel::walk, RateModel::trend, RateModel::adaptive}) {
                DenoiseDesign design;
                design.method = method;
                design.rate = {model, 5.0};
                UnitLimits limits;
                limits.white_sd = 0.1;
                ArrayDenoiser denoiser(noise, std::vector<UnitLimits>(units, limits), design);
                std::array<double, units_max> z{};
                const std::size_t before = calls_of_malloc;
                double sum = 0.0;
                for (std::size_t k = 0; k < 2000; ++k) {
                    for (std::size_t i = 0; i < units; ++i) { z.at(i) = samples[i][k]; }
                    // A unit that comes and goes, and a gap: gains are worked out anew.
                    if (k % 300 == 250) { z[0] = 1e9; }
                    if (k == 1500) { denoiser.skip(10); }
                    sum += denoiser.step(std::span(z).first(units));
                }
                EXPECT_EQ(calls_of_malloc, before)
                    << units << " units, " << name_of(method) << ", " << name_of(model) << ", " << sum;
            }
        }
    }
#endif
}

}  // namespace
}  // namespace gyrolog
