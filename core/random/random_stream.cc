#include "core/random/random_stream.h"

#include <Random123/philox.h>

#include <boost/random/normal_distribution.hpp>

namespace fatmc {

std::array<std::uint64_t, 4> philox_block(const std::array<std::uint64_t, 4>& counter,
                                          const std::array<std::uint64_t, 2>& key) {
  r123::Philox4x64::ctr_type c;
  r123::Philox4x64::key_type k;
  for (unsigned i = 0; i < 4; ++i) c[i] = counter[i];
  for (unsigned i = 0; i < 2; ++i) k[i] = key[i];
  const r123::Philox4x64::ctr_type out = r123::Philox4x64()(c, k);
  return {out[0], out[1], out[2], out[3]};
}

RandomStream::RandomStream(const TrialSeed& trial, std::string_view stream_name)
    : key_{trial.seed, name_hash(stream_name)}, counter_{0, trial.repetition, trial.cell, trial.study} {}

void RandomStream::refill() {
  block_ = philox_block(counter_, key_);
  ++counter_[0];
  next_ = 0;
}

double RandomStream::normal() {
  // Boost's ziggurat keeps no state between calls, so that a fresh object a call changes nothing.
  return boost::random::normal_distribution<double>()(*this);
}

}  // namespace fatmc
