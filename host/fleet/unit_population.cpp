#include "host/fleet/unit_population.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/sensor_model.hpp"
#include "host/base/counted.hpp"
#include "host/formats/population_json.hpp"

namespace gyrolog {
namespace {

struct Value {
    std::size_t recording = 0;
    double value = 0.0;
    double uncertainty = 0.0;
};

// What was measured of one parameter, before units are told apart.
struct Measurements {
    std::string axis;
    std::string name;
    std::vector<Value> values;
    std::size_t not_identified = 0;
};

std::optional<double> dps_per(const std::string& unit) {
    if (unit == "dps") { return 1.0; }
    if (unit == "rad/s") { return deg_per_rad; }
    return std::nullopt;
}

class Collector {
public:
    void take(std::size_t recording, const FleetLine& line) {
        if (line.rate_hz && *line.rate_hz > 0.0) {
            of("", "rate_hz").values.push_back({recording, *line.rate_hz, 0.0});
        }
        for (const FleetAxis& axis : line.axes) { take_axis(recording, axis); }
    }
    std::vector<Measurements>& all() { return all_; }
    std::size_t in_counts() const { return in_counts_; }

private:
    void take_axis(std::size_t recording, const FleetAxis& axis) {
        const bool is_known = std::ranges::find(axis_names, axis.axis) != axis_names.end();
        if (axis.sensor != "gyro" || !is_known || axis.unit.empty()) { return; }
        const auto scale = dps_per(axis.unit);
        if (!scale) {
            ++in_counts_;
            return;
        }
        take_number(recording, axis.axis, "bias", axis.bias, *scale);
        for (std::size_t i = 0; i < fleet_coefficients.size(); ++i) {
            const std::string name = fleet_coefficients[i];
            if (name == "R") { continue; }  // a ramp is a recording's, not a unit's
            take_number(recording, axis.axis, name, axis.coefficients[i], *scale);
        }
    }
    void take_number(std::size_t recording, const std::string& axis, const std::string& name,
                     const FleetNumber& number, double scale) {
        Measurements& to = of(axis, name);
        if (number.value) {
            to.values.push_back({recording, *number.value * scale, number.sd.value_or(0.0) * scale});
        } else {
            ++to.not_identified;
        }
    }
    Measurements& of(const std::string& axis, const std::string& name) {
        const auto found = std::ranges::find_if(
            all_, [&](const Measurements& one) { return one.axis == axis && one.name == name; });
        return found != all_.end() ? *found : all_.emplace_back(Measurements{axis, name, {}, 0});
    }

    std::vector<Measurements> all_;
    std::size_t in_counts_ = 0;
};

// A board's number may be a file's name.
using UnitKey = std::pair<bool, std::string>;
UnitKey unit_of(const FleetLine& line) {
    return line.board.empty() ? UnitKey{false, line.file} : UnitKey{true, line.board};
}

struct UnitValues {
    std::vector<double> values;
    std::vector<double> uncertainties;
};

std::vector<UnitValue> by_unit(std::span<const FleetLine> recordings, const Measurements& of) {
    std::map<UnitKey, UnitValues> units;
    for (const Value& one : of.values) {
        UnitValues& unit = units[unit_of(recordings[one.recording])];
        unit.values.push_back(one.value);
        unit.uncertainties.push_back(one.uncertainty);
    }
    std::vector<UnitValue> medians;
    medians.reserve(units.size());
    for (const auto& [key, unit] : units) {
        medians.push_back({key.second, median_of(unit.values), median_of(unit.uncertainties)});
    }
    return medians;
}

RobustSpread spread_of(const std::vector<UnitValue>& units, double probability) {
    UnitValues all;
    all.values.reserve(units.size());
    all.uncertainties.reserve(units.size());
    for (const UnitValue& unit : units) {
        all.values.push_back(unit.value);
        all.uncertainties.push_back(unit.uncertainty);
    }
    return robust_spread(all.values, all.uncertainties, {probability});
}

bool is_fair_sample(const Measurements& of, const PopulationOptions& options) {
    const auto asked = static_cast<double>(of.values.size() + of.not_identified);
    return static_cast<double>(of.values.size()) >= options.identified_share_least * asked;
}

// Empty: there are enough.
std::string why_not(const Measurements& of, std::size_t units, const PopulationOptions& options) {
    if (!is_fair_sample(of, options)) {
        return fmt::format("identified in {} of {} recordings only: no spread is given", of.values.size(),
                           of.values.size() + of.not_identified);
    }
    if (units >= options.units_least) { return {}; }
    return fmt::format("{} only, and a spread needs {}", counted(units, "unit"), options.units_least);
}

// "Q of x, y, z: identified in 0 of 12 recordings only": axes for which the same holds share a note.
class ParameterNotes {
public:
    void add(const Measurements& of, const std::string& why) {
        const auto same = std::ranges::find_if(
            notes_, [&](const Note& note) { return note.name == of.name && note.why == why; });
        Note& note = same != notes_.end() ? *same : notes_.emplace_back(Note{of.name, why, {}});
        if (!of.axis.empty()) { note.axes.push_back(of.axis); }
    }
    std::vector<std::string> texts() const {
        std::vector<std::string> texts;
        for (const Note& note : notes_) {
            const std::string axes =
                note.axes.empty() ? "" : fmt::format(" of {}", fmt::join(note.axes, ", "));
            texts.push_back(note.name + axes + ": " + note.why);
        }
        return texts;
    }

private:
    struct Note {
        std::string name;
        std::string why;
        std::vector<std::string> axes;
    };
    std::vector<Note> notes_;
};

// 0 where there is no spread.
double robust_z(double value, double uncertainty, const RobustSpread& spread) {
    if (spread.observed_sd <= 0.0) { return 0.0; }
    return (value - spread.median) / std::max(spread.observed_sd, std::hypot(spread.sd, uncertainty));
}

void find_outliers(const Measurements& of, const RobustSpread& spread,
                   std::vector<OutlyingParameter>& outliers) {
    const double bound = outlier_bound(spread.count);
    for (const Value& one : of.values) {
        const double z = robust_z(one.value, one.uncertainty, spread);
        if (std::abs(z) > bound) { outliers.push_back({one.recording, of.axis, of.name, one.value, z}); }
    }
}

void mark_outliers(UnitsOfParameter& of) {
    for (UnitValue& unit : of.units) {
        unit.stands_out =
            std::abs(robust_z(unit.value, unit.uncertainty, *of.spread)) > outlier_bound(of.spread->count);
    }
}

// Quantiles of |z| at which 1 in 2150 Gaussian values lies beyond, simulated with robust_spread()'s factors:
// 2e7 values of each count, known to 2 %. From 20 on they fall as 3.5 + 26.5 / n + 150 / n^2 within that.
constexpr std::array bounds_of_few{27.3, 35.9, 13.8, 15.1, 9.7,  10.1, 7.95, 8.09,
                                   6.90, 6.95, 6.22, 6.28, 5.77, 5.81, 5.44, 5.48};  // of 4 to 19
constexpr std::size_t few_least = 4;
constexpr double bound_of_many = 3.5;
constexpr double bound_rise = 26.5;   // over n
constexpr double bound_bend = 150.0;  // over n squared

}  // namespace

double outlier_bound(std::size_t units) {
    const std::size_t at = std::max(units, few_least) - few_least;
    if (at < bounds_of_few.size()) { return bounds_of_few.at(at); }
    const auto n = static_cast<double>(units);
    return bound_of_many + (bound_rise + bound_bend / n) / n;
}

UnitPopulation population_of(std::span<const FleetLine> recordings, const PopulationOptions& options) {
    Collector collector;
    for (std::size_t i = 0; i < recordings.size(); ++i) { collector.take(i, recordings[i]); }
    UnitPopulation population;
    MeasuredPopulation& measured = population.measured;
    measured.probability = options.probability;
    ParameterNotes notes;
    for (const Measurements& of : collector.all()) {
        UnitsOfParameter parameter{of.axis, of.name, by_unit(recordings, of), {}};
        measured.units = std::max(measured.units, parameter.units.size());
        const std::string why = why_not(of, parameter.units.size(), options);
        if (why.empty()) {
            parameter.spread = spread_of(parameter.units, options.probability);
            measured.parameters.push_back({of.axis, of.name, *parameter.spread});
            find_outliers(of, *parameter.spread, population.outliers);
            mark_outliers(parameter);
        } else {
            notes.add(of, why);
        }
        if (is_fair_sample(of, options)) { population.parameters.push_back(std::move(parameter)); }
    }
    measured.notes = notes.texts();
    if (collector.in_counts() > 0) {
        measured.notes.push_back(fmt::format(
            "rates in counts without a scale are left out, {} of them: analyze takes one with --lsb-dps",
            collector.in_counts()));
    }
    return population;
}

}  // namespace gyrolog
