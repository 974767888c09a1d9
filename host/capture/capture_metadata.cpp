#include "host/capture/capture_metadata.hpp"

#include <array>
#include <cstdio>

#include <time.h>

#include <nlohmann/json.hpp>

namespace gyrolog {
namespace {

using WrittenJson = nlohmann::ordered_json;
// Of read text nobody knows how many keys it has: the ordered object looks through all of them for each.
using Json = nlohmann::json;

// An option of pcapng holds 64 KiB; no real name or descriptor comes near these.
constexpr std::size_t text_bytes_max = 4096;
constexpr std::size_t descriptor_bytes_max = 4096;

// What a device says of itself need not be UTF-8.
std::string dump(const WrittenJson& json) {
    return json.dump(-1, ' ', false, WrittenJson::error_handler_t::replace);
}

std::string bounded(const std::string& text) { return text.substr(0, text_bytes_max); }

std::string hex(ByteView bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const std::uint8_t byte : bytes.first(std::min(bytes.size(), descriptor_bytes_max))) {
        text += digits[byte >> 4U];
        text += digits[byte & 0x0FU];
    }
    return text;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') { return c - '0'; }
    if (c >= 'a' && c <= 'f') { return c - 'a' + 10; }
    return -1;
}

Bytes from_hex(std::string_view text) {
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
        const int high = hex_digit(text[i]);
        const int low = hex_digit(text[i + 1]);
        if (high < 0 || low < 0) { return {}; }
        bytes.push_back(static_cast<std::uint8_t>(high * 16 + low));
    }
    return bytes;
}

std::string hex_id(std::uint16_t id) {
    const std::array<std::uint8_t, 2> bytes{static_cast<std::uint8_t>(id >> 8U),
                                            static_cast<std::uint8_t>(id)};
    return hex(bytes);
}

WrittenJson clock_json(HostTime time) {
    return {{"monotonic_ns", time.monotonic_ns}, {"realtime_ns", time.realtime_ns}};
}

// Members of an object that may be missing or of another type.
class Fields {
public:
    explicit Fields(const Json& object) : object_(object) {}

    template <typename Number>
    void number(const char* name, Number& value) const {
        const auto found = object_.find(name);
        if (found != object_.end() && found->is_number_integer()) { value = found->get<Number>(); }
    }
    void text(const char* name, std::string& value) const {
        const auto found = object_.find(name);
        if (found != object_.end() && found->is_string()) { value = found->get<std::string>(); }
    }
    void id(const char* name, std::uint16_t& value) const {
        std::string digits;
        text(name, digits);
        const Bytes bytes = from_hex(digits);
        if (bytes.size() == 2) { value = static_cast<std::uint16_t>(bytes[0] * 256 + bytes[1]); }
    }
    void descriptor(const char* name, Bytes& value) const {
        std::string digits;
        text(name, digits);
        value = from_hex(digits);
    }
    Json object(const char* name) const {
        const auto found = object_.find(name);
        return found != object_.end() && found->is_object() ? *found : Json::object();
    }

private:
    const Json& object_;
};

HostTime read_clock(const Json& json) {
    HostTime time;
    Fields(json).number("monotonic_ns", time.monotonic_ns);
    Fields(json).number("realtime_ns", time.realtime_ns);
    return {told_ns(time.monotonic_ns), told_ns(time.realtime_ns)};
}

std::optional<Json> parse(std::string_view text, std::string_view schema) {
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) { return std::nullopt; }
    std::string told;
    Fields(json).text("schema", told);
    if (told != schema) { return std::nullopt; }
    return json;
}

}  // namespace

std::string utc_text(std::int64_t realtime_ns) {
    std::int64_t seconds = realtime_ns / 1'000'000'000;
    std::int64_t nanoseconds = realtime_ns % 1'000'000'000;
    if (nanoseconds < 0) {
        nanoseconds += 1'000'000'000;
        --seconds;
    }
    tm utc{};
    const time_t time = seconds;
    gmtime_r(&time, &utc);
    std::array<char, 32> date{};
    const std::size_t length = strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &utc);
    std::string fraction = std::to_string(nanoseconds);
    fraction.insert(0, 9 - fraction.size(), '0');
    return std::string(date.data(), length) + "." + fraction + "Z";
}

std::string metadata_json(const CaptureMetadata& metadata) {
    const SourceIdentity& source = metadata.source;
    WrittenJson json = {{"schema", capture_schema},
                        {"program", metadata.program},
                        {"started", utc_text(metadata.started.realtime_ns)},
                        {"clock", clock_json(metadata.started)},
                        {"source",
                         {{"uri", bounded(source.uri)},
                          {"vid", hex_id(source.vendor_id)},
                          {"pid", hex_id(source.product_id)},
                          {"bus", source.bus_number},
                          {"address", source.device_address},
                          {"manufacturer", bounded(source.manufacturer)},
                          {"product", bounded(source.product)},
                          {"serial", bounded(source.serial)},
                          {"device_descriptor", hex(source.device_descriptor)},
                          {"configuration_descriptor", hex(source.configuration_descriptor)}}}};
    if (metadata.segment) {
        json["segment"] = {{"capture", bounded(metadata.segment->capture)},
                           {"number", metadata.segment->number},
                           {"connection", metadata.segment->connection}};
    }
    return dump(json);
}

std::string checkpoint_json(const CaptureCheckpoint& checkpoint) {
    const CaptureCounters& counters = checkpoint.counters;
    return dump({{"schema", checkpoint_schema},
                 {"clock", clock_json(checkpoint.time)},
                 {"transfers", checkpoint.transfers},
                 {"stream_bytes", checkpoint.stream_bytes},
                 {"counters",
                  {{"stream_bytes", counters.stream_bytes},
                   {"frames", counters.frames},
                   {"samples", counters.samples},
                   {"frames_missing", counters.frames_missing},
                   {"samples_missing", counters.samples_missing},
                   {"transfers_dropped", counters.transfers_dropped},
                   {"bytes_dropped", counters.bytes_dropped}}},
                 {"last", checkpoint.last}});
}

std::string mark_json(const CaptureMark& mark) {
    return dump({{"schema", mark_schema},
                 {"clock", clock_json(mark.time)},
                 {"text", bounded(mark.text)},
                 {"stream_bytes", mark.stream_bytes}});
}

std::optional<CaptureMetadata> read_metadata_json(std::string_view text) {
    const std::optional<Json> json = parse(text, capture_schema);
    if (!json) { return std::nullopt; }
    const Fields fields(*json);
    CaptureMetadata metadata;
    fields.text("program", metadata.program);
    metadata.started = read_clock(fields.object("clock"));

    const Json source_json = fields.object("source");
    const Fields source(source_json);
    source.text("uri", metadata.source.uri);
    source.id("vid", metadata.source.vendor_id);
    source.id("pid", metadata.source.product_id);
    source.number("bus", metadata.source.bus_number);
    source.number("address", metadata.source.device_address);
    source.text("manufacturer", metadata.source.manufacturer);
    source.text("product", metadata.source.product);
    source.text("serial", metadata.source.serial);
    source.descriptor("device_descriptor", metadata.source.device_descriptor);
    source.descriptor("configuration_descriptor", metadata.source.configuration_descriptor);

    const Json segment_json = fields.object("segment");
    const Fields segment(segment_json);
    CaptureSegment part;
    segment.text("capture", part.capture);
    segment.number("number", part.number);
    segment.number("connection", part.connection);
    if (!part.capture.empty()) { metadata.segment = part; }
    return metadata;
}

std::optional<CaptureCheckpoint> read_checkpoint_json(std::string_view text) {
    const std::optional<Json> json = parse(text, checkpoint_schema);
    if (!json) { return std::nullopt; }
    const Fields fields(*json);
    CaptureCheckpoint checkpoint;
    checkpoint.time = read_clock(fields.object("clock"));
    fields.number("transfers", checkpoint.transfers);
    fields.number("stream_bytes", checkpoint.stream_bytes);
    const auto last = json->find("last");
    checkpoint.last = last != json->end() && last->is_boolean() && last->get<bool>();

    const Json counters_json = fields.object("counters");
    const Fields counters(counters_json);
    counters.number("stream_bytes", checkpoint.counters.stream_bytes);
    counters.number("frames", checkpoint.counters.frames);
    counters.number("samples", checkpoint.counters.samples);
    counters.number("frames_missing", checkpoint.counters.frames_missing);
    counters.number("samples_missing", checkpoint.counters.samples_missing);
    counters.number("transfers_dropped", checkpoint.counters.transfers_dropped);
    counters.number("bytes_dropped", checkpoint.counters.bytes_dropped);
    return checkpoint;
}

std::optional<CaptureMark> read_mark_json(std::string_view text) {
    const std::optional<Json> json = parse(text, mark_schema);
    if (!json) { return std::nullopt; }
    const Fields fields(*json);
    CaptureMark mark;
    mark.time = read_clock(fields.object("clock"));
    fields.text("text", mark.text);
    fields.number("stream_bytes", mark.stream_bytes);
    return mark;
}

}  // namespace gyrolog
