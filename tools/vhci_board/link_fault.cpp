#include "tools/vhci_board/link_fault.hpp"

#include <cerrno>
#include <charconv>

namespace gyrolog {

int link_fault_status(LinkFaultKind kind) {
    switch (kind) {
        case LinkFaultKind::stall:
            return -EPIPE;
        case LinkFaultKind::babble:
            return -EOVERFLOW;
        case LinkFaultKind::crc:
            return -EPROTO;
    }
    return -EPROTO;
}

Result<LinkFault> parse_link_fault(std::string_view text) {
    const Error error{
        ErrorCode::invalid_argument,
        "fault '" + std::string(text) + "': expected stall@SECONDS, babble@SECONDS or crc@SECONDS"};
    const std::size_t at = text.find('@');
    if (at == std::string_view::npos) { return error; }
    LinkFault fault;
    const std::string_view kind = text.substr(0, at);
    if (kind == "stall") {
        fault.kind = LinkFaultKind::stall;
    } else if (kind == "babble") {
        fault.kind = LinkFaultKind::babble;
    } else if (kind == "crc") {
        fault.kind = LinkFaultKind::crc;
    } else {
        return error;
    }
    const std::string_view seconds = text.substr(at + 1);
    const auto [end, problem] = std::from_chars(seconds.data(), seconds.data() + seconds.size(), fault.at_s);
    if (problem != std::errc{} || end != seconds.data() + seconds.size() || !(fault.at_s >= 0.0)) {
        return error;
    }
    return fault;
}

}  // namespace gyrolog
