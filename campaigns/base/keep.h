// What of a trial its row holds.
//
//   [keep]
//   arrays = true            # per-line arrays; false: metrics alone
//   records = "none"         # "failures": the flight of a trial that is not ok; "all"
//
// Records stand among the arrays of the row as "record.t", "record.p" ...: 13 channels of 8 bytes a sample.
// What is not kept can be had again from `fatmc replay`. Part of the campaign's identity, since it changes
// rows.
#pragma once

#include "campaigns/base/tree.h"
#include "core/base/error.h"

namespace fatmc {

struct Keep {
  enum class Records { none, failures, all };
  bool arrays = true;
  Records records = Records::none;
};

Result<Keep> decode_keep(const Tree& spec);

/// Channels of a record stand in a row as arrays of this prefix.
inline constexpr const char* kRecordPrefix = "record.";

}  // namespace fatmc
