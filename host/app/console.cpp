#include "host/app/console.hpp"

namespace gyrolog {

std::ostream& Console::notices() const {
    static std::ostream nowhere(nullptr);
    return is_quiet ? nowhere : err;
}

}  // namespace gyrolog
