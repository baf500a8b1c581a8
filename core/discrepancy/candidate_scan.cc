#include "core/discrepancy/candidate_scan.h"

#include <Eigen/QR>
#include <algorithm>

#include "core/discrepancy/effect_size.h"
#include "core/discrepancy/signature_scan.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kParts = 12;  // of an interval between the sizes of two signatures

/// The effect of a signature, its strengths scaled by the amplitude that the scan gives it.
Effect scaled(const Effect& signature, double amplitude) {
  const EffectKind& kind = signature.kind();
  Effect out = signature;
  for (std::size_t p = 0; p < kind.parameters.size(); ++p) {
    const EffectParameter& parameter = kind.parameters[p];
    if (!parameter.strength || is_limit(parameter)) continue;
    out.values[p] = std::clamp(parameter.toward(signature.values[p], std::clamp(amplitude, -4.0, 4.0)),
                               parameter.low, parameter.high);
  }
  return out;
}

class Scan {
 public:
  Scan(const Comparison& comparison, const Vector& r, const Matrix& j, const Vector& deviation)
      : comparison_(comparison), best_(comparison.dictionary().variants.size()) {
    inverse_ = deviation.size() == 0 ? Vector::Ones(comparison.size()) : Vector(deviation.cwiseInverse());
    residual_ = inverse_.asDiagonal() * r;
    fitted_ = inverse_.asDiagonal() * j;
    for (std::size_t v = 0; v < best_.size(); ++v) best_[v].variant = static_cast<int>(v);
  }

  /// Signatures times residual and each other, what lies within J left out.
  void follow_curves() {
    const Matrix atoms = inverse_.asDiagonal() * comparison_.atoms();
    Vector products = atoms.transpose() * residual_;
    Matrix within(0, atoms.cols());
    if (fitted_.cols() > 0) {
      const Eigen::ColPivHouseholderQR<Matrix> qr(fitted_);
      const Matrix basis =
          qr.householderQ() * Matrix::Identity(fitted_.rows(), static_cast<Eigen::Index>(qr.rank()));
      within = basis.transpose() * atoms;
      products -= within.transpose() * (basis.transpose() * residual_);
    }
    for (const EffectCurve& curve : comparison_.curves()) follow(curve, atoms, within, products);
  }

  void scale_signatures() {
    const auto& atoms = comparison_.dictionary().atoms;
    const std::vector<ScanHit> hits =
        scan_signatures(residual_, inverse_.asDiagonal() * comparison_.atoms(), fitted_);
    for (const ScanHit& hit : hits) {
      const Atom& atom = atoms[static_cast<std::size_t>(hit.atom)];
      if (atom.effect.values.size() > 1) take(atom.variant, hit.glr, scaled(atom.effect, hit.amplitude));
    }
    const auto& modes = comparison_.resonances();
    if (modes.empty()) return;
    const Matrix grid = inverse_.asDiagonal() * comparison_.resonance_atoms();
    for (const double sign : {1.0, -1.0}) {
      for (const ScanHit& hit : scan_signatures(sign * residual_, grid, fitted_)) {
        const Atom& mode = modes[static_cast<std::size_t>(hit.atom)];
        take(mode.variant, hit.glr, scaled(mode.effect, sign * hit.amplitude));
      }
    }
  }

  std::vector<Candidate> result() {
    std::erase_if(best_, [](const Candidate& c) { return !(c.gain > 0.0); });
    std::stable_sort(best_.begin(), best_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; });
    return std::move(best_);
  }

 private:
  void take(int variant, double gain, const Effect& effect) {
    Candidate& own = best_[static_cast<std::size_t>(variant)];
    if (gain <= own.gain) return;
    own.gain = gain;
    own.effect = effect;
  }

  void follow(const EffectCurve& curve, const Matrix& atoms, const Matrix& within, const Vector& products) {
    const Effect& variant = comparison_.dictionary().variants[static_cast<std::size_t>(curve.variant())];
    const EffectParameter& parameter = variant.kind().parameters.front();
    std::vector<int> used;  // signatures of this curve; products of them all are formed once
    for (const double t : curve.places(1)) {
      for (const AtomWeight& w : curve.change(t)) {
        if (std::find(used.begin(), used.end(), w.atom) == used.end()) used.push_back(w.atom);
      }
    }
    const Matrix own = atoms(Eigen::all, used), inside = within(Eigen::all, used);
    const Matrix normal = own.transpose() * own - inside.transpose() * inside;
    for (const double t : curve.places(kParts)) {
      Vector share = Vector::Zero(static_cast<Eigen::Index>(used.size()));
      for (const AtomWeight& w : curve.change(t)) {
        share[std::find(used.begin(), used.end(), w.atom) - used.begin()] += w.weight;
      }
      const double gain = 2.0 * share.dot(products(used)) - share.dot(normal * share);
      if (gain <= best_[static_cast<std::size_t>(curve.variant())].gain) continue;
      Effect effect = variant;
      effect.values.front() = std::clamp(from_natural(parameter, t), parameter.low, parameter.high);
      take(curve.variant(), gain, effect);
    }
  }

  const Comparison& comparison_;
  Vector inverse_, residual_;
  Matrix fitted_;
  std::vector<Candidate> best_;
};

}  // namespace

std::vector<Candidate> scan_candidates(const Comparison& comparison, const Eigen::Ref<const Vector>& residual,
                                       const Eigen::Ref<const Matrix>& jacobian,
                                       const Eigen::Ref<const Vector>& deviation) {
  Scan scan(comparison, residual, jacobian, deviation);
  scan.follow_curves();
  scan.scale_signatures();
  return scan.result();
}

}  // namespace fatmc
