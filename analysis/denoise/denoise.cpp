#include "analysis/denoise/denoise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/denoise/axis_denoiser.hpp"
#include "analysis/noise/analyze.hpp"
#include "analysis/parallel/parallel_for.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t failures_listed = 1000;
constexpr double longest_lag_least_s = 0.25;

double variance_of(std::span<const double> values, std::span<const Segment> segments) {
    double sum = 0.0;
    double squares = 0.0;
    double count = 0.0;
    double origin = std::numeric_limits<double>::quiet_NaN();
    for (const Segment& segment : segments) {
        for (std::size_t i = segment.first; i < segment.first + segment.count; ++i) {
            if (std::isnan(values[i])) { continue; }
            if (std::isnan(origin)) { origin = values[i]; }
            sum += values[i] - origin;
            squares += (values[i] - origin) * (values[i] - origin);
            count += 1.0;
        }
    }
    return count > 1.0 ? std::max(0.0, squares - sum * sum / count) / (count - 1.0) : 0.0;
}

// How often a sample equals the one before.
double repeat_share(const Column& column, std::span<const Segment> segments) {
    std::size_t repeats = 0;
    std::size_t steps = 0;
    for (const Segment& segment : segments) {
        for (std::size_t i = segment.first + 1; i < segment.first + segment.count; ++i) {
            repeats += column.value(i) == column.value(i - 1) ? 1U : 0U;
            ++steps;
        }
    }
    return steps == 0 ? 0.0 : static_cast<double>(repeats) / static_cast<double>(steps);
}

UnitLimits limits_of(const Column& column, std::span<const Segment> segments, const UnitNoise& noise,
                     std::optional<double> saturation) {
    UnitLimits limits;
    limits.white_sd = std::sqrt(noise.white_variance);
    limits.repeats_most = repeats_allowed(repeat_share(column, segments));
    if (saturation) {
        limits.saturation = *saturation;
    } else if (column.is_counts()) {
        limits.saturation = std::numeric_limits<std::int16_t>::max() * std::abs(column.scale);
    }
    return limits;
}

// White noise that a fit does not see (none fitted, or a unit that stands still) would be weighted without
// bound.
UnitNoise with_floor(UnitNoise noise, const UnitBand* finest, std::size_t unit, std::size_t units) {
    if (noise.white_variance > 0.0) { return noise; }
    constexpr double least = 1e-18;
    noise.white_variance = least;
    if (finest != nullptr) {
        noise.white_variance = std::max(least, finest->covariance[unit * units + unit]);
    }
    noise.walk_variance = std::max(noise.walk_variance, 1e-14 * noise.white_variance);
    return noise;
}

// Whether white noise is the larger part of the units' Allan variance at this averaging time.
bool is_white(const AxisKnowledge& axis, double tau_s) {
    double white = 0.0;
    double walk = 0.0;
    for (const UnitNoise& unit : axis.noise.units) {
        white += unit.white_variance / (tau_s * axis.noise.rate_hz);
        walk += unit.walk_variance * axis.noise.rate_hz * tau_s / 3.0;
    }
    return white > walk;
}

// Correlations over the bands that one noise rules, weighted by their differences.
std::vector<double> pooled_correlation(const AxisKnowledge& axis, bool white, std::size_t& differences) {
    const std::size_t units = axis.units.size();
    std::vector<double> matrix = equal_correlation(units, 0.0);
    differences = 0;
    for (const UnitBand& band : axis.bands) {
        if (is_white(axis, band.tau_s) != white) { continue; }
        differences += band.differences;
        for (std::size_t i = 0; i < units; ++i) {
            for (std::size_t j = 0; j < units; ++j) {
                if (i == j) { continue; }
                matrix[i * units + j] +=
                    band.correlation(i, j, units) * static_cast<double>(band.differences);
            }
        }
    }
    if (differences == 0) { return {}; }
    const double chance = 2.0 / std::sqrt(static_cast<double>(differences));
    for (std::size_t i = 0; i < units; ++i) {
        for (std::size_t j = 0; j < units; ++j) {
            if (i == j) { continue; }
            double& entry = matrix[i * units + j];
            entry /= static_cast<double>(differences);
            if (std::abs(entry) <= chance) { entry = 0.0; }
        }
    }
    return possible_correlation(std::move(matrix), units);
}

// A fit of a short record finds drift in one unit and none in the next by chance. Units of an array are of
// one kind: none is taken to drift by less than half of what is usual among them.
void floor_walks(std::vector<UnitNoise>& units) {
    std::vector<double> walks;
    walks.reserve(units.size());
    for (const UnitNoise& unit : units) { walks.push_back(unit.walk_variance); }
    std::ranges::sort(walks);
    const double least = 0.25 * walks[walks.size() / 2];
    for (UnitNoise& unit : units) { unit.walk_variance = std::max(unit.walk_variance, least); }
}

void find_noise(AxisKnowledge& axis, const ArrayAxis& columns, const Recording& still,
                std::optional<double> saturation) {
    const std::size_t units = axis.units.size();
    const UnitBand* finest = axis.bands.empty() ? nullptr : &axis.bands.front();
    axis.noise.rate_hz = still.rate_hz;
    axis.noise.units.clear();
    for (std::size_t i = 0; i < units; ++i) {
        axis.noise.units.push_back(
            with_floor(unit_noise(axis.units[i].model, still.rate_hz), finest, i, units));
        if (!columns.units.empty()) {
            // Terms of a fit that stand for each other count once.
            UnitNoise& noise = axis.noise.units.back();
            if (axis.units[i].variance > 0.0) {
                noise.white_variance = std::min(noise.white_variance, axis.units[i].variance);
            }
            axis.units[i].limits =
                limits_of(*columns.units[i], still.segments, axis.noise.units[i], saturation);
        }
        axis.units[i].limits.white_sd = std::sqrt(axis.noise.units[i].white_variance);
    }
    floor_walks(axis.noise.units);
    axis.noise.white_correlation = pooled_correlation(axis, true, axis.white_differences);
    axis.noise.walk_correlation = pooled_correlation(axis, false, axis.walk_differences);
}

AxisKnowledge knowledge_of(const ArrayAxis& columns, const Recording& still, const AnalysisReport& report,
                           std::optional<double> saturation) {
    AxisKnowledge axis;
    axis.axis = columns.name;
    double mean_of_means = 0.0;
    for (std::size_t i = 0; i < columns.units.size(); ++i) {
        UnitKnowledge unit;
        unit.name = columns.unit_names[i];
        for (const AxisReport& fitted : report.axes) {
            if (fitted.axis != columns.name + unit.name) { continue; }
            unit.model = fitted.fit.sparse;
            unit.lines = fitted.lines;
            axis.offsets.push_back(fitted.bias.value);
            mean_of_means += fitted.bias.value / static_cast<double>(columns.units.size());
        }
        const std::vector<double> values = columns.units[i]->values();
        unit.variance = variance_of(values, still.segments);
        axis.units.push_back(std::move(unit));
    }
    for (double& offset : axis.offsets) { offset -= mean_of_means; }
    axis.bands = unit_bands(columns.units, still.segments, still.rate_hz);
    find_noise(axis, columns, still, saturation);
    return axis;
}

// Collects stretches; a unit that fails again after a good sample opens another.
class FailureLog {
public:
    FailureLog(AxisDenoising& axis, double rate_hz) : axis_(axis), rate_hz_(rate_hz) {
        open_.resize(axis.knowledge.units.size());
    }

    void see(std::span<const UnitState> states, std::int64_t index) {
        for (std::size_t i = 0; i < states.size(); ++i) {
            UnitFailure& failure = open_[i];
            if (failure.state != states[i]) { close(i); }
            if (states[i] == UnitState::good) { continue; }
            const double at_s = static_cast<double>(index) / rate_hz_;
            if (failure.samples == 0) { failure = {axis_.knowledge.units[i].name, states[i], at_s, at_s, 0}; }
            failure.to_s = at_s;
            ++failure.samples;
        }
    }
    void end() {
        for (std::size_t i = 0; i < open_.size(); ++i) { close(i); }
        std::ranges::stable_sort(axis_.failures, {}, &UnitFailure::from_s);
    }

private:
    void close(std::size_t i) {
        if (open_[i].samples == 0) { return; }
        if (axis_.failures.size() < failures_listed) {
            axis_.failures.push_back(open_[i]);
        } else {
            ++axis_.failures_more;
        }
        open_[i] = {};
    }

    AxisDenoising& axis_;
    double rate_hz_;
    std::vector<UnitFailure> open_;
};

std::vector<double> run_filter(const Recording& recording, const ArrayAxis& columns,
                               const AxisKnowledge& knowledge, const DenoiseDesign& design, FailureLog* log) {
    AxisDenoiser denoiser(knowledge, design);
    std::vector<double> rate(recording.rows());
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const std::size_t row = segment.first + i;
            const std::int64_t index = segment.first_index + static_cast<std::int64_t>(i);
            rate[row] = denoiser.step(index, columns, row);
            if (log != nullptr) {
                log->see(denoiser.states(), index - recording.segments.front().first_index);
            }
        }
    }
    return rate;
}

Column rate_column(std::vector<double> values, const Column& like) {
    return {"", like.unit, std::move(values), 1.0, 0.0, like.source_unit == "rad_s" ? "rad_s" : ""};
}

// What the recording has besides the part at rest.
std::vector<Segment> moving_part(const Recording& recording, const TimeSpan& still) {
    if (!(still.to_s > still.from_s)) { return recording.segments; }
    const double end_s = recording.duration_s() + 1.0;
    std::vector<Segment> parts = segments_within(recording.segments, recording.rate_hz, {0.0, still.from_s});
    for (const Segment& segment :
         segments_within(recording.segments, recording.rate_hz, {still.to_s, end_s})) {
        parts.push_back(segment);
    }
    return parts;
}

std::optional<MotionError> motion_of(const Recording& recording, const std::string& axis,
                                     std::span<const double> rate, const TimeSpan& still,
                                     double bandwidth_hz) {
    const Column* reference = recording.find("ref_" + axis);
    if (reference == nullptr || reference->unit == "lsb") { return std::nullopt; }
    double longest_lag_s = longest_lag_least_s;
    if (bandwidth_hz > 0.0) { longest_lag_s = std::max(longest_lag_s, 1.0 / bandwidth_hz); }
    return motion_error(rate, reference->values(), moving_part(recording, still), recording.rate_hz,
                        longest_lag_s);
}

void describe_units(AxisDenoising& axis, const Recording& recording, const ArrayAxis& columns,
                    const DenoiseRequest& request) {
    const std::vector<Segment> still =
        segments_known(columns.units, segments_within(recording.segments, recording.rate_hz, request.still));
    std::vector<double> mean(recording.rows(), 0.0);
    for (const Column* unit : columns.units) {
        const std::vector<double> values = unit->values();
        for (std::size_t i = 0; i < values.size(); ++i) {
            mean[i] += values[i] / static_cast<double>(columns.units.size());
        }
        if (still.empty()) { continue; }
        axis.unit_variances.push_back(variance_of(values, still));
        axis.unit_allan.push_back(
            allan_deviation(*unit, still, recording.rate_hz, {.m = {}, .intervals = false}));
        axis.unit_spectra.push_back(power_spectrum(*unit, still, recording.rate_hz));
    }
    if (!still.empty()) { axis.mean_variance = variance_of(mean, still); }
    axis.unit_motion =
        motion_of(recording, columns.name, columns.units.front()->values(), request.still, 0.0);
}

void describe_signal(DenoisedSignal& signal, const AxisDenoising& axis, const Recording& recording,
                     const ArrayAxis& columns, const DenoiseRequest& request) {
    const std::vector<Segment> still = segments_within(recording.segments, recording.rate_hz, request.still);
    if (!still.empty()) {
        signal.still_variance = variance_of(signal.rate, still);
        const Column column = rate_column(signal.rate, *columns.units.front());
        signal.allan = allan_deviation(column, still, recording.rate_hz, {.m = {}, .intervals = false});
        signal.spectrum = power_spectrum(column, still, recording.rate_hz);
    }
    signal.response = filter_response(axis.knowledge.noise, signal.design);
    signal.calm = calm_response(axis.knowledge.noise, signal.design);
    signal.motion =
        motion_of(recording, columns.name, signal.rate, request.still,
                  signal.design.rate.model == RateModel::free ? 0.0 : signal.design.rate.bandwidth_hz);
}

AxisDenoising denoise_axis(const Recording& recording, const ArrayAxis& columns, AxisKnowledge knowledge,
                           const DenoiseRequest& request) {
    AxisDenoising axis;
    axis.knowledge = std::move(knowledge);
    for (const DenoiseDesign& design : request.designs) {
        const bool is_first = axis.signals.empty();
        FailureLog log(axis, recording.rate_hz);
        DenoisedSignal signal;
        signal.design = design;
        signal.rate = run_filter(recording, columns, axis.knowledge, design, is_first ? &log : nullptr);
        if (is_first) { log.end(); }
        if (request.details) { describe_signal(signal, axis, recording, columns, request); }
        axis.signals.push_back(std::move(signal));
    }
    const DenoiseDesign& first = request.designs.front();
    const RateDesign rate = first.method == DenoiseMethod::wavelet ? RateDesign{} : first.rate;
    const KalmanArray filter(axis.knowledge.noise, rate);
    axis.sample_weights = filter.sample_weights();
    axis.drift_weights = filter.drift_weights();
    if (request.details) {
        describe_units(axis, recording, columns, request);
        axis.trend_curve = bandwidth_curve(axis.knowledge.noise, first, RateModel::trend);
        axis.walk_curve = bandwidth_curve(axis.knowledge.noise, first, RateModel::walk);
    }
    return axis;
}

}  // namespace

double AxisDenoising::unit_variance() const {
    double sum = 0.0;
    for (const double variance : unit_variances) { sum += variance; }
    return unit_variances.empty() ? 0.0 : sum / static_cast<double>(unit_variances.size());
}

std::vector<AxisKnowledge> learn_units(const Recording& still, std::optional<double> saturation) {
    AnalysisOptions options;
    options.threads = 0;
    options.sensors = Sensors::gyro;
    options.keep_temperature = true;  // the filter does not know the temperature
    const AnalysisReport report = analyze(still, options);
    std::vector<AxisKnowledge> axes;
    for (const ArrayAxis& axis : array_axes(still)) {
        axes.push_back(knowledge_of(axis, still, report, saturation));
    }
    return axes;
}

std::vector<AxisKnowledge> know_units(const Recording& recording, std::optional<double> saturation) {
    std::vector<AxisKnowledge> axes;
    for (const ArrayAxis& columns : array_axes(recording)) {
        AxisKnowledge axis;
        axis.axis = columns.name;
        axis.noise.rate_hz = recording.rate_hz;
        axis.offsets.assign(columns.units.size(), 0.0);
        for (std::size_t i = 0; i < columns.units.size(); ++i) {
            UnitKnowledge unit;
            unit.name = columns.unit_names[i];
            unit.limits = limits_of(*columns.units[i], {}, {}, saturation);
            unit.limits.repeats_most = UnitLimits{}.repeats_most;
            axis.units.push_back(std::move(unit));
        }
        axes.push_back(std::move(axis));
    }
    return axes;
}

void use_models(std::vector<AxisKnowledge>& axes, const std::vector<std::vector<NoiseModel>>& models) {
    for (std::size_t a = 0; a < axes.size(); ++a) {
        for (std::size_t i = 0; i < axes[a].units.size(); ++i) { axes[a].units[i].model = models[a][i]; }
        Recording only_rate;
        only_rate.rate_hz = axes[a].noise.rate_hz;
        find_noise(axes[a], ArrayAxis{}, only_rate, std::nullopt);
    }
}

std::vector<AxisDenoising> denoise(const Recording& recording, std::vector<AxisKnowledge> knowledge,
                                   const DenoiseRequest& request) {
    const std::vector<ArrayAxis> columns = array_axes(recording);
    std::vector<AxisDenoising> axes(columns.size());
    parallel_for(columns.size(), request.threads, [&](std::size_t i) {
        axes[i] = denoise_axis(recording, columns[i], std::move(knowledge[i]), request);
    });
    return axes;
}

Recording denoised_recording(const Recording& recording, std::span<const AxisDenoising> axes) {
    Recording result = recording;
    result.columns.clear();
    const std::vector<ArrayAxis> columns = array_axes(recording);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        Column column = rate_column(axes[i].signals.front().rate, *columns[i].units.front());
        column.name = "g" + columns[i].name;
        result.columns.push_back(std::move(column));
    }
    for (const Column& column : recording.columns) {
        if (!column.name.starts_with('g')) { result.columns.push_back(column); }
    }
    return result;
}

}  // namespace gyrolog
