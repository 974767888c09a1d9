#include "tests/host/usb/fake_libusb.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <set>
#include <utility>

namespace gyrolog::test {
namespace {

struct Cancelled {
    libusb_transfer* transfer;
    unsigned turns_left;
};

struct BusState {
    std::mutex mutex;
    std::condition_variable changed;
    bool interrupted = false;

    FakeUsb::Script script;
    FakeUsb::Admission admission;
    unsigned cancellation_turns = 0;
    bool unplugged = false;
    int clear_halt_code = LIBUSB_SUCCESS;

    MockUsbFunction* function = nullptr;
    std::uint8_t device_address = 2;
    int event_failure = LIBUSB_SUCCESS;
    std::uint64_t event_failures_left = 0;
    bool events_failed_for_good = false;  // until the next close
    bool silent = false;
    int open_handles = 0;

    std::deque<libusb_transfer*> requests;  // control and bulk OUT: answered before what is awaited
    std::deque<libusb_transfer*> in_flight;
    std::deque<Cancelled> cancelled;
    std::set<libusb_transfer*> allocated;
    std::uint64_t submissions = 0;
    std::uint64_t completions = 0;
    std::uint64_t clear_halts = 0;
    std::uint64_t turns = 0;
    std::size_t most_in_flight = 0;
    std::uint8_t next_byte = 0;
    std::vector<std::string> complaints;

    bool holds(const libusb_transfer* transfer) const {
        return std::find(in_flight.begin(), in_flight.end(), transfer) != in_flight.end() ||
               std::find(requests.begin(), requests.end(), transfer) != requests.end() ||
               std::any_of(cancelled.begin(), cancelled.end(),
                           [&](const Cancelled& one) { return one.transfer == transfer; });
    }
};

bool is_request(const libusb_transfer& transfer) {
    return transfer.type == LIBUSB_TRANSFER_TYPE_CONTROL || (transfer.endpoint & LIBUSB_ENDPOINT_IN) == 0;
}

BusState& state() {
    static BusState the_bus;
    return the_bus;
}

void fill(BusState& bus, libusb_transfer& transfer, const FakeCompletion& completion) {
    transfer.status = completion.status;
    transfer.actual_length = completion.received_bytes;
    for (int i = 0; i < completion.received_bytes; ++i) { transfer.buffer[i] = bus.next_byte++; }
}

// The oldest request with the device's answer, if there is one.
libusb_transfer* take_request(BusState& bus) {
    if (bus.requests.empty() || (bus.silent && !bus.unplugged)) { return nullptr; }
    libusb_transfer* transfer = bus.requests.front();
    bus.requests.pop_front();
    transfer->actual_length = 0;
    transfer->status = LIBUSB_TRANSFER_COMPLETED;
    if (bus.unplugged) {
        transfer->status = LIBUSB_TRANSFER_NO_DEVICE;
    } else if (transfer->type != LIBUSB_TRANSFER_TYPE_CONTROL) {
        bus.function->on_bulk_out({transfer->buffer, static_cast<std::size_t>(transfer->length)});
        transfer->actual_length = transfer->length;
    } else {
        std::array<std::uint8_t, LIBUSB_CONTROL_SETUP_SIZE> setup{};
        std::copy_n(transfer->buffer, setup.size(), setup.begin());
        if (bus.function->on_control(setup, {}) != 0) { transfer->status = LIBUSB_TRANSFER_STALL; }
    }
    return transfer;
}

std::optional<FakeCompletion> ask_device(BusState& bus, libusb_transfer& transfer) {
    const auto in = bus.function->on_bulk_in(static_cast<std::size_t>(transfer.length));
    if (!in) { return std::nullopt; }
    std::copy(in->data.begin(), in->data.end(), transfer.buffer);
    transfer.status = in->status == 0 ? LIBUSB_TRANSFER_COMPLETED : LIBUSB_TRANSFER_NO_DEVICE;
    transfer.actual_length = static_cast<int>(in->data.size());
    return FakeCompletion{transfer.status, transfer.actual_length};
}

// The transfer whose callback is due, if one is.
libusb_transfer* take_due(BusState& bus) {
    if (libusb_transfer* request = take_request(bus)) { return request; }
    if (!bus.cancelled.empty()) {
        Cancelled& first = bus.cancelled.front();
        if (first.turns_left > 0 && !bus.unplugged) {
            --first.turns_left;
            return nullptr;
        }
        libusb_transfer* transfer = first.transfer;
        bus.cancelled.pop_front();
        fill(bus, *transfer, {bus.unplugged ? LIBUSB_TRANSFER_NO_DEVICE : LIBUSB_TRANSFER_CANCELLED, 0});
        return transfer;
    }
    if (bus.in_flight.empty()) { return nullptr; }
    std::optional<FakeCompletion> completion;
    if (bus.unplugged) {
        completion = FakeCompletion{LIBUSB_TRANSFER_NO_DEVICE, 0};
    } else if (bus.silent) {
        return nullptr;
    } else if (bus.function != nullptr) {
        if (!ask_device(bus, *bus.in_flight.front())) { return nullptr; }
        libusb_transfer* transfer = bus.in_flight.front();
        bus.in_flight.pop_front();
        ++bus.completions;
        return transfer;
    } else if (bus.script) {
        completion = bus.script(bus.completions);
    }
    if (!completion) { return nullptr; }
    libusb_transfer* transfer = bus.in_flight.front();
    bus.in_flight.pop_front();
    fill(bus, *transfer, *completion);
    ++bus.completions;
    return transfer;
}

int handle_events(const timeval& timeout) {
    BusState& bus = state();
    std::unique_lock lock(bus.mutex);
    ++bus.turns;
    if (bus.event_failures_left > 0) {
        --bus.event_failures_left;
        return bus.event_failure;
    }
    libusb_transfer* due = take_due(bus);
    if (due == nullptr) {
        // A silent board is asked again soon; the bus has no other clock.
        const auto longest =
            std::chrono::seconds(timeout.tv_sec) + std::chrono::microseconds(timeout.tv_usec);
        const bool busy = !bus.in_flight.empty() || !bus.cancelled.empty() || !bus.requests.empty();
        const auto wait =
            busy ? std::min<std::chrono::microseconds>(longest, std::chrono::microseconds(200)) : longest;
        bus.changed.wait_for(lock, wait, [&] { return bus.interrupted; });
        bus.interrupted = false;
        return LIBUSB_SUCCESS;
    }
    lock.unlock();
    due->callback(due);
    return LIBUSB_SUCCESS;
}

}  // namespace

FakeUsb& FakeUsb::bus() {
    static FakeUsb the_only_one;
    return the_only_one;
}

void FakeUsb::reset(Script script, Admission admission) {
    BusState& bus = state();
    const std::lock_guard lock(bus.mutex);
    bus.script = std::move(script);
    bus.admission = std::move(admission);
    bus.cancellation_turns = 0;
    bus.function = nullptr;
    bus.event_failures_left = 0;
    bus.events_failed_for_good = false;
    bus.silent = false;
    bus.unplugged = false;
    bus.clear_halt_code = LIBUSB_SUCCESS;
    bus.submissions = bus.completions = bus.clear_halts = bus.turns = 0;
    bus.most_in_flight = 0;
    bus.next_byte = 0;
    bus.complaints.clear();
}

void FakeUsb::plug_in(MockUsbFunction* function, std::uint8_t device_address) {
    const std::lock_guard lock(state().mutex);
    state().function = function;
    state().device_address = device_address;
    state().unplugged = false;
    state().silent = false;
}

void FakeUsb::fail_events(int code, std::uint64_t times) {
    const std::lock_guard lock(state().mutex);
    state().event_failure = code;
    state().event_failures_left = code == LIBUSB_SUCCESS ? 0 : times;
    if (state().event_failures_left == FakeUsb::for_good) { state().events_failed_for_good = true; }
    state().interrupted = true;
    state().changed.notify_all();
}

void FakeUsb::fall_silent() {
    const std::lock_guard lock(state().mutex);
    state().silent = true;
}

void FakeUsb::delay_cancellations(unsigned turns) {
    const std::lock_guard lock(state().mutex);
    state().cancellation_turns = turns;
}

void FakeUsb::unplug() {
    const std::lock_guard lock(state().mutex);
    state().unplugged = true;
}

void FakeUsb::answer_clear_halt(int code) {
    const std::lock_guard lock(state().mutex);
    state().clear_halt_code = code;
}

std::uint64_t FakeUsb::completions() const {
    const std::lock_guard lock(state().mutex);
    return state().completions;
}

std::uint64_t FakeUsb::clear_halts() const {
    const std::lock_guard lock(state().mutex);
    return state().clear_halts;
}

std::uint64_t FakeUsb::event_turns() const {
    const std::lock_guard lock(state().mutex);
    return state().turns;
}

std::size_t FakeUsb::most_in_flight() const {
    const std::lock_guard lock(state().mutex);
    return state().most_in_flight;
}

std::vector<std::string> FakeUsb::complaints() const {
    const std::lock_guard lock(state().mutex);
    std::vector<std::string> all = state().complaints;
    if (!state().allocated.empty()) { all.emplace_back("a transfer was never freed"); }
    if (state().open_handles != 0) { all.emplace_back("a device was not closed as often as opened"); }
    return all;
}

}  // namespace gyrolog::test

using gyrolog::test::state;

extern "C" {

int LIBUSB_CALL libusb_init(libusb_context** context) {
    *context = reinterpret_cast<libusb_context*>(&state());
    return LIBUSB_SUCCESS;
}

void LIBUSB_CALL libusb_exit(libusb_context*) {}

int LIBUSB_CALL libusb_handle_events_timeout_completed(libusb_context*, timeval* timeout, int*) {
    return gyrolog::test::handle_events(*timeout);
}

void LIBUSB_CALL libusb_interrupt_event_handler(libusb_context*) {
    const std::lock_guard lock(state().mutex);
    state().interrupted = true;
    state().changed.notify_all();
}

libusb_transfer* LIBUSB_CALL libusb_alloc_transfer(int) {
    auto* transfer = new libusb_transfer();
    const std::lock_guard lock(state().mutex);
    state().allocated.insert(transfer);
    return transfer;
}

void LIBUSB_CALL libusb_free_transfer(libusb_transfer* transfer) {
    if (transfer == nullptr) { return; }
    const std::lock_guard lock(state().mutex);
    if (state().holds(transfer)) { state().complaints.emplace_back("a transfer was freed in flight"); }
    if (state().allocated.erase(transfer) == 0) {
        state().complaints.emplace_back("a transfer was freed twice");
    }
    delete transfer;
}

int LIBUSB_CALL libusb_submit_transfer(libusb_transfer* transfer) {
    auto& bus = state();
    const std::lock_guard lock(bus.mutex);
    if (bus.holds(transfer)) {
        bus.complaints.emplace_back("a transfer was submitted twice");
        return LIBUSB_ERROR_BUSY;
    }
    if (bus.unplugged) { return LIBUSB_ERROR_NO_DEVICE; }
    const std::uint64_t attempt = bus.submissions++;
    if (bus.admission) {
        if (const int code = bus.admission(attempt); code != LIBUSB_SUCCESS) { return code; }
    }
    if (gyrolog::test::is_request(*transfer)) {
        bus.requests.push_back(transfer);
        return LIBUSB_SUCCESS;
    }
    bus.in_flight.push_back(transfer);
    bus.most_in_flight = std::max(bus.most_in_flight, bus.in_flight.size());
    return LIBUSB_SUCCESS;
}

int LIBUSB_CALL libusb_cancel_transfer(libusb_transfer* transfer) {
    auto& bus = state();
    const std::lock_guard lock(bus.mutex);
    const auto place = std::find(bus.in_flight.begin(), bus.in_flight.end(), transfer);
    if (place == bus.in_flight.end()) { return LIBUSB_ERROR_NOT_FOUND; }
    bus.in_flight.erase(place);
    bus.cancelled.push_back({transfer, bus.cancellation_turns});
    return LIBUSB_SUCCESS;
}

int LIBUSB_CALL libusb_clear_halt(libusb_device_handle*, unsigned char) {
    auto& bus = state();
    const std::lock_guard lock(bus.mutex);
    if (!bus.in_flight.empty() || !bus.cancelled.empty()) {
        bus.complaints.emplace_back("a halt was cleared with transfers in flight");
    }
    ++bus.clear_halts;
    return bus.clear_halt_code;
}

// One device at the most.
ssize_t LIBUSB_CALL libusb_get_device_list(libusb_context*, libusb_device*** list) {
    static std::array<libusb_device*, 2> devices{};
    auto& bus = state();
    const std::lock_guard lock(bus.mutex);
    const bool there = bus.function != nullptr && !bus.unplugged;
    devices[0] = there ? reinterpret_cast<libusb_device*>(&bus) : nullptr;
    *list = devices.data();
    return there ? 1 : 0;
}

void LIBUSB_CALL libusb_free_device_list(libusb_device**, int) {}

uint8_t LIBUSB_CALL libusb_get_bus_number(libusb_device*) { return 1; }

uint8_t LIBUSB_CALL libusb_get_device_address(libusb_device*) {
    const std::lock_guard lock(state().mutex);
    return state().device_address;
}

int LIBUSB_CALL libusb_open(libusb_device*, libusb_device_handle** handle) {
    const std::lock_guard lock(state().mutex);
    ++state().open_handles;
    *handle = reinterpret_cast<libusb_device_handle*>(&state());
    return LIBUSB_SUCCESS;
}

void LIBUSB_CALL libusb_close(libusb_device_handle*) {
    auto& bus = state();
    const std::lock_guard lock(bus.mutex);
    --bus.open_handles;
    const bool any = !bus.in_flight.empty() || !bus.requests.empty() || !bus.cancelled.empty();
    if (any && !std::exchange(bus.events_failed_for_good, false)) {
        bus.complaints.emplace_back("a device was closed with transfers in flight");
    }
    // As libusb does: they are nobody's from now on.
    bus.in_flight.clear();
    bus.requests.clear();
    bus.cancelled.clear();
}

int LIBUSB_CALL libusb_claim_interface(libusb_device_handle*, int) { return LIBUSB_SUCCESS; }
int LIBUSB_CALL libusb_release_interface(libusb_device_handle*, int) { return LIBUSB_SUCCESS; }
int LIBUSB_CALL libusb_kernel_driver_active(libusb_device_handle*, int) { return 0; }
int LIBUSB_CALL libusb_detach_kernel_driver(libusb_device_handle*, int) { return LIBUSB_SUCCESS; }
int LIBUSB_CALL libusb_attach_kernel_driver(libusb_device_handle*, int) { return LIBUSB_SUCCESS; }

}  // extern "C"
