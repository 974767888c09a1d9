#include "analysis/numerics/power_comparison.hpp"

#include <bit>
#include <vector>

namespace gyrolog {

namespace {

__extension__ using Product = unsigned __int128;

constexpr unsigned limb_bits = 64;

// Of a number's limbs, the least significant first; the last is not 0.
unsigned bit_width_of(const std::vector<std::uint64_t>& limbs) {
    const auto below = static_cast<unsigned>(limbs.size() - 1) * limb_bits;
    return below + static_cast<unsigned>(std::bit_width(limbs.back()));
}

void multiply(std::vector<std::uint64_t>& limbs, std::uint64_t factor) {
    std::uint64_t carry = 0;
    for (std::uint64_t& limb : limbs) {
        const Product product = static_cast<Product>(limb) * factor + carry;
        limb = static_cast<std::uint64_t>(product);
        carry = static_cast<std::uint64_t>(product >> limb_bits);
    }
    if (carry > 0) { limbs.push_back(carry); }
}

}  // namespace

bool power_reaches(std::uint64_t base, unsigned exponent, unsigned bits) {
    if (base == 0) { return exponent == 0 && bits == 0; }
    std::vector<std::uint64_t> power = {1};
    for (unsigned i = 0; i < exponent && bit_width_of(power) <= bits; ++i) { multiply(power, base); }
    return bit_width_of(power) > bits;
}

}  // namespace gyrolog
