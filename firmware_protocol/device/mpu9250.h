/// InvenSense MPU-9250: the registers this project uses and their set-up. Names and addresses as in the register map
/// (RM-MPU-9250A-00).
#ifndef GYROLOG_PROTOCOL_DEVICE_MPU9250_H
#define GYROLOG_PROTOCOL_DEVICE_MPU9250_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gyrolog_protocol/message.h>

#include "hal.h"

enum {
    glp_mpu_smplrt_div = 0x19,
    glp_mpu_config = 0x1A,
    glp_mpu_gyro_config = 0x1B,
    glp_mpu_accel_config = 0x1C,
    glp_mpu_accel_config2 = 0x1D,
    glp_mpu_fifo_en = 0x23,
    glp_mpu_int_pin_cfg = 0x37,
    glp_mpu_int_enable = 0x38,
    glp_mpu_int_status = 0x3A,
    glp_mpu_accel_xout_h = 0x3B,
    glp_mpu_temp_out_h = 0x41,
    glp_mpu_gyro_xout_h = 0x43,
    glp_mpu_signal_path_reset = 0x68,
    glp_mpu_user_ctrl = 0x6A,
    glp_mpu_pwr_mgmt_1 = 0x6B,
    glp_mpu_pwr_mgmt_2 = 0x6C,
    glp_mpu_fifo_counth = 0x72,
    glp_mpu_fifo_r_w = 0x74,
    glp_mpu_who_am_i = 0x75
};

#define GLP_MPU_WHO_AM_I 0x71U
#define GLP_MPU_FIFO_BYTES 512U

