#include "host/decode/recording_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "analysis/recording/standard_gravity.hpp"
#include "firmware_protocol/device/mpu9250.h"

namespace gyrolog {
namespace {

constexpr double rate_tolerance = 0.03;  // the sensor's clock is good to 1 %
constexpr double longest_pause_s = 1e9;
constexpr double longest_pause_instants = 1e14;  // the same at 100 kHz: a broken clock may give any rate
constexpr std::uint64_t most_rows_ahead = std::uint64_t{1} << 26U;  // a file's size may be a claim only

std::int16_t number_at(const std::uint8_t* bytes) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[0] | (bytes[1] << 8U)));
}

void append_field(std::vector<std::int16_t>& column, const std::uint8_t* bytes, std::size_t count,
                  std::size_t stride) {
    const std::size_t rows = column.size();
    column.resize(rows + count);
    std::int16_t* out = column.data() + rows;
    for (std::size_t i = 0; i < count; ++i, bytes += stride) { out[i] = number_at(bytes); }
}

// Of a sample; the accelerometer's follow the gyro's.
constexpr std::size_t fields_of_sensor = 3;

struct Quantity {
    const char* name;
    const char* unit;
    double scale;
    double offset;
    double bandwidth_hz;
};

constexpr std::size_t accel_config2 = 4;  // among glp_config's registers

std::vector<Quantity> quantities(std::uint8_t layout, const glp_config& config) {
    const double rad_s = config.gyro_ndps_per_lsb * 1e-9 * std::numbers::pi / 180.0;
    const double m_s2 = config.accel_pg_per_lsb * 1e-12 * standard_gravity_m_s2;
    std::vector<Quantity> all;
    if ((layout & glp_layout_gyro) != 0) {
        for (const char* name : {"gx", "gy", "gz"}) {
            all.push_back({name, "rad/s", rad_s, 0.0, static_cast<double>(config.dlpf_hz)});
        }
    }
    if ((layout & glp_layout_accel) != 0) {
        const double accelerometer_hz = glp_mpu_accel_bandwidth_hz(config.registers[accel_config2]);
        for (const char* name : {"ax", "ay", "az"}) {
            all.push_back({name, "m/s^2", m_s2, 0.0, accelerometer_hz});
        }
    }
    all.push_back({"temp", "degC", config.temp_nC_per_lsb * 1e-9, config.temp_offset_mC * 1e-3, 0.0});
    return all;
}

}  // namespace

bool same_setting(const glp_config& a, const glp_config& b) {
    return a.layout == b.layout && a.rate_mHz == b.rate_mHz && a.decimation == b.decimation &&
           a.gyro_full_scale_dps == b.gyro_full_scale_dps && a.accel_full_scale_g == b.accel_full_scale_g &&
           a.dlpf_hz == b.dlpf_hz && a.gyro_ndps_per_lsb == b.gyro_ndps_per_lsb &&
           a.accel_pg_per_lsb == b.accel_pg_per_lsb && a.temp_nC_per_lsb == b.temp_nC_per_lsb &&
           a.temp_offset_mC == b.temp_offset_mC &&
           std::memcmp(a.registers, b.registers, sizeof(a.registers)) == 0;
}

std::vector<Column> sample_columns(std::uint8_t layout, const glp_config& config) {
    std::vector<Column> columns;
    for (const Quantity& quantity : quantities(layout, config)) {
        columns.push_back({quantity.name, quantity.unit, std::vector<std::int16_t>(), quantity.scale,
                           quantity.offset, "", quantity.bandwidth_hz});
    }
    return columns;
}

void append_samples(std::vector<Column>& columns, const glp_samples& samples) {
    const std::size_t stride = glp_sample_bytes(samples.layout);
    for (std::size_t field = 0; field < stride / 2; ++field) {
        append_field(std::get<std::vector<std::int16_t>>(columns[field].data), samples.samples + 2 * field,
                     samples.count, stride);
    }
    if ((samples.layout & glp_layout_temperature) != 0) { return; }
    auto& temperature = std::get<std::vector<std::int16_t>>(columns.back().data);
    temperature.insert(temperature.end(), samples.count, samples.temperature);
}

void RecordingBuilder::take_config(std::uint32_t boot, const glp_config& config) {
    config_ = config;
    config_boot_ = boot;
    // A stream that was joined in its middle tells the configuration of its first samples afterwards.
    if (!current_.config && current_.boot == boot && current_.generation == config.generation) {
        current_.config = config;
    }
}

const glp_config* RecordingBuilder::config_of(const SamplePlace& place, const glp_samples& samples) const {
    const bool known =
        config_ && config_boot_ == place.boot && config_->generation == samples.config_generation;
    return known ? &*config_ : nullptr;
}

bool RecordingBuilder::belongs(const SamplePlace& place, const glp_samples& samples) const {
    if (!current_.begun() || current_.layout != samples.layout) { return false; }
    const glp_config* config = config_of(place, samples);
    if (config != nullptr && current_.config) { return same_setting(*config, *current_.config); }
    return current_.boot == place.boot && current_.generation == samples.config_generation;
}

void RecordingBuilder::take_samples(const SamplePlace& place, const glp_samples& samples) {
    if (!belongs(place, samples)) {
        close();
        current_.layout = samples.layout;
    }
    current_.boot = place.boot;
    current_.generation = samples.config_generation;
    if (!current_.config) {
        if (const glp_config* config = config_of(place, samples)) { current_.config = *config; }
    }
    if (samples_per_row_ > 1) {
        append_means(place, samples);
    } else {
        append(place, samples);
    }
}

bool RecordingBuilder::keeps(std::uint8_t layout, std::size_t field) const {
    if (with_accelerometer_ || (layout & glp_layout_accel) == 0) { return true; }
    const std::size_t first = (layout & glp_layout_gyro) != 0 ? fields_of_sensor : 0;
    return field < first || field >= first + fields_of_sensor;
}

void RecordingBuilder::append(const SamplePlace& place, const glp_samples& samples) {
    const std::size_t stride = glp_sample_bytes(samples.layout);
    const std::size_t fields = stride / 2;
    if (current_.rows == 0) {
        const auto rows = std::min<std::uint64_t>(bytes_to_come_ / stride, most_rows_ahead);
        for (std::size_t field = 0; field < fields_max; ++field) {
            if (keeps(samples.layout, field)) { current_.fields[field].reserve(rows); }
        }
    }
    bytes_to_come_ -= std::min<std::uint64_t>(bytes_to_come_, samples.count * stride);
    for (std::size_t field = 0; field < fields; ++field) {
        if (!keeps(samples.layout, field)) { continue; }
        append_field(current_.fields[field], samples.samples + 2 * field, samples.count, stride);
    }
    if ((samples.layout & glp_layout_temperature) == 0) {
        std::vector<std::int16_t>& column = current_.fields[fields];
        column.insert(column.end(), samples.count, samples.temperature);
    }

    enter_rows(place, samples.first_index, samples.count);
}

void RecordingBuilder::enter_rows(const SamplePlace& place, std::uint64_t first_index, std::size_t rows) {
    std::vector<Piece>& pieces = current_.pieces;
    if (!pieces.empty() && pieces.back().run == place.run &&
        first_index - pieces.back().first_index == pieces.back().count * samples_per_row_) {
        pieces.back().count += rows;
    } else {
        pieces.push_back({place.boot, place.run, first_index, current_.rows, rows});
    }
    current_.rows += rows;
}

void RecordingBuilder::append_means(const SamplePlace& place, const glp_samples& samples) {
    Unfinished& row = current_.unfinished;
    const bool has_own_temperature = (samples.layout & glp_layout_temperature) != 0;
    const std::size_t fields = glp_sample_bytes(samples.layout) / 2;
    const std::size_t columns = fields + (has_own_temperature ? 0 : 1);
    if (row.run != place.run || row.next_index == 0) { row = {place.run, samples.first_index, 0, 0, {}}; }
    const std::uint8_t* bytes = samples.samples;
    for (std::size_t i = 0; i < samples.count; ++i) {
        const std::uint64_t index = samples.first_index + i;
        const std::size_t before = static_cast<std::size_t>((index - row.run_begin) % samples_per_row_);
        if (before == 0 || index != row.next_index) { row.samples = 0, row.sums = {}; }
        row.next_index = index + 1;
        for (std::size_t field = 0; field < fields; ++field, bytes += 2) {
            row.sums[field] += static_cast<double>(number_at(bytes));
        }
        if (!has_own_temperature) { row.sums[fields] += static_cast<double>(samples.temperature); }
        // Of a row whose beginning is missing the rest counts for nothing.
        if (++row.samples != before + 1 || row.samples != samples_per_row_) { continue; }
        for (std::size_t column = 0; column < columns; ++column) {
            if (!keeps(samples.layout, column)) { continue; }
            current_.means[column].push_back(row.sums[column] / static_cast<double>(samples_per_row_));
        }
        enter_rows(place, index + 1 - samples_per_row_, 1);
    }
}

void RecordingBuilder::close() {
    if (!current_.config) {
        without_config_ += current_.rows;
    } else if (current_.rows > longest_.rows) {
        left_out_ += longest_.rows;
        longest_ = std::move(current_);
    } else {
        left_out_ += current_.rows;
    }
    current_ = Stretch{};
}

// Consecutive runs share their grid when the board's indices go on, and are otherwise set apart by the
// clocks.
std::vector<RecordingBuilder::RunOrigin> RecordingBuilder::place_on_grid(const std::vector<Piece>& pieces,
                                                                         const SampleTimeline& timeline,
                                                                         Recording& recording) const {
    const auto samples_of = [&](std::size_t rows) {
        return static_cast<std::int64_t>(rows * samples_per_row_);
    };
    std::vector<RunOrigin> origins;
    for (const Piece& piece : pieces) {
        if (origins.empty()) {
            origins.push_back({piece.run, piece.first_index, 0});
        } else if (origins.back().run != piece.run) {
            const RunOrigin& before = origins.back();
            const Segment& last = recording.segments.back();
            const std::int64_t end = last.first_index + samples_of(last.count);
            const std::uint64_t end_index =
                before.first_index + static_cast<std::uint64_t>(end - before.grid);
            const auto from = timeline.device_time_s(before.run, end_index, recording.rate_hz);
            const auto to = timeline.device_time_s(piece.run, piece.first_index, recording.rate_hz);
            std::int64_t grid = end;
            if (from && to) {
                const double pause_s = std::clamp(*to - *from, 0.0, longest_pause_s);
                grid += std::llround(std::min(pause_s * recording.rate_hz, longest_pause_instants));
                // Numbers go on where the clock jumps: the board counted no loss, only its clock tells of it.
                if (grid > end && piece.first_index == end_index) {
                    recording.dropouts.push_back(
                        {static_cast<double>(end) / recording.rate_hz, grid - end, "time_stamps"});
                }
            } else {
                recording.warnings.emplace_back(
                    "the pause before a restart is not known: joined without one");
            }
            origins.push_back({piece.run, piece.first_index, grid});
        }
        recording.segments.push_back(
            {piece.first, piece.count, origins.back().grid_index(piece.first_index)});
    }
    return origins;
}

void RecordingBuilder::count_in_rows(Recording& recording) const {
    if (samples_per_row_ == 1) { return; }
    const auto samples = static_cast<double>(samples_per_row_);
    // The rows of a later run lie anywhere between those of the first: at the nearest place.
    std::int64_t end = 0;
    for (Segment& segment : recording.segments) {
        segment.first_index =
            std::max<std::int64_t>(end, std::llround(static_cast<double>(segment.first_index) / samples));
        end = segment.first_index + static_cast<std::int64_t>(segment.count);
    }
    recording.rate_hz /= samples;
    if (recording.nominal_rate_hz) { *recording.nominal_rate_hz /= samples; }
    if (recording.rate_sd_hz) { *recording.rate_sd_hz /= samples; }
    recording.stamp_jitter_s.reset();
    recording.stamps = StampKind::none;
    recording.samples_per_row = samples_per_row_;
}

// Where on the grid the run behind a join begins: with its first number, of which the first samples may be
// missing.
std::int64_t RecordingBuilder::begin_behind(const LinkReport& link, const RunOrigin& before,
                                            const RunOrigin& after) {
    const auto join = std::ranges::lower_bound(link.joins, before.run, {}, &LinkJoin::run_before);
    const bool known =
        join != link.joins.end() && join->run_before == before.run && join->run_after == after.run;
    return after.grid_index(known ? join->first_index : after.first_index);
}

void RecordingBuilder::enter_dropouts(const LinkReport& link, const std::vector<RunOrigin>& origins,
                                      Recording& recording) {
    const std::int64_t last = recording.segments.back().first_index;
    const auto enter = [&](const LinkDropout& dropout) {
        const auto origin =
            std::lower_bound(origins.begin(), origins.end(), dropout.run,
                             [](const RunOrigin& o, std::uint32_t run) { return o.run < run; });
        if (origin == origins.end() || origin->run != dropout.run) { return; }
        const std::int64_t at = origin->grid_index(dropout.first_index);
        if (at <= 0 || at > last) { return; }
        auto samples = static_cast<std::int64_t>(dropout.samples);
        const bool join = dropout.cause == DropoutCause::unplugged || dropout.cause == DropoutCause::reset ||
                          dropout.cause == DropoutCause::stopped;
        // The grid is laid with the rate of the whole recording, the account with that of the run before.
        if (join && std::next(origin) != origins.end()) {
            samples = std::max<std::int64_t>(begin_behind(link, *origin, *std::next(origin)) - at, 0);
        }
        recording.dropouts.push_back({static_cast<double>(at) / recording.rate_hz, samples,
                                      std::string(dropout_cause_name(dropout.cause))});
    };
    std::ranges::for_each(link.dropouts, enter);
    std::ranges::for_each(link.stops, enter);
    std::ranges::stable_sort(recording.dropouts, {}, &Dropout::at_s);
    if (link.dropouts_unlisted > 0) {
        recording.warnings.push_back(std::to_string(link.dropouts_unlisted) +
                                     " more dropouts are counted but not listed");
    }
}

// What a board says that contradicts itself, and clocks that do, leave dropouts that are not the holes.
void RecordingBuilder::fit_dropouts_to_holes(const LinkReport& link, Recording& recording) {
    const auto instant = [&](const Dropout& dropout) {
        return static_cast<std::int64_t>(std::llround(dropout.at_s * recording.rate_hz));
    };
    std::vector<Dropout> fitted;
    bool differ = false;
    auto next = recording.dropouts.cbegin();
    for (std::size_t i = 1; i < recording.segments.size(); ++i) {
        const Segment& before = recording.segments[i - 1];
        const std::int64_t begin = before.first_index + static_cast<std::int64_t>(before.count);
        const std::int64_t end = recording.segments[i].first_index;
        std::int64_t left = end - begin;
        for (; next != recording.dropouts.cend() && instant(*next) <= end; ++next) {
            const bool inside = instant(*next) >= begin;
            const std::int64_t samples = inside ? std::min(next->samples, left) : 0;
            differ = differ || samples != next->samples;
            if (samples == 0 && (!inside || next->samples > 0)) { continue; }
            fitted.push_back(*next);
            fitted.back().samples = samples;
            left -= samples;
        }
        if (left == 0 || link.dropouts_unlisted > 0) { continue; }
        differ = true;
        fitted.push_back({static_cast<double>(end - left) / recording.rate_hz, left, "time_stamps"});
    }
    differ = differ || next != recording.dropouts.cend();
    if (!differ) { return; }
    recording.dropouts = std::move(fitted);
    recording.warnings.emplace_back(
        "what is told of dropouts does not add up to the holes between the samples: the holes count");
}

void RecordingBuilder::set_rate(const Stretch& stretch, const SampleTimeline& timeline,
                                Recording& recording) {
    const double nominal_hz = stretch.config->rate_mHz * 1e-3;
    recording.nominal_rate_hz = nominal_hz;
    recording.rate_hz = nominal_hz;
    const auto estimate = timeline.rate(stretch.pieces.front().run, stretch.pieces.back().run);
    if (!estimate) {
        recording.warnings.emplace_back(
            "too few time stamps, or no HELLO with their unit: the rate is the nominal one");
        return;
    }
    recording.rate_hz = estimate->rate_hz;
    recording.rate_sd_hz = estimate->sd_hz;
    recording.stamp_jitter_s = estimate->jitter_s;
    recording.stamps = StampKind::sampling;
    if (std::abs(estimate->rate_hz - nominal_hz) > rate_tolerance * nominal_hz) {
        recording.warnings.push_back("the stamps give " + std::to_string(estimate->rate_hz) +
                                     " Hz, the board says " + std::to_string(nominal_hz) + " Hz");
    }
}

Result<Recording> RecordingBuilder::finish(std::string name, const SampleTimeline& timeline,
                                           const LinkReport& link) {
    close();
    RecordingBuilder taken = std::exchange(*this, RecordingBuilder(0, samples_per_row_, with_accelerometer_));
    Stretch& stretch = taken.longest_;
    if (stretch.rows == 0) {
        return Error{ErrorCode::malformed, taken.without_config_ > 0
                                               ? "the stream never tells the configuration of its samples"
                                               : "the stream holds no samples"};
    }

    Recording recording;
    recording.name = std::move(name);
    set_rate(stretch, timeline, recording);
    if (recording.rate_hz <= 0.0) { return Error{ErrorCode::malformed, "the board says that its rate is 0"}; }
    enter_dropouts(link, place_on_grid(stretch.pieces, timeline, recording), recording);
    if (samples_per_row_ == 1) { fit_dropouts_to_holes(link, recording); }
    const Piece& first = stretch.pieces.front();
    const auto device_s = timeline.device_time_s(first.run, first.first_index, recording.rate_hz);
    const auto clock = timeline.host_clock();
    if (device_s && clock) { host_start_s_ = clock->offset_s + clock->ratio * *device_s; }
    std::size_t next_field = 0;
    for (const Quantity& quantity : quantities(stretch.layout, *stretch.config)) {
        const std::size_t field = next_field++;
        if (!keeps(stretch.layout, field)) { continue; }
        Column column{quantity.name,        quantity.unit, {}, quantity.scale, quantity.offset, "",
                      quantity.bandwidth_hz};
        if (samples_per_row_ > 1) {
            column.data = std::move(stretch.means[field]);
        } else {
            column.data = std::move(stretch.fields[field]);
        }
        recording.columns.push_back(std::move(column));
    }
    count_in_rows(recording);
    if (stretch.config->decimation > 1) {
        recording.warnings.push_back("the board took one sample of " +
                                     std::to_string(stretch.config->decimation) +
                                     " without a filter: faster noise is folded in");
    }
    if (stretch.pieces.front().boot != stretch.pieces.back().boot) {
        recording.warnings.emplace_back("the board was reset: the pause is known by the host's clock only");
    }
    if (taken.left_out_ > 0) {
        recording.warnings.push_back(std::to_string(taken.left_out_ * samples_per_row_) +
                                     " samples of other configurations are left out");
    }
    if (taken.without_config_ > 0) {
        recording.warnings.push_back(std::to_string(taken.without_config_ * samples_per_row_) +
                                     " samples whose configuration was never told are left out");
    }
    return recording;
}

}  // namespace gyrolog
