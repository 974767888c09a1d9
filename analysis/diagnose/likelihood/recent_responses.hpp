// Recent responses are the noise-free answers of models to a world that were simulated last. Of the models
// that a diagnosis tries, most differ in their noise only: their answers are the same.
#pragma once

#include <array>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "analysis/simulate/recorded_world.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

class RecentResponses {
public:
    using Response = std::array<std::vector<float>, 3>;

    // The function returns what is known of `model` in `world`, or what `simulate` gives. `model`: whatever
    // does not change the answer is as it is in a default model. Any thread may call the function.
    Response recall(const std::shared_ptr<const RecordedWorld>& world, const SensorModel& model,
                    const std::function<Response()>& simulate);

private:
    struct Known {
        std::shared_ptr<const RecordedWorld> world;
        SensorModel model;
        std::shared_ptr<const Response> response;
    };

    std::shared_ptr<const Response> find(const std::shared_ptr<const RecordedWorld>& world,
                                         const SensorModel& model);
    void keep(Known known);

    std::mutex mutex_;
    std::list<Known> known_;  // the latest first
    std::size_t values_ = 0;  // of all responses
};

}  // namespace gyrolog
