// Pieces of work that do not depend on each other, on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace gyrolog {

// Calls task(0) ... task(count - 1), each once, and returns when all have returned. At most `threads` run at
// a time, the caller's thread among them; 0: as many as the machine has processors.
//
// Which thread takes which piece, and when, changes from run to run. Where each piece writes only what is its
// own, and sums are taken afterwards in the order of the pieces, the result is the same bits for any number
// of threads.
//
// Where the system gives fewer threads, the work is done by those that there are. What a task throws, when
// memory is out, reaches the caller after the others have returned, and pieces may be left undone.
void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task);

}  // namespace gyrolog
