// Work on outside bytes by a library that may crash, take all memory or never end, in a process of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

struct ProcessConfines {
    std::size_t memory_bytes = 0;  // beyond what this process has
    double processor_s = 0.0;
    std::size_t result_bytes = 0;
};

// `work` runs in a copy of this process and writes its result to the descriptor; what it returns is lost, and
// so are its messages on standard error. It ends with this process.
//
// Errors: malformed, where the work crashed, or did not keep to the confines; failed, where no process could
// be started.
Result<Bytes> run_confined(const ProcessConfines& confines, const std::function<void(int descriptor)>& work);

}  // namespace gyrolog
