// Lets other threads have work done by the one thread that owns some state, so that this state needs no lock.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace gyrolog {

class CallQueue {
public:
    // `wake` makes the owner leave its wait and come to run_pending(); it is called from any thread.
    explicit CallQueue(std::function<void()> wake) : wake_(std::move(wake)) {}

    // Runs `work` on the owner's thread and returns true when it has run; at once when called from that
    // thread. After close() it returns false and `work` does not run.
    bool call(const std::function<void()>& work) {
        std::unique_lock lock(mutex_);
        if (std::this_thread::get_id() == owner_) {
            lock.unlock();
            work();
            return true;
        }
        if (closed_) { return false; }
        Pending pending{&work};
        pending_.push_back(&pending);
        wake_();
        changed_.wait(lock, [&] { return pending.state != State::waiting; });
        return pending.state == State::ran;
    }

    // Takes calls again after close(). They wait until a thread adopts the queue.
    void reopen() {
        const std::lock_guard lock(mutex_);
        closed_ = false;
    }

    // The calling thread becomes the owner. This and the two below are the owner's.
    void adopt() {
        const std::lock_guard lock(mutex_);
        owner_ = std::this_thread::get_id();
    }

    void run_pending() {
        std::unique_lock lock(mutex_);
        while (!pending_.empty()) {
            Pending& next = *pending_.front();
            pending_.pop_front();
            lock.unlock();
            (*next.work)();
            lock.lock();
            next.state = State::ran;
            changed_.notify_all();
        }
    }

    void close() {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        owner_ = {};  // a later thread may get the same id
        for (Pending* pending : pending_) { pending->state = State::refused; }
        pending_.clear();
        changed_.notify_all();
    }

private:
    enum class State { waiting, ran, refused };
    struct Pending {
        const std::function<void()>* work;
        State state = State::waiting;
    };

    std::function<void()> wake_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Pending*> pending_;
    std::thread::id owner_;
    bool closed_ = false;
};

}  // namespace gyrolog
