#include "host/base/file_output.hpp"

#include "host/base/replacing_file.hpp"

namespace gyrolog {
namespace {

Status replace_file(const std::string& path, ByteView contents) {
    GYROLOG_TRY(ReplacingFile file, ReplacingFile::create(path));
    GYROLOG_CHECK(file.write(contents));
    return file.commit();
}

}  // namespace

Status write_file(const std::string& path, ByteView contents) {
    const Status done = replace_file(path, contents);
    return done.ok() ? done : in_context("write '" + path + "'", done.error());
}

}  // namespace gyrolog
