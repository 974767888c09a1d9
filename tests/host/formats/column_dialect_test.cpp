// Recordings as other programs write them, by hand and a few rows each: what comes out is what the canonical
// text of the same numbers gives.

#include "host/formats/column_dialect.hpp"

#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "host/formats/curve_csv.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/formats/stamp_unit.hpp"
#include "host/formats/understood_columns.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Recording dialect_read(const std::string& text, const CsvReadOptions& options = {}) {
    Result<Recording> recording = parse_recording_csv(text, "test.csv", options);
    EXPECT_TRUE(recording.ok()) << (recording.ok() ? "" : recording.error().message) << "\nof\n" << text;
    return recording.ok() ? std::move(recording).value() : Recording{};
}

Error dialect_refusal(const std::string& text, const CsvReadOptions& options = {}) {
    const Result<Recording> recording = parse_recording_csv(text, "test.csv", options);
    return recording.ok() ? Error{ErrorCode::failed, "accepted"} : recording.error();
}

struct Sample {
    int index;
    double gx, gy, gz, ax, ay, az;
};
constexpr std::array samples = {
    Sample{0, 0.0125, -0.25, 0.0625, 9.75, 0.125, -0.5}, Sample{1, 0.0375, -0.2, 0.0675, 9.8, 0.15, -0.45},
    Sample{2, 0.03, -0.3, 0.07, 9.7, 0.1, -0.4},         Sample{3, 0.02, -0.35, 0.05, 9.6, 0.2, -0.3},
    Sample{5, 0.01, -0.15, 0.04, 9.9, 0.05, -0.2},       Sample{6, 1e-3, -0.1, 0.03, 9.85, 0.25, -0.1},
};

// `t` of index 0, 1, 2, ... by a pattern that has {0} for it; the row by one that has {0} for that and {1} to
// {6} for the numbers.
std::string rows(const std::string& pattern, const std::function<std::string(int)>& t) {
    std::string text;
    for (const Sample& s : samples) {
        text += fmt::format(fmt::runtime(pattern), t(s.index), s.gx, s.gy, s.gz, s.ax, s.ay, s.az) + "\n";
    }
    return text;
}

std::string in_s(int index) { return fmt::format("{:.3f}", 0.005 * index); }
std::string since_1970_ns(int index) {
    return std::to_string(1'403'636'579'758'555'392LL + 5'000'000LL * index);
}

constexpr const char* commas = "{0},{1},{2},{3},{4},{5},{6}";

Recording canonical() {
    return dialect_read("t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n" + rows(commas, in_s));
}

void expect_same(const Recording& found, const Recording& wanted) {
    EXPECT_NEAR(found.rate_hz, wanted.rate_hz, 1e-3);
    ASSERT_EQ(found.rows(), wanted.rows());
    ASSERT_EQ(found.segments.size(), wanted.segments.size());
    EXPECT_EQ(found.missing_samples(), wanted.missing_samples());
    for (const Column& column : wanted.columns) {
        const Column* same = found.find(column.name);
        ASSERT_NE(same, nullptr) << column.name;
        EXPECT_EQ(same->unit, column.unit);
        for (std::size_t i = 0; i < column.size(); ++i) {
            EXPECT_NEAR(same->value(i), column.value(i), 1e-15 * std::abs(column.value(i)))
                << column.name << i;
        }
    }
    for (std::size_t i = 0; i < wanted.t_s.size(); ++i) {
        EXPECT_NEAR(found.t_s[i] - found.t_s[0], wanted.t_s[i] - wanted.t_s[0], 5e-7);
    }
}

TEST(ColumnDialect, EurocIsReadAsItIs) {
    const Recording r = dialect_read(
        "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m "
        "s^-2],a_RS_S_y "
        "[m s^-2],a_RS_S_z [m s^-2]\n" +
        rows(commas, since_1970_ns));
    expect_same(r, canonical());
    EXPECT_THAT(r.warnings,
                testing::Contains(
                    AllOf(HasSubstr("timestamp [ns] is taken for t_ns, w_RS_S_x [rad s^-1] for gx_rad_s"),
                          HasSubstr("a_RS_S_z [m s^-2] for az_m_s2"))));
}

TEST(ColumnDialect, RosIsReadByTheStampOfItsHeader) {
    const Recording r = dialect_read(
        "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.angular_velocity.x,"
        "field.angular_velocity.y,field.angular_velocity.z,field.linear_acceleration.x,"
        "field.linear_acceleration.y,field.linear_acceleration.z\n" +
        rows("1403636579000000000,7,{0},imu_link,{1},{2},{3},{4},{5},{6}", since_1970_ns));
    expect_same(r, canonical());
    EXPECT_THAT(r.warnings, testing::Contains(HasSubstr("field.header.stamp is taken for t_ns")));
    EXPECT_THAT(
        r.warnings,
        testing::Contains("ignored columns of unknown name: time, field.header.seq, field.header.frame_id"));
}

TEST(ColumnDialect, RosWithOneTimeOfNoUnitIsReadByItsSize) {
    expect_same(
        dialect_read("%time,angular_velocity_x,angular_velocity_y,angular_velocity_z,linear_acceleration_x,"
                     "linear_acceleration_y,linear_acceleration_z\n" +
                     rows(commas, since_1970_ns)),
        canonical());
}

TEST(ColumnDialect, Px4IsReadAsUlog2csvWritesIt) {
    expect_same(
        dialect_read("timestamp,gyro_rad[0],gyro_rad[1],gyro_rad[2],gyro_integral_dt,accelerometer_m_s2[0],"
                     "accelerometer_m_s2[1],accelerometer_m_s2[2]\n" +
                         rows("{0},{1},{2},{3},4000,{4},{5},{6}",
                              [](int i) { return std::to_string(1'000'000 + 5000 * i); }),
                     {.choice = {.columns = "timestamp=t_us"}}),
        canonical());
}

TEST(ColumnDialect, SemicolonsComeWithDecimalCommas) {
    std::string text = "Time (s);Gx (rad/s);Gy (rad/s);Gz (rad/s);Ax (m/s²);Ay (m/s²);Az (m/s²)\r\n" +
                       rows("{0};{1};{2};{3};{4};{5};{6}", in_s);
    expect_same(dialect_read(text), canonical());
    std::ranges::replace(text, '.', ',');
    expect_same(dialect_read(text), canonical());
    EXPECT_THAT(dialect_refusal("t_s;gx_dps\n0,0;1,5\n0.1;1\n").message,
                HasSubstr("line 3, column 't_s': '0.1' has a decimal point where line 2 has a comma"));
    EXPECT_THAT(dialect_refusal("t_s;gx_dps\n0;1.234,5\n1;1\n").message, HasSubstr("'1.234,5' is no number"));
}

TEST(ColumnDialect, TabsAndBlanksPartColumns) {
    const std::string names = "t_s\tgx_rad_s\tgy_rad_s\tgz_rad_s\tax_m_s2\tay_m_s2\taz_m_s2\n";
    expect_same(dialect_read(names + rows("{0}\t{1}\t{2}\t{3}\t{4}\t{5}\t{6}", in_s)), canonical());
    expect_same(dialect_read(
                    "  Time (s)  gx [rad s^-1] gy [rad/s] gz [rad/s]   ax [m/s^2] ay [m/s^2] az [m/s^2]\n\n" +
                    rows("   {0}  {1}   {2} {3} {4}  {5}\t{6} ", in_s)),
                canonical());
    EXPECT_THAT(dialect_refusal("t_s gx_dps\n0 1\n1\n").message,
                HasSubstr("line 3: 1 field where line 1 names 2 columns; the first without one"));
}

TEST(ColumnDialect, QuotationMarksStandRoundNamesAndNumbers) {
    expect_same(
        dialect_read(
            "\"t_s\",\"gx_rad_s\",\"gy_rad_s\",\"gz_rad_s\",\"ax_m_s2\",\"ay_m_s2\",\"az_m_s2\",note\n" +
            rows("\"{0}\", \"{1}\" ,{2},\"{3}\",{4},{5},{6},\"still, by \"\"day\"\"\"", in_s)),
        canonical());
    EXPECT_THAT(dialect_refusal("t_s,gx_dps\n0,\"1,5\"\n1,1\n").message,
                HasSubstr("line 2, column 'gx_dps': '\"1,5\"' is no number"));
    EXPECT_EQ(dialect_read("t_s,gx_dps,inch\n0,1,5\"\n1,2,\"6\n").rows(), 2U);
}

TEST(ColumnDialect, CommentsMayStandBeforeTheNamesOrBeThem) {
    const std::string names = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
    expect_same(dialect_read("# board 7, 21 C\n\n% by hand\n" + names + rows(commas, in_s)), canonical());
    expect_same(dialect_read("# board 7\n# " + names + rows(commas, in_s)), canonical());
    expect_same(
        dialect_read("# t_s gx_rad_s gy_rad_s gz_rad_s ax_m_s2 ay_m_s2 az_m_s2\n" + rows(commas, in_s)),
        canonical());
    EXPECT_THAT(dialect_refusal("# a\n# b\nt_s,gx_dps\n0,1\n1,x\n").message,
                HasSubstr("line 5, column 'gx_dps'"));
    EXPECT_THAT(dialect_refusal("# a\nt_s,temp_C\n0,1\n").message, HasSubstr("line 2: no gyro column"));
    EXPECT_THAT(dialect_refusal("# t_s,gx_dps\n").message, HasSubstr("no samples"));
}

TEST(ColumnDialect, UnitsMayBeWrittenAsPeopleWriteThem) {
    const auto unit_of = [](const std::string& name) {
        const auto told = dialect_name(name);
        return told ? told->quantity + " " + told->unit : "";
    };
    for (const char* name : {"Gx (deg/s)", "gx_deg_s", "gx_°/s", "GX_DPS", "gyro_x [deg/s]", "gyroX_dps",
                             "Gyroscope x (°/s)", "gyr_x_deg/s", "GyroX(deg/sec)", "gx (\xB0/s)"}) {
        EXPECT_EQ(unit_of(name), "gx dps") << name;
    }
    for (const char* name : {"gz_radps", "gyro.z (rad/s)", "angular_velocity.z", "gyr_z_rad_s",
                             "Gz [rad s^-1]", "w_RS_S_z", "gyro_rad[2]", "motionRotationRateZ(rad/s)"}) {
        EXPECT_EQ(unit_of(name), "gz rad_s") << name;
    }
    for (const char* name : {"gy (deg/h)", "gy_deg_h", "GY [°/h]"}) {
        EXPECT_EQ(unit_of(name), "gy deg_h") << name;
    }
    for (const char* name : {"gyr_x", "gyro_x", "gyroX", "GX", "wx", "gyro x"}) {
        EXPECT_EQ(unit_of(name), "gx ") << name;
    }
    for (const char* name : {"acc_y (g)", "accel_y_g", "ay [G]"}) {
        EXPECT_EQ(unit_of(name), "ay g") << name;
    }
    for (const char* name :
         {"Acceleration y (m/s^2)", "ay [m/s²]", "accel_y_mps2", "linear_acceleration.y"}) {
        EXPECT_EQ(unit_of(name), "ay m_s2") << name;
    }
    EXPECT_EQ(unit_of("timestamp [ns]"), "t ns");
    EXPECT_EQ(unit_of("Time (s)"), "t s");
    EXPECT_EQ(unit_of("time_us"), "t us");
    EXPECT_EQ(unit_of("timestamp_ms"), "t ms");
    EXPECT_EQ(unit_of("t (µs)"), "t us");
    EXPECT_EQ(unit_of("Time"), "t ");
    EXPECT_EQ(unit_of("Temperature (°C)"), "temp C");
    EXPECT_EQ(unit_of("temp_degC"), "temp C");
    for (const char* name : {"seq", "gx (g)", "gx_furlong", "T", "ax (deg/s)", "mag_x", "t (UTC)", "", "x",
                             "_", "gyro", "temp (K)"}) {
        EXPECT_EQ(unit_of(name), "") << name;
    }
}

TEST(ColumnDialect, EveryUnitComesInSi) {
    const auto gx = [](const std::string& header, const CsvReadOptions& options = {}) {
        return dialect_read(header + "\n0,2\n1,2\n", options).find("gx")->value(0);
    };
    EXPECT_DOUBLE_EQ(gx("t_s,gx_deg_h"), 2.0 * rad_per_deg / 3600.0);
    EXPECT_DOUBLE_EQ(gx("t_s,gx_mdps"), 2e-3 * rad_per_deg);
    CsvReadOptions options;
    options.rate_hz = 10.0;
    options.choice.gyro_unit = "rad/s";
    EXPECT_DOUBLE_EQ(gx("seq,gyr_x", options), 2.0);
    options.choice.gyro_unit = "deg/h";
    EXPECT_DOUBLE_EQ(gx("seq,gyr_x", options), 2.0 * rad_per_deg / 3600.0);
    options.choice.gyro_unit = "lsb";
    options.lsb_dps = 0.5;
    EXPECT_DOUBLE_EQ(gx("seq,gyr_x", options), rad_per_deg);
    options.choice.accelerometer_unit = "g";
    EXPECT_DOUBLE_EQ(dialect_read("seq,gyr_x,acc_x\n0,1,2\n1,1,2\n", options).find("ax")->value(0),
                     2.0 * 9.80665);
}

TEST(ColumnDialect, AGyroWithoutAUnitAsksForIt) {
    const Error error = dialect_refusal("time,gyr_x,gyr_y\n0,1,1\n0.1,1,1\n");
    EXPECT_EQ(error.code, ErrorCode::invalid_argument);
    EXPECT_EQ(
        error.message,
        "line 1: no unit in the name of gyr_x, gyr_y: give it with --unit (deg/s, rad/s, deg/h or lsb)");
    const Recording r =
        dialect_read("time,gyr_x,acc_x\n0,1,1\n0.1,1,1\n", {.choice = {.gyro_unit = "deg/s"}});
    EXPECT_THAT(r.warnings, ElementsAre("time is taken for t_s, gyr_x for gx_dps",
                                        "ignored columns without a unit, which --acc-unit gives: acc_x"));
}

TEST(ColumnDialect, ColumnsAreNamedByPosition) {
    CsvReadOptions options;
    options.choice = {.columns = "t,gx,gy,gz,-,_,az_m_s2", .gyro_unit = "rad/s"};
    Recording wanted = canonical();
    std::erase_if(wanted.columns,
                  [](const Column& column) { return column.name == "ax" || column.name == "ay"; });
    expect_same(dialect_read(rows(commas, in_s), options), wanted);
    expect_same(dialect_read(rows("{0} {1} {2} {3} {4} {5} {6}", in_s), options), wanted);
    const Recording renamed = dialect_read("a,b,c,d,e,f,g\n" + rows(commas, in_s), options);
    expect_same(renamed, wanted);
    EXPECT_THAT(renamed.warnings, testing::Contains("names replaced by --columns: a, b, c, d, e, f, g"));
    expect_same(dialect_read("# a comment of three words\n" + rows(commas, in_s), options), wanted);
    std::string german = rows("{0};{1};{2};{3};{4};{5};{6}", in_s);
    std::ranges::replace(german, '.', ',');
    expect_same(dialect_read(german, options), wanted);
    EXPECT_THAT(dialect_read(rows(commas, in_s), options).warnings, ElementsAre(Not(HasSubstr("ignored"))));
    options.choice.columns = "t,gx";
    EXPECT_THAT(dialect_read(rows(commas, in_s), options).warnings,
                testing::Contains(
                    "ignored columns of unknown name: column 3, column 4, column 5, column 6, column 7"));
    options.choice.columns = "t,gx,gy,gz,ax,ay,az,temp_C";
    EXPECT_THAT(dialect_refusal(rows(commas, in_s), options).message,
                HasSubstr("line 1 has 7 columns, and --columns names 8"));
    options.choice.columns = "t,gq";
    EXPECT_THAT(dialect_refusal(rows(commas, in_s), options).message,
                HasSubstr("--columns: 'gq' is no name of a column"));
}

TEST(ColumnDialect, ColumnsAreNamedByName) {
    const std::string text = "clock,rate 1,junk,gx_dps\n" + rows("{0},{1},{2},{3}", in_s);
    const Recording r = dialect_read(text, {.choice = {.columns = "clock=t_s,rate 1=gx_rad_s,gx_dps=_"}});
    EXPECT_DOUBLE_EQ(r.find("gx")->value(0), samples[0].gx);
    EXPECT_THAT(r.warnings, ElementsAre("clock is taken for t_s, rate 1 for gx_rad_s",
                                        "ignored columns of unknown name: junk"));
    EXPECT_THAT(dialect_refusal(text, {.choice = {.columns = "watch=t_s"}}).message,
                HasSubstr("--columns: there is no column 'watch' among clock, rate 1, junk, gx_dps"));
    EXPECT_THAT(dialect_refusal(text, {.choice = {.columns = "clock=t_s,gx"}}).message,
                HasSubstr("not both"));
    EXPECT_THAT(dialect_refusal(text, {.choice = {.columns = "t,,gx"}}).message,
                HasSubstr("a name is empty"));
}

TEST(ColumnDialect, WithoutNamesNothingIsGuessed) {
    EXPECT_THAT(
        dialect_refusal("0,1\n1,2\n").message,
        AllOf(HasSubstr("line 1 holds numbers, and no line before it names the columns: put t_s,gx_dps"),
              HasSubstr("--columns t,gx,gy,gz")));
}

TEST(ColumnDialect, WhatWasFoundIsNamedWhereNothingIsUnderstood) {
    std::string header = "n";
    for (int i = 0; i < 20; ++i) { header += fmt::format(",c{}", i); }
    const std::string message = dialect_refusal(header + "\n").message;
    EXPECT_THAT(
        message,
        AllOf(HasSubstr("line 1: no gyro column, but n, c0, c1, c2, c3, c4, c5, c6, c7, c8 and 11 more"),
              HasSubstr("--columns"), HasSubstr("--unit")));
    EXPECT_THAT(dialect_refusal("a\x1b[2J,b\n").message, HasSubstr("a\\u001b[2J, b"));
    EXPECT_LT(dialect_refusal(std::string(1000, 'x') + ";" + std::string(1000, 'y') + "\n").message.size(),
              500U);
}

TEST(ColumnDialect, OneAxisInTwoUnitsIsAnErrorThatNamesBoth) {
    EXPECT_THAT(
        dialect_refusal("t_s,gx_dps,gx_rad_s\n0,1,1\n").message,
        HasSubstr(
            "line 1: columns 'gx_dps' and 'gx_rad_s' are both gx: leave one out with --columns gx_rad_s=_"));
    EXPECT_THAT(dialect_refusal("t_s,gyro_x (deg/s),gyr_x (rad/s)\n0,1,1\n").message,
                HasSubstr("'gyro_x (deg/s)' and 'gyr_x (rad/s)' are both gx"));
    EXPECT_EQ(
        dialect_read("t_s,gx_dps,gx_rad_s\n0,1,1\n1,1,1\n", {.choice = {.columns = "gx_rad_s=_"}}).rows(),
        2U);
}

TEST(ColumnDialect, DatesAreNoStamps) {
    const std::string text = "time,gx (deg/s)\n2026-11-26 05:00:00.000,1\n2026-11-26 05:00:00.005,2\n";
    EXPECT_THAT(
        dialect_refusal(text).message,
        HasSubstr("is no number; leave the column out with --columns time=_, and give the sampling rate"));
    EXPECT_EQ(dialect_read(text, {.rate_hz = 200.0, .choice = {.columns = "time=_"}}).rows(), 2U);
}

TEST(ColumnDialect, ACanonicalNameWinsOverAnotherForTheSame) {
    const Recording r =
        dialect_read("time,t_s,gx_dps,gyro_x (deg/s),gyro_y,t_ms\nnoon,0,1,a,b,c\nnoon,1,2,a,b,c\n");
    EXPECT_EQ(r.columns.size(), 1U);
    EXPECT_NEAR(r.rate_hz, 1.0, 1e-12);
    EXPECT_THAT(r.warnings,
                ElementsAre("ignored columns of unknown name: time, gyro_x (deg/s), gyro_y, t_ms"));
    const Recording rated = dialect_read("time,gx_dps\nnoon,1\nnoon,2\n", {.rate_hz = 10.0});
    EXPECT_EQ(rated.stamps, StampKind::none);
    EXPECT_THAT(dialect_read("time,gx_dps\n0.5,1\n0.6,2\n").warnings, ElementsAre("time is taken for t_s"));
    const Recording array = dialect_read("t_s,gx1_dps,gx2_dps,gyro_x (deg/s)\n0,1,2,3\n1,1,2,3\n");
    EXPECT_EQ(array.columns.size(), 2U);
    EXPECT_EQ(dialect_read("t_s,temperature (C),gx_dps,temp_C\n0,7,1,20\n1,7,1,20\n").find("temp")->value(0),
              20.0);
}

TEST(ColumnDialect, ACanonicalNameDoesNotHideTheOtherSensorsNames) {
    const Recording r =
        dialect_read("t_s,gx_dps,Gy (deg/s),acc_x (g),temperature (C)\n0,1,2,1,25\n1,1,2,1,26\n");
    ASSERT_NE(r.find("gy"), nullptr);
    EXPECT_NEAR(r.find("gy")->value(0), 2.0 * rad_per_deg, 1e-12);
    ASSERT_NE(r.find("ax"), nullptr);
    EXPECT_NEAR(r.find("ax")->value(0), standard_gravity_m_s2, 1e-12);
    ASSERT_NE(r.find("temp"), nullptr);
    EXPECT_EQ(r.find("temp")->value(1), 26.0);
    EXPECT_THAT(r.warnings, ElementsAre("Gy (deg/s) is taken for gy_dps, acc_x (g) for ax_g, temperature (C) "
                                        "for temp_C"));
}

TEST(ColumnDialect, CanonicalNamesMayStandInCapitals) {
    expect_same(dialect_read("T_S,GX_RAD_S,GY_RAD_S,GZ_RAD_S,AX_M_S2,AY_M_S2,AZ_M_S2\n" + rows(commas, in_s)),
                canonical());
    const Recording r = dialect_read("T_MS,GX1_DPS,GX2_DPS,REF_X_DPS\n0,1,2,3\n10,1,2,3\n");
    EXPECT_NEAR(r.rate_hz, 100.0, 1e-9);
    for (const char* name : {"gx1", "gx2", "ref_x"}) { EXPECT_NE(r.find(name), nullptr) << name; }
    EXPECT_EQ(r.warnings.front(),
              "T_MS is taken for t_ms, GX1_DPS for gx1_dps, GX2_DPS for gx2_dps, REF_X_DPS for ref_x_dps");
}

TEST(ColumnDialect, StampsInMilliMicroAndNanosecondsAreSeconds) {
    for (const auto& [name, per_s] :
         {std::pair{"t_ms", 1e3}, std::pair{"t_us", 1e6}, std::pair{"t_ns", 1e9}}) {
        std::string text = std::string(name) + ",gx_dps\n";
        for (int i = 0; i < 10; ++i) { text += fmt::format("{},1\n", 0.25 * i * per_s); }
        const Recording r = dialect_read(text);
        EXPECT_NEAR(r.rate_hz, 4.0, 1e-9) << name;
        EXPECT_DOUBLE_EQ(r.t_s[3], 0.75) << name;
        EXPECT_THAT(r.warnings, IsEmpty()) << name;
    }
}

std::string units_of(double step, double first = 0.0, double samples_per_row = 1.0) {
    std::vector<double> stamps;
    for (int i = 0; i < 20; ++i) { stamps.push_back(first + step * i); }
    std::string names;
    for (const StampUnit& unit : plausible_stamp_units(stamps, samples_per_row).units) {
        names += std::string(unit.name) + " ";
    }
    return names;
}

TEST(StampUnit, IsTheOneInWhichTheStepIsASamplingPeriod) {
    EXPECT_EQ(units_of(0.01), "s ");
    EXPECT_EQ(units_of(0.000125), "s ");
    EXPECT_EQ(units_of(0.5), "s ");
    EXPECT_EQ(units_of(5.0, 1'700'000'000'000.0), "ms ");
    EXPECT_EQ(units_of(5000.0, 1.7e15), "us ");
    EXPECT_EQ(units_of(5e6, 1.4e18), "ns ");
    EXPECT_EQ(units_of(125'000.0), "us ns ");  // 8 Hz or 8 kHz
    EXPECT_EQ(units_of(20'000.0), "us ");      // 50 Hz; 50 kHz is no gyro's, 0.05 Hz neither
    EXPECT_EQ(units_of(10.0), "s ms ");
    EXPECT_EQ(units_of(5e6), "us ns ");
    EXPECT_EQ(units_of(5e10), "");
    EXPECT_EQ(units_of(1e5 * 0.2, 0.0, 10.0), "ms us ");
    EXPECT_EQ(units_of(0.0), "s ");
}

TEST(StampUnit, ThatIsUndecidedIsAskedFor) {
    const std::string text = "time,gx (deg/s)\n0,1\n10,1\n20,1\n30,1\n";
    const Error error = dialect_refusal(text);
    EXPECT_EQ(error.code, ErrorCode::invalid_argument);
    EXPECT_EQ(error.message,
              "the time stamps of column 'time' may be 0.1 Hz in s or 100 Hz in ms: name it with --columns "
              "time=t_s "
              "(or t_ms, t_us, t_ns)");
    EXPECT_NEAR(dialect_read(text, {.choice = {.columns = "time=t_ms"}}).rate_hz, 100.0, 1e-9);
    const Recording rated = dialect_read(text, {.rate_hz = 101.0});
    EXPECT_EQ(rated.rate_hz, 101.0);
    EXPECT_EQ(rated.stamps, StampKind::sampling);
    EXPECT_EQ(dialect_read(text, {.rate_hz = 1.0}).stamps, StampKind::none);
    EXPECT_THAT(dialect_refusal("time,gx (deg/s)\n0,1\n5e10,1\n").message,
                HasSubstr("step by 5e+10, which is no sampling period"));
}

TEST(CurveDialect, CurvesHaveSeparatorsAndCommentsToo) {
    const auto curves =
        parse_curve_csv("# of a paper\ntau_s;x_dps\n1;0,1\n2;0,08\n4;0,06\n8;0,05\n", "curve.csv");
    ASSERT_TRUE(curves.ok()) << curves.error().message;
    EXPECT_DOUBLE_EQ(curves->curves.at(0).curve.points.at(1).deviation, 0.08 * rad_per_deg);
}

// Columns beyond those that are named are nobody's, whatever their own names are.
TEST(NamedColumns, ThoseBeyondMayHaveTheSameNames) {
    CsvReadOptions options;
    options.choice = {.columns = "t,gx", .gyro_unit = "deg/s"};
    const auto r = parse_recording_csv("time,wx,note,gx\n0,1,7,7\n0.1,2,7,7\n0.2,1,7,7\n", "r.csv", options);
    ASSERT_TRUE(r.ok()) << r.error().message;
    EXPECT_DOUBLE_EQ(r->find("gx")->value(1), 2.0 * rad_per_deg);
}

TEST(NamedColumns, OfOneQuantityTwiceAreRefusedWithAdviceThatWorks) {
    CsvReadOptions options;
    options.choice = {.columns = "t,gx,gx_dps", .gyro_unit = "deg/s"};
    const auto r = parse_recording_csv("0,1,7\n0.1,2,7\n0.2,1,7\n", "r.csv", options);
    ASSERT_FALSE(r.ok());
    EXPECT_THAT(r.error().message, HasSubstr("are both gx: write _ in --columns for one of them"));
}

// NilsPod: a header of its own, without units, time or rate.
TEST(RealDialect, NilspodIsReadWithItsUnitAndRate) {
    if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    const std::string session = shared_data("nilspod_ferraris/example_ferraris_session.csv.xz");
    const auto bare = read_recording_csv(session);
    ASSERT_FALSE(bare.ok());
    EXPECT_THAT(bare.error().message, HasSubstr("gyr_x, gyr_y, gyr_z: give it with --unit"));
    CsvReadOptions options;
    options.choice = {.gyro_unit = "deg/s", .accelerometer_unit = "m/s^2"};
    options.rate_hz = 204.8;
    const auto r = read_recording_csv(session, options);
    ASSERT_TRUE(r.ok()) << r.error().message;
    EXPECT_EQ(r->rows(), 10'376U);
    EXPECT_EQ(r->find("gx")->value(0), -0.6103515625 * rad_per_deg);
    EXPECT_EQ(r->find("az")->value(1), 0.5077441406250001);
    options.choice = {.gyro_unit = "lsb", .accelerometer_unit = "lsb"};
    options.lsb_dps = 1.0 / 16.4;
    const auto counts = read_recording_csv(shared_data("nilspod_ferraris/annotated_session.csv.xz"), options);
    ASSERT_TRUE(counts.ok()) << counts.error().message;
    EXPECT_EQ(counts->rows(), 9'414U);
    EXPECT_DOUBLE_EQ(counts->find("gz")->value(0), -5.0 / 16.4 * rad_per_deg);
}

}  // namespace
}  // namespace gyrolog
