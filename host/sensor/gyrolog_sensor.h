/* A gyro as gyrolog models it, in the loop of another simulator.
 *
 * Open a sensor from a model file; tell it at each step of the simulator what the body does; take the samples
 * that the sensor has made meanwhile; close it. The sensor keeps its own clock: a step may be shorter or
 * longer than its sampling period, and steps need not be equal. Samples are those of `gyrolog simulate` for
 * the same model and seed, bit for bit: at rest as they are, in motion with straight lines between the steps.
 *
 *     char why[256];
 *     gyrolog_sensor *gyro = gyrolog_sensor_open("imu.model.json", 1, 0.0, why, sizeof why);
 *     ...
 *     gyrolog_sensor_input now = {time_s, {p, q, r}, {fx, fy, fz}, NAN};
 *     gyrolog_sensor_sample samples[8];
 *     size_t count;
 *     int status = gyrolog_sensor_step(gyro, &now, samples, 8, &count);
 *
 * SI units. No call but open and close allocates memory. A sensor is used by one thread at a time; any number
 * of sensors may be open.
 */
#ifndef GYROLOG_SENSOR_H
#define GYROLOG_SENSOR_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
    #define GYROLOG_SENSOR_API __attribute__((visibility("default")))
#else
    #define GYROLOG_SENSOR_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gyrolog_sensor gyrolog_sensor;

typedef struct {
    double time_s;        /* the simulator's; the first step is the sensor's first sampling instant */
    double rate_rad_s[3]; /* the body's angular rate, in its own axes */
    double specific_force_m_s2[3]; /* what an ideal accelerometer shows: at rest, z upward, 9.80665 on z */
    double temperature_C;          /* around the sensor; NAN in all steps: the sensor makes it up */
} gyrolog_sensor_input;

typedef struct {
    uint64_t index;       /* of the sensor's clock, from 0; a sample that the sensor lost is missing */
    double time_s;        /* what its time stamp says, on the simulator's time */
    double rate_rad_s[3]; /* as read: rounded and clipped */
    double temperature_C; /* as the sensor's thermometer shows it */
    int32_t counts[3];    /* the converter's; 0 where gyrolog_sensor_lsb_rad_s() is 0 */
} gyrolog_sensor_sample;

enum {
    GYROLOG_SENSOR_OK = 0,
    GYROLOG_SENSOR_MORE = 1,            /* no room for all: gyrolog_sensor_take() gives the rest */
    GYROLOG_SENSOR_BAD_ARGUMENT = -1,   /* a null pointer */
    GYROLOG_SENSOR_TIME = -2,           /* not later than the step before: nothing was done */
    GYROLOG_SENSOR_NOT_FINITE = -3,     /* an input: nothing was done */
    GYROLOG_SENSOR_TEMPERATURE = -4,    /* told in some steps and not in others: nothing was done */
    GYROLOG_SENSOR_STEPS_FORGOTTEN = -5 /* the sensor's delay is longer than the 8192 steps it remembers */
};

/* `path`: a gyrolog-model/1, a data sheet or gyroparams, as `gyrolog simulate` reads them; `seed`: as its
 * --seed; `rate_hz`: in place of the model's, 0 for the model's. NULL where it cannot be: the reason is then
 * in `why` (cut to its size; may be NULL). */
GYROLOG_SENSOR_API gyrolog_sensor* gyrolog_sensor_open(const char* path, uint64_t seed, double rate_hz,
                                                       char* why, size_t why_size);
GYROLOG_SENSOR_API void gyrolog_sensor_close(gyrolog_sensor* sensor); /* NULL is allowed */

GYROLOG_SENSOR_API double gyrolog_sensor_rate_hz(const gyrolog_sensor* sensor);
/* rad/s a count of axis 0, 1 or 2; 0 of a model without a step. */
GYROLOG_SENSOR_API double gyrolog_sensor_lsb_rad_s(const gyrolog_sensor* sensor, int axis);

/* One of the simulator's steps. Writes at most `room` samples that are due and their number to `count`. A
 * sample is due when its instant is reached, and the moment of the world that it shows. */
GYROLOG_SENSOR_API int gyrolog_sensor_step(gyrolog_sensor* sensor, const gyrolog_sensor_input* now,
                                           gyrolog_sensor_sample* samples, size_t room, size_t* count);
/* What is still due, without a step. */
GYROLOG_SENSOR_API int gyrolog_sensor_take(gyrolog_sensor* sensor, gyrolog_sensor_sample* samples,
                                           size_t room, size_t* count);
/* In English; for every status. */
GYROLOG_SENSOR_API const char* gyrolog_sensor_status_text(int status);
/* gyrolog's version. */
GYROLOG_SENSOR_API const char* gyrolog_sensor_version(void);

#ifdef __cplusplus
}
#endif

#endif
