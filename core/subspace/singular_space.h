// Orthonormal bases R and L of a large upper triangular matrix T with T R = L M, grown by a block at a time.
#pragma once

#include <Eigen/Core>

namespace fatmc {

class SingularSpace {
 public:
  /// `triangle` has to outlive the space. Room for `most` columns.
  SingularSpace(const Eigen::Ref<const Eigen::MatrixXd>& triangle, Eigen::Index most);

  [[nodiscard]] Eigen::Index columns() const { return used_; }

  /// In place of what was there: singular triplets of T, or of its leading block as large as they are. T may have
  /// grown: triplets of the block are triplets of T on vectors that end in zeros.
  void take(const Eigen::MatrixXd& u, const Eigen::MatrixXd& w, const Eigen::VectorXd& s);
  /// The unit vectors from `first` on, which have to be outside the space. Their products are columns of T.
  void add_units(Eigen::Index first);
  /// What of a block is outside the space; one multiplication by T.
  void add(Eigen::MatrixXd block);

  /// Singular values of M, descending, and its vectors.
  [[nodiscard]] bool decompose();
  [[nodiscard]] const Eigen::VectorXd& values() const { return values_; }
  /// R V and L U, the leading `count` columns: T rights = lefts diag(values).
  [[nodiscard]] Eigen::MatrixXd rights(Eigen::Index count) const;
  [[nodiscard]] Eigen::MatrixXd lefts(Eigen::Index count) const;
  /// T^T lefts of the given triplets of `lefts`, the part outside R: what keeps them from being triplets of T.
  [[nodiscard]] Eigen::MatrixXd residuals(const Eigen::MatrixXd& lefts) const;

 private:
  void append(const Eigen::MatrixXd& block, const Eigen::MatrixXd& image);

  Eigen::Ref<const Eigen::MatrixXd> triangle_;
  Eigen::MatrixXd right_, left_, middle_;
  Eigen::MatrixXd u_, v_;  // of M
  Eigen::VectorXd values_;
  Eigen::Index used_ = 0;
};

}  // namespace fatmc
