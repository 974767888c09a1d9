// The effects on noise over many seeds: each has the spectrum, distribution and correlation of its
// definition.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <ostream>
#include <vector>

#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>

#include "analysis/simulate/chain.hpp"
#include "tests/analysis/simulate/periodogram.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

using Samples = std::vector<double>;

// In deg/s, and only the rates.
std::array<Samples, 3> rates_dps(const SensorModel& model, double rate_hz, std::uint64_t seed,
                                 std::size_t blocks, std::shared_ptr<const World> world = nullptr) {
    std::array<Samples, 3> axes;
    SensorSimulator simulator(model, rate_hz, seed, std::move(world));
    for (std::size_t i = 0; i < blocks; ++i) {
        const SampleBlock& block = simulator.next_block();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const double rate_rad_s : block.rate_rad_s[axis]) {
                axes[axis].push_back(rate_rad_s * deg_per_rad);
            }
        }
    }
    return axes;
}

// expected(nu): two-sided, at nu cycles a sample, dps^2 per (cycle/sample). From bin `from_bin` on.
template <typename Expected>
void expect_spectrum(const SensorModel& model, double rate_hz, std::size_t from_bin, double model_error,
                     Expected expected) {
    constexpr unsigned seeds = 20;
    SpectrumAverage spectrum(16 * block_samples);
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        for (const Samples& axis : rates_dps(model, rate_hz, seed, 16)) { spectrum.add(axis); }
    }
    for (const OctaveRatio& octave : octave_ratios(spectrum, expected)) {
        if (octave.from_nu * static_cast<double>(spectrum.length()) < static_cast<double>(from_bin)) {
            continue;
        }
        EXPECT_NEAR(octave.ratio, 1.0, model_error + 4.0 * octave.sd)
            << "from " << octave.from_nu * rate_hz << " Hz";
    }
}

double lagged_product(const Samples& x, std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) { sum += x[i] * x[i + lag]; }
    return sum / static_cast<double>(x.size() - lag);
}

// Greatest distance of the sample's distribution from cdf, in units in which 1.95 is passed once in a
// thousand times and 2.23 once in ten thousand.
template <typename Cdf>
double kolmogorov_distance(Samples x, Cdf cdf) {
    std::ranges::sort(x);
    const auto n = static_cast<double>(x.size());
    double distance = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double p = cdf(x[i]);
        distance = std::max({distance, p - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - p});
    }
    return distance * std::sqrt(n);
}

constexpr double kolmogorov_limit = 2.23;

TEST(FlickerMissing, AddsItsSpectrumToTheModelsOwnAsAnotherNoise) {
    SensorModel model = with_effect(ideal_model(), "flicker_missing", {{"B_dps", 0.4}});
    for (AxisModel& axis : model.axes) { axis.noise.B_rad_per_s = 0.3 * rad_per_deg; }
    // Added as the same noise the two would have 0.49 in place of 0.25.
    expect_spectrum(model, 100.0, 2, 0.037, [](double nu) { return 0.25 / (2.0 * pi * nu); });
}

TEST(RrwMissing, AddsARandomWalkWhoseStepsAreIndependentAtEveryRate) {
    SensorModel model = with_effect(ideal_model(), "rrw_missing", {{"K_dps_sqrt_hz", 0.4}});
    for (AxisModel& axis : model.axes) { axis.noise.K_rad_per_s_sqrt_s = 0.3 * rad_per_deg; }
    for (const double rate_hz : {10.0, 100.0, 1000.0, 8000.0}) {
        double variance = 0.0;
        double neighbours = 0.0;
        for (const Samples& walk : rates_dps(model, rate_hz, 5, 100)) {
            Samples steps(walk.size() - 1);
            for (std::size_t i = 0; i < steps.size(); ++i) { steps[i] = walk[i + 1] - walk[i]; }
            variance += lagged_product(steps, 0) / 3.0;
            neighbours += lagged_product(steps, 1) / 3.0;
        }
        const double n = 3.0 * 100.0 * block_samples;
        EXPECT_NEAR(variance * rate_hz, 0.25, 0.25 * 4.0 * std::sqrt(2.0 / n)) << rate_hz;
        EXPECT_NEAR(neighbours * rate_hz, 0.0, 0.25 * 4.0 / std::sqrt(n)) << rate_hz;
    }
}

TEST(AngleNoise, HasTheSpectrumOfADifferenceAndItsFullVarianceFromTheFirstSample) {
    constexpr double rate_hz = 100.0;
    constexpr double Q_dps_s = 0.01;
    const SensorModel model = with_effect(ideal_model(), "angle_noise", {{"Q_dps_s", Q_dps_s}});
    // The window smears the steep start: by 1 / (12 bin^2) of the spectrum's curvature, 0.5 % at bin 8.
    expect_spectrum(model, rate_hz, 8, 0.005,
                    [](double nu) { return std::pow(2.0 * Q_dps_s * rate_hz * std::sin(pi * nu), 2); });
    double first = 0.0;
    constexpr unsigned seeds = 1000;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        for (const Samples& axis : rates_dps(model, rate_hz, seed, 1)) {
            first += axis[0] * axis[0] / (3.0 * seeds);
        }
    }
    EXPECT_NEAR(first / (2.0 * Q_dps_s * Q_dps_s * rate_hz * rate_hz), 1.0,
                4.0 * std::sqrt(2.0 / (3.0 * seeds)));
}

// Products of a sample with itself and with the next ones, over many sensors, at two places of a block: the
// covariance there and one standard deviation of it, which is known from the covariance itself.
constexpr std::array<std::size_t, 2> places = {0, 500};
constexpr std::size_t lags = 4;

void expect_covariance_at_the_start_and_later(const SensorModel& model, double rate_hz,
                                              const std::array<double, lags>& expected_dps2) {
    constexpr int seeds = 2500;
    constexpr double draws = 3.0 * seeds;
    std::array<std::array<double, lags>, places.size()> products{};
    for (int seed = 1; seed <= seeds; ++seed) {
        for (const Samples& y : rates_dps(model, rate_hz, static_cast<std::uint64_t>(seed), 1)) {
            for (std::size_t place = 0; place < places.size(); ++place) {
                const std::size_t at = places[place];
                for (std::size_t lag = 0; lag < lags; ++lag) {
                    products[place][lag] += y[at] * y[at + lag] / draws;
                }
            }
        }
    }
    for (std::size_t lag = 0; lag < lags; ++lag) {
        const double variance = expected_dps2[0];
        const double sd = std::sqrt((variance * variance + expected_dps2[lag] * expected_dps2[lag]) / draws);
        EXPECT_NEAR(products[0][lag], expected_dps2[lag], 4.0 * sd)
            << "lag " << lag << " at the first sample";
        EXPECT_NEAR(products[1][lag], expected_dps2[lag], 4.0 * sd) << "lag " << lag << " in mid-block";
    }
}

// y_k = pole y_(k-1) + g (w_k - zero w_(k-1)), from the two numbers that the effect is given.
struct Colour {
    double gain;
    double middle_of_rate;

    double x() const { return std::tan(pi * middle_of_rate); }
    double zero() const { return (std::sqrt(gain) - x()) / (std::sqrt(gain) + x()); }
    double pole() const { return (1.0 / std::sqrt(gain) - x()) / (1.0 / std::sqrt(gain) + x()); }
    double g() const { return (1.0 - pole()) / (1.0 - zero()); }
    // Of white noise of density one, at nu cycles a sample.
    double density(double nu) const {
        const auto back = std::polar(1.0, -2.0 * pi * nu);
        return g() * g() * std::norm(1.0 - zero() * back) / std::norm(1.0 - pole() * back);
    }
    // Box, Jenkins, Reinsel, 3.4.
    double covariance(std::size_t lag) const {
        const double p = pole();
        const double z = zero();
        const double of_none = (1.0 + z * z - 2.0 * p * z) / (1.0 - p * p);
        const double of_one = (1.0 - p * z) * (p - z) / (1.0 - p * p);
        return g() * g() * (lag == 0 ? of_none : of_one * std::pow(p, static_cast<double>(lag) - 1.0));
    }

    friend void PrintTo(const Colour& colour, std::ostream* out) {
        *out << colour.gain << " at half the rate, middle at " << colour.middle_of_rate << " of it";
    }
};

class ColourAt : public testing::TestWithParam<Colour> {};
INSTANTIATE_TEST_SUITE_P(Colours, ColourAt,
                         testing::Values(Colour{0.3, 0.2}, Colour{3.0, 0.1}, Colour{0.05, 0.4},
                                         Colour{6.0, 0.05}));

constexpr double colour_rate_hz = 200.0;
constexpr double colour_N_dps = 0.02;

SensorModel coloured(const Colour& colour) {
    return with_effect(white_model(colour_N_dps * rad_per_deg), "noise_colour",
                       {{"gain", colour.gain}, {"middle_of_rate", colour.middle_of_rate}});
}

TEST_P(ColourAt, WhiteNoiseHasTheSpectrumOfOneZeroAndOnePole) {
    const Colour colour = GetParam();
    const double N2_dps2 = colour_N_dps * colour_N_dps * colour_rate_hz;
    expect_spectrum(coloured(colour), colour_rate_hz, 2, 0.0,
                    [&](double nu) { return N2_dps2 * colour.density(nu); });
    EXPECT_NEAR(colour.density(0.0), 1.0, 1e-12);
    EXPECT_NEAR(colour.density(0.5), colour.gain * colour.gain, 1e-9);
    EXPECT_NEAR(colour.density(colour.middle_of_rate), colour.gain, 1e-9);
}

TEST_P(ColourAt, WhiteNoiseIsStationaryFromTheFirstSample) {
    const Colour colour = GetParam();
    std::array<double, lags> expected{};
    for (std::size_t lag = 0; lag < lags; ++lag) {
        expected[lag] = colour_N_dps * colour_N_dps * colour_rate_hz * colour.covariance(lag);
    }
    expect_covariance_at_the_start_and_later(coloured(colour), colour_rate_hz, expected);
}

// What an estimator expects is what the simulator makes.
TEST_P(ColourAt, SignatureHasTheSameSpectrum) {
    const Colour colour = GetParam();
    const EffectModel entry = coloured(colour).effects.front();
    std::vector<double> f_hz;
    for (int i = 1; i < 100; ++i) { f_hz.push_back(i); }
    std::vector<SpectralParts> parts(f_hz.size(), {.white = 2.0, .flicker = 3.0, .walk = 4.0, .other = 5.0});
    find_effect("noise_colour")->signature->spectrum(f_hz, colour_rate_hz, EffectValues(entry), parts);
    for (std::size_t i = 0; i < f_hz.size(); ++i) {
        EXPECT_NEAR(parts[i].white, 2.0 * colour.density(f_hz[i] / colour_rate_hz), 1e-9);
        EXPECT_EQ(parts[i].flicker + parts[i].walk + parts[i].other, 12.0);
    }
}

// Noise about a frequency, and the rate that it is sampled at.
struct NarrowLaw {
    double f_hz;
    double width_hz;
    double rate_hz;

    double covariance(std::size_t lag) const {
        const double t_s = static_cast<double>(lag) / rate_hz;
        return std::exp(-pi * width_hz * t_s) * std::cos(2.0 * pi * f_hz * t_s);
    }
    // Of samples with a standard deviation of one: the continuous density with all that folds, at nu cycles a
    // sample per (cycle/sample); the tail as an integral.
    double density(double nu) const {
        constexpr int images = 2000;
        const double half_width = 0.5 * width_hz / rate_hz;
        const auto lorentzian = [&](double from_middle) {
            return half_width / pi / (from_middle * from_middle + half_width * half_width);
        };
        double sum = 0.0;
        for (int k = -images; k <= images; ++k) {
            sum += 0.5 * (lorentzian(nu + k - f_hz / rate_hz) + lorentzian(nu + k + f_hz / rate_hz));
        }
        return sum + 2.0 * half_width / pi / (images + 0.5);
    }
    SensorModel model() const {
        return with_effect(ideal_model(), "narrowband",
                           {{"f_hz", f_hz}, {"width_hz", width_hz}, {"sigma_dps", 1.0}});
    }

    friend void PrintTo(const NarrowLaw& law, std::ostream* out) {
        *out << law.width_hz << " Hz wide at " << law.f_hz << " Hz, sampled at " << law.rate_hz << " Hz";
    }
};

class NarrowbandAt : public testing::TestWithParam<NarrowLaw> {};
INSTANTIATE_TEST_SUITE_P(Bands, NarrowbandAt,
                         testing::Values(NarrowLaw{31.0, 0.5, 100.0}, NarrowLaw{31.0, 8.0, 100.0},
                                         NarrowLaw{83.0, 2.0, 100.0}, NarrowLaw{217.0, 20.0, 100.0},
                                         NarrowLaw{38.0, 3.0, 1000.0}));

TEST_P(NarrowbandAt, HasTheFoldedSpectrumInEveryOctave) {
    const NarrowLaw law = GetParam();
    // The window smears a peak: by a twelfth of the density's curvature over a bin.
    const double bins_per_width = 16.0 * block_samples * law.width_hz / law.rate_hz;
    expect_spectrum(law.model(), law.rate_hz, 2, 8.0 / (bins_per_width * bins_per_width),
                    [&](double nu) { return law.density(nu); });
}

TEST_P(NarrowbandAt, IsStationaryFromTheFirstSample) {
    const NarrowLaw law = GetParam();
    std::array<double, lags> expected{};
    for (std::size_t lag = 0; lag < lags; ++lag) { expected[lag] = law.covariance(lag); }
    expect_covariance_at_the_start_and_later(law.model(), law.rate_hz, expected);
}

// A line of constant height whose frequency wanders: the phase between two samples is normal, so that the
// covariance is cos(2 pi f t) exp(-variance of the phase / 2) (Kubo), which a slow wander makes Gaussian.
struct WanderingLaw {
    double f_hz = 31.0;
    double width_hz = 6.0;
    double wander_s = 0.5;
    double rate_hz = 100.0;

    double spread_hz() const { return width_hz / std::sqrt(8.0 * std::log(2.0)); }
    double covariance(std::size_t lag) const {
        const double kept = std::exp(-1.0 / (wander_s * rate_hz));
        double sum = static_cast<double>(lag);  // of the covariances of all pairs of steps
        for (std::size_t apart = 1; apart < lag; ++apart) {
            sum += 2.0 * static_cast<double>(lag - apart) * std::pow(kept, static_cast<double>(apart));
        }
        const double step_rad = 2.0 * pi * spread_hz() / rate_hz;
        const double turn_rad = 2.0 * pi * f_hz / rate_hz;
        return std::cos(turn_rad * static_cast<double>(lag)) * std::exp(-0.5 * step_rad * step_rad * sum);
    }
    SensorModel model() const {
        return with_effect(
            ideal_model(), "narrowband",
            {{"f_hz", f_hz}, {"width_hz", width_hz}, {"sigma_dps", 1.0}, {"wander_s", wander_s}});
    }
};

TEST(WanderingLine, IsStationaryFromTheFirstSample) {
    const WanderingLaw law;
    std::array<double, lags> expected{};
    for (std::size_t lag = 0; lag < lags; ++lag) { expected[lag] = law.covariance(lag); }
    expect_covariance_at_the_start_and_later(law.model(), law.rate_hz, expected);
}

TEST(WanderingLine, HasAConstantHeight) {
    const Simulated out = simulate(WanderingLaw{}.model(), 100.0, 3, 8);
    double most = 0.0;
    for (const double rate_rad_s : out.rate_rad_s[0]) { most = std::max(most, std::fabs(rate_rad_s)); }
    EXPECT_NEAR(most * deg_per_rad, std::sqrt(2.0), 1e-3);
}

// The distribution of the frequency, which here reaches beyond half the rate.
TEST(WanderingLine, SignatureIsTheGaussianAndWhatFolds) {
    const WanderingLaw law{.f_hz = 44.0, .width_hz = 8.0, .wander_s = 30.0};
    const EffectModel entry = law.model().effects.front();
    std::vector<double> f_hz;
    for (int i = 1; i < 2500; ++i) { f_hz.push_back(0.02 * i); }
    std::vector<SpectralParts> parts(f_hz.size());
    find_effect("narrowband")->signature->spectrum(f_hz, law.rate_hz, EffectValues(entry), parts);
    const double spread_hz = law.spread_hz();
    const auto gaussian = [&](double off_hz) {
        return std::exp(-0.5 * off_hz * off_hz / (spread_hz * spread_hz)) / (std::sqrt(2.0 * pi) * spread_hz);
    };
    for (std::size_t i = 1500; i + 1 < f_hz.size(); i += 7) {
        const double density =
            0.5 * (gaussian(f_hz[i] - law.f_hz) + gaussian(law.rate_hz - f_hz[i] - law.f_hz));
        EXPECT_NEAR(parts[i].other * deg_per_rad * deg_per_rad / density, 1.0, 1e-3) << f_hz[i];
    }
}

// The signature averages over the bins: over many small ones it is the density itself, and over few large
// ones all of the variance is in them.
TEST_P(NarrowbandAt, SignatureHasTheSameSpectrum) {
    const NarrowLaw law = GetParam();
    const EffectModel entry = law.model().effects.front();
    const auto parts_at = [&](const std::vector<double>& f_hz) {
        std::vector<SpectralParts> parts(f_hz.size());
        find_effect("narrowband")->signature->spectrum(f_hz, law.rate_hz, EffectValues(entry), parts);
        return parts;
    };
    std::vector<double> fine_hz;
    for (int i = 1; i < 5000; ++i) { fine_hz.push_back(0.5 * law.rate_hz * i / 5000.0); }
    const std::vector<SpectralParts> fine = parts_at(fine_hz);
    const double dps2 = deg_per_rad * deg_per_rad;
    for (std::size_t i = 1; i + 1 < fine.size(); i += 7) {
        const double density = law.density(fine_hz[i] / law.rate_hz) / law.rate_hz;
        EXPECT_NEAR(fine[i].other * dps2 / density, 1.0, 0.01) << fine_hz[i];
    }
    std::vector<double> coarse_hz;
    for (double f_hz = 0.01 * law.rate_hz; f_hz < 0.5 * law.rate_hz; f_hz *= 1.05) {
        coarse_hz.push_back(f_hz);
    }
    const std::vector<SpectralParts> coarse = parts_at(coarse_hz);
    double variance = 0.0;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        variance += 2.0 * coarse[i].other * dps2 * coarse_hz[i] * (std::sqrt(1.05) - 1.0 / std::sqrt(1.05));
    }
    double from_density = 0.0;
    const double from_nu = 0.01 / std::sqrt(1.05);
    const double to_nu = coarse_hz.back() * std::sqrt(1.05) / law.rate_hz;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        from_density +=
            2.0 * law.density(from_nu + (to_nu - from_nu) * (i + 0.5) / steps) * (to_nu - from_nu) / steps;
    }
    EXPECT_NEAR(variance, from_density, 1e-3);
}

// What a telegraph's parameters say about its samples.
struct TelegraphLaw {
    double dwell_high_s;
    double dwell_low_s;
    double rate_hz;

    double high_share() const { return dwell_high_s / (dwell_high_s + dwell_low_s); }
    double forgetting_per_s() const { return 1.0 / dwell_high_s + 1.0 / dwell_low_s; }
    // From one sample to the next.
    double correlation() const { return std::exp(-forgetting_per_s() / rate_hz); }
    // For a distance of 1.
    double variance() const { return high_share() * (1.0 - high_share()); }

    SensorModel model() const {
        return with_effect(
            ideal_model(), "rtn",
            {{"amplitude_dps", 1.0}, {"dwell_high_s", dwell_high_s}, {"dwell_low_s", dwell_low_s}});
    }

    friend void PrintTo(const TelegraphLaw& law, std::ostream* out) {
        *out << law.dwell_high_s << " s high, " << law.dwell_low_s << " s low, at " << law.rate_hz << " Hz";
    }
};

class TelegraphAt : public testing::TestWithParam<TelegraphLaw> {};
INSTANTIATE_TEST_SUITE_P(Telegraphs, TelegraphAt,
                         testing::Values(TelegraphLaw{0.4, 1.1, 100.0}, TelegraphLaw{2.0, 0.5, 10.0},
                                         TelegraphLaw{0.05, 0.05, 1000.0},
                                         TelegraphLaw{0.004, 0.012, 100.0}));

TEST_P(TelegraphAt, IsInEachStateForItsShareOfTheTime) {
    const TelegraphLaw law = GetParam();
    double high = 0.0;
    double n = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        for (const Samples& axis : rates_dps(law.model(), law.rate_hz, seed, 32)) {
            high += static_cast<double>(std::ranges::count_if(axis, [](double x) { return x > 0.0; }));
            n += static_cast<double>(axis.size());
        }
    }
    const double independent = n * (1.0 - law.correlation()) / (1.0 + law.correlation());
    EXPECT_NEAR(high / n, law.high_share(), 4.0 * std::sqrt(law.variance() / independent));
}

TEST_P(TelegraphAt, StartsInEitherStateAsOftenAsItIsThere) {
    const TelegraphLaw law = GetParam();
    constexpr double seeds = 2000.0;
    double first = 0.0;
    double last = 0.0;
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
        const auto axes = rates_dps(law.model(), law.rate_hz, seed, 1);
        for (const Samples& axis : axes) {
            first += static_cast<double>(axis.front() > 0.0) / (3.0 * seeds);
            last += static_cast<double>(axis.back() > 0.0) / (3.0 * seeds);
        }
    }
    const double sd = std::sqrt(law.variance() / (3.0 * seeds));
    EXPECT_NEAR(first, law.high_share(), 4.0 * sd);
    EXPECT_NEAR(last, law.high_share(), 4.0 * sd);
}

TEST_P(TelegraphAt, DwellsForExponentialTimes) {
    const TelegraphLaw law = GetParam();
    // Sampled, an exponential dwell lasts a geometric number of samples. P(leaves within one sample):
    const double forgotten = 1.0 - law.correlation();
    const double leave_high = (1.0 - law.high_share()) * forgotten;
    const double leave_low = law.high_share() * forgotten;
    std::array<Samples, 2> dwells;  // high, low
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        for (const Samples& axis : rates_dps(law.model(), law.rate_hz, seed, 32)) {
            std::size_t since = 0;  // the first dwell and the last one are cut: left out
            for (std::size_t i = 1; i < axis.size(); ++i) {
                if (axis[i] == axis[i - 1]) { continue; }
                if (since != 0) {
                    dwells[axis[i - 1] > 0.0 ? 0 : 1].push_back(static_cast<double>(i - since));
                }
                since = i;
            }
        }
    }
    for (const auto& [lengths, leave] : {std::pair(dwells[0], leave_high), std::pair(dwells[1], leave_low)}) {
        const auto n = static_cast<double>(lengths.size());
        ASSERT_GT(n, 400.0);
        const double mean = std::accumulate(lengths.begin(), lengths.end(), 0.0) / n;
        EXPECT_NEAR(mean * leave, 1.0, 4.0 * std::sqrt((1.0 - leave) / n));
        // Chi-square over classes of at least an eighth of the probability each.
        double chi_square = 0.0;
        double degrees = -1.0;
        double from = 0.0;
        while (std::pow(1.0 - leave, from) * n > 20.0) {
            double to = from + 1.0;
            const double at_from = std::pow(1.0 - leave, from);
            while (at_from - std::pow(1.0 - leave, to) < 0.125 && std::pow(1.0 - leave, to) * n > 20.0) {
                to += 1.0;
            }
            const bool last = std::pow(1.0 - leave, to) * n <= 20.0;
            const double expected = n * (last ? at_from : at_from - std::pow(1.0 - leave, to));
            const auto seen = static_cast<double>(std::ranges::count_if(
                lengths, [&](double length) { return length > from && (last || length <= to); }));
            chi_square += (seen - expected) * (seen - expected) / expected;
            degrees += 1.0;
            from = to;
        }
        ASSERT_GT(degrees, 0.0);
        EXPECT_LT(chi_square, chi_square_limit(degrees)) << degrees << " degrees of freedom";
    }
}

TEST_P(TelegraphAt, HasALorentzianSpectrumFoldedAtHalfTheRate) {
    const TelegraphLaw law = GetParam();
    const double r = law.correlation();
    // Two levels are not Gaussian: slow telegraphs' periodograms scatter a little more.
    expect_spectrum(law.model(), law.rate_hz, 2, 0.03, [&](double nu) {
        return law.variance() * (1.0 - r * r) / (1.0 - 2.0 * r * std::cos(2.0 * pi * nu) + r * r);
    });
}

TEST(Telegraph, AxesSwitchIndependently) {
    const TelegraphLaw law{0.05, 0.05, 100.0};
    double product = 0.0;
    double n = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const auto axes = rates_dps(law.model(), law.rate_hz, seed, 16);
        for (std::size_t i = 0; i < axes[0].size(); ++i) {
            product += axes[0][i] * axes[1][i] + axes[1][i] * axes[2][i] + axes[2][i] * axes[0][i];
            n += 3.0;
        }
    }
    const double r2 = law.correlation() * law.correlation();
    const double independent = n * (1.0 - r2) / (1.0 + r2);
    EXPECT_NEAR(product / n, 0.0, 4.0 * law.variance() / std::sqrt(independent));
}

class HeavyTailOf : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Degrees, HeavyTailOf, testing::Values(2.5, 3.5, 5.0, 12.0, 150.0));

TEST_P(HeavyTailOf, IsStudentsTOfTheModelsVariance) {
    const double nu = GetParam();
    constexpr double rate_hz = 100.0;
    constexpr double N_dps = 0.01;
    const SensorModel model = with_effect(white_model(N_dps * rad_per_deg), "heavy_tail", {{"nu", nu}});
    const double unit_dps = N_dps * std::sqrt(rate_hz) * std::sqrt((nu - 2.0) / nu);
    const boost::math::students_t student(nu);
    for (const Samples& axis : rates_dps(model, rate_hz, 11, 30)) {
        EXPECT_LT(
            kolmogorov_distance(axis, [&](double x) { return boost::math::cdf(student, x / unit_dps); }),
            kolmogorov_limit);
        // The tails, where that distance sees nothing.
        for (const double p : {1e-3, 1e-4}) {
            const double beyond = unit_dps * boost::math::quantile(boost::math::complement(student, 0.5 * p));
            const auto seen = static_cast<double>(
                std::ranges::count_if(axis, [&](double x) { return std::fabs(x) > beyond; }));
            const double expected = p * static_cast<double>(axis.size());
            EXPECT_NEAR(seen, expected, 4.0 * std::sqrt(expected)) << "p = " << p;
        }
    }
}

TEST(HeavyTail, HasTheVarianceAndTheKurtosisOfItsDegreesOfFreedom) {
    constexpr double nu = 12.0;
    constexpr double rate_hz = 100.0;
    const SensorModel model = with_effect(white_model(0.1 * rad_per_deg), "heavy_tail", {{"nu", nu}});
    double second = 0.0;
    double fourth = 0.0;
    double n = 0.0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        for (const Samples& axis : rates_dps(model, rate_hz, seed, 100)) {
            for (const double x : axis) {
                second += x * x;
                fourth += x * x * x * x;
            }
            n += static_cast<double>(axis.size());
        }
    }
    // Moments of t about zero, in units of its variance: E4 = 3 (nu-2)/(nu-4) and
    // E8 = 105 (nu-2)^3/((nu-4)(nu-6)(nu-8)).
    constexpr double E4 = 3.0 * 10.0 / 8.0;
    constexpr double E8 = 105.0 * 1000.0 / (8.0 * 6.0 * 4.0);
    EXPECT_NEAR(second / n, 1.0, 4.0 * std::sqrt((E4 - 1.0) / n));
    EXPECT_NEAR(fourth / n, 3.0 + 6.0 / (nu - 4.0), 4.0 * std::sqrt((E8 - E4 * E4) / n));
}

TEST(HeavyTail, IsWhite) {
    const SensorModel model = with_effect(white_model(0.1 * rad_per_deg), "heavy_tail", {{"nu", 6.0}});
    expect_spectrum(model, 100.0, 2, 0.0, [](double) { return 1.0; });
    const Samples x = rates_dps(model, 100.0, 1, 200)[0];
    for (const std::size_t lag : {1U, 2U, 3U, 4U, 1024U}) {
        EXPECT_NEAR(lagged_product(x, lag), 0.0, 4.0 / std::sqrt(static_cast<double>(x.size() - lag))) << lag;
    }
}

TEST(CommonMode, CorrelatesTheAxesByItsShareOfTheirNoise) {
    constexpr double rate_hz = 100.0;
    SensorModel model = with_effect(white_model(0.006 * rad_per_deg), "common_mode",
                                    {{"N_dps_per_sqrt_hz", 0.005}, {"gain_y", 0.6}, {"gain_z", -0.8}});
    const Vector3 gains = {1.0, 0.6, -0.8};
    const auto axes = rates_dps(model, rate_hz, 2, 200);
    const auto n = static_cast<double>(axes[0].size());
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = a; b < 3; ++b) {
            double product = 0.0;
            for (std::size_t i = 0; i < axes[a].size(); ++i) { product += axes[a][i] * axes[b][i] / n; }
            const double common = 25e-6 * gains[a] * gains[b] * rate_hz;
            const auto variance = [&](std::size_t axis) {
                return (36e-6 + 25e-6 * gains[axis] * gains[axis]) * rate_hz;
            };
            const double expected = a == b ? variance(a) : common;
            // Isserlis: var(xy) = var(x) var(y) + cov(x, y)^2.
            const double sd = std::sqrt((variance(a) * variance(b) + expected * expected) / n);
            EXPECT_NEAR(product, expected, 4.0 * sd) << a << " " << b;
        }
    }
}

TEST(TemperatureEffects, ARegressionFindsTheSlopeWithinItsStandardError) {
    constexpr double rate_hz = 10.0;
    constexpr double slope_dps_per_C = 0.002;
    constexpr double N_dps = 0.02;
    const auto world = std::make_shared<FormulaWorld>();
    world->temperature_C = [](double t_s) { return 25.0 + 10.0 * triangle(t_s / 50.0); };
    const SensorModel model =
        with_effect(white_model(N_dps * rad_per_deg), "temp_linear", {{"c1_dps_per_C", slope_dps_per_C}});
    double chi_square = 0.0;
    constexpr unsigned seeds = 100;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        const Simulated out = simulate(model, rate_hz, seed, 1, world);
        for (const Samples& rate_rad_s : out.rate_rad_s) {
            double C = 0.0;
            double CC = 0.0;
            double y = 0.0;
            double Cy = 0.0;
            const auto n = static_cast<double>(out.size());
            for (std::size_t i = 0; i < out.size(); ++i) {
                const double above_C = out.die_C[i] - 25.0;
                C += above_C;
                CC += above_C * above_C;
                y += rate_rad_s[i] * deg_per_rad;
                Cy += above_C * rate_rad_s[i] * deg_per_rad;
            }
            const double spread = CC - C * C / n;
            const double found = (Cy - C * y / n) / spread;
            const double standard_error = N_dps * std::sqrt(rate_hz / spread);
            chi_square += std::pow((found - slope_dps_per_C) / standard_error, 2);
        }
    }
    EXPECT_LT(chi_square, chi_square_limit(3.0 * seeds));
    EXPECT_GT(chi_square, 3.0 * seeds - 4.0 * std::sqrt(2.0 * 3.0 * seeds));
}

}  // namespace
}  // namespace gyrolog
