// fdatasync in a thread of its own: a disk that takes seconds for it must not keep the writer from writing,
// or a killed process would lose all that came meanwhile.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace gyrolog {

class BackgroundSync {
public:
    // The file must stay open as long as this lives.
    explicit BackgroundSync(int descriptor) : descriptor_(descriptor) {}
    BackgroundSync(const BackgroundSync&) = delete;
    BackgroundSync& operator=(const BackgroundSync&) = delete;
    ~BackgroundSync();

    // Begins to sync what was written so far, after a sync that is still on its way. Returns the errno of one
    // that has failed since the last call, or 0.
    int begin();
    // Waits until nothing is on its way. Returns the same.
    int wait();

private:
    void run();
    int take_failure();

    const int descriptor_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool wanted_ = false;
    bool busy_ = false;
    bool ending_ = false;
    int failure_ = 0;
    std::thread thread_;  // from the first begin() on
};

// 0, or the errno of the failure; a file that has nothing to sync (a pipe, a device) is none.
int sync_data(int descriptor);

}  // namespace gyrolog
