// The same experiment over many seeds, on all cores.
#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

#include "analysis/parallel/parallel_for.hpp"
#include "tests/support/asked.hpp"

namespace gyrolog::test {

// A few, unless GYROLOG_REALISATIONS asks for so many.
inline std::size_t realisations(std::size_t few) {
    return static_cast<std::size_t>(asked("GYROLOG_REALISATIONS", static_cast<double>(few)));
}

// experiment(1), ..., experiment(count), in this order.
template <typename Experiment>
auto over_seeds(std::size_t count, const Experiment& experiment) {
    using Result = decltype(experiment(std::uint64_t{1}));
    static_assert(!std::same_as<Result, bool>, "neighbours of a vector<bool> share their bytes");
    std::vector<Result> results(count);
    parallel_for(count, 0,
                 [&](std::size_t i) { results[i] = experiment(static_cast<std::uint64_t>(i) + 1); });
    return results;
}

}  // namespace gyrolog::test
