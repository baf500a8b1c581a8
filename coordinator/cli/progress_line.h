// How far a campaign is: a bar that redraws itself on a terminal, else a line every few seconds.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

namespace fatmc::cli {

/// Trials a second over the last seconds, of long trials over the last few of them, and how long the rest takes at that rate.
class RateMeter {
 public:
  using Seconds = std::chrono::duration<double>;
  void add(Seconds time, std::uint64_t done);
  [[nodiscard]] double per_second() const;
  /// Negative while unknown.
  [[nodiscard]] double seconds_left(std::uint64_t left) const;

 private:
  std::deque<std::pair<Seconds, std::uint64_t>> samples_;
};

/// "0:07", "12:30", "3:05:00".
std::string clock_text(double seconds);

/// What there is to say at a moment.
struct Progress {
  std::uint64_t done = 0, total = 0;
  std::uint64_t failed = 0;  ///< of those done
  bool paused = false;
  std::string precision;  ///< of the answer; empty where nothing is watched
};

/// "128/300 trials, 3 not ok, 147/s, ETA 0:02, share_inside_95 0.951 in [0.93, 0.97]".
std::string progress_text(const Progress& progress, const RateMeter& rate);

/// Writes to standard error.
class ProgressLine {
 public:
  ProgressLine();
  void show(const Progress& progress);
  /// Ends the line of the bar.
  void finish(const Progress& progress);

 private:
  void draw(const Progress& progress);

  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
  RateMeter rate_;
};

}  // namespace fatmc::cli
