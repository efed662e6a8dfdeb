// SPDX-License-Identifier: MIT
#include "tb/stimuli/weight_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>

#include "spec/error.h"
#include "tb/base/file.h"

namespace deburr::tb::stimuli {
namespace {

using golden::morphological::WeightTables;

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

// Calls `visit` with each table and its name, in file order.
template <class Tables, class Visit>
void each_table(Tables& tables, const Visit& visit) {
  visit("codes", tables.of_codes);
  visit("near", tables.of_near);
  visit("far", tables.of_far);
}

// Reads words line by line; "#" starts a comment.
class Reader {
 public:
  Reader(std::string_view name, std::string_view text) : name_(name), rest_(text) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw spec::FileError(
        fmt::format("cannot read the weights '{}', line {}: {}", name_, line_, reason));
  }
  // Returns an empty text at the end of the file.
  std::string_view word() {
    while (words_.empty() && !rest_.empty()) next_line();
    const std::size_t end = std::min(words_.find(' '), words_.size());
    const std::string_view found = words_.substr(0, end);
    words_.remove_prefix(end);
    skip_spaces();
    return found;
  }
  void expect(std::string_view wanted) {
    if (const std::string_view found = word(); found != wanted)
      fail(fmt::format("expected '{}', got {}", wanted, shown(found)));
  }
  std::int64_t number(std::int64_t low, std::int64_t high) {
    const std::string_view found = word();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (found.empty() || error != std::errc() || end != found.data() + found.size() ||
        value < low || value > high)
      fail(fmt::format("expected a number from {} to {}, got {}", low, high, shown(found)));
    return value;
  }

 private:
  static std::string shown(std::string_view word) {
    if (word.empty()) return "the end of the file";
    std::string text;
    for (const char c : word.substr(0, 40)) text += c >= ' ' && c < 127 ? c : '?';
    return fmt::format("'{}'{}", text, word.size() > 40 ? " ..." : "");
  }
  void next_line() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    words_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    if (words_.ends_with('\r')) words_.remove_suffix(1);
    words_ = words_.substr(0, words_.find('#'));
    skip_spaces();
  }
  void skip_spaces() {
    words_.remove_prefix(std::min(words_.find_first_not_of(' '), words_.size()));
  }

  std::string_view name_, rest_, words_;
  int line_ = 0;
};

}  // namespace

std::vector<std::int8_t> entries_of(const WeightTables& tables) {
  std::vector<std::int8_t> entries;
  each_table(tables, [&](std::string_view, const auto& table) {
    entries.insert(entries.end(), table.begin(), table.end());
  });
  return entries;
}

std::uint32_t sum_of(const WeightTables& tables) {
  std::uint32_t sum = 0, index = 0;
  for (const std::int8_t entry : entries_of(tables))
    sum += ++index * static_cast<std::uint8_t>(entry);
  return sum;
}

std::string weight_file_text(const WeightTables& tables, const std::vector<std::string>& notes) {
  std::string text = fmt::format("{}\n", kWeightFileHead);
  for (const std::string& note : notes) text += fmt::format("# {}\n", note);
  each_table(tables, [&](std::string_view name, const auto& table) {
    text += fmt::format("{} {}", name, table.size());
    for (std::size_t i = 0; i < table.size(); ++i)
      text += fmt::format("{}{}", i % 16 == 0 ? '\n' : ' ', table[i]);
    text += '\n';
  });
  return text + fmt::format("sum {}\n", sum_of(tables));
}

WeightTables parse_weight_file(std::string_view name, std::string_view text) {
  Reader reader(name, text);
  for (std::string_view rest = kWeightFileHead; !rest.empty();) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    reader.expect(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  WeightTables tables;
  each_table(tables, [&](std::string_view table_name, auto& table) {
    reader.expect(table_name);
    reader.expect(std::to_string(table.size()));
    for (std::int8_t& entry : table) entry = static_cast<std::int8_t>(reader.number(-128, 127));
  });
  reader.expect("sum");
  const std::uint32_t sum = sum_of(tables);
  if (const std::int64_t said = reader.number(0, 0xFFFFFFFF); said != sum)
    reader.fail(fmt::format("the checksum is {}, but the entries give {}: the file was changed",
                            said, sum));
  if (!reader.word().empty()) reader.fail("expected the end of the file after the checksum");
  return tables;
}

WeightTables read_weight_file(const std::filesystem::path& file) {
  return parse_weight_file(file.string(), read_file(file, kMaxBytes));
}

}  // namespace deburr::tb::stimuli
