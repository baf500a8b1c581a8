// The schema of version 1, word for word as the program of that time wrote it.
#pragma once

namespace fatmc {

inline constexpr const char* kSchema1Sql = R"sql(
CREATE TABLE campaign (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  name TEXT NOT NULL,
  study TEXT NOT NULL,
  seed INTEGER NOT NULL,
  identity TEXT NOT NULL,
  build TEXT NOT NULL,
  spec_canonical TEXT NOT NULL,
  spec BLOB NOT NULL,
  created TEXT NOT NULL
);
CREATE TABLE cell (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  repetitions INTEGER NOT NULL
);
CREATE TABLE name (
  id INTEGER PRIMARY KEY,
  text TEXT NOT NULL UNIQUE
);
CREATE TABLE trial (
  id INTEGER PRIMARY KEY,
  cell INTEGER NOT NULL REFERENCES cell (id),
  repetition INTEGER NOT NULL,
  outcome TEXT NOT NULL,
  detail TEXT NOT NULL,
  content_hash BLOB NOT NULL,
  host TEXT NOT NULL,
  pid INTEGER NOT NULL,
  attempts INTEGER NOT NULL,
  started_us INTEGER NOT NULL,
  duration_ns INTEGER NOT NULL
);
CREATE TABLE metric (
  trial INTEGER NOT NULL,
  position INTEGER NOT NULL,
  name INTEGER NOT NULL,
  value,
  PRIMARY KEY (trial, position)
) WITHOUT ROWID;
CREATE TABLE array (
  trial INTEGER NOT NULL,
  position INTEGER NOT NULL,
  name INTEGER NOT NULL,
  data BLOB NOT NULL,
  PRIMARY KEY (trial, position)
);
CREATE VIEW trials AS
  SELECT cell.name AS cell, t.repetition, t.outcome, t.detail, lower(hex(t.content_hash)) AS content_hash,
         t.host, t.pid, t.attempts,
         strftime('%Y-%m-%dT%H:%M:%fZ', t.started_us / 1e6, 'unixepoch') AS started,
         strftime('%Y-%m-%dT%H:%M:%fZ', t.started_us / 1e6 + t.duration_ns / 1e9, 'unixepoch') AS finished,
         t.duration_ns / 1e9 AS duration_s
  FROM trial t JOIN cell ON cell.id = t.cell ORDER BY t.id;
CREATE VIEW metrics AS
  SELECT cell.name AS cell, t.repetition, name.text AS name,
         CASE typeof(m.value) WHEN 'blob' THEN NULL ELSE m.value END AS value
  FROM trial t JOIN cell ON cell.id = t.cell JOIN metric m ON m.trial = t.id JOIN name ON name.id = m.name
  ORDER BY t.id, m.position;
CREATE VIEW arrays AS
  SELECT cell.name AS cell, t.repetition, name.text AS name, length(a.data) / 8 AS count, a.data
  FROM trial t JOIN cell ON cell.id = t.cell JOIN array a ON a.trial = t.id JOIN name ON name.id = a.name
  ORDER BY t.id, a.position;
CREATE VIEW outcomes AS
  SELECT cell.name AS cell, t.outcome, count(*) AS trials
  FROM trial t JOIN cell ON cell.id = t.cell GROUP BY t.cell, t.outcome ORDER BY t.cell, t.outcome;
CREATE VIEW cells AS
  SELECT cell.name AS cell, cell.repetitions, count(t.id) AS stored,
         coalesce(sum(t.outcome = 'ok'), 0) AS ok, avg(t.duration_ns) / 1e9 AS mean_trial_s
  FROM cell LEFT JOIN trial t ON t.cell = cell.id GROUP BY cell.id ORDER BY cell.id;
CREATE VIEW failures AS
  SELECT cell.name AS cell, t.repetition, t.outcome, t.detail
  FROM trial t JOIN cell ON cell.id = t.cell WHERE t.outcome <> 'ok' ORDER BY t.id;
)sql";

}  // namespace fatmc
