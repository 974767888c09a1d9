// Results on their way to files and to standard output.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/app/console.hpp"
#include "host/app/ink.hpp"
#include "host/base/result.hpp"
#include "host/formats/json_fwd.hpp"

namespace gyrolog {

// The results of one command. Files come first, and each is written whether another could be or not; then
// comes what goes to standard output. A reader of that who went away costs no file, and a file that cannot be
// written costs nobody the report.
class ResultOutput {
public:
    explicit ResultOutput(Console& console) : console_(console) {}

    // A result in a file of its own, replaced whole or not at all; without a path there is none.
    void file(const std::string& path, const std::function<Status()>& write);
    // The same for text. The path "-" is standard output.
    void text(const std::string& path, const std::function<std::string()>& text);
    // The same for JSON, which gains the key "reported_by", with program_name().
    void json(const std::string& path, const std::function<Json()>& answer);
    // For standard output, after the files.
    void show(const std::string& text) { shown_ += text; }
    // The same of a report that begins with its verdict.
    void show_verdict(const std::string& report) {
        emphasis_ = Emphasis::first_paragraph;
        show(report);
    }

    // Shows, and says on `err` which files were written. All errors in one, with the first one's code.
    Status finish();

private:
    Console& console_;
    std::string shown_;
    Emphasis emphasis_ = Emphasis::none;
    std::vector<std::string> written_;
    std::optional<Error> error_;
};

}  // namespace gyrolog
