#include "mpu9250.h"

typedef struct bandwidth {
    uint16_t dlpf_hz;
    uint8_t dlpf_cfg;
    uint8_t gyro_fchoice_b;
    uint16_t inside_hz;      // the gyro's own output rate
    uint8_t accel_dlpf_cfg;  // A_DLPF_CFG: the nearest accelerometer bandwidth
} bandwidth;

// RM-MPU-9250A-00 rev. 1.4, table of register 26 (gyroscope) and of register 29 (accelerometer).
static const bandwidth bandwidths[] = {
    {250, 0, 0, 8000, 0},
    {184, 1, 0, 1000, 1},
    {92, 2, 0, 1000, 2},
    {41, 3, 0, 1000, 3},
    {20, 4, 0, 1000, 4},
    {10, 5, 0, 1000, 5},
    {5, 6, 0, 1000, 6},
    {3600, 7, 0, 8000, 7},
    {GLP_DLPF_OFF, 0, glp_mpu_gyro_fchoice_b_bypass, 32000, glp_mpu_accel_fchoice_b}};

static const bandwidth* find_bandwidth(uint16_t dlpf_hz) {
    for (size_t i = 0; i < sizeof bandwidths / sizeof bandwidths[0]; ++i) {
        if (bandwidths[i].dlpf_hz == dlpf_hz) { return &bandwidths[i]; }
    }
    return NULL;
}

// Full scales are a base times 1, 2, 4 or 8; false when `value` is none of them.
static bool range_code(uint16_t value, uint16_t base, uint8_t* code) {
    for (uint8_t i = 0; i < 4U; ++i) {
        if (value == (uint32_t)base << i) {
            *code = i;
            return true;
        }
    }
    return false;
}

// The k for which inside_hz / k is rate_mHz, to the nearest millihertz; 0 when there is none.
static uint32_t divider_for(uint32_t inside_hz, uint32_t rate_mHz) {
    const uint32_t inside_mHz = inside_hz * 1000U;
    if ((rate_mHz == 0U) || (rate_mHz > inside_mHz)) { return 0; }
    const uint32_t k_max = inside_hz / 1000U * 256U;
    uint32_t k = (inside_mHz + rate_mHz / 2U) / rate_mHz;
    // At the slow end of 32 kHz two neighbours round to the same millihertz.
    if (k > k_max) { k = k_max; }
    return ((inside_mHz + k / 2U) / k == rate_mHz) ? k : 0U;
}

bool glp_mpu_plan_for(const glp_mpu_settings* settings, glp_mpu_plan* plan) {
    const bandwidth* filter = find_bandwidth(settings->dlpf_hz);
    uint8_t gyro_range = 0;
    uint8_t accel_range = 0;
    const size_t sample_bytes = glp_sample_bytes(settings->layout);
    if ((filter == NULL) || (sample_bytes == 0U) ||
        !range_code(settings->gyro_full_scale_dps, 250U, &gyro_range) ||
        !range_code(settings->accel_full_scale_g, 2U, &accel_range)) {
        return false;
    }
    const uint32_t k = divider_for(filter->inside_hz, settings->rate_mHz);
    if (k == 0U) { return false; }

    // SMPLRT_DIV is effective only with Fchoice_b 0 and DLPF_CFG 1 to 6 (register 25).
    const bool sensor_divides = filter->inside_hz == 1000U;
    plan->smplrt_div = sensor_divides ? (uint8_t)(k - 1U) : 0U;
    plan->decimation = sensor_divides ? 1U : (uint16_t)k;
    plan->fifo = plan->decimation == 1U;
    plan->layout = settings->layout;
    plan->sample_bytes = (uint8_t)sample_bytes;
    plan->config = (uint8_t)(glp_mpu_config_fifo_mode | filter->dlpf_cfg);
    plan->gyro_config = (uint8_t)((gyro_range << glp_mpu_gyro_fs_sel_shift) | filter->gyro_fchoice_b);
    plan->accel_config = (uint8_t)(accel_range << glp_mpu_accel_fs_sel_shift);
    plan->accel_config2 = filter->accel_dlpf_cfg;
    plan->fifo_en = 0;
    if (plan->fifo) {
        if ((settings->layout & glp_layout_gyro) != 0) { plan->fifo_en |= glp_mpu_fifo_en_gyro; }
        if ((settings->layout & glp_layout_accel) != 0) { plan->fifo_en |= glp_mpu_fifo_en_accel; }
        if ((settings->layout & glp_layout_temperature) != 0) { plan->fifo_en |= glp_mpu_fifo_en_temp; }
    }
    return true;
}

// The sensitivities of the product specification (PS-MPU-9250A-01, table 1): 131, 65.5, 32.8 and 16.4
// LSB/dps. A full scale over 2^15 would be 0.05 % to 0.1 % less.
static uint32_t gyro_ndps_per_lsb(uint16_t full_scale_dps) {
    switch (full_scale_dps) {
        case 250U:
            return 7633588U;
        case 500U:
            return 15267176U;
        case 1000U:
            return 30487805U;
        default:
            return 60975610U;
    }
}

void glp_mpu_describe(const glp_mpu_settings* settings, const glp_mpu_plan* plan, glp_config* config) {
    config->layout = settings->layout;
    config->rate_mHz = settings->rate_mHz;
    config->gyro_full_scale_dps = settings->gyro_full_scale_dps;
    config->accel_full_scale_g = settings->accel_full_scale_g;
    config->dlpf_hz = (settings->dlpf_hz == GLP_DLPF_OFF) ? 0U : settings->dlpf_hz;
    config->decimation = plan->decimation;
    config->gyro_ndps_per_lsb = gyro_ndps_per_lsb(settings->gyro_full_scale_dps);
    // Full scale over 2^15: 1e12 / 2^15 = 1953125000 / 64 stays within 32 bits this way.
    config->accel_pg_per_lsb = settings->accel_full_scale_g / 2U * (1953125000U / 32U) +
                               (settings->accel_full_scale_g / 2U * (1953125000U % 32U) + 16U) / 32U;
    // TEMP_degC = TEMP_OUT / 333.87 + 21 (register 65; sensitivity: product specification
    // PS-MPU-9250A-01, 3.4.2)
    config->temp_nC_per_lsb = 2995178U;
    config->temp_offset_mC = 21000;
}

typedef struct register_value {
    uint8_t address;
    uint8_t value;
} register_value;

static bool write_all(const glp_hal* hal, const register_value* values, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        if (!hal->sensor_write(hal->context, values[i].address, values[i].value)) { return false; }
    }
    return true;
}

static uint8_t idle_user_ctrl(const glp_hal* hal) {
    return hal->sensor_on_spi ? (uint8_t)glp_mpu_user_ctrl_i2c_if_dis : 0U;
}

const char* glp_mpu_name(uint8_t who_am_i) {
    switch (who_am_i) {
        case GLP_MPU_9250_ID:
            return "MPU-9250";
        case GLP_MPU_9255_ID:
            return "MPU-9255";
        case GLP_MPU_9250_75_ID:
            return "MPU-9250 (75)";
        default:
            return NULL;
    }
}

glp_mpu_outcome glp_mpu_reset(const glp_hal* hal, uint8_t* who_am_i, glp_mpu_fault* fault) {
    const register_value reset = {glp_mpu_pwr_mgmt_1, glp_mpu_pwr_mgmt_1_h_reset};
    if (!write_all(hal, &reset, 1)) { return glp_mpu_bus_error; }
    // The product specification gives 11 ms to 100 ms for register access after power-up.
    hal->delay_ms(hal->context, 100);
    const register_value wake[] = {{glp_mpu_pwr_mgmt_1, glp_mpu_pwr_mgmt_1_clksel_pll},
                                   {glp_mpu_user_ctrl, idle_user_ctrl(hal)},
                                   {glp_mpu_pwr_mgmt_2, 0}};
    if (!write_all(hal, wake, sizeof wake / sizeof wake[0])) { return glp_mpu_bus_error; }
    // The gyro needs 35 ms to start, its PLL with it.
    hal->delay_ms(hal->context, 100);
    if (!hal->sensor_read(hal->context, glp_mpu_who_am_i, who_am_i, 1)) { return glp_mpu_bus_error; }
    if (glp_mpu_name(*who_am_i) == NULL) {
        *fault = (glp_mpu_fault){glp_mpu_who_am_i, *who_am_i};
        return glp_mpu_fault_found;
    }
    return glp_mpu_ok;
}

// In the order of glp_config.registers.
static const uint8_t told_registers[8] = {glp_mpu_smplrt_div,   glp_mpu_config,        glp_mpu_gyro_config,
                                          glp_mpu_accel_config, glp_mpu_accel_config2, glp_mpu_fifo_en,
                                          glp_mpu_int_enable,   glp_mpu_user_ctrl};

static bool read_told_registers(const glp_hal* hal, uint8_t registers[8]) {
    for (size_t i = 0; i < sizeof told_registers; ++i) {
        if (!hal->sensor_read(hal->context, told_registers[i], registers + i, 1)) { return false; }
    }
    return true;
}

// What they hold by the plan, idle or started; in the same order.
static void wanted_registers(const glp_hal* hal, const glp_mpu_plan* plan, bool started, uint8_t wanted[8]) {
    wanted[0] = plan->smplrt_div;
    wanted[1] = plan->config;
    wanted[2] = plan->gyro_config;
    wanted[3] = plan->accel_config;
    wanted[4] = plan->accel_config2;
    wanted[5] = started ? plan->fifo_en : 0U;
    wanted[6] = started ? (uint8_t)glp_mpu_int_raw_rdy : 0U;
    wanted[7] = idle_user_ctrl(hal);
    if (started && plan->fifo) { wanted[7] |= glp_mpu_user_ctrl_fifo_en; }
}

static glp_mpu_outcome check_registers(const glp_hal* hal, const uint8_t wanted[8], uint8_t registers[8],
                                       glp_mpu_fault* fault) {
    if (!read_told_registers(hal, registers)) { return glp_mpu_bus_error; }
    for (size_t i = 0; i < sizeof told_registers; ++i) {
        if (registers[i] != wanted[i]) {
            *fault = (glp_mpu_fault){told_registers[i], registers[i]};
            return glp_mpu_fault_found;
        }
    }
    return glp_mpu_ok;
}

glp_mpu_outcome glp_mpu_apply(const glp_hal* hal, const glp_mpu_plan* plan, uint8_t registers[8],
                              glp_mpu_fault* fault) {
    // A 50 us pulse at each sample, which nothing has to clear. INT_STATUS is cleared by reading INT_STATUS
    // only (INT_ANYRD_2CLEAR 0): reading the temperature must not hide an overflow.
    const register_value pulse = {glp_mpu_int_pin_cfg, 0};
    if (!write_all(hal, &pulse, 1)) { return glp_mpu_bus_error; }
    uint8_t wanted[8];
    wanted_registers(hal, plan, false, wanted);
    for (size_t i = 0; i < sizeof told_registers; ++i) {
        const register_value one = {told_registers[i], wanted[i]};
        if (!write_all(hal, &one, 1)) { return glp_mpu_bus_error; }
    }
    return check_registers(hal, wanted, registers, fault);
}

bool glp_mpu_fifo_empty(const glp_hal* hal) {
    // The register map of the MPU-6050 lets FIFO_RST act only while FIFO_EN is 0; the MPU-9250's does not
    // say.
    const uint8_t idle = idle_user_ctrl(hal);
    const register_value values[] = {{glp_mpu_user_ctrl, (uint8_t)(idle | glp_mpu_user_ctrl_fifo_rst)},
                                     {glp_mpu_user_ctrl, (uint8_t)(idle | glp_mpu_user_ctrl_fifo_en)}};
    return write_all(hal, values, sizeof values / sizeof values[0]);
}

bool glp_mpu_overflow_clear(const glp_hal* hal) {
    uint8_t status = 0;
    return hal->sensor_read(hal->context, glp_mpu_int_status, &status, 1);
}

glp_mpu_outcome glp_mpu_start(const glp_hal* hal, const glp_mpu_plan* plan, uint8_t registers[8],
                              glp_mpu_fault* fault) {
    uint8_t wanted[8];
    wanted_registers(hal, plan, true, wanted);
    const register_value values[] = {
        {glp_mpu_fifo_en, wanted[5]}, {glp_mpu_user_ctrl, wanted[7]}, {glp_mpu_int_enable, wanted[6]}};
    if (!write_all(hal, values, sizeof values / sizeof values[0])) { return glp_mpu_bus_error; }
    return check_registers(hal, wanted, registers, fault);
}

glp_mpu_outcome glp_mpu_check(const glp_hal* hal, const glp_mpu_plan* plan, uint8_t registers[8],
                              glp_mpu_fault* fault) {
    uint8_t wanted[8];
    wanted_registers(hal, plan, true, wanted);
    return check_registers(hal, wanted, registers, fault);
}

glp_mpu_outcome glp_mpu_stop(const glp_hal* hal) {
    const register_value values[] = {
        {glp_mpu_int_enable, 0}, {glp_mpu_fifo_en, 0}, {glp_mpu_user_ctrl, idle_user_ctrl(hal)}};
    return write_all(hal, values, sizeof values / sizeof values[0]) ? glp_mpu_ok : glp_mpu_bus_error;
}

bool glp_mpu_fifo_level(const glp_hal* hal, size_t* bytes, bool* overflowed) {
    uint8_t status = 0;
    uint8_t count[2];
    if (!hal->sensor_read(hal->context, glp_mpu_int_status, &status, 1) ||
        !hal->sensor_read(hal->context, glp_mpu_fifo_counth, count, sizeof count)) {
        return false;
    }
    *bytes = (size_t)((count[0] & 0x1FU) << 8U) | count[1];
    *overflowed = ((status & glp_mpu_int_fifo_oflow) != 0) || (*bytes >= GLP_MPU_FIFO_BYTES);
    return true;
}

static uint16_t big_endian(const uint8_t* bytes) { return (uint16_t)((bytes[0] << 8U) | bytes[1]); }

static void put(uint8_t* bytes, uint16_t value) {
    bytes[0] = (uint8_t)value;
    bytes[1] = (uint8_t)(value >> 8U);
}

// 0x7FFF becomes 0 and 0x8000 becomes 1; every other count is larger.
static bool at_end_of_range(uint16_t count) { return (uint16_t)(count - 0x7FFFU) <= 1U; }

bool glp_mpu_arrange(uint8_t* samples, size_t count, uint8_t layout) {
    const size_t gyro = ((layout & glp_layout_gyro) != 0) ? 3U : 0U;
    const size_t accel = ((layout & glp_layout_accel) != 0) ? 3U : 0U;
    const size_t temperature = ((layout & glp_layout_temperature) != 0) ? 1U : 0U;
    const size_t fields = gyro + accel + temperature;
    bool saturated = false;
    for (size_t i = 0; i < count; ++i, samples += 2U * fields) {
        uint16_t in[7];
        for (size_t k = 0; k < fields; ++k) { in[k] = big_endian(samples + 2U * k); }
        uint8_t* out = samples;
        for (size_t k = 0; k < gyro; ++k, out += 2) {
            saturated |= at_end_of_range(in[accel + temperature + k]);
            put(out, in[accel + temperature + k]);
        }
        for (size_t k = 0; k < accel; ++k, out += 2) {
            saturated |= at_end_of_range(in[k]);
            put(out, in[k]);
        }
        if (temperature != 0U) { put(out, in[accel]); }
    }
    return saturated;
}
