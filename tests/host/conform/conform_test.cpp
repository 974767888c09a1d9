#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <gyrolog_protocol/usb_identity.h>

#include <nlohmann/json.hpp>

#include "host/conform/conformance.hpp"
#include "host/conform/conversation.hpp"
#include "host/formats/conform_report.hpp"
#include "host/session/open_source.hpp"
#include "host/virtual_board/breached_source.hpp"

namespace gyrolog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

Result<Dialogue> talk_to(const std::string& uri) {
    GYROLOG_TRY(const OpenedSource opened, open_source(uri, {}, false));
    return converse(*opened.source, [] { return true; });
}

std::vector<std::string> rules_that(const ConformanceReport& report, JudgementState state) {
    std::vector<std::string> numbers;
    for (const RuleVerdict& one : report.verdicts) {
        if (one.verdict.state == state) { numbers.emplace_back(one.rule->number); }
    }
    return numbers;
}

// What a breach's board is found to break, and for a failure what was said of it.
struct Judged {
    std::vector<std::string> failed;
    std::string text;
};

Judged judged(const Breach& breach) {
    const auto dialogue = talk_to(std::string("sim:breach=") + breach.name);
    if (!dialogue.ok()) { return {{}, dialogue.error().message}; }
    const ConformanceReport report = judge(*dialogue);
    return {rules_that(report, JudgementState::fail), conform_text(report)};
}

TEST(Conform, TheHonestBoardBreaksNoRule) {
    const auto dialogue = talk_to("sim:");
    ASSERT_TRUE(dialogue.ok()) << dialogue.error().message;
    const ConformanceReport report = judge(*dialogue);
    EXPECT_THAT(rules_that(report, JudgementState::fail), ElementsAre()) << conform_text(report);
    EXPECT_TRUE(report.conforms());
    // What it does not show when all is well.
    EXPECT_THAT(rules_that(report, JudgementState::not_tested),
                ElementsAre("2.2", "8.7", "8.10", "8.11", "8.12"));
}

TEST(Conform, OtherRatesAndTicksAreNoBreach) {
    std::vector<std::future<Result<Dialogue>>> talks;
    talks.reserve(8);
    for (const char* uri :
         {"sim:rate=1000,full_scale=2000,seed=3", "sim:first_tick=4290000000,clock_ppm=9000",
          "sim:first_sequence=4294967200", "sim:rate=8000,dlpf=3600", "sim:rate=32000,dlpf=off",
          "sim:endpoints=fixed_kind", "sim:sensor=mpu9255", "sim:sensor=mpu9250_75"}) {
        talks.push_back(std::async(std::launch::async, [uri] { return talk_to(uri); }));
    }
    for (auto& talk : talks) {
        const auto dialogue = talk.get();
        ASSERT_TRUE(dialogue.ok()) << dialogue.error().message;
        const ConformanceReport report = judge(*dialogue);
        EXPECT_TRUE(report.conforms()) << conform_text(report);
    }
}

// The conversations are mostly pauses, so they are held side by side.
TEST(Conform, EachBrokenBoardIsCaughtByItsOwnRuleAndByNoOther) {
    constexpr unsigned talkers = 12;
    const auto all = breaches();
    ASSERT_GE(all.size(), 24U);
    std::vector<Judged> found(all.size());
    std::atomic<std::size_t> next = 0;
    std::vector<std::thread> threads;
    threads.reserve(talkers);
    for (unsigned i = 0; i < talkers; ++i) {
        threads.emplace_back([&] {
            for (std::size_t one = next++; one < all.size(); one = next++) { found[one] = judged(all[one]); }
        });
    }
    for (std::thread& thread : threads) { thread.join(); }
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_THAT(found[i].failed, ElementsAre(all[i].rule)) << all[i].name << ": " << all[i].what << '\n'
                                                               << found[i].text;
    }
}

// Of each known sensor the registers are looked at, not only of the one that says 71.
TEST(Conform, RegistersOfEveryKnownSensorAreHeldAgainstTheFields) {
    const Breach* breach = breach_named("register");
    ASSERT_NE(breach, nullptr);
    for (const char* sensor : {"mpu9250", "mpu9255", "mpu9250_75"}) {
        const auto dialogue = talk_to(std::string("sim:breach=register,sensor=") + sensor);
        ASSERT_TRUE(dialogue.ok()) << dialogue.error().message;
        EXPECT_THAT(rules_that(judge(*dialogue), JudgementState::fail), ElementsAre(breach->rule)) << sensor;
    }
}

TEST(Conform, AnIdWithoutTheNameAndANameWithoutTheIdAreNoBoards) {
    auto dialogue = talk_to("sim:");
    ASSERT_TRUE(dialogue.ok()) << dialogue.error().message;
    const auto breaks_10_1 = [&](std::uint16_t vendor_id, std::uint16_t product_id, const char* product) {
        dialogue->identity.vendor_id = vendor_id;
        dialogue->identity.product_id = product_id;
        dialogue->identity.product = product;
        return !judge(*dialogue).conforms();
    };
    EXPECT_FALSE(breaks_10_1(0x1209, 0x6779, "gyrolog"));
    EXPECT_FALSE(breaks_10_1(0x1FC9, 0x0083, "gyrolog")) << "of older firmware";
    EXPECT_TRUE(breaks_10_1(0x1209, 0x6779, "LPC VCOM"));
    EXPECT_TRUE(breaks_10_1(0x1FC9, 0x0083, "LPC VCOM"));
    EXPECT_TRUE(breaks_10_1(0x0483, 0x5740, "gyrolog"));
    EXPECT_TRUE(breaks_10_1(0x1209, 0x0083, "gyrolog"));
}

// A rule that no board breaks may be a check that cannot fail. These four need what no virtual board gives
// from outside (SPEC.md says what): a frame cut off at the end, a host that does not read, a broken sensor, a
// boot.
TEST(Conform, EveryRuleButFourHasABoardThatBreaksIt) {
    std::set<std::string> broken;
    for (const Breach& breach : breaches()) { broken.insert(breach.rule); }
    std::vector<std::string> unbroken;
    for (const auto rules : {frame_rules(), message_rules(), sequence_rules(), device_rules(), usb_rules()}) {
        for (const Rule& rule : rules) {
            if (!broken.contains(rule.number)) { unbroken.emplace_back(rule.number); }
        }
    }
    EXPECT_THAT(unbroken, UnorderedElementsAre("1.2", "8.7", "8.11", "8.12"));
}

TEST(Conform, AFailureSaysWhatWasExpectedWhatCameAndItsBytes) {
    const auto dialogue = talk_to("sim:breach=scale");
    ASSERT_TRUE(dialogue.ok());
    const ConformanceReport report = judge(*dialogue);
    const nlohmann::ordered_json json = conform_json(report);
    EXPECT_EQ(json["schema"], "gyrolog-conform/1");
    EXPECT_EQ(json["conforms"], false);
    EXPECT_EQ(json["failed"], 1);
    for (const auto& rule : json["rules"]) {
        if (rule["verdict"] != "fail") { continue; }
        EXPECT_EQ(rule["rule"], "4.5");
        EXPECT_EQ(rule["expected"], "a count of about 500 / 32768 °/s");
        EXPECT_EQ(rule["came"], "30534352 n°/s");
        // A CONFIG's COBS form: no 00 in it, and the scale at its place.
        EXPECT_THAT(rule["bytes"].get<std::string>(), HasSubstr("d0ead101"));
        EXPECT_GT(rule["times"], 5);
    }
    EXPECT_THAT(conform_text(report), HasSubstr("rules pass, 1 fail (4.5), "));
    EXPECT_THAT(conform_text(report), HasSubstr("came:     30534352 n°/s"));
    EXPECT_THAT(transcript_text(*dialogue), HasSubstr("DTR rises"));
}

// ------------------------------------------------------------------------------------ devices that are none

// Sends what `speak` gives, over and over, whatever the host says.
class Stranger final : public ByteSource {
public:
    explicit Stranger(std::function<Bytes()> speak) : speak_(std::move(speak)) {
        identity_.uri = "test:stranger";
    }
    ~Stranger() override { Stranger::stop(); }

    const SourceIdentity& identity() const override { return identity_; }
    bool can_wait() const override { return false; }
    double tolerated_stall_s(double /*bytes_per_s*/, double /*bytes_per_completion*/) const override {
        return 1.0;
    }
    Status start(TransferSink& sink) override {
        thread_ = std::thread([this, &sink] {
            while (!stopped_) {
                const Bytes bytes = speak_();
                Transfer transfer;
                transfer.endpoint = line_endpoint_in;
                transfer.time = host_now();
                transfer.data = bytes;
                sink.on_transfer(transfer);
                std::this_thread::sleep_for(std::chrono::microseconds(100));
            }
            sink.on_end(SourceEnd::stopped, std::nullopt);
        });
        return {};
    }
    Status set_line_state(bool /*data_terminal_ready*/) override { return {}; }
    Status write(ByteView /*bytes*/) override { return {}; }
    void stop() override {
        stopped_ = true;
        if (thread_.joinable()) { thread_.join(); }
    }

private:
    std::function<Bytes()> speak_;
    SourceIdentity identity_;
    std::atomic<bool> stopped_{false};
    std::thread thread_;
};

Bytes noise(std::size_t size) {
    thread_local std::uint64_t state = 1;
    Bytes bytes(size);
    for (std::uint8_t& byte : bytes) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        byte = static_cast<std::uint8_t>(state >> 56U);
    }
    return bytes;
}

// Three that answer nothing; the conversations are held side by side.
TEST(ConformHostile, StrangersAreJudgedInBoundedMemoryAndTime) {
    Stranger silent([] { return Bytes{}; });
    Stranger noisy([] { return noise(4096); });
    Stranger steady([] { return Bytes(4096, 0x41); });  // not one delimiter
    const auto begin = std::chrono::steady_clock::now();
    const auto talk = [](Stranger& stranger) {
        return std::async(std::launch::async, [&] { return converse(stranger, [] { return true; }); });
    };
    auto silence = talk(silent);
    auto noises = talk(noisy);
    auto steadiness = talk(steady);

    const auto unsaid = silence.get();
    ASSERT_FALSE(unsaid.ok());
    EXPECT_EQ(unsaid.error().code, ErrorCode::timeout);
    EXPECT_EQ(unsaid.error().message, "test:stranger: nothing came, whatever was asked");

    const auto noised = noises.get();
    ASSERT_TRUE(noised.ok()) << noised.error().message;
    EXPECT_LE(noised->entries().size(), Transcript::entries_max);
    EXPECT_LE(noised->transcript.kept_bytes(), Transcript::bytes_max + TranscriptEntry::bytes_kept);
    const ConformanceReport report = judge(*noised);
    EXPECT_NE(report.broken_off, "");
    EXPECT_THAT(rules_that(report, JudgementState::fail), testing::Contains("2.1"));

    const auto endless = steadiness.get();
    ASSERT_TRUE(endless.ok()) << endless.error().message;
    EXPECT_LE(endless->transcript.unended().size(), TranscriptEntry::bytes_kept);
    EXPECT_FALSE(judge(*endless).conforms());
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

// Intact frames whose payloads are anything: bytes turned round, cut short, made longer. REPLY is left alone,
// so that the conversation goes on.
void spoils_payloads(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_reply) {
        line.send(frame);
        return;
    }
    if (!frame.payload.empty()) { line.noted += frame.payload.back(); }
    line.noted = line.noted * 6364136223846793005U + 1442695040888963407U;
    const std::uint64_t dice = line.noted >> 32U;
    const std::size_t size = frame.payload.size();
    if (dice % 4 == 0 && size > 0) {
        frame.payload[(dice >> 8U) % size] ^= static_cast<std::uint8_t>(dice >> 20U);
    }
    if (dice % 16 == 1) { frame.payload.resize((dice >> 8U) % (size + 1)); }
    if (dice % 16 == 2) {
        frame.payload.resize(std::min<std::size_t>(GLP_FRAME_PAYLOAD_MAX, size + (dice >> 8U) % 64));
    }
    if (dice % 32 == 3) { frame.type = static_cast<std::uint8_t>(dice >> 8U); }
    line.send(frame);
}

TEST(ConformHostile, PayloadsOfAnyKindAreJudgedAndNothingElseHappens) {
    const Breach breach{"", "", "", spoils_payloads, nullptr, nullptr};
    std::vector<std::future<void>> talks;
    talks.reserve(8);
    for (unsigned seed = 1; seed <= 8; ++seed) {
        talks.push_back(std::async(std::launch::async, [&breach, seed] {
            auto opened = open_source("sim:seed=" + std::to_string(seed), {}, false);
            ASSERT_TRUE(opened.ok());
            BreachedSource source(std::move(opened->source), breach);
            const auto dialogue = converse(source, [] { return true; });
            ASSERT_TRUE(dialogue.ok()) << dialogue.error().message;
            const ConformanceReport report = judge(*dialogue);
            EXPECT_FALSE(report.conforms());
            EXPECT_NE(conform_json(report).dump(), "");
            EXPECT_NE(transcript_text(*dialogue), "");
        }));
    }
    for (auto& talk : talks) { talk.get(); }
}

TEST(ConformHostile, ABoardThatIsUnpluggedIsCalledLost) {
    const auto dialogue = talk_to("sim:unplug=3");
    ASSERT_FALSE(dialogue.ok());
    EXPECT_EQ(dialogue.error().code, ErrorCode::device_lost);
}

}  // namespace
}  // namespace gyrolog
