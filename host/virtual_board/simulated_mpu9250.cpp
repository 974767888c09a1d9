#include "host/virtual_board/simulated_mpu9250.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/converter.hpp"
#include "analysis/simulate/resting_accelerometer.hpp"
#include "firmware_protocol/device/mpu9250.h"

namespace gyrolog {

namespace {

constexpr std::uint8_t pwr_mgmt_1_sleep = 0x40;
// TEMP_degC = TEMP_OUT / 333.87 + 21 (register 65 and PS-MPU-9250A-01, 3.4.2)
constexpr double temperature_lsb_C = 1.0 / 333.87;
constexpr double temperature_zero_C = 21.0;

// PS-MPU-9250A-01, table 1
constexpr std::array lsb_per_dps{131.0, 65.5, 32.8, 16.4};

// Of the period: nearer or farther than half of it, a firmware calls two instants a discontinuity.
constexpr double shortest_distance = 0.51;
constexpr double longest_distance = 1.49;

// A model that loses so many samples in a row has fallen silent.
constexpr std::uint64_t slots_lost_for_ever = std::uint64_t{1} << 20U;

constexpr double same_scale = 1e-3;

bool about_equal(double a, double b) { return std::fabs(a - b) <= same_scale * b; }

Converter gyro_converter(const SensorModel& model, unsigned range) {
    const double range_rad_s = (250U << range) * rad_per_deg;
    const double lsb_rad_s = rad_per_deg / lsb_per_dps[range];
    if (!about_equal(model.full_scale_rad_s, range_rad_s)) { return {lsb_rad_s, 32767.0 * lsb_rad_s}; }
    const bool own_step = about_equal(model.lsb_rad_s, lsb_rad_s);
    return {own_step ? model.lsb_rad_s : lsb_rad_s, model.saturation_rad_s};
}

void put_big_endian(std::uint8_t* bytes, std::int16_t value) {
    bytes[0] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(value) >> 8U);
    bytes[1] = static_cast<std::uint8_t>(value);
}

// The rate inside the gyro, before SMPLRT_DIV (register 26's table).
double inside_rate_hz(std::uint8_t gyro_config, std::uint8_t config) {
    if ((gyro_config & glp_mpu_gyro_fchoice_b_mask) != 0) { return 32000.0; }
    const unsigned dlpf_cfg = config & glp_mpu_config_dlpf_mask;
    return dlpf_cfg == 0 || dlpf_cfg == 7 ? 8000.0 : 1000.0;
}

// -3 dB, by DLPF_CFG (RM-MPU-9250A-00 rev. 1.4, table of register 26).
constexpr std::array gyro_bandwidths_hz{250.0, 184.0, 92.0, 41.0, 20.0, 10.0, 5.0, 3600.0};

// The model as it shows behind a filter of this bandwidth, at this output rate.
SensorModel filtered(SensorModel model, double bandwidth_hz, double rate_hz) {
    if (bandwidth_hz == 0.0) { return model; }
    const EffectDefinition& lowpass = *find_effect("lowpass");
    EffectModel filter;
    filter.effect = lowpass.name;
    filter.params = {{"fc_hz", bandwidth_hz}};
    constexpr std::array slowest_hz{0.0};
    std::array density{SpectralParts{.white = 1.0}};
    lowpass.signature->spectrum(slowest_hz, rate_hz, EffectValues(filter), density);
    for (AxisModel& axis : model.axes) { axis.noise.N_rad_per_sqrt_s /= std::sqrt(density[0].white); }
    model.effects.push_back(std::move(filter));
    return model;
}

// Of a model without an accelerometer: the white noise of its samples, in m/s^2 where a gyro has rad/s.
SensorModel accelerometer_noise(const SensorModel& model, double rate_hz) {
    SensorModel sensor;
    for (AxisModel& axis : sensor.axes) {
        axis.noise.N_rad_per_sqrt_s = model.acc_noise_m_s2 / std::sqrt(rate_hz);
    }
    return sensor;
}

}  // namespace

SimulatedMpu9250::SimulatedMpu9250(const SensorModel& model, std::uint64_t seed, double clock_error,
                                   std::uint8_t who_am_i)
    : model_(model),
      seed_(seed),
      clock_error_(std::clamp(clock_error, -clock_error_max, clock_error_max)),
      who_am_i_(who_am_i) {
    reset(0);
}

void SimulatedMpu9250::reset(std::int64_t now_ns) {
    registers_.fill(0);
    registers_[glp_mpu_pwr_mgmt_1] = glp_mpu_pwr_mgmt_1_clksel_pll;
    registers_[glp_mpu_who_am_i] = who_am_i_;
    fields_.fill(0);
    fifo_begin_ = 0;
    fifo_bytes_ = 0;
    restart_clock(now_ns);
}

double SimulatedMpu9250::nominal_rate_hz() const {
    const double inside_hz = inside_rate_hz(registers_[glp_mpu_gyro_config], registers_[glp_mpu_config]);
    // SMPLRT_DIV acts on the 1 kHz of the filter settings 1 to 6 only (register 25).
    const double divider = inside_hz == 1000.0 ? 1.0 + registers_[glp_mpu_smplrt_div] : 1.0;
    return inside_hz / (divider * pin_divider_);
}

bool SimulatedMpu9250::samples_wanted() const {
    if ((registers_[glp_mpu_pwr_mgmt_1] & pwr_mgmt_1_sleep) != 0) { return false; }
    const bool fifo_on =
        (registers_[glp_mpu_user_ctrl] & glp_mpu_user_ctrl_fifo_en) != 0 && registers_[glp_mpu_fifo_en] != 0;
    return fifo_on || (registers_[glp_mpu_int_enable] & glp_mpu_int_raw_rdy) != 0;
}

SimulatedMpu9250::Bandwidths SimulatedMpu9250::bandwidths() const {
    const double widest_hz = widest_filter * nominal_rate_hz();
    const auto acting = [&](double bandwidth_hz) { return bandwidth_hz < widest_hz ? bandwidth_hz : 0.0; };
    Bandwidths found;
    if ((registers_[glp_mpu_gyro_config] & glp_mpu_gyro_fchoice_b_mask) == 0) {
        found.gyro_hz = acting(gyro_bandwidths_hz[registers_[glp_mpu_config] & glp_mpu_config_dlpf_mask]);
    }
    found.accel_hz = acting(glp_mpu_accel_bandwidth_hz(registers_[glp_mpu_accel_config2]));
    return found;
}

void SimulatedMpu9250::restart_clock(std::int64_t now_ns) {
    clock_start_ns_ = now_ns;
    period_ns_ = 1e9 / true_rate_hz();
    schedule(now_ns);
}

// The next sample comes at the first instant of the grid after `after_ns`, if anything waits for one.
void SimulatedMpu9250::schedule(std::int64_t after_ns) {
    if (!samples_wanted()) {
        next_instant_ns_ = never_ns;
        return;
    }
    prepare_simulator();
    const double periods = std::floor(static_cast<double>(after_ns - clock_start_ns_) / period_ns_) + 1.0;
    next_instant_ns_ = clock_start_ns_ + std::llround(periods * period_ns_);
    stamps_start_ns_ = next_instant_ns_ - stamp_ns();
    if (block_->lost[place_]) { go_to_next_slot(); }
}

void SimulatedMpu9250::set_pin_divider(unsigned divider, std::int64_t now_ns) {
    if (divider == pin_divider_) { return; }
    pin_divider_ = divider;
    restart_clock(now_ns);
}

void SimulatedMpu9250::write(std::uint8_t address, std::uint8_t value, std::int64_t now_ns) {
    if (address >= registers_.size() || address == glp_mpu_who_am_i) { return; }
    if (address == glp_mpu_pwr_mgmt_1 && (value & glp_mpu_pwr_mgmt_1_h_reset) != 0) {
        reset(now_ns);
        return;
    }
    if (address == glp_mpu_user_ctrl) {
        if ((value & glp_mpu_user_ctrl_fifo_rst) != 0) { fifo_bytes_ = 0; }
        value &= static_cast<std::uint8_t>(~(glp_mpu_user_ctrl_fifo_rst | glp_mpu_user_ctrl_sig_cond_rst));
    }
    if (address == glp_mpu_fifo_r_w) {
        put_in_fifo(value);
        return;
    }
    const double rate_before_hz = nominal_rate_hz();
    const bool wanted_before = samples_wanted();
    const Bandwidths filters_before = bandwidths();
    registers_[address] = value;
    if ((address == glp_mpu_gyro_config || address == glp_mpu_accel_config) && simulator_) { convert(); }
    if (nominal_rate_hz() != rate_before_hz) {
        restart_clock(now_ns);
    } else if (samples_wanted() != wanted_before || bandwidths() != filters_before) {
        schedule(now_ns);
    }
}

std::uint8_t SimulatedMpu9250::read_register(std::uint8_t address) {
    const auto count = static_cast<std::uint16_t>(fifo_bytes_);
    switch (address) {
        case glp_mpu_fifo_counth:
            return static_cast<std::uint8_t>(count >> 8U);
        case glp_mpu_fifo_counth + 1:
            return static_cast<std::uint8_t>(count);
        case glp_mpu_fifo_r_w: {
            if (fifo_bytes_ == 0) { return 0xFF; }
            const std::uint8_t byte = fifo_[fifo_begin_];
            fifo_begin_ = (fifo_begin_ + 1) % fifo_.size();
            --fifo_bytes_;
            return byte;
        }
        case glp_mpu_int_status: {
            const std::uint8_t status = registers_[glp_mpu_int_status];
            registers_[glp_mpu_int_status] = 0;
            return status;
        }
        default:
            break;
    }
    if (address >= glp_mpu_accel_xout_h && address < glp_mpu_accel_xout_h + GLP_MPU_ALL_BYTES) {
        const auto place = static_cast<std::size_t>(address - glp_mpu_accel_xout_h);
        std::array<std::uint8_t, 2> bytes{};
        put_big_endian(bytes.data(), fields_[place / 2]);
        return bytes[place % 2];
    }
    return address < registers_.size() ? registers_[address] : std::uint8_t{0};
}

void SimulatedMpu9250::read(std::uint8_t address, std::span<std::uint8_t> bytes) {
    if (address == glp_mpu_fifo_r_w && bytes.size() <= fifo_bytes_) {
        const std::size_t to_edge = std::min(bytes.size(), fifo_.size() - fifo_begin_);
        std::copy_n(fifo_.begin() + static_cast<std::ptrdiff_t>(fifo_begin_), to_edge, bytes.begin());
        std::copy_n(fifo_.begin(), bytes.size() - to_edge,
                    bytes.begin() + static_cast<std::ptrdiff_t>(to_edge));
        fifo_begin_ = (fifo_begin_ + bytes.size()) % fifo_.size();
        fifo_bytes_ -= bytes.size();
        return;
    }
    for (std::uint8_t& byte : bytes) {
        byte = read_register(address);
        if (address != glp_mpu_fifo_r_w) { ++address; }
    }
}

void SimulatedMpu9250::put_in_fifo(std::uint8_t byte) {
    if (fifo_bytes_ == fifo_.size()) {
        registers_[glp_mpu_int_status] |= glp_mpu_int_fifo_oflow;
        if ((registers_[glp_mpu_config] & glp_mpu_config_fifo_mode) != 0) { return; }
        fifo_begin_ = (fifo_begin_ + 1) % fifo_.size();
        --fifo_bytes_;
    }
    fifo_[(fifo_begin_ + fifo_bytes_) % fifo_.size()] = byte;
    ++fifo_bytes_;
}

void SimulatedMpu9250::store_sample_in_fifo() {
    const unsigned enabled = registers_[glp_mpu_fifo_en];
    std::array<std::uint8_t, GLP_MPU_ALL_BYTES> bytes{};
    std::size_t size = 0;
    const auto put = [&](std::size_t field) {
        put_big_endian(bytes.data() + size, fields_[field]);
        size += 2;
    };
    if ((enabled & glp_mpu_fifo_en_accel) != 0) {
        put(0);
        put(1);
        put(2);
    }
    if ((enabled & glp_mpu_fifo_en_temp) != 0) { put(3); }
    for (unsigned axis = 0; axis < 3; ++axis) {
        if ((enabled & (0x40U >> axis)) != 0) { put(4 + axis); }
    }
    for (std::size_t i = 0; i < size; ++i) { put_in_fifo(bytes[i]); }
}

bool SimulatedMpu9250::pass_instant(bool frozen) {
    if (!frozen) { fields_ = counts_[place_]; }
    go_to_next_slot();
    registers_[glp_mpu_int_status] |= glp_mpu_int_raw_rdy;
    if ((registers_[glp_mpu_user_ctrl] & glp_mpu_user_ctrl_fifo_en) != 0) { store_sample_in_fifo(); }
    return (registers_[glp_mpu_int_enable] & glp_mpu_int_raw_rdy) != 0;
}

std::int64_t SimulatedMpu9250::stamp_ns() const { return std::llround(block_->stamp_s[place_] * 1e9); }

void SimulatedMpu9250::go_to_next_slot() {
    const std::int64_t before_ns = next_instant_ns_;
    std::uint64_t slots = 0;
    do {
        if (++slots == slots_lost_for_ever) {
            next_instant_ns_ = never_ns;
            return;
        }
        if (++place_ == block_samples) { next_block(); }
    } while (block_->lost[place_]);
    const std::int64_t earliest_ns = before_ns + std::llround(shortest_distance * period_ns_);
    next_instant_ns_ = std::max(stamps_start_ns_ + stamp_ns(), earliest_ns);
    if (slots == 1) {
        const std::int64_t latest_ns = before_ns + std::llround(longest_distance * period_ns_);
        next_instant_ns_ = std::min(next_instant_ns_, latest_ns);
    }
}

void SimulatedMpu9250::prepare_simulator() {
    const double rate_hz = true_rate_hz();
    const Bandwidths filters = bandwidths();
    if (simulator_ && simulated_rate_hz_ == rate_hz && simulated_bandwidths_ == filters) { return; }
    // What the chip converts is the rate before any converter: the registers may change while it runs.
    SensorModel unconverted = model_;
    unconverted.lsb_rad_s = 0.0;
    unconverted.saturation_rad_s = std::numeric_limits<double>::infinity();
    // The first simulation is the seed's own, as anyone may repeat it; later ones must not repeat it.
    const std::uint64_t seed = seed_ + (simulations_ << 32U);
    simulator_.emplace(filtered(unconverted, filters.gyro_hz, rate_hz), rate_hz, seed);
    accelerometer_.reset();
    if (model_.accelerometer || filters.accel_hz > 0.0) {
        SensorModel accelerometer =
            model_.accelerometer ? resting_accelerometer(model_) : accelerometer_noise(model_, rate_hz);
        accelerometer.lsb_rad_s = 0.0;
        accelerometer.saturation_rad_s = std::numeric_limits<double>::infinity();
        accelerometer_.emplace(filtered(accelerometer, filters.accel_hz, rate_hz), rate_hz,
                               accelerometer_seed(seed));
    }
    ++simulations_;
    simulated_rate_hz_ = rate_hz;
    simulated_bandwidths_ = filters;
    next_block();
}

void SimulatedMpu9250::next_block() {
    block_ = &simulator_->next_block();
    if (accelerometer_) { accelerometer_block_ = &accelerometer_->next_block(); }
    place_ = 0;
    convert();
}

void SimulatedMpu9250::convert() {
    const unsigned gyro_range = (registers_[glp_mpu_gyro_config] >> glp_mpu_gyro_fs_sel_shift) & 3U;
    const unsigned accel_range = (registers_[glp_mpu_accel_config] >> glp_mpu_accel_fs_sel_shift) & 3U;
    const double accel_lsb_m_s2 = (2U << accel_range) * standard_gravity_m_s2 / 32768.0;
    const Converter gyro = gyro_converter(model_, gyro_range);
    const Converter accel(accel_lsb_m_s2, 32767.0 * accel_lsb_m_s2);
    const Converter temperature(temperature_lsb_C, 32767.0 * temperature_lsb_C);

    std::array<double, block_samples> noise;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const StageContext context{model_, simulated_rate_hz_, seed_ + ((simulations_ - 1) << 32U)};
        context.stream({'A', '0'}, axis).normals(block_->first_index, noise);
        for (std::size_t i = 0; i < block_samples; ++i) {
            const double simulated_m_s2 =
                accelerometer_ ? accelerometer_block_->rate_rad_s[axis][i] : model_.acc_noise_m_s2 * noise[i];
            const double force_m_s2 = model_.accelerometer ? 0.0 : block_->specific_force_m_s2[axis][i];
            counts_[i][axis] = accel(force_m_s2 + simulated_m_s2);
            counts_[i][4 + axis] = gyro(block_->rate_rad_s[axis][i]);
        }
    }
    for (std::size_t i = 0; i < block_samples; ++i) {
        counts_[i][3] = temperature(block_->temperature_C[i] - temperature_zero_C);
    }
}

}  // namespace gyrolog
