// What a diagnosis leaves behind: diagnosis.json, patch.toml, model.toml, and the way back from a patched model.
//
// A patch is a block at the end of a model file:
//
//   # fatmc patch of parent <SHA-256 of the file without this block>
//   [[effect]] ...
//
// so that cutting the file there gives the parent bit for bit, and blocks stack.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coordinator/cli/diagnosis_input.h"
#include "core/discrepancy/diagnosis.h"
#include "core/discrepancy/gap_measures.h"

namespace fatmc::cli {

/// Before, after and where noise alone ends, by the measures of the field.
struct MeasuredGap {
  std::string record;
  bool holdout = false;
  GapMeasures before, after, floor;
};

/// A place where record and model disagree.
struct Place {
  std::string output, input;  ///< input: of the response, or "mean", "noise", "distortion", ...
  double low_hz = 0.0, high_hz = 0.0;
  double decibel = 0.0, degrees = 0.0, sigma = 0.0;
};

/// All that the files say.
struct DiagnosisPage {
  const DiagnosedModel* model = nullptr;
  std::vector<const DiagnosedRecord*> records, holdout;
  Diagnosis diagnosis;
  std::vector<FoundEffect> earlier;  ///< of the rounds before, where --until-consistent made several
  std::vector<Place> where;
  std::vector<MeasuredGap> gaps;
  Thresholds thresholds;
};

std::string diagnosis_json(const DiagnosisPage& page);
/// The tables [[effect]] of the patch alone, with intervals and hashes.
std::string patch_toml(const DiagnosisPage& page);
/// The parent with a patch at its end.
std::string patched_model(const DiagnosisPage& page);

struct PatchBlock {
  std::size_t begin = 0;    ///< of the block in the text: what stands before is the parent
  std::string parent_hash;  ///< as the block states it
  std::vector<std::string> lines;
  bool whole = false;  ///< the text before has that hash
};
/// Patches of a model file, the first one first.
std::vector<PatchBlock> patches_of(const std::string& text);

}  // namespace fatmc::cli
