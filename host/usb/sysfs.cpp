#include "host/usb/sysfs.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace gyrolog {

Bytes read_sysfs_bytes(const std::string& directory, const char* name) {
    std::ifstream file(directory + "/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string read_sysfs_text(const std::string& directory, const char* name) {
    const Bytes bytes = read_sysfs_bytes(directory, name);
    std::string text(as_text(bytes));
    text.erase(text.find_last_not_of(" \n") + 1);
    return text;
}

unsigned long read_sysfs_number(const std::string& directory, const char* name, int base) {
    return std::strtoul(read_sysfs_text(directory, name).c_str(), nullptr, base);
}

Result<UsbDescriptors> read_usb_descriptors(const std::string& directory) {
    const Bytes all = read_sysfs_bytes(directory, "descriptors");
    const auto active = static_cast<std::uint8_t>(read_sysfs_number(directory, "bConfigurationValue", 10));
    if (active == 0) {
        return Error{ErrorCode::unsupported,
                     "the kernel has not configured the device (is there power for it?)"};
    }
    GYROLOG_TRY(const ByteView configuration, find_configuration(all, active));
    UsbDescriptors descriptors;
    descriptors.device.assign(all.begin(), all.begin() + device_descriptor_bytes);
    descriptors.configuration.assign(configuration.begin(), configuration.end());
    GYROLOG_TRY(descriptors.layout, parse_cdc_configuration(configuration));
    return descriptors;
}

}  // namespace gyrolog
