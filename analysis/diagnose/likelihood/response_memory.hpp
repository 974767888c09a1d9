// The response memory keeps responses that were simulated once for a world, for whoever needs them again.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace gyrolog {

class ResponseMemory {
public:
    using Key = std::pair<std::string, std::map<std::string, double>>;
    using Response = std::array<std::vector<float>, 3>;

    // The function returns what is known under `key`, or what `simulate` gives. Any thread may call it.
    Response recall(const Key& key, const std::function<Response()>& simulate);

private:
    std::mutex mutex_;
    std::map<Key, Response> known_;
};

}  // namespace gyrolog
