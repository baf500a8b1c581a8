// Signatures of the effects: what each of them, at some size, changes in the features of a record.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/discrepancy/model_simulator.h"
#include "core/flight/effects/effect.h"

namespace fatmc {

/// One signature: the mean difference of features with and without the effect at these values.
struct Atom {
  Effect effect;
  int variant = 0;  ///< index into Dictionary::variants
};

struct Dictionary {
  std::vector<Effect> variants;  ///< candidates at nominal values: kinds with each choice
  std::vector<Atom> atoms;
  Eigen::MatrixXd differences;  ///< layout size x atoms; zero where the effect cannot be flown at that size

  /// Flights behind a signature, with common random numbers.
  static constexpr int kFlights = 4;
};

/// Candidates of a diagnosis: every choice of the effects that effect_knowledge.h describes, without those whose id or name
/// is in `excluded`.
std::vector<Effect> candidate_variants(const std::vector<std::string>& excluded);

/// Effects at the sizes that signatures are taken at: from every strength a quarter and the whole of the least moderate size, the
/// largest, and their geometric mean, on either side of nominal, so that likelihoods can be followed along the size
/// (effect_curve.h); shapes (the frequency of a mode) on a grid.
std::vector<Atom> signature_effects(const std::vector<Effect>& variants);

/// Signatures of all candidates. Effects that cannot be flown at a size have no signature at it (zeros); `baseline` holds the
/// features of the model's own flights 0 ... kFlights-1 as columns.
Dictionary make_dictionary(const ModelSimulator& model, const std::vector<std::string>& excluded,
                           const Eigen::Ref<const Eigen::MatrixXd>& baseline, int threads,
                           const FlightProgress& progress = {});

}  // namespace fatmc
