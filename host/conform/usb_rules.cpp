#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gyrolog_protocol/usb_identity.h>

#include "host/conform/rule.hpp"

namespace gyrolog {
namespace {

constexpr std::uint8_t descriptor_interface = 4;  // USB 2.0, table 9-5
constexpr std::uint8_t descriptor_endpoint = 5;

TranscriptEntry entry_of(const Bytes& bytes) {
    TranscriptEntry entry;
    entry.bytes = bytes;
    return entry;
}

std::string hexadecimal(const std::uint8_t* bytes, std::size_t size) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) { text += fmt::format("{:02X}", bytes[i]); }
    return text;
}

bool same_letters(std::string_view a, std::string_view b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char one, char other) {
               return (one | 0x20) == (other | 0x20);
           });
}

Judgement identity(const Dialogue& dialogue) {
    const SourceIdentity& board = dialogue.identity;
    if (board.vendor_id == 0) { return not_tested("the line is not USB"); }
    Findings findings;
    findings.looked();
    const bool known = glp_usb_id_of(board.vendor_id, board.product_id) != glp_usb_id_other;
    const TranscriptEntry descriptor = entry_of(board.device_descriptor);
    if (!known || !board.product.starts_with(GLP_USB_PRODUCT_PREFIX)) {
        findings.wrong(fmt::format("{:04x}:{:04x} and a product string that begins with {}",
                                   GLP_USB_VENDOR_ID, GLP_USB_PRODUCT_ID, GLP_USB_PRODUCT_PREFIX),
                       fmt::format("{:04x}:{:04x} '{}'", board.vendor_id, board.product_id, board.product),
                       &descriptor);
    }
    const auto hello = dialogue.hello();
    if (dialogue.on_usb && hello) {
        const std::string uid = hexadecimal(hello->uid, GLP_UID_BYTES);
        if (!same_letters(board.serial, uid)) {
            findings.wrong("the uid in hexadecimal as the serial string: " + uid, "'" + board.serial + "'",
                           &descriptor);
        }
    }
    return findings.judgement({});
}

constexpr unsigned endpoint_in = 0x80;  // USB 2.0, table 9-13, as are the kinds
constexpr unsigned kind_bulk = 2;
constexpr unsigned kind_interrupt = 3;

struct Endpoint {
    unsigned interface;
    unsigned address;
    unsigned kind;
    unsigned packet_bytes;
};

Judgement endpoints(const Dialogue& dialogue) {
    const Bytes& bytes = dialogue.identity.configuration_descriptor;
    if (bytes.empty()) { return not_tested("the line is not USB, or its descriptors are not to be had"); }
    Findings findings;
    findings.looked();
    std::vector<Endpoint> found;
    std::string classes;
    unsigned interface = 0;
    for (std::size_t at = 0; at + 2 <= bytes.size() && bytes[at] >= 2; at += bytes[at]) {
        if (at + bytes[at] > bytes.size()) { break; }
        if (bytes[at + 1] == descriptor_interface && bytes[at] >= 9) {
            interface = bytes[at + 2];
            classes += fmt::format("{}:{:02x}/{:02x} ", interface, bytes[at + 5], bytes[at + 6]);
        } else if (bytes[at + 1] == descriptor_endpoint && bytes[at] >= 7) {
            found.push_back(
                {interface, bytes[at + 2], bytes[at + 3] & 3U, bytes[at + 4] | bytes[at + 5] * 256U});
        }
    }
    const auto count = [&](unsigned of, unsigned kind, unsigned direction, unsigned least, unsigned most) {
        return std::ranges::count_if(found, [&](const Endpoint& endpoint) {
            return endpoint.interface == of && endpoint.kind == kind &&
                   (endpoint.address & endpoint_in) == direction && endpoint.packet_bytes >= least &&
                   endpoint.packet_bytes <= most;
        });
    };
    const TranscriptEntry descriptor = entry_of(bytes);
    std::string told;
    for (const Endpoint& endpoint : found) {
        told += fmt::format("{}:{:02x} kind {} {} bytes ", endpoint.interface, endpoint.address,
                            endpoint.kind, endpoint.packet_bytes);
    }
    if (classes.find("0:02/02") == std::string::npos || classes.find("1:0a/00") == std::string::npos) {
        findings.wrong("interface 0 of class 02/02 and interface 1 of class 0a/00", classes, &descriptor);
    } else if (count(GLP_USB_INTERFACE_CONTROL, kind_interrupt, endpoint_in, 8, 64) != 1 ||
               count(GLP_USB_INTERFACE_DATA, kind_bulk, endpoint_in, 64, 64) != 1 ||
               count(GLP_USB_INTERFACE_DATA, kind_bulk, 0, 64, 64) != 1) {
        findings.wrong(
            "one interrupt IN (kind 3) at interface 0, one bulk IN and one bulk OUT (kind 2) of 64 bytes at "
            "interface 1",
            told, &descriptor);
    }
    return findings.judgement({});
}

constexpr std::array all_usb_rules{
    Rule{"10.1", "The device is known by its id and product, and its serial is its uid", identity},
    Rule{"10.2", "Interfaces and the kinds of endpoints are those of the table", endpoints},
};

}  // namespace

std::span<const Rule> usb_rules() { return all_usb_rules; }

}  // namespace gyrolog
