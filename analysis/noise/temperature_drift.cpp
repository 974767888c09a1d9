#include "analysis/noise/temperature_drift.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "analysis/noise/average_covariance.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/log_sum_exp.hpp"
#include "analysis/numerics/square.hpp"
#include "analysis/recording/block_means.hpp"

namespace gyrolog {
namespace {

constexpr double chance_within_one_sd = 0.6826894921370859;  // of a normal distribution

// How long the record is on its grid, in sampling instants.
std::int64_t instants_of(const Recording& recording) {
    const Segment& last = recording.segments.back();
    return last.first_index + static_cast<std::int64_t>(last.count) - recording.segments.front().first_index;
}

// The blocks of which everything is known, and what was read in them.
struct Blocks {
    double span_s = 0.0;
    std::vector<std::int64_t> index;
    std::vector<double> complete;  // share of the block's samples
    std::vector<double> temperature_C;
    std::vector<std::vector<double>> values;  // of each column
};

bool has_readings(const Column& temperature, std::size_t least) {
    std::set<double> different;
    for (std::size_t row = 0; row < temperature.size() && different.size() < least; ++row) {
        const double reading_C = temperature.value(row);
        if (std::isfinite(reading_C)) { different.insert(reading_C); }
    }
    return different.size() >= least;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) { sum += value; }
    return sum / static_cast<double>(values.size());
}

double variance_of(const std::vector<double>& values) {
    const double mean = mean_of(values);
    double sum = 0.0;
    for (const double value : values) { sum += square(value - mean); }
    return sum / static_cast<double>(values.size() - 1);
}

// The variance of what a thermometer adds to the mean of so many instants by itself: from second differences
// of means over an eighth of them, in which what is slow drops out (1 + 4 + 1 times the variance is left).
double thermometer_variance(const Recording& recording, const Column& temperature, std::int64_t instants) {
    constexpr std::int64_t parts = 8;
    const std::int64_t part = std::max<std::int64_t>(1, instants / parts);
    const std::vector<BlockMean> means = block_means(temperature, recording.segments, part);
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 2; i < means.size(); ++i) {
        if (means[i].index != means[i - 2].index + 2) { continue; }
        sum += square(means[i].mean - 2.0 * means[i - 1].mean + means[i - 2].mean);
        count += 1.0;
    }
    const double second_difference = 6.0;
    return count > 0.0
               ? sum / (count * second_difference) * static_cast<double>(part) / static_cast<double>(instants)
               : 0.0;
}

Blocks blocks_of(const Recording& recording, std::span<const Column* const> columns,
                 const Column& temperature, std::int64_t instants, const TemperatureDriftOptions& options) {
    Blocks blocks;
    blocks.span_s = static_cast<double>(instants) / recording.rate_hz;
    blocks.values.resize(columns.size());
    const std::vector<BlockMean> readings = block_means(temperature, recording.segments, instants);
    std::vector<std::vector<BlockMean>> means;
    means.reserve(columns.size());
    for (const Column* column : columns) {
        means.push_back(block_means(*column, recording.segments, instants));
    }
    auto reading = readings.begin();
    for (std::size_t i = 0; i < means.front().size(); ++i) {
        const BlockMean& block = means.front()[i];
        const double complete = static_cast<double>(block.samples) / static_cast<double>(instants);
        while (reading != readings.end() && reading->index < block.index) { ++reading; }
        if (reading == readings.end()) { break; }
        if (reading->index != block.index || complete < options.complete_share) { continue; }
        blocks.index.push_back(block.index);
        blocks.complete.push_back(complete);
        blocks.temperature_C.push_back(reading->mean);
        for (std::size_t c = 0; c < columns.size(); ++c) { blocks.values[c].push_back(means[c][i].mean); }
    }
    return blocks;
}

Eigen::VectorXd differences(const std::vector<double>& values) {
    Eigen::VectorXd result(static_cast<Eigen::Index>(values.size()) - 1);
    for (Eigen::Index i = 0; i < result.size(); ++i) {
        result[i] = values[static_cast<std::size_t>(i) + 1] - values[static_cast<std::size_t>(i)];
    }
    return result;
}

// The covariance of neighbouring blocks' differences, of a noise whose coefficient is 1.
Eigen::MatrixXd difference_covariance(const Blocks& blocks, NoiseTerm term) {
    const AverageCovariance noise = average_covariance(term);
    std::vector<double> of_lag;
    for (std::int64_t lag = 0; lag <= blocks.index.back() - blocks.index.front(); ++lag) {
        of_lag.push_back(noise.of_unit_square(lag, blocks.span_s));
    }
    const auto size = static_cast<Eigen::Index>(blocks.index.size());
    Eigen::MatrixXd covariance(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        for (Eigen::Index j = 0; j < size; ++j) {
            const auto row = static_cast<std::size_t>(i);
            const auto column = static_cast<std::size_t>(j);
            const std::int64_t lag = std::abs(blocks.index[row] - blocks.index[column]);
            const double share = noise.per_sample ? blocks.complete[row] : 1.0;
            covariance(i, j) = of_lag[static_cast<std::size_t>(lag)] / share;
        }
    }
    const Eigen::Index last = size - 1;
    return covariance.bottomRightCorner(last, last) - covariance.bottomLeftCorner(last, last) -
           covariance.topRightCorner(last, last) + covariance.topLeftCorner(last, last);
}

// A corner at which a noise is as strong as the white one, and what it is worth beforehand. 0: no such noise.
struct Corner {
    double f_hz = 0.0;
    double log_weight = 0.0;
};

std::vector<Corner> corners_of(const Blocks& blocks, double chance_without,
                               const TemperatureDriftOptions& options) {
    const double record_s =
        blocks.span_s * static_cast<double>(blocks.index.back() - blocks.index.front() + 1);
    const double most_hz = options.corner_most_cycles_per_block / blocks.span_s;
    std::vector<Corner> corners = {{0.0, std::log(chance_without)}};
    double f_hz = options.corner_least_cycles_per_record / record_s;
    while (f_hz <= most_hz) {
        corners.push_back({f_hz, 0.0});
        f_hz *= 2.0;
    }
    const double share = (1.0 - chance_without) / static_cast<double>(corners.size() - 1);
    for (std::size_t i = 1; i < corners.size(); ++i) { corners[i].log_weight = std::log(share); }
    return corners;
}

// What one pair of corners says of one column.
struct Answer {
    double log_weight = 0.0;  // with a slope
    double slope = 0.0;
    double scale = 0.0;
    double walk = 0.0;
    double log_weight_without = 0.0;  // with none
    double walk_without = 0.0;
};

Answer answer_of(const Eigen::VectorXd& t, const Eigen::VectorXd& u, double log_determinant,
                 double log_weight, double walk_corner_hz) {
    const auto m = static_cast<double>(t.size());
    const double nu = m - 1.0;
    const double S_tt = t.squaredNorm();
    const double S_uu = u.squaredNorm();
    const double S_tu = t.dot(u);
    constexpr double rounding = 1e-14;  // of a column that is nothing but the temperature
    const double R = std::max(S_uu - S_tu * S_tu / S_tt, rounding * S_uu);
    Answer answer;
    answer.slope = S_tu / S_tt;
    answer.scale = std::sqrt(R / (nu * S_tt));
    answer.walk = 2.0 * pi * walk_corner_hz * std::sqrt(R / nu);
    answer.walk_without = 2.0 * pi * walk_corner_hz * std::sqrt(S_uu / m);
    const double of_corners = log_weight - 0.5 * log_determinant;
    answer.log_weight = of_corners - 0.5 * std::log(S_tt) - 0.5 * nu * std::log(R);
    answer.log_weight_without = of_corners - 0.5 * m * std::log(S_uu);
    return answer;
}

// Every pair's answer, column by column.
std::vector<std::vector<Answer>> answers_of(const Blocks& blocks, const TemperatureDriftOptions& options) {
    const Eigen::MatrixXd white = difference_covariance(blocks, NoiseTerm::N);
    const Eigen::MatrixXd flicker = difference_covariance(blocks, NoiseTerm::B);
    const Eigen::MatrixXd walk = difference_covariance(blocks, NoiseTerm::K);
    Eigen::MatrixXd sides(white.rows(), static_cast<Eigen::Index>(blocks.values.size()) + 1);
    sides.col(0) = differences(blocks.temperature_C);
    for (std::size_t c = 0; c < blocks.values.size(); ++c) {
        sides.col(static_cast<Eigen::Index>(c) + 1) = differences(blocks.values[c]);
    }
    std::vector<std::vector<Answer>> answers(blocks.values.size());
    for (const Corner& b : corners_of(blocks, options.chance_without_flicker, options)) {
        for (const Corner& k : corners_of(blocks, options.chance_without_walk, options)) {
            const Eigen::LLT<Eigen::MatrixXd> factor(white + 2.0 * pi * b.f_hz * flicker +
                                                     square(2.0 * pi * k.f_hz) * walk);
            if (factor.info() != Eigen::Success) { continue; }
            const Eigen::MatrixXd whitened = factor.matrixL().solve(sides);
            const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
            for (std::size_t c = 0; c < answers.size(); ++c) {
                answers[c].push_back(answer_of(whitened.col(0),
                                               whitened.col(static_cast<Eigen::Index>(c) + 1),
                                               log_determinant, b.log_weight + k.log_weight, k.f_hz));
            }
        }
    }
    return answers;
}

// Student's t about several places, each with its weight.
class AnswerMixture {
public:
    AnswerMixture(const std::vector<Answer>& answers, double degrees) : degrees_(degrees) {
        constexpr double least_weight = 1e-12;  // all the others change no chance by more than 1e-10
        std::vector<double> logs;
        logs.reserve(answers.size());
        for (const Answer& answer : answers) { logs.push_back(answer.log_weight); }
        const double all = log_sum_exp(logs);
        for (const Answer& answer : answers) {
            const double weight = std::exp(answer.log_weight - all);
            if (weight < least_weight) { continue; }
            answers_.push_back(answer);
            weights_.push_back(weight);
        }
    }

    double upper_tail(double x) const {
        return sum_of(
            [&](const Answer& a) { return students_t_upper_tail(degrees_, (x - a.slope) / a.scale); });
    }
    double lower_tail(double x) const {
        return sum_of(
            [&](const Answer& a) { return students_t_upper_tail(degrees_, (a.slope - x) / a.scale); });
    }
    double mean() const {
        return sum_of([](const Answer& a) { return a.slope; });
    }
    double walk() const {
        return sum_of([](const Answer& a) { return a.walk; });
    }

    // Half the width of the central interval that holds so much.
    double half_width(double chance) const {
        const double tail = 0.5 * (1.0 - chance);
        double reach = 0.0;  // beyond every part's own quantile
        const double quantile = students_t_upper_quantile(degrees_, tail);
        const double centre = mean();
        for (const Answer& a : answers_) {
            reach = std::max(reach, std::abs(a.slope - centre) + quantile * a.scale);
        }
        const auto distance_of = [&](auto beyond) {
            double near = -reach;
            double far = reach;
            constexpr int halvings = 40;  // to 1e-12 of the reach
            for (int i = 0; i < halvings; ++i) {
                const double middle = 0.5 * (near + far);
                (beyond(middle) > tail ? near : far) = middle;
            }
            return 0.5 * (near + far);
        };
        return 0.5 * (distance_of([&](double d) { return upper_tail(centre + d); }) +
                      distance_of([&](double d) { return lower_tail(centre - d); }));
    }

private:
    template <typename Value>
    double sum_of(Value value) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < answers_.size(); ++i) { sum += weights_[i] * value(answers_[i]); }
        return sum;
    }

    double degrees_;
    std::vector<Answer> answers_;
    std::vector<double> weights_;
};

double walk_left_in(const std::vector<Answer>& answers) {
    std::vector<double> logs(answers.size());
    std::ranges::transform(answers, logs.begin(), &Answer::log_weight_without);
    const double all = log_sum_exp(logs);
    double walk = 0.0;
    for (const Answer& answer : answers) {
        walk += std::exp(answer.log_weight_without - all) * answer.walk_without;
    }
    return walk;
}

TemperatureDrift drift_of(const std::vector<Answer>& answers, double degrees,
                          const TemperatureDriftOptions& options) {
    TemperatureDrift drift;
    drift.false_alarm = options.false_alarm;
    const AnswerMixture slope(answers, degrees);
    drift.slope_per_C = slope.mean();
    drift.sd_per_C = slope.half_width(chance_within_one_sd);
    drift.chance = std::min(1.0, 2.0 * std::min(slope.upper_tail(0.0), slope.lower_tail(0.0)));
    drift.is_there = drift.chance <= options.false_alarm;
    drift.walk_without = slope.walk();
    drift.walk_left_in = walk_left_in(answers);
    return drift;
}

bool takes_several_values(const std::vector<double>& values) {
    return std::ranges::any_of(values, [&](double value) { return value != values.front(); });
}

// The temperature of every row: between the middles of blocks of what was read, along straight lines.
class SmoothTemperature {
public:
    SmoothTemperature(const Recording& recording, const TemperatureDriftOptions& options)
        : recording_(recording),
          instants_(std::max(static_cast<std::int64_t>(options.smooth_samples_least),
                             static_cast<std::int64_t>(std::llround(options.smooth_s * recording.rate_hz)))),
          knots_(block_means(*recording.find("temp"), recording.segments, instants_)) {}

    // take(row, temperature_C), in the rows' order. There is a knot at least.
    template <typename Take>
    void each_row(Take take) const {
        std::size_t knot = 0;
        const std::int64_t begin = recording_.segments.front().first_index;
        for (const Segment& segment : recording_.segments) {
            for (std::size_t i = 0; i < segment.count; ++i) {
                const double instant =
                    static_cast<double>(segment.first_index - begin) + static_cast<double>(i);
                while (knot + 1 < knots_.size() && middle_of(knot + 1) <= instant) { ++knot; }
                take(segment.first + i, between(knot, instant));
            }
        }
    }

private:
    double middle_of(std::size_t knot) const {
        return (static_cast<double>(knots_[knot].index) + 0.5) * static_cast<double>(instants_) - 0.5;
    }

    double between(std::size_t knot, double instant) const {
        const double here = middle_of(knot);
        if (instant <= here || knot + 1 == knots_.size()) { return knots_[knot].mean; }
        const double part = (instant - here) / (middle_of(knot + 1) - here);
        return knots_[knot].mean + part * (knots_[knot + 1].mean - knots_[knot].mean);
    }

    const Recording& recording_;
    std::int64_t instants_;
    std::vector<BlockMean> knots_;
};

double mean_temperature_C(const SmoothTemperature& temperature, std::size_t rows) {
    double sum_C = 0.0;
    temperature.each_row([&](std::size_t, double value_C) { sum_C += value_C; });
    return sum_C / static_cast<double>(rows);
}

// Nothing where no slope can be told from them.
std::optional<Blocks> telling_blocks(const Recording& recording, std::span<const Column* const> columns,
                                     const TemperatureDriftOptions& options) {
    const Column* temperature = recording.find("temp");
    if (columns.empty() || recording.segments.empty() || temperature == nullptr ||
        temperature->unit != "degC" || !has_readings(*temperature, options.readings_least)) {
        return std::nullopt;
    }
    const auto most = static_cast<std::int64_t>(options.blocks_most);
    const std::int64_t instants = (instants_of(recording) + most - 1) / most;
    Blocks blocks = blocks_of(recording, columns, *temperature, instants, options);
    if (blocks.index.size() < options.blocks_least) { return std::nullopt; }
    const double noise = thermometer_variance(recording, *temperature, instants);
    const double seen = variance_of(blocks.temperature_C);
    if (!(seen > 0.0) || seen < options.temperature_over_noise_least * noise) { return std::nullopt; }
    return blocks;
}

}  // namespace

std::vector<std::optional<TemperatureDrift>> temperature_drifts(const Recording& recording,
                                                                std::span<const Column* const> columns,
                                                                const TemperatureDriftOptions& options) {
    std::vector<std::optional<TemperatureDrift>> drifts(columns.size());
    const std::optional<Blocks> blocks = telling_blocks(recording, columns, options);
    if (!blocks) { return drifts; }
    const auto degrees = static_cast<double>(blocks->index.size()) - 2.0;
    const auto [low, high] = std::ranges::minmax_element(blocks->temperature_C);
    const double mean_C = mean_temperature_C(SmoothTemperature(recording, options), recording.rows());
    const std::vector<std::vector<Answer>> answers = answers_of(*blocks, options);
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (!takes_several_values(blocks->values[c]) || answers[c].empty()) { continue; }
        TemperatureDrift drift = drift_of(answers[c], degrees, options);
        drift.from_C = *low;
        drift.to_C = *high;
        drift.mean_C = mean_C;
        drifts[c] = drift;
    }
    return drifts;
}

Column without_drift(const Recording& recording, const Column& column, const TemperatureDrift& drift,
                     const TemperatureDriftOptions& options) {
    Column result{column.name,  column.unit,   std::vector<double>(column.size()),
                  column.scale, column.offset, column.source_unit};
    auto& rest = std::get<std::vector<double>>(result.data);
    const double per_C = drift.slope_per_C / column.scale;
    const SmoothTemperature temperature(recording, options);
    std::visit(
        [&](const auto& data) {
            temperature.each_row([&](std::size_t row, double value_C) {
                rest[row] = static_cast<double>(data[row]) - per_C * (value_C - drift.mean_C);
            });
        },
        column.data);
    return result;
}

}  // namespace gyrolog
