#include "host/app/result_output.hpp"

#include "host/base/file_output.hpp"
#include "host/base/printable.hpp"
#include "host/base/program_name.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {

void ResultOutput::file(const std::string& path, const std::function<Status()>& write) {
    if (path.empty()) { return; }
    const Status done = write();
    if (done.ok()) {
        written_.push_back(path);
    } else if (error_) {
        error_->message += "; " + done.error().message;
    } else {
        error_ = done.error();
    }
}

void ResultOutput::text(const std::string& path, const std::function<std::string()>& text) {
    if (path == "-") {
        show(text());
    } else {
        file(path, [&] { return write_file(path, as_bytes(text())); });
    }
}

void ResultOutput::json(const std::string& path, const std::function<Json()>& answer) {
    text(path, [&] {
        Json signed_answer = answer();
        signed_answer["reported_by"] = program_name();
        return written_out(signed_answer, 2);
    });
}

// Whether standard output took it is asked once, when the program ends.
Status ResultOutput::finish() {
    write_inked(console_.out, shown_, emphasis_);
    console_.out << std::flush;
    for (const std::string& path : written_) { console_.notices() << "written: " << printable(path) << '\n'; }
    return error_ ? Status(*error_) : Status();
}

}  // namespace gyrolog
