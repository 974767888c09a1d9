// Made-up machines, each with one thing in the way.

#include "host/doctor/doctor.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/doctor/udev_rule.hpp"
#include "host/formats/json.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class Doctor : public testing::Test {
protected:
    void SetUp() override {
        machine.root = folder.path("");
        machine.user = "ann";
        machine.groups = {1000, 46, 20};
        machine.kernel_release = "6.1.0-18-amd64";
        machine.now_s = 1'795'000'000;
        machine.may_open = [](const std::string&) { return true; };
        machine.free_bytes = [](const std::string&) { return std::uint64_t{50'000'000'000}; };
        machine.sync_s = [](const std::string&) { return 0.004; };
        put("/dev/bus/usb/001/005", "");
        put("/usr/lib/udev/rules.d/60-gyrolog.rules",
            "ATTR{idVendor}==\"1209\", ATTR{idProduct}==\"6779\"\n");
        put("/etc/group", "root:x:0:\ndialout:x:20:ann\nplugdev:x:46:bob,ann\nann:x:1000:\n");
        put("/sys/module/usbcore/parameters/usbfs_memory_mb", "16\n");
        put("/sys/bus/usb/drivers/cdc_acm/bind", "");
        put("/sys/bus/usb/devices/1-1/idVendor", "1209\n");
        put("/sys/bus/usb/devices/1-1/idProduct", "6779\n");
        put("/sys/bus/usb/devices/1-1/product", "gyrolog bench\n");
        put("/sys/bus/usb/devices/1-1/serial", "S1\n");
        put("/sys/bus/usb/devices/1-1/busnum", "1\n");
        put("/sys/bus/usb/devices/1-1/devnum", "5\n");
        put("/sys/bus/usb/devices/usb1/idVendor", "1d6b\n");
        put("/proc/1/comm", "systemd\n");
        put("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "");
        put("/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf", "");
    }

    void put(const std::string& path, const std::string& text) {
        fs::create_directories(fs::path(machine.at(path)).parent_path());
        std::ofstream(machine.at(path)) << text;
    }
    void take(const std::string& path) { ASSERT_GT(fs::remove_all(machine.at(path)), 0U) << path; }

    // The only thing in the way.
    Diagnostic problem(const std::string& name) {
        Diagnostic found;
        std::string all;
        for (const NamedDiagnostic& one : examine(machine)) {
            if (one.found.fine) {
                EXPECT_EQ(one.found.command, "") << one.name;
                continue;
            }
            all += one.name + ";";
            found = one.found;
            EXPECT_NE(one.found.command, "") << one.name;
        }
        EXPECT_EQ(all, name.empty() ? "" : name + ";");
        return found;
    }

    TemporaryFolder folder;
    Machine machine;
};

TEST_F(Doctor, FindsNothingOnASoundMachine) {
    problem("");
    EXPECT_TRUE(nothing_in_the_way(examine(machine)));
    EXPECT_THAT(doctor_text(examine(machine)), HasSubstr("nothing stands in the way\n"));
}

TEST_F(Doctor, FindsAKernelWithoutUsb) {
    take("/sys/bus/usb/devices");
    EXPECT_THAT(problem("USB").what, HasSubstr("the kernel shows no USB"));
}

TEST_F(Doctor, FindsAContainerWithoutUsbDevices) {
    take("/dev/bus/usb");
    EXPECT_THAT(problem("USB").command, HasSubstr("-v /dev/bus/usb"));
}

TEST_F(Doctor, FindsThatTheRuleIsNotInstalled) {
    take("/usr/lib/udev/rules.d/60-gyrolog.rules");
    EXPECT_THAT(problem("udev rule").command,
                StartsWith("gyrolog doctor --udev-rule | sudo tee /etc/udev/rules.d/60-gyrolog.rules "));
}

// The command that installs the rule needs no file of the source tree.
TEST(UdevRule, OfTheProgramIsThatOfTheProject) {
    const char* source = std::getenv("GYROLOG_SOURCE_DIR");
    if (source == nullptr) { GTEST_SKIP() << "needs GYROLOG_SOURCE_DIR"; }
    EXPECT_EQ(udev_rule_text, read_whole_file(fs::path(source) / "tools/60-gyrolog.rules"));
}

TEST_F(Doctor, FindsAnOlderRuleThatHidesTheNewOne) {
    put("/etc/udev/rules.d/60-gyrolog.rules", "ATTR{idVendor}==\"1fc9\"\n");
    EXPECT_THAT(problem("udev rule").what, HasSubstr("/etc/udev/rules.d/60-gyrolog.rules does not know"));
}

TEST_F(Doctor, FindsAUserWhoIsNotInTheGroup) {
    put("/etc/group", "dialout:x:20:ann\nplugdev:x:46:bob,annie\n");
    machine.groups = {1000, 20};
    EXPECT_EQ(problem("groups").command, "sudo adduser ann plugdev    # then log in again");
    machine.seat = "seat0";
    problem("");
    machine.seat = "";
    machine.is_root = true;
    problem("");
}

TEST_F(Doctor, FindsAGroupThatIsNotThereAndOneThatTheSessionHasNotYet) {
    put("/etc/group", "dialout:x:20:ann\n");
    EXPECT_EQ(problem("groups").command, "sudo groupadd --system plugdev");
    put("/etc/group", "dialout:x:20:ann\nplugdev:x:46:ann\n");
    machine.groups = {1000, 46};
    EXPECT_THAT(problem("groups").what, HasSubstr("in the group dialout, but not yet in this session"));
}

TEST_F(Doctor, FindsABoardThatMayNotBeOpened) {
    std::string asked;
    machine.may_open = [&](const std::string& path) {
        asked = path;
        return false;
    };
    const Diagnostic found = problem("boards");
    EXPECT_EQ(found.what, "the board S1 at /dev/bus/usb/001/005 may not be opened");
    EXPECT_EQ(asked, machine.at("/dev/bus/usb/001/005"));
}

TEST_F(Doctor, LeavesForeignDevicesAlone) {
    put("/sys/bus/usb/devices/1-1/product", "mouse\n");
    machine.may_open = [](const std::string&) { return false; };
    problem("");
}

TEST_F(Doctor, FindsTooLittleUsbMemory) {
    put("/sys/module/usbcore/parameters/usbfs_memory_mb", "4\n");
    EXPECT_EQ(problem("usbfs memory").command,
              "echo 16 | sudo tee /sys/module/usbcore/parameters/usbfs_memory_mb");
    put("/sys/module/usbcore/parameters/usbfs_memory_mb", "0\n");
    problem("");
}

TEST_F(Doctor, FindsAModemManagerThatNothingKeepsOff) {
    put("/proc/77/comm", "ModemManager\n");
    problem("");
    take("/usr/lib/udev/rules.d/60-gyrolog.rules");
    std::string names;
    for (const NamedDiagnostic& one : examine(machine)) {
        if (!one.found.fine) { names += one.name + ";"; }
    }
    EXPECT_EQ(names, "udev rule;ModemManager;");
}

TEST_F(Doctor, FindsAKernelWithoutTheSerialDriver) {
    take("/sys/bus/usb/drivers/cdc_acm");
    problem("");
    put("/lib/modules/6.1.0-18-amd64/modules.dep", "kernel/drivers/usb/class/cdc-acm.ko:\n");
    problem("");
    put("/lib/modules/6.1.0-18-amd64/modules.dep", "kernel/drivers/usb/class/usblp.ko:\n");
    EXPECT_THAT(problem("cdc_acm").what, HasSubstr("--device tty: does not work"));
}

TEST_F(Doctor, FindsAFullDiskAndASlowOne) {
    machine.free_bytes = [](const std::string&) { return std::uint64_t{300'000'000}; };
    EXPECT_THAT(problem("disk space").what, HasSubstr("0.30 GB free here"));
    machine.free_bytes = [](const std::string&) { return std::uint64_t{50'000'000'000}; };
    machine.sync_s = [](const std::string&) { return 1.8; };
    EXPECT_THAT(problem("disk sync").what, HasSubstr("1.8e+03 ms"));
    machine.sync_s = [](const std::string&) {
        return Error{ErrorCode::permission_denied, "permission denied"};
    };
    EXPECT_EQ(problem("disk sync").what, "no file can be written here: permission denied");
}

TEST_F(Doctor, FindsMissingFonts) {
    take("/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf");
    EXPECT_EQ(problem("fonts").command, "sudo apt install fonts-dejavu-core");
}

TEST_F(Doctor, FindsAClockThatIsWrongByYears) {
    machine.now_s = 0;
    EXPECT_EQ(problem("clock").command, "sudo timedatectl set-ntp true");
    machine.now_s = 5'000'000'000;
    problem("clock");
}

TEST_F(Doctor, AnswersInJson) {
    machine.now_s = 0;
    const Json json = doctor_json(examine(machine));
    EXPECT_EQ(json["schema"], "gyrolog-doctor/1");
    EXPECT_EQ(json["ok"], false);
    EXPECT_EQ(json["checks"][0]["name"], "USB");
    EXPECT_EQ(json["checks"][0]["ok"], true);
    EXPECT_FALSE(json["checks"][0].contains("command"));
    EXPECT_EQ(json["checks"].back()["command"], "sudo timedatectl set-ntp true");
}

TEST(ThisMachine, SyncsAFileAndLeavesNothing) {
    const TemporaryFolder folder;
    Machine machine = this_machine();
    const auto sync_s = machine.sync_s(folder.path(""));
    ASSERT_TRUE(sync_s.ok()) << sync_s.error().message;
    EXPECT_GT(*sync_s, 0.0);
    EXPECT_TRUE(fs::is_empty(folder.path("")));
    EXPECT_FALSE(machine.sync_s(folder.path("none")).ok());
    EXPECT_TRUE(machine.free_bytes(folder.path("")).ok());
}

}  // namespace
}  // namespace gyrolog
