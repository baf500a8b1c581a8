#include "coordinator/input/toml_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fatmc {
namespace {

Result<Tree> convert(const toml::node& node, const std::string& file) {
  Tree tree;
  tree.file = file;
  tree.line = static_cast<int>(node.source().begin.line);
  if (const auto* table = node.as_table()) {
    // toml++ sorts keys; the order of the file is that of the source lines.
    std::vector<std::pair<std::string, const toml::node*>> entries;
    for (const auto& [key, value] : *table) entries.emplace_back(std::string(key.str()), &value);
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
      const auto& x = a.second->source().begin;
      const auto& y = b.second->source().begin;
      return std::pair(x.line, x.column) < std::pair(y.line, y.column);
    });
    Tree::Table out;
    for (const auto& [key, value] : entries) {
      Result<Tree> entry = convert(*value, file);
      if (!entry) return entry;
      out.entries.emplace_back(key, std::move(*entry));
    }
    tree.value = std::move(out);
  } else if (const auto* array = node.as_array()) {
    Tree::Array out;
    for (const toml::node& item : *array) {
      Result<Tree> entry = convert(item, file);
      if (!entry) return entry;
      out.items.push_back(std::move(*entry));
    }
    tree.value = std::move(out);
  } else if (const auto* text = node.as_string()) {
    tree.value = text->get();
  } else if (const auto* number = node.as_floating_point()) {
    tree.value = number->get();
  } else if (const auto* integer = node.as_integer()) {
    tree.value = integer->get();
  } else if (const auto* flag = node.as_boolean()) {
    tree.value = flag->get();
  } else {
    return fail(Error{file, tree.line, "", "holds a date or time, write a string, number, list or table"});
  }
  return tree;
}

// Keys whose string is the name of a file to put in its place.
bool names_file(std::string_view key) { return key == "model" || key == "experiment" || key == "published"; }

Status resolve(Tree& tree, int depth);

Status resolve_entry(const std::string& key, Tree& entry, int depth) {
  if (!names_file(key) || entry.table() != nullptr) return resolve(entry, depth);
  const auto* name = std::get_if<std::string>(&entry.value);
  if (name == nullptr) {
    return fail(Error{entry.file, entry.line, key,
                      "is " + with_article(kind_name(entry)) + ", write a file name in quotes"});
  }
  const auto path = std::filesystem::path(entry.file).parent_path() / *name;
  if (depth > 8) return fail(Error{entry.file, entry.line, key, "files name each other in a circle"});
  std::error_code error;
  const auto kind = std::filesystem::status(path, error).type();
  if (kind == std::filesystem::file_type::directory || !std::ifstream(path)) {
    const char* what = kind == std::filesystem::file_type::not_found   ? "no file \""
                       : kind == std::filesystem::file_type::directory ? "names the folder \""
                                                                       : "cannot read \"";
    return fail(Error{
        entry.file, entry.line, key,
        what + path.lexically_normal().string() + "\", write the path of a file relative to this file"});
  }
  Result<Tree> file = read_toml(path.lexically_normal().string());
  if (!file) return fail(file.error());
  entry = std::move(*file);
  return resolve(entry, depth + 1);
}

Status resolve(Tree& tree, int depth) {
  if (auto* table = std::get_if<Tree::Table>(&tree.value)) {
    for (auto& [key, entry] : table->entries) {
      if (Status status = resolve_entry(key, entry, depth); !status) return status;
    }
  } else if (auto* array = std::get_if<Tree::Array>(&tree.value)) {
    for (Tree& item : array->items) {
      if (Status status = resolve(item, depth); !status) return status;
    }
  }
  return {};
}

}  // namespace

Result<Tree> read_toml(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::error_code error;
  if (!in || std::filesystem::is_directory(path, error)) {
    return fail(Error{path, 0, "", "cannot be read, name a TOML file that exists"});
  }
  std::ostringstream text;
  text << in.rdbuf();
  try {
    const toml::table table = toml::parse(text.str(), path);
    return convert(table, path);
  } catch (const toml::parse_error& e) {
    return fail(Error{path, static_cast<int>(e.source().begin.line), "", std::string(e.description())});
  }
}

Result<Tree> read_toml_resolved(const std::string& path) {
  Result<Tree> tree = read_toml(path);
  if (!tree) return tree;
  if (Status status = resolve(*tree, 0); !status) return fail(status.error());
  return tree;
}

}  // namespace fatmc
