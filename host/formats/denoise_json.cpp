#include "host/formats/denoise_json.hpp"

#include <cmath>

#include "host/formats/json.hpp"

namespace gyrolog {
namespace {

class Writer {
public:
    explicit Writer(const DenoiseReport& report) : report_(report) {}

    Json axis(const AxisDenoising& axis) const {
        Json json;
        json["units"] = Json::array();
        for (std::size_t i = 0; i < axis.knowledge.units.size(); ++i) {
            json["units"].push_back(unit(axis, i));
        }
        if (!axis.unit_variances.empty()) {
            json["still"] = {{"unit_variance", squared(axis.unit_variance())},
                             {"mean_of_units_variance", squared(axis.mean_variance)}};
        }
        if (axis.unit_motion) { json["first_unit_motion"] = motion(*axis.unit_motion); }
        json["methods"] = Json::object();
        for (const DenoisedSignal& signal : axis.signals) {
            json["methods"][std::string(name_of(signal.design.method))] = method(axis, signal);
        }
        json["white_correlation"] = matrix(axis.knowledge.noise.white_correlation, axis);
        json["walk_correlation"] = matrix(axis.knowledge.noise.walk_correlation, axis);
        json["bands"] = Json::array();
        for (const UnitBand& b : axis.knowledge.bands) { json["bands"].push_back(band(b)); }
        json["failures"] = Json::array();
        for (const UnitFailure& failure : axis.failures) {
            json["failures"].push_back({{"unit", failure.unit},
                                        {"state", name_of(failure.state)},
                                        {"from_s", failure.from_s},
                                        {"to_s", failure.to_s},
                                        {"samples", failure.samples}});
        }
        json["failures_more"] = axis.failures_more;
        json["bandwidth_curve"] = {{"trend", curve(axis.trend_curve)}, {"walk", curve(axis.walk_curve)}};
        return json;
    }

private:
    double shown(double value) const { return value * report_.per_column_unit; }
    double squared(double value) const { return value * report_.per_column_unit * report_.per_column_unit; }

    Json unit(const AxisDenoising& axis, std::size_t i) const {
        const UnitKnowledge& unit = axis.knowledge.units[i];
        const UnitNoise& noise = axis.knowledge.noise.units[i];
        Json json{
            {"name", unit.name},
            {"white_sd", shown(std::sqrt(noise.white_variance))},
            {"walk_sd_per_sqrt_s", shown(std::sqrt(noise.walk_variance * axis.knowledge.noise.rate_hz))},
            {"weight", axis.sample_weights[i]},
            {"drift_weight", axis.drift_weights[i]}};
        if (i < axis.unit_variances.size()) { json["still_variance"] = squared(axis.unit_variances[i]); }
        if (i < axis.unit_allan.size()) { json["allan"] = allan(axis.unit_allan[i]); }
        if (i < axis.unit_spectra.size()) { json["spectrum"] = spectrum(axis.unit_spectra[i]); }
        json["lines"] = Json::array();
        for (const SpectralLine& line : unit.lines) {
            json["lines"].push_back({{"f_hz", line.f_hz}, {"amplitude", shown(line.amplitude)}});
        }
        return json;
    }

    Json method(const AxisDenoising& axis, const DenoisedSignal& signal) const {
        const bool is_wavelet = signal.design.method == DenoiseMethod::wavelet;
        const RateDesign rate = is_wavelet ? RateDesign{} : signal.design.rate;
        Json json{{"rate_model", name_of(rate.model)}};
        if (rate.model != RateModel::free) { json["bandwidth_hz"] = rate.bandwidth_hz; }
        json["gain"] = signal.design.gain == FilterGain::steady ? "steady" : "varying";
        if (signal.design.method != DenoiseMethod::kalman) {
            json["window"] = signal.design.window;
            json["levels"] = signal.design.levels;
        }
        json["response"] = response(signal.response);
        if (rate.model == RateModel::adaptive) { json["calm_response"] = response(signal.calm); }
        if (!axis.unit_variances.empty()) {
            json["still_variance"] = squared(signal.still_variance);
            if (signal.still_variance > 0.0) {
                json["reduction"] = axis.unit_variance() / signal.still_variance;
            }
            json["allan"] = allan(signal.allan);
            json["spectrum"] = spectrum(signal.spectrum);
        }
        if (signal.motion) { json["motion"] = motion(*signal.motion); }
        return json;
    }

    static Json response(const FilterResponse& response) {
        Json json{{"noise_ratio", response.noise_ratio}, {"lag_s", response.lag_s}};
        if (response.half_power_hz > 0.0) { json["half_power_hz"] = response.half_power_hz; }
        return json;
    }

    static Json curve(const std::vector<BandwidthPoint>& points) {
        Json json = Json::array();
        for (const BandwidthPoint& point : points) {
            json.push_back({{"bandwidth_hz", point.bandwidth_hz},
                            {"kalman", response(point.kalman)},
                            {"joint", response(point.joint)}});
        }
        return json;
    }

    Json motion(const MotionError& error) const {
        return {{"error_variance", squared(error.error_variance)},
                {"motion_variance", squared(error.motion_variance)},
                {"noise_variance", squared(error.noise_variance)},
                {"lag_s", error.lag_s},
                {"gain", error.gain},
                {"offset", shown(error.offset)},
                {"samples", error.samples}};
    }

    Json allan(const AllanCurve& curve) const {
        Json json{{"tau_s", Json::array()}, {"deviation", Json::array()}};
        for (const AllanPoint& point : curve.points) {
            json["tau_s"].push_back(point.tau_s);
            json["deviation"].push_back(shown(point.deviation));
        }
        return json;
    }

    Json spectrum(const PowerSpectrum& spectrum) const {
        Json json{{"f_hz", Json::array()}, {"density", Json::array()}};
        for (const SpectrumPoint& point : spectrum.points) {
            json["f_hz"].push_back(point.f_hz);
            json["density"].push_back(squared(point.density));
        }
        return json;
    }

    static Json matrix(const std::vector<double>& entries, const AxisDenoising& axis) {
        const std::size_t units = axis.knowledge.units.size();
        Json json = Json::array();
        for (std::size_t i = 0; i < units; ++i) {
            Json row = Json::array();
            for (std::size_t j = 0; j < units; ++j) {
                const double independent = i == j ? 1.0 : 0.0;
                row.push_back(entries.empty() ? independent : entries[i * units + j]);
            }
            json.push_back(std::move(row));
        }
        return json;
    }

    static Json band(const UnitBand& band) {
        Json json{{"tau_s", band.tau_s},
                  {"from_hz", band.from_hz},
                  {"to_hz", band.to_hz},
                  {"differences", band.differences},
                  {"correlation", band.mean_correlation},
                  {"correlation_sd", band.correlation_sd},
                  {"gain_mean", band.gain_mean}};
        if (band.gain_best > 0.0) { json["gain_best"] = band.gain_best; }
        if (std::isfinite(band.gain_limit())) { json["gain_limit"] = band.gain_limit(); }
        return json;
    }

    const DenoiseReport& report_;
};

}  // namespace

Json denoise_json(const DenoiseReport& report) {
    Json json{{"schema", "gyrolog-denoise/1"},      {"recording", report.name},  {"rate_hz", report.rate_hz},
              {"duration_s", report.duration_s},    {"samples", report.samples}, {"unit", report.unit},
              {"learned_from", report.learned_from}};
    if (!report.axes.empty()) { json["method"] = name_of(report.axes.front().signals.front().design.method); }
    if (report.still.to_s > report.still.from_s) {
        json["still"] = {{"from_s", report.still.from_s}, {"to_s", report.still.to_s}};
    }
    json["warnings"] = report.warnings;
    json["axes"] = Json::object();
    const Writer writer(report);
    for (const AxisDenoising& axis : report.axes) { json["axes"][axis.knowledge.axis] = writer.axis(axis); }
    return json;
}

}  // namespace gyrolog
