#include "analysis/diagnose/multiscale/joined_passes.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/diagnose/diagnosis.hpp"
#include "analysis/diagnose/selection/cause_probability.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::size_t samples_per_row = 100;

Cause cause(const char* effect, double gain_nats) {
    Cause cause;
    cause.finding.effect = effect;
    cause.finding.gain_nats = gain_nats;
    cause.finding.where.axes = {0};
    return cause;
}

// What a diagnosis says that sees a gap of this size: of p with nothing found, p_left with causes.
Diagnosis pass(Verdict verdict, double gap, const std::vector<Cause>& causes, double p) {
    Diagnosis pass;
    pass.verdict = verdict;
    pass.axes = {0, 1, 2};
    pass.rate_hz = 1000.0;
    pass.duration_s = 10.0;
    pass.samples = 10'000;
    pass.p_none = verdict == Verdict::none || causes.empty() ? p : 1e-12;
    pass.p_left = verdict == Verdict::none || causes.empty() ? 1.0 : p;
    pass.causes = causes;
    pass.corrected = typical_mpu9250();
    pass.gap_before = {gap, 1.0, gap - 0.1, gap + 0.1};
    pass.gap_named = pass.gap_after = pass.gap_before;
    pass.floor_nats = 20.0;
    if (verdict == Verdict::none) { return pass; }
    pass.excess_nats = pass.floor_nats * (gap * gap - 1.0);
    if (verdict == Verdict::unexplained) { pass.left = {{Place{}, gap}}; }
    pass.where.structure = "gap of " + std::to_string(static_cast<int>(gap));
    if (causes.empty()) { return pass; }
    pass.shrink = {0.9, 0.8, 0.95};
    pass.shrink_modelled = 0.9;
    pass.gap_named.value = pass.gap_after.value = std::sqrt(1.0 + 0.1 * (gap * gap - 1.0));
    for (Cause& one : pass.causes) { one.share = {0.9, 0.8, 0.95}; }
    return pass;
}

Diagnosis joined(const Diagnosis& beginning, const Diagnosis& means) {
    return joined_passes(typical_mpu9250(), beginning, means, samples_per_row);
}

// Whatever the passes say.
void expect_consistent(const Diagnosis& whole) {
    EXPECT_EQ(whole.verdict == Verdict::none, whole.causes.empty() &&
                                                  whole.gap_named.value == whole.gap_before.value &&
                                                  whole.where.structure.empty());
    const double before = whole.gap_before.value;
    EXPECT_NEAR(whole.gap_named.value, std::sqrt(1.0 + (1.0 - whole.shrink.value) * (before * before - 1.0)),
                1e-9);
    EXPECT_TRUE(std::ranges::is_sorted(whole.causes, std::ranges::greater{},
                                       [](const Cause& one) { return one.share.value; }));
    // Those of either pass close nine tenths of what the pass has of the whole.
    double shares = 0.0;
    for (const Cause& one : whole.causes) { shares += one.share.value; }
    EXPECT_NEAR(shares, whole.shrink.value, 1e-12);
    EXPECT_EQ(whole.corrected.effects.size(), 0U) << "these findings have no entries";
    EXPECT_EQ(whole.samples, 1'000'000U);
    EXPECT_THAT(whole.passes, SizeIs(2));
}

TEST(JoinedPasses, SayWhatTheOneSaysThatExplainsLeast) {
    const std::vector<Cause> fast{cause("spikes", 300.0)};
    const std::vector<Cause> slow{cause("rate_ramp", 100.0)};
    const Diagnosis beginnings[] = {pass(Verdict::none, 1.0, {}, 0.4), pass(Verdict::known, 5.0, fast, 0.3),
                                    pass(Verdict::unexplained, 4.0, {}, 1e-5),
                                    pass(Verdict::unexplained, 4.0, fast, 1e-4)};
    const Diagnosis means[] = {pass(Verdict::none, 1.0, {}, 0.2), pass(Verdict::known, 3.0, slow, 0.6),
                               pass(Verdict::unexplained, 2.0, {}, 1e-7),
                               pass(Verdict::unexplained, 2.0, slow, 1e-6)};
    for (const Diagnosis& a : beginnings) {
        for (const Diagnosis& b : means) {
            const Diagnosis whole = joined(a, b);
            expect_consistent(whole);
            EXPECT_EQ(whole.verdict, std::max(a.verdict, b.verdict));
            EXPECT_EQ(whole.causes.size(), a.causes.size() + b.causes.size());
            EXPECT_NEAR(whole.p_none, 2.0 * std::min(a.p_none, b.p_none),
                        std::pow(std::min(a.p_none, b.p_none), 2) + 1e-15);
            if (whole.verdict != Verdict::unexplained) { continue; }
            // With its place, and as rare as the rarer of both passes has it.
            EXPECT_LT(whole.p_left, 1e-3);
            EXPECT_FALSE(whole.left.empty());
            EXPECT_FALSE(whole.where.structure.empty());
        }
    }
}

// Surprisals add up.
TEST(JoinedPasses, CloseAsMuchAsTheirPartsOfTheGapHave) {
    Diagnosis beginning = pass(Verdict::known, 5.0, {cause("spikes", 300.0)}, 0.3);
    beginning.shrink.value = 0.98;
    const Diagnosis whole = joined(beginning, pass(Verdict::known, 3.0, {cause("rate_ramp", 100.0)}, 0.6));
    EXPECT_NEAR(whole.shrink.value, 0.75 * 0.98 + 0.25 * 0.9, 1e-12);  // 24 to 8
    EXPECT_NEAR(whole.gap_before.value, std::sqrt(0.5 * (25.0 + 9.0)), 1e-12);
    EXPECT_EQ(whole.causes.front().finding.effect, "spikes");
    EXPECT_NEAR(whole.causes.front().share.value, 0.75 * 0.9, 1e-12);
}

TEST(JoinedPasses, TellOfASecondRecordingWhatWasMeasuredThere) {
    const Diagnosis means = pass(Verdict::known, 3.0, {cause("rate_ramp", 100.0)}, 0.6);
    Diagnosis beginning = pass(Verdict::known, 2.0, {cause("spikes", 300.0)}, 0.3);
    beginning.held_out = "second.csv";
    const Diagnosis whole = joined(beginning, means);
    EXPECT_EQ(whole.held_out, "second.csv");
    EXPECT_EQ(whole.gap_before.value, 2.0);
    EXPECT_EQ(whole.gap_named.value, beginning.gap_named.value);
    Diagnosis both = means;
    both.held_out = "second.csv";
    EXPECT_EQ(joined(beginning, both).gap_before.value, 3.0);
}

TEST(JoinedPasses, HaveSlowNoiseAsTheMeansDo) {
    const NoiseCoefficients stated = typical_mpu9250().axes[0].noise;
    Diagnosis beginning = pass(Verdict::known, 5.0, {cause("spikes", 300.0)}, 0.3);
    beginning.noise_refits = {
        {0, 'N', 1.0, 0.7, 0.01}, {0, 'B', stated.B_rad_per_s, 0.5, 0.1}, {1, 'K', 2.0, 0.4, 0.1}};
    Diagnosis means = pass(Verdict::known, 3.0, {cause("rate_ramp", 100.0)}, 0.6);
    means.noise_refits = {{0, 'N', 3.0, 2.0, 0.1}, {0, 'B', 0.5, 0.2, 0.05}};
    const Diagnosis whole = joined(beginning, means);
    ASSERT_THAT(whole.noise_refits, SizeIs(3));
    EXPECT_EQ(whole.corrected.axes[0].noise.N_rad_per_sqrt_s, 0.7);
    EXPECT_EQ(whole.corrected.axes[0].noise.B_rad_per_s, 0.2);
    EXPECT_EQ(whole.corrected.axes[1].noise.K_rad_per_s_sqrt_s, 0.4);
    // Instead of what the user's model says, not of what the means were held against.
    EXPECT_EQ(whole.noise_refits[1].stated, stated.B_rad_per_s);
}

// What one pass alone can test is tested; a cause that is told no more is not held out either.
TEST(JoinedPasses, TellOfWhatIsNotHeldOutAndOfWhatCannotBeTested) {
    Diagnosis beginning = pass(Verdict::known, 3.0, {cause("arw_scale", 200.0)}, 0.5);
    beginning.untestable = {{"temp_linear", "no temperature"}};
    beginning.not_held_out = {"arw_scale", "tone"};
    beginning.warnings = {"of both", "of the beginning"};
    Diagnosis means = pass(Verdict::known, 4.0, {cause("gauss_markov", 300.0)}, 0.5);
    means.untestable = {{"temp_linear", "no temperature"}, {"heavy_tail", "means"}};
    means.not_held_out = {"gauss_markov"};
    means.warnings = {"of both"};
    const Diagnosis whole = joined(beginning, means);
    EXPECT_THAT(whole.not_held_out, ElementsAre("arw_scale", "gauss_markov"));
    ASSERT_THAT(whole.untestable, SizeIs(1));
    EXPECT_EQ(whole.untestable.front().effect, "temp_linear");
    EXPECT_THAT(whole.warnings, ElementsAre("of both", "of the beginning"));
}

TEST(RemoveCauses, TakesWhatWasSaidOfThemAlong) {
    Diagnosis pass = joined_passes(typical_mpu9250(), Diagnosis{}, Diagnosis{}, samples_per_row);
    pass.causes = {cause("tone", 10.0), cause("rate_ramp", 5.0), cause("tone", 3.0)};
    pass.next_recordings = {telling_apart("tone") + "rtn: ...", telling_apart("rate_ramp") + "warmup: ...",
                            "other"};
    pass.better_shape = BetterShape{"A course", {"rate_ramp"}, 9.0};
    const Diagnosis before = pass;
    remove_causes(pass, {&pass.causes[0]});
    EXPECT_THAT(pass.causes, SizeIs(2));
    EXPECT_EQ(pass.next_recordings, before.next_recordings);
    EXPECT_TRUE(pass.better_shape);
    remove_causes(pass, {&pass.causes[0], &pass.causes[1]});
    EXPECT_THAT(pass.causes, IsEmpty());
    EXPECT_THAT(pass.next_recordings, ElementsAre("other"));
    EXPECT_FALSE(pass.better_shape);
}

}  // namespace
}  // namespace gyrolog
