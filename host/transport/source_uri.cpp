#include "host/transport/source_uri.hpp"

#include <algorithm>
#include <array>

namespace gyrolog {
namespace {

struct Scheme {
    std::string_view name;
    SourceUri::Kind kind;
    bool needs_rest;
};

constexpr std::array<Scheme, 4> schemes{{{"usb", SourceUri::Kind::usb, false},
                                         {"tty", SourceUri::Kind::tty, true},
                                         {"sim", SourceUri::Kind::sim, false},
                                         {"replay", SourceUri::Kind::replay, true}}};

Error refusal(std::string_view text, std::string_view offender, std::string_view why) {
    std::string message = "device '";
    message.append(text).append("': ").append(offender).append(why);
    return {
        ErrorCode::invalid_argument,
        message + "; a device is usb:, usb:SERIAL, tty:PATH[,speed=BAUD], sim:KEY=VALUE,... or replay:FILE"};
}

Status parse_options(std::string_view whole, SourceUri& uri) {
    std::string_view rest = uri.rest;
    while (!rest.empty()) {
        const std::size_t comma = rest.find(',');
        const std::string_view option = rest.substr(0, comma);
        rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
        const std::size_t equals = option.find('=');
        if (equals == 0 || equals == std::string_view::npos) {
            return refusal(whole, option, " is not KEY=VALUE");
        }
        std::string key(option.substr(0, equals));
        const bool repeated = std::any_of(uri.options.begin(), uri.options.end(),
                                          [&](const auto& earlier) { return earlier.first == key; });
        if (repeated) { return refusal(whole, key, " stands there twice"); }
        uri.options.emplace_back(std::move(key), option.substr(equals + 1));
    }
    return {};
}

void split_off_speed(SourceUri& uri) {
    constexpr std::string_view mark = ",speed=";
    const std::size_t at = uri.rest.rfind(mark);
    if (at == std::string::npos || uri.rest.find(',', at + 1) != std::string::npos) { return; }
    uri.options.emplace_back("speed", uri.rest.substr(at + mark.size()));
    uri.rest.resize(at);
}

}  // namespace

Result<SourceUri> parse_source_uri(std::string_view text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) { return refusal(text, text, " has no ':'"); }
    const auto scheme = std::find_if(schemes.begin(), schemes.end(), [&](const Scheme& known) {
        return known.name == text.substr(0, colon);
    });
    if (scheme == schemes.end()) { return refusal(text, text.substr(0, colon), " is no kind of device"); }
    SourceUri uri{scheme->kind, std::string(text.substr(colon + 1)), {}};
    if (uri.kind == SourceUri::Kind::tty) { split_off_speed(uri); }
    if (uri.rest.empty() && scheme->needs_rest) { return refusal(text, "nothing", " stands behind the ':'"); }
    if (uri.kind == SourceUri::Kind::sim) { GYROLOG_CHECK(parse_options(text, uri)); }
    return uri;
}

}  // namespace gyrolog
