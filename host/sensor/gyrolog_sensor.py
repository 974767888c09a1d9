"""A gyro as gyrolog models it, in the loop of another simulator: libgyrolog-sensor for Python.

    import gyrolog_sensor
    with gyrolog_sensor.Sensor("imu.model.json", seed=1) as gyro:
        while simulating:
            samples = gyro.step(time_s, rate_rad_s, specific_force_m_s2)
        # or all steps at once, arrays in, arrays out:
        samples = gyro.run(time_s, rate_rad_s, specific_force_m_s2)

SI units; what the numbers mean is told in gyrolog_sensor.h. GYROLOG_SENSOR_LIBRARY names another library than
the installed one.
"""

import ctypes
import ctypes.util
import math
import os

import numpy as np

SAMPLE = np.dtype([("index", np.uint64), ("time_s", np.float64), ("rate_rad_s", np.float64, 3),
                   ("temperature_C", np.float64), ("counts", np.int32, 3)], align=True)
_INPUT = np.dtype([("time_s", np.float64), ("rate_rad_s", np.float64, 3),
                   ("specific_force_m_s2", np.float64, 3), ("temperature_C", np.float64)], align=True)
_MORE = 1
_AT_REST = (0.0, 0.0, 9.80665)


def _load():
    name = os.environ.get("GYROLOG_SENSOR_LIBRARY") or ctypes.util.find_library("gyrolog-sensor")
    library = ctypes.CDLL(name or "libgyrolog-sensor.so.0")
    pointer, size, double = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_double
    for function, answer, arguments in (
            ("open", pointer, (ctypes.c_char_p, ctypes.c_uint64, double, ctypes.c_char_p, size)),
            ("close", None, (pointer,)),
            ("rate_hz", double, (pointer,)),
            ("lsb_rad_s", double, (pointer, ctypes.c_int)),
            ("step", ctypes.c_int, (pointer, pointer, pointer, size, ctypes.POINTER(size))),
            ("take", ctypes.c_int, (pointer, pointer, size, ctypes.POINTER(size))),
            ("status_text", ctypes.c_char_p, (ctypes.c_int,)),
            ("version", ctypes.c_char_p, ())):
        entry = getattr(library, "gyrolog_sensor_" + function)
        entry.restype, entry.argtypes = answer, arguments
    return library


_library = _load()


def version():
    return _library.gyrolog_sensor_version().decode()


class Sensor:
    """One gyro. `rate_hz` takes the place of the model's."""

    def __init__(self, model, seed=1, rate_hz=0.0):
        why = ctypes.create_string_buffer(1024)
        self._sensor = _library.gyrolog_sensor_open(os.fsencode(model), seed, rate_hz, why, len(why))
        if not self._sensor:
            raise ValueError(why.value.decode(errors="replace"))
        self.rate_hz = _library.gyrolog_sensor_rate_hz(self._sensor)
        self.lsb_rad_s = np.array([_library.gyrolog_sensor_lsb_rad_s(self._sensor, axis) for axis in range(3)])
        self._room = np.empty(64, SAMPLE)
        self._now = np.empty(1, _INPUT)
        self._count = ctypes.c_size_t()

    def close(self):
        sensor, self._sensor = self._sensor, None
        _library.gyrolog_sensor_close(sensor)

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def step(self, time_s, rate_rad_s=(0.0, 0.0, 0.0), specific_force_m_s2=_AT_REST, temperature_C=math.nan):
        """One of the simulator's steps: the samples that are due, an array of SAMPLE. Often it is empty."""
        self._now[0] = (time_s, rate_rad_s, specific_force_m_s2, temperature_C)
        return self._step(self._now.ctypes.data)

    def run(self, time_s, rate_rad_s=None, specific_force_m_s2=None, temperature_C=None):
        """Many steps: times of shape (n,), rates and forces of (n, 3), temperatures of (n,)."""
        steps = np.empty(len(time_s), _INPUT)
        steps["time_s"] = time_s
        steps["rate_rad_s"] = 0.0 if rate_rad_s is None else rate_rad_s
        steps["specific_force_m_s2"] = _AT_REST if specific_force_m_s2 is None else specific_force_m_s2
        steps["temperature_C"] = math.nan if temperature_C is None else temperature_C
        first = steps.ctypes.data
        due = [self._step(first + i * steps.itemsize) for i in range(len(steps))]
        return np.concatenate(due) if due else np.empty(0, SAMPLE)

    def _step(self, now):
        if not self._sensor:
            raise ValueError("the sensor is closed")
        count, room = self._count, self._room
        status = _library.gyrolog_sensor_step(self._sensor, now, room.ctypes.data, len(room), count)
        parts = [room[:count.value].copy()]
        while status == _MORE:
            status = _library.gyrolog_sensor_take(self._sensor, room.ctypes.data, len(room), count)
            parts.append(room[:count.value].copy())
        if status < 0:
            raise ValueError(_library.gyrolog_sensor_status_text(status).decode())
        return parts[0] if len(parts) == 1 else np.concatenate(parts)
