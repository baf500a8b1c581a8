#include "proto/curve_keys.h"

#include <sodium.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/base/check.h"

namespace fatmc {
namespace {

static_assert(crypto_box_PUBLICKEYBYTES == 32 && crypto_box_SECRETKEYBYTES == 32);

void start_sodium() {
  static const bool ready = sodium_init() >= 0;
  FATMC_CHECK(ready, "libsodium starts");
}

}  // namespace

CurvePair make_curve_pair() {
  start_sodium();
  CurvePair pair;
  crypto_box_keypair(pair.open.data(), pair.secret.data());
  return pair;
}

CurvePair pair_of_secret(const CurveKey& secret) {
  start_sodium();
  CurvePair pair{{}, secret};
  FATMC_CHECK(crypto_scalarmult_base(pair.open.data(), secret.data()) == 0, "a secret has a public half");
  return pair;
}

std::string key_text(const CurveKey& key) {
  char text[65];
  sodium_bin2hex(text, sizeof text, key.data(), key.size());
  return text;
}

Result<CurveKey> parse_key(std::string_view text) {
  CurveKey key{};
  std::size_t size = 0;
  const char* end = nullptr;
  if (text.size() != 64 ||
      sodium_hex2bin(key.data(), key.size(), text.data(), text.size(), nullptr, &size, &end) != 0 ||
      size != key.size() || end != text.data() + text.size()) {
    return fail("is no key of 64 hexadecimal digits, make new ones by `fatmc keygen DIR`");
  }
  return key;
}

RunKeys make_run_keys() {
  RunKeys keys;
  keys.coordinator.own = make_curve_pair();
  keys.worker = {make_curve_pair(), keys.coordinator.own.open};
  keys.coordinator.admitted = {keys.worker.own.open};
  return keys;
}

int open_worker_keys(const WorkerKeys& keys) {
  const std::string text = key_text(keys.own.secret) + key_text(keys.coordinator);
  const int descriptor = ::memfd_create("fatmc-worker-keys", MFD_CLOEXEC);
  if (descriptor < 0)
    throw std::system_error(errno, std::generic_category(), "no file for the workers' keys");
  FATMC_CHECK(::pwrite(descriptor, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()),
              "a file in memory takes 128 bytes");
  return descriptor;
}

Result<WorkerKeys> read_worker_keys_from(int descriptor) {
  char text[129];
  const ssize_t size = ::pread(descriptor, text, sizeof text, 0);
  if (size != 128) {
    return fail(Error{"", 0, "--keys-descriptor",
                      std::to_string(descriptor) +
                          " holds no keys; it is for workers that `fatmc run` starts, " +
                          "others take --keys DIR"});
  }
  const Result<CurveKey> secret = parse_key({text, 64}), coordinator = parse_key({text + 64, 64});
  if (!secret || !coordinator) return fail(Error{"", 0, "--keys-descriptor", "holds no keys"});
  return WorkerKeys{pair_of_secret(*secret), *coordinator};
}

}  // namespace fatmc
