"""A fitted gyro on a flight that nobody flew, and the recording that it was fitted to: the same sensor?

    made_up_flight.py RECORDING MODEL.json FLIGHT.csv

README.md tells how to run it. The recording told the model; libgyrolog-sensor is that model in the flight's loop;
`gyrolog compare` takes the flight's true rates out and holds what is left against the recording, and against
simulations of the model.
"""

import subprocess
import sys

import numpy as np

import gyrolog_sensor

STEP_S = 0.002  # of the flight: the sensor keeps its own clock
DURATION_S = 1200.0
HEADER = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ref_x_rad_s,ref_y_rad_s,ref_z_rad_s"


def flight(time_s):
    """Rates of a body that turns and sways, in rad/s, and the specific force that it feels, in m/s^2."""
    def sway(period_s, phase):
        return np.sin(2.0 * np.pi * time_s / period_s + phase)
    rate_rad_s = np.column_stack([0.3 * sway(4.1, 0.0), 0.2 * sway(6.7, 1.0), 0.4 * sway(23.0, 2.0)])
    roll, pitch = 0.2 * sway(4.1, 1.5), 0.2 * sway(6.7, 2.5)
    force_m_s2 = 9.80665 * np.column_stack([-np.sin(pitch), np.cos(pitch) * np.sin(roll),
                                            np.cos(pitch) * np.cos(roll)])
    return rate_rad_s, force_m_s2


def fly(model, path):
    """Writes what the sensor shows beside what is true at the same instants."""
    time_s = np.arange(0.0, DURATION_S, STEP_S)
    rate_rad_s, force_m_s2 = flight(time_s)
    with gyrolog_sensor.Sensor(model, seed=7) as gyro:
        samples = gyro.run(time_s, rate_rad_s, force_m_s2)
    true_rad_s, _ = flight(samples["time_s"])
    rows = np.column_stack([samples["time_s"], samples["rate_rad_s"], true_rad_s])
    np.savetxt(path, rows, fmt=["%.9f"] + 6 * ["%.9g"], delimiter=",", header=HEADER, comments="")


def main():
    if len(sys.argv) != 4:
        sys.exit("usage: made_up_flight.py RECORDING MODEL.json FLIGHT.csv")
    recording, model, path = sys.argv[1:]
    fly(model, path)
    for other in (recording, model):
        subprocess.run(["gyrolog", "compare", path, other], check=True)


if __name__ == "__main__":
    main()
