// How far a campaign is: a bar that redraws itself on a terminal, else a line every few seconds.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

namespace fatmc::cli {

/// Trials a second over the last seconds, and how long the rest takes at that rate.
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

/// Writes to standard error.
class ProgressLine {
 public:
  explicit ProgressLine(std::uint64_t total);
  void show(std::uint64_t done);
  /// Ends the line of the bar.
  void finish(std::uint64_t done);

 private:
  void draw(std::uint64_t done);

  std::uint64_t total_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
  RateMeter rate_;
};

}  // namespace fatmc::cli
