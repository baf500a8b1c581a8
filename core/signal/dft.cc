#include "core/signal/dft.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <vector>

#include "core/base/check.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;

/// FFTW's planner is not thread-safe (its execution is).
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Aligned for FFTW's SIMD; grows and stays, one a thread.
template <typename T>
class AlignedBuffer {
 public:
  ~AlignedBuffer() { fftw_free(data_); }
  AlignedBuffer() = default;
  AlignedBuffer(const AlignedBuffer&) = delete;
  AlignedBuffer& operator=(const AlignedBuffer&) = delete;
  T* at_least(std::size_t count) {
    if (count > count_) {
      fftw_free(data_);
      data_ = static_cast<T*>(fftw_malloc(count * sizeof(T)));
      FATMC_CHECK(data_ != nullptr, "out of memory for a DFT");
      count_ = count;
    }
    return data_;
  }

 private:
  T* data_ = nullptr;
  std::size_t count_ = 0;
};

fftw_complex* raw(Complex* p) { return reinterpret_cast<fftw_complex*>(p); }

}  // namespace

// An even length N is one complex DFT of N/2 points z[n] = x[2n] + j x[2n+1]; with E and O the DFTs of the even
// and odd samples, X(m) = E(m) + exp(-j 2 pi m / N) O(m), and only bins that are asked for are put together.
struct RealDft::Plan {
  fftw_plan plan = nullptr;
  bool half_length = false;
  std::vector<Complex> twiddle;  ///< -j exp(-j 2 pi m / N) / (2 sqrt(N)), half-length plans only

  explicit Plan(int n) : half_length(n % 2 == 0 && n >= 4) {
    AlignedBuffer<Complex> in, out;
    const auto points = static_cast<std::size_t>(n);
    if (half_length) {
      plan = fftw_plan_dft_1d(n / 2, raw(in.at_least(points)), raw(out.at_least(points)), FFTW_FORWARD,
                              FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
      twiddle.resize(points / 2 + 1);
      const double scale = 0.5 / std::sqrt(static_cast<double>(n));
      for (std::size_t m = 0; m < twiddle.size(); ++m) {
        twiddle[m] = Complex(0.0, -scale) * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(m) / n);
      }
    } else {
      plan = fftw_plan_dft_r2c_1d(n, reinterpret_cast<double*>(in.at_least(points)), raw(out.at_least(points)),
                                  FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
    }
    FATMC_CHECK(plan != nullptr, "FFTW made no plan");
  }
  ~Plan() {
    const std::lock_guard lock(planner_mutex());
    fftw_destroy_plan(plan);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
};

RealDft::RealDft(int n) : n_(n) {
  FATMC_CHECK(n >= 2, "a DFT needs two samples");
  planner_mutex();  // constructed before `plans`, hence destroyed after it
  static std::mutex plans_mutex;
  static std::map<int, std::shared_ptr<const Plan>> plans;
  const std::lock_guard plans_lock(plans_mutex);
  std::shared_ptr<const Plan>& plan = plans[n];
  if (!plan) {
    const std::lock_guard lock(planner_mutex());
    plan = std::make_shared<const Plan>(n);
  }
  plan_ = plan;
}

void RealDft::transform(std::span<const double> x, std::span<Complex> bins) const {
  const auto n = static_cast<std::size_t>(n_);
  FATMC_CHECK(x.size() == n && bins.size() <= n / 2 + 1, "sizes of a DFT");
  thread_local AlignedBuffer<double> input;
  thread_local AlignedBuffer<Complex> output;
  auto* in = const_cast<double*>(x.data());  // FFTW_PRESERVE_INPUT: not written
  if (fftw_alignment_of(in) != 0) {
    in = input.at_least(n);
    std::copy(x.begin(), x.end(), in);
  }
  Complex* out = output.at_least(n / 2 + 1);
  if (!plan_->half_length) {
    fftw_execute_dft_r2c(plan_->plan, in, raw(out));
    const double scale = 1.0 / std::sqrt(static_cast<double>(n_));
    for (std::size_t m = 0; m < bins.size(); ++m) bins[m] = scale * out[m];
    return;
  }
  fftw_execute_dft(plan_->plan, reinterpret_cast<fftw_complex*>(in), raw(out));
  const std::size_t half = n / 2;
  const double scale = 0.5 / std::sqrt(static_cast<double>(n_));
  const auto combine = [&](std::size_t m, std::size_t low, std::size_t high) {
    const double ar = out[low].real(), ai = out[low].imag(), br = out[high].real(), bi = -out[high].imag();
    const double wr = plan_->twiddle[m].real(), wi = plan_->twiddle[m].imag();
    const double dr = ar - br, di = ai - bi;  // 2j O(m)
    bins[m] = Complex(scale * (ar + br) + wr * dr - wi * di, scale * (ai + bi) + wr * di + wi * dr);
  };
  if (bins.empty()) return;
  combine(0, 0, 0);
  const std::size_t end = std::min(bins.size(), half);
  for (std::size_t m = 1; m < end; ++m) combine(m, m, half - m);
  if (bins.size() > half) combine(half, 0, 0);
}

void inverse_real_dft(std::span<const Complex> bins, std::span<double> x) {
  const auto n = static_cast<int>(x.size());
  const std::size_t count = x.size() / 2 + 1;
  FATMC_CHECK(n >= 2 && bins.size() <= count, "sizes of an inverse DFT");
  AlignedBuffer<Complex> in;
  AlignedBuffer<double> out;
  Complex* spectrum = in.at_least(count);
  double* samples = out.at_least(x.size());
  fftw_plan plan = nullptr;
  {
    const std::lock_guard lock(planner_mutex());
    plan = fftw_plan_dft_c2r_1d(n, raw(spectrum), samples, FFTW_ESTIMATE);
  }
  FATMC_CHECK(plan != nullptr, "FFTW made no plan");
  std::fill(spectrum, spectrum + count, Complex(0.0, 0.0));
  const double scale = 1.0 / std::sqrt(static_cast<double>(n));
  for (std::size_t m = 0; m < bins.size(); ++m) spectrum[m] = scale * bins[m];
  fftw_execute(plan);
  std::copy(samples, samples + x.size(), x.begin());
  const std::lock_guard lock(planner_mutex());
  fftw_destroy_plan(plan);
}

}  // namespace fatmc
