#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"
#include "host/formats/simulators/three_numbers.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view isaaclab_facts[] = {
    "std is per observation, so that the observation rate above belongs to it; nothing in it remembers the "
    "last "
    "step (IsaacLab, source/isaaclab/isaaclab/utils/noise/noise_model.py, gaussian_noise, 046b71b86f49).",
    "The bias is in mean. NoiseModelWithAdditiveBias has one bias for all axes there, and with operation "
    "\"add\" draws each reset's bias on top of the last one: it walks from reset to reset (the same file, "
    "reset).",
};

std::string isaaclab_text(const SimulatorSource& source, std::span<const std::string> head) {
    Vector3 sd_rad_s{};
    for (std::size_t axis = 0; axis < 3; ++axis) { sd_rad_s[axis] = source.sample_sd_rad_s(axis); }
    return commented_for_python(head) +
           fmt::format(
               "import torch\nfrom isaaclab.utils.noise import GaussianNoiseCfg\n\n"
               "# noise of an ObservationTermCfg of the angular velocity, rad/s\n"
               "gyro_noise = GaussianNoiseCfg(\n    mean=torch.tensor([{}]),\n    std=torch.tensor([{}]),\n"
               "    operation=\"add\",\n)\n",
               three_numbers(source.bias_rad_s), three_numbers(sd_rad_s));
}

}  // namespace

constinit const SimulatorFormat isaaclab_format = {
    .name = "isaaclab",
    .summary = "Isaac Lab: the noise of an observation term, in Python",
    .abilities = {.noise = ProjectedTerms::white},
    .facts = isaaclab_facts,
    .text = isaaclab_text,
};

}  // namespace gyrolog
