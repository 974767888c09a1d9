#include "analysis/compare/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <thread>

#include "analysis/compare/model_draw.hpp"
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/random_purpose.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog {

namespace {

// For the simulations that are in memory at a time.
constexpr double memory_bytes = 3e9;

// Of the sentences about all axes together, when there is no gap.
constexpr double false_alarms = 0.05;
// Shared evenly by an axis' parts, and by each part among its points or numbers.
constexpr double parts_with_model = 3.0;      // two curves and the distribution
constexpr double parts_with_recording = 2.0;  // no band for the distribution
constexpr double numbers_of_distribution = 3.0;
double false_alarms_a_part(double parts, std::size_t axes) {
    return false_alarms / (parts * static_cast<double>(axes));
}

// Functions that make these numbers nearly normal, also where few samples far out make them: the standard
// deviation as the curves (compared_curve.cpp), the excess kurtosis, which is never below -2, by its
// logarithm.
double even_deviation(double deviation) { return std::cbrt(deviation * deviation); }
double even_skewness(double skewness) { return std::asinh(skewness); }
double even_kurtosis(double excess_kurtosis) { return std::log(2.0 + excess_kurtosis); }

std::vector<std::string> axes_of(const Recording& recording) {
    std::vector<std::string> axes;
    for (const char* axis : axis_names) {
        if (recording.find(std::string("g") + axis) != nullptr) { axes.emplace_back(axis); }
    }
    return axes;
}

bool has_reference_rates(const Recording& recording) {
    return std::ranges::any_of(
        axis_names, [&](const char* axis) { return recording.find(std::string("ref_") + axis) != nullptr; });
}

// The gyro's column, or what it shows beyond the reference.
Column compared_column(const Recording& recording, const std::string& axis) {
    const Column& gyro = *recording.find("g" + axis);
    const Column* reference = recording.find("ref_" + axis);
    if (reference == nullptr) { return gyro; }
    std::vector<double> residual = gyro.values();
    double held = 0.0;
    for (std::size_t i = 0; i < residual.size(); ++i) {
        const double known = reference->value(i);
        if (std::isfinite(known)) { held = known; }
        residual[i] -= held;
    }
    return {gyro.name, gyro.unit, std::move(residual)};
}

std::vector<double> taus_of(const AllanCurve& curve) {
    std::vector<double> at;
    for (const AllanPoint& point : curve.points) { at.push_back(point.tau_s); }
    return at;
}

std::vector<double> frequencies_of(const PowerSpectrum& spectrum) {
    std::vector<double> at;
    for (const SpectrumPoint& point : spectrum.points) { at.push_back(point.f_hz); }
    return at;
}

std::vector<double> deviations_of(const AllanCurve& curve) {
    std::vector<double> values;
    for (const AllanPoint& point : curve.points) { values.push_back(point.deviation); }
    return values;
}

std::vector<double> amplitudes_of(const PowerSpectrum& spectrum) {
    std::vector<double> values;
    for (const SpectrumPoint& point : spectrum.points) { values.push_back(std::sqrt(point.density)); }
    return values;
}

std::vector<double> interpolated_at(std::span<const double> at, std::span<const double> x,
                                    std::span<const double> y) {
    std::vector<double> values;
    for (const double place : at) { values.push_back(interpolated(x, y, place)); }
    return values;
}

// What is kept of one simulation's axis.
struct SimulatedAxis {
    std::vector<double> deviations;  // at the recording's tau
    std::vector<double> amplitudes;  // at the recording's frequencies
    double standard_deviation = 0.0, skewness = 0.0, excess_kurtosis = 0.0;
};

// The recording's own curves and, filled in by the simulations, those it is compared with.
class ModelComparison {
public:
    ModelComparison(std::shared_ptr<const Recording> recording, const SensorModel& model,
                    const ModelComparisonOptions& options)
        : recording_(std::move(recording)),
          model_(model),
          options_(options),
          world_(std::make_shared<const RecordedWorld>(recording_)),
          axes_(axes_of(*recording_)),
          own_(axes_.size()),
          first_(axes_.size()),
          simulated_(axes_.size(), std::vector<SimulatedAxis>(options.simulations)) {}

    bool simulate_all() {
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            own_[i] =
                axis_curves(compared_column(*recording_, axes_[i]), recording_->segments, recording_->rate_hz,
                            {.m = {}, .intervals = false, .threads = options_.threads});
        }
        const unsigned wanted =
            options_.threads > 0 ? options_.threads : std::max(1U, std::thread::hardware_concurrency());
        std::mutex mutex;
        std::size_t done = 0;
        bool stopped = false;
        parallel_for(options_.simulations, std::min(wanted, room_for_simulations()),
                     [&](std::size_t simulation) {
                         {
                             const std::lock_guard lock(mutex);
                             if (stopped) { return; }
                         }
                         simulate(simulation);
                         const std::lock_guard lock(mutex);
                         ++done;
                         if (options_.on_progress && !options_.on_progress(done)) { stopped = true; }
                     });
        return !stopped;
    }

    void write_to(Comparison& comparison) const {
        for (std::size_t i = 0; i < axes_.size(); ++i) { comparison.axes.push_back(axis_comparison(i)); }
        comparison.warnings = world_->warnings();
        for (const std::string& term : terms_of_stamps(model_)) {
            if (term == "timestamp_jitter_s") { continue; }  // every model has it
            comparison.warnings.push_back("the model's effect '" + term +
                                          "' changes time stamps, and simulations keep the recording's");
        }
    }

private:
    // A simulation has the recording's other columns and its stamps, and an Allan deviation sums one axis.
    unsigned room_for_simulations() const {
        double bytes_per_row = 2.0 * 8.0;
        for (const Column& column : recording_->columns) { bytes_per_row += column.is_counts() ? 2.0 : 8.0; }
        const double bytes = static_cast<double>(recording_->rows()) * bytes_per_row;
        return static_cast<unsigned>(std::clamp(memory_bytes / bytes, 1.0, 1024.0));
    }

    void simulate(std::size_t simulation) {
        const std::uint64_t seed =
            derived_seed(options_.seed, RandomPurpose::compared_simulations, simulation);
        SimulationRequest request;
        request.seed = seed;
        request.like = world_;
        const Recording simulated = simulate_recording(draw_within_uncertainty(model_, seed), request);
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            // Only the first is drawn over time.
            AxisCurvesOptions options;
            options.intervals = false;
            if (simulation > 0) { options.blocks = 0; }
            for (const AllanPoint& point : own_[i].allan.points) { options.m.push_back(point.m); }
            const AxisCurves curves = axis_curves(compared_column(simulated, axes_[i]), simulated.segments,
                                                  simulated.rate_hz, options);
            SimulatedAxis& kept = simulated_[i][simulation];
            kept.deviations =
                interpolated_at(taus_of(own_[i].allan), taus_of(curves.allan), deviations_of(curves.allan));
            kept.amplitudes =
                interpolated_at(frequencies_of(own_[i].spectrum), frequencies_of(curves.spectrum),
                                amplitudes_of(curves.spectrum));
            kept.standard_deviation = curves.histogram.standard_deviation;
            kept.skewness = curves.histogram.skewness;
            kept.excess_kurtosis = curves.histogram.excess_kurtosis;
            if (simulation == 0) { first_[i] = curves; }
        }
    }

    template <typename Member>
    std::vector<Member> collected(std::size_t axis, Member SimulatedAxis::*member) const {
        std::vector<Member> all;
        for (const SimulatedAxis& one : simulated_[axis]) { all.push_back(one.*member); }
        return all;
    }

    AxisComparison axis_comparison(std::size_t i) const {
        const AxisCurves& own = own_[i];
        const double alarms = false_alarms_a_part(parts_with_model, axes_.size());
        AxisComparison axis;
        axis.axis = axes_[i];
        axis.allan = compare_with_simulations(taus_of(own.allan), deviations_of(own.allan),
                                              collected(i, &SimulatedAxis::deviations), alarms);
        axis.spectrum = compare_with_simulations(frequencies_of(own.spectrum), amplitudes_of(own.spectrum),
                                                 collected(i, &SimulatedAxis::amplitudes), alarms);
        const auto number = [&](double recording, double SimulatedAxis::*member, double (*even)(double)) {
            return compare_number(recording, collected(i, member), even, alarms / numbers_of_distribution);
        };
        axis.standard_deviation =
            number(own.histogram.standard_deviation, &SimulatedAxis::standard_deviation, even_deviation);
        axis.skewness = number(own.histogram.skewness, &SimulatedAxis::skewness, even_skewness);
        axis.excess_kurtosis =
            number(own.histogram.excess_kurtosis, &SimulatedAxis::excess_kurtosis, even_kurtosis);
        axis.recording_histogram = own.histogram;
        axis.other_histogram = first_[i].histogram;
        axis.recording_averages = own.averages;
        axis.other_averages = first_[i].averages;
        return axis;
    }

    std::shared_ptr<const Recording> recording_;
    const SensorModel& model_;
    const ModelComparisonOptions& options_;
    std::shared_ptr<const RecordedWorld> world_;
    std::vector<std::string> axes_;
    std::vector<AxisCurves> own_;
    std::vector<AxisCurves> first_;                      // of the first simulation
    std::vector<std::vector<SimulatedAxis>> simulated_;  // by axis, then simulation
};

CurveWithInterval with_interval(const AllanCurve& curve) {
    CurveWithInterval all;
    for (const AllanPoint& point : curve.points) {
        all.at.push_back(point.tau_s);
        all.value.push_back(point.deviation);
        all.lo.push_back(point.lo);
        all.hi.push_back(point.hi);
    }
    return all;
}

CurveWithInterval with_interval(const PowerSpectrum& spectrum) {
    CurveWithInterval all;
    for (const SpectrumPoint& point : spectrum.points) {
        all.at.push_back(point.f_hz);
        all.value.push_back(std::sqrt(point.density));
        all.lo.push_back(std::sqrt(point.lo));
        all.hi.push_back(std::sqrt(point.hi));
    }
    return all;
}

void describe(const Recording& recording, Comparison& comparison) {
    comparison.recording_name = recording.name;
    comparison.rate_hz = recording.rate_hz;
    comparison.duration_s = recording.duration_s();
    comparison.samples = recording.rows();
}

}  // namespace

const ComparedCurve* AxisComparison::worst() const {
    if (allan.gap.stands_out && (!spectrum.gap.stands_out || allan.gap.distance >= spectrum.gap.distance)) {
        return &allan;
    }
    return spectrum.gap.stands_out ? &spectrum : nullptr;
}

const ComparedNumber* AxisComparison::worst_number() const {
    const ComparedNumber* worst = nullptr;
    for (const ComparedNumber* number : {&skewness, &excess_kurtosis}) {
        if (number->stands_out && (worst == nullptr || number->distance > worst->distance)) {
            worst = number;
        }
    }
    if (worst == nullptr && standard_deviation.stands_out) { worst = &standard_deviation; }
    return worst;
}

std::optional<std::string> comparison_refusal(const Recording& recording) {
    const std::vector<std::string> axes = axes_of(recording);
    if (axes.empty()) { return "there is no angular rate gx, gy or gz to compare"; }
    for (const std::string& axis : axes) {
        if (recording.find("g" + axis)->unit != "rad/s") {
            return "the rates are counts without a scale: give it with --lsb-dps";
        }
    }
    std::size_t longest = 0;
    for (const Segment& segment : recording.segments) { longest = std::max(longest, segment.count); }
    if (longest < comparable_samples_min) {
        return "its longest stretch without a hole has " + std::to_string(longest) + " samples; " +
               std::to_string(comparable_samples_min) + " are needed";
    }
    return std::nullopt;
}

std::optional<Comparison> compare_with_model(std::shared_ptr<const Recording> recording,
                                             const SensorModel& model, const std::string& model_name,
                                             const ModelComparisonOptions& options) {
    Comparison comparison;
    describe(*recording, comparison);
    comparison.other_name = model_name;
    comparison.less_reference = has_reference_rates(*recording);
    comparison.simulations = options.simulations;
    comparison.band_probability = band_probability(options.simulations);
    comparison.seed = options.seed;
    ModelComparison work(std::move(recording), model, options);
    if (!work.simulate_all()) { return std::nullopt; }
    work.write_to(comparison);
    return comparison;
}

Comparison compare_recordings(const Recording& recording, const Recording& other, unsigned threads) {
    Comparison comparison;
    describe(recording, comparison);
    comparison.other_name = other.name;
    comparison.other_duration_s = other.segments.empty() ? 0.0 : other.duration_s();
    comparison.less_reference = has_reference_rates(recording) || has_reference_rates(other);
    const std::vector<std::string> axes = axes_of(recording);
    const double alarms = false_alarms_a_part(parts_with_recording, axes.size());
    for (const std::string& axis : axes) {
        if (other.find("g" + axis) == nullptr) {
            comparison.warnings.push_back(axis + " is left out: '" + other.name + "' does not have it");
            continue;
        }
        const AxisCurvesOptions options{.m = {}, .threads = threads};
        const AxisCurves own =
            axis_curves(compared_column(recording, axis), recording.segments, recording.rate_hz, options);
        const AxisCurves others =
            axis_curves(compared_column(other, axis), other.segments, other.rate_hz, options);
        AxisComparison& one = comparison.axes.emplace_back();
        one.axis = axis;
        one.allan = compare_with_intervals(with_interval(own.allan), with_interval(others.allan), alarms);
        one.spectrum =
            compare_with_intervals(with_interval(own.spectrum), with_interval(others.spectrum), alarms);
        one.standard_deviation = {
            own.histogram.standard_deviation, others.histogram.standard_deviation, {}, {}};
        one.skewness = {own.histogram.skewness, others.histogram.skewness, {}, {}};
        one.excess_kurtosis = {own.histogram.excess_kurtosis, others.histogram.excess_kurtosis, {}, {}};
        one.recording_histogram = own.histogram;
        one.other_histogram = others.histogram;
        one.recording_averages = own.averages;
        one.other_averages = others.averages;
    }
    return comparison;
}

}  // namespace gyrolog
