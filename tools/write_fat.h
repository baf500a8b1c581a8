// fat.toml as text: values of a fitted aircraft with their meaning.
#pragma once

#include <string>

#include "core/flight/aircraft.h"

namespace fatmc::fit {

std::string fat_toml(const Aircraft& aircraft);

}  // namespace fatmc::fit
