// Views: the questions that docs/schema.md lists, in plain SQL, so that they work in any SQLite from 3.38
// with its mathematical functions, without our code.
#include <string>

#include "coordinator/store/schema.h"

namespace fatmc {
namespace {

constexpr const char* kPlainViews = R"sql(
CREATE VIEW trials AS
  SELECT cell.name AS cell, t.repetition, t.outcome, t.detail, lower(hex(t.content_hash)) AS content_hash,
         campaign.seed, campaign.build, t.host, t.pid, t.attempts,
         strftime('%Y-%m-%dT%H:%M:%fZ', t.started_us / 1e6, 'unixepoch') AS started,
         strftime('%Y-%m-%dT%H:%M:%fZ', t.started_us / 1e6 + t.duration_ns / 1e9, 'unixepoch') AS finished,
         t.duration_ns / 1e9 AS duration_s
  FROM campaign, trial t JOIN cell ON cell.id = t.cell ORDER BY t.id;
CREATE VIEW metrics AS
  SELECT cell.name AS cell, t.repetition, name.text AS name,
         CASE typeof(m.value) WHEN 'blob' THEN NULL ELSE m.value END AS value
  FROM trial t JOIN cell ON cell.id = t.cell JOIN metric m ON m.trial = t.id JOIN name ON name.id = m.name
  ORDER BY t.id, m.position;
CREATE VIEW scalars AS
  SELECT cell.name AS cell, name.text AS name, s.n, s.mean,
         CASE WHEN s.n > 1 THEN sqrt(max(0.0, s.square - s.mean * s.mean) * s.n / (s.n - 1)) END
           AS standard_deviation,
         s.smallest, s.largest
  FROM (SELECT trial >> 40 AS cell, name, count(*) AS n, avg(value) AS mean, avg(value * value) AS square,
               min(value) AS smallest, max(value) AS largest
        FROM metric WHERE typeof(value) <> 'blob' GROUP BY trial >> 40, name) s
  JOIN cell ON cell.id = s.cell JOIN name ON name.id = s.name ORDER BY s.cell, s.name;
CREATE VIEW arrays AS
  SELECT cell.name AS cell, t.repetition, name.text AS name, length(a.data) / 8 AS count, a.data
  FROM trial t JOIN cell ON cell.id = t.cell JOIN array a ON a.trial = t.id JOIN name ON name.id = a.name
  ORDER BY t.id, a.position;
CREATE VIEW outcomes AS
  SELECT cell.name AS cell, o.outcome, o.trials
  FROM (SELECT cell, outcome, count(*) AS trials FROM trial GROUP BY cell, outcome) o
  JOIN cell ON cell.id = o.cell ORDER BY o.cell, o.outcome;
CREATE VIEW cells AS
  SELECT cell.name AS cell, cell.repetitions, count(t.id) AS stored,
         coalesce(sum(t.outcome = 'ok'), 0) AS ok, avg(t.duration_ns) / 1e9 AS mean_trial_s
  FROM cell LEFT JOIN trial t ON t.cell = cell.id GROUP BY cell.id ORDER BY cell.id;
CREATE VIEW failures AS
  SELECT cell.name AS cell, t.repetition, t.outcome, t.detail
  FROM trial t JOIN cell ON cell.id = t.cell WHERE t.outcome <> 'ok' ORDER BY t.id;
CREATE VIEW stops AS
  SELECT cell.name AS cell, s.repetitions, s.metric, s.level, s.mean, s.low, s.high
  FROM stop s JOIN cell ON cell.id = s.cell ORDER BY s.cell;
CREATE VIEW provenance AS
  SELECT cell.name AS cell, t.repetition, campaign.seed, campaign.build, t.attempts, t.host, t.pid,
         strftime('%Y-%m-%dT%H:%M:%fZ', t.started_us / 1e6, 'unixepoch') AS started,
         strftime('%Y-%m-%dT%H:%M:%fZ', t.started_us / 1e6 + t.duration_ns / 1e9, 'unixepoch') AS finished,
         lower(hex(t.content_hash)) AS content_hash,
         (SELECT json_group_object(substr(name.text, 6), m.value) FROM metric m JOIN name ON name.id = m.name
          WHERE m.trial = t.id AND name.text GLOB 'draw.*' AND typeof(m.value) <> 'blob') AS drawn
  FROM trial t JOIN cell ON cell.id = t.cell, campaign ORDER BY t.id;
CREATE VIEW history AS SELECT at, what, detail FROM event ORDER BY id;
)sql";

// Four bits of the little-endian double whose hexadecimal digits are h.value; `digit` counts from 1.
std::string bits(int digit) {
  return "instr('123456789ABCDEF', substr(h.value, " + std::to_string(digit) + ", 1))";
}

std::string shifted(int digit, int shift) { return "(" + bits(digit) + " << " + std::to_string(shift) + ")"; }

// IEEE 754: (-1)^s (1 + m 2^-52) 2^(e - 1023); e = 0: m 2^-52 2^-1022; e = 2047: infinity, or NaN, here NULL.
// Every product is exact, so that the value is the very double that was stored.
std::string double_of_digits() {
  const std::string sign = "(1 - 2 * (" + bits(15) + " > 7))";
  const std::string exponent = "(((" + bits(15) + " & 7) << 8) | " + shifted(16, 4) + " | " + bits(13) + ")";
  std::string mantissa = "(" + shifted(14, 48);
  for (int byte = 0; byte < 6; ++byte)
    mantissa += " | " + shifted(2 * byte + 1, 8 * byte + 4) + " | " + shifted(2 * byte + 2, 8 * byte);
  mantissa += ")";
  return sign + " * CASE " + exponent + " WHEN 2047 THEN CASE WHEN " + mantissa +
         " = 0 THEN 9e999 END WHEN 0 THEN " + mantissa + " * pow(2, -52) * pow(2, -1022) ELSE (" + mantissa +
         " + 4503599627370496) * pow(2, -52) * pow(2, " + exponent + " - 1023) END";
}

// json_each() of one text stands for a variable: SQLite would take the digits out of the blob once for every
// use of them.
std::string elements_view() {
  return R"sql(
CREATE VIEW elements AS
  WITH RECURSIVE place (position) AS (
    SELECT 0 UNION ALL
    SELECT position + 1 FROM place WHERE position + 1 < (SELECT max(length(data)) / 8 FROM array))
  SELECT a.trial, cell.name AS cell, a.trial & 1099511627775 AS repetition, name.text AS name, place.position,
         )sql" +
         double_of_digits() + R"sql( AS value
  FROM array a JOIN name ON name.id = a.name JOIN cell ON cell.id = a.trial >> 40
  JOIN place ON place.position < length(a.data) / 8
  JOIN json_each(json_array(hex(substr(a.data, 8 * place.position + 1, 8)))) h;
)sql";
}

// Of studies whose rows hold the arrays error_re, error_im, variance and bias (docs/schema.md). The quantile
// of F(2, 2q) has a closed form, q ((1 - p)^(-1/q) - 1).
constexpr const char* kEstimateViews = R"sql(
CREATE VIEW errors AS
  SELECT trial, cell, repetition, position,
         max(CASE name WHEN 'error_re' THEN value END) AS error_re,
         max(CASE name WHEN 'error_im' THEN value END) AS error_im,
         max(CASE name WHEN 'variance' THEN value END) AS variance,
         max(CASE name WHEN 'bias' THEN value END) AS bias
  FROM elements WHERE name IN ('error_re', 'error_im', 'variance', 'bias')
  GROUP BY trial, position ORDER BY trial, position;
CREATE VIEW bias AS
  WITH shape AS (
    SELECT m.trial >> 40 AS cell, max(CASE name.text WHEN 'elements_per_line' THEN value END) AS elements,
           max(CASE name.text WHEN 'inputs' THEN value END) AS inputs
    FROM metric m JOIN name ON name.id = m.name WHERE name.text IN ('elements_per_line', 'inputs') GROUP BY 1),
  mean AS (
    SELECT e.trial >> 40 AS id, e.cell, position, count(*) AS trials, avg(error_re) AS re, avg(error_im) AS im,
           avg(error_re * error_re + error_im * error_im) AS square, avg(variance) AS variance,
           avg(bias) AS estimated
    FROM errors e JOIN trial t ON t.id = e.trial WHERE t.outcome = 'ok' GROUP BY 1, position)
  SELECT mean.cell, CAST(position / elements AS INTEGER) AS line,
         CAST(position % CAST(elements AS INTEGER) / CAST(inputs AS INTEGER) AS INTEGER) AS output,
         position % CAST(inputs AS INTEGER) AS input, trials, re AS error_re, im AS error_im,
         sqrt(re * re + im * im) AS error_abs,
         CASE WHEN trials > 1 THEN sqrt(max(0.0, square - re * re - im * im) / (trials - 1)) END
           AS standard_error,
         estimated AS mean_estimated_bias, sqrt(variance) AS estimated_standard_deviation
  FROM mean LEFT JOIN shape ON shape.cell = mean.id ORDER BY mean.id, position;
CREATE VIEW coverage_of_trials AS
  WITH level (p) AS (VALUES (0.75), (0.90), (0.95), (0.99)),
  limits AS (
    SELECT m.trial, p, m.value * (pow(1 - p, -1.0 / m.value) - 1) AS f
    FROM metric m JOIN name ON name.id = m.name JOIN level WHERE name.text = 'degrees_of_freedom')
  SELECT e.trial, e.cell, e.repetition, l.p AS level,
         avg((error_re * error_re + error_im * error_im) / variance <= f) AS plain,
         avg(pow(max(0.0, sqrt(error_re * error_re + error_im * error_im) - bias), 2) / variance <= f)
           AS extended,
         avg(pow(sqrt(error_re * error_re + error_im * error_im) - bias, 2) / variance <= f)
           AS extended_as_printed
  FROM errors e JOIN trial t ON t.id = e.trial JOIN limits l ON l.trial = e.trial
  WHERE t.outcome = 'ok' GROUP BY e.trial, l.p ORDER BY e.trial, l.p;
CREATE VIEW coverage AS
  WITH total AS (SELECT cell, count(*) AS trials FROM trial GROUP BY cell),
  share AS (
    SELECT trial >> 40 AS id, cell, level, sum(plain) AS p1, sum(plain * plain) AS p2, sum(extended) AS e1,
           sum(extended * extended) AS e2, sum(extended_as_printed) AS l1,
           sum(extended_as_printed * extended_as_printed) AS l2
    FROM coverage_of_trials GROUP BY 1, level)
  SELECT share.cell, level, trials, p1 / trials AS plain,
         sqrt(max(0.0, p2 / trials - pow(p1 / trials, 2)) / (trials - 1)) AS plain_standard_error,
         e1 / trials AS extended,
         sqrt(max(0.0, e2 / trials - pow(e1 / trials, 2)) / (trials - 1)) AS extended_standard_error,
         l1 / trials AS extended_as_printed,
         sqrt(max(0.0, l2 / trials - pow(l1 / trials, 2)) / (trials - 1)) AS extended_as_printed_standard_error
  FROM share JOIN total ON total.cell = share.id ORDER BY share.id, level;
CREATE VIEW csl AS
  WITH total AS (SELECT cell, count(*) AS trials FROM trial GROUP BY cell),
  p AS (
    SELECT m.trial >> 40 AS id, name.text AS name, value,
           row_number() OVER (PARTITION BY m.trial >> 40, m.name ORDER BY value) AS place,
           count(*) OVER (PARTITION BY m.trial >> 40, m.name) AS n
    FROM metric m JOIN name ON name.id = m.name
    WHERE name.text IN ('p_band_hinf', 'p_band_ssv', 'p_total_hinf', 'p_total_ssv')
      AND typeof(value) <> 'blob')
  SELECT cell.name AS cell, p.name, trials, n, avg(value) AS mean, min(value) AS smallest,
         max(CASE WHEN place = (n + 3) / 4 THEN value END) AS quarter,
         max(CASE WHEN place = (n + 1) / 2 THEN value END) AS median,
         1.0 * sum(value > 0.9) / trials AS share_above_90, 1.0 * sum(value > 0.99) / trials AS share_above_99,
         1.0 * sum(value = 0) / trials AS share_zero
  FROM p JOIN total ON total.cell = p.id JOIN cell ON cell.id = p.id
  GROUP BY p.id, p.name ORDER BY p.id, p.name;
)sql";

}  // namespace

std::string views_sql() { return kPlainViews + elements_view() + kEstimateViews; }

}  // namespace fatmc
