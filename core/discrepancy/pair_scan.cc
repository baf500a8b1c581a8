#include "core/discrepancy/pair_scan.h"

#include <algorithm>
#include <cmath>

#include "core/discrepancy/effect_size.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kParts = 4;        // of an interval between signatures, on the first grid
constexpr int kRefined = 300;    // pairs whose sizes are refined
constexpr int kSteps = 8;        // of Gauss-Newton
constexpr double kEnough = 0.1;  // gain of a step that ends them

/// A curve with what its pairs need.
struct Track {
  const EffectCurve* curve = nullptr;
  std::vector<int> atoms;
  Vector along;   ///< products of its signatures with the residual
  Matrix normal;  ///< and with each other
  std::vector<double> places;
  Matrix shares;  ///< a column a place
  Vector alone;   ///< gain at every place

  [[nodiscard]] double gain(const Vector& share) const {
    return 2.0 * share.dot(along) - share.dot(normal * share);
  }
  /// d(share)/dt.
  [[nodiscard]] Vector slope(double t) const {
    const double h = 1e-4 * (curve->last() - curve->first());
    return (curve->shares(t + h) - curve->shares(t - h)) / (2.0 * h);
  }
};

Track track_of(const EffectCurve& curve, const Vector& products, const Matrix& normal) {
  Track out;
  out.curve = &curve;
  out.atoms = curve.atoms();
  out.along = products(out.atoms);
  out.normal = normal(out.atoms, out.atoms);
  out.places = curve.places(kParts);
  const auto count = static_cast<Eigen::Index>(out.places.size());
  out.shares.resize(static_cast<Eigen::Index>(out.atoms.size()), count);
  out.alone.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    out.shares.col(i) = curve.shares(out.places[static_cast<std::size_t>(i)]);
    out.alone[i] = out.gain(out.shares.col(i));
  }
  return out;
}

struct Pair {
  std::size_t first = 0, second = 0;
  double t = 0.0, u = 0.0, gain = 0.0;
};

double gain_of(const Track& a, const Track& b, const Matrix& cross, double t, double u) {
  const Vector s = a.curve->shares(t), v = b.curve->shares(u);
  return a.gain(s) + b.gain(v) - 2.0 * s.dot(cross * v);
}

/// The best places of the grid.
Pair on_grid(const Track& a, const Track& b, const Matrix& cross) {
  Matrix gain = -2.0 * a.shares.transpose() * (cross * b.shares);
  gain.colwise() += a.alone;
  gain.rowwise() += b.alone.transpose();
  Eigen::Index i = 0, j = 0;
  Pair out;
  out.gain = gain.maxCoeff(&i, &j);
  out.t = a.places[static_cast<std::size_t>(i)];
  out.u = b.places[static_cast<std::size_t>(j)];
  return out;
}

/// From there uphill: the step of the linear model, halved until it gains.
void refine(const Track& a, const Track& b, const Matrix& cross, Pair& pair) {
  for (int step = 0; step < kSteps; ++step) {
    const Vector s = a.curve->shares(pair.t), v = b.curve->shares(pair.u);
    const Vector ds = a.slope(pair.t), dv = b.slope(pair.u);
    const double gt = ds.dot(a.along - a.normal * s - cross * v);
    const double gu = dv.dot(b.along - b.normal * v - cross.transpose() * s);
    const double tt = ds.dot(a.normal * ds), uu = dv.dot(b.normal * dv), tu = ds.dot(cross * dv);
    const double determinant = tt * uu - tu * tu;
    if (!(determinant > 1e-9 * tt * uu)) return;  // one passes for the other
    double dt = (uu * gt - tu * gu) / determinant, du = (tt * gu - tu * gt) / determinant;
    double gained = 0.0;
    for (int attempt = 0; attempt < 4 && !(gained > 0.0); ++attempt, dt *= 0.5, du *= 0.5) {
      const double t = std::clamp(pair.t + dt, a.curve->first(), a.curve->last());
      const double u = std::clamp(pair.u + du, b.curve->first(), b.curve->last());
      const double gain = gain_of(a, b, cross, t, u);
      if (gain <= pair.gain) continue;
      gained = gain - pair.gain;
      pair.t = t;
      pair.u = u;
      pair.gain = gain;
    }
    if (gained < kEnough) return;
  }
}

Effect effect_at(const Comparison& comparison, const EffectCurve& curve, double t) {
  Effect out = comparison.dictionary().variants[static_cast<std::size_t>(curve.variant())];
  const EffectParameter& p = out.kind().parameters.front();
  out.values.front() = std::clamp(from_natural(p, t), p.low, p.high);
  return out;
}

}  // namespace

std::vector<CandidatePair> scan_pairs(const Comparison& comparison, const Eigen::Ref<const Vector>& residual,
                                      const std::vector<std::string>& excluded, std::size_t most) {
  const Vector products = comparison.atoms().transpose() * residual;
  const Matrix normal = comparison.atom_products();
  std::vector<Track> tracks;
  for (const EffectCurve& curve : comparison.curves()) {
    const std::string& id = comparison.dictionary().variants[static_cast<std::size_t>(curve.variant())].id;
    if (std::find(excluded.begin(), excluded.end(), id) == excluded.end())
      tracks.push_back(track_of(curve, products, normal));
  }
  const auto better = [](const Pair& a, const Pair& b) { return a.gain > b.gain; };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::size_t j = i + 1; j < tracks.size(); ++j) {
      Pair one = on_grid(tracks[i], tracks[j], normal(tracks[i].atoms, tracks[j].atoms));
      one.first = i;
      one.second = j;
      if (one.gain > 0.0) pairs.push_back(one);
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), better);
  if (pairs.size() > kRefined) pairs.resize(kRefined);
  for (Pair& one : pairs) {
    const Track &a = tracks[one.first], &b = tracks[one.second];
    refine(a, b, normal(a.atoms, b.atoms), one);
  }
  std::stable_sort(pairs.begin(), pairs.end(), better);
  std::vector<CandidatePair> out;
  for (std::size_t n = 0; n < pairs.size() && n < most; ++n) {
    const Pair& one = pairs[n];
    out.push_back({{effect_at(comparison, *tracks[one.first].curve, one.t),
                    effect_at(comparison, *tracks[one.second].curve, one.u)},
                   one.gain});
  }
  return out;
}

}  // namespace fatmc
