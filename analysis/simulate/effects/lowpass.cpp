// The sensor's digital low-pass filter, which runs much faster than the samples are read: a continuous filter
// H, then a sampler with nothing before it, so that what the filter leaves above half the rate folds.
//
//   order 1:  H(s) = w / (s + w)
//   order 2:  H(s) = w^2 / (s^2 + sqrt 2 w s + w^2), Butterworth,             w = 2 pi fc
//
// White noise. Behind the filter, noise of two-sided density N^2 has the covariance
//   order 1:  N^2 w/2 exp(-w t)
//   order 2:  N^2 a/2 exp(-a t) (cos a t + sin a t),                          a = w / sqrt 2, t >= 0
// (variances N^2 pi fc and N^2 pi fc / sqrt 2). Its samples, T apart, are an autoregression with a moving
// average of one term less (G. E. P. Box, G. M. Jenkins, G. C. Reinsel, Time Series Analysis, A4.1):
//   y_k = phi_1 y_{k-1} + phi_2 y_{k-2} + b (e_k + m e_{k-1}),  e of variance one,
// folded spectrum included. Order 1: phi_1 = exp(-w T), m = 0. Order 2, with q = a T:
//   phi_1 = 2 exp(-q) cos q, phi_2 = -exp(-2 q). The remainder v_k = y_k - phi_1 y_{k-1} - phi_2 y_{k-2} is
//   the filter's impulse response 2 a exp(-a t) sin a t over the last interval, and over the one before what
//   the recursion has left of it, 2 a exp(-q - a t) sin(q - a t). So, in units of N^2 / T,
//
//     var v_k         = 4 q (I(sin^2 x) + exp(-2 q) I(sin^2(q - x))),
//     cov v_k, v_k-1  = 4 q exp(-q) I(sin x sin(q - x)),
//     I(g)            = integral of exp(-2 x) g from x = 0 to q,
//
// and the spectral factor with |m| < 1 follows from their ratio.
//
// All else in the signal passes the filter as cubics through four samples, solved exactly: these
// miss at most (2 pi f T)^4 / 24 of a sine. It starts in the steady state of its first value.
#include <algorithm>
#include <cmath>
#include <complex>

#include "analysis/simulate/effects/axis_filters.hpp"
#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

namespace {

double portable_sine(double x) { return portable_sine_of_turns(x / (2.0 * pi)); }
double portable_cosine(double x) { return portable_sine_of_turns(x / (2.0 * pi) + 0.25); }
// 0 where e^x is too small to matter.
double decay(double x) { return x < 700.0 ? portable_exp(-x) : 0.0; }

// The samples of filtered white noise, from unit white noise, and their covariance at no lag and at one; all
// in units of N^2 / T.
struct NoiseFilter {
    double phi_1;
    double phi_2;
    double b;
    double m;
    double covariance_0;
    double covariance_1;
};

NoiseFilter first_order_noise(double w_T) {
    const double phi = decay(w_T);
    const double variance = 0.5 * w_T;
    return {.phi_1 = phi,
            .phi_2 = 0.0,
            .b = std::sqrt(variance * (1.0 - phi * phi)),
            .m = 0.0,
            .covariance_0 = variance,
            .covariance_1 = variance * phi};
}

// The three integrals I of the file's head, by Simpson's rule: within 4e-6, and 2e-7 up to a cut-off at twice
// the rate. exp(-2 x) leaves nothing beyond 20.
struct Integrals {
    double last = 0.0;    // of sin^2 x
    double before = 0.0;  // of sin^2(q - x)
    double both = 0.0;    // of sin x sin(q - x)
};

Integrals decaying_integrals(double q) {
    constexpr int panels = 400;
    const double step = std::min(q, 20.0) / panels;
    Integrals sum;
    for (int i = 0; i <= panels; ++i) {
        const double x = step * i;
        const double weight = i == 0 || i == panels ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        const double share = weight * step / 3.0 * decay(2.0 * x);
        const double now = portable_sine(x);
        const double then = portable_sine(q - x);
        sum.last += share * now * now;
        sum.before += share * then * then;
        sum.both += share * now * then;
    }
    return sum;
}

NoiseFilter second_order_noise(double q) {
    const double rho = decay(q);
    const Integrals integrals = decaying_integrals(q);
    const double variance = 4.0 * q * (integrals.last + rho * rho * integrals.before);
    const double ratio = 4.0 * q * rho * integrals.both / variance;
    // The root of m / (1 + m^2) = ratio below one, in a form that lets the ratio vanish.
    const double m = 2.0 * ratio / (1.0 + std::sqrt(1.0 - 4.0 * ratio * ratio));
    const double cosine = portable_cosine(q);
    return {.phi_1 = 2.0 * rho * cosine,
            .phi_2 = -rho * rho,
            .b = std::sqrt(variance / (1.0 + m * m)),
            .m = m,
            .covariance_0 = 0.5 * q,
            .covariance_1 = 0.5 * q * rho * (cosine + portable_sine(q))};
}

// One axis of the noise. State: y and e of the samples before.
class FilteredNoise {
public:
    explicit FilteredNoise(const NoiseFilter& filter) : filter_(filter) {}

    // In the stationary state. `draws`: three standard normal ones; `sd`: of the white noise that will
    // follow.
    void start(const std::array<double, 3>& draws, double sd) {
        const NoiseFilter& f = filter_;
        white_before_ = draws[0];
        y_before_2_ = std::sqrt(f.covariance_0) * draws[1];
        const double common = f.covariance_1 / f.covariance_0;
        const double rest = f.covariance_0 - f.b * f.b - common * f.covariance_1;
        y_before_ = f.b * white_before_ + common * y_before_2_ + std::sqrt(std::max(rest, 0.0)) * draws[2];
        for (double* state : {&white_before_, &y_before_2_, &y_before_}) { *state *= sd; }
    }

    double operator()(double white) {
        const NoiseFilter& f = filter_;
        const double y = f.phi_1 * y_before_ + f.phi_2 * y_before_2_ + f.b * (white + f.m * white_before_);
        y_before_2_ = y_before_;
        y_before_ = y;
        white_before_ = white;
        return y;
    }

private:
    NoiseFilter filter_;
    double y_before_ = 0.0;
    double y_before_2_ = 0.0;
    double white_before_ = 0.0;
};

// One axis of all else: the filter's response to a cubic through the last four samples, over the last
// interval. A polynomial u is answered by sum c_n u^(n) / a^n for ever (c = 1, -1, 1, -1 of order 1 with a =
// w; 1, -1, 1/2, 0 of order 2 with a = w / sqrt 2); what the state differs from that rings off. State: output
// and its slope (per sample).
class FilteredSignal {
public:
    FilteredSignal(int order, double w_T) : order_(order), a_T_(order == 1 ? w_T : w_T / std::sqrt(2.0)) {
        decay_ = decay(a_T_);
        cosine_ = portable_cosine(a_T_);
        sine_ = portable_sine(a_T_);
    }

    void start(double input) {
        inputs_.fill(input);
        output_ = input;
    }

    double operator()(double input) {
        const auto& [third, second, first] = inputs_;  // the samples before, the last one last
        const double rise = input - first;
        const double bend = input - 2.0 * first + second;
        const double twist = input - 3.0 * first + 3.0 * second - third;
        const State from = lasting({first, rise - bend / 2.0 - twist / 6.0, bend, twist});
        const State to = lasting({input, rise + bend / 2.0 + twist / 3.0, bend + twist, twist});
        const double off = output_ - from.value;
        if (order_ == 1) {
            output_ = to.value + decay_ * off;
        } else {
            const double off_slope = slope_ - from.slope;
            output_ = to.value + decay_ * (off * (cosine_ + sine_) + off_slope / a_T_ * sine_);
            slope_ = to.slope + decay_ * (off_slope * (cosine_ - sine_) - 2.0 * a_T_ * off * sine_);
        }
        inputs_ = {second, first, input};
        return output_;
    }

private:
    struct State {
        double value;
        double slope;
    };

    // `u`: the cubic and its derivatives.
    State lasting(const std::array<double, 4>& u) const {
        const double lag = 1.0 / a_T_;
        if (order_ == 1) { return {u[0] - lag * (u[1] - lag * (u[2] - lag * u[3])), 0.0}; }
        return {u[0] - lag * (u[1] - 0.5 * lag * u[2]), u[1] - lag * (u[2] - 0.5 * lag * u[3])};
    }

    int order_;
    double a_T_;
    double decay_;
    double cosine_;
    double sine_;
    std::array<double, 3> inputs_{};
    double output_ = 0.0;
    double slope_ = 0.0;
};

struct LowpassAxis {
    FilteredNoise noise;
    FilteredSignal signal;
    RandomStream draws;

    void start(double first_rad_s, double white_sd_rad_s) {
        signal.start(first_rad_s);
        noise.start({draws.normal(0), draws.normal(1), draws.normal(2)}, white_sd_rad_s);
    }
};

std::unique_ptr<Stage> make_lowpass(const EffectUse& use) {
    const int order = use["order"] == 1.0 ? 1 : 2;
    const double w_T = 2.0 * pi * use["fc_hz"] / use.context().rate_hz;
    const NoiseFilter noise = order == 1 ? first_order_noise(w_T) : second_order_noise(w_T / std::sqrt(2.0));
    return std::make_unique<AxisFilters<LowpassAxis>>(use, [&](std::size_t axis) {
        return LowpassAxis{FilteredNoise(noise), FilteredSignal(order, w_T), use.stream(axis)};
    });
}

constexpr EffectParam lowpass_params[] = {
    {.name = "fc_hz",
     .meaning = "-3 dB frequency; it may lie above half the sample rate",
     .range = EffectParam::Range::positive,
     .plausible_from = 5.0,
     .plausible_to = 250.0},
    {.name = "order",
     .meaning = "1, or 2 for Butterworth",
     .plausible_from = 1.0,
     .plausible_to = 2.0,
     .otherwise = 2.0,
     .whole_up_to = 2.0},
};

void lowpass_spectrum(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                      std::span<SpectralParts> parts) {
    const bool first_order = effect["order"] == 1.0;
    const double w_T = 2.0 * pi * effect["fc_hz"] / rate_hz;
    const NoiseFilter filter =
        first_order ? first_order_noise(w_T) : second_order_noise(w_T / std::sqrt(2.0));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double angle = 2.0 * pi * f_hz[i] / rate_hz;
        const std::complex<double> back = std::polar(1.0, -angle);
        const double gain = filter.b * filter.b * std::norm(1.0 + filter.m * back) /
                            std::norm(1.0 - filter.phi_1 * back - filter.phi_2 * back * back);
        parts[i].white *= gain;
        parts[i].added_white *= gain;
        // Slow noise has nothing that could fold.
        const double ratio = f_hz[i] / effect["fc_hz"];
        const double slow_gain = 1.0 / (1.0 + std::pow(ratio, first_order ? 2.0 : 4.0));
        parts[i].flicker *= slow_gain;
        parts[i].walk *= slow_gain;
        parts[i].added_signal *= slow_gain;
    }
}

constexpr std::string_view lowpass_fitted[] = {"fc_hz"};
constexpr double lowpass_orders[] = {1.0, 2.0};
constexpr TrialValues first_order_values[] = {{.param = "order", .from = 1.0, .to = 1.0, .count = 1},
                                              {.param = "fc_hz", .from = 4.0, .to = 300.0, .count = 18}};
constexpr TrialValues second_order_values[] = {{.param = "order", .from = 2.0, .to = 2.0, .count = 1},
                                               {.param = "fc_hz", .from = 4.0, .to = 300.0, .count = 18}};
constexpr std::span<const TrialValues> lowpass_trials[] = {second_order_values, first_order_values};

constexpr EffectSignature lowpass_signature = {
    .changes_mean = true,
    .folds = true,
    .trials = lowpass_trials,
    .spectral = lowpass_fitted,
    .form = "order",
    .form_values = lowpass_orders,
    .spectrum = lowpass_spectrum,
    .words = "A low-pass filter of order {order} at {fc_hz} is missing in the model",
    .noun = "a low-pass filter at {fc_hz}",
    .decided_by = "a recording at a higher sample rate, or one with fast motion",
};

}  // namespace

constinit const EffectDefinition lowpass_effect = {
    .name = "lowpass",
    .model =
        "1 / (1 + s/w), or Butterworth's 1 / (1 + sqrt 2 s/w + s^2/w^2), w = 2 pi fc_hz, on the signal in "
        "continuous time and then sampled, so that the noise folds",
    .source = "definition; the samples of white noise: Box, Jenkins, Reinsel, Time Series Analysis, A4.1",
    .params = lowpass_params,
    .make = make_lowpass,
    .signature = &lowpass_signature,
};

}  // namespace gyrolog
