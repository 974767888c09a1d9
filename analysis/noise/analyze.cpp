#include "analysis/noise/analyze.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <sstream>

#include "analysis/noise/axis_warnings.hpp"
#include "analysis/noise/clipping.hpp"
#include "analysis/noise/converter_step.hpp"
#include "analysis/noise/likelihood_fit.hpp"
#include "analysis/parallel/parallel_for.hpp"

namespace gyrolog {
namespace {

bool is_gyro(const Column& column) { return column.name.size() >= 2 && column.name[0] == 'g'; }

RateUnit unit_of(const Column& column) {
    if (column.unit == "lsb") { return {"lsb", 1.0}; }
    if (column.source_unit == "rad_s") { return {"rad/s", 1.0}; }
    return {"dps", deg_per_rad};
}

// An axis on its way: what its column is analysed as, and the curve that the fit starts from.
struct Work {
    const Column* column = nullptr;
    Column without_outliers;  // empty unless robust
    AllanCurve whole;         // overlapping, at the usual averaging factors
    AxisReport report;
};

void find_curves(Work& work, const Recording& recording, const AnalysisOptions& options) {
    if (options.robust) {
        work.without_outliers = *work.column;
        work.report.outliers = replace_outliers(work.without_outliers, recording.segments);
        work.column = &work.without_outliers;
    }
    AxisReport& axis = work.report;
    axis.axis = work.column->name.substr(1);
    axis.curve = allan_deviation(*work.column, recording.segments, recording.rate_hz, options);
    work.whole = axis.curve;
    if (!options.m.empty() || options.every_m || options.kind != DeviationKind::overlapping) {
        AllanOptions usual{.confidence = options.confidence, .m = {}, .threads = options.threads};
        usual.convention = options.convention;
        work.whole = allan_deviation(*work.column, recording.segments, recording.rate_hz, usual);
    }
    axis.slopes = read_slopes(work.whole);
}

void find_spectrum(Work& work, const Recording& recording, const AnalysisOptions& options) {
    const auto periodograms = averaged_periodograms(*work.column, recording.segments, recording.rate_hz);
    work.report.spectrum = power_spectrum(periodograms, {.confidence = options.confidence});
    work.report.lines = find_lines(periodograms, *work.column, recording.segments, recording.rate_hz);
}

void find_coefficients(Work& work, const Recording& recording, const AnalysisOptions& options) {
    const Column& column = *work.column;
    AxisReport& axis = work.report;
    axis.fit = fit_noise(work.whole, options.confidence);
    LikelihoodFitOptions fit;
    fit.confidence = options.confidence;
    fit.step = converter_step(column);
    for (const SpectralLine& line : axis.lines) {
        fit.lines.push_back({{line.amplitude, line.f_hz}, line.amplitude_sd, line.f_sd_hz});
    }
    if (auto likely = fit_likelihood(column, recording.segments, recording.rate_hz, axis.fit, fit)) {
        axis.fit = *std::move(likely);
    }
    // Of a few samples only their own scatter is known.
    if (axis.fit.method == FitMethod::curve) { axis.fit.mean_dof = static_cast<double>(column.size()) - 1.0; }
    axis.bias = static_bias(column, recording.rate_hz, axis.fit);
}

// Averaging factors that were asked for and cannot be answered.
std::vector<std::string> refused_factors(const AnalysisOptions& options, const AllanCurve& curve) {
    std::vector<std::string> warnings;
    for (const std::int64_t m : options.m) {
        if (std::ranges::find(curve.points, m, &AllanPoint::m) == curve.points.end()) {
            warnings.push_back("m = " + std::to_string(m) +
                               " left out: the record has no unbroken stretch long enough for it");
        }
    }
    return warnings;
}

std::string rounded(double value) {
    std::ostringstream text;
    text << std::setprecision(2) << value;
    return text.str();
}

// Coefficients of a spectrum that the model does not follow are no property of the sensor.
void warn_of_misfit(const AxisReport& axis, AxisWarnings& warnings) {
    constexpr double allowed_error = 0.05;
    constexpr double hopeless_error = 0.5;
    const NoiseFit& fit = axis.fit;
    if (fit.upper_frequency_hz > 0.0) {
        warnings.add(axis.axis,
                     "at high frequencies the spectrum does not follow the model (a filter or vibration "
                     "does that); the coefficients are those of what lies below",
                     "above " + rounded(fit.upper_frequency_hz) + " Hz");
    }
    if (fit.method == FitMethod::likelihood && fit.model_error > hopeless_error) {
        warnings.add(axis.axis,
                     "this is not the noise of a sensor at rest (motion, vibration?): the "
                     "coefficients mean nothing");
    } else if (fit.method == FitMethod::likelihood && fit.model_error > allowed_error) {
        warnings.add(axis.axis,
                     "the spectrum departs from the model (a filter, vibration or temperature does "
                     "that); the uncertainties allow for it as well as they can");
    }
    if (axis.outliers.samples > 0) {
        warnings.add(axis.axis, "outliers were replaced by the median of their neighbours",
                     std::to_string(axis.outliers.samples));
    }
    constexpr double heavy_tails = 1.0;
    if (axis.bias.excess_kurtosis > heavy_tails) {
        warnings.add(axis.axis, "the samples have heavy tails or outliers: see what --robust changes",
                     "excess kurtosis " + rounded(axis.bias.excess_kurtosis));
    }
    if (!axis.curve.points.empty() && axis.bias.sample_sd == 0.0) {
        warnings.add(axis.axis,
                     "all samples are equal: the axis is stuck, or its noise is below the resolution");
    }
}

// A clock that is off makes every averaging time wrong by as much.
void warn_of_rate(const AnalysisReport& report, std::vector<std::string>& warnings) {
    constexpr double allowed = 1e-3;
    if (!report.nominal_rate_hz || !(*report.nominal_rate_hz > 0.0)) { return; }
    const double error = report.rate_hz / *report.nominal_rate_hz - 1.0;
    const double sd = report.rate_sd_hz ? *report.rate_sd_hz / report.rate_hz : 0.0;
    if (std::abs(error) < std::max(allowed, 5.0 * sd)) { return; }
    std::ostringstream text;
    text << "the rate is " << std::setprecision(6) << report.rate_hz << " Hz, " << std::showpos
         << std::setprecision(2) << error * 100.0 << std::noshowpos << std::setprecision(6)
         << " % off the nominal " << *report.nominal_rate_hz
         << " Hz; averaging times follow the measured rate";
    warnings.push_back(text.str());
}

void count_holes(const Recording& recording, AnalysisReport& report) {
    const Stops stops = recording.stops();
    report.stops = stops.events;
    report.stopped_s = stops.s;
    report.dropouts = recording.dropouts.size() - stops.events;
    report.samples_missing = recording.missing_samples() - stops.instants;
}

}  // namespace

AnalysisReport analyze(const Recording& recording, const AnalysisOptions& options) {
    AnalysisReport report;
    report.name = recording.name;
    report.rate_hz = recording.rate_hz;
    report.rate_sd_hz = recording.rate_sd_hz;
    report.nominal_rate_hz = recording.nominal_rate_hz;
    report.stamps = recording.stamps;
    report.duration_s = recording.duration_s();
    report.samples = recording.rows();
    count_holes(recording, report);
    report.segments = recording.segments.size();
    report.kind = options.kind;
    report.convention = options.convention;
    report.confidence = options.confidence;
    report.warnings = recording.warnings;
    if (recording.rows() < 2) {
        report.warnings.emplace_back("fewer than two samples: nothing to analyse");
        return report;
    }
    warn_of_rate(report, report.warnings);
    std::vector<Work> axes;
    for (const Column& column : recording.columns) {
        if (!is_gyro(column)) { continue; }
        if (axes.empty()) { report.unit = unit_of(column); }
        axes.push_back({&column, {}, {}, {}});
    }
    for (Work& axis : axes) { find_curves(axis, recording, options); }
    options.on_stage("spectrum");
    parallel_for(axes.size(), options.threads,
                 [&](std::size_t i) { find_spectrum(axes[i], recording, options); });
    options.on_stage("fit");
    parallel_for(axes.size(), options.threads,
                 [&](std::size_t i) { find_coefficients(axes[i], recording, options); });
    AxisWarnings warnings;
    for (Work& axis : axes) {
        warn_of_misfit(axis.report, warnings);
        if (is_clipped(*axis.column)) {
            warnings.add(axis.report.axis,
                         "the samples are clipped: more lie at their limit than next to it, and "
                         "the noise is larger than these coefficients say");
        }
        report.axes.push_back(std::move(axis.report));
    }
    std::ranges::copy(warnings.lines(), std::back_inserter(report.warnings));
    if (report.axes.empty()) {
        report.warnings.emplace_back("no gyro column: nothing to analyse");
        return report;
    }
    const auto refused = refused_factors(options, report.axes.front().curve);
    report.warnings.insert(report.warnings.end(), refused.begin(), refused.end());
    return report;
}

}  // namespace gyrolog
