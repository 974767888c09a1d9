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

// The fourth counter word keeps the extra bits of the tails apart from the draws.
enum Purpose : std::uint32_t { draws = 0, tail_bits = 1 };

// Many counters side by side, one array a word: the form that compilers turn into vector instructions.
constexpr std::size_t lanes = 64;
struct Lanes {
    std::array<std::array<std::uint32_t, lanes>, 4> words;
};

void philox_round(Lanes& x, std::uint32_t key_0, std::uint32_t key_1) {
    for (std::size_t i = 0; i < lanes; ++i) {
        const std::uint64_t product_0 = std::uint64_t{multiplier_0} * x.words[0][i];
        const std::uint64_t product_1 = std::uint64_t{multiplier_1} * x.words[2][i];
        x.words[0][i] = static_cast<std::uint32_t>(product_1 >> 32U) ^ x.words[1][i] ^ key_0;
        x.words[1][i] = static_cast<std::uint32_t>(product_1);
        x.words[2][i] = static_cast<std::uint32_t>(product_0 >> 32U) ^ x.words[3][i] ^ key_1;
        x.words[3][i] = static_cast<std::uint32_t>(product_0);
    }
}

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

    double operator()(double d) const {
        // Exponent and leading mantissa bits number the part.
        const auto place = static_cast<std::size_t>(std::bit_cast<std::uint64_t>(d) >> (52U - part_bits));
        const Cubic& c = parts_[place - first_place];
        return c[0] + d * (c[1] + d * (c[2] + d * c[3]));
    }

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

// Below this magnitude a word stands for the outermost 2^-20 of the probability.
constexpr std::uint32_t tail_magnitude = 1U << 11U;
constexpr std::uint32_t magnitude_mask = 0x7FFFFFFFU;

double with_sign(double z, std::uint32_t word) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(z) ^ (std::uint64_t{word >> 31U} << 63U));
}

std::uint32_t low_word(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
std::uint32_t high_word(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32U); }

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
    const QuantileTable& quantile = quantile_table();
    std::size_t done = 0;
    for (; done < out.size() && (first_index + done) % 4 != 0; ++done) {
        out[done] = normal(first_index + done);
    }

    Lanes x;
    while (out.size() - done >= 4 * lanes) {
        const std::uint64_t first_block = (first_index + done) / 4;
        for (std::size_t i = 0; i < lanes; ++i) {
            x.words[0][i] = low_word(first_block + i);
            x.words[1][i] = high_word(first_block + i);
            x.words[2][i] = stream_id_;
            x.words[3][i] = draws;
        }
        PhiloxKey key = key_;
        for (int round = 0; round < rounds; ++round) {
            philox_round(x, key[0], key[1]);
            key[0] += weyl_0;
            key[1] += weyl_1;
        }
        std::uint32_t smallest = magnitude_mask;
        for (std::size_t i = 0; i < lanes; ++i) {
            for (std::size_t k = 0; k < 4; ++k) {
                const std::uint32_t w = x.words[k][i];
                const std::uint32_t magnitude = w & magnitude_mask;
                smallest = std::min(smallest, magnitude);
                out[done + 4 * i + k] = with_sign(quantile(static_cast<std::int32_t>(magnitude) + 0.5), w);
            }
        }
        if (smallest < tail_magnitude) {
            for (std::size_t i = 0; i < 4 * lanes; ++i) {
                const std::uint32_t w = x.words[i % 4][i / 4];
                if ((w & magnitude_mask) < tail_magnitude) {
                    out[done + i] = tail_normal(first_index + done + i, w);
                }
            }
        }
        done += 4 * lanes;
    }
    for (; done < out.size(); ++done) { out[done] = normal(first_index + done); }
}

}  // namespace gyrolog
