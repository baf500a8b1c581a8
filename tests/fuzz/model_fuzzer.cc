// Model files of aircraft.
#include <cstdint>

#include "campaigns/base/aircraft_model.h"
#include "coordinator/input/toml_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fatmc;
  static InputFile file;
  file.fill({reinterpret_cast<const char*>(data), size});
  const Result<Tree> tree = read_toml(file.path());
  if (!tree) {
    check_error(tree.error().text());
    return 0;
  }
  const Result<AircraftModel> model = decode_aircraft_model(*tree);
  if (!model) check_error(model.error().text());
  return 0;
}
