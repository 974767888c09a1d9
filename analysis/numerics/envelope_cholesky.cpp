#include "analysis/numerics/envelope_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/numerics/matrix_products.hpp"

namespace gyrolog::resolution {

// Of the diagonal, by which two rows of L differ that are taken for the same: a million of them change the
// logarithm of the determinant by 0.02.
constexpr double same_row_rel = 1e-8;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() != b.size()) { return false; }
    const double tolerance = resolution::same_row_rel * a.back();
    return std::ranges::equal(a, b, [&](double x, double y) { return std::abs(x - y) <= tolerance; });
}

}  // namespace

std::size_t EnvelopeCholesky::numbers() const {
    std::size_t sum = 0;
    for (const std::vector<double>& row : distinct_rows_) { sum += row.size(); }
    return sum;
}

std::vector<double> EnvelopeCholesky::next_row(std::span<const double> row) const {
    const std::size_t i = size();
    const std::size_t first = i + 1 - row.size();
    std::vector<double> made(row.begin(), row.end());
    for (std::size_t j = first; j <= i; ++j) {
        const std::vector<double>& other = j == i ? made : this->row(j);
        const std::size_t other_first = j + 1 - (j == i ? row.size() : other.size());
        const std::size_t both = std::max(first, other_first);
        const double sum = made[j - first] - dot(std::span(made).subspan(both - first, j - both),
                                                 std::span(other).subspan(both - other_first, j - both));
        made[j - first] = j == i ? std::sqrt(std::max(sum, least_pivot_)) : sum / other.back();
    }
    return made;
}

void EnvelopeCholesky::add_row(std::span<const double> row) {
    const bool repeats = std::ranges::equal(row, latest_);
    if (repeats && settled_rows_ >= row.size()) {
        rows_.push_back(rows_.back());
        return;
    }
    std::vector<double> made = next_row(row);
    settled_rows_ = repeats && are_same(made, this->row(size() - 1)) ? settled_rows_ + 1 : 0;
    latest_.assign(row.begin(), row.end());
    rows_.push_back(distinct_rows_.size());
    distinct_rows_.push_back(std::move(made));
}

std::vector<double> EnvelopeCholesky::solve_lower(std::vector<double> right) const {
    for (std::size_t i = 0; i < size(); ++i) {
        const std::vector<double>& own = row(i);
        const std::size_t first = i + 1 - own.size();
        const std::size_t before = i - first;
        right[i] -= dot(std::span(own).first(before), std::span(right).subspan(first, before));
        right[i] /= own.back();
    }
    return right;
}

std::vector<double> EnvelopeCholesky::solve_transposed(std::vector<double> right) const {
    for (std::size_t i = size(); i-- > 0;) {
        const std::vector<double>& own = row(i);
        const std::size_t first = i + 1 - own.size();
        right[i] /= own.back();
        for (std::size_t j = first; j < i; ++j) { right[j] -= own[j - first] * right[i]; }
    }
    return right;
}

}  // namespace gyrolog
