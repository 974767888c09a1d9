#include "analysis/spectrum/averaged_periodogram.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <variant>

#include "analysis/allan/prefix_sum.hpp"
#include "analysis/spectrum/decimator.hpp"

namespace gyrolog {
namespace {

using std::numbers::pi;

// The mean is taken out of the whole record; what a piece has left of it is in bins 0 and 1 of this taper.
constexpr std::size_t lowest_bin = 2;
// Below it a bin is too wide for a logarithmic axis: pieces that are not the longest stop there.
constexpr std::size_t lowest_bin_of_short_pieces = 16;
// Pieces shorter than the longest are added while fewer samples than this share are in the ones there are.
constexpr double enough_of_the_samples = 0.9;
constexpr std::size_t shortening = 4;
constexpr std::size_t shortest_added_piece = 64;
// Fewer pieces do not tell how even the power is.
constexpr std::size_t least_pieces_for_evenness = 8;
// Nearer to 1 it may be chance.
constexpr double certainly_uneven = 0.8;

// The transform is fast for multiples of 4 without large prime factors.
std::size_t fast_length_up_to(std::size_t samples) {
    for (std::size_t n = samples / 4 * 4; n > 4; n -= 4) {
        std::size_t rest = n;
        for (const std::size_t prime : {2U, 3U, 5U}) {
            while (rest % prime == 0) { rest /= prime; }
        }
        if (rest == 1) { return n; }
    }
    return 4;
}

std::size_t octave_of(std::size_t bin) { return static_cast<std::size_t>(std::bit_width(bin)) - 1; }

// Power of the pieces in one octave.
struct OctavePower {
    double sum = 0.0;
    double squares = 0.0;
};

// Averages the periodograms of one length while samples stream by.
class Welch {
public:
    explicit Welch(std::size_t length)
        : taper_(length), tapered_(length), sums_(length / 2 + 1), octaves_(octave_of(length / 2) + 1) {
        fft_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
        for (std::size_t t = 0; t < length; ++t) {
            const double sine = std::sin(pi * static_cast<double>(t) / static_cast<double>(length));
            taper_[t] = sine * sine;
        }
        waiting_.reserve(length);
    }

    void push(std::span<const double> samples) {
        while (!samples.empty()) {
            const std::size_t taken = std::min(samples.size(), taper_.size() - waiting_.size());
            waiting_.insert(waiting_.end(), samples.begin(),
                            samples.begin() + static_cast<std::ptrdiff_t>(taken));
            samples = samples.subspan(taken);
            if (waiting_.size() == taper_.size()) { take_piece(); }
        }
    }

    void restart() {
        waiting_.clear();
        follows_piece_ = false;
    }

    // Of a signal that the decimator made, unless its rate is the record's.
    AveragedPeriodogram result(double rate_hz, double scale, bool decimated, bool last, bool longest) const;

private:
    void take_piece() {
        for (std::size_t t = 0; t < taper_.size(); ++t) { tapered_[t] = taper_[t] * waiting_[t]; }
        fft_.fwd(spectrum_, tapered_);
        for (std::size_t octave = 0; octave < octaves_.size(); ++octave) { take_octave(octave); }
        ++pieces_;
        overlaps_ += follows_piece_ ? 1 : 0;
        follows_piece_ = true;
        waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(taper_.size() / 2));
    }

    void take_octave(std::size_t octave) {
        double power = 0.0;
        const std::size_t end = std::min(std::size_t{2} << octave, sums_.size());
        for (std::size_t k = std::size_t{1} << octave; k < end; ++k) {
            const double density = std::norm(spectrum_[k]);
            sums_[k] += density;
            power += density;
        }
        octaves_[octave].sum += power;
        octaves_[octave].squares += power * power;
    }

    std::vector<double> evenness() const;

    std::vector<double> taper_, waiting_, tapered_, sums_;
    std::vector<OctavePower> octaves_;
    std::vector<std::complex<double>> spectrum_;
    Eigen::FFT<double> fft_;
    std::size_t pieces_ = 0;
    std::size_t overlaps_ = 0;
    bool follows_piece_ = false;
};

// Pieces of even noise scatter too, by the number of bins in the octave.
std::vector<double> Welch::evenness() const {
    std::vector<double> shares(octaves_.size(), 1.0);
    if (pieces_ < least_pieces_for_evenness) { return shares; }
    for (std::size_t i = 0; i < shares.size(); ++i) {
        if (octaves_[i].squares <= 0.0) { continue; }
        const auto bins =
            static_cast<double>(std::min(std::size_t{2} << i, sums_.size()) - (std::size_t{1} << i));
        const double own_scatter = (1.0 + 2.0 * (bin_correlation[1] + bin_correlation[2])) / bins;
        const double share = (1.0 + own_scatter) * octaves_[i].sum * octaves_[i].sum /
                             (static_cast<double>(pieces_) * octaves_[i].squares);
        if (share < certainly_uneven) { shares[i] = share; }
    }
    return shares;
}

AveragedPeriodogram Welch::result(double rate_hz, double scale, bool decimated, bool last,
                                  bool longest) const {
    const std::size_t n = taper_.size();
    const auto bins_of = [n](double cycles_per_sample) {
        return static_cast<std::size_t>(cycles_per_sample * static_cast<double>(n));
    };
    AveragedPeriodogram result;
    result.rate_hz = rate_hz;
    result.length = n;
    result.pieces = pieces_;
    result.overlaps = overlaps_;
    result.evenness = evenness();
    result.valid_begin = lowest_bin;
    // Bin n / 2 is real, and the taper ties it to the one before it.
    result.valid_end = decimated ? bins_of(Decimator::usable) : n / 2 - 1;
    // Where the decimated signal is good for, it resolves more.
    constexpr double handed_on = 0.25;
    const std::size_t covered_below = last ? 0 : bins_of(handed_on / Decimator::factor);
    result.begin = std::max(longest ? lowest_bin : lowest_bin_of_short_pieces, covered_below);
    result.end = decimated ? bins_of(handed_on) : result.valid_end;
    double taper_power = 0.0;
    for (const double w : taper_) { taper_power += w * w; }
    const double factor = scale * scale / (rate_hz * taper_power * static_cast<double>(pieces_));
    result.density.resize(result.valid_end);
    for (std::size_t k = 0; k < result.valid_end; ++k) {
        const double gain =
            decimated ? Decimator::power_gain(static_cast<double>(k) / static_cast<double>(n)) : 1.0;
        result.density[k] = sums_[k] * factor / gain;
    }
    return result;
}

// The signal at one rate: its periodograms, and the next lower rate.
class Stage {
public:
    // `stretches`: lengths of the unbroken ones.
    explicit Stage(const std::vector<std::size_t>& stretches) {
        const std::size_t longest = *std::ranges::max_element(stretches);
        const bool last = longest <= 2 * longest_piece;
        std::size_t length = last ? fast_length_up_to(longest) : longest_piece;
        welches_.emplace_back(length);
        for (length = length / shortening; length >= shortest_added_piece; length /= shortening) {
            if (!last && !leaves_out_too_much(stretches, welches_.back().length)) { break; }
            length = fast_length_up_to(length);
            welches_.emplace_back(length);
        }
        if (last) { return; }
        std::vector<std::size_t> decimated;
        decimated.reserve(stretches.size());
        for (const std::size_t count : stretches) { decimated.push_back(Decimator::outputs(count)); }
        next_ = std::make_unique<Stage>(decimated);
    }

    void push(std::span<const double> samples) {
        for (Length& each : welches_) { each.welch.push(samples); }
        if (next_ == nullptr) { return; }
        decimator_.push(samples, decimated_);
        next_->push(decimated_);
    }

    void restart() {
        for (Length& each : welches_) { each.welch.restart(); }
        if (next_ == nullptr) { return; }
        decimator_.restart();
        next_->restart();
    }

    void collect(double rate_hz, double scale, bool decimated,
                 std::vector<AveragedPeriodogram>& results) const {
        for (std::size_t i = welches_.size(); i-- > 0;) {
            AveragedPeriodogram result =
                welches_[i].welch.result(rate_hz, scale, decimated, next_ == nullptr, i == 0);
            if (result.pieces == 0 || result.begin >= result.end) { continue; }
            // What few long pieces do not tell, the shorter ones before them do.
            if (result.pieces < least_pieces_for_evenness && i + 1 < welches_.size() && !results.empty()) {
                const AveragedPeriodogram& shorter = results.back();
                for (std::size_t octave = 0; octave < result.evenness.size(); ++octave) {
                    const double f_hz = result.f_hz(std::size_t{1} << octave);
                    result.evenness[octave] =
                        shorter.evenness_at(static_cast<std::size_t>(f_hz / shorter.width_hz()));
                }
            }
            results.push_back(std::move(result));
        }
        if (next_ != nullptr) { next_->collect(rate_hz / Decimator::factor, scale, true, results); }
    }

private:
    struct Length {
        explicit Length(std::size_t samples) : length(samples), welch(samples) {}
        std::size_t length;
        Welch welch;
    };

    static bool leaves_out_too_much(const std::vector<std::size_t>& stretches, std::size_t length) {
        double all = 0.0;
        double used = 0.0;
        for (const std::size_t count : stretches) {
            all += static_cast<double>(count);
            if (count >= length) { used += static_cast<double>(count - count % (length / 2)); }
        }
        return used < enough_of_the_samples * all;
    }

    std::vector<Length> welches_;  // longest first
    Decimator decimator_;
    std::vector<double> decimated_;
    std::unique_ptr<Stage> next_;
};

void stream(const Column& column, const Segment& segment, double centre, Stage& stage) {
    constexpr std::size_t block_samples = 4096;
    std::array<double, block_samples> block{};
    std::visit(
        [&](const auto& values) {
            for (std::size_t done = 0; done < segment.count; done += block_samples) {
                const std::size_t count = std::min(block_samples, segment.count - done);
                const auto* first = values.data() + segment.first + done;
                for (std::size_t i = 0; i < count; ++i) { block[i] = static_cast<double>(first[i]) - centre; }
                stage.push({block.data(), count});
            }
        },
        column.data);
    stage.restart();
}

// Power correlation of bins `apart` bins from each other, of pieces that share half of their samples:
// |sum_t w_t w_{t + n/2} exp(2 pi i apart t / n)|^2 / (sum_t w_t^2)^2, for long pieces.
double overlap_correlation(std::size_t apart) {
    constexpr std::size_t n = 512;
    std::complex<double> sum;
    double power = 0.0;
    for (std::size_t t = 0; t < n; ++t) {
        const double angle = pi * static_cast<double>(t) / n;
        const double w = std::pow(std::sin(angle), 2);
        power += w * w;
        if (t < n / 2) {
            sum +=
                w * std::pow(std::cos(angle), 2) * std::polar(1.0, 2.0 * angle * static_cast<double>(apart));
        }
    }
    return std::norm(sum) / (power * power);
}

}  // namespace

double AveragedPeriodogram::evenness_at(std::size_t bin) const {
    if (bin == 0 || evenness.empty()) { return 1.0; }
    return evenness[std::min(octave_of(bin), evenness.size() - 1)];
}

double AveragedPeriodogram::degrees_of_freedom(std::size_t bins) const {
    static const auto overlapped = [] {
        std::array<double, 8> correlations{};
        for (std::size_t b = 0; b < correlations.size(); ++b) { correlations[b] = overlap_correlation(b); }
        return correlations;
    }();
    const auto all = static_cast<double>(bins);
    const auto count = static_cast<double>(pieces);
    double sum = 0.0;
    for (std::size_t b = 0; b < std::min(bins, overlapped.size()); ++b) {
        const double pairs = (b == 0 ? 1.0 : 2.0) * (all - static_cast<double>(b));
        const double same_piece = b < std::size(bin_correlation) ? bin_correlation[b] : 0.0;
        sum += pairs * (count * same_piece + 2.0 * static_cast<double>(overlaps) * overlapped[b]);
    }
    return sum > 0.0 ? 2.0 * std::pow(count * all, 2) / sum : 0.0;
}

std::vector<AveragedPeriodogram> averaged_periodograms(const Column& column,
                                                       std::span<const Segment> segments, double rate_hz) {
    std::vector<std::size_t> stretches;
    stretches.reserve(segments.size());
    for (const Segment& segment : segments) { stretches.push_back(segment.count); }
    std::vector<AveragedPeriodogram> results;
    if (stretches.empty() || *std::ranges::max_element(stretches) < shortest_piece) { return results; }
    Stage stage(stretches);
    const double centre = raw_mean(column);
    for (const Segment& segment : segments) { stream(column, segment, centre, stage); }
    stage.collect(rate_hz, column.scale, false, results);
    return results;
}

}  // namespace gyrolog
