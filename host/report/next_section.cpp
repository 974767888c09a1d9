#include "host/report/next_recording.hpp"
#include "host/report/sections.hpp"

namespace gyrolog {

Html next_section(const ReportPage& page) {
    Html section = element("h2", Html::text("What to record next"));
    const std::vector<std::string> sentences = next_recordings(page.analysis, page.temperature.has_value());
    section += sentences.empty() ? paragraph("Nothing is open about the noise of this sensor at rest.")
                                 : bullet_list(sentences);
    if (page.diagnosis != nullptr && !page.diagnosis->next_recordings.empty()) {
        section += element("h3", Html::text("What would tell more about the model")) +
                   bullet_list(page.diagnosis->next_recordings);
    }
    return section;
}

}  // namespace gyrolog
