#include "core/record/record.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/text.h"

namespace fatmc {

int Record::column(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

Eigen::MatrixXd Record::channels(const std::vector<int>& columns) const {
  Eigen::MatrixXd out(samples.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) out.col(static_cast<Eigen::Index>(c)) = samples.col(columns[c]);
  return out;
}

namespace {

Status check_channels(const Record& record, const std::string& file) {
  for (const std::vector<int>* role : {&record.reference, &record.input, &record.output, &record.auxiliary}) {
    for (const int c : *role) {
      FATMC_CHECK(c >= 0 && c < record.samples.cols(), "roles name columns");
      const auto x = record.samples.col(c);
      const std::string& name = record.names[static_cast<std::size_t>(c)];
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        if (!std::isfinite(x(i))) {
          return fail(Error{file, 0, name, "sample " + std::to_string(i + 1) + " is not a finite number, cut or repair it"});
        }
      }
      if (role != &record.auxiliary && x.minCoeff() == x.maxCoeff()) {
        return fail(Error{file, 0, name, "dead channel: every sample is " + shortest(x(0)) +
                                             ", name another column or leave it out"});
      }
    }
  }
  return {};
}

Status check_periods(Record& record, const std::string& file) {
  const int n = record.sample_count(), period = record.period_samples;
  if (period == 0) return {};
  if (period < 3) return fail(Error{file, 0, "period_samples", std::to_string(period) + " is too short, take 3 or more"});
  if (n % period != 0) {
    return fail(Error{file, 0, "period_samples",
                      "the record holds " + std::to_string(n) + " samples = " +
                          significant(static_cast<double>(n) / period, 4) + " periods of " + std::to_string(period) +
                          ", cut it to whole periods" +
                          (n > period ? " (" + std::to_string(n - n % period) + " samples)" : "")});
  }
  if (record.periods != 0 && record.periods != n / period) {
    return fail(Error{file, 0, "periods", std::to_string(record.periods) + " periods of " + std::to_string(period) +
                                              " samples are announced, the record holds " + std::to_string(n / period)});
  }
  record.periods = n / period;
  for (std::size_t i = 0; i < record.excited_lines.size(); ++i) {
    const int line = record.excited_lines[i];
    if (line < 1 || 2 * line >= period || (i > 0 && line <= record.excited_lines[i - 1])) {
      return fail(Error{file, 0, "excited_lines", "line " + std::to_string(line) + " must ascend and lie in 1 ... " +
                                                      std::to_string((period - 1) / 2)});
    }
  }
  return {};
}

}  // namespace

Status validate(Record& record, const std::string& file) {
  if (!(record.rate_hz > 0.0) || !std::isfinite(record.rate_hz)) {
    return fail(Error{file, 0, "rate_hz", "the sampling rate is missing, give rate_hz or a column t in s"});
  }
  if (record.sample_count() < 4) return fail(Error{file, 0, "", "the record holds fewer than 4 samples"});
  if (record.input.empty()) return fail(Error{file, 0, "input", "no input column is named"});
  if (record.output.empty()) return fail(Error{file, 0, "output", "no output column is named"});
  for (const int column : record.input) {
    if (std::find(record.output.begin(), record.output.end(), column) != record.output.end()) {
      return fail(Error{file, 0, record.names[static_cast<std::size_t>(column)],
                        "is named as input and as output, name it once"});
    }
  }
  if (Status status = check_channels(record, file); !status) return status;
  return check_periods(record, file);
}

Status skip_periods(Record& record, int count, const std::string& file) {
  if (count == 0) return {};
  FATMC_CHECK(record.period_samples > 0, "a periodic record");
  if (count < 0 || record.periods - count < 2) {
    return fail(Error{file, 0, "skip-periods", std::to_string(count) + " of " + std::to_string(record.periods) +
                                                   " periods leave fewer than 2"});
  }
  const Eigen::Index rest = record.samples.rows() - static_cast<Eigen::Index>(count) * record.period_samples;
  record.samples = Eigen::MatrixXd(record.samples.bottomRows(rest));
  record.periods -= count;
  return {};
}

}  // namespace fatmc
