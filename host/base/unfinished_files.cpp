#include "host/base/unfinished_files.hpp"

#include <array>
#include <atomic>

#include <unistd.h>

namespace gyrolog {
namespace {

enum class SlotState : int { empty, being_filled, named };

struct Slot {
    std::atomic<SlotState> state{SlotState::empty};
    std::array<char, 4096> path{};
};

static_assert(std::atomic<SlotState>::is_always_lock_free, "a signal handler reads it");

std::array<Slot, 16> slots;

}  // namespace

UnfinishedFile::UnfinishedFile(const std::string& path) {
    if (path.size() >= slots[0].path.size()) { return; }
    for (std::size_t i = 0; i < slots.size(); ++i) {
        SlotState found = SlotState::empty;
        if (!slots[i].state.compare_exchange_strong(found, SlotState::being_filled)) { continue; }
        slots[i].path[path.copy(slots[i].path.data(), path.size())] = '\0';
        slots[i].state.store(SlotState::named);
        slot_ = static_cast<int>(i);
        return;
    }
}

UnfinishedFile::~UnfinishedFile() {
    if (slot_ != none) { slots[static_cast<std::size_t>(slot_)].state.store(SlotState::empty); }
}

void remove_unfinished_files() noexcept {
    for (const Slot& slot : slots) {
        if (slot.state.load() == SlotState::named) { static_cast<void>(::unlink(slot.path.data())); }
    }
}

}  // namespace gyrolog
