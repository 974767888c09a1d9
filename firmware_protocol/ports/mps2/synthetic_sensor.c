#include "synthetic_sensor.h"

#include "../../device/mpu9250.h"
#include "../../src/memory.h"

enum { REGISTERS = 128, TRIANGLE_STEP = 3, TRIANGLE_TOP = 2000, DATA_BYTES = 14 };

static uint8_t registers[REGISTERS];
static uint8_t fifo[GLP_MPU_FIFO_BYTES];
static uint32_t fifo_in;
static uint32_t fifo_out;
static int16_t level;
static int16_t step = TRIANGLE_STEP;

void synthetic_sensor_reset(void) {
    memset(registers, 0, sizeof registers);
    registers[glp_mpu_who_am_i] = GLP_MPU_9250_ID;
    registers[glp_mpu_pwr_mgmt_1] = 0x01;
    fifo_in = fifo_out = 0;
}

void synthetic_sensor_write(uint8_t address, uint8_t value) {
    if ((address == glp_mpu_pwr_mgmt_1) && ((value & glp_mpu_pwr_mgmt_1_h_reset) != 0)) {
        synthetic_sensor_reset();
        return;
    }
    if ((address == glp_mpu_user_ctrl) && ((value & glp_mpu_user_ctrl_fifo_rst) != 0)) {
        fifo_in = fifo_out = 0;
        value = (uint8_t)(value & ~(unsigned)glp_mpu_user_ctrl_fifo_rst);
    }
    registers[address % REGISTERS] = value;
}

static uint8_t read_one(uint8_t address) {
    const uint32_t held = fifo_in - fifo_out;
    if (address == glp_mpu_fifo_counth) { return (uint8_t)(held >> 8U); }
    if (address == glp_mpu_fifo_counth + 1) { return (uint8_t)held; }
    const uint8_t value = registers[address % REGISTERS];
    if (address == glp_mpu_int_status) { registers[address] = 0; }
    return value;
}

void synthetic_sensor_read(uint8_t address, uint8_t* bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) {
        if (address != glp_mpu_fifo_r_w) {
            bytes[i] = read_one((uint8_t)(address + i));
        } else if (fifo_out != fifo_in) {
            bytes[i] = fifo[fifo_out % GLP_MPU_FIFO_BYTES];
            ++fifo_out;
        } else {
            bytes[i] = 0xFF;
        }
    }
}

static void store(uint8_t first, size_t size) {
    for (size_t i = 0; i < size; ++i) {
        fifo[fifo_in % GLP_MPU_FIFO_BYTES] = registers[first + i];
        ++fifo_in;
    }
}

static void store_sample(void) {
    const uint8_t parts = registers[glp_mpu_fifo_en];
    const uint32_t bytes = ((parts & glp_mpu_fifo_en_accel) != 0 ? 6U : 0U) +
                           ((parts & glp_mpu_fifo_en_temp) != 0 ? 2U : 0U) +
                           ((parts & glp_mpu_fifo_en_gyro) != 0 ? 6U : 0U);
    if (fifo_in - fifo_out + bytes > GLP_MPU_FIFO_BYTES) {
        registers[glp_mpu_int_status] |= glp_mpu_int_fifo_oflow;
        return;
    }
    if ((parts & glp_mpu_fifo_en_accel) != 0) { store(glp_mpu_accel_xout_h, 6); }
    if ((parts & glp_mpu_fifo_en_temp) != 0) { store(glp_mpu_temp_out_h, 2); }
    if ((parts & glp_mpu_fifo_en_gyro) != 0) { store(glp_mpu_gyro_xout_h, 6); }
}

bool synthetic_sensor_sample(void) {
    level = (int16_t)(level + step);
    if ((level > TRIANGLE_TOP) || (level < -TRIANGLE_TOP)) { step = (int16_t)-step; }
    const int16_t fields[DATA_BYTES / 2] = {(int16_t)(level / 8), (int16_t)(-level / 8), 4096, 1000, level,
                                            (int16_t)-level,      (int16_t)(level / 2)};
    for (uint8_t i = 0; i < DATA_BYTES / 2; ++i) {
        registers[glp_mpu_accel_xout_h + 2U * i] = (uint8_t)((uint16_t)fields[i] >> 8U);
        registers[glp_mpu_accel_xout_h + 2U * i + 1U] = (uint8_t)fields[i];
    }
    if ((registers[glp_mpu_user_ctrl] & glp_mpu_user_ctrl_fifo_en) != 0) { store_sample(); }
    return (registers[glp_mpu_int_enable] & glp_mpu_int_raw_rdy) != 0;
}

uint32_t synthetic_sensor_period(uint32_t timer_hz) {
    const bool wanted = ((registers[glp_mpu_int_enable] & glp_mpu_int_raw_rdy) != 0) ||
                        ((registers[glp_mpu_user_ctrl] & glp_mpu_user_ctrl_fifo_en) != 0);
    if (!wanted) { return 0; }
    if ((registers[glp_mpu_gyro_config] & glp_mpu_gyro_fchoice_b_mask) != 0) { return timer_hz / 32000U; }
    const uint8_t filter = registers[glp_mpu_config] & glp_mpu_config_dlpf_mask;
    if ((filter == 0U) || (filter == 7U)) { return timer_hz / 8000U; }
    return timer_hz / 1000U * (1U + registers[glp_mpu_smplrt_div]);
}
