// The control transfers that every capture begins with: those by which a host gets to know a device.
// Wireshark binds its dissectors by them. They are made up from the source's identity, and marked by ids that
// no real transfer has.
#pragma once

#include <cstdint>
#include <functional>

#include "host/base/clock.hpp"
#include "host/transport/byte_source.hpp"
#include "host/transport/transfer.hpp"

namespace gyrolog {

constexpr std::uint64_t head_record_id_min = ~std::uint64_t{0} - 15U;

// A device descriptor is made from the identifiers when there is none; without identifiers there are no
// records.
void for_each_head_record(const SourceIdentity& identity, HostTime time,
                          const std::function<void(const Transfer&)>& visit);

}  // namespace gyrolog
