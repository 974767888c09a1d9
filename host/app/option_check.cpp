#include "host/app/option_check.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "host/app/quantity.hpp"
#include "host/base/result.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view offered_name = "offered: ";

std::optional<double> number_in(const std::string& text) {
    const char* const end = text.data() + text.size();
    double number = 0.0;
    const auto [stop, problem] = std::from_chars(text.data(), end, number);
    if (problem != std::errc() || stop != end) { return std::nullopt; }
    return number;
}

CLI::Validator number_where(bool (*holds)(double, double, double), double lowest, double highest,
                            const std::string& demand) {
    return {[=](const std::string& text) -> std::string {
                const auto number = number_in(text);
                if (!number) { return fmt::format("'{}' is no number", text); }
                return holds(*number, lowest, highest) ? "" : fmt::format("{} {}", text, demand);
            },
            ""};
}

template <typename Number>
CLI::Validator understood_by(Result<Number> (*parse)(std::string_view)) {
    return {[parse](const std::string& text) -> std::string {
                const auto parsed = parse(text);
                return parsed.ok() ? "" : parsed.error().message;
            },
            ""};
}

// Zero needs no unit.
template <typename Number>
CLI::Validator understood_or_none(Result<Number> (*parse)(std::string_view)) {
    return {[parse](const std::string& text) -> std::string {
                if (text == "0") { return ""; }
                const auto parsed = parse(text);
                return parsed.ok() ? "" : parsed.error().message + ", or 0";
            },
            ""};
}

}  // namespace

CLI::Validator number_from_to(double lowest, double highest, const std::string& unit) {
    return number_where(
        [](double x, double lo, double hi) { return x >= lo && x <= hi; }, lowest, highest,
        fmt::format("must be from {:.10g} to {:.10g}{}{}", lowest, highest, unit.empty() ? "" : " ", unit));
}

CLI::Validator sampling_rate() { return number_from_to(1e-4, 1e7, "Hz"); }

CLI::Validator positive_number() {
    return number_where([](double x, double, double) { return x > 0.0 && std::isfinite(x); }, 0.0, 0.0,
                        "must be a finite number above 0");
}

CLI::Validator whole_number(std::uint64_t lowest, std::uint64_t highest) {
    return {[=](const std::string& text) -> std::string {
                std::uint64_t number = 0;
                const char* const end = text.data() + text.size();
                const auto [read_to, error] = std::from_chars(text.data(), end, number);
                const bool whole = error == std::errc() && read_to == end;
                if (whole && number >= lowest && number <= highest) { return ""; }
                return fmt::format("'{}' is no whole number from {} to {}", text, lowest, highest);
            },
            ""};
}

CLI::Validator duration() { return understood_by(parse_duration_s); }

CLI::Validator size() { return understood_by(parse_bytes); }

CLI::Validator duration_or_none() { return understood_or_none(parse_duration_s); }

CLI::Validator size_or_none() { return understood_or_none(parse_bytes); }

CLI::Validator offered(const std::vector<std::string>& values) {
    return CLI::Validator([](std::string&) { return std::string(); }, "",
                          std::string(offered_name) + CLI::detail::join(values, " "));
}

std::vector<std::string> offered_values(CLI::Option& option) {
    try {
        for (int i = 0;; ++i) {
            const std::string& name = option.get_validator(i)->get_name();
            if (!name.starts_with(offered_name)) { continue; }
            return CLI::detail::split(name.substr(offered_name.size()), ' ');
        }
    } catch (const CLI::OptionNotFound&) {  // that was the last
        return {};
    }
}

}  // namespace gyrolog
