// What Wireshark is answered. A capture through its pipe: tests/package/wireshark_test.py.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include "host/app/command_line.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Ran {
    ExitCode code = ExitCode::ok;
    std::string out;
    std::string err;
};

Ran extcap(std::vector<std::string> arguments) {
    std::ostringstream out;
    std::ostringstream err;
    arguments.insert(arguments.begin(), "extcap");
    const ExitCode code = run_command_line(std::move(arguments), {out, err});
    return {code, out.str(), err.str()};
}

TEST(Extcap, ListsTheSimulatedBoardAlways) {
    const Ran ran = extcap({"--extcap-interfaces", "--extcap-version=4.0"});
    EXPECT_EQ(ran.code, ExitCode::ok);
    EXPECT_THAT(ran.out, HasSubstr("extcap {version="));
    EXPECT_THAT(ran.out, HasSubstr("interface {value=gyrolog-sim}{display=gyrolog simulated board}\n"));
    EXPECT_EQ(ran.err, "");
}

TEST(Extcap, TellsLinkTypeAndSettings) {
    EXPECT_THAT(extcap({"--extcap-interface", "gyrolog-sim", "--extcap-dlts"}).out,
                HasSubstr("dlt {number=220}{name=USB_LINUX_MMAPPED}"));
    EXPECT_THAT(extcap({"--extcap-interface", "gyrolog-sim", "--extcap-config"}).out,
                HasSubstr("{call=--sim}"));
    EXPECT_THAT(extcap({"--extcap-interface", "gyrolog-usb-S1", "--extcap-config"}).out,
                Not(HasSubstr("--sim}")));
}

TEST(Extcap, SaysWhatIsMissing) {
    EXPECT_EQ(extcap({}).code, ExitCode::usage);
    EXPECT_THAT(extcap({"--extcap-interface", "gyrolog-sim"}).err, HasSubstr("give --extcap-dlts"));
    EXPECT_THAT(extcap({"--extcap-interface", "gyrolog-sim", "--capture"}).err, HasSubstr("needs --fifo"));
}

TEST(Extcap, RefusesAnUnknownInterfaceAndAFileForAPipe) {
    const TemporaryFolder folder;
    const std::string path = folder.path("file");
    std::ofstream(path) << "text";
    const Ran unknown = extcap({"--capture", "--extcap-interface", "gyrolog-usb-none", "--fifo", path});
    EXPECT_NE(unknown.code, ExitCode::ok);
    EXPECT_THAT(unknown.err, HasSubstr("there is no interface 'gyrolog-usb-none', only"));
    const Ran no_pipe = extcap({"--capture", "--extcap-interface", "gyrolog-sim", "--fifo", path});
    EXPECT_EQ(no_pipe.code, ExitCode::failed);
    EXPECT_THAT(no_pipe.err, HasSubstr("it is no named pipe"));
    EXPECT_EQ(read_whole_file(path), "text");
    const Ran setting =
        extcap({"--capture", "--extcap-interface", "gyrolog-sim", "--fifo", path, "--dlpf", "loud"});
    EXPECT_EQ(setting.code, ExitCode::usage);
    EXPECT_THAT(setting.err, HasSubstr("--dlpf 'loud'"));
}

}  // namespace
}  // namespace gyrolog
