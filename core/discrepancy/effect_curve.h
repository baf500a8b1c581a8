// What an effect of one strength changes in the features, at any size, from its signatures at a few sizes.
//
// Between the sizes t_i of the signatures m(t_i), on the natural scale (effect_size.h), m(t) is the cubic Hermite interpolant
// whose slopes are those of the parabola through a node and its neighbours; nominal, where nothing changes, is a node as
// well, unless the strength is a limit, which has no nominal size. Beyond the last nodes it goes on straight. The interpolant
// is linear in the signatures: a curve is a list of weights, so that likelihoods along it need the signatures' products alone.
#pragma once

#include <vector>

#include "core/discrepancy/dictionary.h"

namespace fatmc {

/// Share of a signature in m(t).
struct AtomWeight {
  int atom = 0;
  double weight = 0.0;
};

class EffectCurve {
 public:
  struct Node {
    double t = 0.0;
    int atom = -1;  ///< nominal has none
  };
  /// Nodes in ascending order of t, two at least.
  EffectCurve(int variant, std::vector<Node> nodes);

  [[nodiscard]] int variant() const { return variant_; }
  [[nodiscard]] double first() const { return nodes_.front().t; }
  [[nodiscard]] double last() const { return nodes_.back().t; }
  [[nodiscard]] std::vector<AtomWeight> change(double t) const;
  /// Signatures of the nodes, ascending in t, and their shares in m(t) in the same order.
  [[nodiscard]] std::vector<int> atoms() const;
  [[nodiscard]] Eigen::VectorXd shares(double t) const;
  /// Sizes at which likelihoods are looked at: `parts` in every interval between nodes.
  [[nodiscard]] std::vector<double> places(int parts) const;

 private:
  /// Adds `factor` times the slope at node i.
  void add_slope(std::size_t i, double factor, std::vector<double>& share) const;
  /// A share a node, nominal included.
  [[nodiscard]] std::vector<double> node_shares(double t) const;

  int variant_;
  std::vector<Node> nodes_;
};

/// Curves of all candidates of one parameter; signatures that are not `usable` (the effect cannot be flown at that size) are
/// no nodes.
std::vector<EffectCurve> effect_curves(const Dictionary& dictionary, const std::vector<bool>& usable);

}  // namespace fatmc
