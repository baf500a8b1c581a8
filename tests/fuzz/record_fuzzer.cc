// Records: the roles (TOML), a line "===", the samples (CSV).
#include <cstdint>

#include "coordinator/input/record_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fatmc;
  static InputFile toml, csv;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  constexpr std::string_view kMark = "===\n";
  const std::size_t mark = text.find(kMark);
  toml.fill(text.substr(0, mark));
  csv.fill(mark == std::string_view::npos ? std::string_view() : text.substr(mark + kMark.size()));
  Result<Record> record = read_record(csv.path(), toml.path());
  if (!record) {
    check_error(record.error().text());
    return 0;
  }
  const Status complete = complete_period(*record, "input");
  if (!complete) check_error(complete.error().text());
  return 0;
}
