#include "host/app/manual_text.hpp"

#include <algorithm>
#include <array>

namespace gyrolog {
namespace {

struct ManualText {
    std::string_view command;  // empty: the program
    std::string_view text;
};

constexpr std::array texts{
    ManualText{
        "",
        R"(`gyrolog` finds the board and captures with a live view (device time, samples, rate, dropouts, CRC
errors, temperature, bytes on disk; the Allan deviation so far, and how much longer until the random
walk K is known to ±20 %). `m` writes a note into the capture, which `gyrolog info` shows with its
time; `s` stops the board and starts it again; `q` or Ctrl-C closes the file and analyses it: the
report on the screen, and beside the capture its `.json`, `.png`, `.accelerometer.png` and
`.model.json`. SIGTERM and SIGHUP close the file only. Without a board it says what it looked for
and what it found instead; `gyrolog --device sim:` runs the virtual one in real time.

A figure is a `.png`, or for paper a `.svg` or `.pdf`, by the ending of its name, with every command
that has `--plot`. It is 180 mm wide, the text of a page or two columns of a journal, and no letter
is smaller than 8 pt. `--plot-width 88` fits one column of a journal, with the panels below each
other and a wide table in letters of 7 pt; `--plot-width 240` is wider with letters of the same
size. `--plot-dpi 150` makes a `.png` coarser than 300 dots to the inch; the file itself says how
large it is to be printed.
Colours differ in grey, too.

On a terminal, what takes longer than a second says how far it is and how long it will still take.
`--quiet` leaves that out, and the notices of what was written; warnings and errors remain.

Each JSON document names its schema. JSON Schemas (draft 7) of all of them stand in
host/formats/schemas, and in `/usr/share/gyrolog/schemas`: `gyrolog-model/1` is
`gyrolog-model-1.schema.json`. They let no unknown key pass; the program itself keeps unknown keys
of a model.)"},
    ManualText{
        "list",
        R"(The program recognises a board by its id 1209:6779 together with a product name that begins with
`gyrolog`. A device with only one of the two, or one that sends no HELLO, is left to its driver;
`gyrolog list` says what it lacks. The id is not granted yet: the application
has not been sent (firmware_protocol/USB_ID.md); boards that still have 1fc9:0083 work, with a warning.

Unplug a board that was there before the rule, and plug it in again: the rule acts when a device
appears. It lets whoever sits at the machine use the board, and the group plugdev also over ssh (its
serial port: the group dialout). The package brings the rule along.)"},
    ManualText{
        "capture",
        R"(If a board is lost, the capture waits for it and goes on in `night.2.pcapng`; with `--on-unplug
exit` it ends. `--rotate-size 2G` and `--rotate-every 6h` begin a new file, too. Every command takes
all files of a capture by the name of the first. `--min-free 10G` ends a capture before less than 10
GB are free. `--device` may be given several times, and `usb:*` names all boards; each board has its
own file, `night-SERIAL.pcapng`. The program says at the start how long the computer may be busy
elsewhere without a loss.

Exit status: 0 all is there, 5 something is missing, 4 the board is lost, 6 the disk is full, 128 +
the signal's number if a signal ended the capture before `--duration`. What came before is saved in
each case. A kill costs what came in the last 250 ms and during the last two writes to the file. A
loss of power costs what came since the last finished sync; a sync begins every second.
host/DESIGN.md has what is promised for each fault, and its test.

While a board is captured, `gyrolog capture -o a.pcapng --denoise joint` writes `a.denoised.csv` as
the samples come, the same that `denoise` would write afterwards, and shows the noise before and
after. The board rests for the first 10 s, from which its noise is learned, or `--denoise-model`
tells it. One board at a time; an array is denoised afterwards.)"},
    ManualText{"analyze", R"(`analyze` also reads text: one header line with the unit in each column's name
(`t_s,gx_dps,gy_dps,gz_dps,temp_C`, also `_rad_s`, `_lsb` with `--lsb-dps`, integrated angles
`gx_deg`, increments `dgx_deg`, arrays `gx1_dps gx2_dps`), plain or `.xz`, `.gz`, `.zst`. Time
stamps that mark the sampling instants show where samples are missing; stamps that mark when data
arrived (bursts) give the mean rate only, and the report says so.

Recordings of other programs are read as they are: names such as `Gx (deg/s)`, `gyr_x`,
`angular_velocity.x`, `timestamp [ns]` (ROS, EuRoC, PX4, loggers of telephones), columns parted by
semicolons, tabs or blanks with decimal commas or points, comments before the names; MATLAB's `.mat`
and NumPy's `.npy`. A warning says how each column was understood. The program asks for what no name
tells; `--columns`, `--unit`, `--acc-unit` and `--rate` say it.

`analyze --curve` fits the complete noise model to a curve that is only known from print
(`tau_s,x_dps` or `x_deg_per_h`, `x_rad_s`; of an accelerometer `x_ug`, `x_mg`, `x_g`, `x_m_s2`),
shows which term brought it how close, and, where a file holds `sensor_x` and `simulation_x`, which
terms the simulation lacks.

What the analysis gives, per axis: the overlapping Allan deviation (or the standard, modified,
Hadamard or total one) with intervals that hold up to the last averaging time; Q, N, B, K and R by
likelihood of the samples, each identified with its uncertainty beside the Cramér-Rao bound, or
bounded from above (in JSON with the best estimate); Gauss-Markov noise and steady lines where the
data call for them; the same coefficients by the textbook's reading of slopes; the spectrum; the
static bias with its expanded uncertainty. If the model does not hold for a record (a filter,
vibration, motion), a warning says so; of one in motion no model and no filter's parameters are
made, a touch of less than a tenth of it apart. `--robust` removes single outliers first. If the
recording has a temperature (`temp_C`), the report says how the bias follows it, per degC; a drift
that is there beyond chance is taken off before the noise is analysed, unless `--keep-temperature`
is given.

`--from 30s --to 2h` looks at that part of a recording, and `--still auto` at the longest part in
which nothing turns: in `analyze`, `compare`, `diagnose`, `export` and `report`; `denoise`, whose
`--still` is where it learns the noise, has the first two.

An accelerometer in the recording (in text `ax_g ay_g az_g`, also `_m_s2`, `_lsb` with `--lsb-g`) is
reported beside the gyro, by the same methods: N, B and K in ug, m/s/sqrt(h) and SI, and instead of
a bias the size of gravity and the tilt, since one position does not tell the bias. JSON has it as
`accelerometer`, with `mean` in the place of `bias`; its figure is `night.accelerometer.png` beside
`night.png`, and the model has an `accelerometer`, which `simulate` plays at rest, or in the poses of
a recording (`--like`) that has an orientation and no accelerometer. With `--sensor
accelerometer`, `compare`, `diagnose` and `denoise` look at it in the gyro's place, with numbers in
g; `diagnose --sensor all` at both, and says which causes both have at the same place: a line, an
instant, lost or repeated frames. analysis/METHODS.md has each estimator's definition, source and
validity.

`compare`, `diagnose`, `denoise`, `export` and `report` take the same options for text.)"},
    ManualText{
        "report",
        R"(The page shows what was recorded and what is missing, the Allan deviation and the spectrum, each
coefficient in every common unit with its meaning for a filter, the bias over time and temperature,
the diagnosis against `--model`, and how long the next recording has to be. It is one HTML file with
its figures inside. It has no scripts and fetches nothing.

From results of many recordings (`.jsonl`, what `table` reads) it makes a page on the units: how far
they lie apart in each coefficient, as a table and as a figure with every unit, which stand out, the
causes that the diagnoses name with the range of their shares, and which recordings have an error
or, with `--expected`, no answer.)"},
    ManualText{
        "compare",
        R"(With a model, the recording is simulated 40 times (`--simulations`, `--seed`): at its instants, with
its holes, temperature and motion, and with the sensor drawn within the uncertainties that the model
states. For each axis the figure shows both signals in time on the same scale, both distributions,
and the Allan deviation and the spectrum over the band of the simulations; on narrow paper fewer of
them. At each point one more simulation lies within that band with a probability of 95.12 %. The
text says where the recording lies outside and by how many decibels, unless chance does as much. It
ends in one sentence for each axis: "x: the simulation is too quiet by 4.7 dB at 13 ms". It names no
cause.)"},
    ManualText{
        "calibrate",
        R"(It needs no level table. Lay the sensor down in at least nine poses for some seconds each, the six
faces and some edges, and move it by hand in between: the size of gravity at rest tells the
accelerometer's scale, misalignment and bias, the moves from one pose to the next the gyro's scale
and misalignment, the rests its bias and how it follows the specific force. `--turn 360` adds turns
by that angle about an upright axis, from rest to rest, whole or in parts; columns `ref_x_dps
ref_y_dps ref_z_dps` (or `ref_qw` ...) of a turntable take the place of moves and turns. A rest
during which `temp_C` changes by 5 degC or more gives the bias over temperature, to the third order
where the data support it.

Each parameter comes with one sigma. The report names what the recordings do not determine, and what
to record for it. If they determine nothing but the gyro's bias, there is no answer (exit status 1).
The text ends with the poses that would help most next. `--json` has covariances and residuals, too
(`gyrolog-calibration/1`, host/formats/calibration_json.hpp). A wrong sampling rate, or axes that
differ between the two sensors, are warned of: gravity does not go where the gyro says. `--px4` and
`--ardupilot` write offsets, scales and polynomials as those programs read them; neither has a
matrix, and the file's head says how much that leaves. The C header has all of it, with the
functions that apply it.)"},
    ManualText{
        "conform",
        R"(A failure says what was expected, what came, and the bytes. Rules that cannot be seen from outside
are listed as not tested.)"},
    ManualText{"diagnose", R"(What it says, in the order in which one asks:

- Could the recording have come from the model at all? How large is the gap, in units of what two
simulations differ by (`--simulations`, `--seed`)?

- How much of it is explained, and by what? A table has a row for each cause: its axes, its size
with the uncertainty, its share of the gap with an interval, and the probability that it is right.

- What is left, and where? Which recording would tell more?

- What are the causes, in words?

The verdict is "none", "known", "partly" (a tenth of the gap or more is explained, and more than a
tenth is left) or "unexplained". A cause may be the model's: "the model has a line at 31 Hz that the
recording lacks". Gap and shares are measured by simulating, on parts of the recording that the fit
did not use, or on the second recording; shares may overlap. The effects are those of `gyrolog
simulate --effects`. If the recording cannot tell two of them apart, the report calls it a tie and
names the recording that would decide. `--verbose` adds every parameter, place and rival, and what
could not be tested.

If the causes leave something, it is modelled without a name: by axis a density of the noise, a mean
over the temperature, a mean over the rate. The report says how much of the gap that closes, and
`--unnamed` puts it into the model. If the model was fitted to a recording with the effect, it holds
part of the effect as noise; the report states the noise without that part.

`--json` writes schema `gyrolog-diagnosis/2` (`host/formats/diagnosis_json.hpp`). `--plot` shows the
shares as bars and below them the curves that stand out, before and after. `--model-out` writes the
model with the causes added, ready for `simulate`; tables such as `density_table` (`gyrolog simulate
--effects`) can also be written by hand.

A recording of more than nine million samples, 25 h at 100 Hz, is diagnosed in two passes if it is
at rest: its first 900 000 samples one by one for what is fast, and all of it in means of some 0.1 s
for what is slow. One report says what both found. 24 h at 1 kHz take less than 1 GB. Of a recording
in motion the beginning is diagnosed. `--average 10` looks at means of ten samples only.

`--sensor accelerometer` holds the accelerometer at rest against the model. If it is set down in
several poses and the recording has its orientation (`ref_qw` ... `ref_qz`, sensor to world, z
upward), it is judged in these poses against gravity: scale factor, misalignment, nonlinearity and
bias show there, and what is between the rests is left out. Six faces of 20 s each tell a scale
factor to 0.004 % where the noise is 150 ug/sqrt(Hz); edges tell it from a cubic error. Without an
orientation a recording in which it is turned or moved is refused; `--still auto` takes the longest
part at rest of one, and `gyrolog calibrate` needs none. A gyro that is turned for more than a
tenth of the time without a reference (`ref_x_dps` ... or `ref_qw` ...) is refused likewise.

If the reference is an orientation (`ref_qw` ... `ref_qz`), its rates are far noisier than the
sensor. The sensor's noise is then judged at its longest rest, and how it answers to the motion in
means of 50 ms. If it is a rate (`ref_x_dps` ...) and the model has no `ref_noise_dps`, its noise is
that of its samples where the sensor rests. The report states the reference's error, delay and
bandwidth first.

Of an array (`gx1_dps`, `gx2_dps` ...) `--gyro 2` takes one gyro, and `--reference others` makes the
others its reference: their mean, each brought to the median response of all, so that a fault of one
is named for that one alone. What most of them share does not show.

analysis/METHODS.md has how often the answer is right on recordings whose effect the program is not
told.

`--curve` needs no recording. It says at which averaging times the model is wrong, which coefficient
is off by what factor, which term is missing, which share of the gap each change closes, and where
the curve is still off. A file that holds `sensor_x` and `simulation_x` needs no model either.

`--ask` takes an effect of your own: a filter's coefficients (`biquad`), a table of the noise's
density, a course of the bias over time, temperature or rate. It says how much of it the recording
has, beside the causes and without them:

  {"schema": "gyrolog-effect/1", "name": "heater", "effect": "time_table", "axes": ["z"],
   "table": {"t_s": [0, 600, 1200], "bias_dps": [0, 0.02, 0]}})"},
    ManualText{
        "denoise",
        R"(It combines the units of an array by a Kalman filter that knows their noise, drift and correlation
(`--method kalman`), takes noise out by a wavelet threshold in real time (`wavelet`), or does both
(`joint`, without `--method`). All are causal; the report states their lag, and in motion against a
reference (`ref_x_dps`) the error by lag and by noise apart. The units' noise is learned from a part
at rest that is found by itself, or named with `--still 0,120`, from another recording
(`--calibration`), or taken from models (`--model`). A unit that is stuck, saturated or noisy is
left out, and the report names it. The report also shows what the units have in common, band by
band, and what averaging could gain there at most.

`kalman` alone passes every motion; `--bandwidth` and `--rate-model` smooth (`walk`, `trend`, or
`adaptive`: narrow when calm, the whole bandwidth in motion, which is what `joint` does by itself).
Units must have parallel axes. analysis/METHODS.md compares the results with published figures, and
says where they fall short.)"},
    ManualText{
        "simulate",
        R"(A model by hand needs little: `{"schema": "gyrolog-model/1", "rate_hz": 100, "axes": {"x": {"N":
0.01}, "y": {"N": 0.01}, "z": {"N": 0.01}}}`, N in deg/s/sqrt(Hz). What is not stated is zero and
exactly known; `diagnose`, `compare` and `--like` take rate, step and range from the recording, and
say so.

With `--like`, time stamps, holes, temperature, reference rate (`ref_x_dps` or an orientation
`ref_qw`) and specific force come from a recording, row by row, and only the gyro is new: simulation
and reality can then be compared sample by sample. Effects of the model on time stamps do not act on
copied stamps; a warning names them.

Three other files are models, too. A data sheet (`gyrolog-datasheet/1`, with an example for the
MPU-9250 in host/formats/datasheet_json.hpp) gives tolerances: the seed draws a unit from them, and
the output says what the sheet does not give. The parameters of MathWorks' gyroparams and IMU block
(`gyrolog-gyroparams/1`, host/formats/gyroparams_json.hpp) are read under their own names. These two
must say whether their densities are one-sided or two-sided. A population (`gyrolog-population/1`,
host/formats/population_json.hpp) is what `gyrolog table` measured of many units.

The virtual board runs on the same models: what `gyrolog capture --device sim:model=FILE,seed=7`
captures is, count by count, what `gyrolog simulate FILE --seed 7` writes, unless a narrow `--dlpf` or
`dlpf=` is asked for.)"},
    ManualText{
        "export",
        R"(`export` tells the format by the ending: `.csv` (`.gz`, `.xz`), `.mat` (MATLAB), `.yaml` (Kalibr),
`.m` (a MATLAB gyroparams object), `.tuning.json` (process noise of a Kalman filter); a model file
is a source too. Where the user had stopped the board, the text has one more column, `stopped_s`: 0,
or in the first sample behind the pause how long it was, so that no reader takes it for a loss.

With --for and the name of a filter it writes white noise and random walk of gyro and accelerometer,
from a recording or a model, under the names and in the units of `kalibr`, `openvins`,
`vins-fusion`, `orb-slam3`, `gtsam` (Python), `px4-ekf2` (`.params`), `ardupilot-ek3` (`.parm`), and
the covariances of `sensor-msgs-imu`, which is also what `robot-localization` takes. The numbers
make the filter's covariance grow as the sensor's errors do, N² t + K² t³ / 3. The head of the file
says whether a number is continuous or discrete and at which rate, how it enters the filter's
equations, which of the filter's faults it makes up for, and the source of that. A term that is not
identified is left out, and its upper limit is given; with `--upper-limits` that limit stands in its
place, for readers that end without it, such as Kalibr. The head also names what no such number can
express (lines, 1/f noise, a spectrum that is not white, the temperature). Only `--inflate FACTOR`
makes the numbers larger than the sensor's, and the head says so.

`gyrolog diagnose --model FILE --model-out` with the same ending writes the user's file with its
numbers changed, approximated as by `export` (`--horizon`). The rest of the file stays, comments
too; the terminal and the file's head say what the file has no place for. A name that ends in
`.json` (`.model.json` where the simulator's file itself is `.json`) gets the whole model. If a file
has several sensors, name one behind a `#`, by as much of the end of its name as tells it from the
others.

With --for and the name of a simulator it writes the model as that simulator's own file, for `sdf`
(gz-sensors, Gazebo classic), `px4-classic`, `rotors`, `pegasus`, `isaaclab`, `mjcf`, `airsim`,
`genesis`, `carla`, `jmavsim`, `gnss-ins-sim`, `navego` and `webots`. These simulators know white
noise and at most a random-walk or Gauss-Markov bias. 1/f noise and the rest are approximated by
these terms, so that the Allan deviation is nearest to the model's for averaging times up to the
horizon. The head of the file states the largest error in dB, what is left out, and the conventions
and faults of the simulator with their source.

SDF (gz-sensors, Gazebo classic), the imu plugins of PX4 and RotorS, MuJoCo's MJCF, AirSim's
`settings.json` and Kalibr's `imu.yaml` are recognised by their content, wherever a model is read:
`diagnose`, `compare`, `denoise`, `report`, `simulate`, `export`, `sim:model=`. The output says how
each number was read, which value the simulator itself takes where the file states none, and what is
left out.)"},
    ManualText{
        "table",
        R"(With `--jsonl` a command takes many recordings and writes a line of JSON for each as it finishes:
what `--json` writes, with the recording's name (`file`) and `seconds`. A recording that cannot be
read is a line with `exit` and `error`; the others are done all the same. The exit status is the
worst of all: 6, then 2, 1, 5, 0. `compare` compares each with the last name. Ctrl-C leaves whole
lines.

`table` joins the lines about each recording, a row for each axis (`host/fleet/fleet_table.hpp` has
the columns), as `.csv` or `.sqlite`. A recording that `--expected` lists and no line is about is a
row, too. `outlier` names the parameters in which a unit differs from the others, by the robust z of
the median absolute deviation: beyond what 1 in 2150 of Gaussian values has by chance, 3.5 of many
units, 5.2 of 20, 8 of 10 and 36 of 5. `--population` writes how the units differ, by axis and parameter:
median, robust standard deviation between units with its interval, and their number; `simulate`
draws units from it as from a data sheet. tools/fleet/README.md spreads a list over hosts with GNU
parallel, or over a Slurm cluster. A line is the answer of its command with `file`, `exit`, `error`
and `seconds` added; one without an answer is `gyrolog-unanswered-line.schema.json`.

The lines are plain JSON: DuckDB reads them without the table, and a test holds the numbers of both
against each other.

  select file, axes.x.bias.value, axes.x.coefficients.N.value from 'analyses.jsonl' where axes.x.bias.value > 0.5;)"},
    ManualText{"doctor",
               R"(Exit status 0: nothing prevents a capture; 1: something does. `--json` writes schema
`gyrolog-doctor/1`.)"},
    ManualText{
        "extcap",
        R"(The package brings a dissector (`tools/gyrolog.lua`) and an entry for Wireshark's list of interfaces
(`tools/wireshark_extcap`): each board that is plugged in stands there, and a simulated one.

Without the package, link them into the folders that Help > About > Folders names, as `gyrolog.lua`
and `gyrolog`.)"},
};

}  // namespace

std::string_view manual_text(std::string_view command) {
    const auto* found = std::ranges::find(texts, command, &ManualText::command);
    return found == texts.end() ? std::string_view() : found->text;
}

}  // namespace gyrolog
