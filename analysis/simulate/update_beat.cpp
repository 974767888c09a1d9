#include "analysis/simulate/update_beat.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

namespace {

// Fewer tell no phase.
constexpr std::size_t repeats_min = 16;
constexpr std::size_t group_repeats = 64;
// Of few repeats eight groups, or as many as have eight each: one alone tells no change of phase.
constexpr std::size_t few = 8;
constexpr std::size_t searched_groups = 16;
// Where nearly all samples repeat, a beat and repeats at random look alike.
constexpr double share_most = 0.9;
// Of a turn, about the middle of a group's: what jitter and drift may move a repeat by.
constexpr double window_least = 0.1;
// Groups farther apart, in typical distances, may have turned unseen between them.
constexpr double neighbours_most = 4.0;
// Trial values of eps: a group's phases turn by a quarter from one to the next.
constexpr double turn_per_trial = 0.25;
constexpr int rounds = 3;
constexpr double majority = 0.5;

template <typename Predicate>
void erase_unless(std::vector<std::size_t>& rows, Predicate predicate) {
    std::erase_if(rows, [&](std::size_t row) { return !predicate(row); });
}

struct Repeats {
    std::vector<double> samples;  // that repeat the one before in all gyro axes, ascending
    double pairs = 0.0;           // of samples that follow each other

    double share() const { return static_cast<double>(samples.size()) / pairs; }
};

Repeats repeats_of(const Recording& recording) {
    Repeats repeats;
    std::vector<std::size_t> rows;
    for (const Segment& segment : recording.segments) {
        rows.clear();
        bool first_axis = true;
        for (const char* name : gyro_columns) {
            const Column* column = recording.find(name);
            if (column == nullptr) { continue; }
            std::visit(
                [&](const auto& data) {
                    const auto is_repeat = [&](std::size_t row) { return data[row] == data[row - 1]; };
                    if (!first_axis) { return erase_unless(rows, is_repeat); }
                    for (std::size_t row = segment.first + 1; row < segment.first + segment.count; ++row) {
                        if (is_repeat(row)) { rows.push_back(row); }
                    }
                },
                column->data);
            first_axis = false;
        }
        const std::int64_t offset = segment.first_index - recording.segments.front().first_index -
                                    static_cast<std::int64_t>(segment.first);
        for (const std::size_t row : rows) {
            repeats.samples.push_back(static_cast<double>(static_cast<std::int64_t>(row) + offset));
        }
        repeats.pairs += segment.count > 0 ? static_cast<double>(segment.count - 1) : 0.0;
    }
    return repeats;
}

std::vector<std::span<const double>> in_groups(std::span<const double> samples) {
    std::vector<std::span<const double>> groups;
    const std::size_t count =
        std::max({std::size_t{1}, samples.size() / group_repeats, std::min(few, samples.size() / few)});
    groups.reserve(count);
    for (std::size_t g = 0; g < count; ++g) {
        const std::size_t first = g * samples.size() / count;
        groups.push_back(samples.subspan(first, (g + 1) * samples.size() / count - first));
    }
    return groups;
}

double power_at(std::span<const std::span<const double>> groups, double eps) {
    double power = 0.0;
    for (const std::span<const double> group : groups) {
        double sine = 0.0;
        double cosine = 0.0;
        for (const double sample : group) {
            sine += portable_sine_of_turns(sample * eps);
            cosine += portable_sine_of_turns(sample * eps + 0.25);
        }
        power += sine * sine + cosine * cosine;
    }
    return power;
}

// From -1/2 to 1/2.
double part_of_turn(double turns) { return turns - std::floor(turns + 0.5); }

// A group's median turn, looked for about `near`.
double median_turn(std::span<const double> group, double eps, double near) {
    std::vector<double> turns;
    turns.reserve(group.size());
    for (const double sample : group) { turns.push_back(part_of_turn(sample * eps - near)); }
    const auto middle = turns.begin() + static_cast<std::ptrdiff_t>(turns.size() / 2);
    std::ranges::nth_element(turns, middle);
    return near + *middle;
}

double scatter_about(std::span<const double> group, double eps, double turn) {
    double sum = 0.0;
    for (const double sample : group) { sum += std::fabs(part_of_turn(sample * eps - turn)); }
    return sum;
}

// Of the first group, of which nothing is known.
double first_turn(std::span<const double> group, double eps) {
    constexpr int places = 8;
    double best = 0.0;
    for (int i = 1; i < places; ++i) {
        const double turn = static_cast<double>(i) / places;
        if (scatter_about(group, eps, turn) < scatter_about(group, eps, best)) { best = turn; }
    }
    return best;
}

struct Turn {
    double sample = 0.0;
    double turn = 0.0;
};

// By group: at its middle sample.
std::vector<Turn> turns_of(std::span<const std::span<const double>> groups, double eps) {
    std::vector<Turn> turns;
    double near = first_turn(groups.front(), eps);
    for (const std::span<const double> group : groups) {
        near = median_turn(group, eps, near);
        turns.push_back({0.5 * (group.front() + group.back()), near});
    }
    return turns;
}

// Turns a sample, from group to group.
double slope_of(std::span<const Turn> turns) {
    std::vector<double> distances;
    for (std::size_t i = 1; i < turns.size(); ++i) {
        distances.push_back(turns[i].sample - turns[i - 1].sample);
    }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::ranges::nth_element(distances, middle);
    const double farthest = neighbours_most * *middle;
    Turn sum;
    for (std::size_t i = 1; i < turns.size(); ++i) {
        const double distance = turns[i].sample - turns[i - 1].sample;
        if (distance > farthest) { continue; }
        sum.sample += distance;
        sum.turn += turns[i].turn - turns[i - 1].turn;
    }
    return sum.turn / sum.sample;
}

// The share of the repeats that come where the beat has them.
double share_in_beat(std::span<const std::span<const double>> groups, std::span<const Turn> turns, double eps,
                     double window) {
    double in_beat = 0.0;
    double all = 0.0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        for (const double sample : groups[g]) {
            all += 1.0;
            in_beat += std::fabs(part_of_turn(sample * eps - turns[g].turn)) <= 0.5 * window ? 1.0 : 0.0;
        }
    }
    return in_beat / all;
}

// Up to the share of all repeats; by a beat's phase a share is off by one repeat.
double best_eps(std::span<const std::span<const double>> groups, double share, std::size_t repeats) {
    std::vector<std::span<const double>> searched;
    const std::size_t count = std::min(groups.size(), searched_groups);
    for (std::size_t i = 0; i < count; ++i) { searched.push_back(groups[i * groups.size() / count]); }
    const double step = turn_per_trial * share / static_cast<double>(groups.front().size());
    double best = 0.0;
    double most = 0.0;
    const double highest = share * (1.0 + 1.0 / static_cast<double>(repeats)) + step;
    const auto trials = static_cast<std::size_t>((highest - majority * share) / step);
    for (std::size_t trial = 0; trial <= trials; ++trial) {
        const double eps = highest - static_cast<double>(trial) * step;
        const double power = power_at(searched, eps);
        if (power > most) {
            most = power;
            best = eps;
        }
    }
    return best;
}

}  // namespace

UpdateBeat::Update UpdateBeat::at(std::uint64_t k) const {
    const auto sample = static_cast<double>(k);
    const auto after = std::ranges::upper_bound(knots_, sample, {}, &Knot::sample);
    double phase = after == knots_.begin() ? knots_.front().phase : (after - 1)->phase;
    if (after != knots_.begin() && after != knots_.end()) {
        const Knot& before = *(after - 1);
        phase += (sample - before.sample) / (after->sample - before.sample) * (after->phase - before.phase);
    }
    const double fresh_share = 1.0 - eps_;
    const double updates = sample * fresh_share + phase;
    const double number = std::floor(updates);
    return {number, (updates - number) / fresh_share};
}

std::optional<UpdateBeat> recorded_beat(const Recording& recording) {
    const Repeats repeats = repeats_of(recording);
    if (repeats.samples.size() < repeats_min || repeats.share() > share_most) { return std::nullopt; }
    const auto groups = in_groups(repeats.samples);
    double eps = best_eps(groups, repeats.share(), repeats.samples.size());
    std::vector<Turn> turns = turns_of(groups, eps);
    for (int round = 0; round < rounds; ++round) {
        eps -= slope_of(turns);
        turns = turns_of(groups, eps);
    }
    const double window = std::max(eps, window_least);
    if (share_in_beat(groups, turns, eps, window) <= majority * (1.0 + window)) { return std::nullopt; }
    // No update comes between samples k - 1 and k where k eps - phase is less than eps above a whole number:
    // half of it in the middle.
    std::vector<UpdateBeat::Knot> knots;
    knots.reserve(turns.size());
    for (const Turn& each : turns) { knots.push_back({each.sample, each.turn - 0.5 * eps}); }
    return UpdateBeat(eps, std::move(knots), repeats.samples.size());
}

}  // namespace gyrolog
