#include "coordinator/cli/progress_line.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "core/base/text.h"

namespace fatmc::cli {
namespace {

constexpr double kWindowS = 10.0;     // short enough to follow a change, long enough to be calm
constexpr std::uint64_t kFewest = 8;  // trials that a rate is taken over; long ones make the window longer
constexpr std::chrono::milliseconds kRedraw{200};
constexpr std::chrono::milliseconds kNewLine{5000};
constexpr std::uint64_t kBarWidth = 30;

}  // namespace

void RateMeter::add(Seconds time, std::uint64_t done) {
  const std::size_t size = samples_.size();
  if (size >= 2 && samples_[size - 2].second == samples_[size - 1].second)
    samples_.back() = {time, done};  // of a pause, when it began is kept: few samples, however long it lasts
  else
    samples_.emplace_back(time, done);
  const auto enough_from = [&](std::size_t first) {
    return (time - samples_[first].first).count() > kWindowS && done - samples_[first].second >= kFewest;
  };
  while (samples_.size() > 2 && enough_from(1)) samples_.pop_front();
}

double RateMeter::per_second() const {
  if (samples_.size() < 2) return 0.0;
  const double span = (samples_.back().first - samples_.front().first).count();
  return span > 0.0 ? static_cast<double>(samples_.back().second - samples_.front().second) / span : 0.0;
}

double RateMeter::seconds_left(std::uint64_t left) const {
  const double rate = per_second();
  return rate > 0.0 ? static_cast<double>(left) / rate : -1.0;
}

std::string clock_text(double seconds) {
  if (!(seconds >= 0.0) || seconds > 3.6e9) return "?";
  const auto all = static_cast<long long>(std::ceil(seconds));
  char text[64];
  if (all >= 3600) {
    std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", all / 3600, all / 60 % 60, all % 60);
  } else {
    std::snprintf(text, sizeof text, "%lld:%02lld", all / 60, all % 60);
  }
  return text;
}

std::string progress_text(const Progress& progress, const RateMeter& rate) {
  std::string text = std::to_string(progress.done) + "/" + std::to_string(progress.total) + " trials";
  if (progress.failed > 0) text += ", " + std::to_string(progress.failed) + " not ok";
  if (progress.paused) {
    text += ", paused (fatmc resume goes on)";
  } else {
    text += ", " + significant(rate.per_second(), 3) + "/s, ETA " +
            clock_text(rate.seconds_left(progress.total - progress.done));
  }
  if (!progress.precision.empty()) text += ", " + progress.precision;
  return text;
}

ProgressLine::ProgressLine()
    : terminal_(::isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()), last_(start_) {}

void ProgressLine::show(const Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  rate_.add(now - start_, progress.done);
  if (now - last_ < (terminal_ ? kRedraw : kNewLine)) return;
  last_ = now;
  draw(progress);
}

void ProgressLine::draw(const Progress& progress) {
  const std::string text = progress_text(progress, rate_);
  if (terminal_) {
    const std::uint64_t filled = progress.total > 0 ? kBarWidth * progress.done / progress.total : kBarWidth;
    std::fprintf(stderr, "\r[%s%s] %s\033[K", std::string(filled, '#').c_str(),
                 std::string(kBarWidth - filled, '.').c_str(), text.c_str());
    std::fflush(stderr);
    drawn_ = true;
  } else {
    std::fprintf(stderr, "%s\n", text.c_str());
  }
}

void ProgressLine::finish(const Progress& progress) {
  if (!drawn_) return;
  draw(progress);
  std::fprintf(stderr, "\n");
}

}  // namespace fatmc::cli
