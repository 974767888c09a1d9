// What is asked of a running capture, from any thread.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "host/base/clock.hpp"
#include "host/capture/capture_metadata.hpp"

namespace gyrolog {

class CaptureControl {
public:
    // In the file within 100 ms, with the time that is given here.
    void mark(std::string text, HostTime made = host_now()) {
        const std::lock_guard lock(mutex_);
        marks_.push_back({made, std::move(text), 0});
    }
    // Stops the board's stream, or starts it again: another run in the same file.
    void set_streaming(bool wanted) {
        const std::lock_guard lock(mutex_);
        streaming_wanted_ = wanted;
    }

    // The session's side.
    std::vector<CaptureMark> take_marks() {
        const std::lock_guard lock(mutex_);
        return std::exchange(marks_, {});
    }
    bool streaming_wanted() const {
        const std::lock_guard lock(mutex_);
        return streaming_wanted_;
    }

private:
    mutable std::mutex mutex_;
    std::vector<CaptureMark> marks_;
    bool streaming_wanted_ = true;
};

}  // namespace gyrolog
