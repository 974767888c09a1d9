// Diagnoses as there may be, for tests of what is written of them.
#pragma once

#include <string>

#include "analysis/diagnose/report.hpp"

namespace gyrolog::test {

inline Finding late_temperature() {
    Finding finding;
    finding.effect = "temp_lag";
    finding.entries = {{"temp_lag", {"x"}, {{"c1_dps_per_C", 0.021}, {"tau_s", 410.0}}, ""}};
    finding.sd = {{{"c1_dps_per_C", 0.002}, {"tau_s", 60.0}}};
    finding.gain_nats = 151.0;
    finding.evidence_nats = 140.0;
    finding.axis_gain_nats = {151.0, 0.0, 0.0};
    finding.where.axes = {0};
    finding.where.temperature = true;
    finding.where.tau_s = Span{60.0, 900.0};
    return finding;
}

inline GapDomain allan_domain() {
    GapDomain domain;
    domain.name = "Allan deviation";
    domain.x = {1.0, 10.0, 100.0};
    domain.recording = {1.0, 2.0, 3.0};
    domain.before_lo = {0.9, 0.9, 0.9};
    domain.before_hi = {1.1, 1.1, 1.1};
    domain.after_lo = {0.9, 1.9, 2.9};
    domain.after_hi = {1.1, 2.1, 3.1};
    domain.outside_before = {false, true, true};
    domain.outside_after = {false, false, false};
    domain.gap_before = 5.2;
    domain.gap_after = 1.02;
    return domain;
}

inline Diagnosis known() {
    Diagnosis diagnosis;
    diagnosis.recording_name = "night.csv";
    diagnosis.model_name = "model.json";
    diagnosis.duration_s = 7200.0;
    diagnosis.rate_hz = 100.0;
    diagnosis.samples = 720'000;
    diagnosis.simulations = 200;
    diagnosis.seed = 7;
    diagnosis.axes = {0, 1, 2};
    diagnosis.verdict = Verdict::known;
    diagnosis.p_none = 0.0002;
    diagnosis.p_left = 0.4;
    Cause cause;
    cause.finding = late_temperature();
    cause.score = 0.91;
    cause.tie_group = {{"temp_lag", 0.0}, {"temp_linear", 2.1}};
    cause.share = {0.97, 0.9, 1.0};
    cause.decided_by = "one up-and-down sweep of 5 degC";
    diagnosis.causes = {cause};
    diagnosis.where.axes = {0};
    diagnosis.where.tau_s = Span{60.0, 900.0};
    diagnosis.gap_before = {4.1, 1.0, 3.6, 4.7};
    diagnosis.gap_named = diagnosis.gap_after = {1.1, 1.0, 0.9, 1.4};
    diagnosis.shrink = {0.97, 0.93, 1.0};
    diagnosis.shrink_modelled = 0.97;
    diagnosis.domains = {allan_domain()};
    diagnosis.untestable = {{"scale_factor", "the recording has no reference rate"},
                            {"rtn", "it is too short"},
                            {"latency", "the recording has no reference rate"}};
    diagnosis.next_recordings = {"One sweep of the temperature."};
    diagnosis.warnings = {"a warning"};
    return diagnosis;
}

// The contract's example.
inline Diagnosis partly() {
    Diagnosis diagnosis = known();
    diagnosis.verdict = Verdict::partly;
    diagnosis.p_left = 1e-9;
    diagnosis.causes[0].share = {0.62, 0.55, 0.68};
    diagnosis.unnamed = {{"density", {}, 0.21}};
    diagnosis.unnamed[0].where.axes = {2};
    diagnosis.unnamed[0].where.freq_hz = Span{31.0, 31.8};
    diagnosis.left = {{{}, 2.1}};
    diagnosis.left[0].where.axes = {2};
    diagnosis.left[0].where.time_s = Span{402.0, 409.0};
    diagnosis.gap_before = {7.9, 1.0, 7.1, 8.8};
    diagnosis.gap_named = {3.4, 1.0, 3.0, 3.9};
    diagnosis.gap_after = {1.1, 1.0, 0.9, 1.4};
    diagnosis.shrink = {0.83, 0.79, 0.86};
    diagnosis.shrink_modelled = 0.97;
    return diagnosis;
}

// A line of the model at 31 Hz that the recording has not.
inline Diagnosis with_line_of_model() {
    Diagnosis diagnosis = partly();
    Cause cause;
    cause.sense = Sense::model_has;
    cause.score = 0.98;
    cause.share = {0.2, 0.1, 0.3};
    cause.finding.effect = "line_absent";
    cause.finding.entries = {{"tone", {"z"}, {{"f_hz", 31.0}, {"amplitude_dps", 0.05}}, ""}};
    cause.finding.sd = {{}};
    cause.finding.where.axes = {2};
    cause.finding.where.freq_hz = Span{30.9, 31.1};
    diagnosis.causes.push_back(cause);
    return diagnosis;
}

inline Diagnosis none() {
    Diagnosis diagnosis = known();
    diagnosis.verdict = Verdict::none;
    diagnosis.p_none = 0.43;
    diagnosis.causes.clear();
    diagnosis.where = {};
    diagnosis.gap_before = diagnosis.gap_named = diagnosis.gap_after = {1.02, 1.0, 0.8, 1.2};
    diagnosis.shrink = {};
    diagnosis.shrink_modelled = 0.0;
    for (GapDomain& domain : diagnosis.domains) {
        domain.after_lo.clear();
        domain.after_hi.clear();
        domain.outside_after.clear();
    }
    return diagnosis;
}

// A text on one line.
inline std::string joined(const std::string& text) {
    std::string line;
    for (const char c : text) {
        if (c != '\n' && c != ' ') {
            line += c;
        } else if (!line.ends_with(' ')) {
            line += ' ';
        }
    }
    return line;
}

// Two axes, of which the second has more of the effect.
inline Finding different_axes() {
    Finding finding = late_temperature();
    finding.entries.push_back({"temp_lag", {"z"}, {{"c1_dps_per_C", 0.05}, {"tau_s", 410.0}}, ""});
    finding.sd.push_back({{"c1_dps_per_C", 0.001}, {"tau_s", 60.0}});
    finding.axis_gain_nats = {20.0, 0.0, 130.0};
    finding.where.axes = {0, 2};
    return finding;
}

}  // namespace gyrolog::test
