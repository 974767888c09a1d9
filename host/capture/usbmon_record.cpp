#include "host/capture/usbmon_record.hpp"

#include <algorithm>
#include <cerrno>

#include "host/capture/byte_order.hpp"

namespace gyrolog {
namespace {

constexpr std::uint8_t direction_in = 0x80;
constexpr std::uint8_t setup_present = 0;
constexpr std::uint8_t setup_absent = '-';
constexpr std::uint8_t data_present = 0;
constexpr std::uint8_t data_absent_in = '<';
constexpr std::uint8_t data_absent_out = '>';
constexpr std::uint32_t urb_direction_in = 0x200;
constexpr std::int64_t ns_per_s = 1'000'000'000;
constexpr std::uint8_t transfer_types = 4;  // isochronous, interrupt, control, bulk

}  // namespace

void append_usbmon_record(Bytes& out, const Transfer& transfer, UsbAddress address, std::int64_t time_ns) {
    const bool in = (transfer.endpoint & direction_in) != 0;
    const bool submission = transfer.event == Transfer::Event::submission;
    const bool has_setup = submission && transfer.kind == TransferKind::control;
    const bool data_expected = in != submission;
    const std::uint8_t no_data = in ? data_absent_in : data_absent_out;
    const auto data_bytes = static_cast<std::uint32_t>(transfer.data.size());

    put<std::uint64_t>(out, transfer.id);
    put<std::uint8_t>(out, static_cast<std::uint8_t>(transfer.event));
    put<std::uint8_t>(out, static_cast<std::uint8_t>(transfer.kind));
    put<std::uint8_t>(out, transfer.endpoint);
    put<std::uint8_t>(out, address.device);
    put<std::uint16_t>(out, address.bus);
    put<std::uint8_t>(out, has_setup ? setup_present : setup_absent);
    put<std::uint8_t>(out, data_expected || data_bytes > 0 ? data_present : no_data);
    put<std::int64_t>(out, time_ns / ns_per_s);
    put<std::int32_t>(out, static_cast<std::int32_t>(time_ns % ns_per_s / 1000));
    put<std::int32_t>(out, submission ? -EINPROGRESS : transfer.status);
    put<std::uint32_t>(out, submission ? transfer.requested_bytes : data_bytes);
    put<std::uint32_t>(out, data_bytes);
    out.insert(out.end(), transfer.setup.begin(), transfer.setup.end());
    put<std::int32_t>(out, 0);  // interval
    put<std::int32_t>(out, 0);  // start frame
    put<std::uint32_t>(out, in ? urb_direction_in : 0U);
    put<std::uint32_t>(out, 0);  // isochronous descriptors
    out.insert(out.end(), transfer.data.begin(), transfer.data.end());
}

std::optional<UsbmonRecord> read_usbmon_record(ByteView packet) {
    if (packet.size() < usbmon_header_bytes) { return std::nullopt; }
    const auto event = packet[8];
    const auto type = packet[9];
    const auto captured_bytes = get<std::uint32_t>(packet, 36);
    const auto time_us = get<std::int32_t>(packet, 24);
    if ((event != 'S' && event != 'C' && event != 'E') || type >= transfer_types || time_us < 0 ||
        time_us >= 1'000'000 || captured_bytes != packet.size() - usbmon_header_bytes) {
        return std::nullopt;
    }

    UsbmonRecord record;
    record.is_error_event = event == 'E';
    record.address = {get<std::uint16_t>(packet, 12), packet[11]};
    const std::int64_t time_s = std::clamp<std::int64_t>(get<std::int64_t>(packet, 16), 0, ns_per_s * 9);
    record.time_us = time_s * 1'000'000 + time_us;
    Transfer& transfer = record.transfer;
    transfer.event = event == 'S' ? Transfer::Event::submission : Transfer::Event::completion;
    transfer.kind = static_cast<TransferKind>(type);
    transfer.endpoint = packet[10];
    transfer.id = get<std::uint64_t>(packet, 0);
    transfer.status = event == 'S' ? 0 : get<std::int32_t>(packet, 28);
    const auto length = get<std::uint32_t>(packet, 32);
    transfer.requested_bytes = event == 'S' ? length : 0;
    record.actual_bytes = event == 'S' ? 0 : length;
    if (packet[14] == setup_present) { std::copy_n(packet.begin() + 40, 8, transfer.setup.begin()); }
    transfer.data = packet.subspan(usbmon_header_bytes);
    return record;
}

}  // namespace gyrolog
