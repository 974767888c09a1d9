#include "host/formats/noise_text.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "host/formats/noise_unit.hpp"
#include "host/formats/uncertain_number.hpp"

namespace gyrolog {
namespace {

using State = FittedCoefficient::State;

constexpr double min_per_h = 60.0;  // the root of 3600 s/h

// What a sensor's coefficients are called, and their units of the trade and of SI. A factor of 0: counts.
struct Trade {
    const char* N;
    const char* K;
    const char* R;
    const char* N_unit;
    double N_factor;
    const char* B_unit;  // null: none of its own
    double B_factor;
    const char* si;  // null: the rows above are in SI already
    double si_factor;
};

Trade trade_of(const SensorUnit& unit) {
    const bool counts = unit.is_counts();
    if (unit.sensor == SensorKind::accelerometer) {
        return {"N  velocity random walk",
                "K  accel. random walk",
                "R  accel. ramp",
                "m/s/sqrt(h)",
                counts ? 0.0 : min_per_h,
                nullptr,
                0.0,
                "m/s^2",
                counts ? 0.0 : 1.0};
    }
    const double degrees = counts ? 0.0 : unit.name == "rad/s" ? deg_per_rad : unit.per_column_unit;
    const bool is_si = unit.name == "rad/s";
    return {"N  angle random walk", "K  rate random walk",     "R  rate ramp",
            "deg/sqrt(h)",          degrees * min_per_h,       "deg/h",
            degrees * s_per_h,      is_si ? nullptr : "rad/s", degrees * rad_per_deg};
}

using Cell = std::function<std::string(const FitOfColumn&)>;

TextRow row_of(std::span<const FitOfColumn> columns, std::string label, std::string unit, const Cell& cell) {
    TextRow row{std::move(label), with_root_signs(std::move(unit)), {}};
    for (const FitOfColumn& column : columns) { row.cells.push_back(cell(column)); }
    return row;
}

// A row where any column has a bound.
void add_bound_row(std::vector<TextRow>& rows, std::span<const FitOfColumn> columns, NoiseTerm term,
                   double scale) {
    const bool any =
        std::ranges::any_of(columns, [&](const FitOfColumn& c) { return (*c.fit)[term].bound > 0.0; });
    if (!any) { return; }
    rows.push_back(row_of(columns, "   (at best)", "", [=](const FitOfColumn& column) {
        const FittedCoefficient& fitted = (*column.fit)[term];
        return fitted.state == State::identified && fitted.bound > 0.0
                   ? fmt::format("{:.2g}", fitted.bound * scale)
                   : std::string("-");
    }));
}

// The i-th of the terms that a column may or may not have.
template <typename Terms, typename Text>
void add_optional_rows(std::vector<TextRow>& rows, std::span<const FitOfColumn> columns, const char* label,
                       const std::string& unit, Terms terms, Text text) {
    std::size_t most = 0;
    for (const FitOfColumn& column : columns) { most = std::max(most, terms(column).size()); }
    for (std::size_t i = 0; i < most; ++i) {
        rows.push_back(row_of(columns, label, unit, [&](const FitOfColumn& column) {
            return i < terms(column).size() ? text(terms(column)[i]) : std::string("-");
        }));
    }
}

}  // namespace

std::string coefficient_text(const FittedCoefficient& fitted, double scale, UncertaintyForm form) {
    if (fitted.state == State::not_identifiable) { return "< " + in_digits(fitted.upper * scale, 2); }
    return form(fitted.value * scale, fitted.sd * scale);
}

std::vector<TextRow> shaped_rows(std::span<const FitOfColumn> columns, const SensorUnit& unit,
                                 UncertaintyForm form) {
    std::vector<TextRow> rows;
    const double scale = unit.per_column_unit;
    const auto processes = [](const FitOfColumn& c) -> const auto& { return c.fit->gauss_markov; };
    const auto lines = [](const FitOfColumn& c) -> const auto& { return c.fit->sinusoids; };
    add_optional_rows(rows, columns, "Gauss-Markov sigma", unit.name, processes,
                      [&](const FittedGaussMarkov& g) {
                          return form(g.value.sigma_rad_per_s * scale, g.sigma_sd * scale);
                      });
    add_optional_rows(rows, columns, "   correlation time", "s", processes, [=](const FittedGaussMarkov& g) {
        return form(g.value.correlation_s, g.correlation_sd_s);
    });
    add_optional_rows(rows, columns, "sinusoid amplitude", unit.name, lines, [&](const FittedSinusoid& s) {
        return form(s.value.amplitude_rad_per_s * scale, s.amplitude_sd * scale);
    });
    add_optional_rows(rows, columns, "   frequency", "Hz", lines,
                      [=](const FittedSinusoid& s) { return form(s.value.frequency_hz, s.frequency_sd_hz); });
    return rows;
}

std::vector<TextRow> slope_rows(std::span<const FitOfColumn> columns, const SensorUnit& unit) {
    const double scale = unit.per_column_unit;
    std::vector<TextRow> rows;
    const auto add_slope = [&](const char* label, NoiseTerm term, auto member) {
        if (std::ranges::none_of(columns,
                                 [=](const FitOfColumn& c) { return (c.slopes->*member).has_value(); })) {
            return;
        }
        const auto number = [=](double SlopeReading::Value::*part, double by) {
            return [=](const FitOfColumn& column) {
                const std::optional<SlopeReading::Value>& value = column.slopes->*member;
                return value ? fmt::format("{:.3g}", (*value).*part * by) : std::string("-");
            };
        };
        rows.push_back(
            row_of(columns, label, noise_unit(term, unit), number(&SlopeReading::Value::coefficient, scale)));
        rows.push_back(row_of(columns, "   at tau", "s", number(&SlopeReading::Value::tau_s, 1.0)));
    };
    add_slope("N  by slope", NoiseTerm::N, &SlopeReading::N);
    add_slope("B  by slope", NoiseTerm::B, &SlopeReading::B);
    add_slope("K  by slope", NoiseTerm::K, &SlopeReading::K);
    return rows;
}

std::vector<TextRow> noise_rows(std::span<const FitOfColumn> columns, const SensorUnit& unit) {
    const double scale = unit.per_column_unit;
    const Trade trade = trade_of(unit);
    std::vector<TextRow> rows;
    const auto add = [&](const char* label, const std::string& unit_name, NoiseTerm term, double by) {
        rows.push_back(row_of(columns, label, unit_name, [=](const FitOfColumn& column) {
            return coefficient_text((*column.fit)[term], by, &in_short_form);
        }));
    };
    add(trade.N, noise_unit(NoiseTerm::N, unit), NoiseTerm::N, scale);
    add_bound_row(rows, columns, NoiseTerm::N, scale);
    if (trade.N_factor > 0.0) { add("", trade.N_unit, NoiseTerm::N, trade.N_factor); }
    add("B  bias instability", unit.name, NoiseTerm::B, scale);
    add_bound_row(rows, columns, NoiseTerm::B, scale);
    if (trade.B_factor > 0.0) { add("", trade.B_unit, NoiseTerm::B, trade.B_factor); }
    add(trade.K, noise_unit(NoiseTerm::K, unit), NoiseTerm::K, scale);
    add_bound_row(rows, columns, NoiseTerm::K, scale);
    add("Q  quantisation", noise_unit(NoiseTerm::Q, unit), NoiseTerm::Q, scale);
    add(trade.R, noise_unit(NoiseTerm::R, unit), NoiseTerm::R, scale);
    for (TextRow& row : shaped_rows(columns, unit, &in_short_form)) { rows.push_back(std::move(row)); }
    for (TextRow& row : slope_rows(columns, unit)) { rows.push_back(std::move(row)); }
    return rows;
}

std::vector<TextRow> si_rows(std::span<const FitOfColumn> columns, const SensorUnit& unit) {
    std::vector<TextRow> rows;
    const Trade trade = trade_of(unit);
    if (trade.si == nullptr || !(trade.si_factor > 0.0)) { return rows; }
    const double scale = trade.si_factor;
    const SensorUnit si{trade.si, 1.0, unit.sensor};
    const auto add = [&](const char* label, NoiseTerm term) {
        rows.push_back(row_of(columns, label, noise_unit(term, si), [=](const FitOfColumn& column) {
            const FittedCoefficient& fitted = (*column.fit)[term];
            const bool known = fitted.state == State::identified;
            return fmt::format("{}{:.4g}", known ? "" : "< ", (known ? fitted.value : fitted.upper) * scale);
        }));
    };
    add("N", NoiseTerm::N);
    add("B", NoiseTerm::B);
    add("K", NoiseTerm::K);
    return rows;
}

std::string term_text(const CurveTerm& term, const SensorUnit& unit) {
    const double size = term.size * unit.per_column_unit;
    switch (term.kind) {
        case CurveTerm::Kind::gauss_markov:
            return fmt::format("Gauss-Markov {:.3g} {}, T {}", size, unit.name, duration_text(term.shape));
        case CurveTerm::Kind::sinusoid:
            return fmt::format("sinusoid {:.3g} {}, period {}", size, unit.name,
                               duration_text(1.0 / term.shape));
        default:
            return fmt::format("{} {:.3g} {}", name_of(term.kind), size,
                               noise_unit(static_cast<NoiseTerm>(term.kind), unit));
    }
}

}  // namespace gyrolog
