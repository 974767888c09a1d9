/* A body in MuJoCo with a fitted gyro on it: what the gyro shows, beside how the body turned (ref_*), as text
 * that gyrolog reads. README.md tells how to run it. Any body will do that has sensors `gyro` and
 * `accelerometer`, and any model of `gyrolog analyze --model`.
 */
#include <gyrolog_sensor.h>
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>

enum { ROOM = 64 };

static int fail(const char* what, const char* why) {
    fprintf(stderr, "mujoco_gyro: %s: %s\n", what, why);
    return EXIT_FAILURE;
}

/* Where a sensor's three numbers are, or -1. */
static int place_of(const mjModel* body, const char* name) {
    const int id = mj_name2id(body, mjOBJ_SENSOR, name);
    return id < 0 || body->sensor_dim[id] != 3 ? -1 : body->sensor_adr[id];
}

/* A sample beside the true rate at its instant, between two steps. */
static void write_sample(const gyrolog_sensor_sample* sample, const gyrolog_sensor_input* before,
                         const gyrolog_sensor_input* now) {
    const double between = now->time_s - before->time_s;
    const double part = between > 0.0 ? (sample->time_s - before->time_s) / between : 1.0;
    printf("%.9f,%.9g,%.9g,%.9g", sample->time_s, sample->rate_rad_s[0], sample->rate_rad_s[1],
           sample->rate_rad_s[2]);
    for (int axis = 0; axis < 3; ++axis) {
        const double from_rad_s = before->rate_rad_s[axis];
        printf(",%.9g", from_rad_s + part * (now->rate_rad_s[axis] - from_rad_s));
    }
    printf("\n");
}

/* One step of the body. MuJoCo's sensors show the world at the beginning of the step. */
static gyrolog_sensor_input step_body(const mjModel* body, mjData* state, int gyro, int accelerometer) {
    gyrolog_sensor_input now = {.time_s = state->time, .temperature_C = NAN};
    mj_step(body, state);
    mju_copy3(now.rate_rad_s, state->sensordata + gyro);
    mju_copy3(now.specific_force_m_s2, state->sensordata + accelerometer);
    return now;
}

static int run(const mjModel* body, mjData* state, gyrolog_sensor* sensor, double duration_s) {
    const int gyro = place_of(body, "gyro");
    const int accelerometer = place_of(body, "accelerometer");
    if (gyro < 0 || accelerometer < 0) { return fail("body", "no sensors `gyro` and `accelerometer`"); }
    printf("t_s,gx_rad_s,gy_rad_s,gz_rad_s,ref_x_rad_s,ref_y_rad_s,ref_z_rad_s\n");
    gyrolog_sensor_input before = {0};
    while (state->time < duration_s) {
        const gyrolog_sensor_input now = step_body(body, state, gyro, accelerometer);
        gyrolog_sensor_sample samples[ROOM];
        size_t count = 0;
        int status = gyrolog_sensor_step(sensor, &now, samples, ROOM, &count);
        for (;;) {
            if (status < 0) { return fail("sensor", gyrolog_sensor_status_text(status)); }
            for (size_t i = 0; i < count; ++i) { write_sample(&samples[i], &before, &now); }
            if (status != GYROLOG_SENSOR_MORE) { break; }
            status = gyrolog_sensor_take(sensor, samples, ROOM, &count);
        }
        before = now;
    }
    return fflush(stdout) == 0 ? EXIT_SUCCESS : fail("output", "cannot be written");
}

int main(int count, char** words) {
    if (count < 4) {
        fprintf(stderr, "usage: mujoco_gyro BODY.xml MODEL.json SECONDS [SEED]\n");
        return 2;
    }
    char why[512] = "";
    mjModel* body = mj_loadXML(words[1], NULL, why, (int)sizeof why);
    if (body == NULL) { return fail(words[1], why); }
    const uint64_t seed = count > 4 ? strtoull(words[4], NULL, 10) : 1;
    gyrolog_sensor* sensor = gyrolog_sensor_open(words[2], seed, 0.0, why, sizeof why);
    if (sensor == NULL) {
        mj_deleteModel(body);
        return fail(words[2], why);
    }
    mjData* state = mj_makeData(body);
    if (body->nkey > 0) { mj_resetDataKeyframe(body, state, 0); }
    const int status = run(body, state, sensor, strtod(words[3], NULL));
    gyrolog_sensor_close(sensor);
    mj_deleteData(state);
    mj_deleteModel(body);
    return status;
}
