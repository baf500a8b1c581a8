// What an effect looks like, what it is mistaken for, and what would tell the two apart.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fatmc {

struct EffectKnowledge {
  std::string_view id;
  std::string_view signature;
  std::vector<std::string_view> confusable;  ///< ids
  std::string_view separated_by;
};

const std::vector<EffectKnowledge>& effect_knowledge();
/// Null for an id without an entry.
const EffectKnowledge* find_knowledge(std::string_view id);
/// Aerodynamic derivatives of the linear airframe: control effectiveness, inertia, mass and geometry are none.
bool is_derivative(std::string_view id);
/// The experiment that would separate effects of these ids, one sentence.
std::string separating_experiment(const std::vector<std::string>& ids);

}  // namespace fatmc
