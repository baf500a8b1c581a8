#include "core/discrepancy/effect_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fatmc {
namespace {

/// m(t) of a curve whose signatures are f at their nodes; f(nominal) = 0.
template <typename F>
double value(const EffectCurve& curve, const std::vector<EffectCurve::Node>& nodes, F f, double t) {
  double out = 0.0;
  for (const AtomWeight& w : curve.change(t)) {
    for (const EffectCurve::Node& node : nodes) out += node.atom == w.atom ? w.weight * f(node.t) : 0.0;
  }
  return out;
}

const std::vector<EffectCurve::Node> kNodes = {{-1.0, 0}, {-0.3, 1}, {0.0, -1}, {0.2, 2}, {0.5, 3}, {1.4, 4}};

TEST(EffectCurve, MeetsItsSignaturesAndIsNothingAtNominal) {
  const EffectCurve curve(0, kNodes);
  const auto f = [](double t) { return std::sin(3.0 * t); };
  for (const EffectCurve::Node& node : kNodes) EXPECT_NEAR(value(curve, kNodes, f, node.t), f(node.t), 1e-14);
}

TEST(EffectCurve, IsExactForParabolasBetweenUnequalNodes) {
  const EffectCurve curve(0, kNodes);
  const auto f = [](double t) { return 2.0 * t - 0.7 * t * t; };
  for (double t = -1.0; t <= 1.4; t += 0.05) EXPECT_NEAR(value(curve, kNodes, f, t), f(t), 1e-13) << t;
}

TEST(EffectCurve, ErrsWithTheThirdPowerOfTheDistanceBetweenNodes) {
  const auto worst = [](double h) {
    const std::vector<EffectCurve::Node> nodes = {{-h, 0}, {0.0, -1}, {h, 1}, {2.0 * h, 2}};
    const EffectCurve curve(0, nodes);
    const auto f = [](double t) { return std::exp(t) - 1.0; };
    double most = 0.0;
    for (double t = 0.0; t < h; t += 0.02 * h)
      most = std::max(most, std::abs(value(curve, nodes, f, t) - f(t)));
    return most;
  };
  EXPECT_NEAR(std::log2(worst(0.2) / worst(0.1)), 3.0, 0.5);
}

TEST(EffectCurve, GoesOnStraightBeyondItsEnds) {
  const EffectCurve curve(0, kNodes);
  const auto f = [](double t) { return t + t * t; };
  EXPECT_NEAR(value(curve, kNodes, f, 1.9), f(1.4) + 0.5 * (1.0 + 2.8), 1e-12);
  EXPECT_NEAR(value(curve, kNodes, f, -1.5), f(-1.0) - 0.5 * (1.0 - 2.0), 1e-12);
}

TEST(EffectCurve, OfTwoNodesIsALine) {
  const std::vector<EffectCurve::Node> nodes = {{0.0, -1}, {2.0, 0}};
  const EffectCurve curve(3, nodes);
  EXPECT_EQ(curve.variant(), 3);
  EXPECT_NEAR(value(
                  curve, nodes, [](double t) { return 5.0 * t; }, 0.5),
              2.5, 1e-14);
}

}  // namespace
}  // namespace fatmc
