// Simulated recordings: what the simulator makes, in the form that a sensor's recording has.
//
// A recording that is made whole equals, column by column and segment by segment, what reading its text file
// gives (host/formats/recording_csv.hpp), but for the digits that the file leaves out.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/recorded_world.hpp"
#include "analysis/simulate/sensor_model.hpp"
#include "analysis/simulate/sensor_simulator.hpp"

namespace gyrolog {

struct SimulationRequest {
    std::uint64_t samples = 0;  // sampling instants, lost ones too; with `like` 0 means all of its
    std::uint64_t seed = 1;
    std::optional<double> rate_hz{};              // in place of the model's; not with `like`
    std::shared_ptr<const World> world{};         // none: at rest; not with `like`
    std::shared_ptr<const RecordedWorld> like{};  // its rows, time stamps and columns other than gyros
    // With a `like` that has an orientation and no accelerometer: ax ay az of the model's, which shows
    // gravity in each pose as if the sensor rested there (recorded_orientation.hpp). What accelerates it in
    // between nobody knows.
    bool accelerometer_in_poses = false;
};

// Of a simulation like a recording: what its stamps and its temperature have in them does not act again.
SensorModel without_what_is_recorded(SensorModel model, const RecordedWorld& like);

// What of the model has no effect on time stamps that are copied: the model's keys and effects by name.
std::vector<std::string> terms_of_stamps(const SensorModel& model);
// The same of a temperature that is copied.
std::vector<std::string> terms_of_temperature(const SensorModel& model);

class RecordingSimulator {
public:
    // `model` has no simulation_refusal(). Cheap; worlds are shared, not copied.
    RecordingSimulator(const SensorModel& model, const SimulationRequest& request);

    // The rows of the next block that were delivered (there may be none); false when all have been. A piece
    // that is handed in again is refilled. Its segments count on the grid of the whole recording. Stamps are
    // whole nanoseconds.
    //
    // Columns: gx gy gz, counts where the model has an lsb; temp. At rest, ax ay az where the model has an
    // accelerometer. In a moving world ref_x ref_y ref_z with the reference's noise, ax ay az with
    // acc_noise_m_s2 and nothing else. With `like`: its own columns in place of
    // these, as they are, and the simulated temperature only if it has none; ax ay az as the request has
    // it.
    bool next(Recording& piece);

    // Of those: what is simulated, not taken over.
    std::vector<std::string> simulated_columns() const;

    std::uint64_t samples() const { return samples_; }
    std::uint64_t samples_done() const { return done_; }
    double rate_hz() const { return rate_hz_; }

private:
    struct Row {
        std::size_t place;     // in the block
        std::size_t like_row;  // of the recording that is followed
    };

    bool simulates_temperature() const;
    bool is_simulated(const Column& column) const;
    void start_accelerometer(const SensorModel& model, const SimulationRequest& request);
    void take_own_rows(std::size_t count, const SampleBlock& block);
    void take_like_rows(std::int64_t begin, std::size_t count, const SampleBlock& block);
    void add_segment_row(Recording& piece, std::int64_t index) const;
    void make_columns(Recording& piece) const;
    void fill_sensor(char sensor, const SampleBlock& block, const std::array<double, 3>& lsb,
                     Recording& piece) const;
    void fill_motion(const SampleBlock& block, Recording& piece) const;
    void fill_temperature(const SampleBlock& block, Recording& piece) const;
    void fill_like(Recording& piece) const;

    SensorSimulator simulator_;
    std::optional<SensorSimulator> accelerometer_;  // in m/s^2 for rad/s
    std::array<double, 3> accelerometer_lsb_m_s2_{};
    std::shared_ptr<const World> world_;
    std::shared_ptr<const RecordedWorld> like_;
    double rate_hz_;
    std::array<double, 3> lsb_rad_s_;
    double reference_sd_rad_s_;
    double accelerometer_sd_m_s2_;
    std::array<RandomStream, 6> instrument_noise_;  // of the reference's axes, then the accelerometer's
    std::uint64_t samples_ = 0;
    std::uint64_t done_ = 0;
    std::vector<Row> rows_;         // of the current block
    std::size_t like_segment_ = 0;  // where the current block begins
};

// The whole, in memory. Its rate, segments and dropouts are those that its stamps show (grid.hpp), as for any
// recording; with `like` they are those of `like`, less the rows that were lost.
Recording simulate_recording(const SensorModel& model, const SimulationRequest& request);

}  // namespace gyrolog
