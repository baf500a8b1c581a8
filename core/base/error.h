// Bad input as a value: which file, which line, which key, what is wrong and what to write instead.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace fatmc {

struct Error {
  std::string file;     ///< as the user named it; empty when the input is not a file
  int line = 0;         ///< from 1; 0 when the input has no lines
  std::string key;      ///< dotted path inside the file, or the name of an option; may be empty
  std::string message;  ///< what is wrong, and the remedy or the allowed values

  /// One line: "file:line: key: message", leaving out what is unknown.
  [[nodiscard]] std::string text() const;
};

template <typename T>
using Result = tl::expected<T, Error>;

using Status = tl::expected<void, Error>;

inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

/// An error without a place in a file.
tl::unexpected<Error> fail(std::string message);

}  // namespace fatmc
