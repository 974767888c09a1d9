// usb_stream_reader FILE BEFORE TOTAL: reads BEFORE bytes from the only board on the bus, lowers DTR, reads
// on to TOTAL bytes and whatever else comes, and leaves the stream in FILE. The test serves it a capture in
// place of the board.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "host/transport/usb_source.hpp"
#include "tests/host/transport/replayed_session.hpp"
#include "tests/support/collecting_sink.hpp"

namespace gyrolog {
namespace {

Status read_stream(const char* path, std::size_t bytes_before, std::size_t bytes_total) {
    GYROLOG_TRY(std::shared_ptr<UsbContext> usb, UsbContext::create());
    GYROLOG_TRY(const auto source, UsbSource::open(usb, "", test::recording_plan));
    test::CollectingSink sink;
    GYROLOG_CHECK(source->start(sink));
    GYROLOG_CHECK(source->write(test::command_before_the_stream));
    GYROLOG_CHECK(source->set_line_state(true));
    sink.wait_for_bytes(bytes_before);
    GYROLOG_CHECK(source->set_line_state(false));
    sink.wait_for_bytes(bytes_total);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    source->stop();
    const Bytes stream = sink.stream();
    std::ofstream file(path, std::ios::binary);
    file.write(as_text(stream).data(), static_cast<std::streamsize>(stream.size()));
    return {};
}

}  // namespace
}  // namespace gyrolog

int main(int count, char** arguments) {
    if (count != 4) { return 2; }
    const gyrolog::Status read = gyrolog::read_stream(arguments[1], std::strtoul(arguments[2], nullptr, 10),
                                                      std::strtoul(arguments[3], nullptr, 10));
    if (!read.ok()) { static_cast<void>(std::fprintf(stderr, "%s\n", read.error().message.c_str())); }
    return read.ok() ? 0 : 1;
}
