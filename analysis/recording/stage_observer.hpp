// A long piece of work tells which part of it begins, for whoever wants to know where the time goes.
#pragma once

#include <functional>
#include <utility>

namespace gyrolog {

// Does nothing unless made from a function.
class StageObserver {
public:
    StageObserver() = default;
    explicit StageObserver(std::function<void(const char* stage)> enter) : enter_(std::move(enter)) {}

    void operator()(const char* stage) const {
        if (enter_) { enter_(stage); }
    }
    bool wanted() const { return static_cast<bool>(enter_); }

private:
    std::function<void(const char*)> enter_;
};

}  // namespace gyrolog
