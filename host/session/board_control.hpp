// What a capture asks of its board.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "host/session/queueing_sink.hpp"
#include "host/session/writer_thread.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

// What an MPU-9250 can be set to, "off" beside the filters.
inline constexpr std::array<std::uint16_t, 4> mpu9250_full_scales_dps{250, 500, 1000, 2000};
inline constexpr std::array<std::uint16_t, 8> mpu9250_dlpfs_hz{5, 10, 20, 41, 92, 184, 250, 3600};

// The conversation with the board: quiet, configured, started; and stopped again at the end. A line without
// control signals (a pty, a bare UART) is started and stopped by commands instead. A source that takes
// neither (a replayed capture) plays whatever it has.
//
// `go_on` is asked while an answer is waited for; when it says no, the wait ends as if the time were over.
class BoardControl {
public:
    using GoOn = std::function<bool()>;

    BoardControl(ByteSource& source, WriterThread& writer, const QueueingSink& sink)
        : source_(source), writer_(writer), sink_(sink) {}

    Status quiet(const GoOn& go_on);
    Status configure(const glp_configure& wanted, const GoOn& go_on);
    bool has_line() const { return has_line_; }
    Status start(const GoOn& go_on);
    // Quiets a board that was asked to start. Whatever goes wrong here, the capture is over anyway.
    void stop();

    // As the user asks in the middle of a capture. A source that takes neither line nor commands goes on.
    Status set_streaming(bool wanted, const GoOn& go_on);
    bool streaming() const { return streaming_; }

private:
    Status send(glp_frame_type type, ByteView payload);
    Status command(glp_frame_type type, ByteView payload, const GoOn& go_on);
    Status refusal(std::uint8_t result) const;

    ByteSource& source_;
    WriterThread& writer_;
    const QueueingSink& sink_;
    bool has_line_ = true;
    bool takes_commands_ = true;
    bool start_asked_ = false;
    bool streaming_ = true;
    std::uint32_t sequence_ = 0;
    glp_configure wanted_{};  // what was asked for last
};

}  // namespace gyrolog
