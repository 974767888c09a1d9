#include "analysis/simulate/recording_simulator.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/noise/sensor_columns.hpp"
#include "analysis/recording/grid.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/force_world.hpp"
#include "analysis/simulate/recorded_orientation.hpp"
#include "analysis/simulate/resting_accelerometer.hpp"

namespace gyrolog {

namespace {

std::uint64_t slots_of(const Recording& recording) {
    return recording.rows() == 0 ? 0
                                 : static_cast<std::uint64_t>(recording.missing_samples()) + recording.rows();
}

bool is_gyro(const Column& column) { return column.name.starts_with('g'); }

bool poses_accelerometer(const SimulationRequest& request) {
    return request.accelerometer_in_poses && request.like && has_orientation(request.like->recording()) &&
           std::ranges::none_of(request.like->recording().columns, [](const Column& column) {
               return is_of(SensorKind::accelerometer, column);
           });
}

std::shared_ptr<const World> world_of_poses(const Recording& like) {
    return std::make_shared<const ForceWorld>(
        std::make_shared<const RecordedWorld>(std::make_shared<const Recording>(with_force_at_rest(like))));
}

double nanoseconds(double t_s) { return std::floor(t_s * 1e9 + 0.5) / 1e9; }

Column sensor_column(char sensor, std::size_t axis, const std::array<double, 3>& lsb) {
    Column column{std::string(1, sensor) + axis_names.at(axis), sensor == 'g' ? "rad/s" : "m/s^2", {}};
    if (lsb.at(axis) == 0.0) {
        column.data = std::vector<double>{};
    } else {
        column.scale = lsb.at(axis);
    }
    return column;
}

Column real_column(std::string name, std::string unit) {
    return {std::move(name), std::move(unit), std::vector<double>{}, 1.0, 0.0, {}};
}

std::vector<double>& reals(Recording& piece, std::string_view name) {
    const auto column = std::ranges::find(piece.columns, name, &Column::name);
    return std::get<std::vector<double>>(column->data);
}

void append(Column& to, const Column& from) {
    std::visit(
        [&](auto& all) {
            const auto& more = std::get<std::decay_t<decltype(all)>>(from.data);
            all.insert(all.end(), more.begin(), more.end());
        },
        to.data);
}

void append(Recording& whole, const Recording& piece) {
    const std::size_t rows = whole.rows();
    for (Segment segment : piece.segments) {
        segment.first += rows;
        if (!whole.segments.empty()) {
            Segment& last = whole.segments.back();
            if (last.first_index + static_cast<std::int64_t>(last.count) == segment.first_index) {
                last.count += segment.count;
                continue;
            }
        }
        whole.segments.push_back(segment);
    }
    if (whole.columns.empty()) {
        whole.columns = piece.columns;
    } else {
        for (std::size_t i = 0; i < whole.columns.size(); ++i) { append(whole.columns[i], piece.columns[i]); }
    }
    whole.t_s.insert(whole.t_s.end(), piece.t_s.begin(), piece.t_s.end());
}

void reserve(Recording& whole, std::uint64_t rows) {
    const auto size = static_cast<std::size_t>(rows);
    for (Column& column : whole.columns) {
        std::visit([&](auto& all) { all.reserve(size); }, column.data);
    }
    if (!whole.t_s.empty()) { whole.t_s.reserve(size); }
}

// The holes between the segments. One that begins where a hole of `before` does keeps its cause.
void list_dropouts(Recording& whole, const std::vector<Dropout>& before) {
    for (std::size_t s = 1; s < whole.segments.size(); ++s) {
        const Segment& last = whole.segments[s - 1];
        const std::int64_t begin = last.first_index + static_cast<std::int64_t>(last.count);
        const double at_s = static_cast<double>(begin - whole.segments.front().first_index) / whole.rate_hz;
        std::string cause = "time_stamps";
        for (const Dropout& old : before) {
            if (std::fabs(old.at_s - at_s) < 0.5 / whole.rate_hz) { cause = old.cause; }
        }
        whole.dropouts.push_back({at_s, whole.segments[s].first_index - begin, std::move(cause)});
    }
}

void place_on_grid(Recording& whole, double rate_hz) {
    Grid grid = grid_from_stamps(whole.t_s);
    if (!grid.failure.empty()) {
        whole.warnings.push_back("the stamps give no grid: " + grid.failure);
        whole.rate_hz = rate_hz;
        list_dropouts(whole, {});
        return;
    }
    whole.rate_hz = grid.rate_hz;
    whole.rate_sd_hz = grid.rate_sd_hz;
    whole.stamp_jitter_s = grid.stamp_jitter_s;
    whole.stamps = grid.stamps;
    whole.segments = std::move(grid.segments);
    whole.dropouts = std::move(grid.dropouts);
    whole.warnings = std::move(grid.warnings);
}

void place_like(Recording& whole, const Recording& like) {
    whole.rate_hz = like.rate_hz;
    whole.nominal_rate_hz = like.nominal_rate_hz;
    whole.rate_sd_hz = like.rate_sd_hz;
    whole.stamp_jitter_s = like.stamp_jitter_s;
    whole.stamps = like.stamps;
    list_dropouts(whole, like.dropouts);
}

}  // namespace

namespace {

double value_of(const EffectModel& effect, const EffectParam& param) {
    const auto given = effect.params.find(std::string(param.name));
    return given == effect.params.end() ? param.otherwise.value_or(0.0) : given->second;
}

bool shows_in_stamps(const EffectModel& effect, const EffectDefinition& definition) {
    const auto param = std::ranges::find(definition.params, "in_stamps", &EffectParam::name);
    return param != definition.params.end() && value_of(effect, *param) != 0.0;
}

}  // namespace

SensorModel without_what_is_recorded(SensorModel model, const RecordedWorld& like) {
    std::erase_if(model.effects, [&](const EffectModel& effect) {
        const EffectDefinition* definition = find_effect(effect.effect);
        const bool in_rate = !definition->rate_error.empty() && shows_in_stamps(effect, *definition);
        return in_rate || (definition->warms && like.has_temperature());
    });
    return model;
}

std::vector<std::string> terms_of_temperature(const SensorModel& model) {
    std::vector<std::string> terms;
    for (const EffectModel& effect : model.effects) {
        const EffectDefinition* definition = find_effect(effect.effect);
        if (definition != nullptr && definition->warms) { terms.push_back(effect.effect); }
    }
    return terms;
}

std::vector<std::string> terms_of_stamps(const SensorModel& model) {
    std::vector<std::string> terms;
    if (model.timestamp_jitter_s != 0.0) { terms.emplace_back("timestamp_jitter_s"); }
    for (const EffectModel& effect : model.effects) {
        const EffectDefinition* definition = find_effect(effect.effect);
        if (definition == nullptr || effect.effect == "dropped") { continue; }  // what is lost has no row
        if (shows_in_stamps(effect, *definition)) { terms.push_back(effect.effect); }
    }
    return terms;
}

RecordingSimulator::RecordingSimulator(const SensorModel& model, const SimulationRequest& request)
    : simulator_(request.like ? without_what_is_recorded(model, *request.like) : model,
                 request.like ? request.like->recording().rate_hz : request.rate_hz.value_or(model.rate_hz),
                 request.seed, request.like ? std::shared_ptr<const World>(request.like) : request.world),
      world_(request.world),
      like_(request.like),
      rate_hz_(like_ ? like_->recording().rate_hz : request.rate_hz.value_or(model.rate_hz)),
      lsb_rad_s_(converter_steps_rad_s(model)),
      reference_sd_rad_s_(model.ref_noise_rad_s),
      accelerometer_sd_m_s2_(model.acc_noise_m_s2),
      instrument_noise_([&] {
          const StageContext context{model, rate_hz_, request.seed};
          return std::array{context.stream({'R', 'r'}, 0), context.stream({'R', 'r'}, 1),
                            context.stream({'R', 'r'}, 2), context.stream({'R', 'a'}, 0),
                            context.stream({'R', 'a'}, 1), context.stream({'R', 'a'}, 2)};
      }()),
      samples_(request.samples) {
    if (like_) {
        const std::uint64_t all = slots_of(like_->recording());
        samples_ = samples_ == 0 ? all : std::min(samples_, all);
    }
    rows_.reserve(block_samples);
    if (model.accelerometer) { start_accelerometer(model, request); }
}

void RecordingSimulator::start_accelerometer(const SensorModel& model, const SimulationRequest& request) {
    const bool at_rest = !like_ && (world_ == nullptr || !world_->moves());
    if (!at_rest && !poses_accelerometer(request)) { return; }
    const SensorModel sensor = at_rest ? resting_accelerometer(model)
                                       : without_what_is_recorded(exposed_accelerometer(model), *like_);
    const auto world = at_rest ? nullptr : world_of_poses(like_->recording());
    accelerometer_.emplace(sensor, rate_hz_, accelerometer_seed(request.seed), world);
    accelerometer_lsb_m_s2_ = converter_steps_rad_s(sensor);
}

void RecordingSimulator::take_own_rows(std::size_t count, const SampleBlock& block) {
    for (std::size_t i = 0; i < count; ++i) {
        if (!block.lost[i]) { rows_.push_back({i, 0}); }
    }
}

void RecordingSimulator::take_like_rows(std::int64_t begin, std::size_t count, const SampleBlock& block) {
    const auto& segments = like_->recording().segments;
    const std::int64_t end = begin + static_cast<std::int64_t>(count);
    for (; like_segment_ < segments.size() && segments[like_segment_].first_index < end; ++like_segment_) {
        const Segment& segment = segments[like_segment_];
        const std::int64_t last = segment.first_index + static_cast<std::int64_t>(segment.count);
        for (std::int64_t index = std::max(begin, segment.first_index); index < std::min(end, last);
             ++index) {
            const auto place = static_cast<std::size_t>(index - begin);
            const auto within = static_cast<std::size_t>(index - segment.first_index);
            if (!block.lost[place]) { rows_.push_back({place, segment.first + within}); }
        }
        if (last > end) { break; }
    }
}

void RecordingSimulator::add_segment_row(Recording& piece, std::int64_t index) const {
    if (!piece.segments.empty()) {
        Segment& last = piece.segments.back();
        if (last.first_index + static_cast<std::int64_t>(last.count) == index) {
            ++last.count;
            return;
        }
    }
    const std::size_t first =
        piece.segments.empty() ? 0 : piece.segments.back().first + piece.segments.back().count;
    piece.segments.push_back({first, 1, index});
}

bool RecordingSimulator::simulates_temperature() const { return !like_ || !like_->has_temperature(); }

bool RecordingSimulator::is_simulated(const Column& column) const {
    if (column.name == "temp") { return simulates_temperature(); }
    return is_gyro(column) || (accelerometer_ && is_of(SensorKind::accelerometer, column));
}

std::vector<std::string> RecordingSimulator::simulated_columns() const {
    std::vector<std::string> names;
    Recording empty;
    make_columns(empty);
    for (const Column& column : empty.columns) {
        if (!like_ || is_simulated(column)) { names.push_back(column.name); }
    }
    return names;
}

void RecordingSimulator::make_columns(Recording& piece) const {
    if (!piece.columns.empty()) { return; }
    piece.rate_hz = rate_hz_;
    piece.stamps = StampKind::sampling;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        piece.columns.push_back(sensor_column('g', axis, lsb_rad_s_));
    }
    for (std::size_t axis = 0; accelerometer_ && axis < axis_names.size(); ++axis) {
        piece.columns.push_back(sensor_column('a', axis, accelerometer_lsb_m_s2_));
    }
    if (simulates_temperature()) { piece.columns.push_back(real_column("temp", "degC")); }
    if (like_) {
        for (const Column& column : like_->recording().columns) {
            if (is_simulated(column)) { continue; }
            Column empty = {column.name, column.unit, {}, column.scale, column.offset, column.source_unit};
            if (!column.is_counts()) { empty.data = std::vector<double>{}; }
            piece.columns.push_back(std::move(empty));
        }
    } else if (world_ != nullptr && world_->moves()) {
        for (const char* axis : axis_names) {
            piece.columns.push_back(real_column(std::string("ref_") + axis, "rad/s"));
        }
        for (const char* axis : axis_names) {
            piece.columns.push_back(real_column(std::string("a") + axis, "m/s^2"));
        }
    }
}

void RecordingSimulator::fill_sensor(char sensor, const SampleBlock& block, const std::array<double, 3>& lsb,
                                     Recording& piece) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string name = std::string(1, sensor) + axis_names[axis];
        Column& column = *std::ranges::find(piece.columns, name, &Column::name);
        const auto fill = [&](auto& data, const auto& source) {
            data.resize(rows_.size());
            for (std::size_t i = 0; i < rows_.size(); ++i) { data[i] = source[rows_[i].place]; }
        };
        if (lsb[axis] == 0.0) {
            fill(std::get<std::vector<double>>(column.data), block.rate_rad_s[axis]);
        } else {
            fill(std::get<std::vector<std::int16_t>>(column.data), block.counts[axis]);
        }
    }
}

// The reference and the accelerometer are read at the instant that the stamp tells, whatever the gyro's
// delay.
void RecordingSimulator::fill_motion(const SampleBlock& block, Recording& piece) const {
    BlockVectors rate_rad_s;           // NOLINT(cppcoreguidelines-pro-type-member-init)
    BlockVectors specific_force_m_s2;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    world_->motion(block.stamp_s, {rate_rad_s[0], rate_rad_s[1], rate_rad_s[2]},
                   {specific_force_m_s2[0], specific_force_m_s2[1], specific_force_m_s2[2]});
    BlockValues draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto fill = [&](const std::string& name, const BlockValues& truth, double sd,
                              std::size_t stream) {
            instrument_noise_[stream].normals(block.first_index, draws);
            auto& data = reals(piece, name);
            data.resize(rows_.size());
            for (std::size_t i = 0; i < rows_.size(); ++i) {
                data[i] = truth[rows_[i].place] + sd * draws[rows_[i].place];
            }
        };
        const double reference_sd_rad_s = world_->is_measured() ? 0.0 : reference_sd_rad_s_;
        fill(std::string("ref_") + axis_names[axis], rate_rad_s[axis], reference_sd_rad_s, axis);
        fill(std::string("a") + axis_names[axis], specific_force_m_s2[axis], accelerometer_sd_m_s2_,
             3 + axis);
    }
}

void RecordingSimulator::fill_like(Recording& piece) const {
    const Recording& like = like_->recording();
    for (const Row& row : rows_) {
        if (!like.t_s.empty()) { piece.t_s.push_back(like.t_s[row.like_row]); }
    }
    for (Column& column : piece.columns) {
        if (is_simulated(column)) { continue; }
        std::visit(
            [&](auto& data) {
                const auto& all = std::get<std::decay_t<decltype(data)>>(like.find(column.name)->data);
                data.resize(rows_.size());
                for (std::size_t i = 0; i < rows_.size(); ++i) { data[i] = all[rows_[i].like_row]; }
            },
            column.data);
    }
}

void RecordingSimulator::fill_temperature(const SampleBlock& block, Recording& piece) const {
    for (Column& column : piece.columns) {
        if (column.name != "temp" || !is_simulated(column)) { continue; }
        auto& data = std::get<std::vector<double>>(column.data);
        data.resize(rows_.size());
        for (std::size_t i = 0; i < rows_.size(); ++i) { data[i] = block.temperature_C[rows_[i].place]; }
    }
}

bool RecordingSimulator::next(Recording& piece) {
    make_columns(piece);
    if (done_ >= samples_) { return false; }
    const SampleBlock& block = simulator_.next_block();
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(block_samples, samples_ - done_));
    rows_.clear();
    piece.segments.clear();
    piece.t_s.clear();
    auto first_index = static_cast<std::int64_t>(block.first_index);
    if (like_) {
        first_index += like_->recording().segments.front().first_index;
        take_like_rows(first_index, count, block);
        fill_like(piece);
    } else {
        take_own_rows(count, block);
        for (const Row& row : rows_) { piece.t_s.push_back(nanoseconds(block.stamp_s[row.place])); }
        if (world_ != nullptr && world_->moves()) { fill_motion(block, piece); }
    }
    for (const Row& row : rows_) {
        add_segment_row(piece, first_index + static_cast<std::int64_t>(row.place));
    }
    fill_sensor('g', block, lsb_rad_s_, piece);
    if (accelerometer_) { fill_sensor('a', accelerometer_->next_block(), accelerometer_lsb_m_s2_, piece); }
    fill_temperature(block, piece);
    done_ += count;
    return true;
}

Recording simulate_recording(const SensorModel& model, const SimulationRequest& request) {
    RecordingSimulator simulator(model, request);
    Recording whole;
    Recording piece;
    while (simulator.next(piece)) {
        const bool first = whole.columns.empty();
        append(whole, piece);
        if (first) { reserve(whole, simulator.samples()); }
    }
    if (whole.columns.empty()) { whole.columns = piece.columns; }
    if (request.like) {
        place_like(whole, request.like->recording());
    } else {
        place_on_grid(whole, simulator.rate_hz());
    }
    return whole;
}

}  // namespace gyrolog
