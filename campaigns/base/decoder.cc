#include "campaigns/base/decoder.h"

#include <algorithm>
#include <cmath>

#include "core/base/text.h"

namespace fatmc {
namespace {

std::string allowed(RealRange range) {
  const bool low = range.low > -std::numeric_limits<double>::max();
  const bool high = range.high < std::numeric_limits<double>::max();
  if (low && high) return "write a value between " + shortest(range.low) + " and " + shortest(range.high);
  if (low) return "write a value of at least " + shortest(range.low);
  if (high) return "write a value of at most " + shortest(range.high);
  return "write a finite number";
}

std::string allowed(IntegerRange range) {
  const bool low = range.low > std::numeric_limits<std::int64_t>::min();
  const bool high = range.high < std::numeric_limits<std::int64_t>::max();
  if (low && high)
    return "write an integer from " + std::to_string(range.low) + " to " + std::to_string(range.high);
  if (low) return "write an integer of at least " + std::to_string(range.low);
  if (high) return "write an integer of at most " + std::to_string(range.high);
  return "write an integer";
}

}  // namespace

Decoder::Decoder(const Tree& tree, std::string path) : tree_(&tree), path_(std::move(path)) {
  if (tree.table() == nullptr) {
    error_ = Error{tree.file, tree.line, path_, "is " + with_article(kind_name(tree)) + ", write a table"};
  }
}

std::string Decoder::name(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void Decoder::skip(std::string_view key) { known_.emplace_back(key); }

bool Decoder::has(std::string_view key) {
  skip(key);
  return tree_->find(key) != nullptr;
}

const Tree* Decoder::get(std::string_view key, bool required) {
  known_.emplace_back(key);
  if (error_) return nullptr;
  const Tree* entry = tree_->find(key);
  if (entry == nullptr && required) {
    error_ = Error{tree_->file, tree_->line, name(key), "is missing"};
  }
  return entry;
}

void Decoder::reject(std::string_view key, std::string message) {
  if (error_) return;
  const Tree* entry = tree_->find(key);
  error_ = Error{tree_->file, entry != nullptr ? entry->line : tree_->line, name(key), std::move(message)};
}

void Decoder::wrong_kind(std::string_view key, const Tree& entry, std::string_view wanted) {
  reject(key, "is " + with_article(kind_name(entry)) + ", write " + std::string(wanted));
}

double Decoder::real(std::string_view key, RealRange range, std::optional<double> fallback) {
  const Tree* entry = get(key, !fallback);
  if (entry == nullptr) return fallback.value_or(0.0);
  const std::optional<double> number = real_value(*entry);
  if (!number) {
    wrong_kind(key, *entry, "a number");
    return 0.0;
  }
  if (!std::isfinite(*number) || *number < range.low || *number > range.high) {
    reject(key, shortest(*number) + " is out of range, " + allowed(range));
  }
  return *number;
}

std::int64_t Decoder::integer(std::string_view key, IntegerRange range,
                              std::optional<std::int64_t> fallback) {
  const Tree* entry = get(key, !fallback);
  if (entry == nullptr) return fallback.value_or(range.low > 0 ? range.low : 0);
  const auto* number = std::get_if<std::int64_t>(&entry->value);
  if (number == nullptr) {
    wrong_kind(key, *entry, "an integer");
    return 0;
  }
  if (*number < range.low || *number > range.high) {
    reject(key, std::to_string(*number) + " is out of range, " + allowed(range));
  }
  return *number;
}

bool Decoder::boolean(std::string_view key, std::optional<bool> fallback) {
  const Tree* entry = get(key, !fallback);
  if (entry == nullptr) return fallback.value_or(false);
  const auto* flag = std::get_if<bool>(&entry->value);
  if (flag == nullptr) {
    wrong_kind(key, *entry, "true or false");
    return false;
  }
  return *flag;
}

std::string Decoder::text(std::string_view key, std::optional<std::string> fallback) {
  const Tree* entry = get(key, !fallback);
  if (entry == nullptr) return fallback.value_or("");
  const auto* text = std::get_if<std::string>(&entry->value);
  if (text == nullptr) {
    wrong_kind(key, *entry, "a string");
    return "";
  }
  return *text;
}

std::string Decoder::choice(std::string_view key, const std::vector<std::string>& choices,
                            std::optional<std::string> fallback) {
  const std::string value = text(key, fallback);
  if (!error_ && std::find(choices.begin(), choices.end(), value) == choices.end()) {
    reject(key, "\"" + value + "\" is not known, write one of: " + join(choices));
  }
  return value;
}

std::vector<double> Decoder::reals(std::string_view key, std::size_t count, RealRange range,
                                   std::optional<std::vector<double>> fallback) {
  const Tree* entry = get(key, !fallback);
  std::vector<double> values(count, 0.0);
  if (entry == nullptr) return error_ ? values : fallback.value_or(values);
  const auto* array = entry->array();
  if (array == nullptr) {
    wrong_kind(key, *entry, "a list of numbers");
    return values;
  }
  std::vector<double> out;
  for (const Tree& item : array->items) {
    const std::optional<double> number = real_value(item);
    if (!number) {
      reject(key, "holds " + with_article(kind_name(item)) + ", write a list of numbers");
      return values;
    }
    if (!std::isfinite(*number) || *number < range.low || *number > range.high) {
      reject(key, shortest(*number) + " is out of range, " + allowed(range));
      return values;
    }
    out.push_back(*number);
  }
  if (count > 0 && out.size() != count) {
    reject(key, "has " + std::to_string(out.size()) + " numbers, write " + std::to_string(count));
    return values;
  }
  return out;
}

std::vector<std::string> Decoder::texts(std::string_view key,
                                        std::optional<std::vector<std::string>> fallback) {
  const Tree* entry = get(key, !fallback);
  if (entry == nullptr) return fallback.value_or(std::vector<std::string>{});
  const auto* array = entry->array();
  std::vector<std::string> out;
  if (array != nullptr) {
    for (const Tree& item : array->items) {
      if (const auto* text = std::get_if<std::string>(&item.value)) out.push_back(*text);
    }
  }
  if (array == nullptr || out.size() != array->items.size()) {
    wrong_kind(key, *entry, "a list of strings");
    return {};
  }
  return out;
}

std::vector<std::vector<double>> Decoder::matrix(std::string_view key, std::size_t rows, std::size_t columns,
                                                 RealRange range) {
  std::vector<std::vector<double>> zero(rows, std::vector<double>(columns, 0.0));
  const Tree* entry = get(key, true);
  if (entry == nullptr) return zero;
  const std::string shape = "write " + (rows > 0 ? std::to_string(rows) + " " : std::string()) + "rows of " +
                            std::to_string(columns) + " numbers, [[..], [..]]";
  const auto* array = entry->array();
  if (array == nullptr || array->items.empty() || (rows > 0 && array->items.size() != rows)) {
    reject(key, "is not such a matrix, " + shape);
    return zero;
  }
  std::vector<std::vector<double>> out;
  for (const Tree& row : array->items) {
    const auto* items = row.array();
    if (items == nullptr || items->items.size() != columns) {
      reject(key, "is not such a matrix, " + shape);
      return zero;
    }
    out.emplace_back();
    for (const Tree& item : items->items) {
      const std::optional<double> number = real_value(item);
      if (!number || !std::isfinite(*number) || *number < range.low || *number > range.high) {
        reject(key, "holds a wrong element, " + allowed(range));
        return zero;
      }
      out.back().push_back(*number);
    }
  }
  return out;
}

const Tree* Decoder::table(std::string_view key, bool required) {
  const Tree* entry = get(key, required);
  if (entry != nullptr && entry->table() == nullptr) {
    wrong_kind(key, *entry, "a table");
    return nullptr;
  }
  return entry;
}

std::vector<const Tree*> Decoder::tables(std::string_view key, bool required) {
  const Tree* entry = get(key, required);
  if (entry == nullptr) return {};
  std::vector<const Tree*> out;
  if (const auto* array = entry->array()) {
    for (const Tree& item : array->items) {
      if (item.table() != nullptr) out.push_back(&item);
    }
    if (out.size() == array->items.size() && !out.empty()) return out;
  }
  wrong_kind(key, *entry, "one or more tables [[" + name(key) + "]]");
  return {};
}

void Decoder::take(const Status& status) {
  if (!error_ && !status) error_ = status.error();
}

Status Decoder::finish() {
  if (!error_) {
    for (const auto& [key, entry] : tree_->table()->entries) {
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      std::vector<std::string> sorted = known_;
      std::sort(sorted.begin(), sorted.end());
      sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());  // asked for more than once
      error_ =
          Error{entry.file, entry.line, name(key), "is not a known key, the keys here are: " + join(sorted)};
      break;
    }
  }
  if (error_) return fail(*error_);
  return {};
}

}  // namespace fatmc
