// Equations with a symmetric, positive definite matrix C = L L' whose rows reach back over few columns (A.
// George, J. W.-H. Liu, Computer Solution of Large Sparse Positive Definite Systems, 1981, chapter 4:
// envelope method).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gyrolog {

class EnvelopeCholesky {
public:
    // `least_pivot`: the least that C can have. A pivot that rounding puts below it is raised to it.
    explicit EnvelopeCholesky(double least_pivot) : least_pivot_(least_pivot) {}

    // Appends row i of C: the entries of the columns i + 1 - row.size() ... i. Where rows repeat, as those of
    // a Toeplitz matrix, and L no longer changes from row to row, a row costs neither time nor memory.
    void add_row(std::span<const double> row);

    std::size_t size() const { return rows_.size(); }
    std::size_t distinct_rows() const { return distinct_rows_.size(); }
    // In the distinct rows of L.
    std::size_t numbers() const;
    // The solution x of L x = right.
    std::vector<double> solve_lower(std::vector<double> right) const;
    // The solution x of L' x = right. Of independent standard normal numbers it has the covariance C^-1.
    std::vector<double> solve_transposed(std::vector<double> right) const;
    double diagonal(std::size_t i) const { return row(i).back(); }

private:
    const std::vector<double>& row(std::size_t i) const { return distinct_rows_[rows_[i]]; }
    std::vector<double> next_row(std::span<const double> row) const;

    double least_pivot_;
    std::vector<std::vector<double>> distinct_rows_;  // of L, the diagonal last
    std::vector<std::size_t> rows_;                   // of L, by place among the distinct ones
    std::vector<double> latest_;                      // row of C
    std::size_t settled_rows_ = 0;                    // at the end of L, that are the same
};

}  // namespace gyrolog
