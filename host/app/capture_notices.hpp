// What is said once while a capture runs.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "host/app/console.hpp"
#include "host/app/live_view.hpp"
#include "host/app/quantity.hpp"
#include "host/session/capture_session.hpp"

namespace gyrolog {

// Says once how long the program may be held up.
class StallNotice {
public:
    explicit StallNotice(Console& console) : console_(console) {}

    void tell(const CaptureProgress& progress) {
        const double stall_s = progress.tolerated_stall_s;
        if (told_ || stall_s <= 0.0) { return; }
        told_ = true;
        if (!std::isfinite(stall_s)) { return; }
        console_.notices() << fmt::format(
            "  nothing is lost while this computer is busy elsewhere for up to {:.2g} s{}\n", stall_s,
            stall_s < 2.0 ? "; keep it from sleeping and from heavy work" : "");
    }

private:
    Console& console_;
    bool told_ = false;
};

// Says once when samples stay away or are all alike, and once when that is over.
class SilenceNotice {
public:
    explicit SilenceNotice(Console& console, LiveView* view = nullptr) : console_(console), view_(view) {}

    void tell(const CaptureProgress& progress) {
        if (progress.parked) { return; }
        if (progress.silent_s > told_from_s) {
            say(silent_,
                "no sample for 2 s: the board streams, but its sensor is silent (its supply, its "
                "interrupt line); waiting for it");
            samples_ = progress.samples;
        } else if (silent_ && progress.samples > samples_) {
            silent_ = false;
            say_again("samples come again");
        }
        if (progress.frozen_s > 0.0) {
            say(frozen_,
                "one reading comes again and again for 2 s: the sensor hangs (unplug the board to "
                "reset it)");
        } else if (frozen_) {
            frozen_ = false;
            say_again("the readings change again");
        }
    }

private:
    static constexpr double told_from_s = 2.0;

    void say(bool& told, const char* what) {
        if (!told) { say_again(what); }
        told = true;
    }
    void say_again(const char* what) {
        if (view_ != nullptr) { view_->finish(); }
        console_.err << "  " << what << '\n';
    }

    Console& console_;
    LiveView* view_;
    bool silent_ = false;
    std::uint64_t samples_ = 0;  // when it was last silent
    bool frozen_ = false;
};

// Says once when the board is lost and waited for, and once when it is back.
class ParkingNotice {
public:
    explicit ParkingNotice(Console& console, LiveView* view = nullptr) : console_(console), view_(view) {}

    void tell(const CaptureProgress& progress) {
        if (progress.parked && progress.parked_why != why_) {
            if (view_ != nullptr) { view_->finish(); }
            console_.err << fmt::format(
                "  {}{}\n", progress.parked_why,
                why_.empty() ? "; waiting for the board to come back (Ctrl-C ends)" : "");
            why_ = progress.parked_why;
        }
        if (progress.parked) {
            away_s_ = progress.parked_s;
        } else if (!why_.empty()) {
            const std::string after = away_s_ >= 0.1 ? " after " + format_duration(away_s_) : "";
            console_.err << fmt::format("  the board is back{}: going on in {}\n", after, progress.path);
            why_.clear();
        }
    }

private:
    Console& console_;
    LiveView* view_;
    std::string why_;
    double away_s_ = 0.0;
};

}  // namespace gyrolog
