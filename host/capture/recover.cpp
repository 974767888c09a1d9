#include "host/capture/recover.hpp"

#include "host/base/program_name.hpp"
#include "host/capture/capture_metadata.hpp"
#include "host/capture/pcapng.hpp"
#include "host/capture/usbmon_record.hpp"

namespace gyrolog {
namespace {

Status write_all(AppendFile& file, ByteView bytes) {
    while (!bytes.empty()) {
        GYROLOG_TRY(const std::size_t taken, file.write(bytes));
        bytes = bytes.subspan(taken);
    }
    return {};
}

}  // namespace

Result<RecoveryReport> recover_capture(std::unique_ptr<InputFile> damaged, AppendFile& recovered) {
    constexpr std::size_t batch_bytes = std::size_t{1} << 20U;
    RecoveryReport report;
    BlockScanner scanner(std::move(damaged));
    Bytes batch;
    bool section = false;
    bool interface = false;
    while (true) {
        GYROLOG_TRY(const std::optional<CaptureBlock> block, scanner.next());
        if (!block || batch.size() >= batch_bytes) {
            GYROLOG_CHECK(write_all(recovered, batch));
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
    GYROLOG_CHECK(recovered.sync());
    GYROLOG_CHECK(recovered.close());
    return report;
}

Result<RecoveryReport> recover_capture(const std::string& damaged_path, const std::string& recovered_path) {
    GYROLOG_TRY(std::unique_ptr<InputFile> damaged, open_input_file(damaged_path));
    GYROLOG_TRY(const std::unique_ptr<AppendFile> recovered,
                create_append_file(recovered_path, IfExists::refuse));
    return recover_capture(std::move(damaged), *recovered);
}

}  // namespace gyrolog
