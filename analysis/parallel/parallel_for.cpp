#include "analysis/parallel/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace gyrolog {
namespace {

template <typename Work>
std::vector<std::jthread> started(std::size_t wanted, const Work& work) {
    std::vector<std::jthread> threads;
    try {
        while (threads.size() < wanted) { threads.emplace_back(work); }
    } catch (const std::system_error&) { return threads; }
    return threads;
}

}  // namespace

void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task) {
    if (count == 0) { return; }
    const std::size_t all = threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
    std::atomic<std::size_t> next = 0;
    std::atomic_flag failed;
    std::exception_ptr failure;
    const auto work = [&]() noexcept {
        try {
            for (std::size_t i = next++; i < count; i = next++) { task(i); }
        } catch (...) {
            if (!failed.test_and_set()) { failure = std::current_exception(); }
            next = count;
        }
    };
    {
        const auto others = started(std::min(all, count) - 1, work);
        work();
    }
    if (failure) { std::rethrow_exception(failure); }
}

}  // namespace gyrolog
