// The published test sets for Allan deviations, through the whole program.
//
// W. J. Riley, NIST SP 1065 (2008), tables 31 and 32: NBS14's 9 frequency values (10 phase points), and the
// 1000-point set of the prime modulus generator.

#include <cmath>
#include <cstdint>
#include <fstream>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;

std::string write_set(const TemporaryFolder& folder, const std::vector<double>& values) {
    const std::string path = folder.path("nbs.csv");
    std::ofstream text(path);
    text.precision(17);
    text << "t_s,gx_dps\n";
    for (std::size_t i = 0; i < values.size(); ++i) { text << i << ',' << values[i] << '\n'; }
    return path;
}

std::vector<double> nine_values() { return {892, 809, 823, 798, 671, 644, 883, 903, 677}; }

std::vector<double> thousand_values() {
    std::vector<double> values;
    std::uint64_t n = 1234567890;
    for (int i = 0; i < 1000; ++i) {
        values.push_back(static_cast<double>(n) / 2147483647.0);
        n = 16807 * n % 2147483647;
    }
    return values;
}

json analyse(const std::vector<double>& values, const std::string& factors, const std::string& deviation,
             const std::string& convention = "sp1065") {
    const TemporaryFolder folder;
    const ProgramResult result =
        run_gyrolog({"analyze", write_set(folder, values), "--m", factors, "--deviation", deviation,
                     "--convention", convention, "--json", "-"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out)["axes"]["x"]["allan"];
}

// To every printed digit: the tables round to `digits` significant ones.
void expect_published(const json& curve, const std::vector<double>& published, int digits) {
    ASSERT_EQ(curve.size(), published.size());
    for (std::size_t i = 0; i < published.size(); ++i) {
        const double last_place = std::pow(10.0, std::floor(std::log10(published[i])) - digits + 1);
        EXPECT_NEAR(curve[i]["value"].get<double>(), published[i], 0.5000001 * last_place)
            << "m = " << curve[i]["m"];
    }
}

TEST(PublishedNumbers, NineValuesGiveTheTablesDeviations) {
    const std::vector<std::pair<std::string, std::vector<double>>> table = {
        {"overlapping", {91.22945, 85.95287}}, {"standard", {91.22945, 115.8082}},
        {"modified", {91.22945, 74.78849}},    {"overlapping_hadamard", {70.80607, 85.61487}},
        {"total", {91.22945, 93.90379}},
    };
    for (const auto& [deviation, values] : table) {
        SCOPED_TRACE(deviation);
        expect_published(analyse(nine_values(), "1,2", deviation), values, 7);
    }
}

TEST(PublishedNumbers, NineValuesGiveTheTablesHadamardDeviation) {
    // 70.80608 is printed for the first, but 70.80607 for the overlapping one, which is the same number.
    expect_published(analyse(nine_values(), "1,2", "hadamard"), {70.80607, 116.7980}, 7);
}

TEST(PublishedNumbers, ThousandValuesGiveTheTablesOverlappingDeviation) {
    const json curve = analyse(thousand_values(), "1,10,100", "overlapping");
    expect_published(curve, {2.922319e-01, 9.159953e-02, 3.241343e-02}, 7);
    EXPECT_EQ(curve[0]["terms"], 999);
    EXPECT_EQ(curve[1]["terms"], 981);
    EXPECT_EQ(curve[2]["terms"], 801);
}

TEST(PublishedNumbers, ThousandValuesGiveTheTablesDeviations) {
    const std::vector<std::pair<std::string, std::vector<double>>> table = {
        {"standard", {2.922319e-01, 9.965736e-02, 3.897804e-02}},
        {"modified", {2.922319e-01, 6.172376e-02, 2.170921e-02}},
        // Printed as 3.910860e-02 at m = 100: to nine digits it is 3.91086056e-02.
        {"hadamard", {2.943883e-01, 1.052754e-01, 3.910861e-02}},
        {"overlapping_hadamard", {2.943883e-01, 9.581083e-02, 3.237638e-02}},
        {"total", {2.922319e-01, 9.134743e-02, 3.406530e-02}},
    };
    for (const auto& [deviation, values] : table) {
        SCOPED_TRACE(deviation);
        expect_published(analyse(thousand_values(), "1,10,100", deviation), values, 7);
    }
}

// sigma^2 = sum over k = 1 ... N - 2m of (theta_{k+2m} - 2 theta_{k+m} + theta_k)^2 / (2 m^2 (N - 2m)), with
// theta = cumsum(x): the first phase point, 0, is left out.
TEST(PublishedNumbers, MatlabConventionFollowsItsOwnFormula) {
    const std::vector<double> values = thousand_values();
    std::vector<long double> theta;
    long double sum = 0;
    for (const double value : values) {
        sum += static_cast<long double>(value);
        theta.push_back(sum);
    }
    const json curve = analyse(values, "1,10,100", "overlapping", "matlab");
    for (const json& point : curve) {
        const auto m = point["m"].get<std::size_t>();
        const std::size_t terms = values.size() - 2 * m;
        long double squares = 0;
        for (std::size_t k = 0; k < terms; ++k) {
            const long double difference = theta[k + 2 * m] - 2 * theta[k + m] + theta[k];
            squares += difference * difference;
        }
        const long double mm = static_cast<long double>(m) * static_cast<long double>(m);
        const auto expected =
            static_cast<double>(std::sqrt(squares / (2 * mm * static_cast<long double>(terms))));
        EXPECT_NEAR(point["value"].get<double>(), expected, 1e-12 * expected);
        EXPECT_EQ(point["terms"], terms);
    }
}

}  // namespace
}  // namespace gyrolog
