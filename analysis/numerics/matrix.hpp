// A dense matrix of doubles, column by column, for results and arguments of the functions of linear algebra
// beside it. What uses those compiles without a linear algebra library.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gyrolog {

class Matrix {
public:
    Matrix() = default;
    Matrix(std::size_t rows, std::size_t columns)
        : rows_(rows), columns_(columns), values_(rows * columns, 0.0) {}

    static Matrix identity(std::size_t size) {
        Matrix identity(size, size);
        for (std::size_t i = 0; i < size; ++i) { identity(i, i) = 1.0; }
        return identity;
    }

    std::size_t rows() const { return rows_; }
    std::size_t columns() const { return columns_; }
    double& operator()(std::size_t row, std::size_t column) { return values_[column * rows_ + row]; }
    double operator()(std::size_t row, std::size_t column) const { return values_[column * rows_ + row]; }
    std::span<double> column(std::size_t column) { return std::span(values_).subspan(column * rows_, rows_); }
    std::span<const double> column(std::size_t column) const {
        return std::span(values_).subspan(column * rows_, rows_);
    }
    // All values, column by column.
    std::span<double> values() { return values_; }
    std::span<const double> values() const { return values_; }

    // The rows and columns of these indices, in their order.
    Matrix part(std::span<const std::size_t> rows, std::span<const std::size_t> columns) const {
        Matrix part(rows.size(), columns.size());
        for (std::size_t j = 0; j < columns.size(); ++j) {
            for (std::size_t i = 0; i < rows.size(); ++i) { part(i, j) = (*this)(rows[i], columns[j]); }
        }
        return part;
    }

private:
    std::size_t rows_ = 0;
    std::size_t columns_ = 0;
    std::vector<double> values_;
};

}  // namespace gyrolog
