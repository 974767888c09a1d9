#include "analysis/diagnose/likelihood/recent_responses.hpp"

#include <algorithm>
#include <utility>

namespace gyrolog::resolution {

// 64 MB: some fifteen answers of three axes to an hour at 100 Hz, and none of a day.
constexpr std::size_t remembered_values = std::size_t{1} << 24;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

std::size_t values_of(const RecentResponses::Response& response) {
    return response[0].size() + response[1].size() + response[2].size();
}

}  // namespace

RecentResponses::Response RecentResponses::recall(const std::shared_ptr<const RecordedWorld>& world,
                                                  const SensorModel& model,
                                                  const std::function<Response()>& simulate) {
    if (const auto known = find(world, model)) { return *known; }
    // Two threads may simulate the same: they get the same.
    Response response = simulate();
    if (values_of(response) <= resolution::remembered_values) {
        keep({world, model, std::make_shared<const Response>(response)});
    }
    return response;
}

std::shared_ptr<const RecentResponses::Response> RecentResponses::find(
    const std::shared_ptr<const RecordedWorld>& world, const SensorModel& model) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(
        known_, [&](const Known& known) { return known.world == world && known.model == model; });
    if (found == known_.end()) { return nullptr; }
    known_.splice(known_.begin(), known_, found);
    return found->response;
}

void RecentResponses::keep(Known known) {
    const std::lock_guard lock(mutex_);
    values_ += values_of(*known.response);
    known_.push_front(std::move(known));
    while (values_ > resolution::remembered_values) {
        values_ -= values_of(*known_.back().response);
        known_.pop_back();
    }
}

}  // namespace gyrolog
