#include "host/capture/background_sync.hpp"

#include <cerrno>
#include <utility>

#include <unistd.h>

namespace gyrolog {

int sync_data(int descriptor) {
    while (::fdatasync(descriptor) != 0) {
        if (errno == EINVAL || errno == EROFS) { return 0; }
        if (errno != EINTR) { return errno; }
    }
    return 0;
}

BackgroundSync::~BackgroundSync() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) { thread_.join(); }
}

int BackgroundSync::begin() {
    const std::lock_guard lock(mutex_);
    wanted_ = true;
    if (!thread_.joinable()) {
        thread_ = std::thread([this] { run(); });
    }
    changed_.notify_all();
    return take_failure();
}

int BackgroundSync::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !wanted_ && !busy_; });
    return take_failure();
}

int BackgroundSync::take_failure() { return std::exchange(failure_, 0); }

void BackgroundSync::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return wanted_ || ending_; });
        if (!wanted_) { return; }
        wanted_ = false;
        busy_ = true;
        lock.unlock();
        const int failure = sync_data(descriptor_);
        lock.lock();
        busy_ = false;
        if (failure != 0) { failure_ = failure; }
        changed_.notify_all();
    }
}

}  // namespace gyrolog
