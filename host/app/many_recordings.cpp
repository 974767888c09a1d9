#include "host/app/many_recordings.hpp"

#include <chrono>
#include <exception>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "host/app/command.hpp"
#include "host/app/stop_signal.hpp"
#include "host/base/line_file.hpp"
#include "host/base/printable.hpp"
#include "host/base/program_name.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {
namespace {

// What became of one recording.
struct Outcome {
    ExitCode code = ExitCode::failed;
    std::string error;  // empty: none was told
    std::string json;   // empty: no answer
    std::string told;   // on `err`
    double seconds = 0.0;
};

Outcome outcome_of(const Console& console, const std::string& recording, const RunOne& run) {
    const auto began = std::chrono::steady_clock::now();
    std::ostringstream out;
    std::ostringstream err;
    Outcome outcome;
    Console own{out,
                err,
                console.progress && console.screen != nullptr,
                console.signal,
                console.screen,
                &outcome.error,
                console.is_quiet};
    try {
        outcome.code = run(own, recording, true);
    } catch (const std::exception& problem) {  // of memory, most likely: the next one may need less
        outcome.error = problem.what();
        outcome.code = ExitCode::failed;
        out.str("");
    }
    outcome.json = out.str();
    outcome.told = err.str();
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return outcome;
}

std::string line_of(const char* command, const std::string& recording, const Outcome& outcome) {
    Json line;
    line["file"] = recording;
    if (!outcome.json.empty()) {
        const Json answer = Json::parse(outcome.json);
        for (const auto& item : answer.items()) { line[item.key()] = item.value(); }
    } else {
        line["command"] = command;
        line["reported_by"] = program_name();
    }
    if (outcome.code != ExitCode::ok) { line["exit"] = static_cast<int>(outcome.code); }
    if (!outcome.error.empty() || outcome.json.empty()) {
        line["error"] = outcome.error.empty() ? "no answer" : outcome.error;
    }
    line["seconds"] = outcome.seconds;
    return written_out(line, -1);
}

// Whole, whatever signal comes meanwhile.
Status write_line(Console& console, std::optional<LineFile>& file, const std::string& line) {
    const TidyEnd not_now;
    if (file) { return file->append(line); }
    console.out << line << std::flush;
    return {};
}

ExitCode write_lines(Console& console, const char* command, const ManyRecordings& many, const RunOne& run) {
    std::optional<LineFile> file;
    if (many.jsonl_path != "-") { file.emplace(many.jsonl_path); }
    ExitCode worst = ExitCode::ok;
    std::size_t number = 0;
    for (const std::string& recording : many.recordings) {
        if (console.progress) {
            console.err << fmt::format("{} of {}: {}\n", ++number, many.recordings.size(), recording);
        }
        const Outcome outcome = outcome_of(console, recording, run);
        worst = worst_of(worst, outcome.code);
        const Status written = write_line(console, file, line_of(command, recording, outcome));
        if (!outcome.told.empty()) { console.err << recording << ":\n" << outcome.told; }
        if (!written.ok()) { return worst_of(worst, report_error(console, command, written.error())); }
        if (console.stop_wanted()) { return ended_by_signal(console.signal->load()); }
        if (!file && !console.out) { return worst; }  // nobody reads on
    }
    if (!file) { return worst; }
    if (const Status closed = file->close(); !closed.ok()) {
        return worst_of(worst, report_error(console, command, closed.error()));
    }
    console.notices() << "written: " << printable(many.jsonl_path) << '\n';
    return worst;
}

Status check_files(const ManyRecordings& many, const FilesOfOne& files) {
    std::vector<NamedPath> read(files.read.begin(), files.read.end());
    for (const std::string& recording : many.recordings) { read.push_back({"RECORDING", recording}); }
    std::vector<NamedPath> written(files.written.begin(), files.written.end());
    written.push_back({"--jsonl", many.jsonl_path});
    return check_output_paths(read, written);
}

std::optional<std::string> problem_with(const ManyRecordings& many, const FilesOfOne& files) {
    if (many.jsonl_path.empty()) {
        if (many.recordings.size() < 2) { return std::nullopt; }
        return "several recordings need --jsonl FILE, which takes a line of JSON for each";
    }
    if (many.recordings.empty()) { return "--jsonl: give at least one RECORDING"; }
    for (const NamedPath& path : files.written) {
        if (path.path.empty() || many.recordings.size() == 1) { continue; }
        return fmt::format("{} is one file, and there are {} recordings: give one, or leave it out",
                           path.option, many.recordings.size());
    }
    return std::nullopt;
}

}  // namespace

CLI::Option* add_recordings(CLI::App& app, ManyRecordings& many, const std::string& positional,
                            const std::string& help) {
    CLI::Option* recordings = app.add_option(positional, many.recordings, help + "; several with --jsonl");
    app.add_option("--jsonl", many.jsonl_path,
                   "Of many recordings, a line of JSON for each, as it finishes (- for standard output); "
                   "the exit status is the worst: 6, 2, 1, 5, 0 in this order")
        ->type_name("FILE")
        ->excludes(app.get_option("--json"));
    return recordings;
}

ExitCode run_on_recordings(Console& console, const char* command, const ManyRecordings& many,
                           const FilesOfOne& files, const RunOne& run) {
    if (const auto problem = problem_with(many, files)) {
        return report_error(console, command, {ErrorCode::invalid_argument, *problem});
    }
    if (many.jsonl_path.empty()) {
        return run(console, many.recordings.empty() ? std::string() : many.recordings.front(), false);
    }
    if (const Status fine = check_files(many, files); !fine.ok()) {
        return report_error(console, command, fine.error());
    }
    return write_lines(console, command, many, run);
}

}  // namespace gyrolog
