#include "host/virtual_board/sim_options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "firmware_protocol/device/board.h"
#include "host/virtual_board/breached_source.hpp"

namespace gyrolog {

namespace {

constexpr unsigned boards_max = 120;
constexpr double fault_latest_s = 1e9;
constexpr std::size_t ring_bytes_max = std::size_t{1} << 24U;

struct FaultName {
    std::string_view name;
    BoardFault::Kind kind;
};

constexpr std::array<FaultName, 11> fault_names = {{
    {"fifo_overflow", BoardFault::Kind::fifo_overflow},
    {"bus_error", BoardFault::Kind::bus_error},
    {"link_stall", BoardFault::Kind::link_stall},
    {"drop_packet", BoardFault::Kind::drop_packet},
    {"duplicate_packet", BoardFault::Kind::duplicate_packet},
    {"corrupt_byte", BoardFault::Kind::corrupt_byte},
    {"reset", BoardFault::Kind::reset},
    {"unplug", BoardFault::Kind::unplug},
    {"int_lost", BoardFault::Kind::int_lost},
    {"sensor_reset", BoardFault::Kind::sensor_reset},
    {"sensor_frozen", BoardFault::Kind::sensor_frozen},
}};

struct SensorName {
    std::string_view name;
    std::uint8_t who_am_i;
};

constexpr std::array sensor_names = {SensorName{"mpu9250", GLP_MPU_9250_ID},
                                     SensorName{"mpu9255", GLP_MPU_9255_ID},
                                     SensorName{"mpu9250_75", GLP_MPU_9250_75_ID}};

// Of these a fault may be given with its end.
constexpr std::array lasting_faults = {BoardFault::Kind::link_stall, BoardFault::Kind::unplug,
                                       BoardFault::Kind::int_lost, BoardFault::Kind::sensor_frozen};

Error refused(std::string_view key, std::string_view value, const std::string& wanted) {
    std::string message = "simulated board: option ";
    message.append(key).append("=").append(value).append(": ").append(wanted);
    return {ErrorCode::invalid_argument, std::move(message)};
}

// The whole text as a number within [lowest, highest].
template <typename Number>
std::optional<Number> number(std::string_view text, Number lowest, Number highest) {
    Number value{};
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || end != text.data() + text.size()) { return std::nullopt; }
    if (!(value >= lowest && value <= highest)) { return std::nullopt; }  // refuses NaN too
    return value;
}

std::optional<BoardFault> parse_fault(std::string_view text) {
    const std::size_t at = text.find('@');
    if (at == std::string_view::npos) { return std::nullopt; }
    for (const FaultName& known : fault_names) {
        if (known.name != text.substr(0, at)) { continue; }
        BoardFault fault{.kind = known.kind};
        std::string_view from = text.substr(at + 1);
        const std::size_t dots = from.find("..");
        const bool may_last = std::ranges::find(lasting_faults, known.kind) != lasting_faults.end();
        if (known.kind == BoardFault::Kind::link_stall && dots == std::string_view::npos) {
            return std::nullopt;
        }
        if (may_last && dots != std::string_view::npos) {
            const auto to_s = number(from.substr(dots + 2), 0.0, fault_latest_s);
            from = from.substr(0, dots);
            const auto from_s = number(from, 0.0, fault_latest_s);
            if (!to_s || !from_s || *to_s < *from_s) { return std::nullopt; }
            fault.duration_s = *to_s - *from_s;
        }
        const auto at_s = number(from, 0.0, fault_latest_s);
        if (!at_s) { return std::nullopt; }
        fault.at_s = *at_s;
        return fault;
    }
    return std::nullopt;
}

Status parse_faults(std::string_view text, std::vector<BoardFault>& faults) {
    std::string_view rest = text;
    while (true) {
        const std::size_t plus = rest.find('+');
        const auto fault = parse_fault(rest.substr(0, plus));
        if (!fault) {
            std::string kinds;
            for (const FaultName& known : fault_names) { kinds.append(" ").append(known.name); }
            return refused("fault", text,
                           "wants KIND@SECONDS, several joined by '+'; KIND@FROM..TO for link_stall, unplug, "
                           "int_lost and sensor_frozen; kinds are" +
                               kinds);
        }
        faults.push_back(*fault);
        if (plus == std::string_view::npos) { return {}; }
        rest.remove_prefix(plus + 1);
    }
}

template <typename Field, typename Number>
Status set_number(Field& field, std::string_view key, std::string_view value, Number lowest, Number highest,
                  const std::string& wanted) {
    const auto parsed = number(value, lowest, highest);
    if (!parsed) { return refused(key, value, wanted); }
    field = *parsed;
    return {};
}

Status set_fault(SimOptions& to, BoardFault::Kind kind, std::string_view key, std::string_view value) {
    BoardFault fault{.kind = kind};
    GYROLOG_CHECK(set_number(fault.at_s, key, value, 0.0, fault_latest_s, "wants seconds since the start"));
    to.faults.push_back(fault);
    return {};
}

Status set_breach(SimOptions& to, std::string_view key, std::string_view value) {
    if (breach_named(value) == nullptr) {
        std::string names;
        for (const Breach& breach : breaches()) { names.append(" ").append(breach.name); }
        return refused(key, value, "there is no such breach; there are" + names);
    }
    to.breach = value;
    return {};
}

Status set_sensor(SimOptions& to, std::string_view key, std::string_view value) {
    for (const SensorName& known : sensor_names) {
        if (known.name != value) { continue; }
        to.who_am_i = known.who_am_i;
        return {};
    }
    return refused(key, value, "wants mpu9250, mpu9255 or mpu9250_75");
}

Status set_option(SimOptions& to, std::string_view key, std::string_view value) {
    constexpr std::uint32_t any_32 = std::numeric_limits<std::uint32_t>::max();
    constexpr std::uint64_t any_64 = std::numeric_limits<std::uint64_t>::max();
    if (key == "model") {
        if (value.empty()) { return refused(key, value, "wants a file"); }
        to.model_path = value;
        return {};
    }
    if (key == "rate") {
        return set_number(to.rate_hz, key, value, 0.001, 32000.0, "wants a rate in Hz up to 32000");
    }
    if (key == "full_scale") {
        return set_number(to.full_scale_dps, key, value, 250U, 2000U,
                          "wants 250, 500, 1000 or 2000 (degrees/s)");
    }
    if (key == "dlpf") {
        if (value == "off") {
            to.dlpf_hz = GLP_DLPF_OFF;
            return {};
        }
        return set_number(to.dlpf_hz, key, value, 5U, 3600U, "wants 5 10 20 41 92 184 250 3600 (Hz) or off");
    }
    if (key == "seed") {
        return set_number(to.seed, key, value, std::uint64_t{0}, any_64, "wants a whole number");
    }
    if (key == "boards") {
        return set_number(to.boards, key, value, 1U, boards_max, "wants 1 to " + std::to_string(boards_max));
    }
    if (key == "board") {
        return set_number(to.board, key, value, 1U, boards_max, "wants 1 to " + std::to_string(boards_max));
    }
    if (key == "realtime") {
        if (value != "0" && value != "1") { return refused(key, value, "wants 0 or 1"); }
        to.realtime = value == "1";
        return {};
    }
    if (key == "clock_ppm") {
        double ppm = 0.0;
        GYROLOG_CHECK(set_number(ppm, key, value, -10000.0, 10000.0, "wants -10000 to 10000"));
        to.clock_error = ppm * 1e-6;
        return {};
    }
    if (key == "first_tick") {
        return set_number(to.first_tick, key, value, std::uint64_t{0}, any_64, "wants a whole number");
    }
    if (key == "first_sequence") {
        return set_number(to.first_sequence, key, value, 0U, any_32, "wants a whole number below 2^32");
    }
    if (key == "boot_id") {
        return set_number(to.boot_id, key, value, 0U, any_32, "wants a whole number below 2^32");
    }
    if (key == "ring") {
        return set_number(to.ring_bytes, key, value, std::size_t{GLP_BOARD_RING_MIN}, ring_bytes_max,
                          "wants at least " + std::to_string(GLP_BOARD_RING_MIN) + " bytes");
    }
    if (key == "fault") { return parse_faults(value, to.faults); }
    if (key == "breach") { return set_breach(to, key, value); }
    if (key == "unplug") { return set_fault(to, BoardFault::Kind::unplug, key, value); }
    if (key == "reset") { return set_fault(to, BoardFault::Kind::reset, key, value); }
    if (key == "replug") {
        return set_number(to.replug_s, key, value, 0.0, fault_latest_s, "wants seconds since the start");
    }
    if (key == "self_powered") {
        if (value != "0" && value != "1") { return refused(key, value, "wants 0 or 1"); }
        to.self_powered = value == "1";
        return {};
    }
    if (key == "endpoints") {
        if (value != "free" && value != "fixed_kind") {
            return refused(key, value, "wants free or fixed_kind");
        }
        to.endpoints = value == "free" ? UsbEndpoints{} : fixed_kind_endpoints;
        return {};
    }
    if (key == "sensor") { return set_sensor(to, key, value); }
    return refused(
        key, value,
        "there is no such option; there are model rate full_scale dlpf seed boards board realtime clock_ppm "
        "first_tick first_sequence boot_id ring fault unplug replug reset self_powered breach endpoints "
        "sensor");
}

// Of the last cable that is pulled for good.
Status set_replug(SimOptions& to) {
    if (!to.replug_s) { return {}; }
    const auto pulled = std::find_if(to.faults.rbegin(), to.faults.rend(), [](const BoardFault& fault) {
        return fault.kind == BoardFault::Kind::unplug && fault.duration_s == 0.0;
    });
    if (pulled == to.faults.rend() || *to.replug_s <= pulled->at_s) {
        return Error{ErrorCode::invalid_argument,
                     "simulated board: option replug: wants an unplug= before it"};
    }
    pulled->duration_s = *to.replug_s - pulled->at_s;
    return {};
}

}  // namespace

Result<SimOptions> parse_sim_options(std::span<const std::pair<std::string, std::string>> options) {
    SimOptions parsed;
    bool board_given = false;
    for (const auto& [key, value] : options) {
        GYROLOG_CHECK(set_option(parsed, key, value));
        if (key == "board") { board_given = true; }
        if (key == "board" || key == "boards") { continue; }
        if (!parsed.text.empty()) { parsed.text += ','; }
        parsed.text.append(key).append("=").append(value);
    }
    GYROLOG_CHECK(set_replug(parsed));
    if (board_given && parsed.board > parsed.boards) { parsed.boards = parsed.board; }
    return parsed;
}

}  // namespace gyrolog
