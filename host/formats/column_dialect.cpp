#include "host/formats/column_dialect.hpp"

#include <algorithm>
#include <array>

#include "host/formats/separated_fields.hpp"

namespace gyrolog {
namespace {

enum class Quantity { time, gyro, accelerometer, temperature };

// Names without their axis and unit, in lower case, without blanks, dots, underscores and dashes. The unit is
// the one that the format prescribes. Of several times in one file the first row here is meant.
struct NameRow {
    std::string_view key;
    Quantity quantity;
    std::string_view unit;
};
constexpr std::array name_rows = {
    // ROS: sensor_msgs/Imu as `rostopic echo -p` writes it; its %time is when the message arrived.
    NameRow{"fieldheaderstamp", Quantity::time, "ns"},
    NameRow{"headerstamp", Quantity::time, "ns"},
    NameRow{"fieldangularvelocity", Quantity::gyro, "rad_s"},
    NameRow{"angularvelocity", Quantity::gyro, "rad_s"},
    NameRow{"fieldlinearacceleration", Quantity::accelerometer, "m_s2"},
    NameRow{"linearacceleration", Quantity::accelerometer, "m_s2"},
    // The EuRoC MAV data set (ASL format): w_RS_S_x [rad s^-1].
    NameRow{"wrss", Quantity::gyro, "rad_s"},
    NameRow{"arss", Quantity::accelerometer, "m_s2"},
    // PX4: sensor_combined as ulog2csv writes it, with [0], [1], [2].
    NameRow{"gyrorad", Quantity::gyro, "rad_s"},
    NameRow{"accelerometerms2", Quantity::accelerometer, "m_s2"},
    // MathWorks' LoggedSingleAxisGyroscope.mat.
    NameRow{"omega", Quantity::gyro, "rad_s"},
    // Loggers of telephones.
    NameRow{"secondselapsed", Quantity::time, "s"},
    NameRow{"gyrorotation", Quantity::gyro, ""},
    NameRow{"rotationrate", Quantity::gyro, ""},
    NameRow{"motionrotationrate", Quantity::gyro, ""},
    NameRow{"accelerometeracceleration", Quantity::accelerometer, ""},
    // Whoever wrote a line of code.
    NameRow{"timestamp", Quantity::time, ""},
    NameRow{"time", Quantity::time, ""},
    NameRow{"t", Quantity::time, ""},
    NameRow{"g", Quantity::gyro, ""},
    NameRow{"gyr", Quantity::gyro, ""},
    NameRow{"gyro", Quantity::gyro, ""},
    NameRow{"gyroscope", Quantity::gyro, ""},
    NameRow{"angularrate", Quantity::gyro, ""},
    NameRow{"w", Quantity::gyro, ""},
    NameRow{"a", Quantity::accelerometer, ""},
    NameRow{"acc", Quantity::accelerometer, ""},
    NameRow{"accel", Quantity::accelerometer, ""},
    NameRow{"acceleration", Quantity::accelerometer, ""},
    NameRow{"accelerometer", Quantity::accelerometer, ""},
    NameRow{"temp", Quantity::temperature, ""},
    NameRow{"temperature", Quantity::temperature, ""},
};

// Units in lower case, without blanks, dots, underscores, carets and asterisks; "deg" for the sign of it.
struct UnitRow {
    std::string_view key;
    Quantity quantity;
    std::string_view unit;  // as csv_column() knows it
};
constexpr std::array unit_rows = {
    UnitRow{"dps", Quantity::gyro, "dps"},
    UnitRow{"deg/s", Quantity::gyro, "dps"},
    UnitRow{"degs", Quantity::gyro, "dps"},
    UnitRow{"degs-1", Quantity::gyro, "dps"},
    UnitRow{"degps", Quantity::gyro, "dps"},
    UnitRow{"deg/sec", Quantity::gyro, "dps"},
    UnitRow{"degsec", Quantity::gyro, "dps"},
    UnitRow{"degree/s", Quantity::gyro, "dps"},
    UnitRow{"degrees/s", Quantity::gyro, "dps"},
    UnitRow{"degrees/sec", Quantity::gyro, "dps"},
    UnitRow{"mdps", Quantity::gyro, "mdps"},
    UnitRow{"mdeg/s", Quantity::gyro, "mdps"},
    UnitRow{"rad/s", Quantity::gyro, "rad_s"},
    UnitRow{"rads", Quantity::gyro, "rad_s"},
    UnitRow{"rads-1", Quantity::gyro, "rad_s"},
    UnitRow{"radps", Quantity::gyro, "rad_s"},
    UnitRow{"rad/sec", Quantity::gyro, "rad_s"},
    UnitRow{"radsec", Quantity::gyro, "rad_s"},
    UnitRow{"radian/s", Quantity::gyro, "rad_s"},
    UnitRow{"radians/s", Quantity::gyro, "rad_s"},
    UnitRow{"deg/h", Quantity::gyro, "deg_h"},
    UnitRow{"degh", Quantity::gyro, "deg_h"},
    UnitRow{"degh-1", Quantity::gyro, "deg_h"},
    UnitRow{"deg/hr", Quantity::gyro, "deg_h"},
    UnitRow{"deghr", Quantity::gyro, "deg_h"},
    UnitRow{"degperh", Quantity::gyro, "deg_h"},
    UnitRow{"dph", Quantity::gyro, "deg_h"},
    UnitRow{"lsb", Quantity::gyro, "lsb"},
    UnitRow{"count", Quantity::gyro, "lsb"},
    UnitRow{"counts", Quantity::gyro, "lsb"},
    UnitRow{"raw", Quantity::gyro, "lsb"},
    UnitRow{"g", Quantity::accelerometer, "g"},
    UnitRow{"mg", Quantity::accelerometer, "mg"},
    UnitRow{"m/s2", Quantity::accelerometer, "m_s2"},
    UnitRow{"ms2", Quantity::accelerometer, "m_s2"},
    UnitRow{"ms-2", Quantity::accelerometer, "m_s2"},
    UnitRow{"mps2", Quantity::accelerometer, "m_s2"},
    UnitRow{"m/s/s", Quantity::accelerometer, "m_s2"},
    UnitRow{"m/sec2", Quantity::accelerometer, "m_s2"},
    UnitRow{"lsb", Quantity::accelerometer, "lsb"},
    UnitRow{"count", Quantity::accelerometer, "lsb"},
    UnitRow{"counts", Quantity::accelerometer, "lsb"},
    UnitRow{"raw", Quantity::accelerometer, "lsb"},
    UnitRow{"s", Quantity::time, "s"},
    UnitRow{"sec", Quantity::time, "s"},
    UnitRow{"secs", Quantity::time, "s"},
    UnitRow{"second", Quantity::time, "s"},
    UnitRow{"seconds", Quantity::time, "s"},
    UnitRow{"ms", Quantity::time, "ms"},
    UnitRow{"msec", Quantity::time, "ms"},
    UnitRow{"millis", Quantity::time, "ms"},
    UnitRow{"milliseconds", Quantity::time, "ms"},
    UnitRow{"us", Quantity::time, "us"},
    UnitRow{"usec", Quantity::time, "us"},
    UnitRow{"micros", Quantity::time, "us"},
    UnitRow{"microseconds", Quantity::time, "us"},
    UnitRow{"ns", Quantity::time, "ns"},
    UnitRow{"nsec", Quantity::time, "ns"},
    UnitRow{"nanos", Quantity::time, "ns"},
    UnitRow{"nanoseconds", Quantity::time, "ns"},
    UnitRow{"c", Quantity::temperature, "C"},
    UnitRow{"degc", Quantity::temperature, "C"},
    UnitRow{"celsius", Quantity::temperature, "C"},
};

// Signs of units in UTF-8 and, where one byte stands alone, in ISO 8859-1.
struct Sign {
    std::string_view bytes;
    std::string_view plain;
};
constexpr std::array signs = {
    Sign{"\xC2\xB0", "deg"}, Sign{"\xC2\xBA", "deg"}, Sign{"\xC2\xB5", "u"},     Sign{"\xCE\xBC", "u"},
    Sign{"\xC2\xB2", "2"},   Sign{"\xC2\xB9", "1"},   Sign{"\xE2\x81\xBB", "-"}, Sign{"\xC2\xB7", ""},
    Sign{"\xB0", "deg"},     Sign{"\xB5", "u"},       Sign{"\xB2", "2"},
};

std::string key_of(std::string_view text, std::string_view dropped) {
    std::string key;
    while (!text.empty()) {
        const auto* sign =
            std::ranges::find_if(signs, [&](const Sign& s) { return text.starts_with(s.bytes); });
        if (sign != signs.end()) {
            key += sign->plain;
            text.remove_prefix(sign->bytes.size());
            continue;
        }
        const char c = text.front();
        if (dropped.find(c) == std::string_view::npos) {
            key += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        }
        text.remove_prefix(1);
    }
    return key;
}

std::string name_key(std::string_view name) { return key_of(name, " \t._-"); }
std::string unit_key(std::string_view unit) { return key_of(unit, " \t._^*"); }

const NameRow* name_row(std::string_view key) {
    const auto* row = std::ranges::find(name_rows, key, &NameRow::key);
    return row == name_rows.end() ? nullptr : row;
}

std::optional<std::string> known_unit(Quantity quantity, std::string_view text) {
    const std::string key = unit_key(text);
    for (const UnitRow& row : unit_rows) {
        if (row.quantity == quantity && row.key == key) { return std::string(row.unit); }
    }
    return std::nullopt;
}

struct Named {
    const NameRow* row;
    char axis;  // 0: none
};

// A name without its unit.
std::optional<Named> whole_name(std::string_view name) {
    if (name == "T") { return std::nullopt; }  // a temperature as often as a time
    std::string key = name_key(name);
    if (const NameRow* row = name_row(key);
        row != nullptr && (row->quantity == Quantity::time || row->quantity == Quantity::temperature)) {
        return Named{row, 0};
    }
    char axis = 0;
    if (key.size() > 3 && key.ends_with(']') && key[key.size() - 3] == '[') {
        axis = static_cast<char>('x' + (key[key.size() - 2] - '0'));
        key.resize(key.size() - 3);
    } else if (key.size() > 1) {
        axis = key.back();
        key.pop_back();
    }
    if (axis < 'x' || axis > 'z') { return std::nullopt; }
    const NameRow* row = name_row(key);
    if (row == nullptr || row->quantity == Quantity::time || row->quantity == Quantity::temperature) {
        return std::nullopt;
    }
    return Named{row, axis};
}

DialectName dialect(const Named& named, std::string unit) {
    DialectName name;
    switch (named.row->quantity) {
        case Quantity::time:
            name.quantity = "t";
            break;
        case Quantity::gyro:
            name.quantity = {'g', named.axis};
            break;
        case Quantity::accelerometer:
            name.quantity = {'a', named.axis};
            break;
        case Quantity::temperature:
            name.quantity = "temp";
            break;
    }
    name.unit = std::move(unit);
    name.rank = static_cast<std::size_t>(named.row - name_rows.data());
    return name;
}

std::optional<DialectName> with_unit(std::string_view name, std::string_view unit) {
    const auto named = whole_name(name);
    if (!named) { return std::nullopt; }
    auto known = known_unit(named->row->quantity, unit);
    if (!known) { return std::nullopt; }
    return dialect(*named, *std::move(known));
}

}  // namespace

std::optional<DialectName> dialect_name(std::string_view header) {
    const std::string_view name = trimmed(header);
    if (const auto named = whole_name(name)) { return dialect(*named, std::string(named->row->unit)); }
    if (name.ends_with(')') || name.ends_with(']')) {
        const std::size_t open = name.rfind(name.back() == ')' ? '(' : '[');
        if (open == std::string::npos) { return std::nullopt; }
        return with_unit(name.substr(0, open), name.substr(open + 1, name.size() - open - 2));
    }
    for (std::size_t at = 1; at + 1 < name.size(); ++at) {
        if (std::string_view("_ .-,").find(name[at]) == std::string_view::npos) { continue; }
        auto told = with_unit(name.substr(0, at), name.substr(at + 1));
        if (told) { return told; }
    }
    return std::nullopt;
}

std::optional<std::string> dialect_unit(char quantity, std::string_view written) {
    switch (quantity) {
        case 'g':
            return known_unit(Quantity::gyro, written);
        case 'a':
            return known_unit(Quantity::accelerometer, written);
        default:
            return std::nullopt;
    }
}

}  // namespace gyrolog
