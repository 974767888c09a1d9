#include "host/app/live_denoise.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/denoise/bandwidth_curve.hpp"
#include "host/app/denoise_knowledge.hpp"
#include "host/app/option_check.hpp"
#include "host/app/quantity.hpp"
#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/decode/recording_builder.hpp"
#include "host/formats/denoise_text.hpp"

namespace gyrolog {
namespace {

constexpr double rest_s = 10.0;           // that noise is learned from
constexpr double rest_rows_least = 80.0;  // of slow sensors
constexpr double patience = 6.0;          // times that, until it is given up
constexpr double rate_known_s = 2.0;      // of stamps, where nothing is learned
constexpr std::size_t batch_rows_most = std::size_t{1} << 16U;
constexpr std::int64_t flush_interval_ns = 1'000'000'000;
constexpr double longest_pause_s = 1e9;
constexpr double longest_pause_instants = 1e14;  // the same at 100 kHz: a broken clock may give any rate

// Gyros of which nothing is known, to try a model on.
Recording three_axes(double rate_hz) {
    Recording recording;
    recording.rate_hz = rate_hz;
    for (const char* name : {"gx", "gy", "gz"}) {
        recording.columns.push_back({name, "rad/s", std::vector<std::int16_t>(), 1.0});
    }
    return recording;
}

// Shared by what is learned at rest and what is known from a file.
Result<std::vector<AxisKnowledge>> knowledge_of_model(const Recording& recording, const std::string& path) {
    std::vector<AxisKnowledge> knowledge = know_units(recording, std::nullopt);
    GYROLOG_CHECK(use_model_files(knowledge, {path}, recording.rate_hz, SensorKind::gyro));
    return knowledge;
}

// Rows at sampling instants from `index` on, which follow what is there without a hole or behind one.
void append_segment(std::vector<Segment>& segments, std::size_t first, std::size_t count,
                    std::int64_t index) {
    if (!segments.empty()) {
        Segment& last = segments.back();
        if (last.first_index + static_cast<std::int64_t>(last.count) == index) {
            last.count += count;
            return;
        }
    }
    segments.push_back({first, count, index});
}

void append_rows(Recording& recording, const Recording& rows) {
    const std::size_t before = recording.rows();
    if (recording.columns.empty()) {
        recording.columns = rows.columns;
    } else {
        for (std::size_t i = 0; i < rows.columns.size(); ++i) {
            auto& to = std::get<std::vector<std::int16_t>>(recording.columns[i].data);
            const auto& from = std::get<std::vector<std::int16_t>>(rows.columns[i].data);
            to.insert(to.end(), from.begin(), from.end());
        }
    }
    for (const Segment& segment : rows.segments) {
        append_segment(recording.segments, before + segment.first, segment.count, segment.first_index);
    }
}

// Short enough to be written out exactly.
double rounded(double value) { return std::stod(fmt::format("{:.9g}", value)); }

}  // namespace

void LiveDenoiseOptions::declare(CLI::App& app) {
    app.add_option("--denoise", choice.method,
                   "Write the rates denoised, too, as they come: kalman, wavelet or joint, as `gyrolog "
                   "denoise --method`; without --denoise-model the board must rest for the first 10 s")
        ->check(CLI::IsMember({"kalman", "wavelet", "joint"}));
    app.add_option("--denoise-out", output, "Where to; without it beside the capture, as NAME.denoised.csv")
        ->type_name("FILE.csv");
    app.add_option("--denoise-model", model,
                   "The gyros' noise (gyrolog-model/1, as analyze writes it), in place of what is learned")
        ->type_name("FILE");
    app.add_option("--bandwidth", choice.bandwidth_hz,
                   "Of --denoise: of the rate that passes the Kalman filter")
        ->type_name("HZ")
        ->check(number_from_to(1e-6, 1e7, "Hz"));
}

Status LiveDenoiseOptions::check(std::optional<double> rate_hz) const {
    if (!wanted()) {
        if (output.empty() && model.empty() && !choice.bandwidth_hz) { return {}; }
        return invalid_argument(
            "--denoise-out, --denoise-model and --bandwidth are of --denoise: add --denoise METHOD");
    }
    constexpr double any_rate_hz = 1e9;
    const auto design = design_of(choice, rate_hz.value_or(any_rate_hz));
    return design.ok() ? Status() : design.error();
}

std::string LiveDenoiseOptions::output_of(const std::string& capture_path) const {
    if (!output.empty()) { return output; }
    const std::string ending = ".pcapng";
    const std::size_t stem = capture_path.size() - (capture_path.ends_with(ending) ? ending.size() : 0);
    return capture_path.substr(0, stem) + ".denoised.csv";
}

RecentSpread::RecentSpread(double rate_hz) : second_samples_(std::max(1.0, rate_hz)) {}

void RecentSpread::take(double value) {
    if (!origin_) { origin_ = value; }
    if (seconds_[present_].count >= second_samples_) {
        present_ = (present_ + 1) % seconds_.size();
        seconds_[present_] = {};
    }
    Sums& sums = seconds_[present_];
    const double distance = value - *origin_;
    sums.count += 1.0;
    sums.sum += distance;
    sums.squares += distance * distance;
}

double RecentSpread::sd() const {
    Sums all;
    for (const Sums& sums : seconds_) {
        all.count += sums.count;
        all.sum += sums.sum;
        all.squares += sums.squares;
    }
    if (all.count < 2.0) { return 0.0; }
    return std::sqrt(std::max(0.0, all.squares - all.sum * all.sum / all.count) / (all.count - 1.0));
}

Result<std::unique_ptr<LiveDenoise>> LiveDenoise::create(Setup setup) {
    std::error_code none;
    const auto there = std::filesystem::status(setup.output, none);
    const bool special = std::filesystem::exists(there) && !std::filesystem::is_regular_file(there);
    if (!special && !setup.output.ends_with(".csv")) {
        return invalid_argument("--denoise-out '" + setup.output +
                                "': it is text that grows; end its name in .csv");
    }
    if (std::filesystem::is_regular_file(there) && !setup.overwrite) {
        return Error{ErrorCode::failed,
                     "'" + setup.output + "' exists; --force replaces it, --denoise-out names another"};
    }
    if (!setup.options.model.empty()) {
        constexpr double any_rate_hz = 100.0;
        const auto tried = knowledge_of_model(three_axes(any_rate_hz), setup.options.model);
        if (!tried.ok()) { return in_context("--denoise-model", Error(tried.error())); }
    }
    CsvWriteOptions options;
    options.resolved = {"gx", "gy", "gz"};
    options.growth = TextGrowth::growing;
    GYROLOG_TRY(RecordingCsvWriter writer, RecordingCsvWriter::create(setup.output, options));
    auto live = std::make_unique<LiveDenoise>(std::move(setup));
    live->writer_ = std::make_unique<RecordingCsvWriter>(std::move(writer));
    live->thread_ = std::thread([&denoise = *live] { denoise.run(); });
    return live;
}

LiveDenoise::LiveDenoise(Setup setup) : setup_(std::move(setup)) {}

LiveDenoise::~LiveDenoise() { static_cast<void>(finish()); }

// The writer's thread ---------------------------------------------------------------------------------------

void LiveDenoise::on_start() {
    const std::lock_guard lock(mutex_);
    if (!config_) { return; }
    config_.reset();
    pending_ = {};
    pending_.begins_anew = true;
    rate_hz_.reset();
    samples_seen_ = 0;
}

void LiveDenoise::begin(const glp_samples& samples, const glp_config& config) {
    config_ = config;
    layout_ = samples.layout;
    run_ = decoder_->run();
    run_first_ = samples.first_index;
    run_grid_ = 0;
    grid_end_ = 0;
    const auto design = design_of(setup_.options.choice, config.rate_mHz * 1e-3);
    if (!design.ok()) { stop("nothing is denoised: " + design.error().message); }
}

void LiveDenoise::stop(std::string why) {
    notices_.push_back(why + "; the capture goes on");
    stopped_ = Error{ErrorCode::failed, std::move(why)};
}

// As RecordingBuilder lays the grid: within a run by the board's numbers, between runs by the clocks.
std::int64_t LiveDenoise::place(const glp_samples& samples) const {
    if (decoder_->run() == run_) {
        return run_grid_ + static_cast<std::int64_t>(samples.first_index - run_first_);
    }
    const SampleTimeline& timeline = decoder_->timeline();
    double rate_hz = rate_hz_.value_or(config_->rate_mHz * 1e-3);
    if (const auto estimate = timeline.rate(run_, run_); !rate_hz_ && estimate) {
        rate_hz = estimate->rate_hz;
    }
    const std::uint64_t end_index = run_first_ + static_cast<std::uint64_t>(grid_end_ - run_grid_);
    const auto from_s = timeline.device_time_s(run_, end_index, rate_hz);
    const auto to_s = timeline.device_time_s(decoder_->run(), samples.first_index, rate_hz);
    if (!from_s || !to_s) { return grid_end_; }
    const double pause_s = std::clamp(*to_s - *from_s, 0.0, longest_pause_s);
    return grid_end_ + std::llround(std::min(pause_s * rate_hz, longest_pause_instants));
}

void LiveDenoise::append(const glp_samples& samples, std::int64_t index) {
    Recording& rows = pending_.rows;
    if (rows.columns.empty()) { rows.columns = sample_columns(layout_, *config_); }
    const std::size_t first = rows.rows();
    append_samples(rows.columns, samples);
    append_segment(rows.segments, first, samples.count, index);
}

bool LiveDenoise::wait_for_room(std::unique_lock<std::mutex>& lock, std::size_t samples) {
    const auto has_room = [&](std::size_t most) { return pending_.rows.rows() + samples <= most || failed_; };
    if (setup_.source_waits) {
        room_.wait(lock, [&] { return has_room(batch_rows_most); });
    } else if (!has_room(setup_.rows_waiting_most)) {
        samples_dropped_ += samples;
        return false;
    }
    return !failed_;
}

void LiveDenoise::on_samples(const glp_frame& /*frame*/, const glp_samples& samples,
                             const glp_config& config) {
    const bool known = config.rate_mHz > 0 && config.generation == samples.config_generation;
    if ((samples.layout & glp_layout_gyro) == 0 || !known || samples.count == 0) { return; }
    std::unique_lock lock(mutex_);
    if (failed_ || stopped_) { return; }
    if (!config_) { begin(samples, config); }
    if (stopped_) { return; }
    if (layout_ != samples.layout || !same_setting(*config_, config)) {
        stop("the board's configuration changed, and a text has one: '" + setup_.output + "' ends there");
        return;
    }
    const std::int64_t index = std::max(place(samples), grid_end_);
    if (decoder_->run() != run_) {
        run_ = decoder_->run();
        run_first_ = samples.first_index;
        run_grid_ = index;
    }
    grid_end_ = index + static_cast<std::int64_t>(samples.count);
    if (!wait_for_room(lock, samples.count)) { return; }
    append(samples, index);
    samples_seen_ += samples.count;
    const double wanted_s = setup_.options.model.empty() ? rest_s : rate_known_s;
    const double nominal_hz = config.rate_mHz * 1e-3;
    const double wanted = std::max(rest_rows_least, wanted_s * nominal_hz);
    if (!rate_hz_ && static_cast<double>(samples_seen_) >= wanted) {
        rate_hz_ = rounded(decoder_->rate_hz().value_or(nominal_hz));
    }
    more_.notify_one();
}

// The denoising thread --------------------------------------------------------------------------------------

void LiveDenoise::run() {
    while (true) {
        Batch batch = next_batch();
        const bool last = batch.last;
        if (const Status taken = take(std::move(batch)); !taken.ok()) { fail(taken.error()); }
        if (last) { return; }
    }
}

LiveDenoise::Batch LiveDenoise::next_batch() {
    std::unique_lock lock(mutex_);
    more_.wait_for(lock, std::chrono::nanoseconds(flush_interval_ns),
                   [&] { return ended_ || pending_.begins_anew || !pending_.rows.columns.empty(); });
    Batch batch = std::exchange(pending_, {});
    batch.rate_hz = rate_hz_;
    // A capture that ends at once has no better.
    if (ended_ && !batch.rate_hz && config_) { batch.rate_hz = config_->rate_mHz * 1e-3; }
    batch.last = ended_;
    room_.notify_all();
    return batch;
}

Status LiveDenoise::take(Batch batch) {
    {
        const std::lock_guard lock(mutex_);
        if (failed_) { return {}; }
    }
    if (batch.begins_anew) {
        gathered_ = {};
        next_look_ = 0;
        if (!denoisers_.empty()) {
            return Error{ErrorCode::failed,
                         "the board was started anew after it had been denoised for a "
                         "while; begin the capture again"};
        }
    }
    if (denoisers_.empty()) {
        if (!batch.rows.columns.empty()) { append_rows(gathered_, batch.rows); }
        if (!batch.rate_hz || gathered_.columns.empty()) { return {}; }
        gathered_.rate_hz = *batch.rate_hz;
        return try_to_start(batch.last);
    }
    if (!batch.rows.columns.empty()) {
        batch.rows.rate_hz = gathered_.rate_hz;
        GYROLOG_CHECK(denoise_rows(batch.rows));
    }
    return flush_now_and_then();
}

Status LiveDenoise::try_to_start(bool last) {
    if (!setup_.options.model.empty()) {
        GYROLOG_TRY(std::vector<AxisKnowledge> knowledge,
                    knowledge_of_model(gathered_, setup_.options.model));
        again_ = "--model " + setup_.options.model;
        return start(std::move(knowledge), "of " + setup_.options.model);
    }
    GYROLOG_TRY(const std::optional<TimeSpan> still, find_rest(last));
    if (!still) { return {}; }
    GYROLOG_TRY(const Recording rows, rows_at_rest(gathered_, *still));
    std::vector<AxisKnowledge> knowledge = learn_units(rows, std::nullopt);
    for (const AxisKnowledge& axis : knowledge) {
        if (axis.units.front().variance > 0.0) { continue; }
        say("warning: g" + axis.axis + " does not change at rest: its noise is not known");
    }
    again_ = fmt::format("--still {},{}", still->from_s, still->to_s);
    return start(std::move(knowledge),
                 fmt::format("of {:.6g} s to {:.6g} s, at rest", still->from_s, still->to_s));
}

// Looks at the same rows whenever they are handed over, so that the same stream gives the same knowledge.
Result<std::optional<TimeSpan>> LiveDenoise::find_rest(bool last) {
    const double wanted_s = std::max(rest_s, rest_rows_least / gathered_.rate_hz);
    const auto wanted = static_cast<std::size_t>(std::ceil(wanted_s * gathered_.rate_hz));
    constexpr double enough = 0.9;  // it is found in whole blocks
    if (next_look_ == 0) { next_look_ = wanted; }
    while (next_look_ <= gathered_.rows()) {
        TimeSpan still = still_part_of(first_rows(gathered_, next_look_));
        still = {rounded(still.from_s), rounded(still.to_s)};
        if (still.to_s - still.from_s >= enough * wanted_s) { return std::optional(still); }
        if (!std::exchange(said_moving_, true)) {
            say(fmt::format(
                "the board does not rest: denoising waits until it has for {:.3g} s, for {:.3g} s "
                "at most",
                wanted_s, patience * wanted_s));
        }
        if (static_cast<double>(next_look_) >= patience * wanted_s * gathered_.rate_hz) {
            return Error{
                ErrorCode::failed,
                fmt::format("the board did not rest for {:.3g} s in its first {:.3g} s, so its noise "
                            "could not be learned; nothing is denoised. Give --denoise-model, or run "
                            "`gyrolog denoise {} -o {}` afterwards, with a recording at rest as "
                            "--calibration",
                            wanted_s, patience * wanted_s, setup_.capture, setup_.output)};
        }
        next_look_ += std::max<std::size_t>(1, wanted / 10);
    }
    if (!last) { return std::optional<TimeSpan>(); }
    return Error{
        ErrorCode::failed,
        fmt::format("the capture ended before the board had rested for {:.3g} s, so its noise could "
                    "not be learned; nothing is denoised. Give --denoise-model, or capture for longer",
                    wanted_s)};
}

Status LiveDenoise::start(std::vector<AxisKnowledge> knowledge, const std::string& learned_from) {
    GYROLOG_TRY(const DenoiseDesign design, design_of(setup_.options.choice, gathered_.rate_hz));
    double lag_s = 0.0;
    for (const AxisKnowledge& axis : knowledge) {
        denoisers_.emplace_back(axis, design);
        before_.emplace_back(gathered_.rate_hz);
        after_.emplace_back(gathered_.rate_hz);
        const double axis_lag_s = filter_response(axis.noise, design).lag_s;
        constexpr double none_s = 5e-7;
        if (std::abs(axis_lag_s) >= none_s) { lag_s = std::max(lag_s, axis_lag_s); }
    }
    say(fmt::format("denoised from the first sample on; noise {}; {}; lag {:.3g} ms", learned_from,
                    design_text(design), 1e3 * lag_s));
    if (design.method == DenoiseMethod::kalman && design.rate.model == RateModel::free) {
        say("one gyro an axis and no --bandwidth: kalman has nothing to combine and gives the rates as they "
            "are; wavelet, joint or a bandwidth take noise out");
    }
    again_ = fmt::format("--method {}{} --rate {} {}", setup_.options.choice.method,
                         setup_.options.choice.bandwidth_hz
                             ? fmt::format(" --bandwidth {}", *setup_.options.choice.bandwidth_hz)
                             : "",
                         gathered_.rate_hz, again_);
    {
        const std::lock_guard lock(mutex_);
        design_text_ = setup_.options.choice.method;
        lag_s_ = lag_s;
    }
    const Recording rows = std::exchange(gathered_, Recording{});
    gathered_.rate_hz = rows.rate_hz;
    return denoise_rows(rows);
}

Status LiveDenoise::denoise_rows(const Recording& rows) {
    const std::vector<ArrayAxis> columns = array_axes(rows);
    std::vector<AxisDenoising> axes(columns.size());
    std::vector<Spread> spreads;
    spreads.reserve(columns.size());
    for (std::size_t a = 0; a < columns.size(); ++a) {
        std::vector<double>& rate = axes[a].signals.emplace_back().rate;
        rate.resize(rows.rows());
        for (const Segment& segment : rows.segments) {
            for (std::size_t i = 0; i < segment.count; ++i) {
                const std::size_t row = segment.first + i;
                rate[row] =
                    denoisers_[a].step(segment.first_index + static_cast<std::int64_t>(i), columns[a], row);
                before_[a].take(columns[a].units.front()->value(row));
                after_[a].take(rate[row]);
            }
        }
        spreads.push_back({columns[a].name, before_[a].sd(), after_[a].sd()});
    }
    {
        const std::lock_guard lock(mutex_);
        spreads_ = std::move(spreads);
    }
    GYROLOG_CHECK(writer_->append(denoised_recording(rows, axes)));
    rows_written_ += rows.rows();
    return {};
}

Status LiveDenoise::flush_now_and_then() {
    const std::int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
    if (now_ns - last_flush_ns_ < flush_interval_ns) { return {}; }
    last_flush_ns_ = now_ns;
    return writer_->flush();
}

void LiveDenoise::fail(const Error& error) {
    const std::lock_guard lock(mutex_);
    failed_ = error;
    pending_ = {};
    if (!ended_) {
        notices_.push_back("not denoised any further: " + error.message + "; the capture goes on");
    }
    room_.notify_all();
}

// What is said ----------------------------------------------------------------------------------------------

void LiveDenoise::say(std::string text) {
    const std::lock_guard lock(mutex_);
    notices_.push_back(std::move(text));
}

std::vector<std::string> LiveDenoise::take_notices() {
    const std::lock_guard lock(mutex_);
    return std::exchange(notices_, {});
}

std::string LiveDenoise::announcement() const {
    if (!setup_.options.model.empty()) {
        return fmt::format("denoising by {} into {}, with the noise of {}", setup_.options.choice.method,
                           setup_.output, setup_.options.model);
    }
    return fmt::format(
        "denoising by {} into {}: leave the board at rest for the first {:g} s, from which its "
        "noise is learned",
        setup_.options.choice.method, setup_.output, rest_s);
}

std::string LiveDenoise::line() const {
    const std::lock_guard lock(mutex_);
    if (failed_) { return "not denoised any further"; }
    if (spreads_.empty()) { return setup_.options.choice.method + ": learning the noise at rest"; }
    std::string text = design_text_;
    for (const Spread& spread : spreads_) {
        text += fmt::format(" {} {:.2g}→{:.2g}", spread.axis, spread.before * deg_per_rad,
                            spread.after * deg_per_rad);
    }
    return text + fmt::format(" °/s (sd, 5 s), lag {:.3g} ms", 1e3 * lag_s_);
}

Result<std::string> LiveDenoise::finish() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
        more_.notify_one();
    }
    if (thread_.joinable()) { thread_.join(); }
    if (!writer_) { return std::string(); }
    Status closed = writer_->close();
    writer_.reset();  // of a file without a row nothing stays, and an earlier one is as it was
    if (failed_) { return *failed_; }
    if (stopped_) { return *stopped_; }
    if (!closed.ok()) { return closed.error(); }
    if (rows_written_ == 0) { return Error{ErrorCode::failed, "no sample came: nothing is denoised"}; }
    if (samples_dropped_ > 0) {
        return Error{ErrorCode::failed,
                     fmt::format("{} samples found no room while they waited to be denoised: they are "
                                 "missing in {}; run `gyrolog denoise {} {}`",
                                 samples_dropped_, setup_.output, shell_word(setup_.capture), again_)};
    }
    return fmt::format("{}: {} samples, {}; the same afterwards: gyrolog denoise {} {}",
                       printable(setup_.output), format_count(rows_written_), line(),
                       shell_word(setup_.capture), again_);
}

}  // namespace gyrolog
