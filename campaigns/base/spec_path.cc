#include "campaigns/base/spec_path.h"

#include <algorithm>
#include <charconv>

#include "core/base/check.h"

namespace fatmc {
namespace {

// Splits the first component off.
std::string_view take_component(std::string_view& path) {
  const std::size_t dot = path.find('.');
  const std::string_view head = path.substr(0, dot);
  path = dot == std::string_view::npos ? std::string_view() : path.substr(dot + 1);
  return head;
}

// The element that a component names, from 0, or the size when there is none.
std::size_t element(const Tree::Array& array, std::string_view component) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(component.data(), component.data() + component.size(), number);
  const bool whole = error == std::errc() && end == component.data() + component.size();
  return whole && number >= 1 && number <= array.items.size() ? number - 1 : array.items.size();
}

}  // namespace

const Tree* find_at(const Tree& tree, std::string_view path) {
  const Tree* here = &tree;
  while (!path.empty() && here != nullptr) {
    const std::string_view head = take_component(path);
    if (const auto* array = here->array()) {
      const std::size_t i = element(*array, head);
      here = i < array->items.size() ? &array->items[i] : nullptr;
    } else {
      here = here->find(head);
    }
  }
  return here;
}

Status set_at(Tree& tree, std::string_view path, const Tree& value) {
  FATMC_CHECK(is_path(path), "a path");
  const std::string full(path);
  Tree* here = &tree;
  while (!path.empty()) {
    const std::string_view head = take_component(path);
    const std::string passed = full.substr(0, full.size() - path.size() - (path.empty() ? 0 : 1));
    if (auto* array = std::get_if<Tree::Array>(&here->value)) {
      const std::size_t i = element(*array, head);
      if (i == array->items.size()) {
        return fail(Error{value.file, value.line, full,
                          "\"" + passed + "\" names no element, write a number from 1 to " +
                              std::to_string(array->items.size())});
      }
      here = &array->items[i];
    } else if (auto* table = std::get_if<Tree::Table>(&here->value)) {
      Tree* next = nullptr;
      for (auto& [name, entry] : table->entries) {
        if (name == head) next = &entry;
      }
      if (next == nullptr) {
        table->entries.emplace_back(std::string(head), Tree{Tree::Table{}, value.file, value.line});
        next = &table->entries.back().second;
      }
      here = next;
    } else {
      const std::string before =
          full.substr(0, passed.size() - head.size() - (passed.size() > head.size() ? 1 : 0));
      return fail(Error{value.file, value.line, full,
                        "\"" + before + "\" is " + with_article(kind_name(*here)) + " and has no entry \"" +
                            std::string(head) + "\""});
    }
  }
  *here = value;
  return {};
}

std::string last_component(std::string_view path) {
  return std::string(path.substr(path.rfind('.') == std::string_view::npos ? 0 : path.rfind('.') + 1));
}

bool is_path(std::string_view path) {
  if (path.empty()) return false;
  while (!path.empty()) {
    const bool more = path.find('.') != std::string_view::npos;
    if (take_component(path).empty() || (more && path.empty())) return false;
  }
  return true;
}

bool is_of_engine(std::string_view path) {
  const std::string_view head = take_component(path);
  const auto among = [](const auto& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (head != "cell") return head == "campaign" || head == "published" || among(kEngineTables, head);
  const std::string_view key = take_component(path);
  return key.empty() || key == "name" || key == "repetitions" || among(kEngineCellKeys, key);
}

}  // namespace fatmc
