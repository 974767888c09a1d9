#include "analysis/denoise/array_reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "analysis/denoise/array_columns.hpp"
#include "analysis/numerics/lu.hpp"
#include "analysis/numerics/matrix.hpp"
#include "analysis/numerics/robust_spread.hpp"
#include "analysis/numerics/square.hpp"
#include "analysis/recording/recording_part.hpp"
#include "analysis/recording/still_blocks.hpp"
#include "analysis/simulate/gyro_rest.hpp"
#include "analysis/simulate/recorded_converter.hpp"

namespace gyrolog {
namespace {

constexpr double quiet_block_s = 1.0;

// Of each axis that a unit has, by its letter.
using Axes = std::map<std::string, const Column*>;
using Units = std::map<unsigned long, Axes>;  // by number

Units units_of(const Recording& recording) {
    Units units;
    for (const ArrayAxis& axis : array_axes(recording)) {
        for (std::size_t i = 0; i < axis.units.size(); ++i) {
            const std::string& name = axis.unit_names[i];
            units[name.empty() ? 0 : std::stoul(name)][axis.name] = axis.units[i];
        }
    }
    return units;
}

std::string listed_units(const Units& units) {
    std::string text;
    for (const auto& [unit, axes] : units) { text += (text.empty() ? "" : ", ") + std::to_string(unit); }
    return text;
}

std::string why_no_unit(const Units& units, unsigned long unit) {
    if (units.empty() || (units.size() == 1 && units.contains(0))) {
        return "has no array of gyros: columns gx1_dps ..., gx2_dps ...";
    }
    return units.contains(unit)
               ? ""
               : "has no gyro " + std::to_string(unit) + ": its gyros are " + listed_units(units);
}

bool is_gyro(const Column& column) { return column.name.starts_with('g'); }

Recording with_gyro(const Recording& recording, const Axes& axes) {
    Recording one = recording;
    std::erase_if(one.columns, is_gyro);
    std::size_t place = 0;
    for (const auto& [axis, column] : axes) {
        Column own = *column;
        own.name = "g" + axis;
        one.columns.insert(one.columns.begin() + static_cast<std::ptrdiff_t>(place++), std::move(own));
    }
    return one;
}

Recording known_rows(const Recording& recording) {
    std::vector<const Column*> gyros;
    for (const Column& column : recording.columns) {
        if (is_gyro(column)) { gyros.push_back(&column); }
    }
    return rows_of(recording, segments_known(gyros, recording.segments));
}

// A gyro beside the one that is judged, or that one. Signals by axis, NaN where not known or at the end of
// the range.
struct Unit {
    unsigned long number = 0;
    std::vector<std::vector<double>> signals;
    std::vector<double> weights;  // by axis
    Matrix response;
};

std::vector<std::vector<double>> signals_of(const Recording& one, const std::vector<std::string>& axes) {
    const auto converter = recorded_converter(one);
    const double end = converter ? converter->saturation_rad_s : std::numeric_limits<double>::infinity();
    const double tolerance = converter ? 0.5 * converter->step_rad_s : 0.0;
    std::vector<std::vector<double>> signals;
    for (const std::string& axis : axes) {
        signals.push_back(one.find("g" + axis)->values());
        for (double& value : signals.back()) {
            if (std::abs(value) >= end - tolerance) { value = std::numeric_limits<double>::quiet_NaN(); }
        }
    }
    return signals;
}

// All units on the rows of the one that is judged, which is the first.
class Array {
public:
    Array(const Recording& one, std::vector<std::string> axes, std::vector<Unit> units,
          const ArrayReferenceOptions& options)
        : one_(one), axes_(std::move(axes)), units_(std::move(units)), options_(options) {
        find_known();
        weigh();
        take_off_bias();
        find_mean();
    }

    // Empty where all is well.
    std::string failure() const {
        if (known_.empty()) { return "has no sample that all its gyros have"; }
        if (!moves()) {
            return "has gyros that share no motion: what rests needs no reference; leave --reference out";
        }
        for (const Unit& unit : units_) {
            for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
                if (!moves(axis) || gain(unit, axis) >= options_.gain_least) { continue; }
                return "has a gyro " + std::to_string(unit.number) + " whose " + axes_[axis] +
                       " does not follow that of gyro " + std::to_string(units_.front().number) +
                       ": the axes of an array's gyros have to point the same way, with the same sign";
            }
        }
        return {};
    }

    std::vector<std::vector<double>> reference() {
        const bool has_median = units_.size() > 2;
        if (has_median) {
            for (Unit& unit : units_) { unit.response = response_of(unit); }
        }
        const Matrix median = has_median ? median_response() : Matrix::identity(axes_.size());
        std::vector<std::vector<double>> sums(axes_.size(), std::vector<double>(one_.rows(), 0.0));
        std::vector<double> weights(axes_.size(), 0.0);
        for (auto unit = units_.begin() + 1; unit != units_.end(); ++unit) {
            Matrix to_median = Matrix::identity(axes_.size());
            if (has_median) { to_median = product(median, LuFactors(unit->response).solve(to_median)); }
            add(*unit, to_median, sums);
            for (std::size_t axis = 0; axis < axes_.size(); ++axis) { weights[axis] += unit->weights[axis]; }
        }
        for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
            for (double& sum : sums[axis]) { sum /= weights[axis]; }
        }
        return sums;
    }

private:
    static Matrix product(const Matrix& left, const Matrix& right) {
        Matrix result(left.rows(), right.columns());
        for (std::size_t i = 0; i < left.rows(); ++i) {
            for (std::size_t j = 0; j < right.columns(); ++j) {
                for (std::size_t k = 0; k < left.columns(); ++k) { result(i, j) += left(i, k) * right(k, j); }
            }
        }
        return result;
    }

    void find_known() {
        for (std::size_t row = 0; row < one_.rows(); ++row) {
            const bool is_known = std::ranges::all_of(units_, [&](const Unit& unit) {
                return std::ranges::all_of(unit.signals,
                                           [&](const auto& signal) { return std::isfinite(signal[row]); });
            });
            if (is_known) { known_.push_back(row); }
        }
    }

    // Equal where one of them shows no noise at all.
    void weigh() {
        const Recording known = rows_of(one_, segments_where(one_.segments, [&](std::size_t row) {
                                            return std::ranges::binary_search(known_, row);
                                        }));
        for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
            std::vector<std::vector<double>> signals;
            for (const Unit& unit : units_) {
                std::vector<double>& signal = signals.emplace_back();
                for (const std::size_t row : known_) { signal.push_back(unit.signals[axis][row]); }
            }
            const std::vector<StillBlock> blocks = still_blocks(known, signals, quiet_block_s);
            const std::vector<double> sds = quiet_sds(blocks, signals.size());
            const bool is_seen = std::ranges::all_of(sds, [](double sd) { return sd > 0.0; });
            noise_variance_.push_back(0.0);
            for (std::size_t i = 0; i < units_.size(); ++i) {
                units_[i].weights.push_back(is_seen ? 1.0 / square(sds[i]) : 1.0);
                noise_variance_.back() += is_seen ? units_[i].weights.back() : 0.0;
            }
            if (is_seen) { noise_variance_.back() = 1.0 / noise_variance_.back(); }
        }
    }

    void take_off_bias() {
        const std::vector<Segment> rest = segments_within(one_.segments, one_.rate_hz, gyro_rest(one_));
        for (Unit& unit : units_) {
            for (std::vector<double>& signal : unit.signals) {
                double sum = 0.0;
                double count = 0.0;
                for (const Segment& part : rest) {
                    for (std::size_t row = part.first; row < part.first + part.count; ++row) {
                        if (!std::isfinite(signal[row])) { continue; }
                        sum += signal[row];
                        count += 1.0;
                    }
                }
                if (count == 0.0) { continue; }
                for (double& value : signal) { value -= sum / count; }
            }
        }
    }

    // Over the known rows, about its own mean.
    void find_mean() {
        for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
            std::vector<double>& mean = mean_.emplace_back();
            double weights = 0.0;
            for (const Unit& unit : units_) { weights += unit.weights[axis]; }
            for (const std::size_t row : known_) {
                double sum = 0.0;
                for (const Unit& unit : units_) { sum += unit.weights[axis] * unit.signals[axis][row]; }
                mean.push_back(sum / weights);
            }
            const double middle =
                std::accumulate(mean.begin(), mean.end(), 0.0) / static_cast<double>(mean.size());
            for (double& value : mean) { value -= middle; }
        }
    }

    double mean_square(std::size_t axis) const {
        return std::inner_product(mean_[axis].begin(), mean_[axis].end(), mean_[axis].begin(), 0.0) /
               static_cast<double>(known_.size());
    }

    // Most of what the mean shows is not its noise.
    bool moves(std::size_t axis) const { return mean_square(axis) > 2.0 * noise_variance_[axis]; }
    bool moves() const {
        for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
            if (moves(axis)) { return true; }
        }
        return false;
    }

    double along(const std::vector<double>& signal, const std::vector<double>& centred) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < known_.size(); ++i) { sum += signal[known_[i]] * centred[i]; }
        return sum;
    }

    // Of its axis on that of the first unit.
    double gain(const Unit& unit, std::size_t axis) const {
        const std::vector<double>& first = units_.front().signals[axis];
        std::vector<double> centred;
        for (const std::size_t row : known_) { centred.push_back(first[row]); }
        const double middle =
            std::accumulate(centred.begin(), centred.end(), 0.0) / static_cast<double>(centred.size());
        for (double& value : centred) { value -= middle; }
        return along(unit.signals[axis], centred) / along(first, centred);
    }

    // Row by row: (M' M + sd_j^2 / response_sd^2) (a_j - 1) = M' (u_j - m)
    Matrix response_of(const Unit& unit) const {
        const std::size_t axes = axes_.size();
        Matrix response = Matrix::identity(axes);
        for (std::size_t row = 0; row < axes; ++row) {
            Matrix normal(axes, axes);
            Matrix right(axes, 1);
            for (std::size_t i = 0; i < axes; ++i) {
                for (std::size_t j = 0; j < axes; ++j) {
                    normal(i, j) =
                        std::inner_product(mean_[i].begin(), mean_[i].end(), mean_[j].begin(), 0.0);
                }
                right(i, 0) = along(unit.signals[row], mean_[i]) - normal(i, row);
                normal(i, i) += 1.0 / (unit.weights[row] * square(options_.response_sd));
            }
            const Matrix more = LuFactors(normal).solve(right);
            for (std::size_t i = 0; i < axes; ++i) { response(row, i) += more(i, 0); }
        }
        return response;
    }

    Matrix median_response() const {
        const std::size_t axes = axes_.size();
        Matrix median(axes, axes);
        for (std::size_t i = 0; i < axes; ++i) {
            for (std::size_t j = 0; j < axes; ++j) {
                std::vector<double> of_units;
                for (const Unit& unit : units_) { of_units.push_back(unit.response(i, j)); }
                median(i, j) = median_of(of_units);
            }
        }
        return median;
    }

    static void add(const Unit& unit, const Matrix& to_median, std::vector<std::vector<double>>& sums) {
        for (std::size_t i = 0; i < sums.size(); ++i) {
            for (std::size_t row = 0; row < sums[i].size(); ++row) {
                double value = 0.0;
                for (std::size_t j = 0; j < sums.size(); ++j) {
                    value += to_median(i, j) * unit.signals[j][row];
                }
                sums[i][row] += unit.weights[i] * value;
            }
        }
    }

    const Recording& one_;
    std::vector<std::string> axes_;
    std::vector<Unit> units_;
    ArrayReferenceOptions options_;
    std::vector<std::size_t> known_;      // rows
    std::vector<double> noise_variance_;  // of the mean, by axis
    std::vector<std::vector<double>> mean_;
};

Units with_axes_of(Units units, const Axes& of_unit) {
    std::erase_if(units, [&](const auto& other) {
        return std::ranges::any_of(of_unit,
                                   [&](const auto& axis) { return !other.second.contains(axis.first); });
    });
    return units;
}

// Empty where they do.
std::string why_others_tell_nothing(const Recording& recording, const Units& units, unsigned long unit) {
    if (has_reference(recording)) {
        return "has a reference already (columns ref_...): leave --reference out";
    }
    if (std::string failure = why_no_unit(units, unit); !failure.empty()) { return failure; }
    for (const auto& [number, axes] : units) {
        const auto has_scale = [](const auto& axis) { return axis.second->unit == "rad/s"; };
        if (!std::ranges::all_of(axes, has_scale)) {
            return "has gyros in counts of no known scale: give it with --lsb-dps";
        }
    }
    if (with_axes_of(units, units.at(unit)).size() > 1) { return {}; }
    return "has no gyro beside gyro " + std::to_string(unit) +
           " with the same axes: a reference of others needs one at least (columns gx2_dps ..., two or more "
           "tell which of all is off)";
}

Recording rows_where_known(const Recording& recording, const Axes& axes) {
    return rows_of(recording, segments_where(recording.segments, [&](std::size_t row) {
                       return std::ranges::all_of(
                           axes, [&](const auto& axis) { return std::isfinite(axis.second->value(row)); });
                   }));
}

// Of the rows that are known of the first.
std::vector<Unit> units_with_first(const Recording& known, const Units& units, unsigned long first,
                                   const std::vector<std::string>& axes) {
    std::vector<Unit> all;
    for (const auto& [number, columns] : units) {
        const auto place = number == first ? all.begin() : all.end();
        all.insert(place, {number, signals_of(with_gyro(known, columns), axes), {}, {}});
    }
    return all;
}

// And leaves the rows out of which it is not known.
void put_reference_in(Recording& judged, const std::vector<std::string>& axes,
                      const std::vector<std::vector<double>>& reference_rad_s) {
    const std::vector<Segment> told = segments_where(judged.segments, [&](std::size_t row) {
        return std::ranges::all_of(reference_rad_s,
                                   [&](const auto& rate_rad_s) { return std::isfinite(rate_rad_s[row]); });
    });
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        judged.columns.push_back({"ref_" + axes[axis], "rad/s", reference_rad_s[axis], 1.0, 0.0, "rad_s"});
    }
    const std::size_t all_rows = judged.rows();
    judged = rows_of(judged, told);
    if (judged.rows() == all_rows) { return; }
    judged.warnings.push_back("another gyro is missing or at the end of its range in " +
                              std::to_string(all_rows - judged.rows()) + " of " + std::to_string(all_rows) +
                              " samples: they are left out");
}

}  // namespace

UnitOfArray unit_of_array(const Recording& recording, unsigned long unit) {
    const Units units = units_of(recording);
    if (std::string failure = why_no_unit(units, unit); !failure.empty()) { return {{}, std::move(failure)}; }
    return {known_rows(with_gyro(recording, units.at(unit))), ""};
}

UnitOfArray unit_against_others(const Recording& recording, unsigned long unit,
                                const ArrayReferenceOptions& options) {
    const Units units = units_of(recording);
    if (std::string failure = why_others_tell_nothing(recording, units, unit); !failure.empty()) {
        return {{}, std::move(failure)};
    }
    const Recording known = rows_where_known(recording, units.at(unit));
    const Units on_rows = units_of(known);
    const Units alike = with_axes_of(on_rows, on_rows.at(unit));
    std::vector<std::string> axes;
    for (const auto& [axis, column] : alike.at(unit)) { axes.push_back(axis); }
    UnitOfArray judged{with_gyro(known, alike.at(unit)), ""};
    judged.recording.reference_gyros = alike.size() - 1;
    Array array(judged.recording, axes, units_with_first(known, alike, unit, axes), options);
    judged.failure = array.failure();
    if (judged.failure.empty()) { put_reference_in(judged.recording, axes, array.reference()); }
    return judged;
}

}  // namespace gyrolog
