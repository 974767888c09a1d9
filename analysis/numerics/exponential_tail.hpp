// An exponential tail is what numbers have beyond a high threshold, where their logarithm's tail falls no
// faster (Pickands, Ann. Statist. 3 (1975) 119). Its largest may be something else: the mean excess is that
// of a sample censored there (Epstein, Sobel, J. Amer. Statist. Assoc. 48 (1953) 486).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace gyrolog {

struct ExponentialTailOptions {
    double share = 0.05;           // of the numbers, that lies in the tail
    std::size_t least = 20;        // numbers in the tail, from which its mean is known to a quarter
    double censored_share = 0.25;  // of the tail, that may be something else
    double mean_least = 0.0;       // of the excess over the threshold
};

class ExponentialTail {
public:
    // No value where twice as many numbers as are in the tail are not there.
    static std::optional<ExponentialTail> of(std::span<const double> values,
                                             const ExponentialTailOptions& options);

    double threshold() const { return threshold_; }
    double mean_excess() const { return mean_; }
    double count() const { return count_; }  // of the numbers in the tail

    // Where the tail ends: of these numbers, which may be other than those that the tail is of, at most a
    // share `chance` lie beyond it by chance (Benjamini, Hochberg, J. R. Stat. Soc. B 57 (1995) 289). Where
    // none is anything else, a share `chance` of such samples has one beyond. `others`: that were found to be
    // beyond before.
    double end(std::vector<double> values, double chance, std::size_t others = 0) const;
    // -ln of the probability that a number is as large, by number, in nats: by its rank below the threshold.
    std::vector<double> surprisals_nats(std::span<const double> values) const;

private:
    // That in a share `chance` of such samples the largest exceeds.
    double exceeded_in(double chance) const;

    double threshold_ = 0.0;
    double mean_ = 0.0;   // excess
    double count_ = 0.0;  // in the tail
    double seen_ = 0.0;   // of these, that are not censored
};

}  // namespace gyrolog
