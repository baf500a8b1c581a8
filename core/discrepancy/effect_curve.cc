#include "core/discrepancy/effect_curve.h"

#include <algorithm>

#include "core/base/check.h"
#include "core/discrepancy/effect_size.h"

namespace fatmc {

EffectCurve::EffectCurve(int variant, std::vector<Node> nodes) : variant_(variant), nodes_(std::move(nodes)) {
  FATMC_CHECK(nodes_.size() >= 2, "a curve has two nodes");
  for (std::size_t i = 1; i < nodes_.size(); ++i)
    FATMC_CHECK(nodes_[i - 1].t < nodes_[i].t, "ascending nodes");
}

// The parabola through (t0, m0), (t1, m1), (t2, m2), with h0 = t1 - t0, h1 = t2 - t1 and d0 = (m1 - m0)/h0, d1 alike, has the
// slope (h1 d0 + h0 d1)/(h0 + h1) at t1, d0 - h0 (d1 - d0)/(h0 + h1) at t0, and d1 + h1 (d1 - d0)/(h0 + h1) at t2.
void EffectCurve::add_slope(std::size_t i, double factor, std::vector<double>& share) const {
  const std::size_t n = nodes_.size();
  const auto add_difference = [&](std::size_t j, double weight) {  // of d_j
    const double h = nodes_[j + 1].t - nodes_[j].t;
    share[j + 1] += factor * weight / h;
    share[j] -= factor * weight / h;
  };
  if (n == 2) return add_difference(0, 1.0);
  const std::size_t j = std::clamp<std::size_t>(i, 1, n - 2);  // the middle of the three
  const double h0 = nodes_[j].t - nodes_[j - 1].t, h1 = nodes_[j + 1].t - nodes_[j].t, sum = h0 + h1;
  if (i == j) {
    add_difference(j - 1, h1 / sum);
    add_difference(j, h0 / sum);
  } else if (i < j) {
    add_difference(j - 1, 1.0 + h0 / sum);
    add_difference(j, -h0 / sum);
  } else {
    add_difference(j - 1, -h1 / sum);
    add_difference(j, 1.0 + h1 / sum);
  }
}

std::vector<double> EffectCurve::node_shares(double t) const {
  std::vector<double> share(nodes_.size(), 0.0);
  if (t <= first() || t >= last()) {
    const std::size_t end = t <= first() ? 0 : nodes_.size() - 1;
    share[end] += 1.0;
    add_slope(end, t - nodes_[end].t, share);
  } else {
    std::size_t i = 0;
    while (t >= nodes_[i + 1].t) ++i;
    const double h = nodes_[i + 1].t - nodes_[i].t, s = (t - nodes_[i].t) / h;
    share[i] += (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s);
    share[i + 1] += s * s * (3.0 - 2.0 * s);
    add_slope(i, h * s * (1.0 - s) * (1.0 - s), share);
    add_slope(i + 1, h * s * s * (s - 1.0), share);
  }
  return share;
}

std::vector<int> EffectCurve::atoms() const {
  std::vector<int> out;
  for (const Node& node : nodes_) {
    if (node.atom >= 0) out.push_back(node.atom);
  }
  return out;
}

Eigen::VectorXd EffectCurve::shares(double t) const {
  const std::vector<double> share = node_shares(t);
  Eigen::VectorXd out(static_cast<Eigen::Index>(atoms().size()));
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (nodes_[i].atom >= 0) out[at++] = share[i];
  }
  return out;
}

std::vector<AtomWeight> EffectCurve::change(double t) const {
  const std::vector<double> share = node_shares(t);
  std::vector<AtomWeight> out;
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (share[i] != 0.0 && nodes_[i].atom >= 0) out.push_back({nodes_[i].atom, share[i]});
  }
  return out;
}

std::vector<double> EffectCurve::places(int parts) const {
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
    for (int k = 0; k < parts; ++k) {
      out.push_back(nodes_[i].t + (nodes_[i + 1].t - nodes_[i].t) * k / parts);
    }
  }
  out.push_back(nodes_.back().t);
  return out;
}

std::vector<EffectCurve> effect_curves(const Dictionary& dictionary, const std::vector<bool>& usable) {
  std::vector<std::vector<EffectCurve::Node>> nodes(dictionary.variants.size());
  for (std::size_t a = 0; a < dictionary.atoms.size(); ++a) {
    const Atom& atom = dictionary.atoms[a];
    const EffectKind& kind = atom.effect.kind();
    if (kind.parameters.size() != 1 || !usable[a]) continue;
    nodes[static_cast<std::size_t>(atom.variant)].push_back(
        {to_natural(kind.parameters.front(), atom.effect.values.front()), static_cast<int>(a)});
  }
  std::vector<EffectCurve> out;
  for (std::size_t v = 0; v < nodes.size(); ++v) {
    if (nodes[v].empty()) continue;
    const EffectParameter& p = dictionary.variants[v].kind().parameters.front();
    if (!is_limit(p)) nodes[v].push_back({to_natural(p, p.nominal), -1});
    std::sort(nodes[v].begin(), nodes[v].end(), [](const auto& a, const auto& b) { return a.t < b.t; });
    if (nodes[v].size() >= 2) out.emplace_back(static_cast<int>(v), std::move(nodes[v]));
  }
  return out;
}

}  // namespace fatmc
