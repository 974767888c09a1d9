#include "host/capture/recover.hpp"

#include <filesystem>

#include "host/base/program_name.hpp"
#include "host/base/replacing_file.hpp"
#include "host/capture/capture_metadata.hpp"
#include "host/capture/pcapng.hpp"
#include "host/capture/usbmon_record.hpp"

namespace gyrolog {

Result<RecoveryReport> recover_capture(std::unique_ptr<InputFile> damaged, const ByteWriter& write) {
    constexpr std::size_t batch_bytes = std::size_t{1} << 20U;
    RecoveryReport report;
    BlockScanner scanner(std::move(damaged));
    Bytes batch;
    bool section = false;
    bool interface = false;
    while (true) {
        GYROLOG_TRY(const std::optional<CaptureBlock> block, scanner.next());
        if (!block || batch.size() >= batch_bytes) {
            GYROLOG_CHECK(write(batch));
            report.bytes_kept += batch.size();
            batch.clear();
        }
        if (!block) { break; }
        if (block->kind == BlockKind::section) {
            section = true;
            interface = false;
        } else if (!section) {
            pcapng::append_section_header(batch, metadata_json({program_name(), {}, {}, {}}), program_name());
            section = true;
            report.header_rewritten = true;
        }
        if (block->kind == BlockKind::interface_description) { interface = true; }
        // Only an own section's packets are intact without the description of their interface.
        if (!interface && scanner.in_own_section() && block->kind != BlockKind::section) {
            pcapng::append_interface(batch, link_type_usb_linux_mmapped, "");
            interface = true;
        }
        batch.insert(batch.end(), block->bytes.begin(), block->bytes.end());
    }
    report.source = scanner.accounts();
    return report;
}

Result<RecoveryReport> recover_capture(const std::string& damaged_path, const std::string& recovered_path) {
    const std::string writing = "write '" + recovered_path + "'";
    std::error_code unknown;
    if (std::filesystem::is_regular_file(recovered_path, unknown)) {
        return invalid_argument(writing + ": it exists; choose another name");
    }
    GYROLOG_TRY(std::unique_ptr<InputFile> damaged, open_input_file(damaged_path));
    auto recovered = ReplacingFile::create(recovered_path);
    if (!recovered.ok()) { return in_context(writing, std::move(recovered).error()); }
    Status written;
    auto report = recover_capture(std::move(damaged), [&](ByteView bytes) {
        written = recovered->write(bytes);
        return written;
    });
    if (!written.ok()) { return in_context(writing, std::move(written).error()); }
    if (!report.ok()) { return in_context("recover '" + damaged_path + "'", std::move(report).error()); }
    if (report->bytes_kept == 0) {
        return malformed("recover '" + damaged_path + "': it holds no intact block of a capture");
    }
    if (Status kept = recovered->commit(); !kept.ok()) {
        return in_context(writing, std::move(kept).error());
    }
    return report;
}

}  // namespace gyrolog
