// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/payload.h"

#include <cxxabi.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "spec/error.h"

namespace deburr::rtl {
namespace {

template <class T>
std::uint64_t load_as(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
template <class T>
void store_as(std::byte* to, std::uint64_t value) {
  const T narrow = static_cast<T>(value);
  std::memcpy(to, &narrow, sizeof narrow);
}

// Bits of a format Ua.b or Sa.b; 0 for other texts.
std::uint32_t format_bits(std::string_view format) {
  if (format.empty() || (format[0] != 'U' && format[0] != 'S')) return 0;
  const char* const end = format.data() + format.size();
  std::uint32_t whole = 0, fraction = 0;
  const auto point = std::from_chars(format.data() + 1, end, whole);
  if (point.ec != std::errc{} || point.ptr == end || *point.ptr != '.') return 0;
  const auto rest = std::from_chars(point.ptr + 1, end, fraction);
  if (rest.ec != std::errc{} || rest.ptr != end) return 0;
  return whole + fraction + (format[0] == 'S' ? 1 : 0);
}

// Loads the whole C++ integer, independent of the host's byte order.
std::uint64_t load(const std::byte* from, std::uint32_t bytes) {
  switch (bytes) {
    case 1:
      return load_as<std::uint8_t>(from);
    case 2:
      return load_as<std::uint16_t>(from);
    case 4:
      return load_as<std::uint32_t>(from);
    default:
      return load_as<std::uint64_t>(from);
  }
}
void store(std::byte* to, std::uint32_t bytes, std::uint64_t value) {
  switch (bytes) {
    case 1:
      return store_as<std::uint8_t>(to, value);
    case 2:
      return store_as<std::uint16_t>(to, value);
    case 4:
      return store_as<std::uint32_t>(to, value);
    default:
      return store_as<std::uint64_t>(to, value);
  }
}

bool parse(std::string_view text, std::uint32_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::uint64_t Field::get(const std::byte* payload) const {
  return load(payload + offset, bytes) & mask();
}

void Field::set(std::byte* payload, std::uint64_t value) const {
  value &= mask();
  if (is_signed && value >> (bits - 1)) value |= ~mask();
  store(payload + offset, bytes, value);
}

bool Field::fits(const std::byte* payload) const {
  if (bits == bytes * 8) return true;
  const std::uint64_t value = load(payload + offset, bytes);
  const std::uint64_t above = value >> bits;
  if (above == 0) return !is_signed || value >> (bits - 1) == 0;
  const std::uint64_t ones = (~std::uint64_t{0} >> (64 - bytes * 8)) >> bits;
  return is_signed && above == ones && value >> (bits - 1) & 1;
}

std::string Field::text(const std::byte* payload) const {
  const std::uint64_t value = get(payload);
  if (is_signed && value >> (bits - 1))
    return fmt::format("{}", static_cast<std::int64_t>(value | ~mask()));
  return fmt::format("{}", value);
}

namespace detail {

PayloadNode PayloadBuilder::field(std::string name, std::ptrdiff_t offset, std::size_t size,
                                  std::uint32_t bits, std::string_view format,
                                  bool is_signed) const {
  const std::string full = path_ + name;
  const std::uint32_t listed = bits;
  for (const auto& [what, narrower] : shape_.widths)
    if (full.starts_with(what) && (full.size() == what.size() || full[what.size()] == '.'))
      bits = narrower;
  DEBURR_CHECK(bits <= listed && listed != 0,
               fmt::format("{}: {} bits, expected 0..{} as listed", full, bits, listed));
  const std::uint32_t written = format_bits(format);
  DEBURR_CHECK(
      written == 0 || written == listed,
      fmt::format("{}: format {} has {} bits, but {} are listed", full, format, written, listed));
  PayloadNode node;
  node.name = std::move(name);
  node.field = {full,
                bits,
                std::string(format),
                is_signed,
                static_cast<std::uint32_t>(offset),
                static_cast<std::uint32_t>(size),
                0};
  return node;
}

PayloadNode PayloadBuilder::array(const std::string& name) {
  PayloadNode node;
  node.kind = PayloadNode::Kind::kArray;
  node.name = name;
  return node;
}

void PayloadBuilder::check_single() const {
  DEBURR_CHECK(shape_.single.empty() || has_single_,
               fmt::format("the payload has no array of payloads {} to shorten", shape_.single));
}

std::size_t PayloadBuilder::count(const std::string& name, std::size_t limit,
                                  std::size_t listed) const {
  for (const auto& [what, fewer] : shape_.counts)
    if (what == name) limit = fewer;
  if (limit == kAll) return listed;
  DEBURR_CHECK(
      limit >= 1 && limit <= listed,
      fmt::format("{}: {} elements are built, expected 1..{} as listed", name, limit, listed));
  return limit;
}

// deburr::rtl::engine::LevelToken -> level_token_t
std::string PayloadBuilder::type_name(const std::type_info& type) {
  const std::unique_ptr<char, decltype(&std::free)> full(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, nullptr), &std::free);
  const std::string name = full ? full.get() : type.name();
  std::string text;
  for (const char c : name.substr(name.rfind(':') + 1)) {
    const bool upper = c >= 'A' && c <= 'Z',
               other = !upper && !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9');
    if (upper && !text.empty() && text.back() != '_') text += '_';
    text += other ? '_' : static_cast<char>(upper ? c - 'A' + 'a' : c);
  }
  return text + "_t";
}

}  // namespace detail

namespace {

// True if all elements of an array have the same widths.
bool alike(const PayloadNode& a, const PayloadNode& b) {
  return a.field.bits == b.field.bits && std::equal(a.children.begin(), a.children.end(),
                                                    b.children.begin(), b.children.end(), alike);
}

// The names of the arrays in a payload. An array whose elements differ has no type.
void find_arrays(const PayloadNode& node, const std::string& path,
                 std::vector<std::string>& arrays) {
  const std::string name = path.empty() ? node.name : path + "." + node.name;
  if (node.kind == PayloadNode::Kind::kArray) {
    arrays.push_back(name);
    for (const PayloadNode& element : node.children)
      DEBURR_CHECK(
          alike(element, node.children.front()),
          fmt::format("{}.{} has another shape than the other elements of its array: narrow "
                      "all of {}",
                      name, element.name, name));
  }
  for (const PayloadNode& child : node.children) find_arrays(child, name, arrays);
}

}  // namespace

Payload::Payload(PayloadNode node, const PayloadShape& shape) : node_(std::move(node)) {
  collect(node_);
  check_fields();
  check_shape(shape);
}

void Payload::check_fields() const {
  std::vector<const Field*> sorted;
  for (const Field& field : fields_) sorted.push_back(&field);
  const auto check = [&](const auto& before, const auto& clash, const char* what) {
    std::sort(sorted.begin(), sorted.end(),
              [&](const Field* a, const Field* b) { return before(*a, *b); });
    const auto found =
        std::adjacent_find(sorted.begin(), sorted.end(),
                           [&](const Field* a, const Field* b) { return clash(*a, *b); });
    if (found != sorted.end())
      throw spec::CheckFailed(fmt::format("a payload lists {} and {}: {}", (*found)->name,
                                          (*std::next(found))->name, what));
  };
  check([](const Field& a, const Field& b) { return a.name < b.name; },
        [](const Field& a, const Field& b) { return a.name == b.name; },
        "two fields with the same name");
  check([](const Field& a, const Field& b) { return a.offset < b.offset; },
        [](const Field& a, const Field& b) { return b.offset < a.offset + a.bytes; },
        "two fields at the same offset");
}

void Payload::check_shape(const PayloadShape& shape) const {
  for (const auto& width : shape.widths) {
    const std::string &what = width.first, within = what + ".";
    const auto meant = [&](const std::string& n) { return n == what || n.starts_with(within); };
    DEBURR_CHECK(std::any_of(fields_.begin(), fields_.end(),
                             [&](const Field& f) { return meant(f.name); }) ||
                     std::any_of(left_out_.begin(), left_out_.end(), meant),
                 fmt::format("the payload has no field {} to narrow", what));
  }
  std::vector<std::string> arrays;
  find_arrays(node_, "", arrays);
  for (const auto& [what, elements] : shape.counts)
    DEBURR_CHECK(std::find(arrays.begin(), arrays.end(), what) != arrays.end(),
                 fmt::format("the payload has no array {} to shorten", what));
}

void Payload::collect(PayloadNode& node) {
  if (node.kind == PayloadNode::Kind::kField) {
    node.field.first_bit = bits_;
    bits_ += node.field.bits;
    fields_.push_back(node.field);
    return;
  }
  std::erase_if(node.children, [&](const PayloadNode& child) {
    const bool out = child.kind == PayloadNode::Kind::kField && child.field.bits == 0;
    if (out) left_out_.push_back(child.field.name);
    return out;
  });
  for (PayloadNode& child : node.children) collect(child);
  std::erase_if(node.children, [](const PayloadNode& child) {
    return child.kind == PayloadNode::Kind::kArray && child.children.empty();
  });
}

const Field* Payload::find(std::string_view field) const {
  const auto found =
      std::find_if(fields_.begin(), fields_.end(), [&](const Field& f) { return f.name == field; });
  return found == fields_.end() ? nullptr : &*found;
}

Payload::Bit Payload::bit(const std::string& text) const {
  if (const Field* field = find(text)) return {field, 0};
  std::uint32_t number = 0;
  if (parse(text, number)) {
    if (number >= bits_)
      throw spec::ConfigError(fmt::format("no bit {}: the payload has {} bits", number, bits_));
    const auto above = std::upper_bound(
        fields_.begin(), fields_.end(), number,
        [](std::uint32_t bit, const Field& field) { return bit < field.first_bit; });
    const Field& field = *std::prev(above);
    return {&field, number - field.first_bit};
  }
  const std::size_t dot = text.rfind('.');
  const Field* const field = dot == std::string::npos ? nullptr : find(text.substr(0, dot));
  if (field && parse(std::string_view(text).substr(dot + 1), number)) {
    if (number >= field->bits)
      throw spec::ConfigError(
          fmt::format("no bit {} of {}: the field has {} bits", number, field->name, field->bits));
    return {field, number};
  }
  std::string known;
  for (const Field& one : fields_) known += fmt::format("\n  {} ({} bits)", one.name, one.bits);
  throw spec::ConfigError(fmt::format("unknown field {}; known:{}", text, known));
}

void Payload::flip(std::byte* payload, Bit bit) const {
  bit.field->set(payload, bit.field->get(payload) ^ std::uint64_t{1} << bit.bit);
}

void Payload::fill(std::byte* payload, std::uint64_t pattern) const {
  // splitmix64: neighbouring fields are uncorrelated.
  for (const Field& field : fields_) {
    std::uint64_t noise = (pattern += 0x9E3779B97F4A7C15);
    noise = (noise ^ noise >> 30) * 0xBF58476D1CE4E5B9;
    noise = (noise ^ noise >> 27) * 0x94D049BB133111EB;
    field.set(payload, noise ^ noise >> 31);
  }
}

const Field* Payload::misfit(const std::byte* payload) const {
  for (const Field& field : fields_)
    if (!field.fits(payload)) return &field;
  return nullptr;
}

std::string Payload::text(const std::byte* payload) const {
  std::string text;
  for (const Field& field : fields_)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", field.name, field.text(payload));
  return text;
}

std::string Payload::difference(const std::byte* expected, const std::byte* got) const {
  std::string text;
  for (const Field& field : fields_)
    if (load(expected + field.offset, field.bytes) != load(got + field.offset, field.bytes))
      text += fmt::format("{}{}={}/{}", text.empty() ? "" : " ", field.name, field.text(expected),
                          field.text(got));
  return text;
}

}  // namespace deburr::rtl
