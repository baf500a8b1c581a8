// Lines of an estimate are independent problems: a loop over them on several cores.
#pragma once

namespace fatmc {

/// body(k) for k = 0 ... count-1, on `threads` threads where the build has OpenMP. body may write to what belongs to
/// line k alone; then results do not depend on `threads`.
template <typename Body>
void for_each_line(int count, [[maybe_unused]] int threads, const Body& body) {
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
#endif
  for (int k = 0; k < count; ++k) body(k);
}

}  // namespace fatmc
