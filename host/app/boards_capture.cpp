#include "host/app/boards_capture.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "host/app/capture_notices.hpp"
#include "host/app/capture_run.hpp"
#include "host/app/command.hpp"
#include "host/app/device_choice.hpp"
#include "host/app/former_id.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/stop_signal.hpp"
#include "host/base/printable.hpp"

namespace gyrolog {
namespace {

// One board's capture on a thread of its own. What it tells is picked up by the console's thread.
class BoardCapture {
public:
    BoardCapture(OpenedSource opened, CaptureRequest request)
        : opened_(std::move(opened)), request_(std::move(request)), limited_(request_.has_limit()) {
        if (opened_.keeps_limit) {
            request_.duration_s.reset();
            request_.samples.reset();
        }
    }
    ~BoardCapture() {
        stop();
        join();
    }
    BoardCapture(const BoardCapture&) = delete;
    BoardCapture& operator=(const BoardCapture&) = delete;

    void start() {
        thread_ = std::thread([this] {
            auto outcome = run_capture(*opened_.source, request_, [&](const CaptureProgress& progress) {
                const std::lock_guard lock(mutex_);
                progress_ = progress;
                return !stop_wanted_;
            });
            const std::lock_guard lock(mutex_);
            outcome_.emplace(std::move(outcome));
        });
    }
    void stop() { stop_wanted_ = true; }
    void join() {
        if (thread_.joinable()) { thread_.join(); }
    }

    const std::string& path() const { return request_.path; }
    const ByteSource& source() const { return *opened_.source; }
    CaptureProgress progress() const {
        const std::lock_guard lock(mutex_);
        return progress_;
    }
    bool finished() const {
        const std::lock_guard lock(mutex_);
        return outcome_.has_value();
    }
    bool limited() const { return limited_; }
    const Result<CaptureOutcome>& outcome() const { return *outcome_; }  // after join()

private:
    OpenedSource opened_;
    CaptureRequest request_;
    bool limited_;
    std::atomic<bool> stop_wanted_{false};
    mutable std::mutex mutex_;
    CaptureProgress progress_;
    std::optional<Result<CaptureOutcome>> outcome_;
    std::thread thread_;
};

using Boards = std::vector<std::unique_ptr<BoardCapture>>;

// Of boards that are as far as the slowest of them.
CaptureProgress sum_of(const Boards& boards) {
    CaptureProgress sum;
    bool first = true;
    for (const auto& board : boards) {
        const CaptureProgress one = board->progress();
        sum.device_s = first ? one.device_s : std::min(sum.device_s, one.device_s);
        sum.samples += one.samples;
        sum.samples_missing += one.samples_missing;
        sum.dropouts += one.dropouts;
        sum.frames_corrupted += one.frames_corrupted;
        sum.file_bytes += one.file_bytes;
        first = false;
    }
    return sum;
}

// The one that a script must hear of first.
ExitCode graver(ExitCode a, ExitCode b) {
    constexpr std::array order{ExitCode::ok,       ExitCode::data_lost, ExitCode::device_lost,
                               ExitCode::failed,   ExitCode::no_device, ExitCode::usage,
                               ExitCode::disk_full};
    // A signal that came before the end is no news beside any of these.
    const auto rank = [&](ExitCode code) {
        const auto place = std::ranges::find(order, code);
        if (place == order.end()) { return 1.0; }
        return code == ExitCode::ok ? 0.0 : 1.0 + static_cast<double>(place - order.begin());
    };
    return rank(a) > rank(b) ? a : b;
}

Result<Boards> open_all(const CaptureOptions& options, const std::vector<std::string>& devices,
                        const std::string& path) {
    GYROLOG_TRY(const CaptureRequest request, options.request());
    std::vector<OpenedSource> opened;
    std::vector<std::string> serials;
    opened.reserve(devices.size());
    serials.reserve(devices.size());
    for (const std::string& uri : devices) {
        GYROLOG_TRY(OpenedSource source, open_source(uri, {request.duration_s, request.samples}, false));
        serials.push_back(source.source->identity().serial);
        opened.push_back(std::move(source));
    }
    std::vector<std::string> files;
    files.reserve(devices.size());
    for (const std::string& uri : devices) { files.push_back(file_of_device(uri)); }
    std::vector<NamedPath> read;
    read.reserve(files.size());
    for (const std::string& file : files) { read.push_back({"--device", file}); }
    Boards boards;
    boards.reserve(opened.size());
    for (std::size_t i = 0; i < opened.size(); ++i) {
        const bool alone = !serials[i].empty() && std::ranges::count(serials, serials[i]) == 1;
        CaptureRequest own = request;
        own.path = path_of_board(path, serials[i], alone ? 0U : static_cast<unsigned>(i) + 1U);
        const NamedPath written[] = {{"--output", own.path}};
        GYROLOG_CHECK(check_output_paths(read, written));
        boards.push_back(std::make_unique<BoardCapture>(std::move(opened[i]), std::move(own)));
    }
    return boards;
}

void watch(Console& console, const Boards& boards) {
    LiveView view(console);
    std::vector<StallNotice> stalls(boards.size(), StallNotice(console));
    std::vector<SilenceNotice> silences(boards.size(), SilenceNotice(console, &view));
    std::vector<ParkingNotice> parkings(boards.size(), ParkingNotice(console, &view));
    const auto finished = [](const auto& board) { return board->finished(); };
    while (!std::ranges::all_of(boards, finished)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        if (console.stop_wanted()) {
            for (const auto& board : boards) { board->stop(); }
        }
        for (std::size_t i = 0; i < boards.size(); ++i) {
            const CaptureProgress progress = boards[i]->progress();
            stalls[i].tell(progress);
            silences[i].tell(progress);
            parkings[i].tell(progress);
        }
        view.show(sum_of(boards));
    }
    view.finish();
}

}  // namespace

ExitCode capture_boards(Console& console, const char* command, const CaptureOptions& options,
                        const std::vector<std::string>& devices, const std::string& path) {
    auto opened = open_all(options, devices, path);
    if (!opened.ok()) {
        report_error(console, command, opened.error());
        return exit_code_of_opening(opened.error());
    }
    const Boards boards = std::move(opened).value();
    for (const auto& board : boards) {
        console.notices() << "capturing from " << printable(board->source().identity().uri) << " to "
                          << printable(board->path()) << '\n';
        warn_of_former_id(console, command, board->source().identity());
    }
    const TidyEnd tidy;
    for (const auto& board : boards) { board->start(); }
    watch(console, boards);
    ExitCode code = ExitCode::ok;
    for (const auto& board : boards) {
        board->join();
        code = graver(code,
                      tell_outcome(console, command, board->outcome(), board->path(), board->limited()).code);
    }
    return code;
}

}  // namespace gyrolog
