// SPI and sensor: each byte takes its time on the wire.
#include "spi.h"

#include "../../../device/mpu9250.h"
#include "../registers.h"
#include "../sample_clock.h"
#include "../synthetic_sensor.h"
#include "load_log.h"
#include "port.h"
#include "sample_timer.h"
#include "sensor_model.h"

enum { READ = 0x80, FAST_HZ = 12000000, SLOW_HZ = 1000000, BITS = 8 };

static uint32_t byte_ticks = CORE_HZ / SLOW_HZ * BITS;
static uint32_t line_free_at;  // when the last byte that was put has passed the wire
static uint32_t due_at[SPI_FIFO_ENTRIES];
static uint8_t under_way[SPI_FIFO_ENTRIES];
static uint32_t put;
static uint32_t got;
static bool reading;
static uint8_t address;
static uint32_t place;  // of the byte in its transfer
static uint8_t level[2];
static uint32_t selected_at;
static uint32_t before_selection;

void sensor_model_start(void) {
    synthetic_sensor_reset();
    sample_clock_start();
}

// A transfer counts as time of the bus, with all that the core does meanwhile.
void sensor_model_select(bool selected) {
    if (selected) {
        place = 0;
        selected_at = line_free_at = sample_timer_now();
        before_selection = load_now.interrupt + load_now.apart;
    } else {
        interrupts_off();
        const uint32_t meanwhile = load_now.interrupt + load_now.apart - before_selection;
        load_now.bus += sample_timer_now() - selected_at - meanwhile;
        interrupts_on();
    }
}

void spi_start(void) { got = put; }

void spi_set_fast(bool fast) { byte_ticks = CORE_HZ / (fast ? FAST_HZ : SLOW_HZ) * BITS; }

static uint8_t read_one(void) {
    // Both bytes of the FIFO's count are of one moment.
    if ((address == glp_mpu_fifo_counth) && (place == 1U)) {
        synthetic_sensor_read(address, level, sizeof level);
    }
    if ((address == glp_mpu_fifo_counth) && (place <= sizeof level)) { return level[place - 1U]; }
    uint8_t byte = 0;
    synthetic_sensor_read((address == glp_mpu_fifo_r_w) ? address : (uint8_t)(address + place - 1U), &byte,
                          1);
    return byte;
}

static uint8_t exchange(uint8_t byte) {
    uint8_t answer = 0;
    interrupts_off();
    if (place == 0U) {
        address = (uint8_t)(byte & ~(unsigned)READ);
        reading = (byte & READ) != 0;
    } else if (reading) {
        answer = read_one();
    } else {
        synthetic_sensor_write(address, byte);
        sample_clock_follow_sensor(CORE_HZ);
    }
    ++place;
    interrupts_on();
    return answer;
}

bool spi_put(uint8_t byte) {
    if (put - got == SPI_FIFO_ENTRIES) { return false; }
    const uint32_t now = sample_timer_now();
    if ((int32_t)(line_free_at - now) < 0) { line_free_at = now; }
    line_free_at += byte_ticks;
    under_way[put % SPI_FIFO_ENTRIES] = byte;
    due_at[put % SPI_FIFO_ENTRIES] = line_free_at;
    ++put;
    return true;
}

bool spi_get(uint8_t* byte) {
    if ((put == got) || ((int32_t)(sample_timer_now() - due_at[got % SPI_FIFO_ENTRIES]) < 0)) {
        return false;
    }
    *byte = exchange(under_way[got % SPI_FIFO_ENTRIES]);
    ++got;
    return true;
}
