// The same experiment over many seeds, on all cores.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace gyrolog::test {

// experiment(1), ..., experiment(count), in this order.
template <typename Experiment>
auto over_seeds(std::size_t count, const Experiment& experiment) {
    std::vector<decltype(experiment(std::uint64_t{1}))> results(count);
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            results[i] = experiment(static_cast<std::uint64_t>(i) + 1);
        }
    };
    {
        std::vector<std::jthread> others;
        for (unsigned t = 1; t < std::thread::hardware_concurrency(); ++t) { others.emplace_back(work); }
        work();
    }
    return results;
}

}  // namespace gyrolog::test
