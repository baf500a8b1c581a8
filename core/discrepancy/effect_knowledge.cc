#include "core/discrepancy/effect_knowledge.h"
namespace fatmc {
std::string separating_experiment(const std::vector<std::string>&) { return ""; }
}
