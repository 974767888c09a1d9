// What stands in the way of captures and figures on a machine, and the command that mends it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/doctor/machine.hpp"
#include "host/formats/json_fwd.hpp"

namespace gyrolog {

struct Diagnostic {
    bool fine = true;
    std::string what;     // what was found, in a clause
    std::string command;  // that mends it; empty where all is fine
};

struct DoctorOptions {
    // usbfs: each board has 4 MiB under way at most (BulkInPlan::for_stream), and the kernel's own limit
    // is 16.
    std::uint64_t usbfs_mb_least = 16;
    // Of disk: twelve hours at 1 kHz take 0.62 GB with three axes of a gyro, some 1.1 GB with an
    // accelerometer.
    std::uint64_t free_bytes_least = 2'000'000'000;
    // A capture asks for a sync every second (host/DESIGN.md): one that takes longer falls behind.
    double sync_s_most = 1.0;
    // Of the clock: 2026-01-01, before this was written, and 2100-01-01.
    std::int64_t now_s_least = 1'767'225'600;
    std::int64_t now_s_most = 4'102'444'800;
};

struct NamedDiagnostic {
    std::string name;
    Diagnostic found;
};

// Every check, in the order in which a capture would stumble. Reads only, but for a file in the machine's
// folder, which is gone afterwards.
std::vector<NamedDiagnostic> examine(const Machine& machine, const DoctorOptions& options = {});

bool nothing_in_the_way(const std::vector<NamedDiagnostic>& found);

// A line for each: "ok" or "problem", and below a problem its command.
std::string doctor_text(const std::vector<NamedDiagnostic>& found);
// {"schema": "gyrolog-doctor/1", "ok": false, "checks": [{"name", "ok", "what", "command"}]}; no command
// where ok.
Json doctor_json(const std::vector<NamedDiagnostic>& found);

}  // namespace gyrolog
