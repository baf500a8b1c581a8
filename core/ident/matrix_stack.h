// One small matrix a line, all in one piece of memory.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace fatmc {

template <typename Scalar>
class MatrixStack {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  MatrixStack() = default;
  MatrixStack(int rows, int cols, int count) { resize(rows, cols, count); }

  void resize(int rows, int cols, int count) {
    rows_ = rows;
    cols_ = cols;
    count_ = count;
    values_.assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols) * static_cast<std::size_t>(count),
                   Scalar{});
  }

  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int cols() const { return cols_; }
  [[nodiscard]] int count() const { return count_; }

  /// Matrix of line `k` (0 ... count-1), column-major.
  Eigen::Map<Matrix> operator[](int k) { return {data(k), rows_, cols_}; }
  Eigen::Map<const Matrix> operator[](int k) const { return {data(k), rows_, cols_}; }
  Scalar* data(int k) { return values_.data() + offset(k); }
  const Scalar* data(int k) const { return values_.data() + offset(k); }

 private:
  [[nodiscard]] std::size_t offset(int k) const {
    return static_cast<std::size_t>(k) * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_);
  }

  int rows_ = 0, cols_ = 0, count_ = 0;
  std::vector<Scalar> values_;
};

}  // namespace fatmc
