#include "host/capture/head_records.hpp"

#include <array>

namespace gyrolog {
namespace {

using Setup = std::array<std::uint8_t, 8>;

constexpr std::uint8_t get_descriptor = 6;  // USB 2.0, table 9-4
constexpr std::uint8_t set_configuration = 9;
constexpr std::uint8_t device_descriptor_type = 1;  // USB 2.0, table 9-5
constexpr std::uint8_t configuration_descriptor_type = 2;
constexpr std::size_t configuration_value_offset = 5;

// USB 2.0, table 9-8: a communications device of USB 2.0 with 64-byte packets and one configuration.
Bytes device_descriptor_of(const SourceIdentity& identity) {
    if (!identity.device_descriptor.empty()) { return identity.device_descriptor; }
    if (identity.vendor_id == 0) { return {}; }
    const auto low = [](std::uint16_t value) { return static_cast<std::uint8_t>(value); };
    const auto high = [](std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8U); };
    return {18,
            device_descriptor_type,
            0x00,
            0x02,
            2,
            0,
            0,
            64,
            low(identity.vendor_id),
            high(identity.vendor_id),
            low(identity.product_id),
            high(identity.product_id),
            0,
            1,
            0,
            0,
            0,
            1};
}

Setup descriptor_request(std::uint8_t type, std::size_t size) {
    return {0x80,
            get_descriptor,
            0,
            type,
            0,
            0,
            static_cast<std::uint8_t>(size),
            static_cast<std::uint8_t>(size >> 8U)};
}

}  // namespace

void for_each_head_record(const SourceIdentity& identity, HostTime time,
                          const std::function<void(const Transfer&)>& visit) {
    std::uint64_t id = head_record_id_min;
    const auto control = [&](const Setup& setup, ByteView answer) {
        Transfer transfer;
        transfer.kind = TransferKind::control;
        transfer.endpoint = setup[0] & 0x80U;
        transfer.id = id++;
        transfer.time = time;
        transfer.setup = setup;
        transfer.event = Transfer::Event::submission;
        transfer.requested_bytes = static_cast<std::uint32_t>(answer.size());
        visit(transfer);
        transfer.setup = {};
        transfer.event = Transfer::Event::completion;
        transfer.data = answer;
        visit(transfer);
    };
    const Bytes device = device_descriptor_of(identity);
    if (device.empty()) { return; }
    control(descriptor_request(device_descriptor_type, device.size()), device);
    const Bytes& configuration = identity.configuration_descriptor;
    if (configuration.size() <= configuration_value_offset) { return; }
    control(descriptor_request(configuration_descriptor_type, configuration.size()), configuration);
    control({0, set_configuration, configuration[configuration_value_offset], 0, 0, 0, 0, 0}, {});
}

}  // namespace gyrolog
