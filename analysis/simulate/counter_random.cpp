#include "analysis/simulate/counter_random.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

namespace {

constexpr std::uint32_t multiplier_0 = 0xD2511F53U;
constexpr std::uint32_t multiplier_1 = 0xCD9E8D57U;
constexpr std::uint32_t weyl_0 = 0x9E3779B9U;
constexpr std::uint32_t weyl_1 = 0xBB67AE85U;
constexpr int rounds = 10;

// The fourth counter word keeps the extra bits of the tails and derived seeds apart from the draws.
enum CounterUse : std::uint32_t { draws = 0, tail_bits = 1, seeds = 2 };

std::uint32_t low_word(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
std::uint32_t high_word(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32U); }

// Below this magnitude a word stands for the outermost 2^-20 of the probability.
constexpr std::uint32_t tail_magnitude = 1U << 11U;
constexpr std::uint32_t magnitude_mask = 0x7FFFFFFFU;

// Many counters side by side, one array a word: the form that compilers turn into vector instructions.
constexpr std::size_t lanes = 32;
class Lanes {
public:
    void draw(std::uint64_t first_counter, std::uint32_t stream_id, PhiloxKey key) {
        for (std::size_t i = 0; i < lanes; ++i) {
            words_[0][i] = low_word(first_counter + i);
            words_[1][i] = high_word(first_counter + i);
            words_[2][i] = stream_id;
            words_[3][i] = draws;
        }
        for (int i = 0; i < rounds; ++i) {
            round(key);
            key[0] += weyl_0;
            key[1] += weyl_1;
        }
        for (std::size_t i = 0; i < lanes; ++i) {
            for (std::size_t k = 0; k < 4; ++k) { in_order_[4 * i + k] = words_[k][i]; }
        }
        std::uint32_t borrows = 0;
        for (const std::uint32_t w : in_order_) { borrows |= (w & magnitude_mask) - tail_magnitude; }
        has_tail_ = borrows > magnitude_mask;
    }

    // In the order of the counters, four of each.
    std::span<const std::uint32_t> words() const { return in_order_; }
    bool has_tail() const { return has_tail_; }

private:
    void round(const PhiloxKey& key) {
        for (std::size_t i = 0; i < lanes; ++i) {
            const std::uint64_t product_0 = std::uint64_t{multiplier_0} * words_[0][i];
            const std::uint64_t product_1 = std::uint64_t{multiplier_1} * words_[2][i];
            words_[0][i] = high_word(product_1) ^ words_[1][i] ^ key[0];
            words_[1][i] = low_word(product_1);
            words_[2][i] = high_word(product_0) ^ words_[3][i] ^ key[1];
            words_[3][i] = low_word(product_0);
        }
    }

    std::array<std::array<std::uint32_t, lanes>, 4> words_;
    std::array<std::uint32_t, 4 * lanes> in_order_;
    bool has_tail_;
};
// Fewer draws than this cost less one by one.
constexpr std::size_t worth_lanes = 10;

// z(d): the normal deviate whose upper tail probability is d / 2^32, for 2^-33 <= d < 2^31.
class QuantileTable {
public:
    QuantileTable() {
        for (int octave = lowest_octave; octave < lowest_octave + octaves; ++octave) {
            const double start =
                octave >= 0 ? static_cast<double>(std::uint64_t{1} << static_cast<unsigned>(octave))
                            : 1.0 / static_cast<double>(std::uint64_t{1} << static_cast<unsigned>(-octave));
            for (int part = 0; part < parts; ++part) {
                parts_[slot(octave, part)] = fit(start / parts, parts + part);
            }
        }
    }

    // The part that holds d: its exponent and leading mantissa bits.
    static std::size_t part_of(double d) {
        return static_cast<std::size_t>(std::bit_cast<std::uint64_t>(d) >> (52U - part_bits)) - first_place;
    }
    double within(std::size_t part, double d) const {
        const Cubic& c = parts_[part];
        return c[0] + d * (c[1] + d * (c[2] + d * c[3]));
    }
    double operator()(double d) const { return within(part_of(d), d); }

private:
    using Cubic = std::array<double, 4>;

    static constexpr unsigned part_bits = 4;
    static constexpr int parts = 1 << part_bits;
    static constexpr int lowest_octave = -33;
    static constexpr int octaves = 64;
    static constexpr std::size_t first_place = static_cast<std::size_t>(std::int64_t{1023} + lowest_octave)
                                               << part_bits;

    static std::size_t slot(int octave, int part) {
        return static_cast<std::size_t>(octave - lowest_octave) * parts + static_cast<std::size_t>(part);
    }

    // Cubic through the four Chebyshev points of [n, n + 1] * width, as a polynomial in d.
    static Cubic fit(double width, int n) {
        constexpr std::array<double, 4> points = {0.03806023374435663, 0.30865828381745511,
                                                  0.69134171618254489, 0.96193976625564337};
        Cubic newton{};
        for (std::size_t i = 0; i < 4; ++i) {
            newton[i] = upper_normal_quantile((n + points[i]) * width * 0x1p-32);
        }
        for (std::size_t order = 1; order < 4; ++order) {
            for (std::size_t i = 3; i >= order; --i) {
                newton[i] = (newton[i] - newton[i - 1]) / (points[i] - points[i - order]);
            }
        }
        Cubic c{};
        for (std::size_t i = 4; i-- > 0;) {  // c := c * (d / width - n - points[i]) + newton[i]
            const double root = n + points[i];
            for (std::size_t k = 3; k > 0; --k) { c[k] = c[k - 1] - c[k] * root; }
            c[0] = newton[i] - c[0] * root;
        }
        double scale = 1.0;
        for (double& coefficient : c) {
            coefficient *= scale;
            scale /= width;
        }
        return c;
    }

    std::array<Cubic, static_cast<std::size_t>(octaves) * parts> parts_{};
};

const QuantileTable& quantile_table() {
    static const QuantileTable table;
    return table;
}

double with_sign(double z, std::uint32_t word) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(z) ^ (std::uint64_t{word >> 31U} << 63U));
}

// Words to draws, those of the tails excepted. Pass by pass, because all but the look-up becomes vector
// instructions that way.
void transform(std::span<const std::uint32_t> words, std::span<double> out) {
    const QuantileTable& quantile = quantile_table();
    std::array<double, 4 * lanes> d;          // NOLINT(cppcoreguidelines-pro-type-member-init)
    std::array<std::size_t, 4 * lanes> part;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    const std::size_t n = out.size();
    for (std::size_t i = 0; i < n; ++i) { d[i] = static_cast<std::int32_t>(words[i] & magnitude_mask) + 0.5; }
    for (std::size_t i = 0; i < n; ++i) { part[i] = QuantileTable::part_of(d[i]); }
    for (std::size_t i = 0; i < n; ++i) { out[i] = quantile.within(part[i], d[i]); }
    for (std::size_t i = 0; i < n; ++i) { out[i] = with_sign(out[i], words[i]); }
}

}  // namespace

PhiloxCounter philox4x32_10(PhiloxCounter counter, PhiloxKey key) {
    for (int round = 0; round < rounds; ++round) {
        const std::uint64_t product_0 = std::uint64_t{multiplier_0} * counter[0];
        const std::uint64_t product_1 = std::uint64_t{multiplier_1} * counter[2];
        counter = {high_word(product_1) ^ counter[1] ^ key[0], low_word(product_1),
                   high_word(product_0) ^ counter[3] ^ key[1], low_word(product_0)};
        key[0] += weyl_0;
        key[1] += weyl_1;
    }
    return counter;
}

std::uint64_t hashed_seed(std::uint64_t seed, std::uint32_t purpose, std::uint64_t number) {
    const PhiloxCounter words = philox4x32_10({low_word(number), high_word(number), purpose, seeds},
                                              {low_word(seed), high_word(seed)});
    return std::uint64_t{words[1]} << 32U | words[0];
}

RandomStream::RandomStream(std::uint64_t seed, std::uint32_t stream_id)
    : key_{low_word(seed), high_word(seed)}, stream_id_(stream_id) {}

std::uint32_t RandomStream::word(std::uint64_t index) const {
    const std::uint64_t block = index / 4;
    return philox4x32_10({low_word(block), high_word(block), stream_id_, draws}, key_)[index % 4];
}

double RandomStream::uniform(std::uint64_t index) const { return (word(index) + 0.5) * 0x1p-32; }

double RandomStream::tail_normal(std::uint64_t index, std::uint32_t word) const {
    const PhiloxCounter more =
        philox4x32_10({low_word(index), high_word(index), stream_id_, tail_bits}, key_);
    return with_sign(quantile_table()((word & magnitude_mask) + (more[0] + 0.5) * 0x1p-32), word);
}

double RandomStream::normal(std::uint64_t index) const {
    const std::uint32_t w = word(index);
    const std::uint32_t magnitude = w & magnitude_mask;
    return magnitude < tail_magnitude ? tail_normal(index, w)
                                      : with_sign(quantile_table()(magnitude + 0.5), w);
}

void RandomStream::normals(std::uint64_t first_index, std::span<double> out) const {
    Lanes x;
    while (out.size() >= worth_lanes) {
        const auto skipped = static_cast<std::size_t>(first_index % 4);
        const std::span<double> now = out.first(std::min(out.size(), 4 * lanes - skipped));
        x.draw(first_index / 4, stream_id_, key_);
        const std::span words = x.words().subspan(skipped);
        transform(words, now);
        if (x.has_tail()) {
            for (std::size_t i = 0; i < now.size(); ++i) {
                const std::uint32_t w = words[i];
                if ((w & magnitude_mask) < tail_magnitude) { now[i] = tail_normal(first_index + i, w); }
            }
        }
        first_index += now.size();
        out = out.subspan(now.size());
    }
    for (double& draw : out) { draw = normal(first_index++); }
}

}  // namespace gyrolog
