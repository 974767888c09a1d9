#include "host/decode/sample_timeline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace gyrolog {
namespace {

// A thousand stamps fix the slope of a line far better than the board's crystal deserves, and bound the
// memory.
constexpr std::size_t stamps_kept = 1024;
constexpr std::size_t runs_kept = 1024;
constexpr std::size_t clock_parts = 16;
constexpr double max_wraps = 1e6;

struct Point {
    double x = 0.0;
    double y = 0.0;
};

// A damaged file may claim any time; far from the ends of the type, differences cannot overflow.
std::int64_t arrival_ns_of(HostTime arrival) {
    constexpr std::int64_t far_ns = std::numeric_limits<std::int64_t>::max() / 4;
    return std::clamp(arrival.monotonic_ns, -far_ns, far_ns);
}

// The part of the convex hull below the points, which come in order of x.
std::vector<Point> lower_hull(const std::vector<Point>& points) {
    std::vector<Point> hull;
    for (const Point& p : points) {
        while (hull.size() >= 2) {
            const Point& a = hull[hull.size() - 2];
            const Point& b = hull.back();
            if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0.0) { break; }
            hull.pop_back();
        }
        hull.push_back(p);
    }
    return hull;
}

}  // namespace

void SampleTimeline::take_hello(const glp_hello& hello) {
    tick_hz_ = hello.tick_hz;
    tick_mask_ = hello.tick_bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << hello.tick_bits) - 1U;
}

// The counter may go round more than once while nothing is sampled: what passed by another account says how
// often. That never takes a turn away: a source that does not wait is faster than its own time.
std::int64_t SampleTimeline::ticks_since_last(std::uint64_t ticks, double about_ticks) const {
    const std::uint64_t step = (ticks - *raw_ticks_) & tick_mask_;
    if (step > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()) / 4) { return 0; }
    double turned = 0.0;
    if (tick_hz_.value_or(0) > 0 && tick_mask_ != ~std::uint64_t{0}) {
        const double turn = static_cast<double>(tick_mask_) + 1.0;
        turned =
            turn * std::clamp(std::round((about_ticks - static_cast<double>(step)) / turn), 0.0, max_wraps);
    }
    return static_cast<std::int64_t>(step) + (turned < 1e18 ? static_cast<std::int64_t>(turned) : 0);
}

double SampleTimeline::ticks_by_host(std::int64_t arrival_ns) const {
    return static_cast<double>(arrival_ns - arrival_ns_) * 1e-9 * tick_hz_.value_or(0);
}

// In one run the board's indices tell: what waited on the board while nobody took it arrives late, and
// together with what comes behind it.
double SampleTimeline::ticks_by_index(const SamplePlace& place, const glp_samples& samples,
                                      std::int64_t arrival_ns) const {
    if (runs_.empty() || runs_.back().number != place.run || runs_.back().last.index <= 0) {
        return ticks_by_host(arrival_ns);
    }
    const Run& run = runs_.back();
    const double spacing = static_cast<double>(run.last.ticks) / static_cast<double>(run.last.index);
    const auto index = static_cast<std::int64_t>(samples.first_index - run.first_index);
    return spacing * static_cast<double>(index - run.last.index);
}

std::optional<double> SampleTimeline::since_last_s(std::uint32_t boot, std::uint64_t ticks,
                                                   HostTime arrival) const {
    if (boots_.empty() || boots_.back().number != boot || !raw_ticks_ || tick_hz_.value_or(0) == 0) {
        return std::nullopt;
    }
    return static_cast<double>(ticks_since_last(ticks, ticks_by_host(arrival_ns_of(arrival)))) / *tick_hz_;
}

void SampleTimeline::take_samples(const SamplePlace& place, const glp_samples& samples, HostTime arrival) {
    present_ = place;
    const std::int64_t arrival_ns = arrival_ns_of(arrival);
    if (boots_.empty() || boots_.back().number != place.boot) {
        if (boots_.size() == runs_kept) { return; }
        Boot boot;
        boot.number = place.boot;
        boot.arrival_ns = arrival_ns;
        if (!boots_.empty()) {
            const Boot& before = boots_.back();
            boot.base_s = start_of(before) + static_cast<double>(arrival_ns - before.arrival_ns) * 1e-9 -
                          before.tail_delay_s();
        }
        boots_.push_back(boot);
        ticks_ = 0;
    } else {
        const std::int64_t step =
            ticks_since_last(samples.first_ticks, ticks_by_index(place, samples, arrival_ns));
        if (step > std::numeric_limits<std::int64_t>::max() / 2 - ticks_) { return; }
        ticks_ += step;
    }
    raw_ticks_ = samples.first_ticks;
    arrival_ns_ = arrival_ns;

    if (runs_.empty() || runs_.back().number != place.run) {
        if (runs_.size() == runs_kept) { return; }
        Run run;
        run.boot = place.boot;
        run.number = place.run;
        run.first_index = samples.first_index;
        run.start_ticks = ticks_;
        runs_.push_back(run);
    }
    Run& run = runs_.back();
    const auto index = static_cast<std::int64_t>(samples.first_index - run.first_index);
    run.last = {index, ticks_ - run.start_ticks, arrival_ns_, samples.count - 1};
    keep(run, run.last);
    note_delay(boots_.back(), run);
}

double SampleTimeline::Boot::tail_delay_s() const {
    const auto kept = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(frames, delays_kept));
    return kept == 0 ? 0.0 : *std::min_element(last_delays_s.begin(), last_delays_s.begin() + kept);
}

// A frame's span is known by the spacing of the run's samples so far, hence from its second frame on.
void SampleTimeline::note_delay(Boot& boot, const Run& run) const {
    if (tick_hz_.value_or(0) == 0 || run.last.index <= 0) { return; }
    const double spacing = static_cast<double>(run.last.ticks) / static_cast<double>(run.last.index);
    const double ticks = static_cast<double>(run.start_ticks) + static_cast<double>(run.last.ticks) +
                         spacing * static_cast<double>(run.last.last);
    const double delay_s =
        static_cast<double>(run.last.arrival_ns - boot.arrival_ns) * 1e-9 - ticks / *tick_hz_;
    if (boot.frames == 0) { boot.head_delay_s = delay_s; }
    if (boot.frames < Boot::delays_kept) { boot.head_delay_s = std::min(boot.head_delay_s, delay_s); }
    boot.last_delays_s[boot.frames % Boot::delays_kept] = delay_s;
    ++boot.frames;
}

// Of `stride` frames in a row the one with the smallest delay is kept. When there is no room, neighbours are
// merged by the same rule and the stride doubles.
void SampleTimeline::keep(Run& run, const Stamp& stamp) const {
    const double tick_ns = tick_hz_.value_or(0) > 0 ? 1e9 / static_cast<double>(*tick_hz_) : 0.0;
    const auto earlier = [&](const Stamp& a, const Stamp& b) {
        const double host_ns = static_cast<double>(b.arrival_ns) - static_cast<double>(a.arrival_ns);
        return host_ns < static_cast<double>(b.ticks - a.ticks) * tick_ns ? b : a;
    };
    const bool same_bucket = run.frames % run.stride != 0;
    ++run.frames;
    if (same_bucket) {
        run.stamps.back() = earlier(run.stamps.back(), stamp);
        return;
    }
    if (run.stamps.size() == stamps_kept) {
        for (std::size_t i = 0; i < stamps_kept / 2; ++i) {
            run.stamps[i] = earlier(run.stamps[2 * i], run.stamps[2 * i + 1]);
        }
        run.stamps.resize(stamps_kept / 2);
        run.stride *= 2;
    }
    run.stamps.push_back(stamp);
}

const SampleTimeline::Run* SampleTimeline::find(std::uint32_t number) const {
    const auto found = std::lower_bound(runs_.begin(), runs_.end(), number,
                                        [](const Run& run, std::uint32_t n) { return run.number < n; });
    return found != runs_.end() && found->number == number ? &*found : nullptr;
}

std::optional<RateEstimate> SampleTimeline::rate(std::uint32_t first_run, std::uint32_t last_run) const {
    if (tick_hz_.value_or(0) == 0) { return std::nullopt; }
    const double tick_hz = *tick_hz_;

    struct Mean {
        const Run* run;
        double index, ticks;
    };
    std::vector<Mean> means;
    std::size_t stamps = 0;
    double sxx = 0.0;
    double sxy = 0.0;
    for (const Run& run : runs_) {
        if (run.number < first_run || run.number > last_run || run.stamps.empty()) { continue; }
        Mean mean{&run, 0.0, 0.0};
        for (const Stamp& stamp : run.stamps) {
            mean.index += static_cast<double>(stamp.index);
            mean.ticks += static_cast<double>(stamp.ticks);
        }
        mean.index /= static_cast<double>(run.stamps.size());
        mean.ticks /= static_cast<double>(run.stamps.size());
        for (const Stamp& stamp : run.stamps) {
            const double x = static_cast<double>(stamp.index) - mean.index;
            sxx += x * x;
            sxy += x * (static_cast<double>(stamp.ticks) - mean.ticks);
        }
        stamps += run.stamps.size();
        means.push_back(mean);
    }
    if (stamps < means.size() + 2 || sxy <= 0.0) { return std::nullopt; }

    const double ticks_per_sample = sxy / sxx;
    double square = 0.0;
    double neighbours = 0.0;
    for (const Mean& mean : means) {
        double before = 0.0;
        for (const Stamp& stamp : mean.run->stamps) {
            const double residual = static_cast<double>(stamp.ticks) - mean.ticks -
                                    ticks_per_sample * (static_cast<double>(stamp.index) - mean.index);
            square += residual * residual;
            neighbours += residual * before;
            before = residual;
        }
    }
    // A stamp is a whole number of ticks: its error has a variance of at least 1/12 even when all of them
    // agree.
    const double variance = std::max(square / static_cast<double>(stamps - means.size() - 1), 1.0 / 12.0);
    const double correlation = square > 0.0 ? std::clamp(neighbours / square, 0.0, 0.99) : 0.0;
    const double inflation = (1.0 + correlation) / (1.0 - correlation);

    RateEstimate estimate;
    estimate.rate_hz = tick_hz / ticks_per_sample;
    estimate.sd_hz = estimate.rate_hz / ticks_per_sample * std::sqrt(variance * inflation / sxx);
    estimate.jitter_s = std::sqrt(variance) / tick_hz;
    estimate.stamps = stamps;
    return estimate;
}

std::optional<HostClockFit> SampleTimeline::host_clock() const {
    const auto longest = std::max_element(
        runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.last.ticks < b.last.ticks; });
    if (longest == runs_.end() || tick_hz_.value_or(0) == 0) { return std::nullopt; }
    const std::optional<RateEstimate> sensor = rate(longest->number, longest->number);
    if (!sensor) { return std::nullopt; }

    // A frame cannot arrive before its last sample was taken.
    const double start_s = start_of(*longest);
    const double arrival_s = static_cast<double>(longest->stamps.front().arrival_ns) * 1e-9;
    std::vector<Point> points;
    double mean_x = 0.0;
    for (const Stamp& stamp : longest->stamps) {
        const double x =
            static_cast<double>(stamp.ticks) / *tick_hz_ + static_cast<double>(stamp.last) / sensor->rate_hz;
        const double y = static_cast<double>(stamp.arrival_ns - longest->stamps.front().arrival_ns) * 1e-9;
        points.push_back({x, y});
        mean_x += x;
    }
    mean_x /= static_cast<double>(points.size());
    std::ranges::stable_sort(points, {}, &Point::x);
    const std::vector<Point> hull = lower_hull(points);
    const auto right = std::ranges::find_if(hull, [&](const Point& p) { return p.x >= mean_x; });
    if (hull.size() < 2 || right == hull.begin() || right == hull.end()) { return std::nullopt; }
    const auto left = right - 1;
    const double ratio = (right->y - left->y) / (right->x - left->x);

    // Smallest delay of each part of the run: were the link's delays the same all the time, they would be
    // equal.
    const double part_s = (points.back().x - points.front().x) / clock_parts;
    std::array<std::optional<Point>, clock_parts> least;
    for (const Point& p : points) {
        const auto part = static_cast<std::size_t>((p.x - points.front().x) / part_s);
        std::optional<Point>& smallest = least[std::min(part, clock_parts - 1)];
        const double delay = p.y - left->y - ratio * (p.x - left->x);
        if (!smallest || delay < smallest->y) { smallest = Point{p.x, delay}; }
    }
    double n = 0.0;
    Point mean;
    for (const auto& p : least) {
        if (p) {
            n += 1.0;
            mean.x += p->x;
            mean.y += p->y;
        }
    }
    mean.x /= n;
    mean.y /= n;
    double sxx = 0.0;
    double syy = 0.0;
    for (const auto& p : least) {
        if (p) {
            sxx += (p->x - mean.x) * (p->x - mean.x);
            syy += (p->y - mean.y) * (p->y - mean.y);
        }
    }
    if (n < 3.0 || sxx <= 0.0) { return std::nullopt; }
    const double sd_s = std::sqrt(syy / (n - 1.0));

    HostClockFit fit;
    fit.ratio = ratio;
    fit.ratio_sd = sd_s / std::sqrt(sxx);
    fit.offset_s = arrival_s + left->y - ratio * (left->x + start_s);
    fit.offset_sd_s = sd_s * std::sqrt(1.0 / n + (mean.x + start_s) * (mean.x + start_s) / sxx);
    return fit;
}

double SampleTimeline::start_of(const Boot& boot) const {
    return &boot == &boots_.front() ? 0.0 : boot.base_s + boot.head_delay_s;
}

double SampleTimeline::start_of(const Run& run) const {
    const auto boot = std::lower_bound(boots_.begin(), boots_.end(), run.boot,
                                       [](const Boot& b, std::uint32_t n) { return b.number < n; });
    return start_of(*boot) + static_cast<double>(run.start_ticks) / tick_hz_.value_or(1);
}

std::optional<double> SampleTimeline::device_time_s(std::uint32_t run_number, std::uint64_t index,
                                                    double rate_hz) const {
    const Run* run = find(run_number);
    if (run == nullptr || tick_hz_.value_or(0) == 0 || rate_hz <= 0.0) { return std::nullopt; }
    const auto from_first = static_cast<std::int64_t>(index - run->first_index);
    Stamp nearest = run->last;
    if (from_first < run->last.index) {
        const auto after =
            std::upper_bound(run->stamps.begin(), run->stamps.end(), from_first,
                             [](std::int64_t i, const Stamp& stamp) { return i < stamp.index; });
        nearest = after == run->stamps.begin() ? *after : *(after - 1);
    }
    return start_of(*run) + static_cast<double>(nearest.ticks) / *tick_hz_ +
           (static_cast<double>(from_first) - static_cast<double>(nearest.index)) / rate_hz;
}

// A run's own stamps change while it lasts, and the place of its boot with that boot's first frames. A run
// that found no room stays unknown.
bool SampleTimeline::settled(std::uint32_t run_number) const {
    const Run* run = find(run_number);
    if (run == nullptr) { return true; }
    const bool over = run->number != present_.run;
    const bool placed = run->boot != present_.boot || boots_.back().frames >= Boot::delays_kept;
    return over && placed;
}

std::vector<Dropout> SampleTimeline::time_dropouts(const std::vector<LinkDropout>& dropouts,
                                                   double nominal_rate_hz) const {
    std::vector<Dropout> timed;
    timed.reserve(dropouts.size());
    std::optional<std::uint32_t> run;
    double rate_hz = nominal_rate_hz;
    for (const LinkDropout& dropout : dropouts) {
        if (run != dropout.run) {
            run = dropout.run;
            const auto estimate = rate(*run, *run);
            rate_hz = estimate ? estimate->rate_hz : nominal_rate_hz;
        }
        timed.push_back({device_time_s(*run, dropout.first_index, rate_hz).value_or(0.0),
                         static_cast<std::int64_t>(dropout.samples),
                         std::string(dropout_cause_name(dropout.cause))});
    }
    return timed;
}

}  // namespace gyrolog
