#include "campaigns/base/trial_row.h"

#include <sodium.h>

#include <bit>
#include <cstring>

#include "core/base/check.h"

namespace fatmc {
namespace {

static_assert(std::endian::native == std::endian::little,
              "content hashes are defined on little-endian doubles");

// Feeds typed values to SHA-256; every variable length stands in front of its bytes.
class Hasher {
 public:
  Hasher() { crypto_hash_sha256_init(&state_); }
  void bytes(const void* data, std::size_t size) {
    crypto_hash_sha256_update(&state_, static_cast<const unsigned char*>(data), size);
  }
  void number(std::uint64_t value) { bytes(&value, sizeof value); }
  void real(double value) { number(std::bit_cast<std::uint64_t>(value)); }
  void text(std::string_view value) {
    number(value.size());
    bytes(value.data(), value.size());
  }
  Sha256 finish() {
    Sha256 out{};
    crypto_hash_sha256_final(&state_, out.data());
    return out;
  }

 private:
  crypto_hash_sha256_state state_{};
};

}  // namespace

const std::vector<double>* TrialRow::array(std::string_view name) const {
  for (const auto& [key_name, values] : arrays) {
    if (key_name == name) return &values;
  }
  return nullptr;
}

const std::vector<double>& array_of(const TrialRow& row, std::string_view name) {
  const std::vector<double>* values = row.array(name);
  FATMC_CHECK(values != nullptr, "a row that is ok holds all arrays of its study");
  return *values;
}

double metric_of(const TrialRow& row, std::string_view name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  FATMC_CHECK(false, "a row that is ok holds all metrics of its study");
}

Sha256 content_hash(const TrialRow& row) {
  Hasher hasher;
  hasher.number(row.key.repetition);
  hasher.text(row.outcome);
  hasher.text(row.detail);
  hasher.number(row.metrics.size());
  for (const auto& [name, value] : row.metrics) {
    hasher.text(name);
    hasher.real(value);
  }
  hasher.number(row.arrays.size());
  for (const auto& [name, values] : row.arrays) {
    hasher.text(name);
    hasher.number(values.size());
    hasher.bytes(values.data(), values.size() * sizeof(double));
  }
  return hasher.finish();
}

Sha256 sha256(std::string_view bytes) {
  Hasher hasher;
  hasher.bytes(bytes.data(), bytes.size());
  return hasher.finish();
}

std::string hex(const Sha256& hash) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (const std::uint8_t byte : hash) {
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

Digest::Digest() : chain_(sha256("fatmc digest 1")) {}

void Digest::add(std::string_view cell_name, const TrialRow& row) {
  const Sha256 content = content_hash(row);
  Hasher hasher;
  hasher.bytes(chain_.data(), chain_.size());
  hasher.text(cell_name);
  hasher.bytes(content.data(), content.size());
  chain_ = hasher.finish();
}

std::string Digest::text() const { return hex(chain_); }

}  // namespace fatmc
