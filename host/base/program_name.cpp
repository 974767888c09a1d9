#include "host/base/program_name.hpp"

#include <utility>

namespace gyrolog {
namespace {

std::string& revision_of_program() {
    static std::string revision;
    return revision;
}

}  // namespace

std::string program_name() {
    const std::string& revision = revision_of_program();
    return "gyrolog " GYROLOG_VERSION + (revision.empty() ? "" : " (" + revision + ")");
}

void set_program_revision(std::string revision) { revision_of_program() = std::move(revision); }

}  // namespace gyrolog
