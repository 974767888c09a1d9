/// InvenSense MPU-9250: the registers this project uses and their set-up. Names, addresses and bits as in the
/// register map (RM-MPU-9250A-00 rev. 1.4); the number in parentheses is the register's decimal number there.
#ifndef GYROLOG_PROTOCOL_DEVICE_MPU9250_H
#define GYROLOG_PROTOCOL_DEVICE_MPU9250_H

#include <gyrolog_protocol/message.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    glp_mpu_smplrt_div = 0x19,         // (25) sample rate = 1 kHz / (1 + SMPLRT_DIV)
    glp_mpu_config = 0x1A,             // (26)
    glp_mpu_gyro_config = 0x1B,        // (27)
    glp_mpu_accel_config = 0x1C,       // (28)
    glp_mpu_accel_config2 = 0x1D,      // (29)
    glp_mpu_fifo_en = 0x23,            // (35)
    glp_mpu_int_pin_cfg = 0x37,        // (55)
    glp_mpu_int_enable = 0x38,         // (56)
    glp_mpu_int_status = 0x3A,         // (58) reading clears it
    glp_mpu_accel_xout_h = 0x3B,       // (59) accel x y z, temperature, gyro x y z: 14 bytes, big endian
    glp_mpu_temp_out_h = 0x41,         // (65)
    glp_mpu_gyro_xout_h = 0x43,        // (67)
    glp_mpu_signal_path_reset = 0x68,  // (104)
    glp_mpu_user_ctrl = 0x6A,          // (106)
    glp_mpu_pwr_mgmt_1 = 0x6B,         // (107)
    glp_mpu_pwr_mgmt_2 = 0x6C,         // (108)
    glp_mpu_fifo_counth = 0x72,        // (114) 13 bits, big endian; reading the high byte latches both
    glp_mpu_fifo_r_w = 0x74,           // (116)
    glp_mpu_who_am_i = 0x75            // (117)
};

enum {
    glp_mpu_config_fifo_mode =
        0x40,  // CONFIG: a full FIFO takes no more (0: the oldest bytes are overwritten)
    glp_mpu_config_dlpf_mask = 0x07,        // CONFIG: DLPF_CFG
    glp_mpu_gyro_fs_sel_shift = 3,          // GYRO_CONFIG: 0..3 = 250, 500, 1000, 2000 dps
    glp_mpu_gyro_fchoice_b_bypass = 0x01,   // GYRO_CONFIG: Fchoice_b bit 0: 8800 Hz bandwidth, 32 kHz
    glp_mpu_gyro_fchoice_b_mask = 0x03,     // GYRO_CONFIG: 0 puts the filter in
    glp_mpu_accel_fs_sel_shift = 3,         // ACCEL_CONFIG: 0..3 = 2, 4, 8, 16 g
    glp_mpu_accel_fchoice_b = 0x08,         // ACCEL_CONFIG2: 1 bypasses the accelerometer's filter: 4 kHz
    glp_mpu_accel_dlpf_mask = 0x07,         // ACCEL_CONFIG2: A_DLPF_CFG
    glp_mpu_fifo_en_temp = 0x80,            // FIFO_EN
    glp_mpu_fifo_en_gyro = 0x70,            // FIFO_EN: x, y and z
    glp_mpu_fifo_en_accel = 0x08,           // FIFO_EN
    glp_mpu_int_pin_anyrd_2clear = 0x10,    // INT_PIN_CFG
    glp_mpu_int_raw_rdy = 0x01,             // INT_ENABLE and INT_STATUS
    glp_mpu_int_fifo_oflow = 0x10,          // INT_STATUS
    glp_mpu_user_ctrl_fifo_en = 0x40,       // USER_CTRL
    glp_mpu_user_ctrl_i2c_if_dis = 0x10,    // USER_CTRL: SPI only
    glp_mpu_user_ctrl_fifo_rst = 0x04,      // USER_CTRL: clears itself
    glp_mpu_user_ctrl_sig_cond_rst = 0x01,  // USER_CTRL: clears itself
    glp_mpu_pwr_mgmt_1_h_reset = 0x80,      // PWR_MGMT_1: clears itself
    glp_mpu_pwr_mgmt_1_clksel_pll =
        0x01  // PWR_MGMT_1: the best clock there is, the gyro's PLL once it is ready
};

/// WHO_AM_I of the parts that have these registers: MPU-9250 (RM-MPU-9250A-00 rev. 1.4, register 117),
/// MPU-9255 (RM-000008 rev. 1.0; Linux, drivers/iio/imu/inv_mpu6050, INV_MPU9255_WHOAMI_VALUE), and what has
/// been sold as an MPU-9250 since that is no longer made. No document names 75: accelerometer and gyro of
/// such parts work with an MPU-9250's driver, their magnetometer does not (github.com/kriswiner/MPU9250,
/// issue 486).
#define GLP_MPU_9250_ID 0x71U
#define GLP_MPU_9255_ID 0x73U
#define GLP_MPU_9250_75_ID 0x75U
#define GLP_MPU_FIFO_BYTES 512U
#define GLP_MPU_ALL_BYTES 14U  ///< ACCEL_XOUT_H to GYRO_ZOUT_L

/// What a configuration asks of the sensor.
typedef struct glp_mpu_settings {
    uint32_t rate_mHz;
    uint16_t gyro_full_scale_dps;  ///< 250 500 1000 2000
    uint16_t accel_full_scale_g;   ///< 2 4 8 16
    uint16_t dlpf_hz;              ///< Gyro: 250 184 92 41 20 10 5 3600, or GLP_DLPF_OFF
    uint8_t layout;
} glp_mpu_settings;

/// How the sensor is set up for it.
///
/// SMPLRT_DIV divides only while DLPF_CFG is 1 to 6. With 250 Hz, 3600 Hz (8 kHz inside) or the filter
/// bypassed (32 kHz) the sensor gives every one of its own samples; decimation then says that each k-th is
/// taken, from the data registers and without any further filter. Where decimation is 1 the FIFO is used.
typedef struct glp_mpu_plan {
    uint16_t decimation;
    bool fifo;
    uint8_t layout;
    uint8_t sample_bytes;
    uint8_t smplrt_div;
    uint8_t config;
    uint8_t gyro_config;
    uint8_t accel_config;
    uint8_t accel_config2;
    uint8_t fifo_en;
} glp_mpu_plan;

/// A register that did not read back as written, or WHO_AM_I.
typedef struct glp_mpu_fault {
    uint8_t address;
    uint8_t value;
} glp_mpu_fault;

typedef enum glp_mpu_outcome { glp_mpu_ok, glp_mpu_bus_error, glp_mpu_fault_found } glp_mpu_outcome;

/// False when the sensor has no such rate, range, bandwidth or layout. Rates: 1 kHz/(1 + n), n = 0..255, with
/// DLPF 184 to 5 Hz; 8 kHz/k, k = 1..2048, with 250 and 3600 Hz; 32 kHz/k, k = 1..8192, with the filter
/// bypassed; each rounded to a millihertz.
bool glp_mpu_plan_for(const glp_mpu_settings* settings, glp_mpu_plan* plan);
/// Fills the fields of CONFIG that follow from the settings: scales, rate, filter, decimation, registers not
/// included.
void glp_mpu_describe(const glp_mpu_settings* settings, const glp_mpu_plan* plan, glp_config* config);

/// -3 dB of the accelerometer's filter in Hz, as ACCEL_CONFIG2 sets it; 0 of a filter that is bypassed.
static inline uint16_t glp_mpu_accel_bandwidth_hz(uint8_t accel_config2) {
    static const uint16_t by_setting_hz[] = {460, 184, 92, 41, 20, 10, 5, 460};  // table of register 29
    if ((accel_config2 & glp_mpu_accel_fchoice_b) != 0) { return 0; }
    return by_setting_hz[accel_config2 & glp_mpu_accel_dlpf_mask];
}

/// What HELLO calls a sensor; NULL for one whose registers are not known to be these. At most
/// GLP_SENSOR_BYTES characters.
const char* glp_mpu_name(uint8_t who_am_i);

/// Hardware reset, clock choice, identity: one of the three above. Takes about 200 ms of the HAL's delay.
glp_mpu_outcome glp_mpu_reset(const glp_hal* hal, uint8_t* who_am_i, glp_mpu_fault* fault);
/// Writes the plan and reads it back into `registers` (order of glp_config). The FIFO and the interrupt stay
/// off.
glp_mpu_outcome glp_mpu_apply(const glp_hal* hal, const glp_mpu_plan* plan, uint8_t registers[8],
                              glp_mpu_fault* fault);
/// Switches the data-ready interrupt and, if the plan uses it, the FIFO on, and checks as glp_mpu_check does.
/// The FIFO may already hold samples when this returns: empty it at a moment between two interrupts.
glp_mpu_outcome glp_mpu_start(const glp_hal* hal, const glp_mpu_plan* plan, uint8_t registers[8],
                              glp_mpu_fault* fault);
/// Whether a started sensor's registers still hold what the plan wants: a sensor that lost its power or was
/// reset has forgotten it. `registers` as above.
glp_mpu_outcome glp_mpu_check(const glp_hal* hal, const glp_mpu_plan* plan, uint8_t registers[8],
                              glp_mpu_fault* fault);
glp_mpu_outcome glp_mpu_stop(const glp_hal* hal);

/// Two register writes; what is sampled between them is lost.
bool glp_mpu_fifo_empty(const glp_hal* hal);
/// Forgets an overflow that was noted before this call.
bool glp_mpu_overflow_clear(const glp_hal* hal);
/// Bytes in the FIFO, and whether it has overflowed since the last call.
bool glp_mpu_fifo_level(const glp_hal* hal, size_t* bytes, bool* overflowed);

/// Turns `count` FIFO records into wire samples, in place: from accel, temperature, gyro (the order of the
/// registers), big endian, to gyro, accel, temperature, little endian. True when a gyro or accel value stands
/// at the end of its code range (0x7FFF or 0x8000).
bool glp_mpu_arrange(uint8_t* samples, size_t count, uint8_t layout);

#ifdef __cplusplus
}
#endif

#endif
