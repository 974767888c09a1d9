// A sink that keeps everything a source tells, and judges the order in which it is told.
#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "host/transport/byte_source.hpp"

namespace gyrolog::test {

class CollectingSink : public TransferSink {
public:
    struct Told {
        Transfer transfer;
        Bytes data;
    };

    bool on_transfer(const Transfer& transfer) override {
        const std::lock_guard lock(mutex_);
        EXPECT_FALSE(end_.has_value()) << "told after the end";
        if (transfer.event == Transfer::Event::submission) {
            EXPECT_TRUE(pending_.emplace(transfer.id, transfer.endpoint).second) << "an id in use";
        } else {
            EXPECT_EQ(pending_.erase(transfer.id), 1U) << "a completion without a submission";
        }
        told_.push_back({transfer, Bytes(transfer.data.begin(), transfer.data.end())});
        if (transfer.carries_stream()) {
            stream_.insert(stream_.end(), transfer.data.begin(), transfer.data.end());
        }
        changed_.notify_all();
        return true;
    }

    void on_end(SourceEnd end, const std::optional<Error>& error) override {
        const std::lock_guard lock(mutex_);
        EXPECT_FALSE(end_.has_value()) << "ended twice";
        EXPECT_TRUE(pending_.empty()) << "a submission without a completion";
        end_ = end;
        error_ = error;
        changed_.notify_all();
    }

    // True as soon as so many bytes of the stream have come.
    bool wait_for_bytes(std::size_t count) const {
        return wait([&] { return stream_.size() >= count; });
    }
    std::optional<SourceEnd> wait_for_end() const {
        wait([&] { return end_.has_value(); });
        return end();
    }

    std::vector<Told> told() const {
        const std::lock_guard lock(mutex_);
        return told_;
    }
    Bytes stream() const {
        const std::lock_guard lock(mutex_);
        return stream_;
    }
    std::optional<SourceEnd> end() const {
        const std::lock_guard lock(mutex_);
        return end_;
    }
    std::string error_message() const {
        const std::lock_guard lock(mutex_);
        return error_ ? error_->message : std::string();
    }

private:
    template <typename Condition>
    bool wait(Condition condition) const {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, std::chrono::seconds(10), condition);
    }

    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::map<std::uint64_t, std::uint8_t> pending_;
    std::vector<Told> told_;
    Bytes stream_;
    std::optional<SourceEnd> end_;
    std::optional<Error> error_;
};

}  // namespace gyrolog::test
