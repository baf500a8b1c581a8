// Random numbers that depend on who asks, never on when or where.
//
// A stream is Philox4x64-10 (Salmon et al. 2011) with
//   key     = (seed, stream)                 stream: hash of a name such as "turbulence"
//   counter = (block, repetition, cell, study)
// so that one draw is fixed by (seed, stream, trial, position in the stream): the number of workers, the
// order of trials and other streams cannot change it, and extending a cell moves nothing.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace fatmc {

/// FNV-1a, 64 bit: names of studies, cells and streams become parts of the key.
constexpr std::uint64_t name_hash(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

/// What a trial's streams have in common.
struct TrialSeed {
  std::uint64_t seed = 0;        ///< of the campaign
  std::uint64_t study = 0;       ///< name_hash of the study
  std::uint64_t cell = 0;        ///< name_hash of the cell
  std::uint64_t repetition = 0;  ///< from 0, within the cell
};

/// One stream of a trial; a uniform random bit generator of 64 bits.
class RandomStream {
 public:
  using result_type = std::uint64_t;

  RandomStream(const TrialSeed& trial, std::string_view stream_name);

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() {
    if (next_ == kBlock) refill();
    return block_[next_++];
  }

  /// Uniform on [0, 1), multiples of 2^-53.
  double uniform() { return static_cast<double>((*this)() >> 11) * 0x1.0p-53; }

  /// Standard normal, by the ziggurat method (a variable number of draws).
  double normal();

 private:
  static constexpr unsigned kBlock = 4;
  void refill();

  std::array<std::uint64_t, 2> key_;
  std::array<std::uint64_t, 4> counter_;
  std::array<std::uint64_t, kBlock> block_{};
  unsigned next_ = kBlock;
};

/// The generator itself, for known-answer tests: Philox4x64-10 of Random123.
std::array<std::uint64_t, 4> philox_block(const std::array<std::uint64_t, 4>& counter,
                                          const std::array<std::uint64_t, 2>& key);

}  // namespace fatmc
