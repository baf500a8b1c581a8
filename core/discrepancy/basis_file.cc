#include "core/discrepancy/basis_file.h"

#include <cstring>

#include "core/discrepancy/moment_filters.h"
#include "core/random/random_stream.h"

namespace fatmc {
namespace {

constexpr std::string_view kTitle = "fatmc comparison basis 3\n";

class Writer {
 public:
  explicit Writer(std::string& text) : text_(text) {}
  void operator()(const double& value) { bytes(&value, sizeof value); }
  template <typename Matrix>
  void matrix(const Matrix& m) {
    const std::int64_t size[2] = {m.rows(), m.cols()};
    bytes(size, sizeof size);
    bytes(m.data(), static_cast<std::size_t>(m.size()) * sizeof(typename Matrix::Scalar));
  }

 private:
  void bytes(const void* data, std::size_t n) { text_.append(static_cast<const char*>(data), n); }
  std::string& text_;
};

class Reader {
 public:
  explicit Reader(std::string_view rest) : rest_(rest) {}
  void operator()(double& value) { bytes(&value, sizeof value); }
  template <typename Matrix>
  void matrix(Matrix& m) {
    std::int64_t size[2] = {0, 0};
    bytes(size, sizeof size);
    constexpr std::int64_t kMost = 1 << 24;
    ok_ = ok_ && size[0] >= 0 && size[1] >= 0 && size[0] < kMost && size[1] < kMost &&
          static_cast<std::uint64_t>(size[0] * size[1]) * sizeof(typename Matrix::Scalar) <= rest_.size();
    if (!ok_) return;
    m.resize(size[0], size[1]);
    bytes(m.data(), static_cast<std::size_t>(m.size()) * sizeof(typename Matrix::Scalar));
  }
  [[nodiscard]] bool done() const { return ok_ && rest_.empty(); }

 private:
  void bytes(void* data, std::size_t n) {
    ok_ = ok_ && rest_.size() >= n;
    if (!ok_) return;
    std::memcpy(data, rest_.data(), n);
    rest_.remove_prefix(n);
  }
  std::string_view rest_;
  bool ok_ = true;
};

/// Everything that is stored, in order; the covariance's factor apart, which has no setter.
template <typename Archive, typename Basis, typename Factor>
void visit(Archive& archive, Basis& basis, Factor& factor) {
  archive.matrix(basis.law.mean);
  for (auto& block : basis.law.inverse_factor) archive.matrix(block);
  archive.matrix(factor);
  archive.matrix(basis.baseline);
  archive.matrix(basis.dictionary.differences);
  archive.matrix(basis.moment_differences);
  archive.matrix(basis.null.score);
  archive.matrix(basis.null.energy);
  archive.matrix(basis.null.group_mean);
  archive.matrix(basis.null.group_deviation);
  archive.matrix(basis.null.group_score);
}

std::uint64_t checksum(std::string_view text) { return name_hash(text); }

}  // namespace

/// Reaches into the map, whose parts belong together.
struct BasisFile {
  template <typename Archive, typename Map>
  static void visit_map(Archive& archive, Map& map) {
    archive.matrix(map.mean_);
    archive.matrix(map.variance_);
    archive.matrix(map.centre_);
    archive.matrix(map.deviation_);
    archive(map.threshold_);
  }
};

std::string basis_text(const ComparisonBasis& basis, const std::string& key) {
  std::string text(kTitle);
  text += key + "\n";
  Writer writer(text);
  visit(writer, basis, basis.law.covariance.factor());
  BasisFile::visit_map(writer, basis.map);
  const std::uint64_t sum = checksum(text);
  text.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  return text;
}

std::optional<ComparisonBasis> parse_basis(const std::string& text, const std::string& key,
                                           const FeatureLayout& layout, const LpmGrid& grid,
                                           const BasisOptions& options) {
  std::string_view rest = text;
  std::uint64_t sum = 0;
  const std::string head = std::string(kTitle) + key + "\n";
  if (!rest.starts_with(head) || rest.size() < head.size() + sizeof sum) return std::nullopt;
  std::memcpy(&sum, rest.data() + rest.size() - sizeof sum, sizeof sum);
  rest.remove_suffix(sizeof sum);
  if (checksum(rest) != sum) return std::nullopt;
  rest.remove_prefix(head.size());

  ComparisonBasis out;
  out.layout = layout;
  out.groups = feature_groups(layout);
  out.dictionary.variants = candidate_variants(options.excluded);
  out.dictionary.atoms = signature_effects(out.dictionary.variants);
  out.law.inverse_factor.resize(layout.blocks.size());
  out.map = ResponseMap::layout_of(grid);
  Eigen::MatrixXd factor;
  Reader reader(rest);
  visit(reader, out, factor);
  BasisFile::visit_map(reader, out.map);
  const auto atoms = static_cast<Eigen::Index>(out.dictionary.atoms.size());
  const bool fits = reader.done() && out.law.mean.size() == layout.size && factor.rows() == layout.size &&
                    out.dictionary.differences.cols() == atoms &&
                    out.moment_differences.cols() == static_cast<Eigen::Index>(higher_moments().size()) &&
                    out.null.score.cols() == atoms &&
                    out.null.group_mean.size() == static_cast<Eigen::Index>(out.groups.size()) &&
                    out.baseline.cols() == ComparisonBasis::kPaired &&
                    out.map.mean().size() == 9 * grid.line_count();
  if (!fits) return std::nullopt;
  out.law.covariance = LowRankCovariance(std::move(factor));
  out.complete();
  return out;
}

}  // namespace fatmc
