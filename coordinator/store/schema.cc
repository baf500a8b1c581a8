#include "coordinator/store/schema.h"

namespace fatmc {

const char* const kTablesSql = R"sql(
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
) STRICT;
CREATE TABLE cell (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  repetitions INTEGER NOT NULL
) STRICT;
CREATE TABLE name (
  id INTEGER PRIMARY KEY,
  text TEXT NOT NULL UNIQUE
) STRICT;
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
) STRICT;
CREATE TABLE metric (
  trial INTEGER NOT NULL,
  position INTEGER NOT NULL,
  name INTEGER NOT NULL,
  value ANY,
  PRIMARY KEY (trial, position)
) STRICT, WITHOUT ROWID;
CREATE TABLE array (
  trial INTEGER NOT NULL,
  position INTEGER NOT NULL,
  name INTEGER NOT NULL,
  data BLOB NOT NULL,
  PRIMARY KEY (trial, position)
) STRICT;
CREATE TABLE event (
  id INTEGER PRIMARY KEY,
  at TEXT NOT NULL,
  what TEXT NOT NULL,
  detail TEXT NOT NULL
) STRICT;
)sql";

const char* const kControlSql = R"sql(
CREATE TABLE IF NOT EXISTS control (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  paused INTEGER NOT NULL
) STRICT;
CREATE TABLE IF NOT EXISTS stop (
  cell INTEGER PRIMARY KEY REFERENCES cell (id),
  repetitions INTEGER NOT NULL,
  metric TEXT NOT NULL,
  level REAL NOT NULL,
  mean REAL NOT NULL,
  low REAL NOT NULL,
  high REAL NOT NULL
) STRICT;
CREATE TABLE IF NOT EXISTS in_flight (
  cell INTEGER NOT NULL REFERENCES cell (id),
  first INTEGER NOT NULL,
  last INTEGER NOT NULL,
  missing INTEGER NOT NULL,
  attempts INTEGER NOT NULL,
  host TEXT NOT NULL,
  pid INTEGER NOT NULL,
  held_s REAL NOT NULL,
  reported TEXT NOT NULL
) STRICT;
)sql";

}  // namespace fatmc
