// What a new user gets wrong, and what the program says of it: a table of command, exit code and message.
// Each message names the file, the place in it where there is one, and what to do; a wrong input writes
// nothing.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/needs.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* model_text = R"({
  "schema": "gyrolog-model/1",
  "rate_hz": 100.0, "full_scale_dps": 500.0, "lsb_dps": 0.015, "saturation_dps": 500.0,
  "axes": {
    "x": {"N": 0.005, "B": 0.002, "K": 1e-4, "bias": 0.3},
    "y": {"N": 0.005, "B": 0.002, "K": 1e-4, "bias": 0.3},
    "z": {"N": 0.005, "B": 0.002, "K": 1e-4, "bias": 0.3}
  },
  "M": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  "latency_s": 0.0, "timestamp_jitter_s": 2e-5,
  "sd_rel": {"N": 0.005}, "sd_abs": {"M": 2e-4},
  "ref_noise_dps": 0.02, "acc_noise_g": 0.003, "temp_noise_C": 0.03,
  "effects": []
}
)";

std::string with(std::string text, const std::string& old, const std::string& now) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return at == std::string::npos ? text : text.replace(at, old.size(), now);
}

void write(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string noise(std::size_t bytes) {
    std::mt19937 random(20261124);
    std::string text(bytes, '\0');
    for (char& byte : text) { byte = static_cast<char>(random() & 0xFFU); }
    return text;
}

// Three rows of two numbers, all zero.
std::string npy(const std::string& type) {
    std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (3, 2), }";
    header.resize(117, ' ');
    return std::string("\x93NUMPY\x01\0v\0", 10) + header + '\n' + std::string(48, '\0');
}

// All tests run in one folder with these files, by names without a path.
class WrongInput : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new TemporaryFolder(TemporaryFolder::Documents::are_wrong_on_purpose);
        before_ = fs::current_path();
        fs::current_path(folder_->path(""));
        fs::create_directory("dir");
        fs::create_directory("out");
        ASSERT_EQ(
            run_gyrolog({"capture", "--device", "sim:rate=100,seed=7", "--duration", "20s", "-o", "c.pcapng"})
                .exit_code,
            0);
        ASSERT_EQ(run_gyrolog({"export", "c.pcapng", "-o", "c.csv"}).exit_code, 0);
        ASSERT_EQ(run_gyrolog({"export", "c.pcapng", "-o", "c.csv.xz"}).exit_code, 0);
        write_captures();
        write_texts();
        write_models();
    }
    static void TearDownTestSuite() {
        fs::current_path(before_);
        delete folder_;
    }

    static void write_captures() {
        const std::string whole = read_whole_file("c.pcapng");
        write("empty.pcapng", "");
        write("noise.pcapng", noise(5000));
        write("head.pcapng", whole.substr(0, 40));
        std::string damaged = whole;
        std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(damaged.size() / 2), 200, '\x55');
        write("damaged.pcapng", damaged);
        write("cut.pcapng", whole.substr(0, whole.size() * 2 / 3 + 1));
    }

    static void write_texts() {
        const std::string whole = read_whole_file("c.csv");
        const std::string compressed = read_whole_file("c.csv.xz");
        write("empty.csv", "");
        write("noise.csv", noise(5000));
        write("torn.csv.xz", compressed.substr(0, compressed.size() / 2));
        write("packed.csv", compressed);
        write("plain.csv.gz", whole);
        write("other.csv.gz", compressed);
        std::string returns = whole;
        std::ranges::replace(returns, '\n', '\r');
        write("cr.csv", returns);
        write("mixed.csv", "t_s;gx_dps\n0,1;1\n0.2;1\n");
        write("nounit.csv", "time,gyr_x,gyr_y\n0,1,2\n0.1,2,3\n0.2,3,4\n");
        write("noname.csv", "0,1\n0.1,2\n0.2,3\n");
        write("anytime.csv", "time,gx (deg/s)\n0,1\n10,2\n20,1\n30,2\n");
        write("both.csv", "t_s,gx_dps,gx_rad_s\n0,1,1\n1,1,1\n");
        std::string scaled = "t_s,gx_lsb\n";
        for (int i = 0; i < 100; ++i) {
            scaled += std::to_string(0.01 * i) + "," + std::to_string(90 + i % 5) + "\n";
        }
        write("scaled.csv", scaled);
        write("cut.npy", std::string("\x93NUMPY\x01\0v\0", 10) + "{'descr': '<f8',");
        write("big.npy", npy(">f8"));
        write("plain.npy", npy("<f8"));
        write("cut.mat", "MATLAB 5.0 MAT-file");
        write("a.npz", "PK\x03\x04 and more");
        write("utf16.csv", std::string("\xFF\xFEt\0_\0s\0", 8));
        write("word.csv", "t_s,gx_dps\n0,1\n1,two\n2,3\n");
        write("short.csv", "t_s,gx_dps,gy_dps\n0,1,2\n1,2\n2,3,4\n");
        write("long.csv", "t_s,gx_dps,gy_dps\n0,1,2\n1,2,3,4\n2,3,4\n");
        write("unit.csv", "t_s,gx_furlong\n0,1\n1,2\n2,3\n");
        write("nostamps.csv", "gx_dps\n1\n2\n3\n");
        write("backwards.csv", "t_s,gx_dps\n0,1\n2,2\n1,3\n3,3\n");
        write("header.csv", "t_s,gx_dps\n");
        write("twice.csv", "t_s,gx_dps,gx_dps\n0,1,1\n1,1,1\n");
        write("curve.csv", "tau_s,x_dps\n1,0.01\n2,0.007\n4,0.005\n8,0.0035\n16,0.0025\n32,0.0018\n");
        write("fewpoints.csv", "tau_s,x_dps\n1,0.01\n2,0.007\n");
        write("counts.csv", "t_s,gx_lsb\n0,1\n1,2\n2,1\n3,2\n4,1\n");
        std::string force = "t_s,ax_g,az_g\n";
        for (int row = 0; row < 100; ++row) {
            force += std::to_string(row) + (row % 3 == 0 ? ",0.01,1\n" : ",0.02,1.01\n");
        }
        write("force.csv", force);
        write("long.csv.txt", std::string(17'000'000, ' '));
        ASSERT_EQ(run_gyrolog({"check", "c.pcapng", "--jsonl", "lines.jsonl"}).exit_code, 0);
    }

    static void write_models() {
        const std::string model = model_text;
        write("m.json", model);
        ASSERT_EQ(run_gyrolog({"simulate", "m.json", "-o", "longer.csv", "--duration", "25s"}).exit_code, 0);
        write("empty.json", "");
        write("noise.json", noise(5000));
        write("list.json", "[1]");
        write("nocomma.json", with(model, "\"rate_hz\": 100.0,", "\"rate_hz\": 100.0"));
        write("comment.json", with(model, "  \"rate_hz\"", "  // of the sensor\n  \"rate_hz\""));
        write("utf16.json", std::string("\xFF\xFE{\0}\0", 6));
        write("future.json", with(model, "gyrolog-model/1", "gyrolog-model/9"));
        write("noschema.json", with(model, "\"schema\": \"gyrolog-model/1\",", ""));
        write("gremlins.json", with(model, "\"effects\": []",
                                    R"("effects": [{"effect": "gremlins", "axes": ["x"], "params": {}}])"));
        write("words.json", with(model, "\"x\": {\"N\": 0.005", "\"x\": {\"N\": \"much\""));
        write("nan.json", with(model, "\"x\": {\"N\": 0.005", "\"x\": {\"N\": NaN"));
        write("negative.json", with(model, "\"x\": {\"N\": 0.005", "\"x\": {\"N\": -0.005"));
    }

    static TemporaryFolder* folder_;
    static fs::path before_;
};

TemporaryFolder* WrongInput::folder_ = nullptr;
fs::path WrongInput::before_;

// Words are separated by one space each; "" is the empty word of an unset variable.
struct Row {
    const char* command;
    int exit_code;
    const char* said;
};

std::vector<std::string> words_of(const std::string& command) {
    std::vector<std::string> words;
    std::istringstream text(command);
    for (std::string word; text >> word;) { words.push_back(word == "\"\"" ? "" : word); }
    return words;
}

std::set<std::string> names_here() {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(".")) { names.insert(entry.path().filename().string()); }
    return names;
}

void expect_told(const std::vector<Row>& rows) {
    const auto before = names_here();
    for (const Row& row : rows) {
        const ProgramResult result = run_gyrolog(words_of(row.command));
        const std::string told = result.out + result.err;
        EXPECT_EQ(result.exit_code, row.exit_code) << "gyrolog " << row.command << '\n' << told;
        EXPECT_THAT(told, HasSubstr(row.said)) << "gyrolog " << row.command;
        EXPECT_LT(told.size(), 4000U) << "gyrolog " << row.command;
        if (row.exit_code > 0 && row.exit_code < 5) {
            EXPECT_EQ(result.out, "") << "gyrolog " << row.command;
        }
        EXPECT_EQ(names_here(), before) << "gyrolog " << row.command;
    }
}

constexpr const char* duration_forms = "is no duration: write 90, 90s, 15m, 6h or 1d";
constexpr const char* device_forms =
    "a device is usb:, usb:SERIAL, tty:PATH[,speed=BAUD], sim:KEY=VALUE,... or replay:FILE";

TEST_F(WrongInput, OfTheProgramAndOfAnyCommand) {
    expect_told({
        {"frobnicate", 2, "gyrolog: there is no command 'frobnicate'\nrun `gyrolog --help`"},
        {"analyse c.csv", 2, "there is no command 'analyse'; did you mean analyze?\nrun"},
        {"\"\"", 2, "there is no command ''"},
        {"--plott", 2, "gyrolog: there is no option --plott\nrun"},
        {"--device nonsense", 2, "nonsense has no ':'; a device is usb:"},
        {"-o x.csv", 2, "--output 'x.csv' has none of the endings of a capture: .pcapng"},
        {"--duration -5", 2, "it has to be longer than 0"},
        {"list extra", 2, "not expected: extra\nrun `gyrolog list --help`"},
        {"list --json", 2, "--json wants its FILE behind it"},
        {"list --json \"\"", 2, "--json is given and empty: fill it in, or leave it out"},
        {"list --json dir", 1, "write 'dir': it is a directory"},
        {"analyze --plott", 2,
         "analyze: there is no option --plott; did you mean --plot?\nrun `gyrolog analyze --help`"},
    });
}

TEST_F(WrongInput, OfCommandsThatReadACapture) {
    for (const std::string command : {"info", "check"}) {
        const auto row = [&](const std::string& rest, int code, const char* said) {
            const std::string line = command + rest;
            expect_told({{line.c_str(), code, said}});
        };
        row("", 2, "FILE is required");
        row(" \"\"", 2, "FILE is given and empty");
        row(" none.pcapng", 1, "open 'none.pcapng': No such file or directory");
        row(" dir", 1, "open 'dir': not a regular file");
        row(" empty.pcapng", 1, "read capture 'empty.pcapng': the file is empty");
        row(" head.pcapng", 1,
            "read capture 'head.pcapng': it holds no whole block: it is no capture, or its writer died");
        row(" noise.pcapng", 1, "open 'noise.pcapng': not a capture: neither pcapng nor pcap");
        row(" c.csv", 1, "open 'c.csv': not a capture: neither pcapng nor pcap");
        row(" m.json", 1, "open 'm.json': not a capture");
        row(" -", 2, "FILE '-': standard input is read by its name, /dev/stdin");
        row(" c.pcapng c.pcapng", 2,
            command == "info" ? "not expected: c.pcapng" : "several recordings need --jsonl FILE");
        row(" c.pcapng --json c.pcapng", 2, "FILE and --json are the same file 'c.pcapng'");
        row(" c.pcapng --json dir", 1, "write 'dir': it is a directory");
    }
    expect_told({
        {"check damaged.pcapng", 5, "\n  damaged: something that was captured is gone\n"},
        {"check cut.pcapng", 0, "\n  nothing is missing before the torn tail; what came after it"},
        {"recover", 2, "FILE is required"},
        {"recover c.pcapng", 2, "--output is required"},
        {"recover none.pcapng -o r.pcapng", 1, "open 'none.pcapng': No such file or directory"},
        {"recover dir -o r.pcapng", 1, "open 'dir': not a regular file"},
        {"recover empty.pcapng -o r.pcapng", 1, "'empty.pcapng': it holds no intact block of a capture"},
        {"recover noise.pcapng -o r.pcapng", 1, "recover 'noise.pcapng': not a capture"},
        {"recover c.csv -o r.pcapng", 1, "recover 'c.csv': not a capture"},
        {"recover c.pcapng -o cut.pcapng", 2, "write 'cut.pcapng': it exists; choose another name"},
        {"recover c.pcapng -o c.pcapng", 2, "FILE and --output are the same file"},
        {"recover c.pcapng -o r.txt", 2, "--output 'r.txt' has none of the endings of a capture: .pcapng"},
        {"recover c.pcapng -o none/r.pcapng", 1, "write 'none/r.pcapng': no such directory"},
        {"recover c.pcapng c.pcapng -o r.pcapng", 2, "not expected: c.pcapng"},
        {"recover c.pcapng -o -", 2, "--output '-': only --json goes to standard output"},
    });
    const std::string check = run_gyrolog({"check", "damaged.pcapng"}).out;
    EXPECT_TRUE(check.ends_with("  damaged: something that was captured is gone\n")) << check;
}

TEST_F(WrongInput, OfCapture) {
    expect_told({
        {"capture", 2, "--output is required"},
        {"capture -o \"\"", 2, "--output is given and empty"},
        {"capture -o x.csv --device sim:", 2, "'x.csv' has none of the endings of a capture: .pcapng"},
        {"capture -o x --device sim:", 2, "'x' has none of the endings of a capture: .pcapng"},
        {"capture -o - --device sim:", 2, "--output '-': only --json goes to standard output"},
        {"capture -o dir --device sim:", 1, "write 'dir': it is a directory"},
        {"capture -o c.pcapng --device sim: --samples 5", 2, "choose another name or --force"},
        {"capture -o c.pcapng --device replay:c.pcapng --force", 2,
         "--device and --output are the same file"},
        {"capture -o x.pcapng --device usbb:", 2, "device 'usbb:': usbb is no kind of device"},
        {"capture -o x.pcapng --device usb", 2, device_forms},
        {"capture -o x.pcapng --device tty:", 2, "nothing stands behind the ':'"},
        {"capture -o x.pcapng --device /dev/ttyACM0", 2, device_forms},
        {"capture -o none/x.pcapng --device sim:", 1, "write 'none/x.pcapng': no such directory"},
        {"capture -o x.pcapng --device tty:/dev/null,speed=fast", 2, "speed=fast: wants a number of baud"},
        {"capture -o x.pcapng --device tty:/dev/no_such_tty", 3, "/dev/no_such_tty"},
        {"capture -o x.pcapng --device tty:/dev/null", 2, "open serial port '/dev/null': not a terminal"},
        {"capture -o x.pcapng --device sim:rat=5", 2, "rat=5: there is no such option; there are model rate"},
        {"capture -o x.pcapng --device sim:rate=abc", 2, "rate=abc: wants a rate in Hz up to 32000"},
        {"capture -o x.pcapng --device sim:rate=-1", 2, "rate=-1: wants a rate in Hz up to 32000"},
        {"capture -o x.pcapng --device sim:rate", 2, "rate is not KEY=VALUE"},
        {"capture -o x.pcapng --device sim:model=none.json", 1, "read model 'none.json': no such file"},
        {"capture -o x.pcapng --device sim:model=c.csv", 1, "model 'c.csv': no JSON: line 1"},
        {"capture -o x.pcapng --device replay:none.pcapng", 1, "open 'none.pcapng': No such file"},
        {"capture -o x.pcapng --device replay:c.csv", 1, "open 'c.csv': not a capture"},
        {"capture -o x.pcapng --device sim: --duration \"\"", 2, duration_forms},
        {"capture -o x.pcapng --device sim: --duration 0", 2, "it has to be longer than 0"},
        {"capture -o x.pcapng --device sim: --duration -5s", 2, "it has to be longer than 0"},
        {"capture -o x.pcapng --device sim: --duration nan", 2, duration_forms},
        {"capture -o x.pcapng --device sim: --duration 1e99", 2, "it has to be ten years at the most"},
        {"capture -o x.pcapng --device sim: --duration soon", 2, "--duration: 'soon' is no duration"},
        {"capture -o x.pcapng --device sim: --samples 0", 2, "'0' is no whole number from 1 to"},
        {"capture -o x.pcapng --device sim: --samples -3", 2, "'-3' is no whole number from 1 to"},
        {"capture -o x.pcapng --device sim: --samples 1.5", 2, "'1.5' is no whole number from 1 to"},
        {"capture -o x.pcapng --device sim: --samples 99999999999999999999", 2,
         "is no whole number from 1 to"},
        {"capture -o x.pcapng --device sim: --full-scale 0", 2,
         "--full-scale: '0' is no whole number from 1"},
        {"capture -o x.pcapng --device sim: --full-scale 70000", 2,
         "'70000' is no whole number from 1 to 65535"},
        {"capture -o x.pcapng --device sim: --rate nan", 2, "--rate: nan must be a finite number above 0"},
        {"capture -o x.pcapng --device sim: --rate inf", 2, "--rate: inf must be a finite number above 0"},
        {"capture -o x.pcapng --device sim: --rate -1", 2, "--rate: -1 must be a finite number above 0"},
        {"capture -o x.pcapng --device sim: --rate \"\"", 2, "--rate: '' is no number"},
        {"capture -o x.pcapng --device sim: --rate 1e9", 2, "--rate 1e+09: out of range"},
        {"capture -o x.pcapng --device sim: --rate 8000 --samples 9", 2,
         "or 8000 Hz with --dlpf 250, 3600 or off"},
        {"capture -o x.pcapng --device sim: --full-scale 300", 2,
         "the board on sim: does not have --full-scale 300: an MPU-9250 has 250, 500, 1000, 2000"},
        {"capture -o x.pcapng --device sim: --dlpf 42", 2,
         "does not have --dlpf 42: an MPU-9250 has 5, 10, 20, 41, 92, 184, 250, 3600 Hz, and off"},
        {"capture -o x.pcapng --device sim: --rate 333", 2,
         "does not have --rate 333: an MPU-9250 has 1000 Hz over a whole number up to 250"},
        {"capture -o x.pcapng --device sim: --dlpf wide", 2,
         "--dlpf 'wide': write a bandwidth in Hz (5, 10,"},
        {"capture -o x.pcapng --device sim: --min-free lots", 2, "'lots' is no size: write 64k, 500M, 2G"},
        {"capture -o x.pcapng --device sim: --min-free 900000T", 6, "(--min-free); make room, or choose"},
        {"capture -o x.pcapng --device sim: --rotate-size 0", 2, "--rotate-size: '0' is no size"},
        {"capture -o x.pcapng --device sim: --rotate-every x", 2, "--rotate-every: 'x' is no duration"},
        {"capture -o x.pcapng --device sim: --on-unplug panic", 2, "'panic' is none of wait, exit"},
        {"capture -o x.pcapng --device sim: --denoise-out y.csv", 2, "add --denoise METHOD"},
        {"capture -o x.pcapng --device sim: --nonsense", 2,
         "there is no option --nonsense\nrun `gyrolog capture"},
        {"capture --outptu x.pcapng", 2, "there is no option --outptu; did you mean --output?"},
        {"capture --outptu=x.pcapng", 2, "there is no option --outptu; did you mean --output?"},
        {"capture x.pcapng", 2, "--output is required"},
        {"diagnose x.csv --unnamed --modle-out y.json", 2,
         "there is no option --modle-out; did you mean --model-out?"},
        {"capture -o out/lost.pcapng --device sim:rate=100,unplug=1 --duration 9s --on-unplug exit", 4,
         "the board is lost, what came before is saved"},
        {"capture -o out/holes.pcapng --device sim:rate=1000,fault=drop_packet@1 --duration 9s", 5,
         "run `gyrolog check out/holes.pcapng`"},
    });
}

TEST_F(WrongInput, OfAnalyze) {
    expect_told({
        {"analyze", 2, "give a RECORDING, or --curve with an Allan curve"},
        {"analyze \"\"", 2, "RECORDING is given and empty"},
        {"analyze -", 2, "RECORDING '-': standard input is read by its name, /dev/stdin"},
        {"analyze none.csv", 1, "read 'none.csv': no such file"},
        {"analyze none.pcapng", 1, "open 'none.pcapng': No such file"},
        {"analyze dir", 1, "read 'dir': it is a directory"},
        {"analyze empty.csv", 1, "read 'empty.csv': empty: line 1 must name the columns, such as t_s,gx_dps"},
        {"analyze empty.pcapng", 1, "read capture 'empty.pcapng': the file is empty"},
        {"analyze noise.csv", 1, "read 'noise.csv': this is no text, and no capture"},
        {"analyze noise.pcapng", 1, "open 'noise.pcapng': not a capture"},
        {"analyze m.json", 1, "read 'm.json': this is JSON, a model or a report perhaps, and no table"},
        {"analyze packed.csv", 1,
         "read 'packed.csv': it is compressed with xz, and its name does not say so: it should end in .xz"},
        {"analyze plain.csv.gz", 1, "read 'plain.csv.gz': its name ends in .gz, and it is not compressed"},
        {"analyze other.csv.gz", 1, "its name ends in .gz, and it is compressed with xz"},
        {"analyze torn.csv.xz", 1, "read 'torn.csv.xz': its compressed text is damaged or cut off"},
        {"analyze cr.csv", 1, "line 1: the lines end in carriage returns alone: end them in line feeds"},
        {"analyze mixed.csv", 1, "line 3, column 't_s': '0.2' has a decimal point where line 2 has a comma"},
        {"analyze nounit.csv", 2, "no unit in the name of gyr_x, gyr_y: give it with --unit (deg/s, rad/s,"},
        {"analyze nounit.csv --unit furlong", 2,
         "--unit: 'furlong' is no unit of a gyro: write deg/s, rad/s"},
        {"analyze nounit.csv --acc-unit dps", 2,
         "--acc-unit: 'dps' is no unit of an accelerometer: write g,"},
        {"analyze nounit.csv --columns gyr_z=gx_dps", 2, "no column 'gyr_z' among time, gyr_x, gyr_y"},
        {"analyze nounit.csv --columns t,gx_dps,gy_dps,gz_dps", 1, "has 3 columns, and --columns names 4"},
        {"analyze nounit.csv --columns t,,gx", 2, "--columns 't,,gx': a name is empty; write _ for a column"},
        {"analyze nounit.csv --columns t,warp", 2,
         "--columns: 'warp' is no name of a column: write t, gx, gy"},
        {"analyze noname.csv", 1, "line 1 holds numbers, and no line before it names the columns: put"},
        {"analyze noname.csv --columns t,gx", 2, "line 1: no unit in the name of gx: give it with --unit"},
        {"analyze anytime.csv", 2,
         "may be 0.1 Hz in s or 100 Hz in ms: name it with --columns time=t_s (or t_ms,"},
        {"analyze both.csv", 1, "line 1: columns 'gx_dps' and 'gx_rad_s' are both gx: leave one out"},
        {"analyze scaled.csv --lsb-dps 65.5", 2,
         "a data sheet's 65.5 LSB per deg/s is --lsb-dps 0.0152672 (1/65.5)"},
        {"analyze cut.npy", 1, "read 'cut.npy': no whole .npy: it is cut off in its header"},
        {"analyze big.npy", 1,
         "read 'big.npy': its numbers are big endian ('>f8'): save it as a.astype('<f8')"},
        {"analyze plain.npy", 2,
         "an .npy does not name its columns, and this has 2: name them with --columns"},
        {"analyze plain.npy --columns gx,gy", 2, "gx, gy: give it with --unit"},
        {"analyze cut.mat", 1, "read 'cut.mat': no MAT-file that libmatio can read"},
        {"analyze a.npz", 1,
         "read 'a.npz': this is an archive (.npz, .zip, .xlsx): take one table out of it"},
        {"analyze utf16.csv", 1, "read 'utf16.csv': the text is UTF-16: save it as UTF-8 or ASCII"},
        {"analyze word.csv", 1, "line 3, column 'gx_dps': 'two' is no number; leave the field empty"},
        {"analyze short.csv", 1,
         "line 3: 2 fields where line 1 names 3 columns; the first without one is column "
         "'gy_dps'"},
        {"analyze long.csv", 1,
         "line 3: 4 fields where line 1 names 3 columns; the last of them is column 'gy_dps'"},
        {"analyze unit.csv", 1,
         "line 1: no gyro column and none of an accelerometer, but t_s, gx_furlong: name"},
        {"analyze nostamps.csv", 2, "no column t_s: give the sampling rate with --rate"},
        {"analyze backwards.csv", 1, "the time stamps step back by 1 s at row 3: cut the recording there"},
        {"analyze header.csv", 1, "read 'header.csv': no samples after the header line"},
        {"analyze twice.csv", 1, "line 1: column 'gx_dps' appears twice"},
        {"analyze c.csv c.csv", 2, "several recordings need --jsonl FILE"},
        {"analyze c.csv c.csv --jsonl dir", 1, "write 'dir': it is a directory"},
        {"analyze --jsonl l.jsonl", 2, "give a RECORDING, or --curve"},
        {"analyze c.csv --from soon", 2, "--from: 'soon' is no duration"},
        {"analyze c.csv --from -5", 2, "--from: '-5' is no duration: it has to be longer than 0, or 0"},
        {"analyze c.csv --from 99", 2, "'c.csv' has no sample from 99 s to"},
        {"analyze c.csv --from 19.991", 2, "'c.csv' has only one sample from 19.991 s"},
        {"analyze c.csv --from 5 --to 3s", 2, "--from 5 s is not before --to 3 s"},
        {"analyze counts.csv --still auto", 1,
         "'counts.csv' has no part of a few seconds in which nothing turns"},
        {"analyze c.csv --still 0,5", 2, "--still: '0,5' is none of auto"},
        {"analyze --curve curve.csv --from 2", 2, "--curve excludes --from"},
        {"analyze c.csv --rate nan", 2, "--rate: nan must be from 0.0001 to 10000000 Hz"},
        {"analyze c.csv --rate -1", 2, "--rate: -1 must be from 0.0001"},
        {"analyze c.csv --rate 1e300", 2, "--rate: 1e300 must be from 0.0001"},
        {"analyze c.csv --rate \"\"", 2, "--rate: '' is no number"},
        {"analyze c.csv --rate fast", 2, "--rate: 'fast' is no number"},
        {"analyze c.csv --confidence 95", 2, "--confidence: 95 must be from 0.01 to 0.9999"},
        {"analyze c.csv --m 0", 2, "'0' is no list of whole numbers from 1 up: write 1,10,100"},
        {"analyze c.csv --m 1,,2", 2, "'1,,2' is no list of whole numbers from 1 up"},
        {"analyze c.csv --lsb-dps inf", 2, "--lsb-dps: inf must be a finite number above 0"},
        {"analyze c.csv --deviation best", 2, "'best' is none of overlapping, "},
        {"analyze c.csv --plot a.jpg", 2,
         "'a.jpg' does not end in .png, .svg or .pdf: a figure has no other form"},
        {"analyze c.csv --plot a.png --plot-width 20", 2, "--plot-width: 20 must be from 88 to 420 mm"},
        {"analyze c.csv --plot a.png --plot-width wide", 2, "--plot-width: 'wide' is no number"},
        {"analyze c.csv --plot a.png --plot-dpi 0", 2, "--plot-dpi: 0 must be from 72 to 600"},
        {"analyze c.csv --json c.csv", 2, "RECORDING and --json are the same file 'c.csv'"},
        {"analyze c.csv --model -", 2, "--model '-': only --json goes to standard output"},
        {"analyze c.csv --model \"\"", 2, "--model is given and empty"},
        {"analyze c.csv --model dir", 1, "write 'dir': it is a directory"},
        {"analyze --curve none.csv", 1, "read 'none.csv': no such file"},
        {"analyze --curve c.csv", 1,
         "line 1: no column tau_s; it must name the columns, such as tau_s,x_dps"},
        {"analyze --curve c.pcapng", 1, "this is a capture, not an Allan curve: give it as RECORDING"},
        {"analyze c.csv --quiet=foo", 2, "--quiet takes no value, and has 'foo'"},
        {"analyze --curve fewpoints.csv", 1, "column 'x_dps': 2 points; a model needs"},
        {"analyze --curve curve.csv c.csv", 2, "give a RECORDING or --curve, not both"},
        {"analyze --curve curve.csv --m 1", 2, "--curve excludes --m"},
        {"analyze --curve curve.csv --unit deg/s", 2, "--curve excludes --unit"},
    });
}

TEST_F(WrongInput, OfCommandsThatReadAModel) {
    for (const std::string command : {"simulate % -o s.csv --duration 1s", "diagnose c.csv --model %",
                                      "denoise c.csv --model %", "export % -o s.yaml"}) {
        const auto row = [&](const std::string& model, const char* said) {
            const std::string line = with(command, "%", model);
            expect_told({{line.c_str(), 1, said}});
        };
        row("none.json", "read model 'none.json': no such file");
        row("empty.json", "model 'empty.json': no JSON: the file is empty");
        row("noise.json", "model 'noise.json': no JSON: line 1, column 1");
        row("list.json", "model 'list.json': not a JSON object");
        row("nocomma.json", "model 'nocomma.json': no JSON: line 3, column 35: unexpected string literal");
        row("comment.json", "model 'comment.json': no JSON: line 3, column 3: invalid literal");
        row("utf16.json", "model 'utf16.json': no JSON: the text is UTF-16: save it as UTF-8");
        row("future.json", "schema is 'gyrolog-model/9', not 'gyrolog-model/1'");
        row("noschema.json", "model 'noschema.json': schema is missing");
        row("words.json", "model 'words.json': axes.x.N is not a finite number");
        row("nan.json", "model 'nan.json': axes.x.N is not a finite number");
        row("negative.json", "model 'negative.json': axes.x.N is negative");
    }
    expect_told({
        {"simulate gremlins.json -o s.csv", 1, "effect 'gremlins' cannot be simulated by this version"},
        {"simulate c.csv -o s.csv", 1, "model 'c.csv': no JSON: line 1"},
        {"simulate c.pcapng -o s.csv", 1, "model 'c.pcapng': this is a capture, not a model"},
        {"simulate dir -o s.csv", 1, "read model 'dir': it is a directory"},
        {"simulate", 2, "give the MODEL to simulate, or --effects"},
        {"simulate m.json", 2, "give the recording to write with -o"},
        {"simulate m.json -o s.txt", 2, "'s.txt' has none of the endings of a recording: .csv"},
        {"simulate m.json -o -", 2, "'-' has none of the endings"},
        {"simulate m.json -o s.csv --duration \"\"", 2, duration_forms},
        {"simulate m.json -o s.csv --duration nan", 2, duration_forms},
        {"simulate m.json -o s.csv --rate 0", 2, "--rate: 0 must be from 0.0001"},
        {"simulate m.json -o s.csv --seed -1", 2, "--seed: '-1' is no whole number from 0"},
        {"simulate m.json -o s.csv --seed 1.5", 2, "--seed: '1.5' is no whole number"},
        {"simulate m.json -o s.csv --like none.csv", 1, "--like: read 'none.csv': no such file"},
        {"simulate m.json -o s.csv --like m.json", 1, "--like: read 'm.json': this is JSON"},
        {"simulate m.json m.json -o s.csv", 2, "not expected: m.json"},
        {"simulate m.json#arm -o s.csv", 2, "model 'm.json': it is one sensor; '#arm' names none"},
        {"simulate m.json -o s.csv --duration 1e300", 2, "it has to be ten years at the most"},
        {"simulate m.json -o s.csv --model-out m.json", 2, "MODEL and --model-out are the same file"},
    });
}

TEST_F(WrongInput, OfCompareDiagnoseAndDenoise) {
    expect_told({
        {"compare", 2, "RECORDING is required"},
        {"compare c.csv", 2, "WITH is required"},
        {"compare none.csv m.json", 1, "read 'none.csv': no such file"},
        {"compare c.csv dir", 1, "read 'dir': it is a directory"},
        {"compare c.csv word.csv", 1, "read 'word.csv': line 3, column 'gx_dps'"},
        {"compare nounit.csv m.json", 2, "gyr_x, gyr_y: give it with --unit"},
        {"compare nostamps.csv m.json", 2, "no column t_s: give the sampling rate with --rate"},
        {"diagnose nostamps.csv --model m.json", 2, "no column t_s: give the sampling rate with --rate"},
        {"diagnose noname.csv --model m.json", 1, "line 1 holds numbers"},
        {"denoise nounit.csv", 2, "gyr_x, gyr_y: give it with --unit"},
        {"report nounit.csv -o r.html", 2, "gyr_x, gyr_y: give it with --unit"},
        {"compare c.csv future.json", 1, "model 'future.json': schema is 'gyrolog-model/9'"},
        {"compare c.csv m.json --simulations 1", 2, "--simulations: '1' is no whole number from"},
        {"compare c.csv m.json --duration soon", 2, duration_forms},
        {"compare c.csv m.json --json c.csv", 2, "RECORDING and --json are the same file"},
        {"diagnose", 2, "give a RECORDING, or --curve with an Allan curve"},
        {"diagnose c.csv", 2, "give the --model that the recording is to be held against"},
        {"diagnose none.csv --model m.json", 1, "read 'none.csv': no such file"},
        {"diagnose c.csv --model m.json --average 100000", 1,
         "`--average 100000` is longer than 'c.csv', which has 2,000 samples; a diagnosis needs 2048 at "
         "least"},
        {"diagnose c.pcapng --model m.json --average 100000", 1,
         "`--average 100000` is longer than 'c.pcapng', which has 2,000 samples;"},
        {"diagnose word.csv --model m.json", 1, "line 3, column 'gx_dps': 'two' is no number"},
        {"diagnose c.csv --model c.pcapng", 1, "model 'c.pcapng': this is a capture"},
        {"diagnose c.csv --model m.json --model-out m.json", 2, "--model and --model-out are the same file"},
        {"diagnose c.csv --model m.json --model-out -", 2, "--model-out '-': only --json goes to standard"},
        {"diagnose c.csv --model m.json --average 0", 2, "'0' is no whole number from 1 to 100000"},
        {"diagnose c.csv --model m.json --simulations 1e9", 2, "'1e9' is no whole number from 20 to 10000"},
        {"diagnose c.csv --model m.json --threads -1", 2, "'-1' is no whole number from 0 to 1024"},
        {"diagnose c.csv --model c.pcapng", 1,
         "read model 'c.pcapng': this is a capture, not a model; `gyrolog analyze c.pcapng --model"},
        {"diagnose --curve curve.csv --average 5", 2, "--curve excludes --average"},
        {"calibrate", 2, "RECORDING is required"},
        {"calibrate c.csv dir/../c.csv", 2,
         "'c.csv' and 'dir/../c.csv' are the same recording: it would count twice"},
        {"analyze c.csv --columns t_s=_,t_s=gx_dps", 2, "'t_s' is named twice"},
        {"calibrate none.csv", 1, "read 'none.csv': no such file"},
        {"denoise", 2, "RECORDING is required"},
        {"denoise none.csv", 1, "read 'none.csv': no such file"},
        {"denoise m.json", 1, "read 'm.json': this is JSON"},
        {"denoise torn.csv.xz", 1, "its compressed text is damaged or cut off"},
        {"denoise c.csv dir/../c.csv", 2,
         "'c.csv' and 'dir/../c.csv' are the same recording: each unit of an array has its own"},
        {"diagnose longer.csv --model m.json --ask none.json", 1, "read effect 'none.json': no such file"},
        {"diagnose longer.csv --model m.json --ask m.json", 1,
         "schema is 'gyrolog-model/1', not 'gyrolog-effect/1'"},
        {"diagnose longer.csv --model m.json --ask long.csv.txt", 1,
         "it is longer than 16.8 MB, and no effect is"},
        {"diagnose longer.csv --model m.json --holdout none.csv", 1, "read 'none.csv': no such file"},
        {"diagnose longer.csv --model m.json --holdout m.json", 1,
         "read 'm.json': this is JSON, a model or a report"},
        {"diagnose c.csv --auto --model m.json", 2, "--model excludes --auto"},
        {"diagnose c.csv --auto --model-out x.sdf", 2,
         "the model is no simulator's file: write a .json, of which `gyrolog export` makes one"},
        {"diagnose force.csv --auto --sensor accelerometer", 1,
         "has 100 samples; a diagnosis needs at least"},
        {"compare c.csv m.json --sensor ear", 2, "--sensor: 'ear' is none of gyro, accelerometer"},
        {"denoise c.csv -o d.txt", 2, "'d.txt' has none of the endings of a denoised recording: .csv"},
        {"denoise c.csv -o c.csv", 2, "RECORDING and --output are the same file"},
        {"denoise c.csv --method magic", 2, "'magic' is none of kalman, wavelet, joint"},
        {"denoise c.csv --bandwidth -1", 2, "--bandwidth: -1 must be from 1e-06"},
        {"denoise c.csv --window 3", 2, "'3' is no whole number from 14 to 65536"},
        {"denoise c.csv --still x", 2, "wants two times in seconds from the first sample, FROM,TO"},
        {"denoise c.csv --still 100,200", 2, "the recording has no sample there, it lasts 20"},
        {"denoise c.csv --duration 0", 2, "it has to be longer than 0"},
        {"denoise c.csv --calibration none.csv", 1, "read 'none.csv': no such file"},
        {"denoise c.csv --saturation nan", 2, "--saturation: nan must be a finite number above 0"},
    });
}

// An accelerometer alone: the way to go on, or what needs no gyro.
TEST_F(WrongInput, OfRecordingsWithoutAGyro) {
    const char* const way =
        "'force.csv' has an accelerometer and no gyro: `--sensor accelerometer` takes that";
    expect_told({
        {"analyze force.csv --sensor gyro", 2, way},
        {"diagnose force.csv --model m.json", 2, way},
        {"compare force.csv m.json", 2, way},
        {"denoise force.csv -o out/d.csv", 2, way},
        {"export force.csv -o out/f.yaml", 2,
         "'force.csv' has an accelerometer and no gyro: this format is of a gyro's noise"},
        {"export force.csv -o out/f.csv", 0, "written: out/f.csv"},
        {"export force.csv -o out/f.mat", 0, "written: out/f.mat"},
        {"simulate m.json --like force.csv -o out/like.csv", 0, "has no gx, gy, gz; simulated all the same"},
    });
}

TEST_F(WrongInput, OfExportAndConform) {
    expect_told({
        {"export", 2, "RECORDING is required"},
        {"export c.csv", 2, "--output is required"},
        {"export none.csv -o e.csv", 1, "read 'none.csv': no such file"},
        {"export dir -o e.csv", 1, "read 'dir': it is a directory"},
        {"export unit.csv -o e.csv", 1,
         "line 1: no gyro column and none of an accelerometer, but t_s, gx_furlong: name columns by"},
        {"export counts.csv -o out/e.csv --lsb-dps 16.4", 0,
         "makes each count 16.4 deg/s, coarser than any gyro's; a data sheet's 16.4 LSB per deg/s is "
         "--lsb-dps"},
        {"export c.pcapng -o out/e.csv --lsb-dps 0.015", 0,
         "warning: --lsb-dps is ignored: a capture says itself what its counts are"},
        {"export c.csv -o out/e.csv --lsb-dps 0.015", 0,
         "warning: --lsb-dps is ignored: no gyro column holds counts"},
        {"export counts.csv -o out/e.csv --lsb-dps 0.015 --lsb-g 0.001", 0,
         "warning: --lsb-g is ignored: no accelerometer column holds counts"},
        {"export c.pcapng -o out/e.csv --unit deg/s", 0,
         "warning: --columns, --unit and --acc-unit are ignored"},
        {"export nounit.csv -o e.csv", 2, "gyr_x, gyr_y: give it with --unit"},
        {"export counts.csv -o e.yaml", 2, "give the scale of counts with --lsb-dps"},
        {"export c.csv -o e", 2, "'e' has none of the endings that tell the format: .csv"},
        {"export c.csv -o e.xls", 2, "'e.xls' has none of the endings that tell the format: .csv"},
        {"export c.csv -o e.sdf", 2, "for another simulator or a filter, --for says which"},
        {"export c.csv -o -", 2, "--output '-': only --json goes to standard output"},
        {"export c.csv -o c.csv", 2, "RECORDING and --output are the same file"},
        {"export m.json -o e.csv", 2, "a model has no samples for a .csv: `gyrolog simulate` makes"},
        {"export m.json -o e.sdf", 2, "'e.sdf' has none of the endings that tell the format: .csv"},
        {"export m.json -o e.sdf --for px4", 2,
         "--for: there is no simulator or filter 'px4'; there are the"},
        {"export m.json -o e.sdf --for sdf --horizon soon", 2, "--horizon: 'soon' is no duration"},
        {"conform --device sim: extra", 2, "not expected: extra"},
        {"conform --device", 2, "--device wants its URI behind it"},
        {"conform --device usbb:", 2, "device 'usbb:': usbb is no kind of device"},
        {"conform --device tty:/dev/no_such_tty", 3, "/dev/no_such_tty"},
        {"conform --device replay:c.pcapng", 2,
         "conform wants a device that answers: usb:, tty:PATH or sim:"},
        {"conform --device sim:breach=nothing", 2, "breach=nothing: there is no such breach; there are"},
        {"conform --device sim:unplug=2", 4, "gyrolog conform: "},
        {"conform --device sim:breach=checksum", 7, "does not conform"},
        {"conform --device sim: --transcript -", 2, "--transcript '-': only --json goes to standard output"},
    });
    if (!has_full_disk()) { GTEST_SKIP() << needs_full_disk; }
    fs::create_symlink("/dev/full", "full.mat");
    expect_told({{"export c.csv -o full.mat", 6, "disk full"}});
}

TEST_F(WrongInput, OfReportAndCalibrate) {
    expect_told({
        {"report", 2, "RECORDING is required"},
        {"report c.csv", 2, "--output is required"},
        {"report none.csv -o r.html", 1, "read 'none.csv': no such file"},
        {"report dir -o r.html", 1, "read 'dir': it is a directory"},
        {"report m.json -o r.html", 1, "read 'm.json': this is JSON, a model or a report perhaps"},
        {"report c.csv c.csv -o r.html", 2,
         "a page is of one recording; of several, give the results of `gyrolog analyze ... --jsonl"},
        {"report lines.jsonl c.csv -o r.html", 2,
         "a page is of one recording or of results (.jsonl), not of"},
        {"report c.csv -o r.txt", 2, "'r.txt' has none of the endings of a page: .html, .htm"},
        {"report c.csv -o -", 2, "--output '-': only --json goes to standard output"},
        {"report c.csv -o dir", 1, "write 'dir': it is a directory"},
        {"report c.csv --model none.json -o r.html", 1, "read model 'none.json': no such file"},
        {"report c.csv --model \"\" -o r.html", 2, "--model is given and empty"},
        {"calibrate dir", 1, "read 'dir': it is a directory"},
        {"calibrate m.json", 1, "read 'm.json': this is JSON"},
        {"calibrate word.csv", 1, "line 3, column 'gx_dps': 'two' is no number"},
        {"calibrate c.csv --turn x", 2, "--turn: 'x' is no number"},
        {"calibrate c.csv --turn 0", 2, "--turn: 0 must be a finite number above 0"},
        {"calibrate c.csv --px4 \"\"", 2, "--px4 is given and empty"},
        {"calibrate c.csv --header -", 2, "--header '-': only --json goes to standard output"},
    });
}

TEST_F(WrongInput, OfTable) {
    expect_told({
        {"table", 2, "LINES is required"},
        {"table \"\" -o t.csv", 2, "LINES is given and empty"},
        {"table none.jsonl -o t.csv", 1, "read 'none.jsonl': no such file"},
        {"table dir -o t.csv", 1, "read 'dir': it is a directory"},
        {"table c.csv -o t.csv", 1, "read 'c.csv': line 1: no JSON: column 2"},
        {"table c.csv -o t.csv", 1, "analyze, check, compare or diagnose wrote with --jsonl"},
        {"manual analyse", 2, "there is no command 'analyse'; did you mean analyze?"},
        {"table noise.csv -o t.csv", 1, "read 'noise.csv': line 1"},
        {"table list.json -o t.csv", 1, "read 'list.json': line 1"},
        {"table m.json -o t.csv", 1, "read 'm.json': line 1: no JSON"},
        {"table lines.jsonl -o t.csv --expected none.txt", 1, "read 'none.txt': no such file"},
        {"table lines.jsonl -o t.csv --expected c.pcapng", 1,
         "read 'c.pcapng': line 3: this is no text: names stand in it one a line"},
        {"table lines.jsonl -o t.csv --population t.csv", 2, "--output and --population are the same file"},
        {"table m.json", 2, "--output is required"},
        {"table m.json -o t.xls", 2, "'t.xls' has none of the endings of a table: .csv, .sqlite"},
        {"table m.json -o -", 2, "--output '-': give a name that ends in .csv or .sqlite"},
        {"table m.json -o t.csv --sensor nose", 2, "'nose' is none of gyro, accelerometer, all"},
        {"table m.json -o m.json", 2, "'m.json' has none of the endings of a table"},
    });
}

TEST_F(WrongInput, OfDoctorExtcapManualAndCompletion) {
    expect_told({
        {"doctor extra", 2, "not expected: extra"},
        {"doctor --root", 2, "--root wants its FOLDER behind it"},
        {"doctor --root none", 2, "--root: Directory does not exist: none"},
        {"doctor --root c.csv", 2, "--root: Directory is actually a file: c.csv"},
        {"doctor --json dir", 1, "write 'dir': it is a directory"},
        {"extcap", 2, "give --extcap-interfaces, or --extcap-interface NAME"},
        {"extcap --extcap-interface gyrolog-sim", 2, "give --extcap-dlts, --extcap-config or --capture"},
        {"extcap --extcap-interface gyrolog-sim --capture", 2, "--capture needs --fifo FILE"},
        {"extcap --extcap-interface none --capture --fifo f", 1, "there is no interface 'none', only"},
        {"extcap --extcap-interface gyrolog-sim --capture --fifo none", 1, "open pipe 'none': No such file"},
        {"extcap --extcap-interface gyrolog-sim --capture --fifo m.json", 1,
         "'m.json': it is no named pipe (mkfifo makes one)"},
        {"extcap --extcap-interface gyrolog-sim --capture --fifo f --sim rat=3", 2,
         "rat=3: there is no such option"},
        {"manual nosuch", 2, "there is no command 'nosuch'"},
        {"manual \"\"", 2, "there is no command ''"},
        {"completion", 2, "SHELL is required"},
        {"completion tcsh", 2, "'tcsh' is none of bash, zsh, fish"},
        {"completion \"\"", 2, "'' is none of bash, zsh, fish"},
    });
}

// As the program itself lists them, so that a new command or option is tried as well.
TEST_F(WrongInput, OfEveryCommandAndOption) {
    const std::string help = run_gyrolog({"--help"}).out;
    const std::regex command_line("\n  (\\w+) ");
    const std::regex option_with_value("\n  (?:-\\w,)?(--[\\w-]+) [^ \n]");
    const std::size_t listed = help.find("Subcommands:");
    ASSERT_NE(listed, std::string::npos);
    const auto all_of = [](const std::string& text, const std::regex& what) {
        std::vector<std::string> found;
        for (std::sregex_iterator at(text.begin(), text.end(), what), end; at != end; ++at) {
            found.push_back((*at)[1]);
        }
        return found;
    };
    const std::vector<std::string> commands = all_of(help.substr(listed), command_line);
    EXPECT_GE(commands.size(), 18U);
    std::set<std::string> options;
    const auto expect_usage_error = [](const std::string& command, const std::string& rest,
                                       const std::string& named) {
        const ProgramResult result = run_gyrolog({command, rest});
        const std::string line = "gyrolog " + command + " " + rest;
        EXPECT_EQ(result.exit_code, 2) << line;
        EXPECT_EQ(result.out, "") << line;
        EXPECT_THAT(result.err, testing::StartsWith("gyrolog " + command + ": ")) << line;
        EXPECT_THAT(result.err, HasSubstr(named)) << line;
        EXPECT_TRUE(result.err.ends_with("\nrun `gyrolog " + command + " --help` to see what there is\n"))
            << line << '\n'
            << result.err;
    };
    const auto before = names_here();
    for (const std::string& command : commands) {
        // Whatever else is missing, too.
        expect_usage_error(command, "--frobnicate", "there is no option --frobnicate\n");
        for (const std::string& option : all_of(run_gyrolog({command, "--help"}).out, option_with_value)) {
            const bool may_stand_alone = option == "--extcap-version" || option == "--extcap-capture-filter";
            if (may_stand_alone || !options.insert(option).second) { continue; }
            expect_usage_error(command, option, option + " wants its ");
        }
    }
    EXPECT_GT(options.size(), 60U) << "the help is not read";
    EXPECT_EQ(names_here(), before);
}

}  // namespace
}  // namespace gyrolog
