#include "analysis/simulate/random_purpose.hpp"

namespace gyrolog {

std::uint64_t derived_seed(std::uint64_t seed, RandomPurpose purpose, std::uint64_t number) {
    return hashed_seed(seed, static_cast<std::uint32_t>(purpose), number);
}

RandomStream derived_stream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t number) {
    return {derived_seed(seed, purpose, number), 0};
}

}  // namespace gyrolog
