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

}  // namespace gyrolog
