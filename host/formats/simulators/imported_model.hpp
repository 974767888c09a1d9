// A model as a simulator's file is read into it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "analysis/noise/noise_model.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {

// Nothing stated: no noise, and rate, steps and range a recording's to tell.
ModelFile nothing_stated();

void state_range(ModelFile& file, double full_scale_rad_s);
void state_step(ModelFile& file, double lsb_rad_s);

// A bias that decays and is driven by noise of a density, as simulators state it: sigma^2 = density^2 T / 2.
GaussMarkov driven_gauss_markov(double drive_rad_per_s_sqrt_s, double correlation_s);

// As effects, one for all axes that have the same; none where sigma is 0.
void add_gauss_markov(SensorModel& model, const std::array<GaussMarkov, 3>& of_axes);

// The whole text, but for blanks around it; nothing where it is no number, or not a finite one.
std::optional<double> finite_number(std::string_view text);

// Numbers that a file states as text. The first that is wrong is kept, with where it stands; later ones are
// then of no use.
class StatedNumbersAsText {
public:
    enum class Range { any, not_negative, positive };

    double number(std::string_view text, const std::string& where, Range range);
    void fail(const std::string& where, const std::string& what);
    const std::optional<std::string>& problem() const { return problem_; }

private:
    std::optional<std::string> problem_;
};

}  // namespace gyrolog
