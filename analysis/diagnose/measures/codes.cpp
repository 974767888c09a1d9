#include "analysis/diagnose/measures/codes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <variant>

#include "analysis/diagnose/measures/shown_values.hpp"
#include "analysis/numerics/square.hpp"
#include "analysis/numerics/tail_probability.hpp"
#include "analysis/numerics/uniform.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

constexpr std::size_t codes_around = 6;  // on either side
constexpr double code_count_least = 8.0;
constexpr double log_mean_most = 40.0;
constexpr double codes_most = 1 << 20;
constexpr int scoring_rounds = 6;
constexpr double count_at_start_least = 0.5;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// How often each code of the converter was shown, from codes_around below the least to as far above the
// largest.
std::vector<double> count_codes(const Recording& recording, std::size_t axis, double lsb_rad_s) {
    const Column& column = *recording.find(gyro_columns.at(axis));
    const double codes_per_number = column.scale / lsb_rad_s;
    return std::visit(
        [&](const auto& data) -> std::vector<double> {
            if (data.empty()) { return {}; }
            const auto [least, most] = std::ranges::minmax(data);
            const double one_end = static_cast<double>(least) * codes_per_number;
            const double other_end = static_cast<double>(most) * codes_per_number;
            const double first = std::round(std::min(one_end, other_end));
            const double codes = std::round(std::max(one_end, other_end)) - first;
            if (codes > resolution::codes_most) { return {}; }
            std::vector<double> counts(static_cast<std::size_t>(codes) + 1 + 2 * resolution::codes_around,
                                       0.0);
            const double from = first - static_cast<double>(resolution::codes_around);
            for (const auto number : data) {
                const double code = static_cast<double>(number) * codes_per_number - from;
                counts[static_cast<std::size_t>(std::max(code + 0.5, 0.0))] += 1.0;
            }
            return counts;
        },
        column.data);
}

// What the codes around say of one: a parabola through the logarithms of their counts, which a normal density
// is. The code itself and its neighbours, that have what it lacks, are left out.
struct ExpectedCount {
    double count = 0.0;
    double rel_variance = 0.0;
};

// By the scoring iterations of a Poisson regression. `counts` goes on by codes_around beyond the code.
ExpectedCount expected_count(const std::vector<double>& counts, std::size_t code) {
    const auto first = counts.begin() + static_cast<std::ptrdiff_t>(code - resolution::codes_around);
    const double all = std::accumulate(first, first + 2 * resolution::codes_around + 1, 0.0);
    if (all < resolution::code_count_least) { return {}; }
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    Eigen::LDLT<Eigen::Matrix3d> solver;
    for (int iteration = 0; iteration < resolution::scoring_rounds; ++iteration) {
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i <= 2 * resolution::codes_around; ++i) {
            const double away = static_cast<double>(i) - static_cast<double>(resolution::codes_around);
            if (std::fabs(away) < 2.0) { continue; }
            const double count = counts[code - resolution::codes_around + i];
            const Eigen::Vector3d powers(1.0, away, away * away);
            const double log_mean =
                iteration == 0 ? std::log(std::max(count, resolution::count_at_start_least)) : powers.dot(at);
            const double mean = std::exp(std::min(log_mean, resolution::log_mean_most));
            normal.noalias() += mean * powers * powers.transpose();
            right += (mean * log_mean + count - mean) * powers;
        }
        solver.compute(normal);
        if (!(solver.rcond() > 1e-10)) { return {}; }
        at = solver.solve(right);
    }
    return {std::exp(at[0]), solver.solve(Eigen::Vector3d::UnitX())[0]};
}

// Twice the log likelihood ratio of a Poisson count, sharing its chance with that of what is expected.
double deviance(double count, const ExpectedCount& expected) {
    const double log_part = count > 0.0 ? count * std::log(count / expected.count) : 0.0;
    return 2.0 * (log_part - count + expected.count) / (1.0 + expected.count * expected.rel_variance);
}

// Of the code, or of it and the next, that is most at odds with those around.
double most_surprising_code(const std::vector<double>& counts) {
    double most_alone = 0.0;
    double most_of_two = 0.0;
    double tries = 0.0;
    double before = 0.0;
    for (std::size_t code = resolution::codes_around; code + resolution::codes_around < counts.size();
         ++code) {
        const ExpectedCount expected = expected_count(counts, code);
        if (!(expected.count >= resolution::code_count_least)) {
            before = 0.0;
            continue;
        }
        const double own = deviance(counts[code], expected);
        most_alone = std::max(most_alone, own);
        most_of_two = std::max(most_of_two, own + before);
        before = own;
        tries += 1.0;
    }
    if (!(tries > 0.0)) { return 0.0; }
    const double surprise = std::max(surprise_of_largest(most_alone, 1.0, 2.0 * tries),
                                     surprise_of_largest(most_of_two, 2.0, 2.0 * tries));
    return deviate_of(surprise);
}

// Of even codes over odd ones, in standard deviations. Noise of s codes leaves, by where the bias lies
// between two codes, a balance of up to 2 exp(-pi^2 s^2 / 2) of all (the first term of the Fourier series of
// a sampled normal density); that place is not known.
double balance_of(const std::vector<double>& counts) {
    double balance = 0.0;
    double all = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t code = 0; code < counts.size(); ++code) {
        const auto at = static_cast<double>(code);
        balance += code % 2 == 0 ? counts[code] : -counts[code];
        all += counts[code];
        sum += counts[code] * at;
        squares += counts[code] * at * at;
    }
    if (!(all > 0.0)) { return 0.0; }
    const double mean = sum / all;
    const double variance = std::max(squares / all - mean * mean - variance_of_uniform(1.0), 0.0);
    const double of_place = std::sqrt(2.0) * all * std::exp(-0.5 * square(std::numbers::pi) * variance);
    return std::fabs(balance) / std::hypot(std::sqrt(all), of_place);
}

GapCurve codes_curve(const Observation& observation, std::size_t axis) {
    const double lsb_rad_s = observation.prediction().model().lsb_rad_s;
    GapCurve curve{&measures::codes, axis, axis, {1.0, 2.0}, {0.0, 0.0}};
    // What moves shows each code for as long as the motion has it.
    if (!(lsb_rad_s > 0.0) || observation.prediction().moves()) { return curve; }
    const std::vector<double> counts = count_codes(observation.recording(), axis, lsb_rad_s);
    curve.value[0] = most_surprising_code(counts);
    curve.value[1] = balance_of(counts);
    return curve;
}

constexpr std::array ways_to_count = {"each code", "even and odd"};

void locate_codes(const GapCurve& /*curve*/, const std::vector<double>& /*z*/, Place& where) {
    where.structure = "code_grid";
}

}  // namespace

const Measure measures::codes{.name = "converter's codes",
                              .x_name = "",
                              .y_name = "excess (its sd)",
                              .shown_x = as_it_is,
                              .shown_y = as_it_is,
                              .locate = locate_codes,
                              .categories = ways_to_count,
                              .is_course = false,
                              // Of a largest deviate.
                              .least_sd = 0.5,
                              .is_normal_far_out = false,
                              .is_of_noise = true};

void add_codes_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    curves.push_back(codes_curve(observation, axis));
}

}  // namespace gyrolog
