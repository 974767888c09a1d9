#include "analysis/noise/noise_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "analysis/numerics/square.hpp"

namespace gyrolog {
namespace {

using ComponentSquares = std::vector<double>;

constexpr double price_of_a_term = 4.0;  // in the sparse model
// A Gauss-Markov term has two parameters, and its correlation time was searched for.
constexpr double gauss_markov_gain = 8.0;
// White noise behind a low pass has the spectrum of Gauss-Markov noise. A gyro's own filter is wider than 5
// Hz (32 ms), and its drift slower than this.
constexpr double fastest_drift_s = 0.1;
constexpr double clear_error = 0.05;    // a departure beyond which the model is amended
constexpr double least_periods = 32.0;  // in the record, of the highest frequency that is left

// ComponentSquares to begin with, from the curve's fit; white noise from the fastest contrasts, so that it is
// never 0.
ComponentSquares first_guess(const ContrastPyramid& pyramid, const SpectrumModel& model,
                             const NoiseFit& start) {
    const NoiseCoefficients& curve = start.best.coefficients;
    double white = 0.0;
    if (!pyramid.levels.empty()) {
        white = pyramid.levels.front().power.back() / pyramid.rate_hz;
    } else {
        for (const TopAverage& sample : pyramid.top) { white += square(sample.value) / pyramid.rate_hz; }
        white /= static_cast<double>(pyramid.top.size());
    }
    ComponentSquares squares(model.components(), 0.0);
    squares[0] = std::max(square(curve.N_rad_per_sqrt_s), 0.01 * white);
    squares[1] = square(curve.B_rad_per_s);
    squares[2] = square(curve.K_rad_per_s_sqrt_s);
    for (std::size_t i = 0; i < model.lines.size(); ++i) {
        squares[model.gauss_markov_at(model.correlations_s.size() + i)] =
            square(model.lines[i].value.amplitude_rad_per_s);
    }
    return squares;
}

// The relative departure of the spectrum from the model that makes the contrasts' misfits as large as chance
// and it together lead one to expect (Paule and Mandel, J. Res. NBS 87 (1982) 377-385).
// Only contrasts known to some percent can tell; without enough of them: nothing.
std::optional<double> departure(const std::vector<ContrastMisfit>& misfits, double upper_hz) {
    std::vector<ContrastMisfit> counted;
    std::ranges::copy_if(misfits, std::back_inserter(counted), [&](const ContrastMisfit& misfit) {
        return misfit.f_hz <= upper_hz && misfit.dof >= 500.0;
    });
    if (counted.size() < 6) { return std::nullopt; }
    const auto excess = [&](double error) {
        double sum = 0.0;
        for (const ContrastMisfit& misfit : counted) {
            sum += square(misfit.ratio - 1.0) / (2.0 / misfit.dof + error * error);
        }
        return sum / static_cast<double>(counted.size()) - 1.0;
    };
    // Chance alone is within this, ninety-nine times in a hundred.
    if (excess(0.0) < 2.5 * std::sqrt(2.0 / static_cast<double>(counted.size()))) { return 0.0; }
    double low = 0.0;
    double high = 10.0;
    for (int pass = 0; pass < 40; ++pass) {
        const double middle = 0.5 * (low + high);
        (excess(middle) > 0.0 ? low : high) = middle;
    }
    return high;
}

// Fits a model, and again with the departure that the first fit shows, until it stands still.
Fitted fit(const ContrastPyramid& pyramid, SpectrumModel model, ComponentSquares start) {
    Fitted fitted{std::move(model), {}};
    for (int pass = 0; pass < 6; ++pass) {
        const NoiseLikelihood likelihood = likelihood_of(pyramid, fitted.model);
        fitted.maximum = maximise(likelihood, start);
        if (!std::isfinite(fitted.maximum.value)) { return fitted; }
        const double error =
            departure(likelihood.misfits(fitted.maximum.squares), fitted.model.upper_hz).value_or(0.0);
        if (std::abs(error - fitted.model.error) <= 0.05 * error) { return fitted; }
        fitted.model.error = error;
        start = fitted.maximum.squares;
    }
    // The squares belong to the departure that the model now has.
    fitted.maximum = maximise(likelihood_of(pyramid, fitted.model), start);
    return fitted;
}

// Leaves out the upper end of the band, octave by octave, until what is left agrees with the model.
Fitted without_upper_end(const ContrastPyramid& pyramid, const Fitted& whole) {
    Fitted best = whole;
    const int octaves = static_cast<int>(std::log2(pyramid.length() / least_periods));
    for (int octave = 2; octave < octaves; ++octave) {
        const double upper_hz = pyramid.rate_hz * std::exp2(-octave);
        if (upper_hz >= whole.model.upper_hz) { continue; }
        SpectrumModel model = whole.model;
        model.upper_hz = upper_hz;
        Fitted next = fit(pyramid, model, best.maximum.squares);
        const auto misfits = likelihood_of(pyramid, next.model).misfits(next.maximum.squares);
        if (!std::isfinite(next.value()) || !departure(misfits, upper_hz)) { break; }
        if (next.model.error < 0.7 * best.model.error) { best = std::move(next); }
        if (best.model.error < clear_error) { break; }
    }
    return best;
}

ComponentSquares with_component(ComponentSquares squares, std::size_t at, double value) {
    squares.insert(squares.begin() + static_cast<std::ptrdiff_t>(at), value);
    return squares;
}

Fitted with_gauss_markov(const ContrastPyramid& pyramid, const Fitted& base, double correlation_s) {
    Fitted next = base;
    const std::size_t at = base.model.gauss_markov_at(base.model.correlations_s.size());
    next.model.correlations_s.push_back(correlation_s);
    const NoiseLikelihood likelihood = likelihood_of(pyramid, next.model);
    const double rate = 1.0 / correlation_s;
    const double level = base.maximum.squares[0] * rate;
    next.maximum = maximise(likelihood, with_component(base.maximum.squares, at, 0.3 * level));
    return next;
}

// The best Gauss-Markov term beside what is there, correlation times searched over the whole record.
Fitted search_gauss_markov(const ContrastPyramid& pyramid, const Fitted& base) {
    Fitted best = base;
    constexpr double step = 3.0;
    const double shortest_s = std::max(3.0 / pyramid.rate_hz, fastest_drift_s);
    const int steps =
        static_cast<int>(std::ceil(std::log(pyramid.length_s() / 8.0 / shortest_s) / std::log(step)));
    const auto try_time = [&](double t_s) {
        Fitted next = with_gauss_markov(pyramid, base, t_s);
        if (next.value() > best.value()) { best = std::move(next); }
    };
    for (int i = 0; i < steps; ++i) { try_time(shortest_s * std::pow(step, i)); }
    if (best.model.correlations_s.size() == base.model.correlations_s.size()) { return base; }
    // Few records gain by it, and then the exact time is worth looking for.
    if (best.value() - base.value() < 0.5 * gauss_markov_gain) { return base; }
    constexpr int halvings = 5;
    for (int i = 1; i <= halvings; ++i) {
        const double centre_s = best.model.correlations_s.back();
        const double ratio = std::pow(step, std::exp2(-i));
        try_time(std::max(centre_s / ratio, shortest_s));
        try_time(centre_s * ratio);
    }
    // What is best at the very end of the search is something faster.
    return best.model.correlations_s.back() > 1.5 * shortest_s ? best : base;
}

bool white_noise_stays(const ContrastPyramid& pyramid, const Fitted& fitted) {
    const NoiseLikelihood likelihood = likelihood_of(pyramid, fitted.model);
    return likelihood_ratio(likelihood, fitted.maximum, 0) > identified_ratio;
}

// Gauss-Markov noise where it gains clearly and leaves the white noise in place (a filter on white noise
// looks like it, too); a narrower band where the upper end departs still.
Fitted amended(const ContrastPyramid& pyramid, Fitted fitted) {
    for (int terms = 0; terms < 2; ++terms) {
        const Fitted tried = search_gauss_markov(pyramid, fitted);
        const bool any = tried.model.correlations_s.size() > fitted.model.correlations_s.size();
        if (!any || tried.value() - fitted.value() < gauss_markov_gain) { break; }
        Fitted next = fit(pyramid, tried.model, tried.maximum.squares);
        if (next.model.error > 0.7 * fitted.model.error || !white_noise_stays(pyramid, next)) { break; }
        fitted = std::move(next);
    }
    return fitted.model.error > clear_error ? without_upper_end(pyramid, fitted) : fitted;
}

// Q that was called for before the rest of the model was there may not be any more.
Fitted without_needless_angle_noise(const ContrastPyramid& pyramid, Fitted fitted) {
    if (!fitted.model.angle_noise) { return fitted; }
    const NoiseLikelihood likelihood = likelihood_of(pyramid, fitted.model);
    const std::size_t at = fitted.model.angle_noise_at();
    if (likelihood_ratio(likelihood, fitted.maximum, at) > optional_ratio) { return fitted; }
    SpectrumModel model = fitted.model;
    model.angle_noise = false;
    ComponentSquares squares = fitted.maximum.squares;
    squares.erase(squares.begin() + static_cast<std::ptrdiff_t>(at));
    return fit(pyramid, model, squares);
}

Fitted with_angle_noise(const ContrastPyramid& pyramid, const Fitted& base) {
    const Fitted more = with_angle_noise_added(pyramid, base);
    if (!std::isfinite(more.value())) { return base; }
    const NoiseLikelihood likelihood = likelihood_of(pyramid, more.model);
    const std::size_t at = more.model.angle_noise_at();
    return likelihood_ratio(likelihood, more.maximum, at) > optional_ratio ? more : base;
}

RampFit with_ramp(const ContrastPyramid& pyramid, const Fitted& base) {
    Fitted with = base;
    with.model.ramp = true;
    const NoiseLikelihood likelihood = likelihood_of(pyramid, with.model);
    with.maximum = maximise(likelihood, base.maximum.squares);
    if (!std::isfinite(with.value())) { return {base, {}, 0.0}; }
    // Likelihoods restricted in different ways do not compare: the ramp's term is taken back.
    const RampEstimate ramp = likelihood.ramp(with.maximum.squares);
    return {with, ramp, 2.0 * (with.value() - std::log(ramp.sd_per_s) - base.value())};
}

// The frequency up to which the sensor's filter leaves the noise as it is, for this record; infinity where
// the filter, or none, does not act.
double passband_hz(const ContrastPyramid& pyramid, const LikelihoodFitOptions& options) {
    const double bandwidth_hz = options.bandwidth_hz;
    if (bandwidth_hz <= 0.0 || bandwidth_hz >= options.filter_acts_below * pyramid.rate_hz) {
        return std::numeric_limits<double>::infinity();
    }
    return std::clamp(least_periods / pyramid.length_s(), options.filter_flat_up_to * bandwidth_hz,
                      bandwidth_hz);
}

}  // namespace

NoiseLikelihood likelihood_of(const ContrastPyramid& pyramid, const SpectrumModel& model) {
    NoiseLikelihood likelihood(pyramid, model.ramp);
    likelihood.add(model.bandwidth_hz > 0.0 ? filtered_white_covariance(model.bandwidth_hz, pyramid.rate_hz)
                                            : average_covariance(NoiseTerm::N));
    likelihood.add(average_covariance(NoiseTerm::B));
    likelihood.add(average_covariance(NoiseTerm::K));
    if (model.angle_noise) { likelihood.add(average_covariance(NoiseTerm::Q)); }
    for (const double correlation_s : model.correlations_s) {
        likelihood.add(gauss_markov_covariance(correlation_s));
    }
    for (const FittedSinusoid& line : model.lines) {
        likelihood.add(sinusoid_covariance(line.value.frequency_hz, pyramid.rate_hz));
    }
    likelihood.limit_frequency(model.upper_hz);
    likelihood.tolerate(model.error);
    return likelihood;
}

Fitted with_angle_noise_added(const ContrastPyramid& pyramid, const Fitted& base) {
    SpectrumModel model = base.model;
    model.angle_noise = true;
    const double start = 1e-3 * base.maximum.squares[0] / square(pyramid.rate_hz);
    return fit(pyramid, model, with_component(base.maximum.squares, model.angle_noise_at(), start));
}

bool is_significant(const RampFit& ramp) {
    return std::min(ramp.ratio, square(ramp.ramp.slope_per_s / ramp.ramp.sd_per_s)) > optional_ratio;
}

LikelihoodMaximum with_needed_terms(const ContrastPyramid& pyramid, const Fitted& fitted) {
    const NoiseLikelihood likelihood = likelihood_of(pyramid, fitted.model);
    LikelihoodMaximum best;
    double most = -std::numeric_limits<double>::infinity();
    for (const std::vector<std::size_t>& left_out :
         {std::vector<std::size_t>{1, 2}, std::vector<std::size_t>{2}, std::vector<std::size_t>{1},
          std::vector<std::size_t>{}}) {
        ComponentSquares start = fitted.maximum.squares;
        for (const std::size_t component : left_out) { start[component] = 0.0; }
        LikelihoodMaximum tried = maximise(likelihood, start, left_out);
        const double kept = 2.0 * tried.value + price_of_a_term * static_cast<double>(left_out.size());
        if (kept > most) {
            most = kept;
            best = std::move(tried);
        }
    }
    return best;
}

SearchResult search_terms(const ContrastPyramid& pyramid, const NoiseFit& start,
                          const LikelihoodFitOptions& options) {
    SpectrumModel model;
    model.lines = options.lines;
    model.upper_hz = passband_hz(pyramid, options);
    if (std::isfinite(model.upper_hz)) { model.bandwidth_hz = options.bandwidth_hz; }
    SearchResult result{fit(pyramid, model, first_guess(pyramid, model, start)), {}};
    if (!std::isfinite(result.fitted.value())) { return result; }
    result.fitted = amended(pyramid, with_angle_noise(pyramid, result.fitted));
    result.ramp = with_ramp(pyramid, result.fitted);
    result.fitted = without_needless_angle_noise(
        pyramid, is_significant(result.ramp) ? result.ramp.fitted : std::move(result.fitted));
    return result;
}

}  // namespace gyrolog
