#include "analysis/diagnose/likelihood/response_memory.hpp"

namespace gyrolog {

ResponseMemory::Response ResponseMemory::recall(const Key& key, const std::function<Response()>& simulate) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = known_.find(key);
        if (found != known_.end()) { return found->second; }
    }
    // Two threads may simulate the same: they get the same.
    Response response = simulate();
    const std::lock_guard lock(mutex_);
    return known_.emplace(key, std::move(response)).first->second;
}

}  // namespace gyrolog
