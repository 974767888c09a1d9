// How much a text for people says.
#pragma once

namespace gyrolog {

enum class Wording {
    brief,  // what one acts on
    whole   // with every detail
};

}  // namespace gyrolog
